//! Any bytes as packets of a remote device, as they come and with a right seal, and as the whole life of a session: greetings, motions,
//! replays and noise between ticks of a servo. No panic, nothing out of bounds, no force without a new, sealed motion of the session.

use haptics::Vec2;
use haptics::device::Device;
use haptics::device::udp::{
    FLAG_GREETING, Force, Key, MAX_POSITION_M, MAX_VELOCITY_M_S, Motion, UdpConfig, UdpDevice, WaveDown, WaveUp, Waves,
    Wire,
};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Swap};
use haptics::world::{State, presets};
use std::collections::VecDeque;
use std::io::{Error, ErrorKind, Result};
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

const DT_S: f64 = 1e-3;
/// Longest that a sample with positions, and one with waves, keeps a force alive: it counts as fresh for a while, and then the watchdog waits, s.
const ALIVE_S: [f64; 2] = [0.004 + 0.02 + 3.0 * DT_S, 0.05 + 0.02 + 3.0 * DT_S];

pub fn run(bytes: &[u8]) {
    let key = Key::new([7; 32]);
    look(bytes, &key);
    // An enemy has no key; a far end with a bug has one.
    let mut numbers = bytes.chunks_exact(8).map(|eight| eight.try_into().expect("eight bytes"));
    let mut whole = || numbers.next().map_or(0, u64::from_le_bytes);
    let (session, sequence, time_us) = (whole(), whole(), whole());
    let mut point = || Vec2::new(f64::from_bits(whole()), f64::from_bits(whole()));
    let (tip_in_world, tip_velocity) = ([point(), point()], [point(), point()]);
    let motion = Motion { flags: 0, session, sequence, time_us, tip_in_world, tip_velocity };
    look(&motion.encode(&key), &key);
    // A script of what happens at the port; its first byte chooses the kind of packets.
    if let [kind, script @ ..] = bytes {
        Talk::new(kind % 2 == 1, key).follow(script);
    }
}

fn look(packet: &[u8], key: &Key) {
    if let Ok(motion) = Motion::decode(packet, key) {
        assert!(motion.tip_in_world.iter().all(|tip| tip.amax() <= MAX_POSITION_M));
        assert!(motion.tip_velocity.iter().all(|velocity| velocity.amax() <= MAX_VELOCITY_M_S));
    }
    if let Ok(wave) = WaveUp::decode(packet, key) {
        assert!(wave.origin_in_world.iter().all(|tip| tip.amax() <= MAX_POSITION_M));
    }
    let _ = (Force::decode(packet, key), WaveDown::decode(packet, key));
}

/// A port without a network: what comes, and the newest session that was given away.
#[derive(Default)]
struct Port {
    /// Packets, the port of their sender, and whether they may be an honest motion.
    coming: VecDeque<(Vec<u8>, u16, bool)>,
    told: Option<Vec<u8>>,
}

#[derive(Clone, Default)]
struct Line(Arc<Mutex<Port>>);

impl Line {
    fn port(&self) -> MutexGuard<'_, Port> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Wire for Line {
    fn receive(&mut self, into: &mut [u8]) -> Result<(usize, SocketAddr)> {
        let (packet, from, _) = self.port().coming.pop_front().ok_or(Error::from(ErrorKind::WouldBlock))?;
        let size = packet.len().min(into.len());
        into[..size].copy_from_slice(&packet[..size]);
        Ok((size, SocketAddr::from((Ipv4Addr::LOCALHOST, from))))
    }

    fn send(&mut self, packet: &[u8], _: SocketAddr) {
        self.port().told = Some(packet.to_vec());
    }
}

/// A servo with a remote device, and its far end.
struct Talk {
    body: Loop,
    line: Line,
    key: Key,
    waves: bool,
    session: u64,
    sequence: u64,
    last: Vec<u8>,
    /// Time since a motion that may be honest waited at the port, s.
    since_s: f64,
}

impl Talk {
    fn new(waves: bool, key: Key) -> Self {
        let world = presets::table();
        let mut config = UdpConfig {
            waves: waves.then_some(Waves { impedance_n_s_m: 10.0, damper_n_s_m: 5.0 }),
            ..UdpConfig::loopback(key.clone())
        };
        config.spec.damping_n_s_m = 10.0;
        let line = Line::default();
        let device = UdpDevice::over(line.clone(), config, State::resting(&world).input.tip_in_world);
        assert!(device.spec().force_feedback);
        let limits = Limits { ramp_s: 2.0 * DT_S, ..Limits::default() };
        let body = Loop::new(Swap::new(world), Box::new(device), limits);
        Self { body, line, key, waves, session: 0, sequence: 0, last: Vec::new(), since_s: f64::INFINITY }
    }

    fn follow(&mut self, mut script: &[u8]) {
        while let [deed, rest @ ..] = script {
            script = rest;
            let mut take = |count: usize| {
                let (taken, rest) = script.split_at(count.min(script.len()));
                script = rest;
                taken.to_vec()
            };
            match deed % 7 {
                0 | 1 => (0..=deed / 7).for_each(|_| self.tick()),
                2 => {
                    self.sequence = 0;
                    let packet = self.packet(0, 0, 0, [Vec2::zeros(); 2]);
                    self.send(packet, false);
                }
                3 => {
                    self.sequence += 1;
                    // Thousandths of the largest place; a byte says how deep the tips are in the table.
                    let x = take(2);
                    let at = |k: usize| f64::from(x.get(k).copied().unwrap_or(0)) * 1e-3;
                    let tips = [Vec2::new(-0.02 - at(0), -0.12 - at(1)), Vec2::new(0.02 + at(0), -0.12 - at(1))];
                    let packet = self.packet(0, self.session, self.sequence, tips);
                    self.send(packet, self.session != 0);
                }
                4 => {
                    let numbers = take(42);
                    let whole = |k: usize| {
                        numbers.get(8 * k..8 * k + 8).map_or(0, |b| u64::from_le_bytes(b.try_into().unwrap_or([0; 8])))
                    };
                    let flags = numbers.get(40..42).map_or(0, |b| u16::from_le_bytes([b[0], b[1]]));
                    let real = |k: usize| f64::from_bits(whole(k));
                    let tips = [Vec2::new(real(1), real(2)), Vec2::new(real(3), real(4))];
                    let packet = self.packet(flags, self.session, whole(0), tips);
                    self.send(packet, self.session != 0);
                }
                5 => {
                    let size = take(1).first().copied().unwrap_or(0);
                    let noise = take(usize::from(size));
                    self.line.port().coming.push_back((noise, 1, false));
                }
                // Sent again, by somebody else.
                _ => {
                    let last = self.last.clone();
                    self.line.port().coming.push_back((last, 2, false));
                }
            }
        }
        (0..4).for_each(|_| self.tick());
    }

    fn packet(&self, flags: u16, session: u64, sequence: u64, tips: [Vec2; 2]) -> Vec<u8> {
        if self.waves {
            let mut wave = WaveUp { flags, session, sequence, origin_in_world: tips, ..WaveUp::default() };
            for (account, tip) in wave.accounts.iter_mut().zip(tips) {
                (account.integral, account.energy_j) = (tip, tip.norm_squared());
            }
            return wave.encode(&self.key).to_vec();
        }
        Motion { flags, session, sequence, tip_in_world: tips, ..Motion::default() }.encode(&self.key).to_vec()
    }

    fn send(&mut self, packet: Vec<u8>, honest: bool) {
        self.last.clone_from(&packet);
        self.line.port().coming.push_back((packet, 1, honest));
    }

    fn tick(&mut self) {
        // What waits in the queue may be read ticks later.
        let queued = self.line.port().coming.iter().any(|(_, _, honest)| *honest);
        self.since_s = if queued { 0.0 } else { self.since_s + DT_S };
        let tick = self.body.tick(DT_S);
        for (tip, force) in tick.device_in_world.iter().zip(tick.sent_force_n) {
            assert!(tip.iter().all(|x| x.is_finite()), "{tip}");
            assert!(force.norm() <= Limits::default().max_force_n + 1e-9, "{force} N");
            let is_alive = self.since_s <= ALIVE_S[usize::from(self.waves)];
            assert!(is_alive || force == Vec2::zeros(), "{force} N, {} s after the last sealed packet", self.since_s);
        }
        let Some(told) = self.line.port().told.take() else { return };
        let greeted = if self.waves {
            WaveDown::decode(&told, &self.key).map(|d| (d.flags, d.session))
        } else {
            Force::decode(&told, &self.key).map(|d| (d.flags, d.session))
        };
        // Whatever is sent can be read.
        let (flags, session) = greeted.expect("a packet of ours");
        if flags & FLAG_GREETING != 0 {
            self.session = session;
        }
    }
}
