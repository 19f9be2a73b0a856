//! Candidate terms: effects that a cause would have on the residual.

use crate::diagnose::contract::{CauseParameter, parameter};
use crate::diagnose::data::limits::SURE;
use haptics::law::Kind;
use std::sync::Arc;

/// Regressor: effect of a cause on each row per unit of its parameter, made once and shared.
pub type Column = Arc<Vec<f64>>;

/// A value that was searched on a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Searched {
    pub name: &'static str,
    pub value: f64,
    pub unit: &'static str,
}

/// Largest distance of a spring's rest position from the middle, in half ranges.
/// Choice: halved or doubled, none of 46 answers changes.
const FARTHEST_REST: f64 = 3.0;

/// Least share of the dry friction that a law of lost motion may replace.
/// Choice: halved or doubled, none of 62 answers changes.
pub(crate) const LEAST_SHARE: f64 = 0.1;
/// Penalty of one of two causes that are equivalent in some recordings, so that the other one is always named first.
/// Examples are a rotated sensor where the load keeps its sign, equivalent to friction by direction, and friction by
/// direction along one coordinate, equivalent to a bias.
/// Choice: halved or doubled, none of 62 answers changes.
pub(crate) const HARDLY: f64 = 0.02;

/// Constraint on the parameters of a cause.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Anything.
    Any,
    /// Share of the dry friction that a law replaces. The law concerns all of it; a smaller share, below `whole`, can
    /// be an artefact of stick-slip and needs more evidence. It has no upper bound: the model without the law may
    /// underestimate the friction by far.
    Share { least: f64, whole: f64 },
    /// k, f0 of a spring with its rest position near the range; a force that hardly depends on position is none.
    /// `half`: half the range.
    Spring { half: f64 },
    /// k, f0 and two cubics (about the middle, and half a range beside it) of a spring that hardens.
    Hardening { half: f64 },
    /// k and k3 of a spring that hardens about a searched place.
    Stiffening,
    /// k, c of a compliant element with damping; a force that drives the motion is no damper.
    Damped,
}

/// Largest damping of the wrong sign that may be noise, in seconds times the stiffness.
/// Choice: no case of the ablation reads it.
const NEARLY_UNDAMPED_S: f64 = 0.1;

impl Shape {
    fn admits(self, values: &[f64]) -> bool {
        match (self, values) {
            (Self::Share { least, .. }, [share, ..]) => *share > least,
            (Self::Spring { half }, [k, f0]) => *k > 0.0 && f0.abs() < FARTHEST_REST * k * half,
            (Self::Hardening { half }, [k, f0, here, there]) => {
                let cube = half.powi(3);
                let [k, f0, k3, place] = about_its_zero([k * half, *f0, here * cube, there * cube]);
                k3 > 0.0 && k > -0.5 * k3 && place.abs() < FARTHEST_REST && f0.abs() < 2.0 * (k.abs() + k3)
            }
            (Self::Stiffening, [k, k3]) => *k > 0.0 && *k3 > 0.0,
            (Self::Damped, [k, c]) => *c > -NEARLY_UNDAMPED_S * k,
            _ => true,
        }
    }

    /// Penalty of its parameters beside their number, in 2 ln(likelihood).
    fn doubt(self, values: &[f64]) -> f64 {
        match (self, values) {
            (Self::Share { whole, .. }, [share, ..]) if *share < whole => SURE,
            _ => 0.0,
        }
    }
}

/// k u + f0 + here u³ + there (u − 1)³ as k (u − place) + f0 + k3 (u − place)³: k, f0, k3 and the place.
pub fn about_its_zero([k, f0, here, there]: [f64; 4]) -> [f64; 4] {
    let k3 = here + there;
    let (c2, c1, c0) = (-3.0 * there, k + 3.0 * there, f0 - there);
    if k3.abs() < 1e-9 * c2.abs() || k3 == 0.0 {
        return [k, f0, 0.0, 0.0];
    }
    let place = -c2 / (3.0 * k3);
    [c1 - c2 * c2 / (3.0 * k3), c0 + c1 * place + c2 * place * place + k3 * place.powi(3), k3, place]
}

/// One cause with its searched values fixed: its regressors are linear in the residual.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Id from `docs/causes/README.md`; terms of the base model have names of their own.
    pub id: &'static str,
    pub kind: Kind,
    /// One regressor per linear parameter, one entry per row.
    pub regressors: Vec<Column>,
    /// Name and unit of the linear parameters.
    pub linear: Vec<(&'static str, &'static str)>,
    pub searched: Vec<Searched>,
    /// Parameters that count in the evidence: linear and searched ones.
    pub cost: f64,
    /// Required sign of its first parameter, or 0.
    pub sign: f64,
    /// Further constraint on its parameters: a cause is named only if they fit it.
    pub shape: Shape,
    /// Least size of its first parameter. A smaller one is within the uncertainty of the model itself.
    pub least: f64,
    /// Measurement noise of its regressor in a row: a rate is measured less well than a direction.
    pub noise: f64,
    /// Side of a one-sided law: +1, −1, or 0 where there is none.
    pub side: f64,
    /// Expression of a cause without a law.
    pub expression: Option<String>,
    /// Channel on which it depends, and that channel's unit.
    pub channel: Option<(String, String)>,
    /// Part of the recording in which its values were searched. Times in different parts are no neighbours on the grid.
    pub part: usize,
}

impl Candidate {
    /// A cause with one linear parameter.
    pub fn one(id: &'static str, kind: Kind, name: &'static str, unit: &'static str, column: Vec<f64>) -> Self {
        Self::several(id, kind, vec![column], vec![(name, unit)])
    }

    /// A cause with several linear parameters.
    pub fn several(
        id: &'static str,
        kind: Kind,
        columns: Vec<Vec<f64>>,
        linear: Vec<(&'static str, &'static str)>,
    ) -> Self {
        Self::of(id, kind, columns.into_iter().map(Column::new).collect(), linear)
    }

    /// The same with shared regressors.
    pub fn of(id: &'static str, kind: Kind, columns: Vec<Column>, linear: Vec<(&'static str, &'static str)>) -> Self {
        let cost = columns.len() as f64;
        Self {
            id,
            kind,
            regressors: columns,
            linear,
            searched: Vec::new(),
            cost,
            sign: 0.0,
            shape: Shape::Any,
            least: 0.0,
            noise: 0.0,
            side: 0.0,
            expression: None,
            channel: None,
            part: 0,
        }
    }

    /// A cause without a law, in this unit.
    pub fn term(expression: String, unit: &'static str, columns: Vec<Vec<f64>>) -> Self {
        let linear = columns.iter().map(|_| ("amplitude", unit)).collect();
        Self { expression: Some(expression), ..Self::several("other", Kind::Plant, columns, linear) }
    }

    /// Id in an answer.
    pub fn name(&self) -> String {
        self.expression.as_ref().map_or_else(|| self.id.to_owned(), |expression| format!("other:{expression}"))
    }

    /// Adds one more searched value.
    pub fn at(mut self, name: &'static str, value: f64, unit: &'static str) -> Self {
        self.searched.push(Searched { name, value, unit });
        self.cost += 1.0;
        self
    }

    /// All its parameters with these values of its regressors, as for a world.
    pub fn parameters(&self, values: &[f64]) -> Vec<CauseParameter> {
        let linear = self.linear.iter().zip(values).map(|((name, unit), value)| parameter(name, *value, 0.0, unit));
        linear.chain(self.searched.iter().map(|s| parameter(s.name, s.value, 0.0, s.unit))).collect()
    }

    /// The searched value of this name.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.searched.iter().find(|s| s.name == name).map(|s| s.value)
    }

    /// True if it was searched for near these values.
    pub fn is_near(&self, values: &[Searched]) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * (a.abs() + b.abs());
        self.searched.len() == values.len()
            && self.searched.iter().zip(values).all(|(s, v)| s.name == v.name && near(s.value, v.value))
    }

    /// Whose parameters are like that.
    pub fn shaped(mut self, shape: Shape) -> Self {
        self.shape = shape;
        self
    }

    /// Sets the channel of the recording on which it depends.
    pub fn with(mut self, channel: (String, String)) -> Self {
        self.channel = Some(channel);
        self
    }

    /// Sets the part of the recording to which the search was limited.
    pub fn within(mut self, part: usize) -> Self {
        self.part = part;
        self
    }

    /// Sets the least size of its first parameter.
    pub fn at_least(mut self, least: f64) -> Self {
        self.least = least;
        self
    }

    /// Sets the measurement noise of its regressor.
    pub fn noisy(mut self, noise: f64) -> Self {
        self.noise = noise;
        self
    }

    /// True if the estimated values fit its name.
    pub fn admits(&self, values: &[f64]) -> bool {
        self.sign * values[0] >= 0.0 && values[0].abs() >= self.least && self.shape.admits(values)
    }

    /// Penalty for values that make its name doubtful, in 2 ln(likelihood).
    pub fn doubt(&self, values: &[f64]) -> f64 {
        self.shape.doubt(values)
    }

    /// Whose first parameter is positive.
    pub fn positive(mut self) -> Self {
        self.sign = 1.0;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_cubics_are_one_about_another_place() {
        let given = [0.7, -0.2, 1.1, 0.4];
        let [k, f0, k3, place] = about_its_zero(given);
        for u in [-1.0, -0.3, 0.0, 0.4, 1.0_f64] {
            let two = given[0] * u + given[1] + given[2] * u.powi(3) + given[3] * (u - 1.0).powi(3);
            let v = u - place;
            assert!((two - (k * v + f0 + k3 * v.powi(3))).abs() < 1e-12);
        }
    }

    #[test]
    fn a_part_of_the_friction_that_bends_is_doubtful() {
        let share = Shape::Share { least: 0.3, whole: 0.65 };
        assert!(share.admits(&[0.4]) && share.doubt(&[0.4]) > 0.0 && share.doubt(&[0.9]) == 0.0);
        assert!(!share.admits(&[0.2]) && share.admits(&[1.8]));
    }

    #[test]
    fn what_pushes_along_is_no_damper() {
        assert!(Shape::Damped.admits(&[12.0, 0.2]) && Shape::Damped.admits(&[12.0, -0.2]));
        assert!(!Shape::Damped.admits(&[12.0, -6.8]));
    }

    #[test]
    fn a_constant_force_is_no_spring() {
        let spring = Shape::Spring { half: 0.5 };
        assert!(spring.admits(&[2.0, 1.0]) && !spring.admits(&[0.1, 1.0]) && !spring.admits(&[-2.0, 0.0]));
        let hardening = Shape::Hardening { half: 0.5 };
        assert!(hardening.admits(&[2.0, 0.1, 3.0, 0.5]) && !hardening.admits(&[2.0, 0.1, -3.0, 0.5]));
    }
}
