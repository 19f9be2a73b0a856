//! Diagnosis of a block that is slid over the table, held between two fingers or pushed by one. The force along the
//! table is compared with the motion, as for any other motion along one coordinate.
//!
//! The base model is a mass with dry friction. The friction is proportional to the load on the ground if the block's
//! weight is known (less the lift of the fingers), and a constant otherwise. A tilted table pulls on the block alone.
//! Empty fingers feel a sensor bias, too.

use super::baseline_models::named;
use super::coordinate_answer::explain;
use super::mechanism::rows;
use super::one_coordinate;
use crate::diagnose::answer::build::Evidence;
use crate::diagnose::answer::named::Named;
use crate::diagnose::answer::put_back::PutBack;
use crate::diagnose::contract::{
    Alternative, Cause, Experiment, Gain, NextExperiment, NotExcited, Validation, parameter,
};
use crate::diagnose::data::interpolation::mean_step_s;
use crate::diagnose::data::limits::{CERTAIN, HAND_REST_HZ, PAUSE_S};
use crate::diagnose::data::regression_data;
use crate::diagnose::data::regression_data::{Model, Place, Track};
use crate::diagnose::data::row_means::mean_and_error;
use crate::diagnose::experiment::proposal;
use crate::diagnose::experiment::strokes::FREE_S;
use crate::diagnose::findings::{DelayFindings, Findings};
use crate::diagnose::free_run::windows::AT_ONCE;
use crate::diagnose::hypotheses::{
    force_bias, force_gain, friction_asymmetry, gravity_tilt, length_scale, load_friction,
};
use crate::diagnose::options::{Options, nothing};
use crate::diagnose::recording::{pads, sample_faults, time_delay};
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::held_out_gain;
use crate::diagnose::validation::on_other_recordings;
use estimation::identify::limits::LEAST_FREE_S;
use estimation::segment::slid::{LIFTED, LIFTED_S};
use estimation::segment::threshold::{Levels, percentile};
use foundation::estimate::EstimateError;
use foundation::signal::task::{TaskSignals, smooth, task_signals};
use foundation::words::amount;
use haptics::law::{Backlash, CoulombFriction, Effect, Hysteresis, Inertia, Kind, Law as _, LoadFriction};
use haptics::recording::{Channel, Meta, Recording};
use haptics::world::World;

/// Least force of a touching finger, as a share of its usual force.
/// Choice: no case of the ablation reads it.
const SLIDER_TOUCH_SHARE: f64 = 0.1;
/// Margin at the slow closing and opening of fingers, s.
/// Choice: no case of the ablation reads it.
const GRIP_CLOSING_MARGIN_S: f64 = 0.15;
/// Least total duration of sliding, s.
/// Choice: no case of the ablation reads it.
const LEAST_S: f64 = 2.0;
/// Relative error of a known mass from which a scale is wrong.
/// Choice: no case of the ablation reads it.
const MASS_SHARE: f64 = 0.08;

/// One recording as a coordinate with a force along it.
struct Slid {
    along: Recording,
    bad: Vec<bool>,
    lift_n: Vec<f64>,
    /// Sum of the horizontal forces of empty fingers and its error, N.
    free_n: Option<(f64, f64)>,
    weight_n: Option<f64>,
    slides_s: f64,
    lifted_s: f64,
}

/// True if [`slid`] handles these recordings: a block was moved on the ground and never carried.
pub fn is_slid(recordings: &[Recording]) -> bool {
    let slides = |r: &Recording| read(r, None).is_ok_and(|s| s.slides_s > LEAST_S && s.lifted_s < LIFTED_S);
    !recordings.is_empty() && recordings.iter().all(|r| r.time_s.is_some() && slides(r))
}

/// Diagnoses recordings of one block that is slid.
pub fn slid(
    recordings: &[Recording],
    options: &Options,
    faults: &[Cause],
    put_back: Option<&PutBack<'_>>,
) -> Result<Findings, EstimateError> {
    let (mut track, of_samples, read) = track_of(recordings, options.world.as_ref())?;
    let weight_n = read.iter().find_map(|s| s.weight_n);
    let model = model(options, weight_n.is_some())?;
    options.progress.tell(0.4)?;
    let study = one_coordinate::study(&mut track, &model, &given_by_pads())?;
    options.progress.tell(0.8)?;
    let scale = scale(&study, &model, weight_n.map(|w| w / recordings[0].meta.gravity()));
    let causes = faults.iter().cloned().chain(of_samples).collect();
    let delay = DelayFindings { guess_s: time_delay::guess_s(&track, &model), ..DelayFindings::default() };
    let evidence = Evidence { causes, delay, ..Evidence::default() };
    let mut draft = explain(&track, &model, &study, Vec::new(), evidence);
    let named = &mut draft.named;
    // Motions of the library are for an object that a program drives along its coordinate.
    if let Some(next) = &mut named.next {
        next.experiment = None;
    }
    constants(named, &read, weight_n);
    let_go(named, &track);
    if let Some((ratio, error)) = scale {
        scales(named, ratio, error);
    }
    if weight_n.is_none() {
        let why = "the block's weight is not known; state `weight_N` in the sidecar, or name a world";
        let ids = [load_friction::ID, force_gain::ID, length_scale::ID];
        named.not_excited.extend(ids.map(|id| NotExcited::new(id, why)));
    }
    Ok(draft.finish(put_back))
}

/// Validates the found causes on another recording.
pub fn validate(recordings: &[Recording], options: &Options, found: &Findings) -> Result<Validation, EstimateError> {
    let (mut track, ..) = track_of(recordings, options.world.as_ref())?;
    Ok(on_other_recordings::validate(&mut track, &found.plain, &found.effects, &[], &found.kept))
}

/// The pads yield before the block slides, by hundredths of a millimetre, as with presliding and backlash. Neither is
/// therefore a candidate.
fn given_by_pads() -> Model {
    vec![Effect::new(&Hysteresis, &[0.0, 1.0]), Effect::new(&Backlash, &[0.0])]
}

/// Laws of the base model.
fn model(options: &Options, weighs: bool) -> Result<Model, EstimateError> {
    match options.baseline.as_deref() {
        Some(name) => named(name),
        None if weighs => Ok(vec![Effect::new(&Inertia, &[1.0]), Effect::new(&LoadFriction, &[1.0])]),
        None => Ok(vec![Effect::new(&Inertia, &[1.0]), Effect::new(&CoulombFriction, &[1.0])]),
    }
}

/// Rows of all recordings, faults of their samples, and the recordings as read.
fn track_of(recordings: &[Recording], world: Option<&World>) -> Result<(Track, Vec<Cause>, Vec<Slid>), EstimateError> {
    let (mut tracks, mut faults, mut all) = (Vec::new(), Vec::new(), Vec::new());
    for recording in recordings {
        let sensed = sample_faults::faults(recording);
        let mut slid = read(recording, world)?;
        slid.bad.iter_mut().zip(&sensed.bad).for_each(|(bad, sensed)| *bad |= sensed);
        let mut rows = rows::track(&slid.along, &slid.bad, None)?;
        load(&mut rows, &slid);
        tracks.push(rows);
        faults.extend(sensed.causes);
        all.push(slid);
    }
    Ok((regression_data::join(tracks).ok_or_else(nothing)?, faults, all))
}

/// Sets the load of the block on the ground, row by row.
fn load(rows: &mut Track, slid: &Slid) {
    let (Some(weight_n), Some(time_s)) = (slid.weight_n, &slid.along.time_s) else { return };
    let start_s = time_s.first().copied().unwrap_or(0.0);
    for row in rows.rows.iter_mut().filter(|r| r.place == Place::Along) {
        let i = time_s.partition_point(|t| *t < start_s + row.motion.time_s).min(time_s.len() - 1);
        row.motion.normal_force_n = (weight_n - slid.lift_n[i]).max(0.0);
    }
}

fn known_weight_n(recording: &Recording, world: Option<&World>) -> Option<f64> {
    let known = |name: &str| {
        let known = &recording.meta.known;
        known.get(name).or_else(|| known.get(&format!("block-1.{name}"))).copied()
    };
    let gravity = recording.meta.gravity();
    let stated = known("weight_N").or_else(|| Some(known("mass_kg")? * gravity));
    stated.or_else(|| Some(world?.blocks.first()?.mass_kg * gravity))
}

fn read(recording: &Recording, world: Option<&World>) -> Result<Slid, EstimateError> {
    let signals = task_signals(recording)?;
    let n = signals.len();
    let time = &signals.time_s;
    let levels = Levels::of(&signals);
    let touches = [0, 1].map(|f| touching(&signals, &levels, f));
    let any = |i: usize| touches[0][i] || touches[1][i];
    let height = |i: usize| {
        let of: Vec<f64> = (0..2).filter(|f| touches[*f][i]).map(|f| signals.tips[f].position[i].y).collect();
        of.iter().sum::<f64>() / of.len().max(1) as f64
    };
    let mut heights: Vec<f64> = (0..n).filter(|i| any(*i)).map(height).collect();
    if heights.is_empty() {
        return Err(EstimateError::Other(format!("{} touches nothing: there is nothing to diagnose", recording.name)));
    }
    let ground_m = percentile(&mut heights, 0.05);
    let object_m = signals.object_m();
    let above_m = ground_m + LIFTED * object_m;
    let lifted = (0..n).filter(|i| any(*i) && height(*i) > above_m).count();
    let mut bad: Vec<bool> = (0..n).map(|i| !any(i) || height(i) > above_m).collect();
    widen(&mut bad, time);
    let of_touching = |pick: &dyn Fn(usize, usize) -> f64, mean: bool| -> Vec<f64> {
        let at = |i: usize| {
            let both = touches[0][i] == touches[1][i];
            let of: Vec<f64> = (0..2).filter(|f| both || touches[*f][i]).map(|f| pick(f, i)).collect();
            of.iter().sum::<f64>() / if mean { of.len() as f64 } else { 1.0 }
        };
        (0..n).map(at).collect()
    };
    let force = |f: usize, i: usize| signals.tips[f].force.as_ref().map_or(0.0, |v| v[i].x);
    let pad_m_n = pads::compliance_m_n(&signals).unwrap_or(0.0);
    let behind = [0, 1].map(|f| pads::behind_pad(&signals, f, pad_m_n));
    let place = of_touching(&|f, i| behind[f].0[i], true);
    let rate = of_touching(&|f, i| behind[f].1[i], true);
    let along_n = of_touching(&force, false);
    let net: Vec<f64> = signals.net_force_n.iter().map(|f| f.y).collect();
    let bias_y = levels.bias_n[0].y + levels.bias_n[1].y;
    let lift_n = smooth(time, &net).value.iter().map(|f| f - bias_y).collect();
    let step_s = mean_step_s(time);
    let calm = smooth(time, &rate).value;
    let slides_s = (0..n).filter(|i| !bad[*i] && calm[*i].abs() > HAND_REST_HZ * object_m).count() as f64 * step_s;
    let channel = |name: &str, unit: &str, values| Channel { name: name.to_owned(), unit: unit.to_owned(), values };
    let along = Recording {
        name: recording.name.clone(),
        time_s: Some(time.clone()),
        channels: vec![channel("q_m", "m", place), channel("dq_m_s", "m_s", rate), channel("f_N", "N", along_n)],
        meta: Meta { gravity_m_s2: recording.meta.gravity_m_s2, ..Meta::default() },
        ..Recording::default()
    };
    let free_n = free(&signals, &levels, step_s);
    Ok(Slid {
        along,
        bad,
        lift_n,
        free_n,
        weight_n: known_weight_n(recording, world),
        slides_s,
        lifted_s: lifted as f64 * step_s,
    })
}

/// Flags of samples in which a finger presses.
fn touching(signals: &TaskSignals, levels: &Levels, finger: usize) -> Vec<bool> {
    let Some(force) = &signals.tips[finger].force else { return vec![false; signals.len()] };
    let x: Vec<f64> = force.iter().map(|f| f.x - levels.bias_n[finger].x).collect();
    let pressed: Vec<f64> = smooth(&signals.time_s, &x).value.iter().map(|f| f.abs()).collect();
    let usual = percentile(&mut pressed.clone(), 0.95);
    let least = (SLIDER_TOUCH_SHARE * usual).max(CERTAIN * levels.force_noise_n);
    pressed.iter().map(|f| *f > least).collect()
}

/// Extends the flags to neighbouring samples.
fn widen(bad: &mut [bool], time_s: &[f64]) {
    let flagged: Vec<usize> = (0..bad.len()).filter(|i| bad[*i]).collect();
    let edge = |i: usize| i == 0 || i + 1 == bad.len() || !bad[i - 1] || !bad[i + 1];
    let edges: Vec<usize> = flagged.into_iter().filter(|i| edge(*i)).collect();
    for i in edges {
        let from = time_s.partition_point(|t| *t < time_s[i] - GRIP_CLOSING_MARGIN_S);
        let to = time_s.partition_point(|t| *t <= time_s[i] + GRIP_CLOSING_MARGIN_S);
        bad[from..to].fill(true);
    }
}

/// Mean total force on empty fingers along the table, and its standard error, N.
fn free(signals: &TaskSignals, levels: &Levels, step_s: f64) -> Option<(f64, f64)> {
    if (levels.free.len() as f64) * step_s < PAUSE_S {
        return None;
    }
    let part = (LEAST_FREE_S / step_s).round().max(1.0) as usize;
    let means: Vec<f64> = levels
        .free
        .chunks_exact(part)
        .map(|c| c.iter().map(|i| signals.net_force_n[*i].x).sum::<f64>() / part as f64)
        .collect();
    (means.len() >= 3).then(|| mean_and_error(&means))
}

/// Causes with a constant force at every position: during motion they are equivalent.
const CONSTANT: [&str; 2] = [force_bias::ID, friction_asymmetry::ID];

/// Mean force on empty fingers and its standard error, N. One sensor has one bias: a single recording determines it for
/// all.
fn of_empty_fingers(read: &[Slid]) -> Option<(f64, f64)> {
    let free: Vec<(f64, f64)> = read.iter().filter_map(|s| s.free_n).collect();
    let count = free.len() as f64;
    let mean = free.iter().map(|f| f.0).sum::<f64>() / count;
    let error = free.iter().map(|f| f.1 * f.1).sum::<f64>().sqrt() / count;
    (!free.is_empty()).then_some((mean, error))
}

/// Attributes a constant force along the table. It belongs to the sensor if empty fingers feel it, and otherwise to a
/// tilted table or to friction by direction. It is ambiguous if the fingers were never empty.
fn constants(found: &mut Named, read: &[Slid], weight_n: Option<f64>) {
    let named = |c: &&mut Cause| CONSTANT.contains(&c.id.as_str()) && c.parameters.iter().any(|p| p.unit == "N");
    let Some(cause) = found.causes.iter_mut().find(named) else { return };
    let Some(b) = cause.parameters.first().cloned() else { return };
    found.alternatives.retain(|a| !CONSTANT.contains(&a.id.as_str()) && a.instead_of != cause.id);
    let free = of_empty_fingers(read);
    let (mean, error) = free.unwrap_or_default();
    let felt = mean.abs() > CERTAIN * error && (b.value - mean).abs() < CERTAIN * error.hypot(b.std_error);
    let of_sensor = |cause: &mut Cause| {
        force_bias::ID.clone_into(&mut cause.id);
        cause.kind = Kind::Instrument;
        cause.parameters = vec![parameter("b", b.value, b.std_error, "N")];
    };
    let (others, motion): (&[&str], &str) = if free.is_some() && felt {
        of_sensor(cause);
        cause.evidence += "; empty fingers feel it as well";
        (&[], "")
    } else if free.is_some() {
        // The table's part is the difference from the reading of empty fingers.
        let (tilt_n, error) = (mean - b.value, error.hypot(b.std_error));
        gravity_tilt::ID.clone_into(&mut cause.id);
        cause.kind = Kind::Plant;
        cause.parameters = vec![parameter("force", tilt_n, error, "N")];
        if let Some(weight_n) = weight_n.filter(|w| *w > tilt_n.abs()) {
            cause.parameters.push(parameter("angle", (tilt_n / weight_n).asin(), error / weight_n, "rad"));
        }
        cause.evidence = format!(
            "the sliding block is drawn to one side by {}, and empty fingers feel none of it",
            amount(tilt_n.abs(), "N")
        );
        (
            &[friction_asymmetry::ID],
            "turn the table by half a turn, with the block on it, and slide it again: what a tilt pulls changes its sign",
        )
    } else {
        of_sensor(cause);
        (
            &[gravity_tilt::ID, friction_asymmetry::ID],
            "let go for two seconds before and after the sliding: a bias of the sensor stays, a tilt does not",
        )
    };
    cause.posterior = 1.0 / (1.0 + others.len() as f64);
    let (own, posterior) = (cause.id.clone(), cause.posterior);
    found.alternatives.extend(others.iter().map(|id| Alternative {
        id: (*id).to_owned(),
        instead_of: own.clone(),
        posterior,
        why: "on the move both are one and the same constant force".to_owned(),
    }));
    if others.is_empty() {
        if found.alternatives.is_empty() {
            found.next = None;
        }
        return;
    }
    let separates = std::iter::once(own).chain(others.iter().map(|id| (*id).to_owned())).collect();
    found.next = Some(NextExperiment::in_words(motion, separates, 0.9));
}

/// If the answer asks to let go: the same experiment for a scripted operator, with its probability of success.
fn let_go(found: &mut Named, track: &Track) {
    let size = found.causes.iter().find(|c| c.id == force_bias::ID).and_then(|c| c.parameters.first()).map(|b| b.value);
    let (Some(next), Some(size)) = (&mut found.next, size) else { return };
    if !next.separates.iter().any(|s| s == gravity_tilt::ID) {
        return;
    }
    let at = |share: f64| track.quantile(share, |r| r.motion.position);
    // Rows of empty fingers, before and after, with a row's noise each.
    let rows = 2.0 * FREE_S / track.period_s;
    let lambda = rows * (size / track.force_noise.max(f64::MIN_POSITIVE)).powi(2);
    next.expected_power = proposal::SURE_HUNG * proposal::power(lambda);
    next.experiment = Some(Experiment {
        id: "slide-let-go".to_owned(),
        seconds: 10.0,
        free_s: FREE_S,
        middle: 0.5 * (at(0.02) + at(0.98)),
        half_range: 0.5 * (at(0.98) - at(0.02)),
        fast: track.quantile(0.95, |r| r.motion.velocity.abs()),
        ..Experiment::default()
    });
}

/// Ratio of an estimated to a known mass, and its error, if it differs from one.
fn scale(study: &ChannelFit, model: &Model, mass_kg: Option<f64>) -> Option<(f64, f64)> {
    let (known, solved) = (mass_kg?, study.solved.as_ref()?);
    let k = model.iter().position(|e| e.law().id() == Inertia.id())?;
    let (ratio, error) = (solved.values[k] / known, solved.std_error(k, study.system.rows) / known);
    let differs = (ratio - 1.0).abs() >= MASS_SHARE.max(CERTAIN * error);
    differs.then_some((ratio, error))
}

/// A known mass with a wrong estimate shows a wrong scale of forces or lengths.
fn scales(found: &mut Named, ratio: f64, error: f64) {
    let off = (ratio - 1.0).abs();
    let why = "a mass that comes out wrong is a wrong scale of the forces, or the opposite one of the lengths";
    found.causes.push(Cause {
        id: force_gain::ID.to_owned(),
        kind: Kind::Instrument,
        parameters: vec![parameter("g - 1", ratio - 1.0, error, "1")],
        p_value: held_out_gain::chi_square_tail((off / error).powi(2), 1.0),
        posterior: 0.5,
        standing: None,
        gain: Gain::default().run(Err(AT_ONCE.to_owned())),
        evidence: format!(
            "the block needs {:+.1} % of force for its accelerations beyond what its known weight asks for",
            100.0 * (ratio - 1.0)
        ),
    });
    found.alternatives.push(Alternative {
        id: length_scale::ID.to_owned(),
        instead_of: force_gain::ID.to_owned(),
        posterior: 0.5,
        why: why.to_owned(),
    });
    let motion = "lift the block and hold it still for two seconds: its weight shows the scale of the forces alone";
    let separates = [force_gain::ID, length_scale::ID].map(str::to_owned).to_vec();
    found.next.get_or_insert_with(|| NextExperiment::in_words(motion, separates, 0.95));
}
