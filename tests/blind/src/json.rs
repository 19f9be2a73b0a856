//! What a battery comes out at, for programs: the same counts as the tables.

use super::follow::Experiments;
use super::interval::Share;
use super::score::{Figures, Row};
use super::sets::Set;
use super::tables::{brier, calibration_bins, confusion_counts, gains_by_cause};
use serde_json::{Map, Value, json};

/// Everything; shares come with their exact 95 % intervals.
pub fn json(rows: &[Row]) -> Value {
    let f = Figures::of(rows);
    let e = Experiments::of(rows);
    json!({
        "cases": rows.len(),
        "figures": {
            "right_first_from_ratio_0.5": share(f.first_from_half),
            "right_or_equal_first_from_ratio_0.5": share(f.first_or_equal_from_half),
            "right_first": share(f.first_all),
            "right_or_equal_first": share(f.first_or_equal),
            "truth_in_ambiguity_set": share(f.in_set),
            "ambiguity_set_size": number(f.set_size),
            "false_alarms": share(f.false_alarms),
            "false_alarms_20_hz": share(f.false_alarms_20_hz),
            "unexplained_on_nulls": share(f.null_flags),
            "precision": share(f.precision),
            "nameless_named": share(f.nameless_named),
            "nameless_flagged": share(f.nameless_flagged),
            "pairs_both": share(f.both),
            "pairs_both_or_equal": share(f.both_or_equal),
            "pairs_spurious_a_case": number(f.spurious),
            "pairs_spurious_beside_equals": number(f.spurious_beside_equals),
            "gain_of_oracle": { "median": number(f.gain[0]), "p10": number(f.gain[1]) },
            "gain_claimed": { "median": number(f.gain_claimed[0]), "p10": number(f.gain_claimed[1]) },
            "errors": share(f.errors),
            "experiments_settled": share(e.settled),
            "experiments_answered": share(e.answered),
            "experiments_expected_power": number(e.expected_power),
        },
        "confusion": confusion(rows),
        "calibration": {
            "bins": bins(&calibration_bins(rows)),
            "brier": number(brier(rows).0),
        },
        "experiments": {
            "calibration": bins(&e.calibration),
            "by_motion": e.by_motion.iter().map(|(id, settled)| {
                let mut motion = share(*settled);
                motion["id"] = json!(id);
                motion
            }).collect::<Vec<_>>(),
        },
        "gain_of_oracle_by_cause": gains_by_cause(rows).into_iter()
            .map(|(id, [median, p10], cases)| json!({ "id": id, "median": number(median), "p10": number(p10), "cases": cases }))
            .collect::<Vec<_>>(),
        "not_counted": rows.iter().filter(|r| r.set != Set::Null && r.missed).count(),
    })
}

/// Hidden → said → how often.
fn confusion(rows: &[Row]) -> Value {
    let of = |said: Vec<(String, usize)>| -> Map<String, Value> {
        said.into_iter().map(|(name, count)| (name, json!(count))).collect()
    };
    Value::Object(confusion_counts(rows).into_iter().map(|(hidden, said)| (hidden, Value::Object(of(said)))).collect())
}

/// What was stated, and how often it was so.
fn bins(bins: &[(f64, Share)]) -> Vec<Value> {
    let bin = |(mean, right): &(f64, Share)| {
        let mut bin = share(*right);
        bin["stated"] = number(*mean);
        bin
    };
    bins.iter().map(bin).collect()
}

fn share(share: Share) -> Value {
    let [low, high] = if share.of > 0 { share.interval(0.95) } else { [f64::NAN; 2] };
    json!({ "share": number(share.value()), "hits": share.hits, "of": share.of, "interval": [number(low), number(high)] })
}

/// What is no number is nothing.
fn number(value: f64) -> Value {
    if value.is_finite() { json!(value) } else { Value::Null }
}
