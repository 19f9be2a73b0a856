//! `cargo +nightly fuzz run world ../assets/worlds`; what it does stands in `src/targets/world.rs`.

#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fuzz::targets::world::run(bytes));
