//! Any bytes behind the first ones of a Parquet file: a recording or a sentence. `cargo +nightly fuzz run parquet ../tests/corpus/parquet`.

#![no_main]

use libfuzzer_sys::fuzz_target;

const MAGIC: &[u8] = b"PAR1";

fuzz_target!(|bytes: &[u8]| {
    let mut whole = MAGIC.to_vec();
    // Seeds are whole files.
    whole.extend_from_slice(bytes.strip_prefix(MAGIC).unwrap_or(bytes));
    fuzz::load(&whole, &fuzz::file("log.parquet"));
});
