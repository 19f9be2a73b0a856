//! Answer of a motion along one coordinate, and of the paths beside it.

use crate::diagnose::answer::atlas;
use crate::diagnose::answer::atlas::Atlas;
use crate::diagnose::answer::build::{Draft, Evidence, draft};
use crate::diagnose::answer::part::{Part, Role, Told};
use crate::diagnose::answer::time_series::course;
use crate::diagnose::contract::{CauseParameter, NotExcited};
use crate::diagnose::data::direction::STANDS;
use crate::diagnose::data::regression_data::{Model, Place, Row, Track};
use crate::diagnose::experiment::proposal::{propose, turned_track};
use crate::diagnose::extension::hypothetical_worlds::hypotheses;
use crate::diagnose::extension::model::{effects, plain};
use crate::diagnose::findings::Findings;
use crate::diagnose::free_run::FreeRun;
use crate::diagnose::hypotheses::all::widen;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::{backlash, force_gain, friction_asymmetry, hysteresis, length_scale};
use crate::diagnose::model_error::twin::{Twin, is_upright};
use crate::diagnose::recording::time_delay::{apart, rest_s, skew};
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::held_out_gain::rms;
use crate::diagnose::selection::profile_likelihood::of_hardening_spring;
use foundation::tasks::SystemState;

/// The draft of the answer of one object's recordings. `paths`: comparisons beside the force.
pub fn explain(
    track: &Track,
    model: &Model,
    study: &ChannelFit,
    paths: Vec<Part<'_>>,
    evidence: Evidence<'_>,
) -> Draft {
    let along: Vec<bool> = track.rows.iter().map(|r| r.place == Place::Along).collect();
    let picks = study.picks();
    let (end, end_train) = rms(study, &picks, &along);
    let coordinate = Coordinate { track, study, is_put_together: evidence.skew_s != 0.0 };
    let force = Part {
        role: Role::Coordinate,
        study,
        channel: if track.freely.is_some() { "motion" } else { "force" },
        unit: track.force_unit(),
        floor: if track.freely.is_some() { end_train.min(end) } else { track.force_noise.hypot(track.inertial_noise) },
        noise: track.force_noise,
        along: &along,
        state: track.rows.iter().map(|row| state(track, row)).collect(),
        view: None,
        told: &coordinate,
        free_run: FreeRun::Coordinate(track, model),
        in_world: None,
    };
    let parts: Vec<Part<'_>> = std::iter::once(force).chain(paths).collect();
    let next = |open: &[_]| {
        if track.freely.is_some() { turned_track(open) } else { propose(track, model, study, open) }
    };
    let mut evidence = Evidence { next: &next, ..evidence };
    if evidence.model.is_empty() {
        evidence.model = model.iter().map(|e| e.law().id()).collect::<Vec<_>>().join("+");
    }
    evidence.not_excited.extend(without_reversals(track));
    evidence.delay.rest_s = rest_s(study, &picks);
    let atlas = if evidence.atlas { atlas::atlas(track, study) } else { Atlas::default() };
    // The force of a replay is written in the axes of the recording.
    let twin = (evidence.twins && is_upright(&evidence.causes)).then(|| Twin::of(track, study)).flatten().map(Box::new);
    let mut draft = draft(&parts, evidence);
    draft.findings = Findings {
        twin,
        plain: plain(track, model, study),
        effects: effects(track, model, study),
        course: course(track, study),
        atlas,
        per_inertia: track.freely.is_some_and(|free| !free.is_known),
        hypotheses: hypotheses(track, model, study),
        ..draft.findings
    };
    draft
}

/// Force along a coordinate.
struct Coordinate<'a> {
    track: &'a Track,
    study: &'a ChannelFit,
    /// True if an offset between force and motion was removed before: its sentence stands for what remains of it.
    is_put_together: bool,
}

impl Told for Coordinate<'_> {
    fn is_cause(&self, k: usize) -> bool {
        skew(self.study, k, self.track).is_none()
    }

    fn excuse(&self, k: usize) -> Option<String> {
        skew(self.study, k, self.track).filter(|_| !self.is_put_together).map(apart)
    }

    fn states(&self, k: usize, candidate: &Candidate, mut found: Vec<CauseParameter>) -> Vec<CauseParameter> {
        widen(candidate.id, &mut found, self.track);
        of_hardening_spring(self.track, self.study, k).unwrap_or(found)
    }
}

/// Channel and state of a row.
fn state(track: &Track, row: &Row) -> Option<(&'static str, SystemState)> {
    match row.place {
        // A free motion has no measured force.
        Place::Along if track.freely.is_some() => Some(("force that the motion needs", SystemState::FreeMotion)),
        Place::Along if row.open > STANDS => Some(("force along the motion", SystemState::Holding)),
        Place::Along => Some(("force along the motion", SystemState::Turning)),
        Place::FreeX => Some(("horizontal force", SystemState::FreeMotion)),
        Place::FreeY => Some(("vertical force", SystemState::FreeMotion)),
        // Displacements, in newtons of the same noise.
        Place::Stuck { .. } => None,
    }
}

/// Causes that act at reversals alone, for a motion without any.
fn without_reversals(track: &Track) -> impl Iterator<Item = NotExcited> {
    // Along one coordinate, friction by direction then equals dry friction.
    let by_direction = (!track.planar).then_some(friction_asymmetry::ID);
    let hidden = [backlash::ID, hysteresis::ID].into_iter().chain(by_direction).filter(|_| track.goes_one_way());
    hidden.map(|id| NotExcited::new(id, "no reversal in the recording; move to and fro, also in short strokes"))
}

/// Causes that no motion shows unless a quantity is known. `weight`, `length`: true if one is known.
pub fn without_known(weight: bool, length: bool) -> Vec<NotExcited> {
    let hidden = [
        (force_gain::ID, weight, "no weight is known; state one in the sidecar, or hang one on"),
        (
            length_scale::ID,
            length,
            "no length is known, so a factor of all lengths cannot show; state radius_m in the sidecar",
        ),
    ];
    hidden.into_iter().filter(|(_, known, _)| !known).map(|(id, _, why)| NotExcited::new(id, why)).collect()
}
