//! Any bytes behind the first ones of a Parquet file: a recording or a sentence.

const MAGIC: &[u8] = b"PAR1";

pub fn run(bytes: &[u8]) {
    let mut whole = MAGIC.to_vec();
    // Seeds are whole files.
    whole.extend_from_slice(bytes.strip_prefix(MAGIC).unwrap_or(bytes));
    crate::targets::load(&whole, &crate::targets::file("log.parquet"));
}
