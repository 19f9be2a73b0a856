//! Simulated slow and unreliable network between the servo and any device: delay, jitter and loss both ways, drawn by a
//! seed. Optional wave variables keep it stable.
//!
//! Without them the servo's forces arrive late at the operator, and a wall that is stiffer than the operator's arm
//! starts to swing and grows: the plain channel is there to see and to measure this. With them the line cannot generate
//! energy.
//!
//! The wrapped device is asked every tick, as if it ran at the servo's clock at the far end.

#[cfg(test)]
mod forwarding;
#[cfg(test)]
mod hold;
pub(crate) mod line;
#[cfg(test)]
mod tests;

pub use super::waves::Waves;

use super::interface::{Command, Device, DeviceSpec, Sample};
use super::waves::{Account, OperatorEnd, SMOOTHING_S, WorldEnd};
use crate::device::interface::ForceGuard;
use crate::world::{State, World};
use line::Line;

/// Without a new force for this long (beside the jitter) the far end puts zero force on the operator, s.
const HOLD_S: f64 = 0.05;
/// A sample counts as fresh for this long beside the jitter, s.
const FRESH_S: f64 = 0.005;
/// Delay, jitter and loss that the network applies to each packet, each way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ChannelConfig {
    /// Delay one way, s; half the round trip.
    pub delay_s: f64,
    /// Extra delay, evenly between none and this, s: packets may overtake each other.
    pub jitter_s: f64,
    /// Share of the packets that is lost, 0 to 1.
    pub loss: f64,
    /// Draws the fate of the packets.
    pub seed: u64,
    /// Wave variables, if they are to be used.
    pub waves: Option<Waves>,
}

/// A network that cannot be.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ChannelError {
    /// Delay or jitter out of range.
    #[error("a {0} of {1} s is not possible; choose 0 to 2 s")]
    Time(&'static str, f64),
    /// Loss out of range.
    #[error("a loss of {0} is not possible; choose a share of 0 to 1")]
    Loss(f64),
    /// Wave impedance or damper out of range.
    #[error("a wave impedance of {0} N s/m with a damper of {1} N s/m is not possible; both are positive")]
    Waves(f64, f64),
}

impl ChannelConfig {
    /// Fault of the settings, if there is one, in one sentence.
    pub fn check(&self) -> Result<(), ChannelError> {
        for (name, time_s) in [("delay", self.delay_s), ("jitter", self.jitter_s)] {
            if !(0.0..=2.0).contains(&time_s) {
                return Err(ChannelError::Time(name, time_s));
            }
        }
        if !(0.0..=1.0).contains(&self.loss) {
            return Err(ChannelError::Loss(self.loss));
        }
        match self.waves {
            Some(Waves { impedance_n_s_m: b, damper_n_s_m: d }) if !(b > 0.0 && d >= 0.0 && b + d < 1e4) => {
                Err(ChannelError::Waves(b, d))
            }
            _ => Ok(()),
        }
    }
}

/// Content of a packet from the servo to the device.
#[derive(Clone, Copy)]
enum Down {
    Force(Command),
    Wave([Account; 2]),
}

/// Content of a packet from the device to the servo.
#[derive(Clone, Copy)]
enum Up {
    Motion(Sample, Ages),
    Wave([Account; 2], Ages),
}

/// Age of each finger's newest sample at the far end when the packet left, s.
type Ages = [f64; 2];

/// Any device behind a network.
pub struct ChannelDevice {
    inner: Box<dyn Device>,
    spec: DeviceSpec,
    config: ChannelConfig,
    down: Line<Down>,
    up: Line<Up>,
    strikes: Line<f64>,
    now_s: f64,
    /// Forces at the far end, N.
    command: Command,
    command_age_s: f64,
    /// Newest sample that has reached the servo.
    sample: Sample,
    sample_age_s: Ages,
    /// Age of each finger's newest sample at the far end, s; infinite before the finger was first seen.
    seen_s: Ages,
    operator_end: OperatorEnd,
    world_end: WorldEnd,
}

impl ChannelDevice {
    /// Puts a network between the servo and `inner`.
    pub fn new(inner: Box<dyn Device>, config: ChannelConfig) -> Result<Self, ChannelError> {
        config.check()?;
        let ChannelConfig { delay_s, jitter_s, loss, seed, waves } = config;
        let mut spec = inner.spec().clone();
        if let Some(waves) = waves {
            // The servo feels the wave impedance at its end, not the device.
            (spec.damping_n_s_m, spec.coulomb_n, spec.resolution_m) = (waves.impedance_n_s_m, 0.0, 0.0);
        }
        spec.name = format!("{} behind {:.0} ms each way", spec.name, 1e3 * delay_s);
        Ok(Self {
            inner,
            spec,
            config,
            down: Line::new(delay_s, jitter_s, loss, seed),
            up: Line::new(delay_s, jitter_s, loss, seed ^ 0x9e37_79b9_7f4a_7c15),
            strikes: Line::new(delay_s, jitter_s, loss, seed ^ 0x6a09_e667_f3bc_c908),
            now_s: 0.0,
            command: Command::default(),
            command_age_s: f64::INFINITY,
            sample: Sample::default(),
            sample_age_s: [f64::INFINITY; 2],
            seen_s: [f64::INFINITY; 2],
            operator_end: OperatorEnd::default(),
            world_end: WorldEnd::default(),
        })
    }

    /// Late forces to the device, late positions to the servo.
    fn plain(&mut self, command: &Command, dt_s: f64) {
        self.down.send(self.now_s, Down::Force(*command));
        if let Some(Down::Force(command)) = self.down.receive(self.now_s) {
            (self.command, self.command_age_s) = (command, 0.0);
        }
        if self.command_age_s > HOLD_S + self.config.jitter_s {
            self.command = Command::default();
        }
        let sample = self.ask(dt_s);
        if sample.is_any_fresh() {
            self.up.send(self.now_s, Up::Motion(sample, self.seen_s));
        }
        if let Some(Up::Motion(sample, ages_s)) = self.up.receive(self.now_s) {
            (self.sample, self.sample_age_s) = (sample, ages_s);
        }
    }

    /// Asks the device at the far end, and counts since when each finger has not been seen.
    fn ask(&mut self, dt_s: f64) -> Sample {
        let sample = self.inner.exchange(&self.command, dt_s);
        for (seen_s, fresh) in self.seen_s.iter_mut().zip(sample.fresh) {
            *seen_s = if fresh { 0.0 } else { *seen_s + dt_s };
        }
        sample
    }

    fn waves(&mut self, waves: &Waves, command: &Command, dt_s: f64) {
        let smoothing_s = SMOOTHING_S + self.config.jitter_s;
        self.sample.tip_velocity = self.world_end.tick(waves, command.force_n, smoothing_s, dt_s);
        for (tip, velocity) in self.sample.tip_in_world.iter_mut().zip(self.sample.tip_velocity) {
            *tip += velocity * dt_s;
        }
        self.down.send(self.now_s, Down::Wave(self.world_end.accounts()));
        if let Some(Down::Wave(accounts)) = self.down.receive(self.now_s) {
            self.command_age_s = 0.0;
            self.operator_end.arrive(accounts);
        }
        self.operate(waves, smoothing_s, dt_s);
        if let Some(Up::Wave(accounts, ages_s)) = self.up.receive(self.now_s) {
            self.sample_age_s = ages_s;
            self.world_end.arrive(accounts);
        }
    }

    /// The operator's end.
    fn operate(&mut self, waves: &Waves, smoothing_s: f64, dt_s: f64) {
        let DeviceSpec { max_force_n, resolution_m, .. } = *self.inner.spec();
        self.command.force_n = self.operator_end.forces(waves, smoothing_s, max_force_n, dt_s);
        let sample = self.ask(dt_s);
        // The hand begins when both fingers are known.
        let known = self.seen_s.iter().all(|seen_s| seen_s.is_finite());
        if !(known && sample.is_any_fresh()) {
            self.operator_end.unseen(dt_s);
            return;
        }
        if self.operator_end.moved(waves, self.command.force_n, sample.tip_in_world, resolution_m, dt_s) {
            // Both ends agree on where the hand begins; waves only tell how it moves.
            self.sample.tip_in_world = sample.tip_in_world;
        }
        self.up.send(self.now_s, Up::Wave(self.operator_end.accounts(), self.seen_s));
    }
}

impl Device for ChannelDevice {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample {
        self.now_s += dt_s;
        self.command_age_s += dt_s;
        self.sample_age_s = self.sample_age_s.map(|age_s| age_s + dt_s);
        if let Some(speed_m_s) = self.strikes.receive(self.now_s) {
            self.inner.strike(speed_m_s);
        }
        match self.config.waves {
            Some(waves) if dt_s > 0.0 => self.waves(&waves, command, dt_s),
            Some(_) => {}
            None => self.plain(command, dt_s),
        }
        // With waves a gap is harmless: the tip comes to rest by itself.
        let patience_s = if self.config.waves.is_some() { HOLD_S } else { FRESH_S };
        self.sample.fresh = self.sample_age_s.map(|age_s| age_s < patience_s + self.config.jitter_s);
        self.sample
    }

    fn delay_s(&self) -> f64 {
        // Waves need no allowance for the delay of the line; plain positions and forces do.
        let own = if self.config.waves.is_some() { 0.0 } else { 2.0 * self.config.delay_s + self.config.jitter_s };
        self.inner.delay_s() + own
    }

    fn line_stiffness_n_m(&self) -> Option<f64> {
        let late_s = self.config.delay_s + SMOOTHING_S + self.config.jitter_s;
        let own = self.config.waves.map(|waves| waves.line_stiffness_n_m(late_s));
        match (own, self.inner.line_stiffness_n_m()) {
            (Some(own), Some(behind)) => Some(own * behind / (own + behind)),
            (own, behind) => own.or(behind),
        }
    }

    fn make_safe(&mut self) {
        // Not over the line: a device is made safe where it is.
        self.command = Command::default();
        self.inner.make_safe();
    }

    fn interrupted(&mut self) {
        self.inner.interrupted();
    }

    fn guard(&mut self) -> Option<ForceGuard> {
        // Not over the line either: the servo's thread and the device's driver are the same with and without it.
        self.inner.guard()
    }

    fn strike(&mut self, speed_m_s: f64) {
        self.strikes.send(self.now_s, speed_m_s);
    }

    fn see(&mut self, world: &World, state: &State) {
        self.inner.see(world, state);
    }

    fn finished(&self) -> bool {
        self.inner.finished()
    }
}
