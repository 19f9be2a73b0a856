//! Evidence of a group of values: their size beside their covariance, and what they are worth on poses held out.

use crate::diagnose::contract::{Alternative, Cause, Gain, NextExperiment, NotExcited, PassedOver, parameter};
use crate::diagnose::hypotheses::{force_bias, force_drift, force_gain, mass_change};
use crate::diagnose::selection::held_out_gain::chi_square_tail;
use estimation::identify::payload::{Estimate, PAYLOAD, SEPARATES};
use foundation::words::amount;
use haptics::law::Kind;
use nalgebra::{DMatrix, DVector};

/// Values that one cause changes.
pub(super) struct Group {
    pub id: &'static str,
    pub kind: Kind,
    /// In words, for sentences.
    pub words: &'static str,
    /// True for the names of its values.
    pub owns: fn(&(&'static str, &'static str)) -> bool,
}

pub(super) static GROUPS: [Group; 3] = [
    Group {
        id: force_bias::ID,
        kind: Kind::Instrument,
        words: "the bias of the sensor",
        owns: |(_, name)| name.contains("bias"),
    },
    Group {
        id: mass_change::ID,
        kind: Kind::Plant,
        words: "the weight of the load",
        owns: |(object, _)| *object == PAYLOAD,
    },
    Group {
        id: force_drift::ID,
        kind: Kind::Instrument,
        words: "a drift of the sensor",
        owns: |(_, name)| name.contains("drift"),
    },
];

/// Values of a group with their joint test.
pub(super) struct Tested {
    /// Indices of the values.
    pub at: Vec<usize>,
    /// Quadratic form of the values with the inverse of their covariance.
    pub square: f64,
    /// [`Self::square`] less the cost of the values, 2 ln(likelihood): k ln n.
    pub score: f64,
}

/// Joint test of some values against 0; `rows`: number of poses.
pub(super) fn tested(values: &[f64], covariance: &DMatrix<f64>, at: Vec<usize>, rows: usize) -> Tested {
    let part = DMatrix::from_fn(at.len(), at.len(), |i, j| covariance[(at[i], at[j])]);
    // In units of their own errors: forces and torques have different sizes.
    let scale = DVector::from_fn(at.len(), |i, _| part[(i, i)].max(f64::MIN_POSITIVE).sqrt().recip());
    let part = DMatrix::from_diagonal(&scale) * part * DMatrix::from_diagonal(&scale);
    let values = DVector::from_fn(at.len(), |i, _| values[at[i]] * scale[i]);
    // With few poses the covariance of many values is singular: each alone then, the largest counts.
    let joint = part.cholesky().map(|c| values.dot(&c.solve(&values)));
    let alone = values.amax().powi(2);
    let is_full = 3 * rows > 2 * covariance.nrows();
    let square = joint.filter(|_| is_full).unwrap_or(alone);
    let cost = at.len() as f64 * (rows.max(2) as f64).ln();
    Tested { square, score: square - cost, at }
}

impl Tested {
    /// Probability that the values differ from 0, by the Schwarz criterion (Kass & Raftery 1995).
    pub fn posterior(&self) -> f64 {
        1.0 / (1.0 + (-0.5 * self.score).exp())
    }
}

/// Mean square of poses that took part in nothing, without and with a cause.
pub(super) struct HeldOut {
    pub before: Vec<f64>,
    pub after: Vec<f64>,
    pub noise_n: f64,
}

impl HeldOut {
    pub fn gain(&self) -> Gain {
        let mean = |all: &[f64]| all.iter().sum::<f64>() / all.len().max(1) as f64;
        let (before, after) = (mean(&self.before), mean(&self.after));
        let floor = (self.noise_n * self.noise_n).min(after);
        let open: f64 = self.before.iter().map(|b| b - floor).sum();
        let share =
            if open > 0.0 { self.before.iter().zip(&self.after).map(|(b, a)| b - a).sum::<f64>() / open } else { 0.0 };
        // Error of a ratio of sums over independent poses.
        let off = self.before.iter().zip(&self.after).map(|(b, a)| (b - a - share * (b - floor)).powi(2)).sum::<f64>();
        let error = if open > 0.0 { 1.96 * off.sqrt() / open } else { 0.0 };
        Gain {
            heldout_rms_before: before.sqrt(),
            heldout_rms_after: after.sqrt(),
            share_of_explainable: share.clamp(0.0, 1.0),
            interval: [(share - error).clamp(0.0, 1.0), (share + error).clamp(0.0, 1.0)],
            in_turn: true,
            unit: Some("N".to_owned()),
            no_rollout: Some("a reading at rest does not run forward".to_owned()),
            ..Gain::default()
        }
    }
}

/// A cause with its values; `verb`: `carries`, `changed by`, …
pub(super) fn cause(
    group: &Group,
    test: &Tested,
    of: (&Estimate, &[f64], &DMatrix<f64>),
    held_out: &HeldOut,
    how: &str,
) -> Cause {
    let (found, values, covariance) = of;
    let shown = |i: &usize| {
        let (_, name) = found.names[*i];
        let unit = if name.ends_with("Nm_s") {
            "N m/s"
        } else if name.ends_with("N_s") {
            "N/s"
        } else if name.ends_with("Nm") {
            "N m"
        } else {
            "N"
        };
        parameter(name, values[*i], covariance[(*i, *i)].max(0.0).sqrt(), unit)
    };
    let gain = held_out.gain();
    let evidence = format!(
        "{} {how}: {} remain on poses that took no part without it, {} with it",
        group.words,
        amount(gain.heldout_rms_before, "N"),
        amount(gain.heldout_rms_after, "N")
    );
    Cause {
        id: group.id.to_owned(),
        kind: group.kind,
        parameters: test.at.iter().map(shown).collect(),
        p_value: (GROUPS.len() as f64 * chi_square_tail(test.square, test.at.len() as f64)).min(1.0),
        posterior: test.posterior(),
        standing: None,
        gain,
        evidence,
    }
}

/// A group that was looked at and not named.
pub(super) fn passed_over(group: &Group, test: &Tested) -> PassedOver {
    PassedOver {
        id: group.id.to_owned(),
        alone: test.score,
        beside: test.score,
        // 2 ln 19: a probability of 0.95.
        least: 2.0 * 19.0_f64.ln(),
        why: format!("{} is not larger than its error", group.words),
    }
}

/// Bias or weight, if the orientations show only their sum.
pub(super) fn open() -> (Alternative, NextExperiment) {
    let why = format!("one orientation shows only the sum of weight and bias; {SEPARATES}");
    let other =
        Alternative { id: mass_change::ID.to_owned(), instead_of: force_bias::ID.to_owned(), posterior: 0.5, why };
    let separates = vec![force_bias::ID.to_owned(), mass_change::ID.to_owned()];
    (other, NextExperiment::in_words(SEPARATES, separates, 0.95))
}

/// Causes that such poses cannot show.
pub(super) fn not_excited(has_drift: bool) -> Vec<NotExcited> {
    let mut all = vec![NotExcited::new(force_gain::ID, "a known weight on the sensor shows it, and nothing else does")];
    if !has_drift {
        all.push(NotExcited::new(
            force_drift::ID,
            "without a clock, or with few poses, nothing shows a change with time",
        ));
    }
    all
}
