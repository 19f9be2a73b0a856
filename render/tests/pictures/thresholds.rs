//! How alike two pictures must be: the one place for such numbers.

/// Size that references are kept in, pixels: small, so that a driver's own way with edges matters little.
pub const REFERENCE: [u32; 2] = [128, 72];
/// Mean difference of a channel from its reference, of 255.
pub const MEAN: f64 = 1.2;
/// A pixel differs when one of its channels is off by more than this, of 255.
pub const PIXEL: u8 = 20;
/// Share of the pixels that may differ.
pub const SHARE: f64 = 0.006;

/// Brightness of a shadow's core, as a share of the same place in the light, at most.
pub const SHADE: f32 = 0.82;
/// Brightness of a place that no shadow reaches, as a share of what it is without the thing that casts it: within this of 1.
pub const UNTOUCHED: f32 = 0.02;
/// Different colours in a picture that is not blank.
pub const COLORS: usize = 400;
