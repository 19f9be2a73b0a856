//! Worlds are swapped under loaded fingers: the force never jumps by more than the slew limit allows, and comes up softly when the
//! new world presses much harder.

use haptics::Vec2;
use haptics::device::{Command, Device, DeviceSpec, MouseTarget, Sample, mouse};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Servo, ServoConfig, Swap, TickRecord};
use haptics::world::{State, World, presets};
use std::time::{Duration, Instant};

const DT: f64 = 1e-3;

/// Two fingers that stay where they are, whatever pushes.
struct Rigid(DeviceSpec, [Vec2; 2]);

impl Device for Rigid {
    fn spec(&self) -> &DeviceSpec {
        &self.0
    }

    fn exchange(&mut self, _: &Command, _: f64) -> Sample {
        Sample { tip_in_world: self.1, tip_velocity: [Vec2::zeros(); 2], fresh: [true; 2] }
    }

    fn make_safe(&mut self) {}
}

fn rigid(force_feedback: bool, at: [Vec2; 2]) -> Box<dyn Device> {
    let spec = DeviceSpec {
        name: "rigid".to_owned(),
        force_feedback,
        max_force_n: 8.0,
        damping_n_s_m: 1.0,
        coulomb_n: 0.0,
        resolution_m: 0.0,
    };
    Box::new(Rigid(spec, at))
}

/// A table under fingertips of a stiffness.
fn table(stiffness_n_m: f64) -> World {
    let mut world = presets::table();
    world.pad.stiffness_n_m = stiffness_n_m;
    world
}

/// Two blocks, the first one around a point.
fn block_around(point_in_world: Vec2) -> World {
    let mut world = presets::stacking();
    world.blocks[0].start.center_m = point_in_world + Vec2::new(0.004, 0.001);
    world
}

/// Fingers 1.2 mm deep in the table, 40 mm apart.
fn leaning() -> [Vec2; 2] {
    let table_m = presets::table().floor.expect("a table").height_m;
    [Vec2::new(-0.02, table_m - 0.0012), Vec2::new(0.02, table_m - 0.0012)]
}

/// Soft, stiff, a block around a finger, a crank, blocks: everything that may be put under a hand.
fn tour(at: Vec2) -> Vec<World> {
    vec![
        table(400.0),
        table(2500.0),
        table(400.0),
        block_around(at),
        presets::crank(),
        presets::stacking(),
        table(2500.0),
    ]
}

fn largest_jump(ticks: &[TickRecord]) -> f64 {
    let jump =
        |w: &[TickRecord]| (0..2).map(|f| (w[1].sent_force_n[f] - w[0].sent_force_n[f]).norm()).fold(0.0, f64::max);
    ticks.windows(2).map(jump).fold(0.0, f64::max)
}

#[test]
fn no_swap_jumps_above_the_slew_limit_in_the_loop() {
    let limits = Limits::default();
    for force_feedback in [false, true] {
        let at = leaning();
        let mut body = Loop::new(Swap::new(table(2500.0)), rigid(force_feedback, at), limits);
        let mut ticks: Vec<TickRecord> = (0..800).map(|_| body.tick(DT)).collect();
        assert!(ticks[799].sent_force_n[0].norm() > 1.0, "loaded");
        for world in tour(at[0]) {
            body.swap(Swap::new(world));
            ticks.extend((0..800).map(|_| body.tick(DT)));
        }
        let jump = largest_jump(&ticks);
        assert!(jump <= limits.max_slew_n_s * DT + 1e-12, "a jump of {jump} N");
        assert!(ticks.iter().all(|t| t.sent_force_n.iter().all(|f| f.norm() <= limits.max_force_n + 1e-9)));
        assert!(ticks.last().is_some_and(|t| t.sent_force_n[0].norm() > 1.0), "loaded again in the end");
    }
}

#[test]
fn from_soft_to_stiff_the_force_comes_up_with_the_ramp_and_back_it_fades() {
    let limits = Limits::default();
    let mut body = Loop::new(Swap::new(table(400.0)), rigid(false, leaning()), limits);
    let run = |body: &mut Loop| -> Vec<TickRecord> { (0..1_000).map(|_| body.tick(DT)).collect() };
    let soft = run(&mut body)[999].sent_force_n[0].y;
    body.swap(Swap::new(table(2500.0)));
    let up = run(&mut body);
    let stiff = up[999].sent_force_n[0].y;
    assert!(stiff > soft + 2.0, "{soft} N, then {stiff} N");
    // The ramp of half a second is a thousand times gentler than the slew limit; the fade adds a little of the old force.
    let gentle = stiff * DT / limits.ramp_s + soft * DT / 0.05;
    assert!(largest_jump(&up) < 1.1 * gentle, "{} N a tick, {gentle} N would be gentle", largest_jump(&up));
    body.swap(Swap::new(table(400.0)));
    let down = run(&mut body);
    assert!(largest_jump(&down) < 1.1 * (stiff - soft) * DT / 0.05, "{} N a tick", largest_jump(&down));
    // Upwards: the jump into the table at the start left a pull along it, which a new world does not know.
    let after = down[100].sent_force_n[0].y;
    assert!((after - soft).abs() < 0.02, "soft again after a tenth of a second: {soft} N, {after} N");
}

#[test]
fn no_swap_jumps_above_the_slew_limit_on_the_thread() {
    let world = table(2500.0);
    let state = State::resting(&world);
    let at = leaning();
    let start = MouseTarget { center_in_world: 0.5 * (at[0] + at[1]) - Vec2::new(0.0, 0.004), aperture_m: 0.04 };
    let (mut handle, device) = mouse(start, world.hand.workspace);
    handle.set(start);
    let config = ServoConfig::at(1000.0);
    let mut servo = Servo::start(Box::new(Swap { world, state }), Box::new(device), config).expect("a thread");
    let mut ticks = Vec::new();
    let mut wait_for_ticks = |servo: &mut Servo, more: usize| {
        let (goal, begun) = (ticks.len() + more, Instant::now());
        while ticks.len() < goal && begun.elapsed() < Duration::from_secs(20) {
            servo.drain(&mut ticks);
            std::thread::yield_now();
        }
        assert!(ticks.len() >= goal, "the servo ticks");
        ticks.len()
    };
    wait_for_ticks(&mut servo, 700);
    for (number, world) in tour(at[0]).into_iter().chain(tour(at[1])).enumerate() {
        assert!(servo.swap(Swap::new(world)).is_ok());
        wait_for_ticks(&mut servo, 150);
        assert_eq!(servo.newest().generation, number as u64 + 1);
    }
    // A tick that was interrupted by the machine goes to zero at once, which is no jump of a world.
    let pairs: Vec<[TickRecord; 2]> = ticks.windows(2).map(|w| [w[0], w[1]]).filter(|w| !w[1].flags.stale).collect();
    let worst = pairs.iter().map(|w| largest_jump(w)).fold(0.0, f64::max);
    assert!(worst <= config.limits.max_slew_n_s * DT + 1e-12, "a jump of {worst} N");
    assert!(ticks.iter().any(|t| t.sent_force_n[0].norm() > 0.5), "there was a load");
}
