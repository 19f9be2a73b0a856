//! Golden answers of the program: see `tests/answers.rs`. A crate of its own, so that the check builds neither window nor pictures.
