//! Diagnosis of a toggle switch that two fingers throw back and forth.
//!
//! The curve of a switch is measured, not derived. Without a world, its curve over position is estimated in both
//! directions, and only effects of speed, time and sensors can be identified. With a world its curve is the model, and
//! deviations from it are candidates as well.

pub(crate) mod curve;
pub(crate) mod experiment;
pub(crate) mod held_knob;
pub(crate) mod measured_curve;
pub(crate) mod model;
pub(crate) mod rows;
pub(crate) mod sensor_zero;
pub(crate) mod stop;
pub(crate) mod throw;

use crate::diagnose::answer::build::{Evidence, answer};
use crate::diagnose::answer::part::Part;
use crate::diagnose::contract::{Alternative, Cause, NextExperiment, NotExcited};
use crate::diagnose::extension::hypothetical_worlds::{Act, Simulated};
use crate::diagnose::findings::Findings;
use crate::diagnose::free_run::FreeRun;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::{
    added_constraint, backlash, coulomb_friction, force_gain, friction_asymmetry, friction_change, hysteresis,
    length_scale, local_resistance, pad_compliance, return_spring, viscous_friction,
};
use crate::diagnose::model_error::twin::{Twin, is_upright};
use crate::diagnose::options::Options;
use crate::diagnose::recording::sample_faults;
use crate::diagnose::selection::comparison::Compared;
use crate::diagnose::selection::rules::Rules;
use foundation::estimate::EstimateError;
use haptics::recording::Recording;
use model::Known;
use throw::Push;

/// All comparisons of the recordings of one switch.
struct Look {
    seen: rows::Seen,
    push: Push,
    curve: Option<curve::Beside>,
    stop: Option<stop::Pressed>,
}

fn look(recordings: &[Recording], bad: &[Vec<bool>], options: &Options) -> Result<Look, EstimateError> {
    let seen = rows::seen(recordings, bad)?;
    let known = options.world.as_ref().and_then(Known::of);
    let rules = Rules::of_channel(seen.period_s);
    let push = throw::push(&seen, rules)?;
    options.progress.tell(0.5)?;
    let curve = match &known {
        Some(known) => curve::curve(&push, known, seen.period_s, rules)?,
        None => None,
    };
    // With another knob force or a sensor error, the knob rests at another position in its stops.
    let has_changed = push.compared.study.has(friction_change::ID);
    let other = has_changed || curve.as_ref().is_some_and(|c| !c.compared.study.chosen.is_empty());
    let stop = if other { None } else { stop::stop(&seen, known.as_ref(), rules)? };
    Ok(Look { seen, push, curve, stop })
}

/// The channels of other recordings of the same switch.
pub fn channels(recordings: &[Recording], options: &Options) -> Result<Vec<Compared>, EstimateError> {
    let bad: Vec<Vec<bool>> = recordings.iter().map(|r| sample_faults::faults(r).bad).collect();
    let Look { push, curve, stop, .. } = look(recordings, &bad, options)?;
    Ok(std::iter::once(push.compared).chain(curve.map(|c| c.compared)).chain(stop.map(|s| s.compared)).collect())
}

/// Diagnoses recordings of one switch.
pub fn switch(recordings: &[Recording], options: &Options, faults: &[Cause]) -> Result<Findings, EstimateError> {
    let of_samples: Vec<sample_faults::Faults> = recordings.iter().map(sample_faults::faults).collect();
    let bad: Vec<Vec<bool>> = of_samples.iter().map(|f| f.bad.clone()).collect();
    let has_world = options.world.as_ref().and_then(Known::of).is_some();
    let Look { seen, push, curve, stop } = look(recordings, &bad, options)?;
    let mut beside = Evidence {
        model: if has_world { "curve and stops of the world" } else { "any curve there and back, pads that give" }
            .to_owned(),
        causes: faults.iter().cloned().chain(of_samples.into_iter().flat_map(|f| f.causes)).collect(),
        atlas: options.atlas,
        ..Evidence::default()
    };
    unseen(&seen, has_world, &mut beside);
    let mut parts = vec![Part::of(&push.compared, &push).running(FreeRun::Channel(&push.thrown))];
    parts.extend(curve.as_ref().map(|c| Part::of(&c.compared, c).running(FreeRun::Channel(&c.knob))));
    parts.extend(stop.as_ref().map(|s| Part::of(&s.compared, s).running(FreeRun::Channel(&s.pads))));
    let parts: Vec<Part<'_>> = parts.into_iter().map(|part| part.in_world(&InWorld)).collect();
    let known = options.world.as_ref().and_then(Known::of);
    let asked = |open: &[Alternative]| {
        let on_curve = curve.as_ref().map(|c| &c.compared);
        experiment::propose(open, &seen, (&push, on_curve, known.as_ref())).or_else(|| next(open))
    };
    let mut found = answer(&parts, Evidence { next: &asked, ..beside });
    if options.twins && is_upright(faults) {
        found.twin = Twin::of_channels([(&push.compared.study, push.placed())]).map(Box::new);
    }
    Ok(found)
}

/// Causes that no recording of this kind shows.
fn unseen(seen: &rows::Seen, has_world: bool, beside: &mut Evidence<'_>) {
    let mut add = |ids: &[&str], why: &str| {
        beside.not_excited.extend(ids.iter().map(|id| NotExcited::new(id, why)));
    };
    if !has_world {
        let why = "the curve is the recording's own; name a world that was captured before to compare it with";
        let ids =
            [coulomb_friction::ID, friction_asymmetry::ID, return_spring::ID, local_resistance::ID, force_gain::ID];
        add(&ids, why);
        add(&[length_scale::ID, added_constraint::ID], why);
    }
    add(
        &[hysteresis::ID, backlash::ID],
        "the motion turned at the stops only; turn round in the middle of the way, in touch",
    );
    for (side, way) in [(0, "right"), (1, "left")] {
        if seen.throws[side] == 0 {
            beside
                .warnings
                .push(format!("no throw to the {way} was seen: what the knob asks for that way is not looked at"));
        }
    }
}

/// Recording that would settle the open questions.
fn next(open: &[Alternative]) -> Option<NextExperiment> {
    let motion = "throw the switch over to both sides, three times slowly and three times fast, press on at each stop, and let go for \
                  two seconds before and after";
    NextExperiment::of_first(open, motion, 0.8)
}

/// Causes that a world's switch or its pads can have. A world has no change of friction over time and no length scale.
pub(crate) const POSSIBLE: [&str; 7] = [
    viscous_friction::ID,
    coulomb_friction::ID,
    friction_asymmetry::ID,
    return_spring::ID,
    local_resistance::ID,
    added_constraint::ID,
    pad_compliance::ID,
];

/// Effects of a switch's channel. Its base model is already in the world.
pub(crate) struct InWorld;

impl Simulated for InWorld {
    fn act(&self, candidate: &Candidate, values: &[f64]) -> Option<Act> {
        POSSIBLE.contains(&candidate.id).then(|| (candidate.id.to_owned(), candidate.parameters(values)))
    }
}
