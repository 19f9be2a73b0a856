//! Units that files use, including those that the reader converts only by a factor in the sidecar.

use estimator::log::units::{self, Dimension};
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
    /// Accepted spellings, in lower case without blanks.
    spellings: &'static [&'static str],
}

const fn own(
    shown: &'static str,
    symbol: &'static str,
    dimension: Dimension,
    factor: f64,
    spellings: &'static [&'static str],
) -> FileUnit {
    FileUnit { shown, symbol: Some(symbol), dimension, factor, spellings }
}

const fn foreign(
    shown: &'static str,
    dimension: Dimension,
    factor: f64,
    spellings: &'static [&'static str],
) -> FileUnit {
    FileUnit { shown, symbol: None, dimension, factor, spellings }
}

/// One kilogram-force, N (CGPM 1901), and one pound, kg (1959).
const KGF_N: f64 = 9.806_65;
const POUND_KG: f64 = 0.453_592_37;
const INCH_M: f64 = 0.0254;

/// All offered units; the first of a dimension is the SI unit.
pub const FILE_UNITS: [FileUnit; 39] = [
    own("m", "m", Dimension::Length, 1.0, &["m", "meter", "metre", "meters"]),
    own("cm", "cm", Dimension::Length, 1e-2, &["cm"]),
    own("mm", "mm", Dimension::Length, 1e-3, &["mm", "millimeter", "millimetre"]),
    own("µm", "um", Dimension::Length, 1e-6, &["um", "µm", "μm", "micron"]),
    foreign("in", Dimension::Length, INCH_M, &["in", "inch", "zoll", "\""]),
    foreign("ft", Dimension::Length, 12.0 * INCH_M, &["ft", "feet"]),
    foreign("mil", Dimension::Length, 1e-3 * INCH_M, &["mil"]),
    own("rad", "rad", Dimension::Angle, 1.0, &["rad", "radian", "radians"]),
    own("°", "deg", Dimension::Angle, PI / 180.0, &["deg", "°", "degree", "degrees", "grad"]),
    foreign("turns", Dimension::Angle, TAU, &["turns", "turn", "rev", "umdr"]),
    foreign("gon", Dimension::Angle, PI / 200.0, &["gon"]),
    own("s", "s", Dimension::Time, 1.0, &["s", "sec", "secs", "second", "seconds", "sek", "sekunden"]),
    own("ms", "ms", Dimension::Time, 1e-3, &["ms", "msec", "millis", "milliseconds"]),
    own("µs", "us", Dimension::Time, 1e-6, &["us", "µs", "μs", "usec", "micros"]),
    foreign("ns", Dimension::Time, 1e-9, &["ns", "nsec", "nanos"]),
    foreign("min", Dimension::Time, 60.0, &["min"]),
    own("N", "N", Dimension::Force, 1.0, &["n", "newton", "newtons"]),
    own("mN", "mN", Dimension::Force, 1e-3, &["mn"]),
    own("gf", "gf", Dimension::Force, 1e-3 * KGF_N, &["gf", "gram", "g", "pond", "p"]),
    foreign("kN", Dimension::Force, 1e3, &["kn"]),
    foreign("kgf", Dimension::Force, KGF_N, &["kgf", "kp", "kg"]),
    foreign("lbf", Dimension::Force, POUND_KG * KGF_N, &["lbf", "lb", "lbs"]),
    foreign("ozf", Dimension::Force, POUND_KG * KGF_N / 16.0, &["ozf", "oz"]),
    own("N·m", "Nm", Dimension::Torque, 1.0, &["nm", "n_m", "n·m", "n*m", "n.m"]),
    own("mN·m", "mNm", Dimension::Torque, 1e-3, &["mnm", "mn·m", "mn*m", "nmm", "n·mm"]),
    foreign("N·cm", Dimension::Torque, 1e-2, &["ncm", "n·cm", "n*cm"]),
    foreign("lbf·in", Dimension::Torque, POUND_KG * KGF_N * INCH_M, &["lbfin", "inlb", "lbin", "lbf·in", "in-lb"]),
    foreign("ozf·in", Dimension::Torque, POUND_KG * KGF_N / 16.0 * INCH_M, &["ozin", "ozfin", "ozf·in"]),
    own("m/s", "m_s", Dimension::Velocity, 1.0, &["m/s", "m_s", "mps", "ms-1", "m/sec"]),
    own("cm/s", "cm_s", Dimension::Velocity, 1e-2, &["cm/s", "cm_s"]),
    own("mm/s", "mm_s", Dimension::Velocity, 1e-3, &["mm/s", "mm_s", "mmps"]),
    own("µm/s", "um_s", Dimension::Velocity, 1e-6, &["um/s", "um_s", "µm/s", "μm/s"]),
    foreign("in/s", Dimension::Velocity, INCH_M, &["in/s", "in_s", "ips"]),
    own("rad/s", "rad_s", Dimension::AngularVelocity, 1.0, &["rad/s", "rad_s", "1/s", "s^-1"]),
    own("°/s", "deg_s", Dimension::AngularVelocity, PI / 180.0, &["deg/s", "°/s", "deg_s", "grad/s", "dps"]),
    foreign("rpm", Dimension::AngularVelocity, TAU / 60.0, &["rpm", "1/min", "u/min", "r/min"]),
    own("V", "V", Dimension::Other, 1.0, &["v", "volt"]),
    own("A", "A", Dimension::Other, 1.0, &["a", "ampere"]),
    own("°C", "degC", Dimension::Other, 1.0, &["degc", "°c", "celsius"]),
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

/// Unit by its spelling; case matters where it must (`mN` is not `MN`, `Nm` not `nm`).
pub fn spelled(text: &str) -> Option<&'static FileUnit> {
    let text: String = text.chars().filter(|c| !c.is_whitespace()).collect();
    if let Some(unit) = FILE_UNITS.iter().find(|u| u.shown == text || u.symbol == Some(text.as_str())) {
        return Some(unit);
    }
    let lower = text.to_lowercase();
    FILE_UNITS.iter().find(|u| u.spellings.contains(&lower.as_str()))
}

/// Splits a column header into name and unit: `Fx1 [N]`, `Weg (mm)`, `pos in mm`, `theta_deg`, `speed/rpm`.
pub fn unit_in(header: &str) -> (String, Option<&'static FileUnit>) {
    let header = header.trim();
    if let Some((quantity, unit)) = units::split(header)
        && let Some(found) = FileUnit::of_symbol(unit.symbol)
    {
        return (quantity.to_owned(), Some(found));
    }
    for (open, close) in [('[', ']'), ('(', ')'), ('{', '}'), ('<', '>')] {
        if let Some((name, rest)) = header.split_once(open)
            && let Some((inside, _)) = rest.rsplit_once(close)
        {
            return (name.trim().to_owned(), spelled(inside.trim_start_matches("in ")));
        }
    }
    // `F/kN`, `Kraft in N`; the latest separator first, so that `v/m/s` can match as a whole.
    let marks = [" in ", " / ", "/", ",", "_in_"];
    let marked = marks.iter().find_map(|mark| {
        let mut places = header.match_indices(mark);
        places.find_map(|(at, _)| Some((at, spelled(&header[at + mark.len()..])?)))
    });
    if let Some((at, unit)) = marked.filter(|(at, _)| *at > 0) {
        return (header[..at].trim().to_owned(), Some(unit));
    }
    for mark in ['_', ' ', '.', '-'] {
        let mut places = header.match_indices(mark);
        let found = places.find_map(|(at, m)| Some((at, word(&header[at + m.len()..])?)));
        if let Some((at, unit)) = found.filter(|(at, _)| *at > 0) {
            return (header[..at].trim().to_owned(), Some(unit));
        }
    }
    (header.to_owned(), None)
}

/// Unit after a mere blank or underscore: single letters other than the SI ones are more likely names (`pos_a`,
/// `force_p`).
fn word(text: &str) -> Option<&'static FileUnit> {
    if text.len() == 1 && !["m", "s", "N", "V", "A", "°"].contains(&text) {
        return None;
    }
    spelled(text).filter(|_| !matches!(text, "in" | "min" | "P" | "Min"))
}

#[cfg(test)]
mod tests {
    use super::*;

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
