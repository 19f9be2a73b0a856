//! What a battery comes out at, for programs: the same counts as the tables.

use super::follow::Experiments;
use super::interval::Share;
use super::score::{Figures, Row};
use super::sets::Set;
use super::tables::{brier, calibration_bins, confusion_counts, gains_by_cause};
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;

/// Everything; shares come with their exact 95 % intervals, what is no number is null.
#[derive(JsonSchema, Serialize)]
pub struct Said {
    /// Recordings that were asked about.
    cases: usize,
    /// Shares by name.
    figures: Table,
    /// Hidden → said → how often.
    confusion: BTreeMap<String, BTreeMap<String, usize>>,
    /// What probabilities are worth.
    calibration: Calibration,
    /// The experiments that were proposed, done and asked about again.
    experiments: Proposed,
    /// How much of what is possible the extended worlds gain, by what was hidden.
    gain_of_oracle_by_cause: Vec<GainOf>,
    /// Cases in which something was hidden that no test could have seen.
    not_counted: usize,
}

/// A share with its exact 95 % interval.
#[derive(JsonSchema, Serialize)]
struct Counted {
    /// Hits over cases.
    share: Option<f64>,
    /// Hits.
    hits: usize,
    /// Cases.
    of: usize,
    /// Ends of the interval.
    interval: [Option<f64>; 2],
}

/// The figures of `docs/diagnosis.md`.
#[derive(JsonSchema, Serialize)]
struct Table {
    #[serde(rename = "right_first_from_ratio_0.5")]
    right_first_from_half: Counted,
    #[serde(rename = "right_or_equal_first_from_ratio_0.5")]
    right_or_equal_first_from_half: Counted,
    right_first: Counted,
    right_or_equal_first: Counted,
    truth_in_ambiguity_set: Counted,
    ambiguity_set_size: Option<f64>,
    false_alarms: Counted,
    false_alarms_20_hz: Counted,
    unexplained_on_nulls: Counted,
    precision: Counted,
    nameless_named: Counted,
    nameless_flagged: Counted,
    pairs_both: Counted,
    pairs_both_or_equal: Counted,
    pairs_spurious_a_case: Option<f64>,
    pairs_spurious_beside_equals: Option<f64>,
    gain_of_oracle: Spread,
    gain_claimed: Spread,
    errors: Counted,
    experiments_settled: Counted,
    experiments_answered: Counted,
    experiments_expected_power: Option<f64>,
}

/// A median, and what 9 of 10 are above.
#[derive(JsonSchema, Serialize)]
struct Spread {
    median: Option<f64>,
    p10: Option<f64>,
}

/// What probabilities are worth.
#[derive(JsonSchema, Serialize)]
struct Calibration {
    /// By what was stated.
    bins: Vec<Bin>,
    /// Brier score.
    brier: Option<f64>,
}

/// What was stated, and how often it was so.
#[derive(JsonSchema, Serialize)]
struct Bin {
    /// Mean of the probabilities in this bin.
    stated: Option<f64>,
    #[serde(flatten)]
    right: Counted,
}

/// Experiments that were proposed.
#[derive(JsonSchema, Serialize)]
struct Proposed {
    /// By the power that was stated.
    calibration: Vec<Bin>,
    /// By the motion that was asked for.
    by_motion: Vec<OfMotion>,
}

/// Experiments of one motion.
#[derive(JsonSchema, Serialize)]
struct OfMotion {
    /// The motion.
    id: String,
    #[serde(flatten)]
    settled: Counted,
}

/// Gains where one cause was hidden.
#[derive(JsonSchema, Serialize)]
struct GainOf {
    /// The cause.
    id: String,
    #[serde(flatten)]
    gain: Spread,
    /// Its cases.
    cases: usize,
}

impl Said {
    /// Counts.
    pub fn of(rows: &[Row]) -> Self {
        let e = Experiments::of(rows);
        Self {
            cases: rows.len(),
            figures: Table::of(&Figures::of(rows), &e),
            confusion: confusion_counts(rows)
                .into_iter()
                .map(|(hidden, said)| (hidden, said.into_iter().collect()))
                .collect(),
            calibration: Calibration { bins: bins(&calibration_bins(rows)), brier: number(brier(rows).0) },
            experiments: Proposed {
                calibration: bins(&e.calibration),
                by_motion: e
                    .by_motion
                    .into_iter()
                    .map(|(id, settled)| OfMotion { id, settled: settled.into() })
                    .collect(),
            },
            gain_of_oracle_by_cause: gains_by_cause(rows)
                .into_iter()
                .map(|(id, gain, cases)| GainOf { id, gain: gain.into(), cases })
                .collect(),
            not_counted: rows.iter().filter(|r| r.set != Set::Null && r.missed).count(),
        }
    }
}

impl Table {
    fn of(f: &Figures, e: &Experiments) -> Self {
        Self {
            right_first_from_half: f.first_from_half.into(),
            right_or_equal_first_from_half: f.first_or_equal_from_half.into(),
            right_first: f.first_all.into(),
            right_or_equal_first: f.first_or_equal.into(),
            truth_in_ambiguity_set: f.in_set.into(),
            ambiguity_set_size: number(f.set_size),
            false_alarms: f.false_alarms.into(),
            false_alarms_20_hz: f.false_alarms_20_hz.into(),
            unexplained_on_nulls: f.null_flags.into(),
            precision: f.precision.into(),
            nameless_named: f.nameless_named.into(),
            nameless_flagged: f.nameless_flagged.into(),
            pairs_both: f.both.into(),
            pairs_both_or_equal: f.both_or_equal.into(),
            pairs_spurious_a_case: number(f.spurious),
            pairs_spurious_beside_equals: number(f.spurious_beside_equals),
            gain_of_oracle: f.gain.into(),
            gain_claimed: f.gain_claimed.into(),
            errors: f.errors.into(),
            experiments_settled: e.settled.into(),
            experiments_answered: e.answered.into(),
            experiments_expected_power: number(e.expected_power),
        }
    }
}

impl From<Share> for Counted {
    fn from(share: Share) -> Self {
        let interval = if share.of > 0 { share.interval(0.95) } else { [f64::NAN; 2] };
        Self { share: number(share.value()), hits: share.hits, of: share.of, interval: interval.map(number) }
    }
}

impl From<[f64; 2]> for Spread {
    fn from([median, p10]: [f64; 2]) -> Self {
        Self { median: number(median), p10: number(p10) }
    }
}

fn bins(bins: &[(f64, Share)]) -> Vec<Bin> {
    bins.iter().map(|(mean, right)| Bin { stated: number(*mean), right: (*right).into() }).collect()
}

/// What is no number is nothing.
fn number(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
