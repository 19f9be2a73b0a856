//! Teleoperation: the operator here, the world far away, a slow line between them.
//!
//! The servo's world stays the far one: recordings and scores are of its events. Everything at the operator's end is a
//! device of that servo, in one of two ways (`docs/delay.md`):
//!
//! * [`waved`]: force and motion go over the line in wave variables, which cannot give energy out, and the operator sees a
//!   picture that is late. Honest, and slow: move, wait, look.
//! * [`modelled`]: the operator touches a model of the far world that answers at once (predictive display and
//!   model-mediated control; Sheridan 1993, Mitra & Niemeyer 2008). The motion of the hand is sent there and done by a
//!   hand of its own. The pictures that come back correct the model, slowly enough that no force jumps.
//!
//! Force reaches the operator through the safety stage in both: that of the servo, which sends it over the line, or that of a
//! second [`crate::servo::Loop`] at the operator's end, on the model.

mod album;
mod far_hand;
mod guess;
mod model;
mod modelled;
mod picture;
#[cfg(test)]
mod tests;
mod view;
mod waved;

pub use guess::{GUESS_OFF, guess};
pub use model::Weighed;
pub use view::{Knock, View, ViewSource};

use crate::device::channel::{ChannelConfig, ChannelError};
use crate::device::{Device, HandImpedance};
use crate::servo::safety::Limits;
use crate::world::{State, World};
use serde::{Deserialize, Serialize};

/// A slow line to the world, and the method against its delay.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Delay {
    /// From a motion to its answer, s: half of it each way.
    pub round_trip_s: f64,
    /// Extra delay of each packet, each way, evenly between none and this, s.
    pub jitter_s: f64,
    /// Share of the packets that is lost, 0 to 1.
    pub loss: f64,
    /// True if a model of the far world answers at once.
    pub predicted: bool,
}

impl Delay {
    /// A line of a round trip, s, without jitter and loss.
    pub fn of(round_trip_s: f64, predicted: bool) -> Self {
        Self { round_trip_s, predicted, ..Self::default() }
    }

    /// True when there is no line at all.
    pub fn is_none(&self) -> bool {
        self.round_trip_s == 0.0 && self.jitter_s == 0.0 && self.loss == 0.0
    }

    /// Fault of the line's settings, if there is one, in one sentence.
    pub fn check(&self) -> Result<(), ChannelError> {
        self.channel(0).check()
    }

    /// The line as a channel without waves.
    fn channel(&self, seed: u64) -> ChannelConfig {
        let Self { jitter_s, loss, .. } = *self;
        ChannelConfig { delay_s: self.one_way_s(), jitter_s, loss, seed, waves: None }
    }

    /// Delay one way, s, without the jitter.
    pub fn one_way_s(&self) -> f64 {
        0.5 * self.round_trip_s
    }
}

/// Settings that the two ends must agree on before anything moves.
#[derive(Clone, Copy, Debug)]
pub struct Ends<'a> {
    /// The far world.
    pub world: &'a World,
    /// Its state.
    pub state: &'a State,
    /// First model of the far world at the operator's end; `None`: the truth.
    pub guess: Option<&'a World>,
    /// Limits of the force that may reach the operator.
    pub limits: Limits,
    /// The servo's slowest period, s.
    pub period_s: f64,
    /// Draws the fate of the packets.
    pub seed: u64,
}

/// Puts a line between `operator` and the world that the servo runs. The view is for the operator's display.
pub fn connect(
    operator: Box<dyn Device>,
    ends: &Ends<'_>,
    delay: &Delay,
) -> Result<(Box<dyn Device>, ViewSource), ChannelError> {
    let (view, source) = view::view(ends.state, delay.predicted);
    let device: Box<dyn Device> = if delay.predicted {
        Box::new(modelled::ModelledHand::new(operator, ends, delay, view)?)
    } else {
        Box::new(waved::WavedHand::new(operator, ends, delay, view)?)
    };
    Ok((device, source))
}

/// Stiffness that a far fingertip must have to hold anything, N/m: a hand's own.
fn hand_stiffness_n_m() -> f64 {
    HandImpedance::default().stiffness_n_m
}
