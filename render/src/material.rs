//! Materials of solids: their response to light and their pattern. The patterns are in `material.wgsl`.

/// A material. Colour and gloss belong to the solid.
#[repr(u32)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Material {
    /// Smooth lacquer or plastic.
    #[default]
    Plain = 0,
    /// Aluminium, brushed along the solid's own x.
    Brushed = 1,
    /// Steel and brass that mirror their surroundings.
    Polished = 2,
    /// Foam rubber with open pores.
    Foam = 3,
    /// Paper with its fibres; light shines through a little.
    Paper = 4,
    /// Wood under thin paint, its grain along the solid's own x.
    Wood = 5,
    /// Rubber: a broad, weak shine.
    Rubber = 6,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shader has the same numbers.
    #[test]
    fn the_shader_knows_every_material() {
        let shader = include_str!("pipeline/material.wgsl");
        for material in [
            Material::Plain,
            Material::Brushed,
            Material::Polished,
            Material::Foam,
            Material::Paper,
            Material::Wood,
            Material::Rubber,
        ] {
            let name = format!("{material:?}").to_uppercase();
            let line = format!("const {name}: u32 = {}u;", material as u32);
            assert!(shader.contains(&line), "{line}");
        }
    }
}
