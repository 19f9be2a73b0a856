//! `cargo +nightly fuzz run sidecar ../tests/corpus/sidecar`; what it does stands in `src/targets/sidecar.rs`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::targets::sidecar::run(bytes));
