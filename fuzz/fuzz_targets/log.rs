//! Any bytes as a log, most of them tables of text: a recording or a sentence. `cargo +nightly fuzz run log ../tests/corpus/log`.

#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| fuzz::load(bytes, &fuzz::file("log.csv")));
