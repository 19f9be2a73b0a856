//! From a solved system to the named parameters of the result.

use super::gravity::Gravity;
use super::parameters::{Known, Term};
use super::regress::Shown;
use crate::identify::limits::SIGNIFICANT;
use crate::regression::bootstrap::Resampled;
use crate::regression::linear::LinearFit;
use crate::regression::long_run_variance::HALF_INTERVAL;
use foundation::estimate::{Correlated, Fit, Parameter};
use haptics::law::Coordinate;
use nalgebra::DMatrix;

/// The object's name in the results.
pub const OBJECT: &str = "mechanism";
/// Angle at which a mechanism with a gravity moment hangs, rad.
pub const PHASE: &str = "gravity_phase_rad";
/// Largest uncertainty of the force by the error of one value, as a share of the force. A value with a larger one is
/// shown only if it is significant.
/// Choice: halved or doubled, none of 5 answers changes.
pub(super) const EFFECT_SHARE: f64 = 0.2;

/// Input of the report.
pub struct Material<'a> {
    /// Length or angle.
    pub coordinate: Coordinate,
    /// Terms that the motion can show.
    pub shown: &'a Shown,
    /// The terms in the order of the columns.
    pub terms: &'a [Term],
    /// The solution.
    pub fit: &'a LinearFit,
    /// Root mean square of each regressor: force per unit of its parameter.
    pub effect: &'a [f64],
    /// Root mean square of the force.
    pub force_rms: f64,
    /// Parameters that the sidecar states.
    pub known: &'a Known,
    /// Errors by resampling, in the order of the columns.
    pub resampled: Option<&'a Resampled>,
    /// Decision about gravity; `None` if it cannot act.
    pub gravity: Option<&'a Gravity>,
}

impl Material<'_> {
    fn index(&self, term: Term) -> Option<usize> {
        self.terms.iter().position(|t| *t == term)
    }

    fn samples(&self) -> usize {
        self.fit.residuals.len()
    }

    /// All parameters of the mechanism.
    pub fn push(&self, result: &mut Fit) {
        for term in [Term::Inertia, Term::Viscous, Term::Coulomb, Term::Offset] {
            if self.known.value(term).is_none() {
                result.parameters.push(self.parameter(term));
            }
        }
        self.push_resistance(result);
        self.push_gravity(result);
        push_known(result, self.known, self.coordinate);
    }

    fn parameter(&self, term: Term) -> Parameter {
        let name = term.name(self.coordinate);
        if let Some((_, why)) = self.shown.hidden.iter().find(|(t, _)| *t == term) {
            return Parameter::unidentified(OBJECT, name, self.samples(), why);
        }
        let Some(i) = self.index(term).filter(|&i| self.fit.identified[i]) else {
            return Parameter::unidentified(OBJECT, name, self.samples(), "the motion does not excite it; vary it");
        };
        let (value, error) = (self.fit.values[i], self.fit.std_errors[i]);
        let vague = error * self.effect[i] > EFFECT_SHARE * self.force_rms && value.abs() < SIGNIFICANT * error;
        if vague || !error.is_finite() {
            let why =
                format!("its value is uncertain by {error:.3}, too much against the noise; excite it harder or longer");
            return Parameter::unidentified(OBJECT, name, self.samples(), &why);
        }
        // Everything has a mass: one whose 95 % interval holds none at all was not shown.
        if term == Term::Inertia && value < HALF_INTERVAL * error {
            let why = if value < -HALF_INTERVAL * error {
                format!("it comes out at {value:.1e} ± {error:.1e}: check the sign of the force column")
            } else {
                format!("it comes out at {value:.1e} ± {error:.1e}, which may as well be none; accelerate harder")
            };
            return Parameter::unidentified(OBJECT, name, self.samples(), &why);
        }
        let how = format!(
            "least squares over the whole motion, zero-phase filtered signals, {:.0} independent samples",
            self.fit.effective_samples
        );
        Parameter::identified(OBJECT, name, value, error, self.samples(), &how).with_bootstrap(self.drawn(i))
    }

    /// Covariance of the fitted terms.
    pub fn correlated(&self) -> Correlated {
        let kept: Vec<usize> = (0..self.terms.len())
            .filter(|i| !matches!(self.terms[*i], Term::GravitySine | Term::GravityCosine))
            .filter(|i| self.terms[*i].law().is_some())
            .filter(|i| !self.shown.hidden.iter().any(|(t, _)| *t == self.terms[*i]))
            .collect();
        Correlated {
            parameters: kept.iter().map(|i| format!("{OBJECT}.{}", self.terms[*i].name(self.coordinate))).collect(),
            values: kept.iter().map(|i| self.fit.values[*i]).collect(),
            covariance: kept.iter().map(|i| kept.iter().map(|j| self.fit.covariance[(*i, *j)]).collect()).collect(),
            shown_below: kept.iter().map(|i| EFFECT_SHARE * self.force_rms / self.effect[*i].max(1e-300)).collect(),
        }
    }

    /// Sum of offset and friction if they are inseparable: it is still worth knowing.
    fn push_resistance(&self, result: &mut Fit) {
        let hidden = |t: Term| self.shown.hidden.iter().any(|(h, _)| *h == t);
        let (term, what) = match (hidden(Term::Offset), hidden(Term::Coulomb)) {
            (true, _) if !self.terms.contains(&Term::Coulomb) => (Term::Offset, "along +coordinate"),
            (_, true) => (Term::Coulomb, "against the motion"),
            _ => return,
        };
        let Some(i) = self.index(term).filter(|&i| self.fit.identified[i]) else { return };
        let name = if self.coordinate == Coordinate::Linear { "resistance_N" } else { "resistance_Nm" };
        let how = format!("all constant resistance {what} together: this motion cannot split it");
        let parameter =
            Parameter::identified(OBJECT, name, self.fit.values[i], self.fit.std_errors[i], self.samples(), &how);
        result.parameters.push(parameter.with_bootstrap(self.drawn(i)));
    }

    fn drawn(&self, column: usize) -> Option<f64> {
        self.resampled.map(|drawn| drawn[column])
    }

    fn push_gravity(&self, result: &mut Fit) {
        let Some(gravity) = self.gravity else { return };
        let name = Term::GravitySine.name(self.coordinate);
        let terms = match gravity {
            Gravity::Present(terms) => terms,
            Gravity::Absent { why, .. } => {
                result.parameters.push(Parameter::unidentified(OBJECT, name, self.samples(), why));
                return;
            }
        };
        let Some(i) = self.index(Term::GravitySine) else { return };
        let cosine = self.index(Term::GravityCosine).filter(|_| terms.contains(&Term::GravityCosine));
        let (a, b) = (self.fit.values[i], cosine.map_or(0.0, |j| self.fit.values[j]));
        let moment = a.hypot(b).max(f64::MIN_POSITIVE);
        // First-order propagation through √(a² + b²) and atan2, the correlation of the two included.
        let errors = |c: &DMatrix<f64>| {
            let (aa, bb, ab) = (c[(i, i)], cosine.map_or(0.0, |j| c[(j, j)]), cosine.map_or(0.0, |j| c[(i, j)]));
            let along = a * a * aa + b * b * bb + 2.0 * a * b * ab;
            let across = b * b * aa + a * a * bb - 2.0 * a * b * ab;
            (along.max(0.0).sqrt() / moment, across.max(0.0).sqrt() / (moment * moment))
        };
        let (stated, drawn) = (errors(&self.fit.covariance), self.resampled.map(|drawn| errors(drawn.covariance())));
        let how = "least squares: the part of the force that follows the sine of the angle";
        let found = Parameter::identified(OBJECT, name, moment, stated.0, self.samples(), how);
        result.parameters.push(found.with_bootstrap(drawn.map(|d| d.0)));
        let how = "angle at which the mechanism hangs at rest, in the recording's coordinate";
        let found = Parameter::identified(OBJECT, PHASE, (-b).atan2(a), stated.1, self.samples(), how);
        result.parameters.push(found.with_bootstrap(drawn.map(|d| d.1)));
    }
}

/// Copies the values stated in the sidecar into the result.
pub fn push_known(result: &mut Fit, known: &Known, coordinate: Coordinate) {
    let how = "given in the sidecar, not estimated";
    for &(term, value) in &known.values {
        match term {
            Term::GravityCosine => {}
            Term::GravitySine => {
                let moment = value.hypot(known.value(Term::GravityCosine).unwrap_or(0.0));
                result.parameters.push(Parameter::identified(OBJECT, "gravity_moment_Nm", moment, 0.0, 0, how));
            }
            _ => result.parameters.push(Parameter::identified(OBJECT, term.name(coordinate), value, 0.0, 0, how)),
        }
    }
}
