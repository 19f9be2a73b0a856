//! Readings of the assistant, from the online estimates and the live world.

use crate::ui::train::lessons::state::{Lessons, Phase};
use crate::ui::train::state::Training;
use crate::ui::train::trainer::live::Trainer;
use estimator::assistant::{Held, Known, Load, Look, Warnings, collision, warnings};
use estimator::online::{Pull, Report};
use haptics::Vec2;
use haptics::world::{Block, Shape, State, World};

/// Detected circle of a handle: centre, m, with the standard errors of its coordinates, and radius, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Circle {
    pub(crate) center_m: Vec2,
    pub(crate) center_error_m: Vec2,
    pub(crate) radius: Known,
}

/// Content of the assistant at one moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Said {
    pub(crate) held: Option<Held>,
    /// Centre of the held object, m in the world.
    pub(crate) held_at_m: Vec2,
    pub(crate) warnings: Warnings,
    pub(crate) pulls: Vec<Pull>,
    pub(crate) circle: Option<Circle>,
}

/// Reason for the assistant's silence, as a sentence; `None` while it is active.
pub fn silent(lessons: &Lessons) -> Option<&'static str> {
    match lessons.open.as_ref()?.phase {
        Phase::Testing | Phase::Asking => Some("In a test you are on your own."),
        // The world is paused behind the result.
        Phase::Grading | Phase::Debrief(_) => Some("The attempt is over. It goes on with the next one."),
        Phase::Brief | Phase::Watching | Phase::Practising => None,
    }
}

pub(crate) fn said(training: &Training) -> Option<Said> {
    if !training.assistant.on || silent(&training.lessons).is_some() {
        return None;
    }
    let trainer = &training.trainer;
    let (_, world) = trainer.scene()?;
    let state = trainer.seen()?;
    let delay = trainer.delay();
    let late_s = if delay.is_none() || delay.predicted { 0.0 } else { delay.round_trip_s };
    let load = Load { limit_n: limit_n(training), late_s };
    let report = trainer.watch.report();
    let held_body = collision::held(state);
    Some(Said {
        held: report.as_deref().and_then(|report| Held::of(report, &look(world, held_body))),
        held_at_m: middle(state, held_body),
        warnings: warnings(world, state, &load),
        pulls: report.as_deref().map(|r| r.pulls.clone()).unwrap_or_default(),
        circle: report.as_deref().and_then(circle),
    })
}

/// Maximum force of a finger, N: the limit of the lesson, or of the servo.
fn limit_n(training: &Training) -> f64 {
    let by_lesson = training.lessons.open.as_ref().map(|open| open.lesson.limit_n);
    by_lesson.unwrap_or_else(|| max_force_n(&training.trainer))
}

fn max_force_n(trainer: &Trainer) -> f64 {
    trainer.config().limits.max_force_n
}

/// Visible properties of a body before any touch, and the empty weight of such a vessel.
fn look(world: &World, body: Option<usize>) -> Look {
    let Some(block) = body.and_then(|k| world.blocks.get(k)) else { return Look::default() };
    Look {
        height_m: Some(block.height_m),
        round: block.shape == Shape::Barrel,
        empty_kg: block.content.map(|content| block.mass_kg - content.mass_kg),
        called: called(block),
        borne: block.shape == Shape::Needle,
    }
}

/// Name of a needle: the membrane supports and pulls it, so its weight is not shown.
pub const NEEDLE: &str = "needle";

/// Visible kind of an object that is neither block nor barrel.
fn called(block: &Block) -> Option<&'static str> {
    match block.shape {
        Shape::Needle => Some(NEEDLE),
        Shape::Cup => Some("paper-cup"),
        Shape::Block | Shape::Barrel => None,
    }
}

/// The same for the only object of a world; the estimator beside the servo knows no names.
pub fn only_thing(world: &World) -> Option<&'static str> {
    match world.blocks.as_slice() {
        [only] => called(only),
        _ => None,
    }
}

fn middle(state: &State, body: Option<usize>) -> Vec2 {
    let tips = state.input.tip_in_world;
    body.and_then(|k| state.bodies.get(k)).map_or(0.5 * (tips[0] + tips[1]), |b| b.center_m)
}

fn circle(report: &Report) -> Option<Circle> {
    let of = |name: &str| {
        let parameter = report.parameters.iter().find(|p| p.object == "crank" && p.name == name && p.identified)?;
        parameter.value.zip(parameter.std_error.filter(|e| e.is_finite()))
    };
    let (x, y, (value, std_error)) = (of("center_x_m")?, of("center_y_m")?, of("radius_m")?);
    let radius = Known { value, std_error };
    Some(Circle { center_m: Vec2::new(x.0, y.0), center_error_m: Vec2::new(x.1, y.1), radius })
}
