//! Videos of the hand: any format, decoded by the program `ffmpeg` into small pictures for the time cursor.
//!
//! A video is stored as JPEG pictures at an even rate, so that any moment is available at once, forwards and backwards;
//! a minute takes some 30 MB. `ffmpeg` gets the file and nothing else: no playlist in it can reach the network or other
//! files.

pub mod pictures;
pub mod program;
pub mod reading;
#[cfg(test)]
pub(crate) mod tests;
pub mod writer;
