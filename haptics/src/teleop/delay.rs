//! The line between the operator and a far world: its delay, and the two ends that it joins.

use crate::device::HandImpedance;
use crate::device::channel::{ChannelConfig, ChannelError};
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
    pub(super) fn channel(&self, seed: u64) -> ChannelConfig {
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

/// Stiffness that a far fingertip must have to hold anything, N/m: a hand's own.
pub(super) fn hand_stiffness_n_m() -> f64 {
    HandImpedance::default().stiffness_n_m
}
