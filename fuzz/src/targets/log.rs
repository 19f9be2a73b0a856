//! Any bytes as a log, most of them tables of text: a recording or a sentence.

pub fn run(bytes: &[u8]) {
    crate::targets::load(bytes, &crate::targets::file("log.csv"));
}
