//! Simulated mouse hand that repeats the expert's performance more slowly: for screenshots and tests with a manual
//! clock.

use crate::text::sentence::sentence;
use crate::ui::train::lessons::practising;
use crate::ui::train::lessons::state::Phase;
use crate::ui::train::lessons::trace::Point;
use crate::ui::train::state::Training;
use crate::ui::train::trainer::live::Trainer;
use crate::ui::train::trainer::pointer_grip::Pinch;
use estimator::training::lesson::Lesson;
use haptics::Vec2;
use haptics::world::State;

/// Duration of a frame, s.
const FRAME_S: f64 = 1.0 / 60.0;
/// Speed relative to the expert: a mouse is slower than an expert's hand.
const SLOWER: f64 = 0.6;
/// Minimum force of an intended grip, N.
const GRIP_N: f64 = 0.15;
/// Minimum pinch force of a mouse, N.
const WEAKEST_N: f64 = 0.6;
/// Minimum intended pull against a constraint, N, and additional travel of the mouse beyond the expert's, m.
const PULL_N: f64 = 0.2;
const UNTIL_TAUT_M: f64 = 0.004;
/// Additional depth, beyond the expert's, to which a mouse presses the held object, m.
const UNTIL_IT_GIVES_M: f64 = 0.003;
/// Minimum force of an intended push to the side, N.
const PUSH_N: f64 = 0.1;

/// Performs the open lesson with the mouse for some time, or until its attempt is over.
pub fn follow_expert(training: &mut Training, seconds: f64) {
    let mut left_s = seconds;
    while left_s > 0.0 {
        let Some(open) = training.lessons.open.as_ref() else { return };
        let (Some(trace), true) = (&open.expert, matches!(open.phase, Phase::Practising | Phase::Testing)) else {
            return;
        };
        let now_s = training.trainer.scene().map_or(0.0, |(snapshot, _)| snapshot.state.time_s);
        let Some(point) = trace.at(SLOWER * now_s).copied() else { return };
        point_as(&mut training.trainer, &point);
        training.trainer.advance(FRAME_S);
        if !practising::see_lesson(training)
            || training.lessons.open.as_ref().is_some_and(|open| open.progress.is_completed())
        {
            return;
        }
        left_s -= FRAME_S;
    }
}

fn point_as(trainer: &mut Trainer, point: &Point) {
    let pinch = &mut trainer.pinch;
    let pointed = Pointed::of(point, pinch.opening_m());
    pinch.move_to(pointed.at_m);
    pinch.button = pointed.pinches;
    if pointed.pinches {
        pinch.strengthen(pointed.strength_n - pinch.strength_n());
    }
}

/// Position and action of the mouse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pointed {
    /// Position of the pointer, m in the world.
    pub at_m: Vec2,
    /// True if its button is down.
    pub pinches: bool,
    /// Pinch force, N.
    pub strength_n: f64,
    /// True if it presses down with the held object until that yields.
    pub presses: bool,
}

impl Pointed {
    /// Mouse action for a point of the expert's trace; `opening_m` is the distance of the mouse's open fingers.
    fn of(point: &Point, opening_m: f64) -> Self {
        let pinches = point.grip_n() > GRIP_N;
        let apart_m = point.tips_in_world[1].x - point.tips_in_world[0].x;
        let push_n = point.tip_force_n[0].x + point.tip_force_n[1].x;
        let farther_m = if pinches && push_n.abs() > PULL_N {
            // A person pulls a visible cable until it is taut.
            UNTIL_TAUT_M
        } else if !pinches && push_n.abs() > PUSH_N {
            // Fingers that are farther apart push later.
            0.5 * (opening_m - apart_m).max(0.0)
        } else {
            0.0
        };
        // A person continues to press down until the object yields.
        let presses = pinches && point.tip_force_n[0].y + point.tip_force_n[1].y < -PULL_N;
        let deeper_m = if presses { UNTIL_IT_GIVES_M } else { 0.0 };
        let at_m = point.wanted_m() + Vec2::new(farther_m * push_n.signum(), -deeper_m);
        Self { at_m, pinches, strength_n: point.grip_n().max(WEAKEST_N), presses }
    }
}

/// Mouse actions of a person in a lesson, `every_s` seconds apart: the expert's path, as slow as in
/// [`Session::follow_expert`].
pub fn pointer_through(lesson: &Lesson, every_s: f64) -> Result<Vec<Pointed>, String> {
    let trace = crate::ui::train::lessons::trace::of_expert(lesson)?;
    let world = lesson.world(0).map_err(|error| sentence(&error.to_string()))?;
    let mut pinch = Pinch::default();
    pinch.prepare_for(&world, &State::resting(&world));
    let count = (trace.duration_s() / (SLOWER * every_s)).ceil() as usize;
    let at = |k: usize| trace.at(SLOWER * every_s * k as f64).map(|point| Pointed::of(point, pinch.opening_m()));
    Ok((0..=count).filter_map(at).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pointer_never_opens_or_closes_for_a_moment() {
        const EVERY_S: f64 = 0.033;
        /// Minimum duration of an intended button press, s.
        const SHORTEST_S: f64 = 0.2;
        let (lessons, problems) = crate::lessons::all(None);
        assert!(problems.is_empty(), "{problems:?}");
        for lesson in lessons {
            let way = pointer_through(&lesson, EVERY_S).expect("a way");
            for part in way.chunk_by(|a, b| a.pinches == b.pinches) {
                let lasts_s = EVERY_S * part.len() as f64;
                assert!(lasts_s > SHORTEST_S, "{}: {lasts_s:.2} s", lesson.id);
            }
        }
    }
}
