//! A device at the other end of a network: positions come in as UDP packets, forces go back.
//!
//! Every packet is sealed with a shared key. A device first asks for a session (a number drawn at random for each
//! request). Only motion of the newest session, with a sequence number above all before, moves the fingers and gets
//! forces. A recorded packet is therefore worth nothing later, in the same session or in another; and a restarted
//! device is accepted at once. The tick reads at most [`PACKETS_A_TICK`] packets from a socket that never waits, into a
//! preallocated buffer, and answers with one.
//!
//! Optionally the packets carry wave variables in place of positions and forces ([`WaveUp`], [`WaveDown`]): a slow
//! network then cannot generate energy.

mod key;
mod monitor;
mod packet;
#[cfg(test)]
mod tests;
mod wave_packet;
#[cfg(test)]
mod wave_tests;
mod wire;

pub use super::waves::{Account, Waves};
pub use key::{Key, KeyError, SEAL_BYTES};
pub use monitor::UdpMonitor;
pub use packet::{
    FLAG_BYE, FLAG_GREETING, FORCE_BYTES, Force, MAGIC, MAX_POSITION_M, MAX_VELOCITY_M_S, MOTION_BYTES, Motion,
    Refused, VERSION,
};
pub use wave_packet::{FLAG_STOP, WAVE_DOWN_BYTES, WAVE_UP_BYTES, WAVE_VERSION, WaveDown, WaveUp};
pub use wire::Wire;

use super::interface::{Command, Device, DeviceSpec, Sample};
use super::waves::{SMOOTHING_S, WorldEnd};
use crate::Vec2;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::sync::atomic::Ordering;

/// Largest number of packets that one tick reads: a flood costs the tick no more than this, and ends in zero force.
pub const PACKETS_A_TICK: usize = 16;
/// The port, when none is named.
pub const PORT: u16 = 47_474;
/// A sample counts as fresh for this long: a device that sends at 250 Hz or faster is never stale.
const FRESH_S: f64 = 0.004;
/// With waves a gap is harmless: the tip comes to rest by itself. A sample counts as fresh for this long, s.
const WAVE_FRESH_S: f64 = 0.05;
/// Nothing from the device for this long: its address is forgotten and gets no more packets.
const FORGET_S: f64 = 1.0;

/// Address to listen on, and the device that is trusted.
#[derive(Clone, Debug)]
pub struct UdpConfig {
    /// Address and port. Loopback by default: to be reached from other machines, name the address of a network card.
    pub listen: SocketAddr,
    /// The shared key.
    pub key: Key,
    /// Capabilities of the remote device.
    pub spec: DeviceSpec,
    /// Round trip to it, s: the stiffness that may be rendered is computed with it. Waves need no allowance for it.
    pub delay_s: f64,
    /// Wave variables in the packets in place of positions and forces, if they are to be used.
    pub waves: Option<Waves>,
}

impl UdpConfig {
    /// On this machine only, at the usual port, for a device that feels up to 4 N and states nothing else of itself.
    pub fn loopback(key: Key) -> Self {
        Self {
            listen: SocketAddr::from((Ipv4Addr::LOCALHOST, PORT)),
            key,
            spec: Self::unstated(),
            delay_s: 0.0,
            waves: None,
        }
    }

    /// A device of which nothing is known.
    pub fn unstated() -> DeviceSpec {
        DeviceSpec {
            name: "Remote device over UDP".to_owned(),
            force_feedback: true,
            max_force_n: 4.0,
            // Not stated is none: the computed limits are then zero, which is the safe side.
            damping_n_s_m: 0.0,
            coulomb_n: 0.0,
            resolution_m: 0.0,
        }
    }
}

/// Why the port could not be used.
#[derive(Debug, thiserror::Error)]
#[error("the UDP address {listen} could not be opened ({reason}); is it this machine's, and free?")]
pub struct UdpError {
    /// Address that could not be used.
    listen: SocketAddr,
    /// Reason that the operating system reports.
    reason: String,
}

/// Content of a packet from the device, the same for both versions of the protocol.
struct Word {
    flags: u16,
    session: u64,
    sequence: u64,
    time_us: u64,
    says: Says,
}

enum Says {
    Motion { tip_in_world: [Vec2; 2], tip_velocity: [Vec2; 2] },
    Waves { origin_in_world: [Vec2; 2], accounts: [Account; 2] },
}

/// The servo's end of a remote device.
#[derive(Debug)]
pub struct UdpDevice<W: Wire = UdpSocket> {
    spec: DeviceSpec,
    delay_s: f64,
    waves: Option<Waves>,
    world_end: WorldEnd,
    wire: W,
    key: Key,
    monitor: UdpMonitor,
    /// Draws the sessions.
    rng: StdRng,
    session: u64,
    /// The session promised to the newest request; it counts from its first motion.
    promised: u64,
    /// Sequence that the next motion must exceed; `None` before the first.
    newest: Option<u64>,
    sent: u64,
    peer: Option<SocketAddr>,
    echo_us: u64,
    age_s: f64,
    now_s: f64,
    sample: Sample,
}

impl UdpDevice {
    /// Opens the port. The tips are reported at `start_in_world` (m), and stale, until a device comes.
    pub fn open(config: UdpConfig, start_in_world: [Vec2; 2]) -> Result<Self, UdpError> {
        let listen = config.listen;
        let fail = |e: std::io::Error| UdpError { listen, reason: e.to_string() };
        let socket = UdpSocket::bind(listen).map_err(fail)?;
        socket.set_nonblocking(true).map_err(fail)?;
        let listen = socket.local_addr().map_err(fail)?;
        Ok(Self::over(socket, UdpConfig { listen, ..config }, start_in_world))
    }
}

impl<W: Wire> UdpDevice<W> {
    /// The same over something that carries packets and is open already.
    pub fn over(wire: W, config: UdpConfig, start_in_world: [Vec2; 2]) -> Self {
        let mut spec = config.spec;
        if let Some(waves) = config.waves {
            // The servo feels the wave impedance at its end, not the device.
            (spec.damping_n_s_m, spec.coulomb_n, spec.resolution_m) = (waves.impedance_n_s_m, 0.0, 0.0);
        }
        Self {
            spec,
            delay_s: config.delay_s,
            waves: config.waves,
            world_end: WorldEnd::default(),
            wire,
            key: config.key,
            monitor: UdpMonitor::new(config.listen),
            rng: StdRng::seed_from_u64(rand::random()),
            // This session was promised to no device, so that none can use it.
            session: 0,
            promised: 0,
            newest: None,
            sent: 0,
            peer: None,
            echo_us: 0,
            age_s: f64::INFINITY,
            now_s: 0.0,
            sample: Sample { tip_in_world: start_in_world, tip_velocity: [Vec2::zeros(); 2], fresh: [false; 2] },
        }
    }

    /// Counts packets, from any thread.
    pub fn monitor(&self) -> UdpMonitor {
        self.monitor.clone()
    }

    /// Reads the waiting packets, at most [`PACKETS_A_TICK`].
    fn receive(&mut self) {
        // One byte more than the largest packet shows one that is too long.
        let mut buffer = [0; WAVE_UP_BYTES + 1];
        for _ in 0..PACKETS_A_TICK {
            let (size, from) = match self.wire.receive(&mut buffer) {
                Ok(received) => received,
                Err(e) if e.kind() == std::io::ErrorKind::WouldBlock => return,
                // Some systems report here that an earlier answer found no receiver; the next packet is behind it.
                Err(_) => continue,
            };
            if let Err(why) = self.decode(&buffer[..size]).and_then(|word| self.take(&word, from)) {
                self.monitor.counters.refused[why as usize].fetch_add(1, Ordering::Relaxed);
            }
        }
    }

    /// Opens a packet of the kind that is spoken here.
    fn decode(&self, packet: &[u8]) -> Result<Word, Refused> {
        let with_waves = packet.get(4) == Some(&WAVE_VERSION);
        if packet.starts_with(&MAGIC) && with_waves != self.waves.is_some() {
            // Before its size is looked at: a person needs to know this.
            return Err(Refused::Version);
        }
        if self.waves.is_some() {
            let WaveUp { flags, session, sequence, time_us, origin_in_world, accounts } =
                WaveUp::decode(packet, &self.key)?;
            return Ok(Word { flags, session, sequence, time_us, says: Says::Waves { origin_in_world, accounts } });
        }
        let Motion { flags, session, sequence, time_us, tip_in_world, tip_velocity } =
            Motion::decode(packet, &self.key)?;
        Ok(Word { flags, session, sequence, time_us, says: Says::Motion { tip_in_world, tip_velocity } })
    }

    /// Takes a sealed packet in.
    fn take(&mut self, word: &Word, from: SocketAddr) -> Result<(), Refused> {
        if word.session == 0 {
            self.monitor.counters.greeted.fetch_add(1, Ordering::Relaxed);
            // Zero asks for a session, so no session has this number.
            self.promised = self.rng.random::<u64>().max(1);
            self.answer(from, FLAG_GREETING, self.promised, [Vec2::zeros(); 2], word.time_us);
            return Ok(());
        }
        if word.session == self.promised {
            self.begin();
        }
        if word.session != self.session {
            return Err(Refused::Session);
        }
        if self.newest.is_some_and(|newest| word.sequence <= newest) {
            return Err(Refused::Sequence);
        }
        self.monitor.counters.accepted.fetch_add(1, Ordering::Relaxed);
        match word.says {
            Says::Motion { tip_in_world, tip_velocity } => {
                (self.sample.tip_in_world, self.sample.tip_velocity) = (tip_in_world, tip_velocity);
            }
            Says::Waves { origin_in_world, accounts } => {
                if self.newest.is_none() {
                    // Both ends agree on where the hand begins; waves only tell how it moves.
                    self.sample.tip_in_world = origin_in_world;
                }
                self.world_end.arrive(accounts);
            }
        }
        self.newest = Some(word.sequence);
        self.echo_us = word.time_us;
        let leaves = word.flags & FLAG_BYE != 0;
        self.peer = (!leaves).then_some(from);
        self.age_s = if leaves { f64::INFINITY } else { 0.0 };
        if leaves {
            // The last word to a device that goes is zero force, like that of a session that ends here.
            self.answer(from, FLAG_STOP, self.session, [Vec2::zeros(); 2], word.time_us);
        }
        Ok(())
    }

    /// The first motion of a session that was promised.
    fn begin(&mut self) {
        (self.session, self.promised) = (self.promised, 0);
        self.newest = None;
        self.world_end = WorldEnd::default();
    }

    /// Sends the forces (N), or the waves that stand for them. The flag to stop is for waves: plain packets say zero.
    fn answer(&mut self, to: SocketAddr, flags: u16, session: u64, force_n: [Vec2; 2], echo_us: u64) {
        self.sent += 1;
        let (sequence, time_us) = (self.sent, (self.now_s * 1e6) as u64);
        if let Some(waves) = self.waves {
            let impedance_n_s_m = waves.impedance_n_s_m;
            // A mere request has no waves yet.
            let accounts = if flags & FLAG_GREETING == 0 { self.world_end.accounts() } else { Default::default() };
            let packet = WaveDown { flags, session, sequence, time_us, accounts, impedance_n_s_m, echo_us };
            self.wire.send(&packet.encode(&self.key), to);
        } else {
            let flags = flags & FLAG_GREETING;
            let packet = Force { flags, session, sequence, time_us, force_n, echo_us };
            self.wire.send(&packet.encode(&self.key), to);
        }
    }
}

impl<W: Wire> Device for UdpDevice<W> {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample {
        self.now_s += dt_s;
        self.age_s += dt_s;
        self.receive();
        if self.age_s > FORGET_S {
            self.peer = None;
        }
        if let Some(waves) = self.waves.filter(|_| dt_s > 0.0 && self.newest.is_some()) {
            self.sample.tip_velocity = self.world_end.tick(&waves, command.force_n, SMOOTHING_S, dt_s);
            for (tip, velocity) in self.sample.tip_in_world.iter_mut().zip(self.sample.tip_velocity) {
                *tip += velocity * dt_s;
            }
        }
        if let Some(peer) = self.peer {
            self.answer(peer, 0, self.session, command.force_n, self.echo_us);
        }
        let patience_s = if self.waves.is_some() { WAVE_FRESH_S } else { FRESH_S };
        self.sample.fresh = [self.age_s < patience_s; 2];
        self.sample
    }

    fn delay_s(&self) -> f64 {
        // Waves need no allowance for the delay of the line.
        if self.waves.is_some() { 0.0 } else { self.delay_s }
    }

    fn line_stiffness_n_m(&self) -> Option<f64> {
        // The round trip is stated; half of it is one way.
        self.waves.map(|waves| waves.line_stiffness_n_m(0.5 * self.delay_s + SMOOTHING_S))
    }

    fn make_safe(&mut self) {
        if let Some(peer) = self.peer {
            // Said three times, because packets are lost.
            for _ in 0..3 {
                self.answer(peer, FLAG_STOP, self.session, [Vec2::zeros(); 2], self.echo_us);
            }
        }
    }
}

impl<W: Wire> Drop for UdpDevice<W> {
    fn drop(&mut self) {
        self.make_safe();
    }
}
