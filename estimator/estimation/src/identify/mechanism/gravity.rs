//! Does a turning mechanism carry weight off its axis? Decided by evidence, against a spring as the rival.
//!
//! All models are judged with the noise of the richest one. Without gravity, its effect is a slow residual, which looks
//! like few independent samples and hides the very effect in question (`facts/diagnosis.md`, step 5).

use super::parameters::{Known, Term};
use super::regress::System;
use super::signals::Piece;
use crate::identify::limits::CLEARLY_SIGNIFICANT;
use crate::regression::linear::LinearFit;
use foundation::estimate::EstimateError;

/// Least evidence for a gravity moment: twice the log-likelihood ratio, less the BIC penalty.
/// Source: Kass & Raftery 1995: above 10 it is "very strong".
const EVIDENCE: f64 = 10.0;
/// Smallest range of the angle in which sine and line can differ, rad.
/// Choice: halved or doubled, none of 4 answers changes.
const MIN_RANGE_RAD: f64 = 0.3;

/// Decision about gravity.
#[derive(Clone, Debug)]
pub enum Gravity {
    /// These terms belong to the model.
    Present(Vec<Term>),
    /// They do not, for this reason. The shift of the base terms by an overlooked moment is their `doubt`.
    Absent {
        /// The reason.
        why: String,
        /// One standard deviation for each base term, in its unit: 0 where the data exclude gravity.
        doubt: Vec<f64>,
    },
}

/// The rival models of one recording.
struct Models {
    plain: LinearFit,
    hanging: LinearFit,
    any: LinearFit,
    spring: LinearFit,
    /// Independent samples in the noise of the richest model.
    independent: f64,
}

impl Models {
    fn new(pieces: &[Piece], base: &[Term], known: &Known) -> Result<Self, EstimateError> {
        let fit = |extra: &[Term]| -> Result<LinearFit, EstimateError> {
            let terms: Vec<Term> = base.iter().chain(extra).copied().collect();
            System::stack(pieces, &terms, known, Piece::applied_force).solve()
        };
        let richest = fit(&[Term::GravitySine, Term::GravityCosine, Term::Spring])?;
        Ok(Self {
            plain: fit(&[])?,
            hanging: fit(&[Term::GravitySine])?,
            any: fit(&[Term::GravitySine, Term::GravityCosine])?,
            spring: fit(&[Term::Spring])?,
            independent: richest.effective_samples.max(2.0),
        })
    }

    /// Twice the log-likelihood ratio of `to` against the base model, less the BIC penalty.
    fn gain(&self, to: &LinearFit, parameters: f64) -> f64 {
        let ratio = self.plain.rms / to.rms.max(1e-12 * self.plain.rms).max(f64::MIN_POSITIVE);
        2.0 * self.independent * ratio.ln() - parameters * self.independent.ln()
    }

    /// Shift of each base term if there were gravity, weighted with the probability that there is (Bayesian model
    /// averaging, Hoeting et al. 1999; even odds before). If the arc is too `short` to tell the two apart, a model is
    /// not less likely for having a term more: the data could not have spoken for it.
    fn doubt(&self, base: usize, short: bool) -> Vec<f64> {
        let count = |parameters: f64| if short { 0.0 } else { parameters };
        let rivals =
            [(&self.hanging, self.gain(&self.hanging, count(1.0))), (&self.any, self.gain(&self.any, count(2.0)))];
        let weight = |gain: f64| (0.5 * gain.min(100.0)).exp();
        let total = 1.0 + rivals.iter().map(|(_, gain)| weight(*gain)).sum::<f64>();
        let spread = |fit: &LinearFit, j: usize| {
            let moved = fit.values[j] - self.plain.values[j];
            let wider = (fit.std_errors[j].powi(2) - self.plain.std_errors[j].powi(2)).max(0.0);
            if fit.identified[j] { moved * moved + wider } else { f64::INFINITY }
        };
        let variance = |j: usize| rivals.iter().map(|(fit, gain)| weight(*gain) / total * spread(fit, j)).sum::<f64>();
        (0..base).map(|j| variance(j).sqrt()).collect()
    }
}

/// Compares the base model with a gravity moment from hanging, with one of any phase, and with a spring.
pub fn decide(pieces: &[Piece], base: &[Term], known: &Known) -> Result<Gravity, EstimateError> {
    let models = Models::new(pieces, base, known)?;
    let (low, high) = range(pieces);
    let short = high - low < MIN_RANGE_RAD;
    let absent = |why: String| Ok(Gravity::Absent { why, doubt: models.doubt(base.len(), short) });
    if short {
        return absent(format!(
            "the angle covers only {:.2} rad, too little to tell gravity from an offset",
            high - low
        ));
    }
    let (alone, phased) = (models.gain(&models.hanging, 1.0), models.gain(&models.any, 2.0));
    let clear = stands_out(&models.hanging, base.len()) || stands_out(&models.any, base.len());
    if alone.max(phased) < EVIDENCE || !clear {
        return absent("no gravity moment stands out of the residual".to_owned());
    }
    if models.gain(&models.spring, 1.0) > alone.max(phased) + 1e-9 {
        return absent("the force grows with the angle like a spring rather than like gravity".to_owned());
    }
    let (hanging, any) = (vec![Term::GravitySine], vec![Term::GravitySine, Term::GravityCosine]);
    Ok(Gravity::Present(if phased > alone + EVIDENCE { any } else { hanging }))
}

/// True if the terms from `base` on differ from zero by [`CLEARLY_SIGNIFICANT`] standard errors. Sine and cosine count together,
/// because over a short arc either may stand for part of the other.
fn stands_out(fit: &LinearFit, base: usize) -> bool {
    let p = fit.values.len();
    if (base..p).any(|i| fit.t_value(i).abs() > CLEARLY_SIGNIFICANT) {
        return true;
    }
    let extra = p - base;
    let covariance = fit.covariance.view((base, base), (extra, extra)).into_owned();
    let values = nalgebra::DVector::from_column_slice(&fit.values[base..]);
    let distance = covariance.try_inverse().map_or(0.0, |inverse| (values.transpose() * inverse * &values)[(0, 0)]);
    distance > CLEARLY_SIGNIFICANT * CLEARLY_SIGNIFICANT + 2.0 * CLEARLY_SIGNIFICANT
}

/// Smallest and largest angle over the usable samples.
pub fn range(pieces: &[Piece]) -> (f64, f64) {
    let used = pieces.iter().flat_map(|p| p.motion.iter().zip(&p.usable).filter(|(_, u)| **u).map(|(m, _)| m.position));
    used.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), q| (low.min(q), high.max(q)))
}
