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
    /// From `0xRRGGBB`, opaque.
    pub const fn hex(rgb: u32) -> Self {
        let [_, r, g, b] = rgb.to_be_bytes();
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

/// What a colour stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorRole {
    /// Finger 1 (index 0, left) or 2 (index 1, right): pad, arrow, curve.
    Finger(usize),
    /// A block, by index; six colours, then again.
    Block(usize),
    /// What was measured.
    Measured,
    /// What was simulated.
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
    pub workspace: Color,
    pub ghost: Color,
}

impl Theme {
    /// The colour of a role.
    pub fn color(self, role: ColorRole) -> Color {
        let dark = self == Self::Dark;
        let pick = |light: u32, on_dark: u32| Color::hex(if dark { on_dark } else { light });
        match role {
            ColorRole::Finger(0) => pick(0x00_72_B2, 0x4A_B0_F0),
            ColorRole::Finger(_) => pick(0xE6_8A_00, 0xF5_A8_2A),
            ColorRole::Block(index) => match index % 6 {
                0 => pick(0x1F_A5_83, 0x1F_A8_85),
                1 => pick(0xC8_74_A6, 0xC9_78_A9),
                2 => pick(0xE8_CF_3F, 0xDD_C5_40),
                3 => pick(0x63_B4_E4, 0x5F_AF_DE),
                4 => pick(0x9A_8A_78, 0xA0_92_82),
                _ => pick(0x6B_6F_C9, 0x7C_80_D8),
            },
            ColorRole::Measured => pick(0x33_3A_44, 0xE6_EA_F0),
            ColorRole::Simulated => pick(0xB5_4A_8A, 0xE0_8C_BE),
            ColorRole::Constraint => pick(0x00_7A_5C, 0x3C_D6_AC),
            ColorRole::Saturated => pick(0xD5_2E_00, 0xFF_5A_2B),
            ColorRole::Neutral => pick(0x7A_84_92, 0x8A_95_A5),
        }
    }

    pub(crate) fn palette(self) -> Palette {
        match self {
            Self::Light => Palette {
                background_top: Color::hex(0xDD_E4_EC),
                background_bottom: Color::hex(0xF3_F5_F8),
                glow: Color::hex(0x16_14_10),
                table: Color::hex(0xE4_E8_ED),
                grid: Color::hex(0x8E_A0_B6),
                shadow: Color::hex(0x1E_2A_3C).with_alpha(0.42),
                link: Color::hex(0xAE_B8_C4),
                link_secondary: Color::hex(0x94_A0_AE),
                coupler: Color::hex(0x5C_68_78),
                frame: Color::hex(0x4A_55_64),
                pin: Color::hex(0xE8_EC_F0),
                steel: Color::hex(0xC4_CC_D6),
                brass: Color::hex(0xD8_B4_5E),
                workspace: Color::hex(0x8A_9A_AE),
                ghost: Color::hex(0x5A_6A_80),
            },
            Self::Dark => Palette {
                background_top: Color::hex(0x12_16_1C),
                background_bottom: Color::hex(0x1F_26_30),
                glow: Color::hex(0x14_18_1E),
                table: Color::hex(0x36_40_4C),
                grid: Color::hex(0x7C_90_A8),
                shadow: Color::hex(0x03_05_08).with_alpha(0.60),
                link: Color::hex(0x96_A2_B0),
                link_secondary: Color::hex(0x76_83_92),
                coupler: Color::hex(0x46_52_60),
                frame: Color::hex(0x38_43_50),
                pin: Color::hex(0xD2_DA_E2),
                steel: Color::hex(0x9A_A6_B4),
                brass: Color::hex(0xC8_A4_50),
                workspace: Color::hex(0x5E_70_86),
                ghost: Color::hex(0xB8_C8_DC),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hex_becomes_bytes_again() {
        assert_eq!(Color::hex(0x12_80_FF).bytes(), [0x12, 0x80, 0xFF]);
    }

    #[test]
    fn fingers_differ_in_lightness_and_hue_in_both_themes() {
        for theme in [Theme::Light, Theme::Dark] {
            let difference = theme.color(ColorRole::Finger(0)).rgb - theme.color(ColorRole::Finger(1)).rgb;
            assert!(difference.length() > 0.5, "{theme:?}");
        }
    }
}
