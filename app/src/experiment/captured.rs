//! Desired hand positions over time, with a needle at its membrane and around the knob of a switch.

use super::timetable::{CLEARANCE_M, CLOSE_S, LEAST_FREE_S, REACH_S, Writer, unknown};
use estimator::diagnose::{Experiment, Insertions, Throws};
use haptics::Vec2;
use haptics::device::{HandGoal, HandImpedance, Skill};
use haptics::world::{Membrane, Shape, Switch, World};

/// Height from which a hand approaches a needle and a knob, m.
const OVER_NEEDLE_M: f64 = 0.010;
const OVER_KNOB_M: f64 = 0.020;
/// Factor on the pinch force for a needle: it is pushed along its own length.
const FIRMER: f64 = 1.4;
/// Distance between insertions, m; the first one is beside the needle's initial position.
const APART_M: f64 = 8e-3;
const BESIDE_M: f64 = 2e-3;
/// Share of the membrane used for insertions.
const WITHIN: f64 = 0.8;
/// Distance beyond the expected puncture over which the hand still compensates the membrane's full force, m. Over the
/// same distance again the compensation falls to zero.
const PUSHES_ON_M: f64 = 1e-3;
/// Deflection of the arm's spring with which a knob is pressed against its stop, m.
const PRESSED_M: f64 = 2.5e-3;
/// Limits below which a throw is called slow, and above which fast, as shares of the maximum speed.
const SLOW: f64 = 0.3;
const FAST: f64 = 0.7;

/// Position of insertion `k` of `count`, m from the centre of the membrane.
pub(super) fn place_m(membrane: &Membrane, count: usize, k: usize) -> f64 {
    let apart = APART_M.min(2.0 * WITHIN * membrane.half_width_m / count.max(1) as f64);
    apart * (k as f64 - 0.5 * (count.max(1) - 1) as f64) + BESIDE_M
}

impl Writer {
    /// Takes the needle, performs the insertions, puts it back.
    pub(super) fn pierce(&mut self, membrane: &Membrane, world: &World, asked: &Experiment) -> Result<(), String> {
        let motion = Insertions::of(asked).ok_or_else(|| unknown(asked))?;
        let needle = world.blocks.iter().find(|b| b.shape == Shape::Needle);
        let needle = needle.ok_or("There is no needle in this world; do it on the real one and load the recording.")?;
        // By its upper third, as in a lesson.
        let grip = Vec2::new(0.0, needle.height_m / 6.0);
        let over_point = Vec2::new(0.0, 0.5 * needle.height_m) + grip;
        let stands = needle.start.center_m + grip;
        self.take(asked.free_s, (stands, OVER_NEEDLE_M), needle.width_m, FIRMER * Skill::default().pinch_n);
        let held = self.at;
        let at = |x_m: f64, depth_m: f64| HandGoal {
            center_m: membrane.center_m + Vec2::new(x_m, -depth_m) + over_point,
            ..held
        };
        let place = |k: usize| place_m(membrane, motion.count(), k);
        self.go(CLOSE_S, HandGoal { center_m: stands - Vec2::new(0.0, motion.depth_m(0.0)), ..held });
        self.go(REACH_S, at(place(0), motion.depth_m(0.0)));
        self.say("Lift the needle over the sheet.", true);
        let begun_s = self.now_s();
        let mut pushed = Pushed::default();
        let mut last = 0;
        while self.now_s() - begun_s < motion.duration_s() {
            let time_s = self.now_s() - begun_s;
            let (k, share) = motion.place(time_s);
            if k != last {
                self.say(words(last, motion.count()), true);
                (last, pushed) = (k, Pushed::default());
            }
            let x_m = if k + 1 < motion.count() { place(k) + (place(k + 1) - place(k)) * share } else { place(k) };
            let depth_m = motion.depth_m(time_s);
            self.at = at(x_m, depth_m + pushed.ahead_m(membrane, depth_m));
            self.goals.push(self.at);
        }
        self.say(words(last, motion.count()), true);
        self.go(REACH_S, HandGoal { center_m: stands - Vec2::new(0.0, motion.depth_m(0.0)), ..held });
        self.go(CLOSE_S, HandGoal { center_m: stands, ..held });
        self.say("Put it back.", true);
        self.let_go(asked.free_s, OVER_NEEDLE_M, needle.width_m);
        Ok(())
    }

    /// Throws the switch to both sides.
    pub(super) fn throw(&mut self, switch: &Switch, asked: &Experiment) -> Result<(), String> {
        let ends = [switch.curve.points.first(), switch.curve.points.last()].map(|p| p.map_or(0.0, |p| p.at_m));
        let [left, right] = ends.map(|end| switch.knob_in_world(end));
        let released_m = 0.5 * (right.x - left.x);
        let pressed_m = released_m + 0.5 * CLEARANCE_M + PRESSED_M;
        let motion = Throws::of(asked, pressed_m, released_m).ok_or_else(|| unknown(asked))?;
        let middle = 0.5 * (left + right);
        let around = HandGoal { center_m: left, aperture_m: 2.0 * switch.knob_radius_m + CLEARANCE_M, pinch_n: 0.0 };
        self.wait(asked.free_s.max(LEAST_FREE_S));
        self.say("Touch nothing.", false);
        self.go(REACH_S, HandGoal { center_m: left + Vec2::new(0.0, OVER_KNOB_M), ..around });
        self.go(REACH_S, around);
        self.wait(CLOSE_S);
        self.say("Go down around the knob with open fingers.", false);
        let begun_s = self.now_s();
        let ends_s = |k: usize| motion.all().get(k + 1).map_or(motion.duration_s(), |next| next.begins_s);
        for (k, throw) in motion.all().iter().enumerate() {
            while self.now_s() - begun_s < ends_s(k) {
                let x_m = middle.x + motion.at_m(self.now_s() - begun_s);
                self.at = HandGoal { center_m: Vec2::new(x_m, left.y), ..around };
                self.goals.push(self.at);
            }
            let side = if throw.right { "right" } else { "left" };
            let pace = match throw.fast_m_s / asked.fast {
                share if share < SLOW => ", slowly",
                share if share > FAST => ", fast",
                _ => "",
            };
            self.say(format!("Push it over to the {side}{pace}; press on at the stop, then let it go."), false);
        }
        self.go(REACH_S, HandGoal { center_m: self.at.center_m + Vec2::new(0.0, OVER_KNOB_M), ..self.at });
        self.go(REACH_S, self.away);
        self.say("Take the hand away.", false);
        self.wait(asked.free_s.max(LEAST_FREE_S));
        self.say("Touch nothing.", false);
        Ok(())
    }
}

/// State of an insertion: whether the membrane is pierced at this position.
#[derive(Clone, Copy, Debug, Default)]
struct Pushed {
    through: bool,
}

impl Pushed {
    /// Lead of the hand over the needle, m: the arms deflect under the reaction of the membrane.
    fn ahead_m(&mut self, membrane: &Membrane, depth_m: f64) -> f64 {
        let law = &membrane.law;
        let beyond_m = depth_m - law.puncture_depth_m();
        self.through |= beyond_m > 2.0 * PUSHES_ON_M;
        if self.through {
            return 0.0;
        }
        let share = (2.0 - beyond_m / PUSHES_ON_M).clamp(0.0, 1.0);
        share * 0.5 * law.loading_n(depth_m).min(law.puncture_n) / HandImpedance::default().stiffness_n_m
    }
}

fn words(k: usize, count: usize) -> String {
    let place = if count > 1 { format!(" ({} of {count})", k + 1) } else { String::new() };
    format!(
        "Push in a little and draw back; push through; move to and fro in the hole, slowly and fast; draw out{place}."
    )
}

#[cfg(test)]
mod tests {
    use super::super::timetable::tests::asked;
    use super::*;
    use crate::experiment::perform::perform;
    use crate::experiment::timetable::Timetable;
    use estimator::diagnose::SensorFault;
    use estimator::pipeline;
    use haptics::world::presets;

    #[test]
    fn a_held_needle_goes_through_as_often_as_asked_and_what_the_sheet_is_like_is_read_from_it() {
        let world = presets::needle();
        let law = &world.membrane.as_ref().expect("a sheet").law;
        let half_range = 2.5e-3;
        let asked = Experiment {
            middle: law.puncture_depth_m() + half_range,
            half_range,
            fast: 0.04,
            seconds: 12.0,
            ..asked("pierce-slow-fast")
        };
        let table = Timetable::new(&world, &asked, "so").expect("it can be done");
        let recording = perform(&table, &asked, "a needle", (&SensorFault::default(), 0.01), 1, &|_| true);
        let fit = pipeline::analyse(&[recording.expect("not ended")], &pipeline::Options::default()).expect("a fit");
        let found = &fit.world.membrane.expect("a sheet").law;
        assert!((found.puncture_n / law.puncture_n - 1.0).abs() < 0.1, "{found:?}");
        assert!((found.friction_n / law.friction_n - 1.0).abs() < 0.3, "{found:?}");
    }

    #[test]
    fn a_switch_is_thrown_over_both_ways_and_what_it_asks_for_is_read_from_it() {
        let world = presets::switch();
        let asked = Experiment { half_range: 0.014, fast: 0.08, seconds: 12.0, ..asked("throw-slow-fast") };
        let table = Timetable::new(&world, &asked, "so").expect("it can be done");
        assert!(table.steps.iter().any(|s| s.words.contains("fast")) && table.steps.iter().all(|s| !s.holds));
        let recording = perform(&table, &asked, "a switch", (&SensorFault::default(), 0.01), 1, &|_| true);
        let fit = pipeline::analyse(&[recording.expect("not ended")], &pipeline::Options::default()).expect("a fit");
        let most = |world: &World| {
            let points = &world.switch.as_ref().expect("a switch").curve.points;
            points.iter().map(|p| p.forward_n).fold(0.0, f64::max)
        };
        assert!((most(&fit.world) / most(&world) - 1.0).abs() < 0.15, "{}", most(&fit.world));
    }
}
