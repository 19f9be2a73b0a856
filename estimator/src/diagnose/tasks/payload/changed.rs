//! Two sets of poses of one sensor: the change of its load and of its bias between them.

use super::evidence::{GROUPS, Group, HeldOut, Tested, cause, not_excited, passed_over, tested};
use super::one::{baseline, by_gain, end, residual, undecided};
use crate::diagnose::contract::{CERTAIN_FROM, Diagnosis, Verdict};
use crate::diagnose::findings::Findings;
use crate::diagnose::hypotheses::{force_bias, mass_change};
use estimation::identify::payload::doubts::doubts;
use estimation::identify::payload::{Estimate, Left, Model, Observed, Row, left_by, observe};
use estimation::regression::long_run_variance::inflation;
use foundation::estimate::EstimateError;
use haptics::recording::{Recording, WrenchFrame};
use nalgebra::{DMatrix, Vector3};

/// Change of the values that both sets show, with its covariance.
struct Change {
    values: Vec<f64>,
    covariance: DMatrix<f64>,
    /// Degrees of freedom of each error.
    freedom: Vec<f64>,
    /// Places of the values that both show, in the second set.
    shown: Vec<usize>,
}

impl Change {
    fn between(before: &Estimate, after: &Estimate) -> Self {
        let place = |name: &str| before.index(name).filter(|at| before.identified[*at]);
        let pairs: Vec<Option<usize>> = after.names.iter().map(|(_, name)| place(name)).collect();
        let n = after.names.len();
        let covariance = DMatrix::from_fn(n, n, |i, j| {
            after.covariance[(i, j)] + pairs[i].zip(pairs[j]).map_or(0.0, |(a, b)| before.covariance[(a, b)])
        });
        Self {
            values: (0..n).map(|i| pairs[i].map_or(0.0, |at| after.values[i] - before.values[at])).collect(),
            covariance,
            freedom: (0..n).map(|i| pairs[i].map_or(1.0, |at| welch((before, at), (after, i)))).collect(),
            // A drift is each recording's own.
            shown: (0..n)
                .filter(|i| after.identified[*i] && pairs[*i].is_some() && !after.names[*i].1.contains("drift"))
                .collect(),
        }
    }
}

/// Degrees of freedom of the difference of two values (Welch 1947).
fn welch(a: (&Estimate, usize), b: (&Estimate, usize)) -> f64 {
    let of = |(set, at): (&Estimate, usize)| {
        let freedom = set.freedom[at].max(1.0);
        (set.covariance[(at, at)] / inflation(freedom), freedom)
    };
    let ((va, na), (vb, nb)) = (of(a), of(b));
    let parts = va * va / na + vb * vb / nb;
    if parts > 0.0 { (va + vb).powi(2) / parts } else { na.min(nb) }
}

/// Values of the load and of the bias that a set shows, as a force in the sensor's axes.
fn reading(found: &Estimate, row: &Row, group: &str) -> Vector3<f64> {
    let value = |name: &str| found.index(name).map_or(0.0, |at| found.values[at]);
    if group == mass_change::ID {
        return row.down * found.known_weight_n.unwrap_or_else(|| value("weight_N"));
    }
    Vector3::new(value("force_bias_x_N"), value("force_bias_y_N"), value("force_bias_z_N"))
}

fn read(recording: &Recording) -> Result<(Observed, Estimate), EstimateError> {
    let mut seen = observe(recording)?;
    // Both loads are compared as they are.
    seen.known_weight_n = None;
    let found = Estimate::of(&seen, seen.frame.unwrap_or(WrenchFrame::Sensor))?;
    Ok((seen, found))
}

/// Residual of the second set's force if parts of the model keep the values of the first set.
fn left(before: &Estimate, after: &Estimate, kept: &[&str]) -> Left {
    let mut rows = after.rows.clone();
    for row in &mut rows {
        let own: Vector3<f64> = kept.iter().map(|group| reading(before, row, group)).sum();
        row.force_n -= own;
    }
    let (load, bias) = (!kept.contains(&mass_change::ID), !kept.contains(&force_bias::ID));
    left_by(&rows, Model { load, bias, drift: after.model.drift && bias }, after.block)
}

/// Diagnosis of the change from one set to another.
pub(super) fn diagnosed(first: &Recording, second: &Recording) -> Result<Findings, EstimateError> {
    let ((seen_before, before), (seen, after)) = (read(first)?, read(second)?);
    let mut warnings = doubts(&seen_before, &before);
    warnings.extend(doubts(&seen, &after));
    warnings.extend(seen_before.warnings.into_iter().chain(seen.warnings));
    let noise_n = seen.noise_n.unwrap_or(after.force_rms_n);
    let kept = left(&before, &after, &[mass_change::ID, force_bias::ID]);
    let mut diagnosis = Diagnosis {
        baseline: baseline(format!("as in {}", first.name), format!("force of the sensor in {}", second.name), &kept),
        noise_floor_n: noise_n,
        not_excited: not_excited(true),
        warnings,
        ..Diagnosis::default()
    };
    let change = Change::between(&before, &after);
    let rows = before.rows.len() + after.rows.len();
    let groups: Vec<(&Group, Tested)> = GROUPS
        .iter()
        .filter_map(|group| {
            let at: Vec<usize> = change.shown.iter().copied().filter(|i| (group.owns)(&after.names[*i])).collect();
            (!at.is_empty()).then(|| (group, tested((&change.values, &change.covariance, &change.freedom), at, rows)))
        })
        .collect();
    let named: Vec<&str> = groups.iter().filter(|(_, t)| t.posterior() >= CERTAIN_FROM).map(|(g, _)| g.id).collect();
    // Parts that did not change keep the first set's values.
    let without = |but: Option<&str>| -> Vec<&'static str> {
        let all = [mass_change::ID, force_bias::ID];
        all.into_iter().filter(|id| !named.contains(id) || but == Some(*id)).collect()
    };
    let changed = left(&before, &after, &without(None));
    let how = format!("differs between {} and {}", first.name, second.name);
    for (group, test) in &groups {
        if named.contains(&group.id) {
            let left = left(&before, &after, &without(Some(group.id)));
            let held_out = HeldOut { before: left.held_out, after: changed.held_out.clone(), noise_n };
            diagnosis.causes.push(cause(group, test, (&after, &change.values, &change.covariance), &held_out, &how));
        } else {
            diagnosis.passed_over.push(passed_over(group, test));
        }
    }
    by_gain(&mut diagnosis.causes);
    diagnosis.end = end(&changed);
    diagnosis.residuals = vec![residual(after.rows.len(), kept.rms_n, changed.rms_n, seen.noise_n)];
    diagnosis.verdict = if diagnosis.causes.is_empty() { Verdict::None } else { Verdict::Causes };
    let is_divided = [&before, &after].into_iter().all(|set| set.weight_n().is_some());
    let spread_n = before.force_rms_n.hypot(after.force_rms_n).hypot(noise_n);
    // Three standard deviations: the readings differ, and the orientations do not say by which part.
    if !is_divided && kept.rms_n > 3.0 * spread_n {
        undecided(&mut diagnosis, &after);
    }
    Ok(Findings::from(diagnosis))
}
