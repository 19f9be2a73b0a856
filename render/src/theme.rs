//! Colours: a light and a dark theme, safe for the usual colour blindnesses (after Okabe and Ito, 2008).
//!
//! The same roles serve the plots of the app, so that a curve has the colour of the finger that it belongs to.

use glam::{Vec3, Vec4};

/// A display colour: sRGB components and opacity, all 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Color {
    /// Red, green, blue as displayed, 0 to 1.
    pub rgb: Vec3,
    /// Opacity, 0 to 1.
    pub alpha: f32,
}

impl Color {
    /// From bytes, opaque.
    pub const fn rgb8(r: u8, g: u8, b: u8) -> Self {
        Self { rgb: Vec3::new(r as f32 / 255.0, g as f32 / 255.0, b as f32 / 255.0), alpha: 1.0 }
    }

    /// The same colour with another opacity.
    pub const fn with_alpha(self, alpha: f32) -> Self {
        Self { alpha, ..self }
    }

    /// A mixture: 0 is this colour, 1 the other.
    pub fn mix(self, other: Self, t: f32) -> Self {
        Self { rgb: self.rgb.lerp(other.rgb, t), alpha: self.alpha + (other.alpha - self.alpha) * t }
    }

    /// Bytes for a user interface: red, green, blue.
    pub fn bytes(self) -> [u8; 3] {
        let c = (self.rgb.clamp(Vec3::ZERO, Vec3::ONE) * 255.0).round();
        [c.x as u8, c.y as u8, c.z as u8]
    }

    /// As the shaders of unlit things take it.
    pub(crate) fn display(self) -> Vec4 {
        self.rgb.extend(self.alpha)
    }

    /// As the shaders of lit things take it: gamma 2 undone, so that `sqrt` brings it back exactly.
    pub(crate) fn linear(self) -> Vec4 {
        (self.rgb * self.rgb).extend(self.alpha)
    }
}

/// Meaning of a colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorRole {
    /// Finger 1 (index 0, left) or 2 (index 1, right): pad, arrow, curve.
    Finger(usize),
    /// A block, by index; six colours, then again.
    Block(usize),
    /// Measured values.
    Measured,
    /// Simulated values.
    Simulated,
    /// The centre of rotation, a constraint.
    Constraint,
    /// A clamped force: attention.
    Saturated,
    /// Anything else that should stay in the background.
    Neutral,
}

/// Light or dark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// Bright background.
    #[default]
    Light,
    /// Dark background.
    Dark,
}

/// Every colour of the scene that is not a role.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Palette {
    pub background_top: Color,
    pub background_bottom: Color,
    /// Added to the background behind the hand.
    pub glow: Color,
    pub table: Color,
    pub grid: Color,
    pub shadow: Color,
    pub link: Color,
    pub link_secondary: Color,
    pub coupler: Color,
    pub frame: Color,
    pub pin: Color,
    pub steel: Color,
    pub brass: Color,
    /// The cup, and the cut through its paper.
    pub paper: Color,
    pub paper_cut: Color,
    pub rope: Color,
    /// Liquid that runs out of a barrel.
    pub liquid: Color,
    pub workspace: Color,
    pub ghost: Color,
}

impl Theme {
    /// The colour of a role.
    pub fn color(self, role: ColorRole) -> Color {
        let dark = self == Self::Dark;
        let pick = |light: [u8; 3], on_dark: [u8; 3]| {
            let [r, g, b] = if dark { on_dark } else { light };
            Color::rgb8(r, g, b)
        };
        match role {
            ColorRole::Finger(0) => pick([0x00, 0x72, 0xB2], [0x4A, 0xB0, 0xF0]),
            ColorRole::Finger(_) => pick([0xE6, 0x8A, 0x00], [0xF5, 0xA8, 0x2A]),
            ColorRole::Block(index) => match index % 6 {
                0 => pick([0x1F, 0xA5, 0x83], [0x1F, 0xA8, 0x85]),
                1 => pick([0xC8, 0x74, 0xA6], [0xC9, 0x78, 0xA9]),
                2 => pick([0xE8, 0xCF, 0x3F], [0xDD, 0xC5, 0x40]),
                3 => pick([0x63, 0xB4, 0xE4], [0x5F, 0xAF, 0xDE]),
                4 => pick([0x9A, 0x8A, 0x78], [0xA0, 0x92, 0x82]),
                _ => pick([0x6B, 0x6F, 0xC9], [0x7C, 0x80, 0xD8]),
            },
            ColorRole::Measured => pick([0x33, 0x3A, 0x44], [0xE6, 0xEA, 0xF0]),
            ColorRole::Simulated => pick([0xB5, 0x4A, 0x8A], [0xE0, 0x8C, 0xBE]),
            ColorRole::Constraint => pick([0x00, 0x7A, 0x5C], [0x3C, 0xD6, 0xAC]),
            ColorRole::Saturated => pick([0xD5, 0x2E, 0x00], [0xFF, 0x5A, 0x2B]),
            ColorRole::Neutral => pick([0x7A, 0x84, 0x92], [0x8A, 0x95, 0xA5]),
        }
    }

    pub(crate) fn palette(self) -> Palette {
        match self {
            Self::Light => Palette {
                background_top: Color::rgb8(0xD6, 0xDE, 0xE8),
                background_bottom: Color::rgb8(0xEC, 0xF0, 0xF4),
                glow: Color::rgb8(0x10, 0x0E, 0x0B),
                table: Color::rgb8(0xD3, 0xDA, 0xE3),
                grid: Color::rgb8(0x84, 0x96, 0xAE),
                shadow: Color::rgb8(0x1E, 0x2A, 0x3C).with_alpha(0.42),
                link: Color::rgb8(0xAE, 0xB8, 0xC4),
                link_secondary: Color::rgb8(0x94, 0xA0, 0xAE),
                coupler: Color::rgb8(0x5C, 0x68, 0x78),
                frame: Color::rgb8(0x4A, 0x55, 0x64),
                pin: Color::rgb8(0xE8, 0xEC, 0xF0),
                steel: Color::rgb8(0xC4, 0xCC, 0xD6),
                brass: Color::rgb8(0xD8, 0xB4, 0x5E),
                paper: Color::rgb8(0xE6, 0xDA, 0xC4),
                paper_cut: Color::rgb8(0xB4, 0x9A, 0x74),
                rope: Color::rgb8(0x8C, 0x7B, 0x66),
                liquid: Color::rgb8(0x3C, 0x92, 0xA8),
                workspace: Color::rgb8(0x8A, 0x9A, 0xAE),
                ghost: Color::rgb8(0x5A, 0x6A, 0x80),
            },
            Self::Dark => Palette {
                background_top: Color::rgb8(0x12, 0x16, 0x1C),
                background_bottom: Color::rgb8(0x1F, 0x26, 0x30),
                glow: Color::rgb8(0x14, 0x18, 0x1E),
                table: Color::rgb8(0x36, 0x40, 0x4C),
                grid: Color::rgb8(0x7C, 0x90, 0xA8),
                shadow: Color::rgb8(0x03, 0x05, 0x08).with_alpha(0.60),
                link: Color::rgb8(0x96, 0xA2, 0xB0),
                link_secondary: Color::rgb8(0x76, 0x83, 0x92),
                coupler: Color::rgb8(0x46, 0x52, 0x60),
                frame: Color::rgb8(0x38, 0x43, 0x50),
                pin: Color::rgb8(0xD2, 0xDA, 0xE2),
                steel: Color::rgb8(0x9A, 0xA6, 0xB4),
                brass: Color::rgb8(0xC8, 0xA4, 0x50),
                paper: Color::rgb8(0xC2, 0xB4, 0x9E),
                paper_cut: Color::rgb8(0xE8, 0xD8, 0xB8),
                rope: Color::rgb8(0xA0, 0x90, 0x7A),
                liquid: Color::rgb8(0x46, 0xA4, 0xBA),
                workspace: Color::rgb8(0x5E, 0x70, 0x86),
                ghost: Color::rgb8(0xB8, 0xC8, 0xDC),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_become_bytes_again() {
        assert_eq!(Color::rgb8(0x12, 0x80, 0xFF).bytes(), [0x12, 0x80, 0xFF]);
    }

    #[test]
    fn fingers_differ_in_lightness_and_hue_in_both_themes() {
        for theme in [Theme::Light, Theme::Dark] {
            let difference = theme.color(ColorRole::Finger(0)).rgb - theme.color(ColorRole::Finger(1)).rgb;
            assert!(difference.length() > 0.5, "{theme:?}");
        }
    }
}
