//! `cargo +nightly fuzz run log ../tests/corpus/log`; what it does stands in `src/targets/log.rs`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::targets::log::run(bytes));
