//! Needles and switches drawn at random, handled by the scripted operator in the stepped world.

use crate::coverage::{LEVELS, Scores, score};
use crate::generate::{Truth, perform_at_levels};
use estimator::pipeline::{Options, analyse};
use haptics::device::Skill;
use haptics::law::object::CurvePoint;
use haptics::recording::Task;
use haptics::servo::recorder::SensorModel;
use haptics::world::{Switch, World, presets};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// Names of parameters and what they truly are.
pub type Values = Vec<(&'static str, f64)>;

/// A sheet and a needle, with what the fit should find; the surface is added by what the performance knows.
fn needle_world(seed: u64) -> (World, Values) {
    let mut rng = StdRng::seed_from_u64(seed.wrapping_mul(0x2545_f491_4f6c_dd1d) ^ 0x004e_ed1e);
    let mut world = presets::needle();
    let mut draw = |low: f64, high: f64| rng.random_range(low..high);
    world.pad.stiffness_n_m = draw(1800.0, 4000.0);
    world.pad.shear_stiffness_n_m = world.pad.stiffness_n_m * draw(0.3, 1.1);
    world.blocks[0].mass_kg = draw(0.006, 0.014);
    let hardens = draw(0.0, 1.0) < 0.7;
    let cubic_n_m3 = if hardens { draw(0.8e6, 3e6) } else { 0.0 };
    let shift_m = draw(-0.002, 0.004);
    let mut truth = vec![("weight_N", world.blocks[0].mass_kg * world.gravity_m_s2)];
    if let Some(membrane) = &mut world.membrane {
        membrane.center_m.y += shift_m;
        membrane.law.stiffness_n_m = draw(150.0, 420.0);
        membrane.law.cubic_n_m3 = cubic_n_m3;
        membrane.law.puncture_n = draw(1.0, 2.0);
        membrane.law.friction_n = draw(0.15, 0.35);
        membrane.law.drag_n_s_m = draw(0.5, 3.0);
        truth.extend([
            ("stiffness_N_m", membrane.law.stiffness_n_m),
            ("puncture_force_N", membrane.law.puncture_n),
            ("shaft_friction_N", membrane.law.friction_n),
        ]);
        if hardens {
            truth.push(("hardening_N_m3", cubic_n_m3));
        }
    }
    world.blocks[0].start.center_m.y += shift_m;
    (world, truth)
}

/// Gives a switch a curve of straight pieces out of the left end, which it starts from; half its travel, m.
pub fn draw_curve(switch: &mut Switch, rng: &mut StdRng) -> f64 {
    let half = rng.random_range(6e-3..9e-3);
    let (peak, gap) = (rng.random_range(0.8..1.6), rng.random_range(0.1..0.3));
    let (snap, caught) = (-half * rng.random_range(0.35..0.55), half * rng.random_range(0.35..0.55));
    let trough = -peak * rng.random_range(0.6..0.9);
    let point = |at_m: f64, middle: f64, gap: f64| CurvePoint {
        at_m,
        forward_n: middle + 0.5 * gap,
        backward_n: middle - 0.5 * gap,
    };
    switch.curve.points = vec![
        point(-half, 0.0, gap),
        point(snap, peak - 0.5 * gap, gap * rng.random_range(1.0..1.5)),
        point(caught, trough, gap),
        point(half, 0.0, gap),
    ];
    switch.start_m = -half;
    half
}

/// A switch as the built-in one, but with everything about it drawn.
fn switch_world(seed: u64) -> (World, Values) {
    let mut rng = StdRng::seed_from_u64(seed.wrapping_mul(0x9fb2_1c65_1e98_df25) ^ 0x005c_17c4);
    let mut world = presets::switch();
    let gravity_m_s2 = world.gravity_m_s2;
    world.pad.stiffness_n_m = rng.random_range(2000.0..3500.0);
    let Some(switch) = &mut world.switch else { return (world, Vec::new()) };
    let half = draw_curve(switch, &mut rng);
    // As the fit says it takes them: the pads' share of the give at the stops, and the travel over the lever, are evenly likely.
    let share = rng.random_range(0.4..0.98);
    switch.curve.stop_n_m = world.pad.stiffness_n_m * share / (1.0 - share);
    switch.lever_m = 2.0 * half / rng.random_range(0.27..0.78);
    switch.knob_radius_m = rng.random_range(0.005..0.007);
    let truth = switch_truth(switch, gravity_m_s2);
    let pad_n_m = world.pad.stiffness_n_m;
    (world, truth.into_iter().chain([("pad", pad_n_m)]).collect())
}

/// In the terms of the fit: places of the knob's middle, forces with the knob's weight in them.
pub fn switch_truth(switch: &Switch, gravity_m_s2: f64) -> Values {
    let points = &switch.curve.points;
    let x = |k: usize| switch.knob_in_world(points[k].at_m).x;
    let weight = |k: usize| switch.mass_kg * gravity_m_s2 * (points[k].at_m / switch.lever_m).sin();
    let there = |k: usize| points[k].forward_n - weight(k);
    let back = |k: usize| -(points[k].backward_n - weight(k));
    let slope = |f: &dyn Fn(usize) -> f64, a: usize, b: usize| (f(b) - f(a)) / (x(b) - x(a)).abs();
    // Where the mean of both branches vanishes.
    let middle_n = |k: usize| 0.5 * (there(k) - back(k));
    let share = middle_n(1) / (middle_n(1) - middle_n(2));
    let friction = |k: usize| 0.5 * (there(k) + back(k));
    vec![
        ("peak_force_N", there(1)),
        ("snap_position_m", x(1)),
        ("rise_N_m", slope(&there, 0, 1)),
        ("fall_N_m", slope(&there, 1, 2)),
        ("return_peak_force_N", back(2)),
        ("return_snap_position_m", x(2)),
        ("return_rise_N_m", slope(&back, 3, 2)),
        ("return_fall_N_m", slope(&back, 2, 1)),
        ("right_end_position_m", x(3)),
        ("left_end_position_m", x(0)),
        ("travel_m", x(3) - x(0)),
        ("friction_N", friction(1) + (friction(2) - friction(1)) * share),
        ("knob_width_m", 2.0 * switch.knob_radius_m),
    ]
}

/// Scores of the fits of one performance, a level of noise each.
fn scores(seed: u64, task: Task, world: &World, values: &Values) -> Vec<Scores> {
    let sensors = LEVELS.map(|level| SensorModel::TYPICAL.noisier(level));
    let object = task.name();
    let performances = perform_at_levels(world, seed, Skill::default(), 5, &sensors);
    let of = |(name, value): &(&str, f64)| {
        let owner = if *name == "pad" { ("pad", "stiffness_N_m") } else { (object, *name) };
        ((owner.0.to_owned(), owner.1.to_owned()), *value)
    };
    let mut truth: Truth = values.iter().map(of).collect();
    if let (Some(membrane), Some(above_m)) = (&world.membrane, performances[0].held_above_m) {
        let met_m = membrane.center_m.y + 0.5 * world.blocks[0].height_m + above_m;
        truth.insert((object.to_owned(), "surface_position_m".to_owned()), met_m);
    }
    let fitted = |p: &crate::generate::Performance| {
        let mut recording = p.recording.clone();
        recording.meta.task = Some(task);
        analyse(std::slice::from_ref(&recording), &Options::default()).expect("it was handled").fit
    };
    performances.iter().map(|p| score(&fitted(p), &truth)).collect()
}

/// Scores of a needle, a level of noise each.
pub fn needle_scores(seed: u64) -> Vec<Scores> {
    let (world, truth) = needle_world(seed);
    scores(seed, Task::Needle, &world, &truth)
}

/// Scores of a switch, a level of noise each.
pub fn switch_scores(seed: u64) -> Vec<Scores> {
    let (world, truth) = switch_world(seed);
    scores(seed, Task::Switch, &world, &truth)
}
