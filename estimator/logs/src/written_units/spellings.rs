//! Spellings of units, with their exponents and factors.

use crate::units::Dimension;

/// Standard gravity, m/s² (exact, CGPM 1901): turns a mass on a scale into its weight.
pub(super) const GRAVITY_M_S2: f64 = 9.806_65;
/// One inch, m, and one pound, kg (both exact, 1959).
pub(super) const INCH_M: f64 = 0.0254;
pub(super) const POUND_KG: f64 = 0.453_592_37;
pub(super) const TURN_RAD: f64 = std::f64::consts::TAU;

/// Exponents of length, time, force, mass, angle; units of other kinds have none.
pub(super) type Exponents = [i32; 5];
pub(super) const LENGTH: Exponents = [1, 0, 0, 0, 0];
pub(super) const TIME: Exponents = [0, 1, 0, 0, 0];
pub(super) const FORCE: Exponents = [0, 0, 1, 0, 0];
pub(super) const MASS: Exponents = [0, 0, 0, 1, 0];
pub(super) const ANGLE: Exponents = [0, 0, 0, 0, 1];
pub(super) const PRESSURE: Exponents = [-2, 0, 1, 0, 0];
pub(super) const TURN_RATE: Exponents = [0, -1, 0, 0, 1];
pub(super) const SPEED: Exponents = [1, -1, 0, 0, 0];
/// Voltage, current, temperature, frequency: no mechanical dimension.
pub(super) const OTHER: Exponents = [0, 0, 0, 0, 9];

/// A base unit: spellings, exponents, factor. A spelling of one letter or with capitals keeps its case.
pub(super) type Atom = (&'static [&'static str], Exponents, f64);

/// Units that take the prefixes of [`PREFIXES`].
pub(super) const PREFIXED: [Atom; 11] = [
    (&["m", "meter", "meters", "metre", "metres", "м", "米"], LENGTH, 1.0),
    (&["s", "sec", "secs", "second", "seconds", "sek", "sekunde", "sekunden", "с", "秒"], TIME, 1.0),
    (&["rad", "radian", "radians", "рад", "弧度"], ANGLE, 1.0),
    (&["N", "newton", "newtons", "Н", "牛", "牛顿"], FORCE, 1.0),
    (&["g", "gram", "grams", "г", "克"], MASS, 1e-3),
    (&["Pa", "pascal"], PRESSURE, 1.0),
    (&["bar"], PRESSURE, 1e5),
    (&["V", "volt", "volts"], OTHER, 1.0),
    (&["A", "amp", "amps", "ampere"], OTHER, 1.0),
    (&["deg"], ANGLE, TURN_RAD / 360.0),
    (&["rpm"], TURN_RATE, TURN_RAD / 60.0),
];

pub(super) const PLAIN: [Atom; 38] = [
    (&["in", "inch", "inches", "zoll", "\""], LENGTH, INCH_M),
    (&["ft", "foot", "feet"], LENGTH, 12.0 * INCH_M),
    (&["yd", "yard", "yards"], LENGTH, 36.0 * INCH_M),
    (&["mil", "mils", "thou"], LENGTH, 1e-3 * INCH_M),
    (&["uin", "microinch"], LENGTH, 1e-6 * INCH_M),
    (&["micron", "microns"], LENGTH, 1e-6),
    (&["min", "minute", "minutes", "мин"], TIME, 60.0),
    (&["h", "hr", "hour", "hours"], TIME, 3600.0),
    (&["day", "days"], TIME, 86_400.0),
    (&["micros"], TIME, 1e-6),
    (&["millis"], TIME, 1e-3),
    (&["nanos"], TIME, 1e-9),
    (&["degs", "degree", "degrees", "grados", "град", "度"], ANGLE, TURN_RAD / 360.0),
    (&["gon"], ANGLE, TURN_RAD / 400.0),
    (&["arcmin"], ANGLE, TURN_RAD / 21_600.0),
    (&["arcsec"], ANGLE, TURN_RAD / 1_296_000.0),
    (&["rev", "revs", "revolution", "revolutions", "turn", "turns", "umdr", "об", "转"], ANGLE, TURN_RAD),
    (&["gf", "pond", "gramforce"], FORCE, 1e-3 * GRAVITY_M_S2),
    (&["kgf", "kp", "kilogramforce", "кгс"], FORCE, GRAVITY_M_S2),
    (&["lbf", "lbsf", "poundforce"], FORCE, POUND_KG * GRAVITY_M_S2),
    (&["ozf", "ounceforce"], FORCE, POUND_KG / 16.0 * GRAVITY_M_S2),
    (&["klbf"], FORCE, 1e3 * POUND_KG * GRAVITY_M_S2),
    (&["pdl", "poundal", "poundals"], FORCE, POUND_KG * 12.0 * INCH_M),
    (&["dyn", "dyne", "dynes"], FORCE, 1e-5),
    (&["kip", "kips"], FORCE, 1e3 * POUND_KG * GRAVITY_M_S2),
    (&["lb", "lbs", "pound", "pounds"], MASS, POUND_KG),
    (&["oz", "ounce", "ounces"], MASS, POUND_KG / 16.0),
    (&["psi"], PRESSURE, POUND_KG * GRAVITY_M_S2 / (INCH_M * INCH_M)),
    (&["atm"], PRESSURE, 101_325.0),
    (&["rps"], TURN_RATE, TURN_RAD),
    (&["dps", "degps"], TURN_RATE, TURN_RAD / 360.0),
    (&["radps"], TURN_RATE, 1.0),
    (&["mps"], SPEED, 1.0),
    (&["ips"], SPEED, INCH_M),
    (&["kph", "kmh"], SPEED, 1.0 / 3.6),
    (&["mph"], SPEED, 63_360.0 * INCH_M / 3600.0),
    (&["ipm"], SPEED, INCH_M / 60.0),
    (&["degc", "celsius", "K", "kelvin", "Hz", "hertz", "W", "watt"], OTHER, 1.0),
];

pub(super) const PREFIXES: [(&[&str], f64); 9] = [
    (&["n", "nano"], 1e-9),
    (&["u", "micro", "мк", "微"], 1e-6),
    (&["m", "milli", "м", "毫"], 1e-3),
    (&["c", "centi", "с", "厘"], 1e-2),
    (&["d", "deci"], 1e-1),
    (&["da", "deca"], 1e1),
    (&["h", "hecto"], 1e2),
    (&["k", "kilo", "к", "千"], 1e3),
    (&["M", "mega"], 1e6),
];

/// Numbers without a unit of their own.
pub(super) const COUNTS: [&str; 19] = [
    "count", "counts", "cts", "cnt", "tick", "ticks", "lsb", "raw", "adc", "digit", "digits", "step", "steps", "pulse",
    "pulses", "inc", "px", "pixel", "pixels",
];

/// Texts that mean a unit only for quantities of some dimensions.
pub(super) const HABITS: [(&str, Dimension, f64); 9] = [
    ("g", Dimension::Acceleration, GRAVITY_M_S2),
    ("G", Dimension::Acceleration, GRAVITY_M_S2),
    ("1/s", Dimension::AngularVelocity, 1.0),
    ("s-1", Dimension::AngularVelocity, 1.0),
    ("min-1", Dimension::AngularVelocity, TURN_RAD / 60.0),
    ("1/min", Dimension::AngularVelocity, TURN_RAD / 60.0),
    ("U/min", Dimension::AngularVelocity, TURN_RAD / 60.0),
    ("r/min", Dimension::AngularVelocity, TURN_RAD / 60.0),
    ("r/s", Dimension::AngularVelocity, TURN_RAD),
];
