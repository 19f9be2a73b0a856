//! Evidence of a group of values: their size beside their covariance, and what they are worth on poses held out.

use crate::diagnose::contract::{Alternative, Cause, Gain, NextExperiment, NotExcited, PassedOver, parameter};
use crate::diagnose::hypotheses::{force_bias, force_drift, force_gain, mass_change};
use estimation::identify::payload::{Estimate, PAYLOAD, SEPARATES};
use estimation::regression::long_run_variance::inflation;
use foundation::words::amount;
use haptics::law::Kind;
use nalgebra::DMatrix;
use statrs::distribution::{ChiSquared, ContinuousCDF, StudentsT};

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

/// Values of a group with their test.
pub(super) struct Tested {
    /// Indices of the values.
    pub at: Vec<usize>,
    /// Probability that chance makes the largest of them so large, the others counted in.
    pub p_value: f64,
    /// 2 ln(likelihood) of that probability, less its cost ln n.
    pub score: f64,
}

/// Test of some values against 0, by the most significant one: few poses do not show a covariance of many values well enough
/// for a joint test. `of`: values, covariance, and degrees of freedom; `rows`: number of poses.
pub(super) fn tested(of: (&[f64], &DMatrix<f64>, &[f64]), at: Vec<usize>, rows: usize) -> Tested {
    let (values, covariance, freedom) = of;
    let chance = |i: &usize| {
        // The error contains the width of Student's t.
        let error = covariance[(*i, *i)].max(f64::MIN_POSITIVE).sqrt() / inflation(freedom[*i]).sqrt();
        StudentsT::new(0.0, 1.0, freedom[*i].max(1.0)).map_or(1.0, |t| 2.0 * t.sf((values[*i] / error).abs()))
    };
    let p_value = (at.len() as f64 * at.iter().map(chance).fold(1.0, f64::min)).clamp(f64::MIN_POSITIVE, 1.0);
    let square = ChiSquared::new(1.0).map_or(0.0, |d| d.inverse_cdf(1.0 - p_value));
    // Beyond the resolution of 1 − p the tail of the square is its logarithm.
    let square = if square.is_finite() && p_value > 1e-14 { square } else { -2.0 * p_value.ln() };
    Tested { score: square - (rows.max(2) as f64).ln(), p_value, at }
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
        p_value: (GROUPS.len() as f64 * test.p_value).min(1.0),
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
