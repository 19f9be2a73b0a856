//! `cargo +nightly fuzz run udp`; what it does stands in `src/targets/udp.rs`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::targets::udp::run(bytes));
