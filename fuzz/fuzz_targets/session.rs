//! `cargo +nightly fuzz run --features window session`; what it does stands in `src/window/session.rs`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::window::session::run(bytes));
