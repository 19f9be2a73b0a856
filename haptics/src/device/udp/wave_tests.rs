//! Waves over the real socket, with half a second of round trip in simulated time between the hand and it.

use super::*;
use crate::device::channel::line::Line;
use crate::device::impedance::HandImpedance;
use crate::device::waves::OperatorEnd;
use crate::world::presets;
use std::time::Duration;

const DT: f64 = 1e-3;
const ONE_WAY_S: f64 = 0.25;
/// The wall, N/m, 1 mm to the right of where the hand begins.
const STIFFNESS: f64 = 2_000.0;

fn key() -> Key {
    Key::new([0x21; 32])
}

fn waves() -> Waves {
    let spec = DeviceSpec { damping_n_s_m: HandImpedance::default().damping_n_s_m, ..UdpConfig::unstated() };
    Waves::new(&spec, &presets::table(), DT)
}

fn open(waves: Option<Waves>) -> UdpDevice {
    let listen = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
    UdpDevice::open(UdpConfig { listen, waves, ..UdpConfig::loopback(key()) }, [Vec2::zeros(); 2]).expect("a free port")
}

fn socket(device: &UdpDevice) -> UdpSocket {
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("a free port");
    socket.connect(device.monitor().address()).expect("loopback");
    socket.set_read_timeout(Some(Duration::from_secs(10))).expect("a time-out");
    socket
}

fn received(socket: &UdpSocket) -> ([u8; 200], usize) {
    let mut buffer = [0; 200];
    let size = socket.recv(&mut buffer).expect("an answer");
    (buffer, size)
}

/// A hand on its spring and damper at the far end, which wants to be somewhere along x.
struct Hand {
    socket: UdpSocket,
    with_waves: bool,
    end: OperatorEnd,
    session: u64,
    sequence: u64,
    up: Line<Vec<u8>>,
    down: Line<([u8; 200], usize)>,
    force_n: [Vec2; 2],
    position: [Vec2; 2],
    velocity: [Vec2; 2],
    /// Energy that it has put into the line, J, and the least of all times.
    energy_j: f64,
    least_j: f64,
}

impl Hand {
    /// Greets without delay and begins.
    fn begin(device: &mut UdpDevice, loss: f64) -> Self {
        let with_waves = device.waves.is_some();
        let mut hand = Self {
            socket: socket(device),
            with_waves,
            end: OperatorEnd::default(),
            session: 0,
            sequence: 0,
            up: Line::new(ONE_WAY_S, 0.0, loss, 1),
            down: Line::new(ONE_WAY_S, 0.0, loss, 2),
            force_n: [Vec2::zeros(); 2],
            position: [Vec2::zeros(); 2],
            velocity: [Vec2::zeros(); 2],
            energy_j: 0.0,
            least_j: 0.0,
        };
        let hello = hand.packet();
        hand.socket.send(&hello).expect("loopback");
        device.exchange(&Command::default(), DT);
        let (bytes, size) = received(&hand.socket);
        hand.session = if with_waves {
            let greeting = WaveDown::decode(&bytes[..size], &key()).expect("sealed by the device");
            assert_eq!((greeting.flags, greeting.impedance_n_s_m), (FLAG_GREETING, waves().impedance_n_s_m));
            greeting.session
        } else {
            Force::decode(&bytes[..size], &key()).expect("sealed by the device").session
        };
        hand
    }

    fn packet(&mut self) -> Vec<u8> {
        self.sequence += 1;
        let (session, sequence) = (self.session, self.sequence);
        if self.with_waves {
            return WaveUp { session, sequence, accounts: self.end.accounts(), ..WaveUp::default() }
                .encode(&key())
                .to_vec();
        }
        let (tip_in_world, tip_velocity) = (self.position, self.velocity);
        Motion { session, sequence, tip_in_world, tip_velocity, ..Motion::default() }.encode(&key()).to_vec()
    }

    /// One tick of the hand: arrived packets, forces, motion, sent packets. Returns the packets that reach the device
    /// now.
    fn tick(&mut self, now_s: f64, goal_m: f64) {
        if let Some((bytes, size)) = self.down.receive(now_s) {
            if self.with_waves {
                self.end.arrive(WaveDown::decode(&bytes[..size], &key()).expect("sealed").accounts);
            } else {
                self.force_n = Force::decode(&bytes[..size], &key()).expect("sealed").force_n;
            }
        }
        if self.with_waves {
            self.force_n = self.end.forces(&waves(), SMOOTHING_S, 1e6, DT);
        }
        for finger in 0..2 {
            let before = self.position[finger];
            let (position, velocity) = (&mut self.position[finger], &mut self.velocity[finger]);
            let wanted = (Vec2::new(goal_m, 0.0), Vec2::zeros());
            HandImpedance::default().advance(position, velocity, wanted, self.force_n[finger], DT);
            self.energy_j -= self.force_n[finger].dot(&(*position - before));
        }
        self.least_j = self.least_j.min(self.energy_j);
        if self.with_waves {
            self.end.moved(&waves(), self.force_n, self.position, 0.0, DT);
        }
        let packet = self.packet();
        self.up.send(now_s, packet);
        if let Some(packet) = self.up.receive(now_s) {
            self.socket.send(&packet).expect("loopback");
        }
    }
}

/// Course of hand and tip along x, m.
struct Course {
    hand_m: Vec<f64>,
    tip_m: Vec<f64>,
    least_j: f64,
}

/// The hand presses 3 mm into the wall from half a second on.
fn press(device: &mut UdpDevice, seconds: f64, loss: f64) -> Course {
    let mut hand = Hand::begin(device, loss);
    let mut course = Course { hand_m: Vec::new(), tip_m: Vec::new(), least_j: 0.0 };
    let mut command = Command::default();
    for tick in 0..(seconds / DT) as u32 {
        let now_s = f64::from(tick) * DT;
        let goal_m = if now_s > 0.5 { 0.004 } else { 0.0 };
        hand.tick(now_s, goal_m);
        let sample = device.exchange(&command, DT);
        if device.peer.is_some() {
            hand.down.send(now_s, received(&hand.socket));
        }
        command.force_n = sample.tip_in_world.map(|tip| Vec2::new(-STIFFNESS * (tip.x - 0.001).max(0.0), 0.0));
        course.hand_m.push(hand.position[0].x);
        course.tip_m.push(sample.tip_in_world[0].x);
    }
    course.least_j = hand.least_j;
    course
}

fn spread(series: &[f64]) -> f64 {
    let (low, high) = series.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
    high - low
}

#[test]
fn at_half_a_second_of_round_trip_plain_packets_swing_and_waves_rest() {
    let plain = press(&mut open(None), 15.0, 0.0);
    assert!(spread(&plain.hand_m[10_000..]) > 5e-3, "it never rests: {} m", spread(&plain.hand_m[10_000..]));
    assert!(plain.least_j < -1e-3, "and gives energy out: {} J", plain.least_j);
    for loss in [0.0, 0.3] {
        let waved = press(&mut open(Some(waves())), 30.0, loss);
        let late = 25_000..;
        assert!(
            spread(&waved.hand_m[late.clone()]) < 5e-5,
            "the hand rests: {} m",
            spread(&waved.hand_m[late.clone()])
        );
        assert!(spread(&waved.tip_m[late]) < 5e-5, "the tip rests");
        assert!(waved.least_j > -1e-6, "no energy is given out: {} J", waved.least_j);
        // Three springs in series, 400 N/m from 4 mm, b/d, 2000 N/m from 1 mm; a tick each way adds to the delay.
        let line = waves().line_stiffness_n_m(ONE_WAY_S + SMOOTHING_S + DT);
        let force = 0.003 / (1.0 / 400.0 + 1.0 / line + 1.0 / STIFFNESS);
        // Both tremble a little if packets are lost: the mean of two seconds.
        let mean = |series: &[f64]| series[28_000..].iter().sum::<f64>() / 2_000.0;
        let felt = 400.0 * (0.004 - mean(&waved.hand_m));
        // The receivers smooth over the gaps of lost packets, which adds a little delay; the force stays all the same.
        let within = if loss > 0.0 { 0.2 } else { 0.02 };
        assert!((felt / force - 1.0).abs() < within, "loss {loss}: the hand feels {felt} N, should be {force} N");
        let pressed = STIFFNESS * (mean(&waved.tip_m) - 0.001);
        assert!((pressed / felt - 1.0).abs() < 0.02, "the wall {pressed} N, the hand {felt} N");
    }
}

#[test]
fn who_speaks_otherwise_is_told_apart_and_moves_nothing() {
    let (mut plain, mut waved) = (open(None), open(Some(waves())));
    for (device, packet) in [
        (&mut plain, WaveUp::default().encode(&key()).to_vec()),
        (&mut waved, Motion::default().encode(&key()).to_vec()),
    ] {
        socket(device).send(&packet).expect("loopback");
        device.exchange(&Command::default(), DT);
        assert_eq!((device.monitor().refused(Refused::Version), device.monitor().greeted()), (1, 0));
    }
    assert_eq!(waved.spec().damping_n_s_m, waves().impedance_n_s_m, "at this end the line is felt");
    assert_eq!((waved.delay_s(), waved.spec().resolution_m), (0.0, 0.0));
}

#[test]
fn a_new_session_begins_with_new_waves_and_the_end_says_stop() {
    let mut device = open(Some(waves()));
    let mut first = Hand::begin(&mut device, 0.0);
    let answer = |device: &mut UdpDevice, hand: &mut Hand, packet: WaveUp| {
        hand.socket.send(&packet.encode(&key())).expect("loopback");
        let sample = device.exchange(&Command { force_n: [Vec2::new(-1.0, 0.0); 2] }, DT);
        let (bytes, size) = received(&hand.socket);
        (sample, WaveDown::decode(&bytes[..size], &key()).expect("sealed"))
    };
    let account = Account { integral: Vec2::new(0.01, 0.0), energy_j: 1.0 };
    let mut up = WaveUp { session: first.session, sequence: 5, accounts: [account; 2], ..WaveUp::default() };
    let (sample, down) = answer(&mut device, &mut first, up);
    assert!(sample.is_fresh() && sample.tip_velocity[0].x > 0.0 && down.accounts[0].integral.x != 0.0);
    // Another device, or the same one restarted: it counts from one, and its waves from zero.
    let mut second = Hand::begin(&mut device, 0.0);
    let origin = [Vec2::new(0.02, -0.1); 2];
    up = WaveUp { session: second.session, sequence: 1, origin_in_world: origin, ..WaveUp::default() };
    let (sample, _) = answer(&mut device, &mut second, up);
    assert!(sample.is_fresh() && (sample.tip_in_world[0] - origin[0]).norm() < 1e-3, "{sample:?}");
    assert_eq!(device.monitor().accepted(), 2);
    // The session before is over, whatever its sequence.
    first.socket.send(&WaveUp { session: first.session, sequence: 1_000, ..up }.encode(&key())).expect("loopback");
    device.exchange(&Command::default(), DT);
    assert_eq!(device.monitor().refused(Refused::Session), 1);
    received(&second.socket);
    device.make_safe();
    let (bytes, size) = received(&second.socket);
    assert_eq!(WaveDown::decode(&bytes[..size], &key()).expect("sealed").flags, FLAG_STOP);
}
