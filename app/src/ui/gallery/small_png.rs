//! Pictures for a repository: PNG with a palette of 256 colours, a fraction of the size.

use anyhow::Context as _;
use color_quant::NeuQuant;
use image::RgbaImage;
use std::collections::HashMap;

/// Colours of the palette.
const COLORS: usize = 256;
/// The palette is learned from every so many pixels.
const SAMPLED: i32 = 4;

/// The file of a picture.
pub fn small_png(picture: &RgbaImage) -> anyhow::Result<Vec<u8>> {
    let palette = NeuQuant::new(SAMPLED, COLORS, picture.as_raw());
    let mut known = HashMap::new();
    let indices: Vec<u8> = picture
        .pixels()
        .map(|pixel| *known.entry(pixel.0).or_insert_with(|| palette.index_of(&pixel.0) as u8))
        .collect();
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, picture.width(), picture.height());
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette.color_map_rgb());
    encoder.set_compression(png::Compression::High);
    // Neighbouring indices say nothing about each other: filters would only hide repetitions.
    encoder.set_filter(png::Filter::NoFilter);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&indices));
    written.context("the picture could not be encoded")?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    #[test]
    fn a_small_picture_is_nearly_the_same_and_small() {
        let picture = RgbaImage::from_fn(320, 200, |x, y| {
            if (80..160).contains(&x) { Rgba([31, 165, 131, 255]) } else { Rgba([(x / 2) as u8, 90, y as u8, 255]) }
        });
        let file = small_png(&picture).expect("encoded");
        assert!(file.len() < 320 * 200, "{} bytes", file.len());
        let back = image::load_from_memory(&file).expect("decoded").into_rgba8();
        assert_eq!(back.dimensions(), picture.dimensions());
        let off = |(a, b): (&Rgba<u8>, &Rgba<u8>)| (0..3).map(|i| u64::from(a[i].abs_diff(b[i]))).sum::<u64>();
        let sum: u64 = picture.pixels().zip(back.pixels()).map(off).sum();
        assert!(sum / (320 * 200) < 12, "mean {}", sum / (320 * 200));
    }
}
