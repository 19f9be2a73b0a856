//! A switch that is thrown.

use haptics::world::{State, World};
use schemars::JsonSchema;
use serde::Serialize;

/// A knob that is nearer to an end than this share of its way stands there.
const AT_AN_END: f64 = 0.1;
/// A knob that was this share of its way from its end and went back was pushed in vain.
const PUSHED: f64 = 1.0 / 3.0;

/// Of a switch.
#[derive(Clone, Copy, Debug, Default, PartialEq, JsonSchema, Serialize)]
pub struct SwitchMeasures {
    /// Times it went over from one side to the other.
    pub throws: usize,
    /// Times it was pushed a third of its way or more and went back.
    pub fell_back: usize,
    /// Largest force of a finger while the knob stood at one of its ends, N.
    pub stop_force_n: f64,
}

/// Watches a switch from tick to tick.
pub struct Watch {
    ends_m: [f64; 2],
    /// The end where it stood last: 0 left, 1 right.
    side: usize,
    /// Farthest from that end since, as a share of the way.
    farthest: f64,
    found: SwitchMeasures,
}

impl Watch {
    /// Nothing seen yet; nothing to see without a switch.
    pub fn new(world: &World) -> Option<Self> {
        let switch = world.switch.as_ref()?;
        let (first, last) = switch.curve.points.first().zip(switch.curve.points.last())?;
        let ends_m = [first.at_m, last.at_m];
        let side = usize::from(switch.start_m > 0.5 * (ends_m[0] + ends_m[1]));
        Some(Self { ends_m, side, farthest: 0.0, found: SwitchMeasures::default() })
    }

    /// The next state.
    pub fn see(&mut self, state: &State) {
        let [left, right] = self.ends_m;
        let share = (state.switch.at_m - left) / (right - left);
        let gone = if self.side == 0 { share } else { 1.0 - share };
        if gone > 1.0 - AT_AN_END {
            self.found.throws += 1;
            (self.side, self.farthest) = (1 - self.side, 0.0);
        } else if gone < AT_AN_END {
            self.found.fell_back += usize::from(self.farthest > PUSHED);
            self.farthest = 0.0;
        } else {
            self.farthest = self.farthest.max(gone);
        }
        if !(AT_AN_END..=1.0 - AT_AN_END).contains(&share) {
            let force_n = state.tip_force_n.iter().map(haptics::Vec2::norm).fold(0.0, f64::max);
            self.found.stop_force_n = self.found.stop_force_n.max(force_n);
        }
    }

    /// All that was seen so far.
    pub fn found(&self) -> SwitchMeasures {
        self.found
    }
}
