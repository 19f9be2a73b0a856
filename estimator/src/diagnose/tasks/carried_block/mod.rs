//! Diagnosis of carried blocks: grip width, net force and standing height, each with its own causes.
//!
//! Without a world the base model is the thesis's: rigid widths and plain means of weights and heights. With a world,
//! its pads, inertia and cables belong to the base model. Weights and widths are estimated in both, unless the sidecar
//! states them.

pub(crate) mod cable;
pub(crate) mod experiment;
pub(crate) mod free_body;
pub(crate) mod grasp_slip;
pub(crate) mod grip_width;
pub(crate) mod net_force;
pub(crate) mod net_force_candidates;
#[cfg(test)]
#[path = "../../../../tests/diagnosis/recorded.rs"]
mod recorded;
pub(crate) mod regrasp;
pub(crate) mod rows;
pub(crate) mod signals;
pub(crate) mod standing_height;
pub(crate) mod stands;

use crate::diagnose::answer::build::{Evidence, draft};
use crate::diagnose::answer::part::Part;
use crate::diagnose::answer::put_back::PutBack;
use crate::diagnose::contract::{Alternative, Cause, Final, NextExperiment, NotExcited};
use crate::diagnose::findings::{DelayFindings, Figures, Findings};
use crate::diagnose::free_run::FreeRun;
use crate::diagnose::hypotheses::{
    added_constraint, fingertip_slip, force_bias, force_cross_axis, force_drift, force_gain, friction_change,
    gravity_tilt, length_scale, mass_change, pad_compliance,
};
use crate::diagnose::model_error::twin::{Twin, is_upright};
use crate::diagnose::options::Options;
use crate::diagnose::recording::sample_faults;
use crate::diagnose::selection::comparison::Compared;
use crate::diagnose::selection::rules::Rules;
use foundation::estimate::EstimateError;
use haptics::recording::Recording;
use haptics::world::World;
use net_force::Carry;
use signals::Seen;

/// Diagnoses recordings of the same blocks.
pub fn blocks(
    recordings: &[Recording],
    options: &Options,
    faults: &[Cause],
    put_back: Option<&PutBack<'_>>,
) -> Result<Findings, EstimateError> {
    let seen = recordings.iter().map(Seen::of).collect::<Result<Vec<_>, _>>()?;
    let world = options.world.as_ref();
    let (carry, grasp, ground) = look(&seen, world)?;
    let mut beside = Evidence {
        model: if world.is_some() {
            "world: weight+inertia+pads"
        } else {
            "weight and its mass+rigid widths+plain heights"
        }
        .to_owned(),
        causes: faults.iter().cloned().chain(sample_faults::causes(recordings)).collect(),
        atlas: options.atlas,
        ..Evidence::default()
    };
    if let (Some(ground), Some(world)) = (&ground, world) {
        let scaled = grasp.as_ref().is_some_and(|g| g.has(length_scale::ID));
        let faulty = scaled || carry.has(force_cross_axis::ID) || carry.compared.structured().is_some();
        regrasped(ground, &seen, world, faulty, &mut beside);
    }
    unseen(&seen, &mut beside.not_excited);
    let mut parts = vec![Part::of(&carry.compared, &carry).running(FreeRun::Channel(&carry.airborne)).in_world(&carry)];
    parts.extend(grasp.as_ref().map(|grasp| Part::of(&grasp.compared, grasp).running(FreeRun::Channel(&grasp.pads))));
    parts.extend(ground.as_ref().map(|ground| Part::of(&ground.compared, ground)));
    let asked = |open: &[Alternative]| experiment::propose(open, &carry, &seen).or_else(|| next(open));
    // Delay of the net force, in which it is best seen. The strongest cause may be of another channel.
    if let Some((late, force)) = carry.late.zip(parts.first()) {
        let figures = force.figures();
        // Other terms of the final model may absorb part of a delay. The delay is therefore judged by its own model,
        // too.
        let end = Final { heldout_rms_n: (late.plain_rms * figures.end.heldout_rms_n).sqrt(), ..figures.end };
        beside.delay = DelayFindings::of_scan(late, Figures { end, ..figures });
    }
    let is_replayed = options.twins && is_upright(faults);
    let replayed = || Twin::of_channels([(&carry.compared.study, carry.airborne.rows.placed())]);
    let twin = is_replayed.then(replayed).flatten().map(Box::new);
    let mut draft = draft(&parts, Evidence { next: &asked, ..beside });
    draft.findings.twin = twin;
    Ok(draft.finish(put_back))
}

/// Adds a slip between pick-up and placement. `faulty`: sensor faults were found that have the same effect.
fn regrasped(
    ground: &standing_height::Ground,
    seen: &[Seen<'_>],
    world: &World,
    faulty: bool,
    beside: &mut Evidence<'_>,
) {
    let within = ground.compared.study.has(fingertip_slip::ID);
    match regrasp::moved(ground, seen, world) {
        Some(cause) if faulty => beside
            .warnings
            .push(format!("{}; what is wrong with the sensors would do the same, so no slip is named", cause.evidence)),
        cause => beside.causes.extend(cause.filter(|_| !within)),
    }
}

/// Comparisons of net force, grip width and grip height.
fn look<'a>(
    seen: &'a [Seen<'a>],
    world: Option<&World>,
) -> Result<(Carry<'a>, Option<grip_width::Grasp>, Option<standing_height::Ground>), EstimateError> {
    let rules = Rules::of_channel(seen.iter().map(|s| s.period_s).fold(0.0, f64::max));
    let carry = net_force::carry(seen, world, rules)?;
    let grasp = grip_width::grasp(seen, world, rules)?;
    // A block with a taut cable is supported by more than the ground.
    let mut ground = if carry.has(added_constraint::ID) {
        None
    } else {
        standing_height::ground(seen, world, carry.cross(), rules)?
    };
    if let Some((ground, errors)) = ground.as_mut().zip(carry.compared.structured()) {
        // The net force dates the rests. Its structured errors displace contacts, which looks like a slip.
        ground.compared.study.discount(fingertip_slip::ID, errors);
    }
    Ok((carry, grasp, ground))
}

/// The channels of other recordings of the same blocks.
pub fn channels(recordings: &[Recording], options: &Options) -> Result<Vec<Compared>, EstimateError> {
    let seen = recordings.iter().map(Seen::of).collect::<Result<Vec<_>, _>>()?;
    let (carry, grasp, ground) = look(&seen, options.world.as_ref())?;
    let rest = grasp.map(|g| g.compared).into_iter().chain(ground.map(|g| g.compared));
    Ok(std::iter::once(carry.compared).chain(rest).collect())
}

/// Causes that no recording of this kind shows.
fn unseen(seen: &[Seen<'_>], found: &mut Vec<NotExcited>) {
    let mut add = |id: &str, why: &str| found.push(NotExcited::new(id, why));
    let knows = |name: &str| seen.iter().any(|s| (1..=s.count).any(|k| s.known(k, name).is_some()));
    if !knows("weight_N") && !knows("mass_kg") {
        add(force_gain::ID, "no weight is known; state one in the sidecar");
    }
    if !knows("width_m") {
        add(length_scale::ID, "no width is known; state one in the sidecar");
    }
    add(friction_change::ID, "the fingers hold the blocks and do not slide on them");
}

/// Recording that would settle the open questions.
fn next(open: &[Alternative]) -> Option<NextExperiment> {
    let first = open.first()?;
    let pair = [first.instead_of.as_str(), first.id.as_str()];
    let is = |a: &str, b: &str| pair.contains(&a) && pair.contains(&b);
    let (motion, power) = if is(mass_change::ID, force_drift::ID) {
        ("let go for two seconds before and after the carry: a drift of the sensor stays, a lost weight does not", 0.95)
    } else if is(mass_change::ID, force_bias::ID) || is(force_bias::ID, force_drift::ID) {
        ("start and end with two seconds of free motion", 0.95)
    } else if is(pad_compliance::ID, length_scale::ID) {
        ("squeeze the standing block softly and hard, several times", 0.95)
    } else if is(gravity_tilt::ID, force_cross_axis::ID) {
        ("turn the hand's base by a quarter turn and carry the same block again", 0.95)
    } else {
        (
            "repeat the carry with softer and harder grips, fast and slow, and let go for two seconds before and after",
            0.7,
        )
    };
    NextExperiment::of_first(open, motion, power)
}
