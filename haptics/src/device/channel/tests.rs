//! Delay makes contact unstable, waves keep it stable, and the energy says so.

use super::*;
use crate::Vec2;
use crate::device::{HandImpedance, MouseTarget, ScriptedOperator, Skill, mouse};
use crate::servo::safety::Limits;
use crate::servo::{Loop, Swap};
use crate::world::presets;
use std::sync::{Arc, Mutex};

const DT: f64 = 1e-3;

/// Figures observed at the far end.
#[derive(Default)]
struct Seen {
    /// Energy that the operator has put into the line so far, J, at its lowest.
    least_j: f64,
    energy_j: f64,
    x_m: Vec<f64>,
}

/// A passive operator: a hand on its spring and damper that wants to be somewhere, first moving along x for a while.
struct Operator {
    spec: DeviceSpec,
    goal: Box<dyn Fn(f64) -> f64 + Send>,
    position: [Vec2; 2],
    velocity: [Vec2; 2],
    now_s: f64,
    seen: Arc<Mutex<Seen>>,
}

impl Device for Operator {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, command: &Command, dt_s: f64) -> Sample {
        self.now_s += dt_s;
        let wanted = (Vec2::new((self.goal)(self.now_s), 0.0), Vec2::zeros());
        let mut seen = self.seen.lock().expect("one thread");
        for finger in 0..2 {
            let before = self.position[finger];
            let force = command.force_n[finger];
            let (position, velocity) = (&mut self.position[finger], &mut self.velocity[finger]);
            HandImpedance::default().advance(position, velocity, wanted, force, dt_s);
            seen.energy_j -= force.dot(&(*position - before));
        }
        seen.least_j = seen.least_j.min(seen.energy_j);
        seen.x_m.push(self.position[0].x);
        Sample { tip_in_world: self.position, tip_velocity: self.velocity, fresh: [true; 2] }
    }

    fn make_safe(&mut self) {}
}

fn operator(goal: impl Fn(f64) -> f64 + Send + 'static) -> (Box<Operator>, Arc<Mutex<Seen>>) {
    let seen = Arc::new(Mutex::new(Seen::default()));
    let spec = DeviceSpec {
        name: "Passive operator".to_owned(),
        force_feedback: true,
        max_force_n: 4.0,
        damping_n_s_m: HandImpedance::default().damping_n_s_m,
        coulomb_n: 0.0,
        resolution_m: 0.0,
    };
    let (position, velocity) = ([Vec2::zeros(); 2], [Vec2::zeros(); 2]);
    (Box::new(Operator { spec, goal: Box::new(goal), position, velocity, now_s: 0.0, seen: Arc::clone(&seen) }), seen)
}

/// A wall 1 mm away, K N/m; `sticky`: it also pulls, as a held object does.
fn wall(x_m: f64, stiffness: f64, sticky: bool) -> f64 {
    let depth = x_m - 0.001;
    if sticky || depth > 0.0 { -stiffness * depth } else { 0.0 }
}

const STIFFNESS: f64 = 2_000.0;

/// Half a second of round trip.
fn half_a_second(waves: bool) -> ChannelConfig {
    let waves = waves.then(|| {
        let (device, _) = operator(|_| 0.0);
        Waves::new(&device.spec, &presets::table(), DT)
    });
    ChannelConfig { delay_s: 0.25, waves, ..ChannelConfig::default() }
}

/// Runs the operator against the wall; returns the world's tip, m, over time.
fn run(device: &mut ChannelDevice, seconds: f64, sticky: bool) -> Vec<f64> {
    let mut command = Command::default();
    let mut tips = Vec::new();
    for _ in 0..(seconds / DT) as usize {
        let sample = device.exchange(&command, DT);
        command.force_n = sample.tip_in_world.map(|tip| Vec2::new(wall(tip.x, STIFFNESS, sticky), 0.0));
        tips.push(sample.tip_in_world[0].x);
    }
    tips
}

fn spread(series: &[f64]) -> f64 {
    let (low, high) = series.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
    high - low
}

#[test]
fn plain_delay_swings_and_grows_while_waves_come_to_rest() {
    let press = |t: f64| if t > 0.5 { 0.004 } else { 0.0 };
    for sticky in [false, true] {
        // A wall that pulls is drawn by 1 mm at the start.
        let stored = if sticky { 0.5 * STIFFNESS * 0.001_f64.powi(2) } else { 0.0 };
        let (device, seen) = operator(press);
        let mut plain = ChannelDevice::new(device, half_a_second(false)).expect("possible");
        run(&mut plain, 20.0, sticky);
        let seen = seen.lock().expect("one thread");
        let late = spread(&seen.x_m[15_000..]);
        if sticky {
            let early = spread(&seen.x_m[..3_000]);
            assert!(late > 1e3 * early, "it grows: {early} m, then {late} m");
        } else {
            assert!(late > 5e-3, "it never comes to rest: {late} m");
        }
        assert!(seen.least_j < -stored - 1e-3, "and gives energy out: {} J", seen.least_j);
        drop(seen);

        let (device, seen) = operator(press);
        let mut waves = ChannelDevice::new(device, half_a_second(true)).expect("possible");
        let tips = run(&mut waves, 30.0, sticky);
        let seen = seen.lock().expect("one thread");
        assert!(spread(&seen.x_m[25_000..]) < 5e-5, "the hand rests: {} m", spread(&seen.x_m[25_000..]));
        assert!(spread(&tips[25_000..]) < 5e-5, "the tip rests");
        assert!(seen.least_j > -stored - 1e-6, "no energy is given out: {} J", seen.least_j);
        // Balance of arm, line and wall: three springs in series, 400 N/m from 4 mm, b/d, 2000 N/m from 1 mm. The
        // receivers' smoothing and the tick add to the delay.
        let line = half_a_second(true).waves.expect("waves").line_stiffness_n_m(0.25 + SMOOTHING_S + DT);
        let force = 0.003 / (1.0 / 400.0 + 1.0 / line + 1.0 / STIFFNESS);
        let felt = 400.0 * (0.004 - seen.x_m[29_999]);
        assert!((felt / force - 1.0).abs() < 0.02, "the hand feels {felt} N, should be {force} N");
        let pressed = STIFFNESS * (tips[29_999] - 0.001);
        assert!((pressed / felt - 1.0).abs() < 0.02, "and the wall {pressed} N");
    }
}

#[test]
fn waves_stay_passive_and_do_not_drift_when_packets_are_late_and_lost() {
    for (seed, (jitter_s, loss)) in [(0.02, 0.0), (0.0, 0.3), (0.05, 0.5)].into_iter().enumerate() {
        // Moves back and forth, into the wall and out, for 20 s; then rests in the air.
        let wander = |t: f64| if t < 20.0 { 0.006 * (1.3 * t).sin() + 0.003 * (4.1 * t).sin() } else { -0.003 };
        let (device, seen) = operator(wander);
        let config = ChannelConfig { jitter_s, loss, seed: seed as u64, ..half_a_second(true) };
        let mut channel = ChannelDevice::new(device, config).expect("possible");
        let tips = run(&mut channel, 40.0, false);
        let seen = seen.lock().expect("one thread");
        assert!(seen.least_j > -1e-6, "jitter {jitter_s}, loss {loss}: {} J", seen.least_j);
        assert!(spread(&seen.x_m[35_000..]) < 1e-4, "at rest");
        assert!((seen.x_m[39_999] + 0.003).abs() < 1e-4, "the hand is where it wants to be");
        let apart = (tips[39_999] - seen.x_m[39_999]).abs();
        assert!(apart < 3e-4, "jitter {jitter_s}, loss {loss}: the ends are {apart} m apart");
    }
}

/// Two fingers that move to the left at 0.2 m/s for half a second, are not seen any more, and the forces on them
/// meanwhile.
struct Lost(DeviceSpec, u32, Arc<Mutex<Vec<f64>>>);

impl Device for Lost {
    fn spec(&self) -> &DeviceSpec {
        &self.0
    }

    fn exchange(&mut self, command: &Command, _: f64) -> Sample {
        self.1 += 1;
        self.2.lock().expect("one thread").push(command.force_n[0].x);
        let tip = Vec2::new(-2e-4 * f64::from(self.1.min(500)), 0.0);
        Sample { tip_in_world: [tip; 2], fresh: [self.1 <= 500; 2], ..Sample::default() }
    }

    fn make_safe(&mut self) {}
}

#[test]
fn a_device_that_is_lost_in_the_middle_of_a_motion_is_not_pushed_any_more() {
    let felt = Arc::new(Mutex::new(Vec::new()));
    let device = Lost(operator(|_| 0.0).0.spec, 0, Arc::clone(&felt));
    let mut channel = ChannelDevice::new(Box::new(device), half_a_second(true)).expect("possible");
    let tips = run(&mut channel, 3.0, false);
    let felt = felt.lock().expect("one thread");
    assert!(felt[400].abs() > 0.5, "the line damps a motion: {} N", felt[400]);
    assert!(felt[2_500..].iter().all(|force| force.abs() < 1e-6), "{} N are left", felt[2_999]);
    assert!(spread(&tips[2_500..]) < 1e-6 && !channel.sample.is_fresh());
}

#[test]
fn a_force_that_is_held_does_not_bleed_away_when_packets_are_lost() {
    for loss in [0.3, 0.5] {
        let (device, seen) = operator(|t| if t > 0.5 { 0.004 } else { 0.0 });
        let config = ChannelConfig { loss, seed: 3, ..half_a_second(true) };
        let mut channel = ChannelDevice::new(device, config).expect("possible");
        run(&mut channel, 60.0, false);
        let seen = seen.lock().expect("one thread");
        let felt = |tick: usize| 400.0 * (0.004 - seen.x_m[tick]);
        // 0.096 N without loss: 36 N/m of line.
        assert!(felt(59_999) > 0.07, "loss {loss}: {} N are left", felt(59_999));
        assert!((felt(59_999) / felt(30_000) - 1.0).abs() < 0.05, "{} N, then {} N", felt(30_000), felt(59_999));
        assert!(seen.least_j > -1e-6, "{} J", seen.least_j);
    }
}

#[test]
fn an_impact_is_told_after_the_delay_one_way() {
    /// Writes down when it is told of an impact.
    struct Told(DeviceSpec, usize, Arc<Mutex<Vec<(usize, f64)>>>);
    impl Device for Told {
        fn spec(&self) -> &DeviceSpec {
            &self.0
        }
        fn exchange(&mut self, _: &Command, _: f64) -> Sample {
            self.1 += 1;
            Sample::default()
        }
        fn strike(&mut self, speed_m_s: f64) {
            self.2.lock().expect("one thread").push((self.1, speed_m_s));
        }
        fn make_safe(&mut self) {}
    }
    let told = Arc::new(Mutex::new(Vec::new()));
    let device = Told(operator(|_| 0.0).0.spec, 0, Arc::clone(&told));
    let config = ChannelConfig { delay_s: 0.02, ..ChannelConfig::default() };
    let mut channel = ChannelDevice::new(Box::new(device), config).expect("possible");
    for tick in 0..100 {
        channel.exchange(&Command::default(), DT);
        if tick == 9 {
            channel.strike(0.3);
        }
    }
    assert_eq!(*told.lock().expect("one thread"), [(29, 0.3)], "struck after the tenth tick, told in the thirtieth");
}

#[test]
fn a_line_that_breaks_ends_at_rest_without_force() {
    let (device, seen) = operator(|_| 0.004);
    let mut channel = ChannelDevice::new(device, half_a_second(true)).expect("possible");
    run(&mut channel, 10.0, false);
    channel.config.loss = 1.0;
    channel.down = Line::new(0.25, 0.0, 1.0, 0);
    channel.up = Line::new(0.25, 0.0, 1.0, 0);
    let tips = run(&mut channel, 10.0, false);
    assert!(!channel.sample.is_fresh(), "and says that it is stale");
    assert!(spread(&tips[5_000..]) < 1e-5, "the tip in the world rests");
    let seen = seen.lock().expect("one thread");
    assert!((seen.x_m[19_999] - 0.004).abs() < 1e-4, "no force is left on the hand");
    assert!(seen.least_j > -1e-6);
}

#[test]
fn without_delay_jitter_and_loss_nothing_changes_to_the_bit() {
    let world = presets::stacking();
    let state = State::resting(&world);
    let operator = || Box::new(ScriptedOperator::new(&world, &state, Skill::default(), 2));
    let mut direct: Box<dyn Device> = operator();
    let mut channel = ChannelDevice::new(operator(), ChannelConfig::default()).expect("possible");
    for tick in 0..5_000 {
        let command = Command { force_n: [Vec2::new(0.1, -0.2) * f64::from(tick % 10); 2] };
        assert_eq!(direct.exchange(&command, DT), channel.exchange(&command, DT));
    }
    assert_eq!(direct.spec().damping_n_s_m, channel.spec().damping_n_s_m);
}

#[test]
fn a_block_is_held_over_half_a_second() {
    let world = presets::stacking();
    let state = State::resting(&world);
    let block = state.bodies[0].center_m;
    let tips = state.input.tip_in_world;
    let start = MouseTarget { center_in_world: 0.5 * (tips[0] + tips[1]), aperture_m: tips[1].x - tips[0].x };
    let (mut handle, device) = mouse(start, world.hand.workspace);
    let waves = Some(Waves::new(device.spec(), &world, DT));
    let channel =
        ChannelDevice::new(Box::new(device), ChannelConfig { waves, ..half_a_second(false) }).expect("possible");
    let mut servo = Loop::new(Swap::at(world, state), Box::new(channel), Limits::default());
    let mut run = |target: MouseTarget, seconds: f64| {
        handle.set(target);
        (0..(seconds / DT) as usize).map(|_| servo.tick(DT)).collect::<Vec<_>>()
    };
    run(MouseTarget { center_in_world: block + Vec2::new(0.0, 0.02), aperture_m: 0.026 }, 5.0);
    run(MouseTarget { center_in_world: block, aperture_m: 0.026 }, 5.0);
    // Half a second makes a soft line, so the fingers must aim far inside the block to squeeze it. (A lifted block
    // would turn out of the fingers: 36 N/m across the pinch do not keep them opposite each other.)
    let held = run(MouseTarget { center_in_world: block, aperture_m: -0.024 }, 40.0);
    let late = &held[32_000..];
    assert!(late.iter().all(|tick| tick.label == "hold-on-ground"), "{}", late[0].label);
    let forces: Vec<f64> = late.iter().map(|tick| tick.tip_force_n[0].x).collect();
    assert!(spread(&forces) < 0.05 && forces[0] > 0.5, "{} N, within {} N", forces[0], spread(&forces));
}

#[test]
fn impossible_networks_are_refused_in_words() {
    let refuse = |config: ChannelConfig| {
        let (device, _) = operator(|_| 0.0);
        ChannelDevice::new(device, config).err().map(|e| e.to_string()).unwrap_or_default()
    };
    assert!(refuse(ChannelConfig { delay_s: -1.0, ..ChannelConfig::default() }).contains("delay"));
    assert!(refuse(ChannelConfig { jitter_s: f64::NAN, ..ChannelConfig::default() }).contains("jitter"));
    assert!(refuse(ChannelConfig { loss: 1.5, ..ChannelConfig::default() }).contains("loss"));
    let waves = Some(Waves { impedance_n_s_m: 0.0, damper_n_s_m: 0.0 });
    assert!(refuse(ChannelConfig { waves, ..ChannelConfig::default() }).contains("wave impedance"));
}

#[test]
fn b_comes_from_the_device_and_the_world() {
    let (device, _) = operator(|_| 0.0);
    // Pads of the table: K = 2500 + 1500 N/m, B = 3 N s/m: K T/2 + B = 5 N s/m at 1 kHz.
    let waves = Waves::new(&device.spec, &presets::table(), DT);
    assert!((waves.damper_n_s_m - 5.0).abs() < 1e-9 && (waves.impedance_n_s_m - 9.0).abs() < 1e-12);
    let light = DeviceSpec { damping_n_s_m: 0.1, ..device.spec.clone() };
    assert!((Waves::new(&light, &presets::table(), DT).impedance_n_s_m - 5.0).abs() < 1e-9);
    let faster = Waves::new(&light, &presets::table(), DT / 4.0);
    assert!((faster.damper_n_s_m - 3.5).abs() < 1e-9);
}
