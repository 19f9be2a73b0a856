//! One set of poses: the share of its reading that load, bias, and drift carry, beside a known load.

use super::evidence::{GROUPS, Group, HeldOut, Tested, cause, not_excited, open, passed_over, tested};
use crate::diagnose::contract::{Baseline, CERTAIN_FROM, Cause, Diagnosis, Final, Residual, Verdict};
use crate::diagnose::findings::Findings;
use crate::diagnose::hypotheses::{force_bias, mass_change};
use crate::diagnose::selection::held_out_gain::chi_square_tail;
use estimation::identify::payload::doubts::{doubts, is_unexplained};
use estimation::identify::payload::{Estimate, Left, Model, left_by, observe};
use foundation::estimate::EstimateError;
use foundation::tasks::SystemState;
use haptics::recording::{Recording, WrenchFrame};

/// The model with the causes of these ids, but one.
fn model(full: Model, ids: &[&str], but: Option<&str>) -> Model {
    let has = |group: &Group, is_in: bool| is_in && ids.contains(&group.id) && but != Some(group.id);
    let [bias, load, drift] = &GROUPS;
    Model { load: has(load, full.load), bias: has(bias, full.bias), drift: has(drift, full.drift) }
}

/// Root mean square of held-out squares.
fn root_mean(squares: &[f64]) -> f64 {
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
}

/// Diagnosis of one set.
pub(super) fn diagnosed(recording: &Recording) -> Result<Findings, EstimateError> {
    let mut seen = observe(recording)?;
    let known_n = seen.known_weight_n.take().unwrap_or(0.0);
    let mut found = Estimate::of(&seen, seen.frame.unwrap_or(WrenchFrame::Sensor))?;
    let mut warnings = doubts(&seen, &found);
    warnings.extend(seen.warnings.clone());
    // The load beyond the known one.
    found.rows.iter_mut().for_each(|row| row.force_n -= row.down * known_n);
    if let Some(at) = found.index("weight_N") {
        found.values[at] -= known_n;
    }
    let rows = &found.rows;
    let nothing = Model { load: false, bias: false, drift: false };
    let base = left_by(rows, nothing, found.block);
    let noise_n = seen.noise_n.unwrap_or(found.force_rms_n);
    let name = if known_n == 0.0 { "no-load" } else { "known-load" };
    let mut diagnosis = Diagnosis {
        baseline: baseline(name.to_owned(), "force of the sensor".to_owned(), &base),
        noise_floor_n: noise_n,
        not_excited: not_excited(found.model.drift),
        warnings,
        ..Diagnosis::default()
    };
    let groups = groups(&found);
    let named: Vec<&str> = groups.iter().filter(|(_, t)| t.posterior() >= CERTAIN_FROM).map(|(g, _)| g.id).collect();
    let whole = model(found.model, &named, None);
    let after = left_by(rows, whole, found.block);
    let held_out = |group: &Group| {
        let before = left_by(rows, model(found.model, &named, Some(group.id)), found.block).held_out;
        HeldOut { before, after: after.held_out.clone(), noise_n }
    };
    let of = |(group, test): &(&Group, Tested)| {
        cause(
            group,
            test,
            (&found, &found.values, &found.covariance),
            &held_out(group),
            "carries a part of the reading",
        )
    };
    diagnosis.causes = groups.iter().filter(|(g, _)| named.contains(&g.id)).map(of).collect();
    by_gain(&mut diagnosis.causes);
    diagnosis.passed_over =
        groups.iter().filter(|(g, _)| !named.contains(&g.id)).map(|(group, test)| passed_over(group, test)).collect();
    diagnosis.end = end(&after);
    diagnosis.residuals = vec![residual(rows.len(), base.rms_n, after.rms_n, seen.noise_n)];
    diagnosis.verdict = if diagnosis.causes.is_empty() { Verdict::None } else { Verdict::Causes };
    if is_unexplained(&found) && !diagnosis.causes.is_empty() {
        diagnosis.verdict = Verdict::Unexplained;
    }
    // Three standard deviations of the noise: a reading that is there.
    if found.weight_n().is_none() && base.rms_n > 3.0 * noise_n {
        undecided(&mut diagnosis, &found);
    }
    Ok(Findings::from(diagnosis))
}

/// Figures of the model that was started from.
pub(super) fn baseline(model: String, of: String, left: &Left) -> Baseline {
    Baseline {
        model,
        rms_n: left.rms_n,
        heldout_rms_n: root_mean(&left.held_out),
        whiteness_p: whiteness_p(left),
        of: Some(of),
        unit: Some("N".to_owned()),
        ..Baseline::default()
    }
}

/// Figures of the model in the end.
pub(super) fn end(left: &Left) -> Final {
    Final { heldout_rms_n: root_mean(&left.held_out), whiteness_p: whiteness_p(left), heldout_rms_nm: None }
}

/// Groups with values that the poses show, and their tests.
fn groups(found: &Estimate) -> Vec<(&'static Group, Tested)> {
    let of = |group: &'static Group| {
        let at: Vec<usize> =
            (0..found.names.len()).filter(|i| found.identified[*i] && (group.owns)(&found.names[*i])).collect();
        (!at.is_empty())
            .then(|| (group, tested((&found.values, &found.covariance, &found.freedom), at, found.rows.len())))
    };
    GROUPS.iter().filter_map(of).collect()
}

/// Causes by the power that each takes off, the largest first.
pub(super) fn by_gain(causes: &mut [Cause]) {
    let taken = |cause: &Cause| cause.gain.heldout_rms_before.powi(2) - cause.gain.heldout_rms_after.powi(2);
    causes.sort_by(|a, b| taken(b).total_cmp(&taken(a)));
}

/// A reading that is there, and that orientations do not divide between weight and bias.
pub(super) fn undecided(diagnosis: &mut Diagnosis, found: &Estimate) {
    let (other, next) = open();
    let bias: Vec<usize> = (0..found.names.len()).filter(|i| found.names[*i].1.starts_with("force_bias")).collect();
    let test = Tested { at: bias, p_value: 1.0, score: 0.0 };
    let held_out = HeldOut { before: Vec::new(), after: Vec::new(), noise_n: 0.0 };
    let mut first =
        cause(&GROUPS[0], &test, (found, &found.values, &found.covariance), &held_out, "or the weight of the load");
    first.parameters.clear();
    first.gain.no_share = Some(other.why.clone());
    first.evidence = format!("the reading is more than noise, and it is {} or {}", force_bias::ID, mass_change::ID);
    diagnosis.causes = vec![first];
    diagnosis.passed_over.clear();
    diagnosis.alternatives = vec![other];
    diagnosis.next_experiment = Some(next);
    diagnosis.verdict = Verdict::Ambiguous;
}

pub(super) fn residual(rows: usize, before_n: f64, after_n: f64, noise_n: Option<f64>) -> Residual {
    Residual {
        channel: "force of the sensor".to_owned(),
        unit: "N".to_owned(),
        state: SystemState::Holding,
        rows,
        rms_before: before_n,
        rms_after: after_n,
        noise_floor: noise_n,
    }
}

/// Probability of residuals at least as correlated if those of neighbouring poses were independent.
fn whiteness_p(left: &Left) -> f64 {
    chi_square_tail(left.correlated, 1.0)
}
