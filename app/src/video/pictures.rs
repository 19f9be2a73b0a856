//! JPEG pictures in a stream: finding their ends, and decoding them.

use image::{ImageFormat, ImageReader, Limits, RgbImage};
use std::io::Cursor;

/// Maximum size of the longer side of a decoded picture, pixels.
const MOST_PIXELS: u32 = 4096;

/// Finds the ends of pictures in a stream of JPEG pictures that arrives in chunks.
#[derive(Debug, Default)]
pub struct Cutter {
    /// Number of stream bytes before the end of each picture.
    pub ends: Vec<usize>,
    after_mark: bool,
}

impl Cutter {
    /// Adds a chunk that begins `before` bytes into the stream. Within a picture's data the mark 0xff is followed by a
    /// zero or a restart, so the end mark is unambiguous.
    pub fn add(&mut self, before: usize, piece: &[u8]) {
        for (k, byte) in piece.iter().enumerate() {
            if self.after_mark && *byte == 0xd9 {
                self.ends.push(before + k + 1);
            }
            self.after_mark = *byte == 0xff;
        }
    }
}

/// Decoded picture; `None` if the bytes are not a JPEG.
pub fn decode(jpeg: &[u8]) -> Option<RgbImage> {
    let mut reader = ImageReader::with_format(Cursor::new(jpeg), ImageFormat::Jpeg);
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(MOST_PIXELS), Some(MOST_PIXELS));
    reader.limits(limits);
    Some(reader.decode().ok()?.into_rgb8())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_found_across_pieces() {
        let stream = [0xff, 0xd8, 1, 0xff, 0x00, 0xd9, 0xff, 0xd9, 0xff, 0xd8, 0xff, 0xff, 0xd9];
        for at in 0..stream.len() {
            let mut cut = Cutter::default();
            cut.add(0, &stream[..at]);
            cut.add(at, &stream[at..]);
            assert_eq!(cut.ends, [8, 13], "in pieces at {at}");
        }
    }

    #[test]
    fn what_is_no_picture_is_none() {
        assert!(decode(b"").is_none() && decode(&[0xff, 0xd8, 0xff, 0xd9]).is_none());
    }
}
