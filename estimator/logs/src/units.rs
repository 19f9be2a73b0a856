//! Column names `<quantity>[finger]_<unit>` and the conversion of their units to SI.

/// Dimension of a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// m.
    Length,
    /// rad.
    Angle,
    /// s.
    Time,
    /// N.
    Force,
    /// N m.
    Torque,
    /// m/s.
    Velocity,
    /// rad/s.
    AngularVelocity,
    /// m/s².
    Acceleration,
    /// rad/s².
    AngularAcceleration,
    /// V, A, °C: kept as they are.
    Other,
}

/// A unit the program knows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// As it stands in a column's name.
    pub symbol: &'static str,
    /// Dimension of the unit.
    pub dimension: Dimension,
    /// The SI unit, as it stands in a column's name.
    pub si: &'static str,
    /// SI value = number × factor.
    pub factor: f64,
}

/// Standard gravity, m/s²: 1 gf = 9.80665e-3 N (exact, CGPM 1901).
const GRAM_FORCE_N: f64 = 9.806_65e-3;
/// One degree, rad.
const DEGREE_RAD: f64 = std::f64::consts::PI / 180.0;

const fn unit(symbol: &'static str, dimension: Dimension, si: &'static str, factor: f64) -> Unit {
    Unit { symbol, dimension, si, factor }
}

/// Every accepted unit.
pub const UNITS: [Unit; 31] = [
    unit("m", Dimension::Length, "m", 1.0),
    unit("cm", Dimension::Length, "m", 1e-2),
    unit("mm", Dimension::Length, "m", 1e-3),
    unit("um", Dimension::Length, "m", 1e-6),
    unit("rad", Dimension::Angle, "rad", 1.0),
    unit("deg", Dimension::Angle, "rad", DEGREE_RAD),
    unit("s", Dimension::Time, "s", 1.0),
    unit("ms", Dimension::Time, "s", 1e-3),
    unit("us", Dimension::Time, "s", 1e-6),
    unit("N", Dimension::Force, "N", 1.0),
    unit("mN", Dimension::Force, "N", 1e-3),
    unit("gf", Dimension::Force, "N", GRAM_FORCE_N),
    unit("Nm", Dimension::Torque, "Nm", 1.0),
    unit("N_m", Dimension::Torque, "Nm", 1.0),
    unit("mNm", Dimension::Torque, "Nm", 1e-3),
    unit("m_s", Dimension::Velocity, "m_s", 1.0),
    unit("cm_s", Dimension::Velocity, "m_s", 1e-2),
    unit("mm_s", Dimension::Velocity, "m_s", 1e-3),
    unit("um_s", Dimension::Velocity, "m_s", 1e-6),
    unit("rad_s", Dimension::AngularVelocity, "rad_s", 1.0),
    unit("deg_s", Dimension::AngularVelocity, "rad_s", DEGREE_RAD),
    unit("m_s2", Dimension::Acceleration, "m_s2", 1.0),
    unit("cm_s2", Dimension::Acceleration, "m_s2", 1e-2),
    unit("mm_s2", Dimension::Acceleration, "m_s2", 1e-3),
    unit("rad_s2", Dimension::AngularAcceleration, "rad_s2", 1.0),
    unit("deg_s2", Dimension::AngularAcceleration, "rad_s2", DEGREE_RAD),
    unit("V", Dimension::Other, "V", 1.0),
    unit("A", Dimension::Other, "A", 1.0),
    unit("degC", Dimension::Other, "degC", 1.0),
    unit("Hz", Dimension::Other, "Hz", 1.0),
    unit("kg", Dimension::Other, "kg", 1.0),
];

/// Units that can be used for a quantity, for people.
pub fn accepted(dimensions: &[Dimension]) -> &'static str {
    match dimensions {
        [Dimension::Time] => "s, ms, us",
        [Dimension::Length, Dimension::Angle] => "m, cm, mm, um, rad, deg",
        [Dimension::Angle] => "rad, deg",
        [Dimension::Force] => "N, mN, gf",
        [Dimension::Torque] => "Nm, mNm",
        [Dimension::Velocity] => "m_s, cm_s, mm_s, um_s",
        [Dimension::AngularVelocity] => "rad_s, deg_s",
        [Dimension::Velocity, Dimension::AngularVelocity] => "m_s, cm_s, mm_s, rad_s, deg_s",
        [Dimension::Acceleration, ..] => "m_s2, cm_s2, mm_s2, rad_s2, deg_s2",
        _ => "m, cm, mm, um",
    }
}

/// Symbol of the SI unit of a dimension, as it stands in a column's name.
pub fn si(dimension: Dimension) -> &'static str {
    UNITS.iter().find(|unit| unit.dimension == dimension).map_or("", |unit| unit.si)
}

/// The unit with this symbol.
pub fn find(symbol: &str) -> Option<Unit> {
    UNITS.iter().copied().find(|u| u.symbol == symbol)
}

/// Splits `tip_x_mm` into `tip_x` and the unit mm; the longest known unit wins (`vx_cm_s` is a speed, not a time).
pub fn split(name: &str) -> Option<(&str, Unit)> {
    name.match_indices('_')
        .find_map(|(at, _)| find(&name[at + 1..]).map(|unit| (&name[..at], unit)))
        .filter(|(quantity, _)| !quantity.is_empty())
}

/// Dimensions of a quantity of the program; `None` for a name that the program does not know.
pub fn quantity_dimensions(quantity: &str) -> Option<&'static [Dimension]> {
    let stem = quantity.trim_end_matches(['1', '2']);
    if quantity.len() - stem.len() > 1 {
        return None;
    }
    let fingered = stem.len() < quantity.len();
    match (stem, fingered) {
        ("t", false) => Some(&[Dimension::Time]),
        ("x" | "y", _) | ("z", false) => Some(&[Dimension::Length]),
        ("vx" | "vy", _) | ("vz", false) => Some(&[Dimension::Velocity]),
        ("fx" | "fy", _) | ("fz" | "f", false) => Some(&[Dimension::Force]),
        ("qb" | "qt", _) => Some(&[Dimension::Angle]),
        ("dqb" | "dqt", _) => Some(&[Dimension::AngularVelocity]),
        ("q", false) => Some(&[Dimension::Length, Dimension::Angle]),
        ("dq", false) => Some(&[Dimension::Velocity, Dimension::AngularVelocity]),
        ("ddq", false) => Some(&[Dimension::Acceleration, Dimension::AngularAcceleration]),
        ("tau", false) => Some(&[Dimension::Torque]),
        _ => None,
    }
}

/// True for the SI name of a quantity that the program works with, e.g. `fx1_N`.
pub fn is_program_name(name: &str) -> bool {
    split(name).is_some_and(|(quantity, unit)| {
        quantity_dimensions(quantity).is_some_and(|d| d.contains(&unit.dimension)) && unit.factor == 1.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_split_at_the_longest_unit() {
        let (quantity, unit) = split("vx1_cm_s").expect("a speed");
        assert_eq!((quantity, unit.dimension, unit.si), ("vx1", Dimension::Velocity, "m_s"));
        assert_eq!(split("fx_wrist_sensor_N").map(|(q, u)| (q, u.symbol)), Some(("fx_wrist_sensor", "N")));
        assert_eq!(split("time_s").map(|(q, u)| (q, u.symbol)), Some(("time", "s")));
        assert!(split("label").is_none() && split("load_percent").is_none() && split("_m").is_none());
    }

    #[test]
    fn quantities_know_what_they_measure() {
        assert_eq!(quantity_dimensions("fx1"), Some(&[Dimension::Force][..]));
        assert_eq!(quantity_dimensions("q1"), None, "a joint of somebody's arm, not a coordinate");
        assert_eq!(quantity_dimensions("z2"), None);
        assert!(is_program_name("dqb2_rad_s") && is_program_name("q_m") && !is_program_name("x_mm"));
        assert!(!is_program_name("tip_x_m"));
    }

    #[test]
    fn one_gram_force_is_9_80665_millinewton() {
        assert_eq!(find("gf").map(|u| u.factor), Some(9.806_65e-3));
        assert!((find("deg").expect("known").factor * 180.0 - std::f64::consts::PI).abs() < 1e-15);
    }
}
