//! A device at the other end of a network: positions come in as UDP packets, forces go back.
//!
//! Every packet is sealed with a shared key. A device first asks for a session (a number drawn at random when the port is opened);
//! only motion of this session, with a sequence above all before, moves the fingers and gets forces. So what was recorded on the
//! wire is worth nothing later, in the same session or in another. The tick reads at most [`PACKETS_A_TICK`] packets from a socket
//! that never waits, into a buffer that was there before, and answers with one.

mod key;
mod packet;
#[cfg(test)]
mod tests;

pub use key::{Key, KeyError, SEAL_BYTES};
pub use packet::{
    FLAG_BYE, FLAG_GREETING, FORCE_BYTES, Force, MAGIC, MAX_POSITION_M, MAX_VELOCITY_M_S, MOTION_BYTES, Motion,
    Refused, VERSION,
};

use super::{Command, Device, DeviceSpec, Sample};
use crate::Vec2;
use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Packets that one tick reads at the most: a flood costs the tick no more than this, and ends in zero force.
pub const PACKETS_A_TICK: usize = 16;
/// The port, when none is named.
pub const PORT: u16 = 47_474;
/// A sample counts as fresh for this long: a device that sends at 250 Hz or faster is never stale.
const FRESH_S: f64 = 0.004;
/// Nothing from the device for this long: its address is forgotten and gets no more packets.
const FORGET_S: f64 = 1.0;

/// Where to listen and whom to believe.
#[derive(Clone, Debug)]
pub struct UdpConfig {
    /// Address and port. Loopback by default: to be reached from other machines, name the address of a network card.
    pub listen: SocketAddr,
    /// The shared key.
    pub key: Key,
    /// What the remote device can do.
    pub spec: DeviceSpec,
    /// Round trip to it, s: the stiffness that may be rendered is computed with it.
    pub delay_s: f64,
}

impl UdpConfig {
    /// On this machine only, at the usual port, for a device that feels up to 4 N and states nothing else of itself.
    pub fn loopback(key: Key) -> Self {
        Self { listen: SocketAddr::from((Ipv4Addr::LOCALHOST, PORT)), key, spec: Self::unstated(), delay_s: 0.0 }
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
    /// Where.
    listen: SocketAddr,
    /// What the system says.
    reason: String,
}

#[derive(Debug, Default)]
struct Counters {
    accepted: AtomicU64,
    greeted: AtomicU64,
    refused: [AtomicU64; Refused::ALL.len()],
}

/// Packets so far, for panels and tests; read from any thread.
#[derive(Clone, Debug)]
pub struct UdpMonitor {
    counters: Arc<Counters>,
    address: SocketAddr,
}

impl UdpMonitor {
    /// Motion packets that moved the fingers.
    pub fn accepted(&self) -> u64 {
        self.counters.accepted.load(Ordering::Relaxed)
    }

    /// Devices that asked for a session.
    pub fn greeted(&self) -> u64 {
        self.counters.greeted.load(Ordering::Relaxed)
    }

    /// Packets that were refused for a reason.
    pub fn refused(&self, why: Refused) -> u64 {
        self.counters.refused[why as usize].load(Ordering::Relaxed)
    }

    /// Where the device listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }
}

/// The servo's end of a remote device.
#[derive(Debug)]
pub struct UdpDevice {
    spec: DeviceSpec,
    delay_s: f64,
    socket: UdpSocket,
    key: Key,
    monitor: UdpMonitor,
    session: u64,
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
        let address = socket.local_addr().map_err(fail)?;
        Ok(Self {
            spec: config.spec,
            delay_s: config.delay_s,
            socket,
            key: config.key,
            monitor: UdpMonitor { counters: Arc::new(Counters::default()), address },
            // Zero asks for a session, so no session has this number.
            session: rand::random::<u64>().max(1),
            newest: None,
            sent: 0,
            peer: None,
            echo_us: 0,
            age_s: f64::INFINITY,
            now_s: 0.0,
            sample: Sample { tip_in_world: start_in_world, tip_velocity: [Vec2::zeros(); 2], fresh: false },
        })
    }

    /// Counts packets, from any thread.
    pub fn monitor(&self) -> UdpMonitor {
        self.monitor.clone()
    }

    /// Reads what has come, at most [`PACKETS_A_TICK`] packets.
    fn receive(&mut self) {
        // One byte more than the largest packet shows what was too long.
        let mut buffer = [0; MOTION_BYTES + 1];
        for _ in 0..PACKETS_A_TICK {
            let (size, from) = match self.socket.recv_from(&mut buffer) {
                Ok(received) => received,
                Err(e) if e.kind() == std::io::ErrorKind::WouldBlock => return,
                // Some systems report here that an earlier answer found nobody; the next packet is behind it.
                Err(_) => continue,
            };
            if let Err(why) = Motion::decode(&buffer[..size], &self.key).and_then(|motion| self.take(&motion, from)) {
                self.monitor.counters.refused[why as usize].fetch_add(1, Ordering::Relaxed);
            }
        }
    }

    /// Takes a sealed motion packet in.
    fn take(&mut self, motion: &Motion, from: SocketAddr) -> Result<(), Refused> {
        if motion.session == 0 {
            self.monitor.counters.greeted.fetch_add(1, Ordering::Relaxed);
            self.answer(from, FLAG_GREETING, [Vec2::zeros(); 2], motion.time_us);
            return Ok(());
        }
        if motion.session != self.session {
            return Err(Refused::Session);
        }
        if self.newest.is_some_and(|newest| motion.sequence <= newest) {
            return Err(Refused::Sequence);
        }
        self.newest = Some(motion.sequence);
        self.monitor.counters.accepted.fetch_add(1, Ordering::Relaxed);
        self.sample.tip_in_world = motion.tip_in_world;
        self.sample.tip_velocity = motion.tip_velocity;
        self.echo_us = motion.time_us;
        let leaves = motion.flags & FLAG_BYE != 0;
        self.peer = (!leaves).then_some(from);
        self.age_s = if leaves { f64::INFINITY } else { 0.0 };
        if leaves {
            // The last word to a device that goes is zero force, like that of a session that ends here.
            self.answer(from, 0, [Vec2::zeros(); 2], motion.time_us);
        }
        Ok(())
    }

    fn answer(&mut self, to: SocketAddr, flags: u16, force_n: [Vec2; 2], echo_us: u64) {
        self.sent += 1;
        let time_us = (self.now_s * 1e6) as u64;
        let force = Force { flags, session: self.session, sequence: self.sent, time_us, force_n, echo_us };
        // A packet that cannot be sent is a packet that is lost: the device goes to zero force by itself.
        let _ = self.socket.send_to(&force.encode(&self.key), to);
    }
}

impl Device for UdpDevice {
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
        if let Some(peer) = self.peer {
            self.answer(peer, 0, command.force_n, self.echo_us);
        }
        self.sample.fresh = self.age_s < FRESH_S;
        self.sample
    }

    fn delay_s(&self) -> f64 {
        self.delay_s
    }

    fn make_safe(&mut self) {
        if let Some(peer) = self.peer {
            // Said three times, because packets are lost.
            for _ in 0..3 {
                self.answer(peer, 0, [Vec2::zeros(); 2], self.echo_us);
            }
        }
    }
}

impl Drop for UdpDevice {
    fn drop(&mut self) {
        self.make_safe();
    }
}
