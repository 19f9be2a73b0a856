//! The fit itself: stacked segments, effective-variance weights, and the terms that the motion can show.

use super::parameters::{Known, Term};
use super::signals::{Piece, StateNoise};
use crate::regression::linear::{LinearFit, least_squares};
use crate::regression::repetition;
use foundation::estimate::EstimateError;
use nalgebra::{DMatrix, DVector};

/// Part of a column that no other column explains, as a share, below which two terms merge.
/// Choice: halved or doubled, none of 5 answers changes.
const DISTINCT: f64 = 0.05;
/// Least filtered direction of motion of a sample away from a reversal, of 1.
/// Choice: halved or doubled, none of 5 answers changes.
const STEADY_DIRECTION: f64 = 0.98;
/// Least share of the moving time in each direction for a reversal to count.
/// Choice: halved or doubled, none of 5 answers changes.
const REVERSAL_SHARE: f64 = 0.02;
/// Least share of the way in each direction for a reversal to count.
/// Choice: halved or doubled, none of 5 answers changes.
const REVERSAL_WAY: f64 = 0.01;
/// Standard deviation of the place of a reversal between two samples, in samples.
/// Derived: 1/√12, that of an even spread over one sample.
const SKEW_SAMPLES: f64 = 0.29;
/// Share of its usual speed below which a mechanism or joint may stick.
/// Choice: halved or doubled, none of 5 answers changes.
pub(super) const STICKING_SHARE: f64 = 0.015;
/// Number of rounds of weighting.
/// Choice: halved or doubled, none of 5 answers changes.
pub(super) const WEIGHTING_ROUNDS: usize = 3;
/// Half the longest stop that a filter hides, in periods of its cut-off.
/// Choice: halved, 2 of 5 answers change; doubled, 3 of 5 answers change.
const UNSEEN_STOP: f64 = 0.4;
/// Decay rate of the reach of the filter, per period of its cut-off. It lies between its main lobe and its ringing
/// (2.4), where masses of generated recordings with many stops have no bias and the errors are least.
/// Choice: halved or doubled, none of 5 answers changes.
const REACH: f64 = 4.5;
/// Least velocity of a motion, in multiples of the velocity's noise.
/// Choice: halved or doubled, none of 5 answers changes.
const MOTION_RATIO: f64 = 2.0;

/// Regressors, target and weights of a fit, over the usable samples of all segments.
#[derive(Clone, Debug)]
pub struct System {
    /// The terms that are estimated, in the order of the columns.
    pub terms: Vec<Term>,
    /// One column a term.
    pub columns: Vec<Vec<f64>>,
    /// Force less its known part, N or N m.
    pub target: Vec<f64>,
    /// Share of 1 by which the direction of motion is uncertain, 0 … 1.
    pub uncertainty: Vec<f64>,
    /// Filtered position of each sample, m or rad, and the noise of the motion there: how much the columns are off.
    pub motion: Vec<(f64, StateNoise)>,
    /// Relative uncertainty of that noise.
    pub noise_known_to: f64,
    /// Place of each sample in its recording, 0 … 1: for holding out the end.
    pub place: Vec<f64>,
    /// True if samples near a reversal count less.
    pub is_weighted: bool,
}

impl System {
    /// Stacks the segments for `terms`; `target_of` returns the left-hand side of a segment.
    pub fn stack(pieces: &[Piece], terms: &[Term], known: &Known, target_of: impl Fn(&Piece) -> Vec<f64>) -> Self {
        let mut system = Self {
            terms: terms.to_vec(),
            columns: vec![Vec::new(); terms.len()],
            target: Vec::new(),
            uncertainty: Vec::new(),
            motion: Vec::new(),
            noise_known_to: pieces.iter().map(Piece::noise_known_to).fold(0.0, f64::max),
            place: Vec::new(),
            is_weighted: true,
        };
        for piece in pieces {
            let keep = |values: Vec<f64>| values.into_iter().zip(&piece.usable).filter(|(_, u)| **u).map(|(v, _)| v);
            let mut target = target_of(piece);
            for &(term, value) in &known.values {
                for (t, c) in target.iter_mut().zip(term.column(piece)) {
                    *t -= value * c;
                }
            }
            system.target.extend(keep(target));
            for (column, term) in system.columns.iter_mut().zip(terms) {
                column.extend(keep(term.column(piece)));
            }
            system.uncertainty.extend(keep(direction_uncertainty(piece)));
            let used = piece.motion.iter().zip(&piece.usable).filter(|(_, u)| **u);
            system.motion.extend(used.map(|(m, _)| (m.position, piece.noise)));
            let n = piece.motion.len() as f64;
            system.place.extend(keep((0..piece.motion.len()).map(|i| i as f64 / n).collect()));
        }
        system
    }

    /// Solves with weights that silence the samples whose direction is uncertain (`facts/diagnosis.md`, step 3), and
    /// takes out the attenuation by noise in the regressors.
    pub fn solve(&self) -> Result<LinearFit, EstimateError> {
        let (fit, weights) = self.weighted()?;
        Ok(fit.without_attenuation(&self.column_noise(weights.as_deref()), self.noise_known_to))
    }

    /// The same with errors that count a residual that repeats with the motion, and the factor on each of them.
    pub fn solve_repeated(&self) -> Result<(LinearFit, Vec<f64>), EstimateError> {
        let (mut fit, weights) = self.weighted()?;
        let repeated = repetition::factors(&fit, &self.columns, weights.as_deref());
        fit.scale_errors(&repeated);
        Ok((fit.without_attenuation(&self.column_noise(weights.as_deref()), self.noise_known_to), repeated))
    }

    /// The fit, and the weights that it was solved with.
    fn weighted(&self) -> Result<(LinearFit, Option<Vec<f64>>), EstimateError> {
        let mut fit = least_squares(&self.columns, &self.target, None)?;
        let mut weights = None;
        for _ in 0..WEIGHTING_ROUNDS {
            weights = self.weights(&fit);
            let Some(weights) = weights.as_deref() else { break };
            fit = least_squares(&self.columns, &self.target, Some(weights))?;
        }
        Ok((fit, weights))
    }

    /// Weights of the samples after `fit`; `None` if no term depends on the direction.
    pub fn weights(&self, fit: &LinearFit) -> Option<Vec<f64>> {
        let dry = self.terms.iter().position(|t| *t == Term::Coulomb).filter(|_| self.is_weighted)?;
        let level = fit.values[dry].powi(2);
        // The weighted RMS would fall with every round toward that of the few rows that fit best.
        let base = self.rms_in_motion(&fit.values).unwrap_or(fit.rms);
        let floor = base.powi(2).max(1e-12 * level).max(f64::MIN_POSITIVE);
        Some(self.uncertainty.iter().map(|u| 1.0 / (1.0 + level * u / floor)).collect())
    }

    /// RMS residual with these values of the terms; all rows count the same.
    pub fn residual_rms(&self, values: &[f64]) -> f64 {
        let squares: f64 =
            self.target.iter().enumerate().map(|(i, target)| (target - self.predicted(i, values)).powi(2)).sum();
        (squares / self.target.len().max(1) as f64).sqrt()
    }

    fn predicted(&self, row: usize, values: &[f64]) -> f64 {
        self.columns.iter().zip(values).map(|(c, v)| c[row] * v).sum()
    }

    /// RMS residual that noise in the motion makes with these values of the terms.
    pub fn noise_by_motion(&self, values: &[f64]) -> f64 {
        let values = DVector::from_column_slice(values);
        (values.dot(&(self.column_noise(None) * &values)) / self.target.len().max(1) as f64).sqrt()
    }

    /// Σ wᵢ E[eᵢ eᵢᵀ] of the errors e in the columns that come from noise in the motion.
    fn column_noise(&self, weights: Option<&[f64]>) -> DMatrix<f64> {
        let p = self.terms.len();
        let mut sum = DMatrix::zeros(p, p);
        for (i, (position, noise)) in self.motion.iter().enumerate() {
            let weight = weights.map_or(1.0, |w| w[i]);
            for (j, a) in self.terms.iter().enumerate() {
                let [q, v, acceleration] = a.slopes(*position);
                for (k, b) in self.terms.iter().enumerate() {
                    let other = b.slopes(*position);
                    let both = q * other[0] * noise.position
                        + v * other[1] * noise.velocity
                        + acceleration * other[2] * noise.acceleration
                        + (q * other[2] + acceleration * other[0]) * noise.position_acceleration;
                    sum[(j, k)] += weight * both;
                }
            }
        }
        sum
    }

    /// The samples for which `keep(place)` holds.
    pub fn part(&self, keep: impl Fn(f64) -> bool) -> Self {
        let kept: Vec<bool> = self.place.iter().map(|p| keep(*p)).collect();
        self.filtered(&kept)
    }

    /// The system with the effects of the force channel's defects, as fitted, taken from the target.
    pub fn without_defects(&self, fit: &LinearFit) -> Self {
        let mut rest = self.clone();
        for j in (0..self.terms.len()).rev().filter(|&j| self.terms[j].law().is_none()) {
            rest.terms.remove(j);
            let column = rest.columns.remove(j);
            rest.target.iter_mut().zip(column).for_each(|(target, c)| *target -= fit.values[j] * c);
        }
        rest
    }

    /// True for each row away from reversals, where the filter has not mixed the two directions; `None` if they are few, or
    /// without Coulomb friction.
    fn in_motion(&self) -> Option<Vec<bool>> {
        let dry = self.terms.iter().position(|t| *t == Term::Coulomb)?;
        let kept: Vec<bool> = self.columns[dry].iter().map(|c| c.abs() > STEADY_DIRECTION).collect();
        (10 * kept.iter().filter(|k| **k).count() >= kept.len()).then_some(kept)
    }

    /// RMS residual of the rows in motion with these values of the terms; `None` if they are few.
    fn rms_in_motion(&self, values: &[f64]) -> Option<f64> {
        let kept = self.in_motion()?;
        let rows = (0..kept.len()).filter(|&i| kept[i]);
        let squares: f64 = rows.clone().map(|i| (self.target[i] - self.predicted(i, values)).powi(2)).sum();
        Some((squares / rows.count().max(1) as f64).sqrt())
    }

    /// Rows away from reversals, or everything if they are few.
    pub fn steady(&self) -> Self {
        self.in_motion().map_or_else(|| self.clone(), |kept| self.filtered(&kept))
    }

    /// The samples that are `kept`.
    pub fn filtered(&self, kept: &[bool]) -> Self {
        let pick =
            |values: &Vec<f64>| -> Vec<f64> { values.iter().zip(kept).filter(|(_, k)| **k).map(|(v, _)| *v).collect() };
        Self {
            terms: self.terms.clone(),
            columns: self.columns.iter().map(pick).collect(),
            target: pick(&self.target),
            uncertainty: pick(&self.uncertainty),
            motion: self.motion.iter().zip(kept).filter(|(_, k)| **k).map(|(m, _)| *m).collect(),
            noise_known_to: self.noise_known_to,
            place: pick(&self.place),
            is_weighted: self.is_weighted,
        }
    }

    /// For each column: the share of it (root of 1 − R²) that the others do not explain; 0 for an empty column.
    pub fn distinctness(&self) -> Vec<f64> {
        let p = self.terms.len();
        let norm: Vec<f64> = self.columns.iter().map(|c| c.iter().map(|v| v * v).sum::<f64>().sqrt()).collect();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let gram = DMatrix::from_fn(p, p, |i, j| {
            let size = norm[i] * norm[j];
            if size > 0.0 { dot(&self.columns[i], &self.columns[j]) / size } else { f64::from(u8::from(i == j)) }
        });
        // A ridge far below anything that counts keeps the inverse finite.
        let inverse = (gram + DMatrix::identity(p, p) * 1e-12).try_inverse();
        (0..p)
            .map(|j| match &inverse {
                Some(inverse) if norm[j] > 0.0 => (1.0 / inverse[(j, j)]).max(0.0).sqrt(),
                _ => 0.0,
            })
            .collect()
    }
}

/// 1 for an entirely uncertain sign of the motion, 0 for a certain one. It depends on velocity noise, the place of the
/// reversal between two samples, and friction that holds the mechanism at rest.
pub(super) fn direction_uncertainty(piece: &Piece) -> Vec<f64> {
    let blur = |m: &haptics::law::Motion| {
        1.2 * piece.velocity_noise.hypot(SKEW_SAMPLES * m.acceleration * piece.period_s).max(f64::MIN_POSITIVE)
    };
    let slow = STICKING_SHARE * piece.rms(|m| m.velocity);
    // A mechanism that sticks resists with anything up to its friction, and a stop that is shorter than the filter's
    // own time looks like a smooth reversal. The filtered error of such a moment reaches as far as the filter does. All
    // samples within that time share it: one error that comes back so often counts so often.
    let sticking = |m: &haptics::law::Motion| {
        let slow = slow.hypot(UNSEEN_STOP * m.acceleration / piece.cutoff_hz).max(f64::MIN_POSITIVE);
        (1.0 + (m.velocity / slow).powi(2)).powi(-2)
    };
    let stuck = spread(&piece.motion.iter().map(sticking).collect::<Vec<f64>>(), piece.cutoff_hz * piece.period_s);
    let repeats = (1.0 / (piece.cutoff_hz * piece.period_s)).max(1.0);
    let by_noise = |m: &haptics::law::Motion| 1.0 - (m.velocity / blur(m)).tanh().powi(2);
    piece.motion.iter().zip(stuck).map(|(m, stuck)| by_noise(m).max(repeats * stuck * stuck)).collect()
}

/// Spread of `values` by a filter of this cut-off (a share of the rate), decaying to both sides without zeros. The
/// filter's own response rings, and where that of one moment passes through zero, that of the next does not.
fn spread(values: &[f64], cutoff_share: f64) -> Vec<f64> {
    let kept = (-REACH * cutoff_share).exp();
    let before = decaying(values.iter(), kept);
    let after = decaying(values.iter().rev(), kept);
    let share = (1.0 - kept) / (1.0 + kept);
    before.iter().zip(after.iter().rev()).zip(values).map(|((b, a), v)| share * (a + b - v)).collect()
}

/// Running sum of which every step keeps a share.
fn decaying<'a>(values: impl Iterator<Item = &'a f64>, kept: f64) -> Vec<f64> {
    values
        .scan(0.0, |sum, v| {
            *sum = kept * *sum + v;
            Some(*sum)
        })
        .collect()
}

/// Terms that this motion can show, and the reason for each other one.
#[derive(Clone, Debug)]
pub struct Shown {
    /// Terms to fit. [`Term::Offset`] is always among them.
    pub fitted: Vec<Term>,
    /// Terms that have no value of their own, with the reason.
    pub hidden: Vec<(Term, String)>,
}

impl Shown {
    pub(super) fn hide(&mut self, term: Term, why: &str) {
        if !self.hidden.iter().any(|(t, _)| *t == term) {
            self.hidden.push((term, why.to_owned()));
        }
    }

    pub(super) fn drop(&mut self, term: Term) {
        self.fitted.retain(|t| *t != term);
    }
}

/// Looks at the motion: reversals, speed range, acceleration above its noise. `both`: Coulomb friction or offset, whichever stands for both of
/// them where the motion never reverses. Friction knows that it holds back less where it stands; a constant does not.
pub fn shown(pieces: &[Piece], known: &Known, candidates: &[Term], both: Term) -> Shown {
    let free = |t: &Term| known.value(*t).is_none();
    let mut shown = Shown { fitted: candidates.iter().copied().filter(free).collect(), hidden: Vec::new() };
    let has = |s: &Shown, t: Term| s.fitted.contains(&t);
    if !moves(pieces) {
        for term in shown.fitted.clone() {
            shown.hide(term, "the mechanism does not move in this recording");
        }
        shown.fitted.retain(|t| *t == Term::Offset);
        return shown;
    }
    if has(&shown, Term::Inertia) && !pieces.iter().any(|p| p.accelerates) {
        shown.hide(
            Term::Inertia,
            "the acceleration does not stand out of the noise of the positions; accelerate harder",
        );
        shown.drop(Term::Inertia);
    }
    if has(&shown, Term::Coulomb) && has(&shown, Term::Offset) && !reverses(pieces) {
        let why = "the motion never reverses, so Coulomb friction and a constant offset are one; move both ways";
        shown.hide(Term::Coulomb, why);
        shown.hide(Term::Offset, why);
        shown.drop(if both == Term::Coulomb { Term::Offset } else { Term::Coulomb });
    }
    let system = System::stack(pieces, &shown.fitted, &Known::default(), |p| vec![0.0; p.motion.len()]);
    let distinct = system.steady().distinctness();
    let weak = |t: Term| system.terms.iter().position(|x| *x == t).is_some_and(|i| distinct[i] < DISTINCT);
    if weak(Term::Viscous) {
        let why = "the speed hardly varies, so viscous and Coulomb friction are one; vary the speed";
        shown.hide(Term::Viscous, why);
        if has(&shown, Term::Coulomb) {
            shown.hide(Term::Coulomb, why);
        } else {
            shown.hide(Term::Offset, why);
        }
        shown.drop(Term::Viscous);
    }
    let system = System::stack(pieces, &shown.fitted, &Known::default(), |p| vec![0.0; p.motion.len()]);
    let distinct = system.distinctness();
    for (term, share) in system.terms.iter().zip(distinct) {
        if share < 0.4 * DISTINCT {
            shown.hide(*term, "its effect cannot be told from that of the other parameters in this motion; vary it");
        }
    }
    shown
}

/// True when there is motion beyond the noise of the velocity.
fn moves(pieces: &[Piece]) -> bool {
    pieces.iter().any(|p| p.rms(|m| m.velocity) > MOTION_RATIO * p.velocity_noise.max(f64::MIN_POSITIVE))
}

/// True when both directions are there, for some time and some way: at a stop a filter rings back by a hair.
fn reverses(pieces: &[Piece]) -> bool {
    let (mut time, mut way) = ([0.0, 0.0], [0.0, 0.0]);
    for piece in pieces {
        for ((direction, motion), usable) in piece.direction.iter().zip(&piece.motion).zip(&piece.usable) {
            if *usable && direction.abs() > 0.9 && motion.velocity.abs() > 3.0 * piece.velocity_noise {
                let side = usize::from(*direction > 0.0);
                time[side] += piece.period_s;
                way[side] += piece.period_s * motion.velocity.abs();
            }
        }
    }
    let both = |of: [f64; 2], share: f64| of[0].min(of[1]) > share * (of[0] + of[1]);
    both(time, REVERSAL_SHARE) && both(way, REVERSAL_WAY)
}
