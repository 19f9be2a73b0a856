//! Worlds are swapped under loaded fingers: the force never jumps by more than the slew limit allows, and comes up softly when the
//! new world presses much harder.

use haptics::Vec2;
use haptics::device::{Command, Device, DeviceSpec, MouseTarget, Sample, ScriptedOperator, Skill, mouse};
use haptics::law::{Effect, Hysteresis, PositionRipple};
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
    let mut servo = Servo::start(Swap::at(world, state), Box::new(device), config).expect("a thread");
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

/// A crank, and the same crank with something more in its bearing.
fn cranks() -> [World; 2] {
    let before = presets::crank();
    let mut after = before.clone();
    let effects = &mut after.crank.as_mut().expect("a crank").effects;
    effects.push(Effect::new(&PositionRipple, &[0.25, 0.02, 0.0]));
    effects.push(Effect::new(&Hysteresis, &[0.2, 800.0]));
    [before, after]
}

/// Largest change from one tick to the next, N: of what the fingers do to the world, and of what is sent.
fn changes(last: &TickRecord, now: &TickRecord) -> [f64; 2] {
    let most = |a: &[Vec2; 2], b: &[Vec2; 2]| a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    [most(&last.tip_force_n, &now.tip_force_n), most(&last.sent_force_n, &now.sent_force_n)]
}

/// The crank is turned while worlds go on in each other every so many ticks. Largest changes a tick while it is held (when fingers meet
/// the handle they knock, with swaps and without), at swaps and elsewhere, and how many swaps fell on a turning crank.
fn turned(worlds: &[World; 2], every: usize) -> ([f64; 2], [f64; 2], usize) {
    let operator = ScriptedOperator::new(&worlds[0], &State::resting(&worlds[0]), Skill::default(), 5);
    let ticks = (operator.duration_s() / DT) as usize;
    let mut body = Loop::new(Swap::new(worlds[0].clone()), Box::new(operator), Limits::default());
    let (mut last, mut angle_rad) = (body.tick(DT), body.state().crank.angle_rad);
    let (mut elsewhere, mut at_swaps, mut turning) = ([0.0_f64; 2], [0.0_f64; 2], 0);
    for tick in 1..ticks {
        let swapped = tick % every == 0;
        if swapped {
            body.swap(Swap::going_on(worlds[(tick / every) % 2].clone()));
        }
        let now = body.tick(DT);
        let crank = body.state().crank;
        assert!((crank.angle_rad - angle_rad).abs() < 0.02, "the handle jumps at tick {tick}");
        if now.tip_force_n.iter().all(|f| f.norm() > 1.0) {
            let worst = if swapped { &mut at_swaps } else { &mut elsewhere };
            for (worst, change) in worst.iter_mut().zip(changes(&last, &now)) {
                *worst = worst.max(change);
            }
            turning += usize::from(swapped && crank.rate_rad_s.abs() > 0.5);
        }
        (last, angle_rad) = (now, crank.angle_rad);
    }
    (elsewhere, at_swaps, turning)
}

#[test]
fn a_world_that_goes_on_changes_its_laws_under_a_turning_crank_without_a_bump() {
    let [before, after] = cranks();
    let same = |world: &World| turned(&[world.clone(), world.clone()], usize::MAX).0;
    let quiet = [same(&before), same(&after)];
    // Every 137 ms, so that swaps fall on every part of the turn.
    let (elsewhere, at_swaps, turning) = turned(&[before, after], 137);
    println!("largest change a tick, N: never swapped {quiet:?}, swapped {elsewhere:?}, at swaps {at_swaps:?}");
    assert!(turning > 20, "{turning} swaps under a turning crank");
    // What the world feels: laws change the handle's acceleration, never its place, so the pads carry nothing over at once.
    let usual = [0, 1].map(|k| f64::max(quiet[0][k], quiet[1][k]));
    assert!(at_swaps[0] <= usual[0], "{} N at a swap, up to {} N a tick without any", at_swaps[0], usual[0]);
    // What the hand feels: nothing at the swap; then the old force fades within 50 ms, a newton of difference at most.
    assert!(
        at_swaps[1] <= 0.1 * usual[1],
        "a bump of {} N at a swap, up to {} N a tick without",
        at_swaps[1],
        usual[1]
    );
    let fading = 1.0 * DT / 0.05;
    assert!(elsewhere[1] <= usual[1] + fading, "{} N a tick, {} N without swaps", elsewhere[1], usual[1]);
}

#[test]
fn a_world_with_other_things_in_it_does_not_go_on_from_a_state_that_means_nothing_there() {
    let mut body = Loop::new(Swap::new(presets::stacking()), rigid(false, leaning()), Limits::default());
    for _ in 0..50 {
        body.tick(DT);
    }
    body.swap(Swap::going_on(presets::crank()));
    assert_eq!(body.state().bodies.len(), presets::crank().blocks.len());
    let start = presets::crank().crank.expect("a crank").start_rad;
    assert_eq!(body.state().crank.angle_rad, start);
    assert_eq!(body.state().input.tip_in_world, leaning(), "the fingers stay where they are");
}
