//! Pictures for a repository: PNG with a palette of 256 colours, a fraction of the size.

use anyhow::Context as _;
use color_quant::NeuQuant;
use image::RgbaImage;
use std::collections::{BTreeMap, HashMap};

/// Colours of the palette.
const COLORS: usize = 256;
/// Bits per channel that distinguish colours while the palette is learned.
const BITS: u32 = 6;

/// PNG file of a picture.
pub fn small_png(picture: &RgbaImage) -> anyhow::Result<Vec<u8>> {
    let palette = NeuQuant::new(1, COLORS, &evened_out(picture));
    let mut known = HashMap::new();
    let indices: Vec<u8> = picture
        // Without dithering: it would hide the bands of a gradient, and nearly double the file.
        .pixels()
        .map(|pixel| pixel.0)
        .map(|color| *known.entry(color).or_insert_with(|| palette.index_of(&color) as u8))
        .collect();
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, picture.width(), picture.height());
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(palette.color_map_rgb());
    encoder.set_compression(png::Compression::High);
    // Neighbouring indices are uncorrelated: filters would only hide repetitions.
    encoder.set_filter(png::Filter::NoFilter);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&indices));
    written.context("the picture could not be encoded")?;
    Ok(file)
}

/// The picture's colours, each weighted by the square root of its number of pixels. A large gradient would otherwise
/// take the palette from small, important details.
fn evened_out(picture: &RgbaImage) -> Vec<u8> {
    let mut bins: BTreeMap<[u8; 3], (u32, [u32; 3])> = BTreeMap::new();
    for pixel in picture.pixels() {
        let [r, g, b, _] = pixel.0;
        let (count, sums) = bins.entry([r, g, b].map(|c| c >> (8 - BITS))).or_default();
        *count += 1;
        for (sum, value) in sums.iter_mut().zip([r, g, b]) {
            *sum += u32::from(value);
        }
    }
    let mut colors = Vec::new();
    for (count, sums) in bins.into_values() {
        let [r, g, b] = sums.map(|sum| (sum / count) as u8);
        for _ in 0..count.isqrt() {
            colors.extend([r, g, b, 255]);
        }
    }
    colors
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    #[test]
    fn a_large_gradient_leaves_its_hue_to_a_small_thing() {
        let blue = [0, 114, 178];
        let picture = RgbaImage::from_fn(320, 200, |x, y| {
            let [r, g, b] = if x < 12 && y < 12 { blue } else { [190, 200, 215].map(|c| c + (y / 8) as u8) };
            Rgba([r, g, b, 255])
        });
        let file = small_png(&picture).expect("encoded");
        assert!(file.len() < 320 * 200 / 4, "{} bytes", file.len());
        let back = image::load_from_memory(&file).expect("decoded").into_rgba8();
        assert_eq!(back.dimensions(), picture.dimensions());
        let off = |(a, b): (&Rgba<u8>, &Rgba<u8>)| (0..3).map(|i| u32::from(a[i].abs_diff(b[i]))).sum::<u32>();
        let mean = picture.pixels().zip(back.pixels()).map(off).sum::<u32>() / (320 * 200);
        assert!(mean < 9, "mean {mean}");
        let small = back.get_pixel(6, 6);
        assert!((0..3).all(|i| small[i].abs_diff(blue[i]) < 8), "{small:?}");
    }
}
