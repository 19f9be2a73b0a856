//! `cargo +nightly fuzz run mcap ../tests/corpus/mcap`; what it does stands in `src/targets/mcap.rs`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::targets::mcap::run(bytes));
