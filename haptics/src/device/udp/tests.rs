//! The real socket on the loopback, with a client that does everything wrong.

use super::*;
use crate::servo::safety::Limits;
use crate::servo::{Loop, Swap};
use crate::world::presets;
use std::time::Duration;

const DT: f64 = 1e-3;

fn key() -> Key {
    Key::new([0x11; 32])
}

fn open() -> (UdpDevice, Client) {
    let listen = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
    let start = [Vec2::new(-0.01, -0.08), Vec2::new(0.01, -0.08)];
    let mut config = UdpConfig { listen, ..UdpConfig::loopback(key()) };
    // Damping enough for the pads to be rendered as they are.
    config.spec.damping_n_s_m = 10.0;
    let device = UdpDevice::open(config, start).expect("a free port");
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("a free port");
    socket.connect(device.monitor().address()).expect("loopback");
    socket.set_read_timeout(Some(Duration::from_secs(10))).expect("a time-out");
    (device, Client { socket, session: 0, sequence: 0 })
}

struct Client {
    socket: UdpSocket,
    session: u64,
    sequence: u64,
}

impl Client {
    fn motion(&mut self, depth_m: f64) -> Motion {
        self.sequence += 1;
        let tip = |x: f64| Vec2::new(x, -0.125 - depth_m);
        Motion {
            session: self.session,
            sequence: self.sequence,
            time_us: 1_000 * self.sequence,
            tip_in_world: [tip(-0.02), tip(0.02)],
            ..Motion::default()
        }
    }

    fn send(&self, packet: &[u8]) {
        self.socket.send(packet).expect("loopback takes packets");
    }

    fn receive(&self) -> Force {
        let mut buffer = [0; 200];
        let size = self.socket.recv(&mut buffer).expect("an answer");
        Force::decode(&buffer[..size], &key()).expect("sealed by the device")
    }

    fn greet(&mut self, device: &mut UdpDevice) {
        let hello = self.motion(0.0);
        self.send(&hello.encode(&key()));
        device.exchange(&Command::default(), DT);
        let greeting = self.receive();
        assert_eq!(greeting.flags, FLAG_GREETING);
        assert_eq!(greeting.force_n, [Vec2::zeros(); 2]);
        self.session = greeting.session;
    }
}

#[test]
fn moves_the_fingers_and_feels_the_table() {
    let (mut device, mut client) = open();
    let monitor = device.monitor();
    assert!(!device.exchange(&Command::default(), DT).is_fresh(), "nobody there yet");
    client.greet(&mut device);
    let limits = Limits { ramp_s: 0.01, ..Limits::default() };
    let mut servo = Loop::new(Swap::new(presets::table()), Box::new(device), limits);
    let mut felt = Force::default();
    for _ in 0..100 {
        let motion = client.motion(0.0005);
        client.send(&motion.encode(&key()));
        servo.tick(DT);
        felt = client.receive();
        assert_eq!(felt.echo_us, motion.time_us);
    }
    // 0.5 mm into a pad of 2500 N/m in front of a table of 8000 N/m: about 1 N upwards.
    assert!(felt.force_n.iter().all(|f| f.y > 0.5 && f.y < 1.5), "{felt:?}");
    assert_eq!((monitor.accepted(), monitor.greeted()), (100, 1));
    // The device is gone without a word: zero force within the watchdog time.
    let mut tick = servo.tick(DT);
    for _ in 0..30 {
        tick = servo.tick(DT);
    }
    assert!(tick.flags.stale && tick.sent_force_n == [Vec2::zeros(); 2]);
    drop(servo);
    let last = std::iter::repeat_with(|| client.receive()).take(34).last().expect("34 answers");
    assert_eq!(last.force_n, [Vec2::zeros(); 2], "the last word is zero force");
}

#[test]
fn strangers_replays_and_other_sessions_move_nothing() {
    let (mut device, mut client) = open();
    let monitor = device.monitor();
    client.greet(&mut device);
    let (first, second) = (client.motion(0.0).encode(&key()), client.motion(0.001).encode(&key()));
    let mut deliver = |packet: &[u8]| {
        client.send(packet);
        device.exchange(&Command::default(), DT)
    };
    assert!(deliver(&first).is_fresh());
    let sample = deliver(&second);
    // Sent again, out of order, changed, cut, sealed by another, of a session long ago.
    let mut changed = second;
    changed[40] ^= 1;
    let stranger = Motion { session: 1, sequence: 1_000, ..Motion::default() };
    let long_ago = Motion { session: 77, sequence: 1_000, ..Motion::default() };
    let packets: [(&[u8], Refused); 7] = [
        (&second, Refused::Sequence),
        (&first, Refused::Sequence),
        (&changed, Refused::Seal),
        (&second[..100], Refused::Size),
        (&[0; 400], Refused::Size),
        (&stranger.encode(&Key::new([0x12; 32])), Refused::Seal),
        (&long_ago.encode(&key()), Refused::Session),
    ];
    for (packet, why) in packets {
        let before = monitor.refused(why);
        assert_eq!(deliver(packet).tip_in_world, sample.tip_in_world);
        assert_eq!(monitor.refused(why), before + 1, "{why:?}");
    }
    assert_eq!(monitor.accepted(), 2);
    assert!(!deliver(&[]).is_fresh(), "and nothing of it keeps the force alive");
}

#[test]
fn a_device_that_is_started_anew_is_taken_at_once_and_a_repeated_question_ends_no_session() {
    let (mut device, mut client) = open();
    let monitor = device.monitor();
    client.greet(&mut device);
    client.sequence = 100_000;
    let hello = Motion { session: 0, ..client.motion(0.0) };
    let motion = client.motion(0.0);
    client.send(&motion.encode(&key()));
    assert!(device.exchange(&Command::default(), DT).is_fresh());
    client.receive();
    // A recorded question is sent again: it is answered, and changes nothing.
    client.send(&hello.encode(&key()));
    client.send(&client_motion_after(&motion).encode(&key()));
    assert!(device.exchange(&Command::default(), DT).is_fresh());
    assert_eq!((monitor.accepted(), monitor.refused(Refused::Session)), (2, 0));
    // The device's program is restarted and counts from one.
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("a free port");
    socket.connect(monitor.address()).expect("loopback");
    socket.set_read_timeout(Some(Duration::from_secs(10))).expect("a time-out");
    let mut anew = Client { socket, session: 0, sequence: 0 };
    anew.greet(&mut device);
    assert_ne!(anew.session, client.session);
    let motion = anew.motion(0.002);
    anew.send(&motion.encode(&key()));
    assert_eq!(device.exchange(&Command::default(), DT).tip_in_world, motion.tip_in_world);
    assert_eq!((monitor.accepted(), monitor.refused(Refused::Sequence)), (3, 0));
}

fn client_motion_after(motion: &Motion) -> Motion {
    Motion { sequence: motion.sequence + 1, ..*motion }
}

#[test]
fn a_flood_costs_a_tick_no_more_than_its_share() {
    let (mut device, mut client) = open();
    let monitor = device.monitor();
    client.greet(&mut device);
    for _ in 0..100 {
        client.send(&[0; MOTION_BYTES]);
    }
    let mut ticks = 0;
    while monitor.refused(Refused::Magic) < 100 {
        let before = monitor.refused(Refused::Magic);
        device.exchange(&Command::default(), DT);
        assert!(monitor.refused(Refused::Magic) - before <= PACKETS_A_TICK as u64);
        ticks += 1;
        assert!(ticks < 1_000_000, "the flood is read to its end");
    }
    let motion = client.motion(0.0).encode(&key());
    client.send(&motion);
    assert!(device.exchange(&Command::default(), DT).is_fresh(), "and the device still works");
}

#[test]
fn goodbye_is_stale_at_once_and_a_taken_port_is_said() {
    let (mut device, mut client) = open();
    client.greet(&mut device);
    let motion = client.motion(0.0);
    client.send(&motion.encode(&key()));
    let pushing = Command { force_n: [Vec2::new(0.0, 1.0); 2] };
    assert!(device.exchange(&pushing, DT).is_fresh());
    let pushed = client.receive();
    assert_eq!(pushed.force_n, pushing.force_n);
    let bye = Motion { flags: FLAG_BYE, ..client.motion(0.0) };
    client.send(&bye.encode(&key()));
    assert!(!device.exchange(&pushing, DT).is_fresh());
    // One more packet, with zero force, whatever the world says; then none.
    let last = client.receive();
    assert_eq!((last.force_n, last.echo_us), ([Vec2::zeros(); 2], bye.time_us));
    assert!(last.sequence > pushed.sequence);
    device.exchange(&pushing, DT);
    client.socket.set_nonblocking(true).expect("a socket can do without waiting");
    assert!(client.socket.recv(&mut [0; 200]).is_err(), "who has gone gets no more packets");
    let config = UdpConfig { listen: device.monitor().address(), ..UdpConfig::loopback(key()) };
    let error = UdpDevice::open(config, [Vec2::zeros(); 2]).expect_err("the port is taken").to_string();
    assert!(error.contains("could not be opened"), "{error}");
}

#[test]
fn a_stated_round_trip_makes_the_coupling_softer() {
    let felt = |delay_s: f64| {
        let listen = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
        let mut config = UdpConfig { listen, delay_s, ..UdpConfig::loopback(key()) };
        config.spec.damping_n_s_m = 2.0;
        let device = UdpDevice::open(config, [Vec2::zeros(); 2]).expect("a free port");
        let coupling = crate::servo::coupling::Coupling::needed(device.spec(), &presets::table(), DT, device.delay_s());
        coupling.expect("2 N s/m is too little for the pads").stiffness_n_m
    };
    assert!((felt(0.0) - 3200.0).abs() < 1e-6, "0.8 b / (T/2): {}", felt(0.0));
    assert!((felt(0.0095) - 160.0).abs() < 1e-6, "0.8 b / (T/2 + 9.5 ms): {}", felt(0.0095));
}
