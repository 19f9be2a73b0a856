//! The numbers of the tests of pictures, in one place.

/// Different colours in a picture that is not blank.
pub const COLORS: usize = 60;
/// Share of the pixels in the palette's own colours of surfaces, at least.
pub const SURFACE: f64 = 0.04;
/// Pixels in the palette's colours of words, at least.
pub const INK: usize = 40;
/// Mean brightness, of 255: light pictures are above, dark ones below.
pub const LIGHT: f64 = 170.0;
pub const DARK: f64 = 90.0;
/// Width of the margin around a panel in which nothing may be drawn, pixels.
pub const MARGIN: u32 = 8;
/// Pixels that a layer of the scene must add in its colour.
pub const LAYER: usize = 60;
