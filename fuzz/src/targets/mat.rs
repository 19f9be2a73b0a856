//! Any bytes as a file of MATLAB: a recording or a sentence.

pub fn run(bytes: &[u8]) {
    crate::targets::load(bytes, &crate::targets::file("log.mat"));
}
