//! A remote device among enemies: only what is sealed with the key, belongs to the session and is new counts as a hand.

use crate::Chaos;
use haptics::Vec2;
use haptics::device::udp::{FLAG_GREETING, Force, Key, Motion, UdpConfig, UdpDevice};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Swap};
use haptics::world::{State, World, presets};
use rand::RngExt as _;
use rand::rngs::StdRng;
use std::net::{Ipv4Addr, SocketAddr, UdpSocket};

const DT: f64 = 1e-3;
const PHASES: usize = 40;
/// Time for which a sample counts as fresh on this line, and that in which a queue of packets is worked off, s.
const FRESH_S: f64 = 0.004;
const QUEUE_S: f64 = 0.1;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    Good,
    Silent,
    Noise,
    Spoiled,
    Replayed,
    OtherKey,
    Flood,
    Anew,
}

const KINDS: [Phase; 10] = [
    Phase::Good,
    Phase::Good,
    Phase::Anew,
    Phase::Silent,
    Phase::Noise,
    Phase::Spoiled,
    Phase::Replayed,
    Phase::OtherKey,
    Phase::Flood,
    Phase::Good,
];

/// The far end, honest or not.
pub struct Client {
    socket: UdpSocket,
    key: Key,
    pub session: u64,
    sequence: u64,
    /// What was on the wire, for who records it.
    heard: Vec<Vec<u8>>,
}

impl Client {
    pub fn new(to: SocketAddr, key: Key) -> Self {
        let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
        socket.connect(to).expect("loopback");
        socket.set_nonblocking(true).expect("a socket");
        Self { socket, key, session: 0, sequence: 0, heard: Vec::new() }
    }

    pub fn send(&self, packet: &[u8]) {
        // What the system does not take is lost, as on any network.
        let _ = self.socket.send(packet);
    }

    /// Two tips that lean on the table.
    pub fn motion(&mut self) -> Vec<u8> {
        self.sequence += 1;
        let tips = [Vec2::new(-0.02, -0.1258), Vec2::new(0.02, -0.1258)];
        let (session, sequence) = (self.session, self.sequence);
        let motion = Motion { session, sequence, tip_in_world: tips, ..Motion::default() };
        motion.encode(&self.key).to_vec()
    }

    /// What came back; a greeting names the session.
    pub fn listen(&mut self) {
        let mut buffer = [0; 256];
        while let Ok(size) = self.socket.recv(&mut buffer) {
            if let Ok(force) = Force::decode(&buffer[..size], &self.key)
                && force.flags & FLAG_GREETING != 0
            {
                (self.session, self.sequence) = (force.session, 0);
            }
        }
    }
}

/// A device that listens on a port of its own, and its key.
pub fn device(world: &World) -> (UdpDevice, Key) {
    let key = Key::new([7; 32]);
    let listen = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
    let mut config = UdpConfig { listen, ..UdpConfig::loopback(key.clone()) };
    config.spec.damping_n_s_m = 10.0;
    let device = UdpDevice::open(config, State::resting(world).input.tip_in_world).expect("a free port");
    (device, key)
}

pub fn attacked(chaos: &mut Chaos) {
    let world = presets::table();
    let (device, key) = device(&world);
    let monitor = device.monitor();
    let limits = Limits { ramp_s: 0.05, ..Limits::default() };
    let mut body = Loop::new(Swap::new(world), Box::new(device), limits);
    let mut client = Client::new(monitor.address(), key);
    let (mut since_s, mut since_flood_s) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..PHASES {
        let phase = KINDS[chaos.rng.random_range(0..KINDS.len())];
        if phase == Phase::Anew {
            client.session = 0;
        }
        for _ in 0..chaos.rng.random_range(20..400) {
            (since_s, since_flood_s) = (since_s + DT, since_flood_s + DT);
            let honest = act(&mut client, phase, &mut chaos.rng);
            if honest {
                since_s = 0.0;
            }
            if phase == Phase::Flood {
                since_flood_s = 0.0;
            }
            // The word stood behind what the flood has left.
            let queued = since_flood_s - since_s < QUEUE_S;
            let tick = body.tick(DT);
            client.listen();
            let is_zero = tick.sent_force_n == [Vec2::zeros(); 2];
            let late_s = FRESH_S + limits.watchdog_s + 3.5 * DT + if queued { QUEUE_S } else { 0.0 };
            if since_s > late_s {
                assert!(is_zero, "{phase:?}: {:?} N, {since_s} s after the last honest word", tick.sent_force_n);
                chaos.count("ticks without fresh data", 1);
            }
            chaos.count("ticks with force", u64::from(!is_zero));
        }
    }
    chaos.count("sealed packets taken", monitor.accepted());
    let refused = haptics::device::udp::Refused::ALL.into_iter().map(|why| monitor.refused(why)).sum();
    chaos.count("packets refused", refused);
}

/// What goes onto the wire in a tick; true when an honest, new motion is among it.
fn act(client: &mut Client, phase: Phase, rng: &mut StdRng) -> bool {
    match phase {
        Phase::Good | Phase::Anew => {
            let packet = client.motion();
            client.send(&packet);
            let asks = client.session == 0;
            if !asks && client.heard.len() < 200 {
                client.heard.push(packet);
            }
            !asks
        }
        Phase::Silent => false,
        Phase::Noise => {
            let noise: Vec<u8> = (0..rng.random_range(0..1_400)).map(|_| rng.random()).collect();
            client.send(&noise);
            false
        }
        Phase::Spoiled => {
            let packet = client.motion();
            let spoiled = tests::spoiled::bytes(&packet, rng);
            let same = spoiled == packet;
            client.send(&spoiled);
            same && client.session != 0
        }
        Phase::Replayed => {
            if !client.heard.is_empty() {
                client.send(&client.heard[rng.random_range(0..client.heard.len())]);
            }
            false
        }
        Phase::OtherKey => {
            let honest = std::mem::replace(&mut client.key, Key::new([8; 32]));
            let packet = client.motion();
            client.send(&packet);
            client.key = honest;
            false
        }
        Phase::Flood => {
            let noise: Vec<u8> = (0..112).map(|_| rng.random()).collect();
            (0..40).for_each(|_| client.send(&noise));
            false
        }
    }
}
