//! `cargo +nightly fuzz run serial`; what it does stands in `src/targets/serial.rs`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::targets::serial::run(bytes));
