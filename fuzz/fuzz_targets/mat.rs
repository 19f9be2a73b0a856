//! `cargo +nightly fuzz run mat ../tests/corpus/mat`; what it does stands in `src/targets/mat.rs`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::targets::mat::run(bytes));
