//! Entry of the catalogue about a law or a fault: for files, the app and the pages `docs/causes/<id>.md`
//! ([`super::page`]).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Whether a law changes the world or corrects the recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Part of what the trainee feels.
    Plant,
    /// A fault of the measurement; the world stays as it is.
    Instrument,
}

/// Kind of the coordinate, a length or an angle: decides the units of a law's parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Coordinate {
    /// Path length s in m, force in N.
    Linear,
    /// Angle θ in rad, torque in N m.
    Angular,
}

/// Role of a parameter in its law, linear or not: limits the methods of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Enters {
    /// The force is linear and homogeneous in all such parameters together.
    Linear,
    /// Must be searched for.
    Nonlinear,
    /// Geometry that is known beforehand; never fitted.
    Fixed,
}

/// Name, unit and range of one parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterSpec {
    /// Symbol without its unit, e.g. `c`.
    pub name: &'static str,
    /// Unit when the coordinate is a length.
    pub unit: &'static str,
    /// Unit when the coordinate is an angle.
    pub unit_angular: &'static str,
    /// Physically meaningful range.
    pub bounds: (f64, f64),
    /// Linear, nonlinear or fixed.
    pub enters: Enters,
}

/// Bounds of a parameter that cannot be negative.
pub(super) const POSITIVE: (f64, f64) = (0.0, f64::INFINITY);
/// Bounds of a parameter of either sign.
pub(super) const ANY: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

impl ParameterSpec {
    /// A parameter in which the force is linear.
    pub(super) const fn linear(
        name: &'static str,
        unit: &'static str,
        unit_angular: &'static str,
        bounds: (f64, f64),
    ) -> Self {
        Self { name, unit, unit_angular, bounds, enters: Enters::Linear }
    }

    /// A parameter that must be searched for.
    pub(super) const fn nonlinear(
        name: &'static str,
        unit: &'static str,
        unit_angular: &'static str,
        bounds: (f64, f64),
    ) -> Self {
        Self { name, unit, unit_angular, bounds, enters: Enters::Nonlinear }
    }

    /// A parameter that is known beforehand.
    pub(super) const fn fixed(
        name: &'static str,
        unit: &'static str,
        unit_angular: &'static str,
        bounds: (f64, f64),
    ) -> Self {
        Self { name, unit, unit_angular, bounds, enters: Enters::Fixed }
    }
}

/// One page of the catalogue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// Stable id (`docs/causes/README.md`, or a base term such as `weight`).
    pub id: &'static str,
    /// Plant or instrument.
    pub kind: Kind,
    /// A short name for people.
    pub title: &'static str,
    /// The added term.
    pub equation: &'static str,
    /// Description of the effect.
    pub what: &'static str,
    /// Signs of the effect in a recording: "As …" or "In …".
    pub shows: &'static str,
    /// Effects that mimic it, and under which conditions.
    pub mimics: &'static str,
    /// Motion that reveals the effect, as one sentence.
    pub reveals: &'static str,
    /// The parameters, in the order of the regressor's columns.
    pub parameters: &'static [ParameterSpec],
}
