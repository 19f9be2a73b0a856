//! A driven motion that is nearly a free swing: gravity alone explains its acceleration.
//!
//! The ratio of gravity moment and inertia is then known, and little else. Inertia rests on the small part of the
//! acceleration that the force explains. Regression of the force on the motion takes its noise for noise of the force;
//! regression of the acceleration on the force takes it for noise of the acceleration. The truth lies between the two
//! (Frisch 1934), so that half of their distance joins the errors.

use super::parameters::{Known, Term};
use super::regress::System;
use super::signals::{CUTOFF_OVER_MOTION, Piece, Raw, pieces_below};
use crate::identify::limits::CLEARLY_SIGNIFICANT;
use crate::regression::linear::{LinearFit, least_squares, least_squares_values};
use foundation::estimate::EstimateError;
use std::f64::consts::TAU;

/// Terms beside the inertia.
const OTHERS: [Term; 5] = [Term::Viscous, Term::Coulomb, Term::Offset, Term::GravitySine, Term::GravityCosine];

/// The same with a spring: a regular stroke of a hand goes with the place as well, but not with its sine.
const SPRING: [Term; 4] = [Term::Viscous, Term::Coulomb, Term::Offset, Term::Spring];

/// A fit of a swing.
pub struct Swing {
    /// Segments behind the filter at which force and acceleration go together best.
    pub pieces: Vec<Piece>,
    /// Regressors and target of the fit.
    pub system: System,
    /// The solution of `system`, errors of the acceleration included.
    pub solution: LinearFit,
    /// Gravity moment over inertia and its standard error, 1/s².
    pub ratio: [f64; 2],
    /// Share of the acceleration beside gravity and friction that the force explains.
    pub coherence: f64,
}

impl Swing {
    /// `pieces`: the segments behind the usual filter. `None` if the motion is no swing, or its inertia is known.
    ///
    /// # Errors
    /// Those of a least-squares fit.
    pub fn of(raws: &[Raw], pieces: &[Piece], known: &Known) -> Result<Option<Self>, EstimateError> {
        // Recorded swings of a motor-driven pendulum leave 0.002 to 0.05; a lever in a hand leaves half and more.
        let left = rest(pieces, &OTHERS)?;
        if !known.values.is_empty() || left > CLEARLY_SIGNIFICANT.powi(-2) || left > rest(pieces, &SPRING)? {
            return Ok(None);
        }
        let highest_hz = pieces.iter().map(|p| p.cutoff_hz).fold(0.0, f64::max);
        let mut best = Self::at(pieces.to_vec())?;
        // In the steps in which the usual cut-off is sought.
        for share in std::iter::successors(Some(0.8), |share| Some(share * 0.8)) {
            let below = pieces_below(raws, pieces, share)?;
            if share * highest_hz < CUTOFF_OVER_MOTION * motion_hz(&below) {
                break;
            }
            let other = Self::at(below)?;
            if other.coherence > best.coherence {
                best = other;
            }
        }
        Ok(Some(best))
    }

    fn at(pieces: Vec<Piece>) -> Result<Self, EstimateError> {
        let terms: Vec<Term> = std::iter::once(Term::Inertia).chain(OTHERS).collect();
        // A force that follows the direction of motion shows its effect at the reversals alone.
        let system =
            System { is_weighted: false, ..System::stack(&pieces, &terms, &Known::default(), Piece::applied_force) };
        let mut solution = system.solve()?;
        // Acceleration as a function of the force and of everything else.
        let (inertia, others) = (&system.columns[0], &system.columns[1..]);
        let causes: Vec<Vec<f64>> = std::iter::once(&system.target).chain(others).cloned().collect();
        let reverse = least_squares(&causes, inertia, None)?;
        let per_inertia = reverse.values[0];
        // The force's own fast noise does not count for noise of the acceleration.
        let fast = pieces.iter().map(|p| p.force_noise.powi(2)).sum::<f64>() / pieces.len().max(1) as f64;
        let open = (1.0 - fast / solution.rms.powi(2).max(f64::MIN_POSITIVE)).max(0.0);
        let apart: Vec<f64> = if per_inertia > 0.0 {
            let other = |k: usize| if k == 0 { per_inertia.recip() } else { -reverse.values[k] / per_inertia };
            solution.values.iter().enumerate().map(|(k, value)| 0.5 * open * (other(k) - value).abs()).collect()
        } else {
            // Any size that the force could hold.
            let size = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>().sqrt();
            system.columns.iter().map(|c| size(&system.target) / size(c).max(f64::MIN_POSITIVE)).collect()
        };
        let coherence = (solution.values[0].max(0.0) * per_inertia.max(0.0)).min(1.0);
        solution.widen(&apart);
        let moment_over_inertia = |values: &[f64]| values[4].hypot(values[5]) / values[0];
        let ratio = reverse.values[4].hypot(reverse.values[5]);
        let mut ratio_error = reverse.std_errors[4];
        // A digital drive computes for one sample and holds its output for another; a sensor may be as late.
        for shift in [-2, 2] {
            let late = |p: &Piece| later(&p.applied_force(), shift);
            let target = System::stack(&pieces, &terms, &Known::default(), late).target;
            let other = least_squares_values(&system.columns, &target, None)?.values;
            // Half of each, because the two are one error.
            let share = 6.0_f64.sqrt().recip();
            let moved = other.iter().zip(&solution.values).map(|(o, v)| share * (o - v));
            solution.widen(&moved.collect::<Vec<f64>>());
            ratio_error = ratio_error.hypot(share * (moment_over_inertia(&other) - ratio));
        }
        Ok(Self { ratio: [ratio, ratio_error], coherence, solution, system, pieces })
    }

    /// One sentence about the motion, for the warnings.
    pub fn sentence(&self) -> String {
        let [ratio, error] = self.ratio;
        let known = format!(
            "the motion is nearly a free swing: gravity explains its acceleration, and the recording shows the gravity moment over the inertia, {ratio:.2} ± {error:.2} 1/s²"
        );
        let share = 100.0 * self.coherence;
        if self.coherence < 0.5 {
            format!(
                "{known}; of the rest of the acceleration the force explains {share:.0} %, as if a controller made it out of the motion: inertia and friction cannot be told apart; drive it with a force that does not follow the motion"
            )
        } else {
            format!("{known}; of the rest of the acceleration the force explains {share:.0} %")
        }
    }
}

/// Share of the acceleration's power that these terms leave.
fn rest(pieces: &[Piece], terms: &[Term]) -> Result<f64, EstimateError> {
    let acceleration = |p: &Piece| p.motion.iter().map(|m| m.acceleration).collect();
    let system = System::stack(pieces, terms, &Known::default(), acceleration);
    let fit = least_squares(&system.columns, &system.target, None)?;
    let power = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>();
    Ok(power(&fit.residuals) / power(&system.target).max(f64::MIN_POSITIVE))
}

/// These values by one sample later or earlier.
fn later(values: &[f64], shift: isize) -> Vec<f64> {
    let last = values.len().saturating_sub(1);
    (0..values.len()).map(|i| values[i.saturating_add_signed(-shift).min(last)]).collect()
}

/// Frequency at which most of the motion takes place.
pub fn motion_hz(pieces: &[Piece]) -> f64 {
    rms(pieces, |m| m.acceleration) / (TAU * rms(pieces, |m| m.velocity)).max(f64::MIN_POSITIVE)
}

pub fn rms(pieces: &[Piece], of: impl Fn(&haptics::law::Motion) -> f64) -> f64 {
    let square = pieces.iter().map(|p| p.rms(&of).powi(2)).sum::<f64>();
    (square / pieces.len().max(1) as f64).sqrt()
}
