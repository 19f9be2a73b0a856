//! A motion planned elsewhere for the scripted hand to follow: the goals of the pair of fingers, at even times.

use super::movement::Goal;

/// Goals at even times, from the start on.
#[derive(Clone, Debug, PartialEq)]
pub struct Route {
    period_s: f64,
    goals: Vec<Goal>,
}

impl Route {
    /// A route of goals that are `period_s` apart; nothing without two of them.
    pub fn new(period_s: f64, goals: Vec<Goal>) -> Option<Self> {
        (period_s > 0.0 && goals.len() > 1).then_some(Self { period_s, goals })
    }

    /// Length, s.
    pub fn duration_s(&self) -> f64 {
        self.period_s * (self.goals.len() - 1) as f64
    }

    /// Goal and its rate (per second; the rate's pinch is unused). Before the start and after the end the hand rests.
    pub fn at(&self, time_s: f64) -> (Goal, Goal) {
        let place = (time_s / self.period_s).clamp(0.0, (self.goals.len() - 1) as f64);
        let first = (place as usize).min(self.goals.len() - 2);
        let (from, to) = (self.goals[first], self.goals[first + 1]);
        let moves = time_s > 0.0 && time_s < self.duration_s();
        let per_s = if moves { 1.0 / self.period_s } else { 0.0 };
        let rate = Goal {
            center_m: (to.center_m - from.center_m) * per_s,
            aperture_m: (to.aperture_m - from.aperture_m) * per_s,
            pinch_n: 0.0,
        };
        (from.lerp(&to, place - first as f64), rate)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{ScriptedOperator, Skill};
    use super::*;
    use crate::Vec2;
    use crate::device::{Command, Device as _};
    use crate::world::{State, presets};

    #[test]
    fn the_hand_follows_the_route_and_is_done_at_its_end() {
        let world = presets::table();
        let state = State::resting(&world);
        let start = Goal::from_tips(state.input.tip_in_world);
        let goals = (0..=100).map(|k| Goal { center_m: start.center_m + Vec2::new(2e-4 * f64::from(k), 0.0), ..start });
        let route = Route::new(0.01, goals.collect()).expect("a route");
        assert!((route.duration_s() - 1.0).abs() < 1e-12);
        let skill = Skill { tremor_m: 0.0, ..Skill::default() };
        let mut operator = ScriptedOperator::on_route(&state, route.clone(), skill, 1);
        let mut worst_m = 0.0_f64;
        for k in 0..1_500 {
            let sample = operator.exchange(&Command::default(), 1e-3);
            let middle = 0.5 * (sample.tip_in_world[0] + sample.tip_in_world[1]);
            worst_m = worst_m.max((middle - route.at(1e-3 * f64::from(k + 1)).0.center_m).norm());
            assert!(operator.finished() == (k >= 1_000) || k == 999, "tick {k}");
        }
        assert!(worst_m < 1e-3, "the hand was {worst_m} m off");
        assert!(Route::new(0.01, vec![start]).is_none());
    }
}
