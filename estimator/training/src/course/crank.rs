//! A turned crank.

use haptics::world::State;
use schemars::JsonSchema;
use serde::Serialize;
use std::f64::consts::TAU;

/// Turning back less than this is no reversal, rad.
pub const REVERSAL_RAD: f64 = 0.05;
/// Slower than this the crank stands, rad/s.
const STANDING_RAD_S: f64 = 0.2;

/// Of a crank.
#[derive(Clone, Copy, Debug, Default, PartialEq, JsonSchema, Serialize)]
pub struct CrankMeasures {
    /// Angle gone through, both ways together, in turns.
    pub turns: f64,
    /// How often the direction changed by more than [`REVERSAL_RAD`].
    pub reversals: usize,
    /// Force of the bearing against the hand along the way of the handle, ∫ |F| |ds| of its radial part, J: effort that turns nothing.
    pub off_tangent_j: f64,
    /// Mean speed while it turned, rad/s.
    pub mean_speed_rad_s: f64,
    /// Standard deviation of the speed over its mean while it turned: 0 is perfectly even.
    pub speed_variation: f64,
}

/// Watches a crank from tick to tick.
#[derive(Default)]
pub struct Watch {
    before: Option<(f64, f64)>,
    gone_rad: f64,
    /// The farthest angle in the present direction, and that direction.
    extreme_rad: Option<f64>,
    direction: f64,
    reversals: usize,
    off_tangent_j: f64,
    turning_s: f64,
    sum: f64,
    squares: f64,
}

impl Watch {
    /// The next state, at the recording's clock, s.
    pub fn see(&mut self, time_s: f64, state: &State) {
        let crank = &state.crank;
        let Some((before_s, before_rad)) = self.before.replace((time_s, crank.angle_rad)) else {
            self.extreme_rad = Some(crank.angle_rad);
            return;
        };
        let (span_s, step_rad) = (time_s - before_s, crank.angle_rad - before_rad);
        self.gone_rad += step_rad.abs();
        self.off_tangent_j += crank.constraint_force_n.abs() * crank.handle_velocity.norm() * span_s;
        let speed = crank.rate_rad_s.abs();
        if speed > STANDING_RAD_S {
            self.turning_s += span_s;
            self.sum += span_s * speed;
            self.squares += span_s * speed * speed;
        }
        self.turn(crank.angle_rad);
    }

    fn turn(&mut self, angle_rad: f64) {
        let extreme = self.extreme_rad.get_or_insert(angle_rad);
        let back = angle_rad - *extreme;
        if self.direction == 0.0 {
            if back.abs() > REVERSAL_RAD {
                (self.direction, *extreme) = (back.signum(), angle_rad);
            }
        } else if back * self.direction > 0.0 {
            *extreme = angle_rad;
        } else if back.abs() > REVERSAL_RAD {
            (self.direction, *extreme) = (-self.direction, angle_rad);
            self.reversals += 1;
        }
    }

    /// All that was seen.
    pub fn end(self) -> CrankMeasures {
        let mean = if self.turning_s > 0.0 { self.sum / self.turning_s } else { 0.0 };
        let variance = if self.turning_s > 0.0 { (self.squares / self.turning_s - mean * mean).max(0.0) } else { 0.0 };
        CrankMeasures {
            turns: self.gone_rad / TAU,
            reversals: self.reversals,
            off_tangent_j: self.off_tangent_j,
            mean_speed_rad_s: mean,
            speed_variation: if mean > 0.0 { variance.sqrt() / mean } else { 0.0 },
        }
    }
}
