//! Does a turning mechanism carry weight off its axis? Decided by evidence, against a spring as the rival.

use super::regress::System;
use super::signals::Piece;
use super::terms::{Known, Term};
use crate::estimate::EstimateError;
use crate::identify::linear::LinearFit;

/// Evidence (log-likelihood ratio less the BIC penalty) that a gravity moment must bring. 10 is "very strong" (Kass and
/// Raftery 1995).
const EVIDENCE: f64 = 10.0;
/// … and a value this many standard errors from zero.
const CLEAR_T: f64 = 4.0;
/// Smallest range of the angle in which sine and line can differ, rad.
const MIN_RANGE_RAD: f64 = 0.3;

/// What was found.
#[derive(Clone, Debug)]
pub enum Gravity {
    /// These terms belong to the model.
    Present(Vec<Term>),
    /// They do not, for this reason.
    Absent(String),
}

/// Compares the base model with a gravity moment from hanging, with one of any phase, and with a spring.
pub fn decide(pieces: &[Piece], base: &[Term], known: &Known) -> Result<Gravity, EstimateError> {
    let (low, high) = range(pieces);
    if high - low < MIN_RANGE_RAD {
        let why = format!("the angle covers only {:.2} rad, too little to tell gravity from an offset", high - low);
        return Ok(Gravity::Absent(why));
    }
    let fit = |extra: &[Term]| -> Result<LinearFit, EstimateError> {
        let terms: Vec<Term> = base.iter().chain(extra).copied().collect();
        System::stack(pieces, &terms, known, |p| p.force.clone().unwrap_or_default()).solve()
    };
    let plain = fit(&[])?;
    let hanging = [Term::GravitySine];
    let any = [Term::GravitySine, Term::GravityCosine];
    let (one, two, spring) = (fit(&hanging)?, fit(&any)?, fit(&[Term::Spring])?);
    let independent = one.effective_samples.min(two.effective_samples).max(2.0);
    let gain = |from: &LinearFit, to: &LinearFit, parameters: f64| {
        2.0 * independent * (from.rms / to.rms.max(1e-12 * from.rms).max(f64::MIN_POSITIVE)).ln()
            - parameters * independent.ln()
    };
    let (alone, phased) = (gain(&plain, &one, 1.0), gain(&plain, &two, 2.0));
    let clear = |f: &LinearFit| (base.len()..f.values.len()).any(|i| f.t_value(i).abs() > CLEAR_T);
    if alone.max(phased) < EVIDENCE || !(clear(&one) || clear(&two)) {
        return Ok(Gravity::Absent("no gravity moment stands out of the residual".to_owned()));
    }
    if gain(&plain, &spring, 1.0) > alone.max(phased) + 1e-9 {
        return Ok(Gravity::Absent("the force grows with the angle like a spring rather than like gravity".to_owned()));
    }
    Ok(Gravity::Present(if phased > alone + EVIDENCE { any.to_vec() } else { hanging.to_vec() }))
}

/// Smallest and largest angle over the usable samples.
pub fn range(pieces: &[Piece]) -> (f64, f64) {
    let used = pieces.iter().flat_map(|p| p.motion.iter().zip(&p.usable).filter(|(_, u)| **u).map(|(m, _)| m.position));
    used.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), q| (low.min(q), high.max(q)))
}
