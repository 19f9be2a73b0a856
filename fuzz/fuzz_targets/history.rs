//! `cargo +nightly fuzz run --features window history`; what it does stands in `src/window/history.rs`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::window::history::run(bytes));
