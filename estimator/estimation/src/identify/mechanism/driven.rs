//! Motion under a measured force.

use super::gravity::{self, Gravity};
use super::parameters::{CLOCK_TOLERANCE, Known, Term};
use super::regress::{Shown, System, shown};
use super::report::{Material, OBJECT};
use super::signals::{Piece, Raw};
use super::swing::Swing;
use super::zero_step::OF_POWER;
use super::{offset, path};
use crate::identify::limits::{HELD_OUT, ROUNDING};
use crate::regression::bootstrap::block_bootstrap;
use crate::regression::linear::LinearFit;
use crate::regression::long_run_variance::HALF_INTERVAL;
use foundation::estimate::{EstimateError, Fit, Parameter, Quality};
use haptics::law::Coordinate;
use haptics::recording::Recording;
use std::borrow::Cow;

/// Fits a mechanism to its motion under a force.
pub fn fit(raws: &[Raw], pieces: &[Piece], known: &Known, recordings: &[Recording]) -> Result<Fit, EstimateError> {
    let seen = shown(pieces, known, &BASE, Term::Coulomb);
    if let Some(nothing) = offset::told_nothing(raws, pieces, &seen, known) {
        return Ok(nothing);
    }
    let can_hang = raws[0].coordinate == Coordinate::Angular
        && known.value(Term::GravitySine).is_none()
        && recordings.first().is_some_and(|first| path::up(first).is_some());
    let mut solved = Solved::of(raws, pieces, known, (seen.clone(), can_hang))?;
    if solved.friction_falls() {
        let mut seen = seen;
        seen.hide(Term::Viscous, FRICTION_FALLS);
        seen.drop(Term::Viscous);
        solved = Solved::of(raws, pieces, known, (seen, can_hang))?;
    }
    let mut result = solved.report(raws[0].coordinate, known);
    if recordings.iter().any(contradicts_its_clock) {
        for parameter in result.parameters.iter_mut().filter(|p| is_by_rate(&p.name)) {
            *parameter = Parameter::unidentified(OBJECT, &parameter.name, parameter.samples, CLOCK);
        }
    }
    Ok(result)
}

/// The terms of the base model.
const BASE: [Term; 4] = [Term::Inertia, Term::Viscous, Term::Coulomb, Term::Offset];
const FRICTION_FALLS: &str =
    "the friction falls as the speed rises, and viscous friction cannot; Stribeck friction does";
const CLOCK: &str =
    "the recorded rate contradicts the clock and the position (see the warning); correct one of them first";

/// True if a rate of this recording does not fit its position and its clock.
pub fn contradicts_its_clock(recording: &Recording) -> bool {
    let is_rate = |column: &str| column.starts_with("dq_");
    recording.warnings.iter().any(|w| w.kind == "unit" && w.column.as_deref().is_some_and(is_rate))
}

/// True for parameters whose values depend on the clock.
fn is_by_rate(name: &str) -> bool {
    ["mass_kg", "inertia_kg_m2", "viscous_N_s_m", "viscous_Nm_s"].contains(&name)
}

/// A solved model of the motion.
struct Solved<'a> {
    pieces: Cow<'a, [Piece]>,
    seen: Shown,
    gravity: Option<Gravity>,
    system: System,
    solution: LinearFit,
    /// Factor on each error for a residual that repeats with the motion; empty for a swing.
    repeated: Vec<f64>,
    /// Sentence and ratio of a swing.
    swing: Option<(String, [f64; 2])>,
}

impl<'a> Solved<'a> {
    /// `can_hang`: gravity may act.
    fn of(
        raws: &[Raw],
        pieces: &'a [Piece],
        known: &Known,
        (mut seen, can_hang): (Shown, bool),
    ) -> Result<Self, EstimateError> {
        let swing = if can_hang && seen.fitted == BASE { Swing::of(raws, pieces, known)? } else { None };
        if swing.is_none() {
            seen.fitted.extend(pieces.iter().any(|piece| !piece.zero_steps.is_empty()).then_some(Term::ZeroStep));
            seen.fitted.extend(pieces.iter().any(|piece| piece.is_late).then_some(Term::Delay));
        }
        let gravity = match &swing {
            Some(_) => Some(Gravity::Present(vec![Term::GravitySine, Term::GravityCosine])),
            None if can_hang => Some(gravity::decide(pieces, &seen.fitted, known)?),
            None => None,
        };
        if let Some(Gravity::Present(terms)) = &gravity {
            seen.fitted.extend(terms);
        }
        let told = swing.as_ref().map(|swing| (swing.sentence(), swing.ratio));
        let (pieces, system, (mut solution, repeated)) = if let Some(Swing { pieces, system, solution, .. }) = swing {
            (Cow::Owned(pieces), system, (solution, Vec::new()))
        } else {
            let system = System::stack(pieces, &seen.fitted, known, Piece::applied_force);
            let solved = system.solve_repeated()?;
            (Cow::Borrowed(pieces), system, solved)
        };
        if let Some(Gravity::Absent { doubt, .. }) = &gravity {
            solution.widen(doubt);
        }
        solution.widen(&clock_errors(&system.terms, &solution.values));
        Ok(Self { pieces, seen, gravity, system, solution, repeated, swing: told })
    }

    /// Value of a term in units of half its 95 % interval; `None` if it is not fitted.
    fn size(&self, term: Term) -> Option<f64> {
        let i = self.system.terms.iter().position(|t| *t == term)?;
        Some(self.solution.values[i] / (HALF_INTERVAL * self.solution.std_errors[i]).max(f64::MIN_POSITIVE))
    }

    fn is_negative(&self, term: Term) -> bool {
        self.size(term).is_some_and(|size| size < -1.0)
    }

    /// True if the viscous friction alone comes out negative. With a wrong sign of the force, all would.
    fn friction_falls(&self) -> bool {
        let is_dry = self.size(Term::Coulomb).is_some_and(|size| size > 1.0);
        self.swing.is_none() && is_dry && self.is_negative(Term::Viscous) && !self.is_negative(Term::Inertia)
    }

    /// True if the recorded force cannot be the one that moves the mechanism: a negative inertia, beside a friction that
    /// is none. With a wrong sign of the force, both would be negative.
    fn moved_by_another(&self) -> bool {
        self.is_negative(Term::Inertia) && !self.is_negative(Term::Viscous) && !self.is_negative(Term::Coulomb)
    }

    fn report(&self, coordinate: Coordinate, known: &Known) -> Fit {
        let Self { system, solution, .. } = self;
        let rms = |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt();
        let effect: Vec<f64> = system.columns.iter().map(|c| rms(c)).collect();
        let weights = system.weights(solution);
        let resampled = block_bootstrap(&system.columns, &system.target, weights.as_deref(), solution);
        let mut result = Fit { task: "mechanism".to_owned(), ..Fit::default() };
        let material = Material {
            coordinate,
            shown: &self.seen,
            terms: &system.terms,
            fit: solution,
            effect: &effect,
            force_rms: rms(&system.target),
            known,
            resampled: resampled.as_ref(),
            gravity: self.gravity.as_ref(),
        };
        material.push(&mut result);
        result.parameters.extend(self.swing.as_ref().map(|(_, [value, error])| {
            let how = "least squares: the part of the acceleration that follows the sine of the angle";
            Parameter::identified(OBJECT, RATIO, *value, *error, system.target.len(), how)
        }));
        if self.moved_by_another() {
            leave_out_what_is_unsure(&mut result);
        }
        result.correlated = vec![material.correlated()];
        result.quality = quality(&self.pieces, system, solution, coordinate, known);
        result.warnings = self.warnings();
        result.warnings.extend(self.repetition(coordinate));
        let quality = result.quality.as_ref();
        result.warnings.extend(quality.and_then(|quality| self.hardly_explains(quality).or_else(|| quality.misfit())));
        result
    }

    /// One sentence if the fit does not explain half of the force's variance on the rows that are held out.
    fn hardly_explains(&self, quality: &Quality) -> Option<String> {
        let force = &self.system.target;
        let count = force.len() as f64;
        let mean = force.iter().sum::<f64>() / count;
        let variance = force.iter().map(|f| (f - mean).powi(2)).sum::<f64>() / count;
        let left = quality.heldout_rms.powi(2);
        (left > OF_POWER * variance && left > (ROUNDING * mean).powi(2)).then(|| {
            format!(
                "the fit explains {:.0} % of the variance of the force on the {:.0} % held out, so that the values tell little: \
                 check that force and motion belong together (columns, signs, clocks), and run the diagnosis",
                100.0 * (1.0 - left / variance).max(0.0),
                100.0 * HELD_OUT
            )
        })
    }

    /// One sentence if the residual repeats with the motion.
    fn repetition(&self, coordinate: Coordinate) -> Option<String> {
        let terms = self.system.terms.iter().zip(&self.repeated);
        let (term, factor) = terms.filter(|(_, factor)| **factor > 1.0).max_by(|a, b| a.1.total_cmp(b.1))?;
        Some(format!(
            "the residual repeats with the motion, as that of a rounded position, a late channel or a missing force does: the error \
             of `{}` is {factor:.1} times as large as noise would make it; vary the motion",
            term.name(coordinate)
        ))
    }

    fn warnings(&self) -> Vec<String> {
        let mut found = Vec::new();
        if self.moved_by_another() {
            found.push(format!("{MOVED_BY_ANOTHER}; record the force that moves it, and check its clock, because a late force shows the same"));
        } else if [Term::Inertia, Term::Viscous, Term::Coulomb].into_iter().any(|term| self.is_negative(term)) {
            found.push(
                "inertia or friction comes out negative: check the sign of the force column (\"sign\" in the sidecar)"
                    .to_owned(),
            );
        }
        if self.seen.hidden.iter().any(|(_, why)| why == FRICTION_FALLS) {
            found.push(FRICTION_FALLS.to_owned());
        }
        if let Some(piece) = self.pieces.first() {
            found.push(format!(
                "velocity and acceleration are derived from the recording with a zero-phase filter at {:.1} Hz, which the force also goes through",
                piece.cutoff_hz
            ));
        }
        found.extend(self.swing.as_ref().map(|(sentence, _)| sentence.clone()));
        found
    }
}

/// Name of a swing's ratio in the results.
const RATIO: &str = "gravity_moment_per_inertia_rad_s2";

/// Reason why nothing but the force itself is told.
const MOVED_BY_ANOTHER: &str = "the inertia comes out negative and the friction does not: another force moves it, as a hand does, and the recorded one follows the motion, as a controller's does";

/// Leaves out the values that may as well be zero. The others describe the recorded force.
fn leave_out_what_is_unsure(result: &mut Fit) {
    for parameter in &mut result.parameters {
        let is_sure =
            parameter.value.zip(parameter.std_error).is_some_and(|(v, error)| v.abs() > HALF_INTERVAL * error);
        if !is_sure {
            *parameter = Parameter::unidentified(OBJECT, &parameter.name, parameter.samples, MOVED_BY_ANOTHER);
        }
    }
}

/// Errors by the clock's tolerance of parameters of a motion under a measured force: inertia goes as time squared,
/// viscous friction as time.
fn clock_errors(terms: &[Term], values: &[f64]) -> Vec<f64> {
    let powers = |term: &Term| Term::GravitySine.powers_of_time() - term.powers_of_time();
    terms.iter().zip(values).map(|(term, value)| (value * CLOCK_TOLERANCE * powers(term)).abs()).collect()
}

/// Refit on the first 70 % of every segment, held-out RMS on the last 30 %. Defects of the force channel
/// are taken from the whole fit, because one part may be without them.
fn quality(
    pieces: &[Piece],
    system: &System,
    fit: &LinearFit,
    coordinate: Coordinate,
    known: &Known,
) -> Option<Quality> {
    let system = system.without_defects(fit);
    let early = system.part(|place| place < 1.0 - HELD_OUT).solve().ok()?;
    let late = system.part(|place| place >= 1.0 - HELD_OUT);
    let n = late.target.len();
    if n == 0 {
        return None;
    }
    let root = |sum: f64| (sum / n as f64).sqrt();
    let heldout_rms = late.residual_rms(&early.values);
    // Relative to the force as measured, its known part included.
    let nothing_known =
        System::stack(pieces, &[], &Known::default(), Piece::applied_force).part(|place| place >= 1.0 - HELD_OUT);
    debug_assert!(known.values.is_empty() || nothing_known.target.len() == n, "the same samples either way");
    let force = root(nothing_known.target.iter().map(|f| f * f).sum());
    let worst_force = pieces.iter().map(|piece| piece.force_noise).fold(0.0, f64::max);
    Some(Quality {
        noise: Some(worst_force.hypot(late.noise_by_motion(&early.values))),
        rms: fit.rms,
        heldout_rms,
        heldout_relative: if force > 0.0 { heldout_rms / force } else { f64::NAN },
        heldout_share: HELD_OUT,
        unit: if coordinate == Coordinate::Linear { "N" } else { "Nm" }.to_owned(),
    })
}
