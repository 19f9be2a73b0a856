//! Exported worlds, run in MuJoCo on the same input as ours.

use super::fits;
use super::table::{Row, Table};
use app::export::{Format, export};
use haptics::Vec2;
use haptics::law::{Law as _, LoadFriction};
use haptics::world::{Input, State, Switch, World, presets, step};
use serde_json::{Value, json};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Tick of both programs, s: fine, so that neither's steps are what differs.
pub const STEP_S: f64 = 1.25e-4;
/// Dry friction of the switch at its knob, N, over which way it turns round, m, and damping, N s/m: what moves a knob by a given force
/// is mostly damping then; with little of it the smallest difference in friction is a long way.
const DRY_N: f64 = 0.05;
const REVERSAL_M: f64 = 0.02e-3;
const DAMPING_N_S_M: f64 = 5.0;
/// Ticks between compared places.
const EVERY: usize = 8;

/// What both programs say of the same coordinates.
struct Course {
    ours: Vec<Vec<f64>>,
    theirs: Vec<Vec<f64>>,
}

impl Course {
    /// Its first seconds.
    fn until(mut self, seconds: f64) -> Self {
        let count = (seconds / (EVERY as f64 * STEP_S)) as usize;
        assert!(count <= self.ours.len(), "the course is shorter than {seconds} s");
        self.ours.truncate(count);
        self.theirs.truncate(count);
        self
    }

    fn largest(&self, joint: usize) -> f64 {
        self.ours.iter().zip(&self.theirs).map(|(a, b)| (a[joint] - b[joint]).abs()).fold(0.0, f64::max)
    }

    fn way(&self, joint: usize) -> f64 {
        let places = self.ours.iter().map(|row| row[joint]);
        places.clone().fold(f64::NEG_INFINITY, f64::max) - places.fold(f64::INFINITY, f64::min)
    }

    fn row(&self, what: &str, (name, joint): (&str, usize), unit: &str, tolerance: f64) -> Row {
        let (off, way) = (self.largest(joint), self.way(joint));
        for (index, (ours, theirs)) in self.ours.iter().zip(&self.theirs).enumerate().step_by(self.ours.len() / 40) {
            let at_s = (index + 1) as f64 * EVERY as f64 * STEP_S;
            println!("{what}: at {at_s:.3} s {:.6} here, {:.6} in MuJoCo", ours[joint], theirs[joint]);
        }
        let (scale, shown) = if unit == "m" { (1e3, "mm") } else { (1e3, "mrad") };
        Row {
            labels: vec![what.to_owned(), name.to_owned()],
            shown: [way, off, tolerance].map(|value| format!("{:.3} {shown}", scale * value)).to_vec(),
            found: off,
            wanted: 0.0,
            tolerance,
            per: 1.0,
            places: 3,
        }
    }
}

/// All comparisons; `None` where MuJoCo is missing.
pub fn compared() -> Option<Table> {
    // Calibrated out of logs that MuJoCo made, and handed back to it.
    let made = fits::made(fits::SEED)?;
    let [blocks_of_log, crank_of_log] = ["blocks", "crank"].map(|name| fits::analysed(&made, name).1.world);
    let crank = turned_crank(presets::crank())?;
    // Until its last stop: there the force that held it in our hands holds it on a slope in MuJoCo, where it creeps and falls.
    let crank_fitted = turned_crank(crank_of_log)?.until(3.5);
    let swung = [Format::Mjcf, Format::Urdf].map(swung_crank);
    let [Some(swung), Some(swung_urdf)] = swung else { return None };
    let slid = slid_block(0.0)?;
    let slope = slid_block(-0.25)?;
    let dropped = dropped_block()?;
    let lifted = lifted_block(&presets::stacking())?;
    let lifted_fitted = lifted_block(&blocks_of_log)?;
    let led = led_switch(0.9)?;
    let pressed = led_switch(1.06)?;
    let fallen = fallen_switch()?;
    let rows = vec![
        crank.row("crank, turned by the same force at its handle", ("angle", 0), "rad", 5e-3),
        crank_fitted.row("crank fitted to MuJoCo's log, the same until 3.5 s", ("angle", 0), "rad", 5e-3),
        swung.row("crank, let go", ("angle", 0), "rad", 1e-3),
        swung_urdf.row("crank as URDF, let go", ("angle", 0), "rad", 50e-3),
        slid.row("block, sent over the floor at 0.3 m/s", ("x", 0), "m", 0.3e-3),
        slope.row("block, sent up a floor tilted by 0.25 rad", ("x", 0), "m", 0.5e-3),
        dropped.row("block, dropped by 5 mm until it lies", ("y", 1), "m", 0.3e-3),
        lifted.row("upper block, lifted by two fingers and put back", ("y", 1), "m", 0.6e-3),
        lifted_fitted.row("upper of the blocks fitted to MuJoCo's log, the same", ("y", 1), "m", 0.6e-3),
        led.row("switch without its snap, led to and fro by the same force at its knob", ("angle", 0), "rad", 5e-3),
        pressed.row("the same, led against both stops", ("angle", 0), "rad", 5e-3),
        fallen.row("the same without friction, let go, falls against a stop", ("angle", 0), "rad", 15e-3),
    ];
    Some(Table { head: vec!["world and input", "coordinate", "way", "largest difference", "may be"], rows })
}

/// Runs an exported world in MuJoCo.
fn played(world: &World, (format, fingers): (Format, bool), job: &mut Value) -> Option<Vec<Vec<f64>>> {
    let folder = tempfile::tempdir().expect("a folder");
    let (model, file) = (folder.path().join("world.xml"), folder.path().join("job.json"));
    std::fs::write(&model, export(world, format, fingers).text).expect("the model is written");
    job["model"] = json!(model);
    job["step_s"] = json!(STEP_S);
    std::fs::write(&file, job.to_string()).expect("the job is written");
    let said = tests::python::output_of("tests/mujoco/play.py", &[file.to_str().expect("a plain path")])?;
    let said: Value = serde_json::from_str(&said).expect("one JSON object");
    let rows: Vec<Vec<f64>> = serde_json::from_value(said["rows"].clone()).expect("rows of numbers");
    Some(rows.into_iter().skip(EVERY - 1).step_by(EVERY).collect())
}

fn reach(u: f64, from: f64, to: f64) -> f64 {
    let s = ((u - from) / (to - from)).clamp(0.0, 1.0);
    s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)
}

/// Steps a world along the tips' course; tells each tick's state to `look`.
pub fn stepped(
    world: &World,
    state: &mut State,
    seconds: f64,
    tips: &dyn Fn(f64) -> [Vec2; 2],
    mut look: impl FnMut(&State),
) {
    for tick in 1..=(seconds / STEP_S).round() as u32 {
        let at = |tick: u32| tips(f64::from(tick) * STEP_S);
        let (now, before) = (at(tick), at(tick - 1));
        let input = Input { tip_in_world: now, tip_velocity: [0, 1].map(|f| (now[f] - before[f]) / STEP_S) };
        step(world, state, &input, STEP_S);
        look(state);
    }
}

fn times(count: usize) -> Vec<f64> {
    (1..=count).map(|tick| tick as f64 * STEP_S).collect()
}

fn thinned<T: Clone>(all: &[T]) -> Vec<T> {
    all.iter().skip(EVERY - 1).step_by(EVERY).cloned().collect()
}

/// Two fingers turn our crank; the force that they put on the handle turns MuJoCo's.
fn turned_crank(mut world: World) -> Option<Course> {
    let crank = world.crank.as_mut().expect("a crank");
    // The one law that MuJoCo has nothing for.
    crank.effects.retain(|effect| effect.law().id() != LoadFriction.id());
    let (center_m, radius_m, half_m) = (crank.center_m, crank.radius_m, 0.5 * crank.handle_width_m);
    let tips = move |t: f64| {
        let angle = -FRAC_PI_2 + TAU * (1.2 * reach(t, 0.3, 2.0) - 1.9 * reach(t, 2.2, 4.0));
        let handle_m = center_m + radius_m * Vec2::new(angle.cos(), angle.sin());
        let half = Vec2::new(half_m + 0.003 * (1.0 - reach(t, 0.0, 0.2)) - 5e-4, 0.0);
        [handle_m - half, handle_m + half]
    };
    let (mut forces, mut angles) = (Vec::new(), Vec::new());
    let mut state = State::new(&world, tips(0.0));
    stepped(&world, &mut state, 4.5, &tips, |state| {
        let force = state.tip_force_n[0] + state.tip_force_n[1];
        forces.push([force.x, force.y]);
        angles.push(vec![state.crank.angle_rad]);
    });
    let force = json!({ "body": "crank", "site": "crank-handle", "rows": forces });
    let theirs = played(&world, (Format::Mjcf, false), &mut json!({ "at_s": times(angles.len()), "force": force }))?;
    Some(Course { ours: thinned(&angles), theirs })
}

/// A switch without what MuJoCo has nothing for: a force that changes over the way. What lies between the two ways stays, the same
/// everywhere.
fn without_snap(dry_n: f64, damping_n_s_m: f64, start_m: f64) -> (World, Switch) {
    let mut world = presets::switch();
    let switch = world.switch.as_mut().expect("a switch");
    switch.curve.points.iter_mut().for_each(|p| (p.forward_n, p.backward_n) = (dry_n, -dry_n));
    switch.curve.reversal_m = REVERSAL_M;
    (switch.damping_n_s_m, switch.start_m) = (damping_n_s_m, start_m);
    let switch = switch.clone();
    (world, switch)
}

/// Its lever, a little off the top, falls under its weight until a stop holds it.
fn fallen_switch() -> Option<Course> {
    let (world, switch) = without_snap(0.0, 0.3, 3e-3);
    let mut angles = Vec::new();
    let mut state = State::new(&world, away(0.0));
    stepped(&world, &mut state, 1.0, &away, |state| angles.push(vec![state.switch.at_m / switch.lever_m]));
    let theirs = played(&world, (Format::Mjcf, false), &mut json!({ "at_s": times(angles.len()) }))?;
    Some(Course { ours: thinned(&angles), theirs })
}

/// Two fingers lead the knob of our switch to and fro over a share of its way, from the middle; the force that they put on it moves
/// MuJoCo's lever.
fn led_switch(share: f64) -> Option<Course> {
    let (world, knob) = without_snap(DRY_N, DAMPING_N_S_M, 0.0);
    let (lever_m, most_m) = (knob.lever_m, share * knob.curve.points.last().expect("an end").at_m);
    let tips = move |t: f64| {
        let way = reach(t, 0.3, 0.8) - 2.0 * reach(t, 1.0, 1.8) + reach(t, 2.0, 2.5);
        let half = Vec2::new(knob.knob_radius_m + 0.003 * (1.0 - reach(t, 0.0, 0.2)) - 5e-4, 0.0);
        let middle = knob.knob_in_world(most_m * way);
        [middle - half, middle + half]
    };
    let (mut forces, mut angles) = (Vec::new(), Vec::new());
    let mut state = State::new(&world, tips(0.0));
    stepped(&world, &mut state, 2.8, &tips, |state| {
        let force = state.tip_force_n[0] + state.tip_force_n[1];
        forces.push([force.x, force.y]);
        angles.push(vec![state.switch.at_m / lever_m]);
    });
    let force = json!({ "body": "switch", "site": "switch-handle", "rows": forces });
    let theirs = played(&world, (Format::Mjcf, false), &mut json!({ "at_s": times(angles.len()), "force": force }))?;
    Some(Course { ours: thinned(&angles), theirs })
}

/// The crank falls from a little above the horizontal and comes to rest, nobody touching it.
fn swung_crank(format: Format) -> Option<Course> {
    let mut world = presets::crank();
    let crank = world.crank.as_mut().expect("a crank");
    crank.start_rad = 0.3;
    let start_rad = crank.start_rad;
    let mut angles = Vec::new();
    let mut state = State::new(&world, away(0.0));
    stepped(&world, &mut state, 2.0, &away, |state| angles.push(vec![state.crank.angle_rad]));
    let mut theirs = played(&world, (format, false), &mut json!({ "at_s": times(angles.len()) }))?;
    if format == Format::Urdf {
        // There a joint is zero where the world starts.
        for row in &mut theirs {
            row[0] += start_rad;
        }
    }
    Some(Course { ours: thinned(&angles), theirs })
}

/// One block alone on a floor.
fn one_block() -> World {
    let mut world = presets::stacking();
    world.blocks.truncate(1);
    world.blocks[0].start.center_m = Vec2::new(-0.02, -0.125 + 0.5 * world.blocks[0].height_m);
    world
}

/// Where the fingers touch nothing.
pub fn away(_: f64) -> [Vec2; 2] {
    [Vec2::new(-0.5, 0.5), Vec2::new(0.5, 0.5)]
}

fn alone(world: &World, seconds: f64, speed_m_s: f64) -> Option<Course> {
    let mut state = State::new(world, away(0.0));
    state.bodies[0].velocity_m_s.x = speed_m_s;
    let mut places = Vec::new();
    stepped(world, &mut state, seconds, &away, |state| {
        let body = &state.bodies[0];
        places.push(vec![body.center_m.x, body.center_m.y, body.angle_rad]);
    });
    let mut job = json!({ "at_s": times(places.len()), "speed": { "block-1-x": speed_m_s } });
    let theirs = played(world, (Format::Mjcf, false), &mut job)?;
    Some(Course { ours: thinned(&places), theirs })
}

fn slid_block(tilt_rad: f64) -> Option<Course> {
    let mut world = one_block();
    world.tilt_rad = tilt_rad;
    alone(&world, 0.5, 0.3)
}

fn dropped_block() -> Option<Course> {
    let mut world = one_block();
    world.blocks[0].start.center_m.y += 0.005;
    alone(&world, 0.4, 0.0)
}

/// A person's cycle on the upper of two blocks; MuJoCo's fingertips are led along the same course.
fn lifted_block(world: &World) -> Option<Course> {
    let (upper_m, half_m) = (world.blocks[0].start.center_m, 0.5 * world.blocks[0].width_m);
    let tips = move |t: f64| {
        let closed = reach(t, 0.1, 0.5) - reach(t, 2.3, 2.7);
        let lifted = reach(t, 0.6, 1.2) - reach(t, 1.6, 2.2);
        let half = Vec2::new(half_m + 0.004 * (1.0 - closed) - 6e-4 * closed, 0.0);
        let middle = upper_m + Vec2::new(0.0, 0.015 * lifted);
        [middle - half, middle + half]
    };
    let (mut controls, mut places) = (Vec::new(), Vec::new());
    let mut state = State::new(world, tips(0.0));
    stepped(world, &mut state, 3.0, &tips, |state| {
        let [left, right] = state.input.tip_in_world;
        controls.push([left.x, left.y, right.x, right.y]);
        let body = &state.bodies[0];
        places.push(vec![body.center_m.x, body.center_m.y, body.angle_rad]);
    });
    let theirs =
        played(world, (Format::Mjcf, true), &mut json!({ "at_s": times(places.len()), "controls": controls }))?;
    Some(Course { ours: thinned(&places), theirs })
}
