//! `cargo +nightly fuzz run documents ../assets/lessons`; what it does stands in `src/targets/documents.rs`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::targets::documents::run(bytes));
