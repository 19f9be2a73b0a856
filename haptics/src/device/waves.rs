//! Wave variables: they replace position and force on a slow line, so that the line itself can never generate energy.
//!
//! u = (b v + F)/√(2b) goes to the world, w = (b v − F)/√(2b) comes back; the power is (u² − w²)/2 at either end (Anderson &
//! Spong 1989; Niemeyer & Slotine 1991). A constant delay then stores energy and nothing else. Delay that varies, loss and drift of
//! position are handled as in Niemeyer & Slotine 1998, "Towards force-reflecting teleoperation over the Internet": the packets
//! carry the *integral* of the wave and its *energy* since the start. The receiver makes a wave whose integral follows, and whose
//! energy never exceeds what has arrived. A lost packet costs nothing, because the next one contains it; and as
//! ∫u + ∫w = √(2b) x at both ends, positions agree again whenever the hand comes to rest in the air.
//!
//! The effect of a delay d is still felt, as on every line: moving the hand moves a mass of b d, and pressing presses a
//! spring of b/d in series with the world (9 N s/m over 250 ms one way: 2.2 kg and 36 N/m). Stable is not the same as
//! crisp.

use super::pointer::towards;
use crate::Vec2;
use crate::device::interface::DeviceSpec;
use crate::servo::passivity::required_damping;
use crate::world::World;

/// Time constant with which the receiver of waves follows the arrivals, beside the jitter, s.
pub(super) const SMOOTHING_S: f64 = 0.005;
/// Least ratio of the receiver's time constant to the longest gap between packets.
const SMOOTH_GAPS: f64 = 4.0;
/// A longer gap is a break, s: it is not smoothed over.
const LONGEST_GAP_S: f64 = 0.05;
/// Memory of gaps, s.
const GAP_MEMORY_S: f64 = 2.0;
/// Time constant of the velocity of a device with a resolution, s.
const VELOCITY_SMOOTHING_S: f64 = 0.004;
/// Faster than a hand: a jump of position is spread over time, m/s.
const FASTEST_M_S: f64 = 2.0;
/// Fingers that were not seen for this long count as being at rest, s.
const UNSEEN_S: f64 = 0.02;
/// Energy that an end may keep from one tick for another, J per finger: evens the errors of sampling out, no more.
const PURSE_J: f64 = 1e-4;

/// The two numbers that the wave variables need.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Waves {
    /// Wave impedance b, N s/m.
    pub impedance_n_s_m: f64,
    /// A damper beside the world, N s/m, that takes up the energy that the sampled world generates.
    pub damper_n_s_m: f64,
}

impl Waves {
    /// Stiffness that the line puts in series with the world for a delay one way (s), N/m: b/d.
    pub fn line_stiffness_n_m(&self, delay_s: f64) -> f64 {
        self.impedance_n_s_m / delay_s
    }

    /// Mass that the line adds to a hand that moves freely, kg: b d.
    pub fn line_mass_kg(&self, delay_s: f64) -> f64 {
        self.impedance_n_s_m * delay_s
    }

    /// Wave settings for a device that touches a world at a period (s). The damper makes the sampled pads passive (K
    /// T/2 + |B|, Colgate & Schenkel 1997). The impedance b is the device's own damping, which reflects least of a
    /// wave, and no less than the damper. The pads count with their stiffness at the device's largest force: beyond it
    /// the force is held.
    pub fn new(spec: &DeviceSpec, world: &World, period_s: f64) -> Self {
        let stiffness = world.pad.elastic().stiffness_at_n_m(spec.max_force_n) + world.pad.shear_stiffness_n_m;
        let damping = world.pad.damping_n_s_m + world.pad.shear_damping_n_s_m;
        let damper_n_s_m = required_damping(stiffness, damping, period_s);
        Self { impedance_n_s_m: spec.damping_n_s_m.max(damper_n_s_m), damper_n_s_m }
    }

    fn root(&self) -> f64 {
        (2.0 * self.impedance_n_s_m).sqrt()
    }

    /// Force that the world's side puts on the operator, N, where the finger moves at `velocity` and the wave `w` comes in.
    fn force_on_operator(&self, velocity: Vec2, w: Vec2) -> Vec2 {
        w * self.root() - velocity * self.impedance_n_s_m
    }

    /// The wave that leaves the operator's side, √W.
    fn outgoing(&self, velocity: Vec2, w: Vec2) -> Vec2 {
        velocity * self.root() - w
    }

    /// Velocity of the tip in the world, m/s, and the wave that goes back, for the incoming wave `u` and the force of the tip on
    /// the world, N.
    fn at_world(&self, u: Vec2, force_n: Vec2) -> (Vec2, Vec2) {
        let velocity = (u * self.root() - force_n) / (self.impedance_n_s_m + self.damper_n_s_m);
        let total = force_n + velocity * self.damper_n_s_m;
        (velocity, u - total * (2.0 / self.root()))
    }
}

/// Content of a packet for one finger: integral of the wave, √W s, and its energy, J, since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Account {
    /// Integral, √W s.
    pub integral: Vec2,
    /// Energy, J.
    pub energy_j: f64,
}

/// The sending end of one finger's wave.
#[derive(Clone, Copy, Debug, Default)]
struct Sender {
    account: Account,
    purse_j: f64,
}

impl Sender {
    /// Sends a wave for `dt_s`. `income_j` is the energy that this end took in meanwhile (from its port and from the
    /// wave that arrived): the wave may not carry more, whatever sampling, filters and limits do.
    fn send(&mut self, wave: Vec2, income_j: f64, dt_s: f64) {
        self.account.integral += wave * dt_s;
        self.purse_j += income_j;
        let spent = (0.5 * wave.norm_squared() * dt_s).min(self.purse_j).max(0.0);
        self.account.energy_j += spent;
        self.purse_j = (self.purse_j - spent).min(PURSE_J);
    }
}

/// The receiving end of one finger's wave.
#[derive(Clone, Copy, Debug, Default)]
struct Receiver {
    arrived: Account,
    used: Account,
    /// Time since the last packet, s; `None` before the first, which is no gap.
    since_s: Option<f64>,
    /// Longest time between two packets lately, s.
    gap_s: f64,
}

impl Receiver {
    /// Takes the newest packet's content.
    fn arrive(&mut self, account: Account) {
        self.arrived = account;
        self.gap_s = self.gap_s.max(self.since_s.map_or(0.0, |since_s| since_s.min(LONGEST_GAP_S)));
        self.since_s = Some(0.0);
    }

    /// The wave for the next `dt_s`, within the energy that arrived. It follows the integral with the time constant
    /// `smoothing_s`, or a longer one that covers the gaps between packets. After a last packet it fades out.
    ///
    /// A wave that jumps with every packet spends more energy than the even one that was sent: a held force would bleed
    /// away.
    fn draw(&mut self, smoothing_s: f64, dt_s: f64) -> Vec2 {
        self.since_s = self.since_s.map(|since_s| since_s + dt_s);
        self.gap_s -= self.gap_s * (dt_s / GAP_MEMORY_S).min(1.0);
        let smoothing_s = smoothing_s.max(SMOOTH_GAPS * self.gap_s).max(dt_s);
        let wanted = (self.arrived.integral - self.used.integral) / smoothing_s;
        let purse_j = (self.arrived.energy_j - self.used.energy_j).max(0.0);
        let most = (2.0 * purse_j / dt_s).sqrt();
        let size = wanted.norm();
        let wave = if size > most { wanted * (most / size) } else { wanted };
        self.used.integral += wave * dt_s;
        self.used.energy_j += 0.5 * wave.norm_squared() * dt_s;
        wave
    }
}

/// The end of the line at the world: both fingers.
#[derive(Clone, Copy, Debug, Default)]
pub struct WorldEnd {
    arriving: [Receiver; 2],
    leaving: [Sender; 2],
}

impl WorldEnd {
    /// Takes the newest packet from the operator.
    pub fn arrive(&mut self, accounts: [Account; 2]) {
        for (receiver, account) in self.arriving.iter_mut().zip(accounts) {
            receiver.arrive(account);
        }
    }

    /// One tick: the velocities of the tips, m/s, for the force that the operator is to feel, N.
    pub fn tick(&mut self, waves: &Waves, force_on_operator_n: [Vec2; 2], smoothing_s: f64, dt_s: f64) -> [Vec2; 2] {
        let mut velocities = [Vec2::zeros(); 2];
        for finger in 0..2 {
            let u = self.arriving[finger].draw(smoothing_s, dt_s);
            // The force of the tips on the world is the reaction to the operator's force.
            let (velocity, w) = waves.at_world(u, -force_on_operator_n[finger]);
            // The port takes F v, the damper beside it the rest: the balance is exact here.
            self.leaving[finger].send(w, 0.5 * w.norm_squared() * dt_s, dt_s);
            velocities[finger] = velocity;
        }
        velocities
    }

    /// Content of the next packet to the operator.
    pub fn accounts(&self) -> [Account; 2] {
        self.leaving.map(|sender| sender.account)
    }
}

/// The end of the line at the operator: both fingers.
#[derive(Clone, Copy, Debug, Default)]
pub struct OperatorEnd {
    arriving: [Receiver; 2],
    leaving: [Sender; 2],
    /// The waves that are felt in this tick.
    incoming: [Vec2; 2],
    /// Last known positions of the fingers, m; velocities come from them. `None` before the hand is known.
    tracked: Option<[Vec2; 2]>,
    velocity: [Vec2; 2],
    /// Time since the fingers were last seen, s.
    unseen_s: f64,
}

impl OperatorEnd {
    /// Takes the newest packet from the world.
    pub fn arrive(&mut self, accounts: [Account; 2]) {
        for (receiver, account) in self.arriving.iter_mut().zip(accounts) {
            receiver.arrive(account);
        }
    }

    /// One tick begins: the forces to put on the fingers, N, no larger than the device can make.
    pub fn forces(&mut self, waves: &Waves, smoothing_s: f64, most_n: f64, dt_s: f64) -> [Vec2; 2] {
        for (incoming, receiver) in self.incoming.iter_mut().zip(&mut self.arriving) {
            *incoming = receiver.draw(smoothing_s, dt_s);
        }
        std::array::from_fn(|finger| {
            let force = waves.force_on_operator(self.velocity[finger], self.incoming[finger]);
            let size = force.norm();
            if size > most_n { force * (most_n / size) } else { force }
        })
    }

    /// The tick ends: the fingers, under the forces that were put on them (N), are now at `tips`, m. `resolution_m`: steps of the
    /// positions. Returns true for the first tips, which are where the hand begins.
    pub fn moved(&mut self, waves: &Waves, force_n: [Vec2; 2], tips: [Vec2; 2], resolution_m: f64, dt_s: f64) -> bool {
        self.unseen_s = 0.0;
        let first = self.tracked.is_none();
        let tracked = self.tracked.get_or_insert(tips);
        // Positions with steps would make a noisy velocity; the integral of the smoothed one is still the position.
        let blend = if resolution_m > 0.0 { 1.0 - (-dt_s / VELOCITY_SMOOTHING_S).exp() } else { 1.0 };
        for finger in 0..2 {
            let way = (tips[finger] - tracked[finger]) * blend;
            let moved = towards(Vec2::zeros(), way, FASTEST_M_S * dt_s);
            tracked[finger] += moved;
            self.velocity[finger] = moved / dt_s;
            let w = self.incoming[finger];
            let work_j = -force_n[finger].dot(&moved);
            let u = waves.outgoing(self.velocity[finger], w);
            self.leaving[finger].send(u, work_j + 0.5 * w.norm_squared() * dt_s, dt_s);
        }
        first
    }

    /// The tick ends without a word from the fingers, as ticks do that are faster than the device. A hand that stays unseen counts
    /// as a hand at rest: the damping of a motion that is long over must not push it for ever.
    pub fn unseen(&mut self, dt_s: f64) {
        self.unseen_s += dt_s;
        if self.unseen_s > UNSEEN_S {
            self.velocity = [Vec2::zeros(); 2];
        }
    }

    /// Content of the next packet to the world.
    pub fn accounts(&self) -> [Account; 2] {
        self.leaving.map(|sender| sender.account)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_carry_the_power_of_the_port() {
        let waves = Waves { impedance_n_s_m: 9.0, damper_n_s_m: 0.0 };
        let (v, w) = (Vec2::new(0.1, -0.02), Vec2::new(0.3, 0.4));
        let (force, u) = (-waves.force_on_operator(v, w), waves.outgoing(v, w));
        assert!((force.dot(&v) - 0.5 * (u.norm_squared() - w.norm_squared())).abs() < 1e-15, "operator's port");
        assert!((u - (v * 9.0 + force) / 18.0_f64.sqrt()).norm() < 1e-15, "u = (b v + F)/√(2b)");
        let force = Vec2::new(1.0, -2.0);
        let (v, w) = waves.at_world(u, force);
        assert!((force.dot(&v) - 0.5 * (u.norm_squared() - w.norm_squared())).abs() < 1e-14, "world's port");
        assert!((w - (v * 9.0 - force) / 18.0_f64.sqrt()).norm() < 1e-15, "w = (b v − F)/√(2b)");
    }

    #[test]
    fn a_receiver_never_uses_more_than_arrived_and_ends_at_the_integral() {
        let (mut sender, mut receiver) = (Sender::default(), Receiver::default());
        let dt_s = 1e-3;
        let mut used_j = 0.0;
        for tick in 0..20_000_i32 {
            let wave = if tick < 15_000 { Vec2::new((f64::from(tick) * 0.01).sin(), 0.5) } else { Vec2::zeros() };
            sender.send(wave, 1.0, dt_s);
            // Most packets are lost; some come in bursts.
            if tick % 37 == 0 || tick == 15_001 {
                receiver.arrive(sender.account);
            }
            used_j += 0.5 * receiver.draw(0.04, dt_s).norm_squared() * dt_s;
            assert!(used_j <= sender.account.energy_j + 1e-12);
        }
        assert!((receiver.used.integral - sender.account.integral).norm() < 1e-6, "nothing of the motion is lost");
    }

    #[test]
    fn an_end_without_income_sends_motion_without_energy() {
        let mut sender = Sender::default();
        sender.send(Vec2::new(1.0, 0.0), 0.0, 1e-3);
        assert_eq!(sender.account.energy_j, 0.0);
        assert!(sender.account.integral.x > 0.0);
        sender.send(Vec2::new(1.0, 0.0), 10.0, 1e-3);
        assert!((sender.account.energy_j - 0.5e-3).abs() < 1e-15);
        sender.send(Vec2::new(1e3, 0.0), 0.0, 1e-3);
        assert!(sender.account.energy_j < 0.5e-3 + 1.01 * PURSE_J, "savings are small");
    }
}
