//! A slow and unreliable network between the servo and any device: delay, jitter and loss both ways, drawn by a seed; on choice
//! with wave variables, which keep it stable.
//!
//! Without them the servo's forces arrive late at the operator, and a wall that is stiffer than the operator's arm starts to swing
//! and grows: this is what the plain channel is for, to see and to measure it. With them the line cannot give energy out.
//!
//! The wrapped device is asked every tick, as if it ran at the servo's clock at the far end.

#[cfg(test)]
mod hold;
mod line;
#[cfg(test)]
mod tests;
mod wave;

pub use wave::Waves;

use super::{Command, Device, DeviceSpec, Sample};
use crate::Vec2;
use crate::world::{State, World};
use line::Line;
use wave::{Account, Receiver, Sender};

/// Without a new force for this long (beside the jitter) the far end puts zero force on the operator, s.
const HOLD_S: f64 = 0.05;
/// A sample counts as fresh for this long beside the jitter, s.
const FRESH_S: f64 = 0.005;
/// Time constant with which the receiver of waves follows what arrives, beside the jitter, s.
const SMOOTHING_S: f64 = 0.005;
/// Time constant of the velocity of a device with a resolution, s.
const VELOCITY_SMOOTHING_S: f64 = 0.004;
/// Faster than a hand: a jump of position is spread over time, m/s.
const FASTEST_M_S: f64 = 2.0;

/// What the network does to each packet, each way.
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
    fn check(&self) -> Result<(), ChannelError> {
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

/// What goes from the servo to the device.
#[derive(Clone, Copy)]
enum Down {
    Force(Command),
    Wave([Account; 2]),
}

/// What comes back.
#[derive(Clone, Copy)]
enum Up {
    Motion(Sample),
    Wave([Account; 2]),
}

/// One finger's ends of the waves.
#[derive(Clone, Copy, Default)]
struct Ends {
    operator_in: Receiver,
    operator_out: Sender,
    world_in: Receiver,
    world_out: Sender,
    /// The wave that the operator's end feels in this tick.
    incoming: Vec2,
    /// Where the operator's finger is known to be, m; velocities come from it.
    tracked: Vec2,
    velocity: Vec2,
}

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
    /// What the servo has.
    sample: Sample,
    sample_age_s: f64,
    ends: [Ends; 2],
    started: bool,
}

impl ChannelDevice {
    /// Puts a network between the servo and `inner`.
    pub fn new(inner: Box<dyn Device>, config: ChannelConfig) -> Result<Self, ChannelError> {
        config.check()?;
        let ChannelConfig { delay_s, jitter_s, loss, seed, waves } = config;
        let mut spec = inner.spec().clone();
        if let Some(waves) = waves {
            // What the servo feels at its end is the wave impedance, not the device.
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
            sample_age_s: f64::INFINITY,
            ends: [Ends::default(); 2],
            started: false,
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
        let sample = self.inner.exchange(&self.command, dt_s);
        if sample.fresh {
            self.up.send(self.now_s, Up::Motion(sample));
        }
        if let Some(Up::Motion(sample)) = self.up.receive(self.now_s) {
            (self.sample, self.sample_age_s) = (sample, 0.0);
        }
    }

    fn waves(&mut self, waves: &Waves, command: &Command, dt_s: f64) {
        let smoothing_s = SMOOTHING_S + self.config.jitter_s;
        // The servo's end: the force of the tips on the world is the reaction to what the operator is to feel.
        for (finger, ends) in self.ends.iter_mut().enumerate() {
            let u = ends.world_in.draw(smoothing_s, dt_s);
            let force_n = -command.force_n[finger];
            let (velocity, w) = waves.at_world(u, force_n);
            // The port takes F v, the damper beside it the rest: the balance is exact here.
            ends.world_out.send(w, 0.5 * w.norm_squared() * dt_s, dt_s);
            self.sample.tip_in_world[finger] += velocity * dt_s;
            self.sample.tip_velocity[finger] = velocity;
        }
        self.down.send(self.now_s, Down::Wave(self.ends.map(|ends| ends.world_out.account)));
        if let Some(Down::Wave(accounts)) = self.down.receive(self.now_s) {
            self.command_age_s = 0.0;
            for (ends, account) in self.ends.iter_mut().zip(accounts) {
                ends.operator_in.arrive(account);
            }
        }
        self.operate(waves, smoothing_s, dt_s);
        if let Some(Up::Wave(accounts)) = self.up.receive(self.now_s) {
            self.sample_age_s = 0.0;
            for (ends, account) in self.ends.iter_mut().zip(accounts) {
                ends.world_in.arrive(account);
            }
        }
    }

    /// The operator's end.
    fn operate(&mut self, waves: &Waves, smoothing_s: f64, dt_s: f64) {
        let most_n = self.inner.spec().max_force_n;
        for (finger, ends) in self.ends.iter_mut().enumerate() {
            ends.incoming = ends.operator_in.draw(smoothing_s, dt_s);
            let force = waves.force_on_operator(ends.velocity, ends.incoming);
            let size = force.norm();
            self.command.force_n[finger] = if size > most_n { force * (most_n / size) } else { force };
        }
        let sample = self.inner.exchange(&self.command, dt_s);
        if !sample.fresh {
            return;
        }
        if !self.started {
            // Both ends agree on where the hand begins; waves only tell how it moves.
            self.started = true;
            self.sample.tip_in_world = sample.tip_in_world;
            for (ends, tip) in self.ends.iter_mut().zip(sample.tip_in_world) {
                ends.tracked = tip;
            }
        }
        // Positions with steps would make a noisy velocity; the integral of the smoothed one is still the position.
        let smooth = self.inner.spec().resolution_m > 0.0;
        let blend = if smooth { 1.0 - (-dt_s / VELOCITY_SMOOTHING_S).exp() } else { 1.0 };
        for (finger, ends) in self.ends.iter_mut().enumerate() {
            let moved = super::pointer::towards(
                Vec2::zeros(),
                (sample.tip_in_world[finger] - ends.tracked) * blend,
                FASTEST_M_S * dt_s,
            );
            ends.tracked += moved;
            ends.velocity = moved / dt_s;
            let w = ends.incoming;
            let work_j = -self.command.force_n[finger].dot(&moved);
            let u = waves.outgoing(ends.velocity, w);
            ends.operator_out.send(u, work_j + 0.5 * w.norm_squared() * dt_s, dt_s);
        }
        self.up.send(self.now_s, Up::Wave(self.ends.map(|ends| ends.operator_out.account)));
    }
}

impl Device for ChannelDevice {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample {
        self.now_s += dt_s;
        self.command_age_s += dt_s;
        self.sample_age_s += dt_s;
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
        self.sample.fresh = self.sample_age_s < patience_s + self.config.jitter_s;
        self.sample
    }

    fn delay_s(&self) -> f64 {
        // What waves carry needs no allowance for its delay; what is sent plainly does.
        let own = if self.config.waves.is_some() { 0.0 } else { 2.0 * self.config.delay_s + self.config.jitter_s };
        self.inner.delay_s() + own
    }

    fn make_safe(&mut self) {
        // Not over the line: a device is made safe where it is.
        self.command = Command::default();
        self.inner.make_safe();
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
