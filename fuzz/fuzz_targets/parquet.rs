//! `cargo +nightly fuzz run parquet ../tests/corpus/parquet`; what it does stands in `src/targets/parquet.rs`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::targets::parquet::run(bytes));
