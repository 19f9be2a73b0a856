//! The servo's tick allocates nothing: every built-in world, every device, a swap, and copying the state out.

use assert_no_alloc::{AllocDisabler, assert_no_alloc};
use haptics::Vec2;
use haptics::device::channel::{ChannelConfig, ChannelDevice, Waves};
use haptics::device::gamepad::{self, GamepadMode, PadState, gamepad};
use haptics::device::haply::{Board, BoardModel, HaplyHand, Placement};
use haptics::device::udp::{Force, Key, Motion, UdpConfig, UdpDevice, WaveDown, WaveUp};
use haptics::device::{
    Command, Device, DeviceSpec, KeysHeld, Mistake, MouseTarget, ReplayDevice, Sample, ScriptedOperator, Skill,
    keyboard, mouse, touch,
};
use haptics::law::contact::{FingertipSlip, VelocityLoss};
use haptics::law::{CATALOGUE, Effect};
use haptics::servo::rate::{RateReport, Watch};
use haptics::servo::safety::Limits;
use haptics::servo::timing::{TickTiming, TimingCollector};
use haptics::servo::{Loop, Swap};
use haptics::teleop::{self, Delay, Ends};
use haptics::world::{State, Wall, World, presets};
use std::io::{Read, Write};
use std::time::Duration;

#[global_allocator]
static GUARD: AllocDisabler = AllocDisabler;

const DT: f64 = 1e-3;

fn servo(world: &World, device: Box<dyn Device>) -> Loop {
    let state = State::resting(world);
    Loop::new(Swap::at(world.clone(), state), device, Limits::default())
}

/// Ticks under the guard; an allocation aborts the test.
fn run(servo: &mut Loop, ticks: usize) {
    let mut newest = servo.state().clone();
    assert_no_alloc(|| {
        for _ in 0..ticks {
            servo.tick(DT);
            newest.copy_from(servo.state());
        }
    });
    assert!(servo.state().tick as usize >= ticks);
}

#[test]
fn scripted_operator_in_every_world() {
    for world in presets::all() {
        let operator = ScriptedOperator::new(&world, &State::resting(&world), Skill::default(), 3);
        run(&mut servo(&world, Box::new(operator)), 20_000);
    }
}

#[test]
fn every_law_of_the_catalogue_and_of_contacts() {
    for &law in CATALOGUE {
        let mut world = presets::crank();
        let crank = world.crank.as_mut().expect("there is one");
        crank.constraint_stiffness_n_m = Some(5000.0);
        // Every parameter at something that acts.
        let values = vec![0.05; law.parameters().len()];
        crank.effects.push(Effect::new(law, &values));
        world.check().expect("a world with one law more");
        let operator = ScriptedOperator::new(&world, &State::resting(&world), Skill::default(), 3);
        run(&mut servo(&world, Box::new(operator)), 8_000);
    }
    let mut world = presets::stacking();
    (world.pad.cubic_n_m3, world.pad.hertz_n_m15) = (1e9, 1e4);
    world.pad.slip = Some(FingertipSlip { way_m: Vec2::new(0.0, 1e-3), t0_s: 5.0, duration_s: 1.0 });
    world.floor.as_mut().expect("there is one").loss = Some(VelocityLoss { e: 0.3, mu: 0.4 });
    world.blocks[0].wall = Some(Wall { stiffness_n_m: 4000.0, strength_n: Some(3.0) });
    let operator = ScriptedOperator::new(&world, &State::resting(&world), Skill::default(), 3);
    run(&mut servo(&world, Box::new(operator)), 20_000);
}

#[test]
fn operators_that_drop_blocks_and_fetch_them_again() {
    let world = presets::stacking();
    for mistake in [Mistake::WeakPinch, Mistake::EarlyRelease] {
        let state = State::resting(&world);
        let operator = ScriptedOperator::with_mistakes(&world, &state, Skill::novice(), &[mistake], 3);
        let planned = operator.duration_s();
        let mut servo = servo(&world, Box::new(operator));
        run(&mut servo, (planned / DT) as usize + 1_000);
        assert!(!servo.finished(), "the second attempt made the performance longer than {planned} s");
        run(&mut servo, 60_000);
        assert!(servo.finished());
    }
}

#[test]
fn mouse_and_replay() {
    let world = presets::stacking();
    let start = MouseTarget { center_in_world: world.hand.workspace.center_m, aperture_m: 0.03 };
    let (mut handle, device) = mouse(start, world.hand.workspace);
    handle.set(MouseTarget { aperture_m: 0.01, ..start });
    run(&mut servo(&world, Box::new(device)), 3_000);

    let tips = || vec![world.hand.workspace.center_m; 3];
    let replay = ReplayDevice::new("test", vec![0.0, 0.5, 1.0], [tips(), tips()], [tips(), tips()])
        .expect("three samples of two fingers");
    run(&mut servo(&world, Box::new(replay)), 2_000);
}

/// A block 5 mm above the table.
fn falling() -> World {
    let mut world = presets::stacking();
    world.blocks[0].start.center_m.y += 0.005;
    world
}

#[test]
fn touch_screen_gamepad_and_keyboard() {
    let world = presets::stacking();
    let tips = State::resting(&world).input.tip_in_world;
    let (mut handle, device) = touch(tips, world.hand.workspace);
    let mut servo_touch = servo(&world, Box::new(device));
    handle.begin(1, tips[0]);
    handle.begin(2, tips[1]);
    run(&mut servo_touch, 500);
    handle.end(2);
    run(&mut servo_touch, 500);

    for mode in [GamepadMode::Hand, GamepadMode::Tips] {
        let (mut handle, device) = gamepad(tips, world.hand.workspace, mode);
        let sticks = [Vec2::new(0.5, -1.0); 2];
        handle.set(PadState { sticks, triggers: [0.0, 1.0], connected: true, number: 1 });
        let mut servo = servo(&world, Box::new(device));
        run(&mut servo, 500);
        // A block that falls onto the other one strikes: the pad knocks.
        let mut next = Some(Swap::new(falling()));
        let (mut old, mut struck) = (None, false);
        assert_no_alloc(|| {
            old = next.take().map(|next| servo.swap(next));
            (0..300).for_each(|_| struck |= servo.tick(DT).impact_m_s > 0.0);
        });
        assert!(struck && handle.rumble() == gamepad::Rumble::default(), "told, and over");
        drop(old);
    }

    let (mut handle, device) = keyboard(tips, world.hand.workspace);
    handle.set(KeysHeld { down: true, close: true, ..KeysHeld::default() });
    run(&mut servo(&world, Box::new(device)), 2_000);
}

#[test]
fn a_remote_device() {
    let world = presets::table();
    let tips = State::resting(&world).input.tip_in_world;
    let key = Key::new([9; 32]);
    let listen = (std::net::Ipv4Addr::LOCALHOST, 0).into();
    let device = UdpDevice::open(UdpConfig { listen, ..UdpConfig::loopback(key.clone()) }, tips).expect("a free port");
    let (monitor, client) = (device.monitor(), std::net::UdpSocket::bind("127.0.0.1:0").expect("a free port"));
    let mut servo = servo(&world, Box::new(device));
    let mut motion = Motion { tip_in_world: tips, ..Motion::default() };
    let mut buffer = [0; 256];
    client.send_to(&motion.encode(&key), monitor.address()).expect("loopback");
    run(&mut servo, 5);
    let size = client.recv(&mut buffer).expect("a greeting");
    motion.session = Force::decode(&buffer[..size], &key).expect("sealed").session;
    for sequence in 1..200 {
        motion.sequence = sequence;
        client.send_to(&motion.encode(&key), monitor.address()).expect("loopback");
        client.send_to(&[1; 50], monitor.address()).expect("loopback");
        run(&mut servo, 1);
    }
    assert!(monitor.accepted() > 100);
}

#[test]
fn a_remote_device_that_speaks_in_waves() {
    let world = presets::table();
    let tips = State::resting(&world).input.tip_in_world;
    let key = Key::new([9; 32]);
    let listen = (std::net::Ipv4Addr::LOCALHOST, 0).into();
    let waves = Some(Waves::new(&UdpConfig::unstated(), &world, DT));
    let config = UdpConfig { listen, waves, ..UdpConfig::loopback(key.clone()) };
    let device = UdpDevice::open(config, tips).expect("a free port");
    let (monitor, client) = (device.monitor(), std::net::UdpSocket::bind("127.0.0.1:0").expect("a free port"));
    let mut servo = servo(&world, Box::new(device));
    let mut up = WaveUp { origin_in_world: tips, ..WaveUp::default() };
    let mut buffer = [0; 256];
    client.send_to(&up.encode(&key), monitor.address()).expect("loopback");
    run(&mut servo, 5);
    let size = client.recv(&mut buffer).expect("a greeting");
    up.session = WaveDown::decode(&buffer[..size], &key).expect("sealed").session;
    for sequence in 1..200_u32 {
        up.sequence = u64::from(sequence);
        up.accounts[0].integral.x = 1e-3 * f64::from(sequence);
        up.accounts[0].energy_j = 1e-3 * f64::from(sequence);
        client.send_to(&up.encode(&key), monitor.address()).expect("loopback");
        run(&mut servo, 1);
    }
    assert!(monitor.accepted() > 100);
}

#[test]
fn a_device_behind_a_slow_network() {
    for world in [presets::stacking(), presets::crank()] {
        for with_waves in [false, true] {
            let operator = ScriptedOperator::new(&world, &State::resting(&world), Skill::expert(), 3);
            let waves = with_waves.then(|| Waves::new(operator.spec(), &world, DT));
            let config = ChannelConfig { delay_s: 0.25, jitter_s: 0.05, loss: 0.1, seed: 1, waves };
            let device = ChannelDevice::new(Box::new(operator), config).expect("a possible network");
            run(&mut servo(&world, Box::new(device)), 10_000);
        }
    }
}

#[test]
fn an_operator_over_a_slow_line_with_and_without_a_model() {
    for world in presets::all() {
        for predicted in [false, true] {
            let state = State::resting(&world);
            let operator = ScriptedOperator::new(&world, &state, Skill::expert(), 3).waiting();
            let delay = Delay { jitter_s: 0.02, loss: 0.1, ..Delay::of(0.15, predicted) };
            let guess = teleop::guess(&world, 3);
            let limits = Limits { max_force_n: 12.0, ..Limits::default() };
            let ends = Ends { world: &world, state: &state, guess: Some(&guess), limits, period_s: DT, seed: 1 };
            let (device, mut view) = teleop::connect(Box::new(operator), &ends, &delay).expect("a possible line");
            let mut servo = servo(&world, device);
            run(&mut servo, 15_000);
            assert_no_alloc(|| servo.interrupted());
            assert!(view.newest().age_s < 0.3, "pictures come: {} s", view.newest().age_s);
        }
    }
}

#[test]
fn a_larger_world_is_swapped_in() {
    let small = presets::table();
    let mut large = presets::stacking();
    for number in 3..40_u32 {
        let mut block = large.blocks[1].clone();
        block.name = format!("block-{number}");
        block.start.center_m.x += 0.03 * f64::from(number);
        large.blocks.push(block);
    }
    let operator = ScriptedOperator::new(&small, &State::resting(&small), Skill::default(), 1);
    let mut servo = servo(&small, Box::new(operator));
    run(&mut servo, 100);
    let mut next = Some(Swap::new(large));
    let mut newest = servo.state().clone();
    let mut old = None;
    assert_no_alloc(|| {
        if let Some(next) = next.take() {
            old = Some(servo.swap(next));
        }
        for _ in 0..500 {
            servo.tick(DT);
            newest.copy_from(servo.state());
        }
    });
    assert_eq!(servo.state().bodies.len(), 39);
    drop(old);
}

#[test]
fn a_world_that_goes_on_is_swapped_in_while_the_crank_turns() {
    let before = presets::crank();
    let mut after = before.clone();
    after.crank.as_mut().expect("a crank").effects.truncate(3);
    let operator = ScriptedOperator::new(&before, &State::resting(&before), Skill::default(), 3);
    let mut servo = servo(&before, Box::new(operator));
    run(&mut servo, 4_000);
    let angle_rad = servo.state().crank.angle_rad;
    let mut next = Some(Swap::going_on(after));
    let mut old = None;
    assert_no_alloc(|| {
        if let Some(next) = next.take() {
            old = Some(servo.swap(next));
        }
        servo.tick(DT);
    });
    assert!((servo.state().crank.angle_rad - angle_rad).abs() < 0.02, "it goes on where it was");
    drop(old);
}

/// Two fingers at rest on the table, on a device that needs a virtual coupling.
struct Coupled(DeviceSpec);

impl Device for Coupled {
    fn spec(&self) -> &DeviceSpec {
        &self.0
    }

    fn exchange(&mut self, _: &Command, _: f64) -> Sample {
        let tip_in_world = [Vec2::new(-0.02, -0.126), Vec2::new(0.02, -0.126)];
        Sample { tip_in_world, tip_velocity: [Vec2::zeros(); 2], fresh: [true; 2] }
    }

    fn make_safe(&mut self) {}
}

#[test]
fn the_virtual_coupling_a_swap_under_it_and_a_change_of_the_rate() {
    let spec = DeviceSpec {
        name: "coupled".to_owned(),
        force_feedback: true,
        max_force_n: 4.0,
        damping_n_s_m: 0.5,
        coulomb_n: 0.0,
        resolution_m: 0.0,
    };
    let mut servo = servo(&presets::table(), Box::new(Coupled(spec)));
    run(&mut servo, 1_000);
    assert!(servo.coupling().is_some());
    let mut next = Some(Swap::new(presets::stacking()));
    let mut old = None;
    assert_no_alloc(|| {
        old = next.take().map(|next| servo.swap(next));
        for _ in 0..500 {
            servo.tick(0.25 * DT);
        }
        // A clock that stands still, and a standstill that is noticed.
        servo.tick(0.0);
        servo.interrupted();
        servo.tick(DT);
    });
    drop(old);
}

#[test]
fn the_timing_of_a_tick_and_its_summary() {
    let mut collector = TimingCollector::default();
    let mut watch = Watch::default();
    let rate = RateReport { rate_hz: 1000.0, ..RateReport::default() };
    let timing = assert_no_alloc(|| {
        for tick in 0..5_000_u32 {
            let missed = tick.is_multiple_of(3);
            collector.add(&TickTiming { compute_s: 1e-6, interval_s: Some(DT), missed, ..TickTiming::default() });
            watch.add(missed, DT);
        }
        collector.summary(rate)
    });
    assert_eq!(timing.ticks, 5_000);
}

/// A board that answers every question with the same two angles.
struct Echo(usize);

impl Read for Echo {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        if self.0 == 0 {
            std::thread::sleep(Duration::from_millis(1));
            return Err(std::io::ErrorKind::TimedOut.into());
        }
        let mut reply = vec![BoardModel::V3.id];
        reply.extend([60.0_f32, 120.0].iter().flat_map(|angle| angle.to_le_bytes()));
        let count = buffer.len().min(self.0);
        buffer[..count].copy_from_slice(&reply[reply.len() - self.0..][..count]);
        self.0 -= count;
        Ok(count)
    }
}

impl Write for Echo {
    fn write(&mut self, frame: &[u8]) -> std::io::Result<usize> {
        self.0 = if frame.first() == Some(&2) { 9 } else { self.0 };
        Ok(frame.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn two_haply_boards() {
    let board = || Board::start(Box::new(Echo(0)), BoardModel::V3).expect("it takes its set-up");
    let place = Placement { device_m: Vec2::new(0.019, 0.12), world_m: Vec2::new(0.0, -0.1), scale: 1.0 };
    let mut servo = servo(&presets::stacking(), Box::new(HaplyHand::new([board(), board()], [place, place])));
    let begun = std::time::Instant::now();
    // The boards answer on threads of their own: until both have, the samples are old.
    let mut answered = false;
    while !answered || servo.state().tick < 500 {
        let before = servo.state().tick as usize;
        run(&mut servo, 50);
        assert_eq!(servo.state().tick as usize, before + 50);
        answered |= servo.sample_age_s() < 0.05;
        assert!(begun.elapsed() < Duration::from_secs(20), "no board answered");
    }
}
