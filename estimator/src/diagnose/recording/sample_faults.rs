//! Faults of the recording itself, before anything is asked of the model: plateaus, stuck, coarse and missing samples,
//! mirrored axes.

use crate::diagnose::contract::{Cause, CauseParameter, Gain, parameter};
use crate::diagnose::data::limits::{CERTAIN, SIGNIFICANT};
use crate::diagnose::hypotheses::{axis_sign, channel_fault, force_saturation, length_scale};
use crate::diagnose::selection::held_out_gain::LEAST_CHANGE_SHARE;
use foundation::signal::noise::white_noise;
use haptics::law::Kind;
use haptics::recording::{Recording, Warning};
use logs;

pub struct Faults {
    pub causes: Vec<Cause>,
    /// Flags of samples that no sensor measured.
    pub bad: Vec<bool>,
}

/// Kinds of warnings that are a fault of a channel.
const CHANNEL: [&str; 8] = [
    "stuck-channel",
    "copied-channel",
    "duplicate-samples",
    "dropped-samples",
    "gap",
    "clock-jump",
    "quantised",
    logs::SPIKES,
];
/// Kinds of them that concern all samples, so that none can be left out.
const WHOLE: [&str; 5] = ["dropped-samples", "gap", "clock-jump", "quantised", logs::SPIKES];
/// Number of places with lost samples up to which the data remain usable.
/// Choice: no case of the ablation reads it.
const USABLE_GAPS: usize = 3;

/// Looks at the raw samples.
pub fn faults(recording: &Recording) -> Faults {
    let mut found = Faults { causes: Vec::new(), bad: vec![false; recording.len()] };
    // Spikes and stuck channels were repaired: only the warning is left of them. Few spikes are no fault of the channel.
    let is_fault = |w: &&Warning| match w.kind.as_str() {
        logs::SPIKES => 100 * w.spans.len() >= recording.len(),
        kind => kind == "stuck-channel",
    };
    let repaired = recording.warnings.iter().filter(is_fault).cloned();
    let now = logs::check(recording).into_iter().map(|warning| (warning, true));
    for (warning, has_rows) in now.chain(repaired.map(|warning| (warning, false))) {
        let id = match warning.kind.as_str() {
            "saturation" => force_saturation::ID,
            kind if CHANNEL.contains(&kind) && is_sensed(&warning) => channel_fault::ID,
            _ => continue,
        };
        if has_rows && !WHOLE.contains(&warning.kind.as_str()) {
            for span in &warning.spans {
                let end = span.end.min(found.bad.len());
                found.bad[span.first.min(end)..end].fill(true);
            }
        }
        if warning.kind == "saturation" {
            leave_out_near_the_rail(recording, &warning, &mut found.bad);
        }
        if found.causes.iter().all(|c| c.id != id) {
            found.causes.push(cause(id, &warning, recording));
        }
    }
    // Faults in most of the recording cannot be left out.
    if 2 * found.bad.iter().filter(|b| **b).count() > found.bad.len() {
        found.bad.fill(false);
    }
    found
}

pub fn causes(recordings: &[Recording]) -> impl Iterator<Item = Cause> {
    recordings.iter().flat_map(|recording| faults(recording).causes)
}

/// Leaves out samples near a saturation limit, where the noise is cut on one side: the rest there is a biased sample of
/// the force.
fn leave_out_near_the_rail(recording: &Recording, warning: &Warning, bad: &mut [bool]) {
    let channel = warning.column.as_deref().and_then(|c| recording.channels.iter().find(|x| x.name == c));
    let (Some(channel), Some(span)) = (channel, warning.spans.first()) else { return };
    let level = channel.values.get(span.first).map_or(0.0, |v| v.abs());
    let near = level - SIGNIFICANT * white_noise(&channel.values);
    for (bad, value) in bad.iter_mut().zip(&channel.values) {
        *bad |= value.abs() > near;
    }
}

/// The force and motion channels, and the clock.
fn is_sensed(warning: &Warning) -> bool {
    let Some(column) = &warning.column else { return true };
    // Recorders occasionally lose a single sample.
    let clock = column == "t_s" && (warning.kind != "dropped-samples" || warning.spans.len() >= USABLE_GAPS);
    clock || ["f", "tau", "q", "dq", "x", "y", "v"].iter().any(|start| column.starts_with(start))
}

fn cause(id: &str, warning: &Warning, recording: &Recording) -> Cause {
    let first = warning.spans.first();
    let time = |sample: usize| {
        recording
            .time_s
            .as_ref()
            .and_then(|t| t.get(sample.min(t.len().saturating_sub(1))))
            .copied()
            .unwrap_or(sample as f64)
    };
    let number = |name: &str, value: f64, unit: &str| parameter(name, value, 0.0, unit);
    let channel = warning.column.as_deref().and_then(|c| recording.channels.iter().find(|x| x.name == c));
    let parameters = match (id, first, channel) {
        (force_saturation::ID, Some(span), Some(channel)) => {
            vec![number("F_max", channel.values[span.first].abs(), &channel.unit)]
        }
        (_, Some(span), _) => {
            // Without a clock, these are numbers of samples.
            let unit = if recording.time_s.is_some() { "s" } else { "samples" };
            vec![number("from", time(span.first), unit), number("to", time(span.end), unit)]
        }
        _ => Vec::new(),
    };
    certain(id, parameters, warning.text.clone())
}

/// A fault of a sensor that is certain.
fn certain(id: &str, parameters: Vec<CauseParameter>, evidence: String) -> Cause {
    Cause {
        id: id.to_owned(),
        kind: Kind::Instrument,
        parameters,
        p_value: 0.0,
        posterior: 1.0,
        standing: None,
        gain: Gain::default(),
        evidence,
    }
}

/// A mirrored or swapped axis, as a cause.
pub fn mirrored(which: &str, better: f64) -> Cause {
    let how = if which.contains("with") { "swapped" } else { "mirrored" };
    let evidence = format!(
        "with {which} {how} the model leaves {:.0} % of the force that it leaves unexplained as recorded, and friction resists",
        100.0 * better
    );
    wrong_sign(which, evidence)
}

/// An axis with a wrong sign, as a cause with this evidence.
pub fn wrong_sign(which: &str, evidence: String) -> Cause {
    certain(axis_sign::ID, vec![parameter(&format!("which: {which}"), -1.0, 0.0, "1")], evidence)
}

/// Reaction forces on the hand, as a cause: they take work from the person who moves the mechanism, all the way.
pub fn backwards(which: &str) -> Cause {
    let (act, they) = if which.contains(" and ") { ("act", "they are forces") } else { ("acts", "it is the force") };
    let taken = if which.contains(" and ") { "are" } else { "is" };
    let evidence = format!(
        "{which} {act} against the motion all the way: {they} on the hand and not on what it moves, and {taken} taken with the other sign"
    );
    wrong_sign(which, evidence)
}

/// A force along a coordinate with the wrong sign, as a cause.
pub fn driving(which: &str) -> Cause {
    let evidence = format!(
        "as recorded {which} has mass and friction of the wrong sign: it would pull back what speeds up and drive what it should hold back"
    );
    wrong_sign(which, evidence)
}

/// A rate that contradicts the differences of its own position, as a cause.
pub fn against_motion(which: &str) -> Cause {
    wrong_sign(which, format!("{which} goes against what the recorded places do; it is taken with the other sign"))
}

/// Scale error of lengths (`epsilon` with its standard error) against a known length, as a cause; `None` if they agree.
pub fn scaled(known: &str, [epsilon, std_error]: [f64; 2]) -> Option<Cause> {
    let off = epsilon.abs() > LEAST_CHANGE_SHARE.max(CERTAIN * std_error);
    let evidence = format!("the path is {:+.2} % off the known {known}", 100.0 * epsilon);
    off.then(|| certain(length_scale::ID, vec![parameter("epsilon", epsilon, std_error, "1")], evidence))
}
