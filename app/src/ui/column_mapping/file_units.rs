//! Units that files use, including those that the reader converts only by a factor in the sidecar.

use estimator::log::units::Dimension;
use estimator::log::written_units::{Written, in_header, parse};
use std::f64::consts::{PI, TAU};

/// Unit of a column in a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FileUnit {
    /// Displayed symbol.
    pub shown: &'static str,
    /// Symbol of the reader; `None` if the sidecar needs a factor.
    pub symbol: Option<&'static str>,
    /// Dimension that it measures.
    pub dimension: Dimension,
    /// SI value = number × factor.
    pub factor: f64,
}

const fn own(shown: &'static str, symbol: &'static str, dimension: Dimension, factor: f64) -> FileUnit {
    FileUnit { shown, symbol: Some(symbol), dimension, factor }
}

const fn foreign(shown: &'static str, dimension: Dimension, factor: f64) -> FileUnit {
    FileUnit { shown, symbol: None, dimension, factor }
}

/// One kilogram-force, N (CGPM 1901), and one pound, kg (1959).
const KGF_N: f64 = 9.806_65;
const POUND_KG: f64 = 0.453_592_37;
const INCH_M: f64 = 0.0254;

/// All offered units; the first of a dimension is the SI unit.
pub const FILE_UNITS: [FileUnit; 39] = [
    own("m", "m", Dimension::Length, 1.0),
    own("cm", "cm", Dimension::Length, 1e-2),
    own("mm", "mm", Dimension::Length, 1e-3),
    own("µm", "um", Dimension::Length, 1e-6),
    foreign("in", Dimension::Length, INCH_M),
    foreign("ft", Dimension::Length, 12.0 * INCH_M),
    foreign("mil", Dimension::Length, 1e-3 * INCH_M),
    own("rad", "rad", Dimension::Angle, 1.0),
    own("°", "deg", Dimension::Angle, PI / 180.0),
    foreign("turns", Dimension::Angle, TAU),
    foreign("gon", Dimension::Angle, PI / 200.0),
    own("s", "s", Dimension::Time, 1.0),
    own("ms", "ms", Dimension::Time, 1e-3),
    own("µs", "us", Dimension::Time, 1e-6),
    foreign("ns", Dimension::Time, 1e-9),
    foreign("min", Dimension::Time, 60.0),
    own("N", "N", Dimension::Force, 1.0),
    own("mN", "mN", Dimension::Force, 1e-3),
    own("gf", "gf", Dimension::Force, 1e-3 * KGF_N),
    foreign("kN", Dimension::Force, 1e3),
    foreign("kgf", Dimension::Force, KGF_N),
    foreign("lbf", Dimension::Force, POUND_KG * KGF_N),
    foreign("ozf", Dimension::Force, POUND_KG * KGF_N / 16.0),
    own("N·m", "Nm", Dimension::Torque, 1.0),
    own("mN·m", "mNm", Dimension::Torque, 1e-3),
    foreign("N·cm", Dimension::Torque, 1e-2),
    foreign("lbf·in", Dimension::Torque, POUND_KG * KGF_N * INCH_M),
    foreign("ozf·in", Dimension::Torque, POUND_KG * KGF_N / 16.0 * INCH_M),
    own("m/s", "m_s", Dimension::Velocity, 1.0),
    own("cm/s", "cm_s", Dimension::Velocity, 1e-2),
    own("mm/s", "mm_s", Dimension::Velocity, 1e-3),
    own("µm/s", "um_s", Dimension::Velocity, 1e-6),
    foreign("in/s", Dimension::Velocity, INCH_M),
    own("rad/s", "rad_s", Dimension::AngularVelocity, 1.0),
    own("°/s", "deg_s", Dimension::AngularVelocity, PI / 180.0),
    foreign("rpm", Dimension::AngularVelocity, TAU / 60.0),
    own("V", "V", Dimension::Other, 1.0),
    own("A", "A", Dimension::Other, 1.0),
    own("°C", "degC", Dimension::Other, 1.0),
];

impl FileUnit {
    /// The unit with this symbol of the reader.
    pub fn of_symbol(symbol: &str) -> Option<&'static Self> {
        let symbol = if symbol == "N_m" { "Nm" } else { symbol };
        FILE_UNITS.iter().find(|u| u.symbol == Some(symbol))
    }

    /// The SI unit of a dimension.
    pub fn si(dimension: Dimension) -> Option<&'static Self> {
        FILE_UNITS.iter().find(|u| u.dimension == dimension)
    }

    /// Units of a dimension.
    pub fn all_of(dimension: Dimension) -> impl Iterator<Item = &'static Self> {
        FILE_UNITS.iter().filter(move |u| u.dimension == dimension)
    }
}

/// Dimensions that a dialog offers units for.
pub const MECHANICAL: [Dimension; 7] = [
    Dimension::Length,
    Dimension::Angle,
    Dimension::Time,
    Dimension::Force,
    Dimension::Torque,
    Dimension::Velocity,
    Dimension::AngularVelocity,
];

/// Unit by its spelling, as the reader of logs understands it for a quantity of one of these dimensions.
pub fn spelled_for(text: &str, wanted: &[Dimension]) -> Option<&'static FileUnit> {
    if let Some(unit) = FILE_UNITS.iter().find(|u| u.shown == text) {
        return Some(unit);
    }
    let Written::Known(dimension, factor) = parse(text, wanted) else { return None };
    FileUnit::all_of(dimension).find(|u| dimension != Dimension::Other && (u.factor / factor - 1.0).abs() < 1e-9)
}

/// Unit by its spelling.
pub fn spelled(text: &str) -> Option<&'static FileUnit> {
    spelled_for(text, &MECHANICAL).or_else(|| FILE_UNITS.iter().find(|u| u.symbol == Some(text)))
}

/// Splits a column header into name and unit, as the reader does.
pub fn unit_in(header: &str) -> (String, Option<&'static FileUnit>) {
    let (name, text) = in_header(header, &[]);
    (name.to_owned(), spelled(text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use estimator::log::units;

    #[test]
    fn symbols_and_factors_are_the_readers() {
        for unit in &FILE_UNITS {
            if let Some(symbol) = unit.symbol {
                let known = units::find(symbol).expect("the reader knows it");
                assert_eq!(known.dimension, unit.dimension, "{symbol}");
                assert!((known.factor / unit.factor - 1.0).abs() < 1e-12, "{symbol}");
            }
        }
    }

    #[test]
    fn units_are_found_in_headers() {
        for (header, name, shown) in [
            ("Fx1 [N]", "Fx1", Some("N")),
            ("Weg (mm)", "Weg", Some("mm")),
            ("Kraft in kN", "Kraft", Some("kN")),
            ("theta_deg", "theta", Some("°")),
            ("speed/rpm", "speed", Some("rpm")),
            ("v/m/s", "v", Some("m/s")),
            ("vx_mm_s", "vx", Some("mm/s")),
            ("time_ms", "time", Some("ms")),
            ("Winkel [°]", "Winkel", Some("°")),
            ("M [N*m]", "M", Some("N·m")),
            ("pos.x", "pos.x", None),
            ("stamp", "stamp", None),
            ("force_left_x", "force_left_x", None),
            ("x_min", "x_min", None),
            ("Zeit [bars]", "Zeit", None),
            ("load lbf", "load", Some("lbf")),
        ] {
            let (found, unit) = unit_in(header);
            assert_eq!((found.as_str(), unit.map(|u| u.shown)), (name, shown), "{header}");
        }
    }
}
