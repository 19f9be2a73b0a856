//! Somebody handles a barrel of unknown contents: lifts it, pulls at its cable along an arc, puts it down and squeezes it. The hand is
//! a mass on a spring that follows where it is wanted; the barrel is the stepped world's.

use crate::coverage::{LEVELS, Scores, score};
use crate::generate::{STEP_S, Truth};
use estimator::pipeline::{Options, analyse};
use haptics::Vec2;
use haptics::device::HandImpedance;
use haptics::recording::{Recording, Task};
use haptics::servo::TickRecord;
use haptics::servo::recorder::{SensorModel, to_recording};
use haptics::world::{Cable, Content, Input, State, Wall, World, presets, step, true_label};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// Where the pair of fingers is wanted: middle, m, distance, m, extra squeeze of each, N.
#[derive(Clone, Copy, Debug)]
struct Wanted {
    middle: Vec2,
    apart_m: f64,
    pinch_n: f64,
}

/// A barrel that was handled, seen by several sensors.
pub struct Handling {
    /// One a sensor.
    pub recordings: Vec<Recording>,
    /// What the fit should find; the mass is that at the start.
    pub truth: Truth,
    /// Mass at the start, kg, and what it loses, kg/s.
    pub mass_kg: (f64, f64),
    /// How far the barrel turned in the grip while its cable pulled, rad.
    pub turned_rad: f64,
}

/// A barrel drawn at random; about half of them leak, two of three are on a cable.
pub fn barrel_world(seed: u64) -> World {
    let mut rng = StdRng::seed_from_u64(seed.wrapping_mul(0xa076_1d64_78bd_642f) ^ 0x00ba_44e1);
    let mut world = presets::barrel();
    let floor_m = world.floor.as_ref().map_or(0.0, |f| f.height_m);
    let mut draw = |low: f64, high: f64| rng.random_range(low..high);
    world.pad.stiffness_n_m = draw(1800.0, 4000.0);
    world.pad.shear_stiffness_n_m = world.pad.stiffness_n_m * draw(0.5, 0.9);
    if let Some(floor) = &mut world.floor {
        floor.stiffness_n_m = draw(15_000.0, 50_000.0);
        floor.damping_n_s_m = 12.0;
    }
    let barrel = &mut world.blocks[0];
    barrel.mass_kg = draw(0.12, 0.28);
    barrel.width_m = draw(0.020, 0.028);
    barrel.height_m = draw(0.028, 0.036);
    barrel.start.center_m.y = floor_m + 0.5 * barrel.height_m;
    barrel.stiffness_n_m = 50_000.0;
    barrel.damping_n_s_m = 12.0;
    barrel.wall = Some(Wall { stiffness_n_m: draw(1500.0, 6000.0), strength_n: None });
    let leaks = draw(0.0, 1.0) < 0.5;
    let leak_kg_s = if leaks { draw(0.2e-3, 2e-3) } else { 0.0 };
    barrel.content = Some(Content { mass_kg: 0.6 * barrel.mass_kg, leak_kg_s, leaks_from_s: Some(0.0) });
    let anchor_m = Vec2::new(-0.034 + draw(-0.003, 0.003), floor_m + draw(0.0, 0.01));
    let held = draw(0.0, 1.0) < 2.0 / 3.0;
    barrel.cable = held.then(|| Cable {
        anchor_m,
        length_m: draw(0.038, 0.044),
        stiffness_n_m: draw(300.0, 1200.0),
        damping_n_s_m: draw(0.5, 3.0),
    });
    world
}

/// Handles the barrel of `world` and looks at it through `sensors`, at 1 kHz; the sensors' zeros are off and drift a little.
pub fn handle(world: &World, seed: u64, sensors: &[SensorModel]) -> Handling {
    let mut rng = StdRng::seed_from_u64(seed ^ 0x9a1d);
    let plan = plan(world, &mut rng);
    let (ticks, off_m, turned_rad) = perform(world, &plan);
    let zeros = [(); 2].map(|()| Vec2::from_fn(|_, _| rng.random_range(-0.02..0.02)));
    let drifts = [(); 2].map(|()| Vec2::new(0.0, rng.random_range(-1e-3..1e-3)));
    let seen: Vec<TickRecord> = ticks
        .iter()
        .map(|t| TickRecord {
            tip_force_n: [0, 1].map(|f: usize| t.tip_force_n[f] + zeros[f] + drifts[f] * t.time_s),
            ..*t
        })
        .collect();
    let recordings = sensors.iter().map(|sensor| {
        let mut recording = to_recording(&format!("barrel {seed}"), world, &seen, 1, sensor, seed ^ 0x5eed);
        recording.meta.task = Some(Task::Barrel);
        recording.meta.known.insert("pad_stiffness_N_m".to_owned(), world.pad.stiffness_n_m);
        recording.meta.known.insert("height_m".to_owned(), world.blocks[0].height_m);
        recording
    });
    let content = world.blocks[0].content.unwrap_or(Content { mass_kg: 0.0, leak_kg_s: 0.0, leaks_from_s: None });
    Handling {
        recordings: recordings.collect(),
        truth: truth(world, off_m),
        mass_kg: (world.blocks[0].mass_kg, content.leak_kg_s),
        turned_rad,
    }
}

/// `off_m`: how far above the barrel's middle the fingers' middle held it.
fn truth(world: &World, off_m: f64) -> Truth {
    let barrel = &world.blocks[0];
    let behind = |a: f64, b: f64| 1.0 / (1.0 / a + 1.0 / b);
    let wall_n_m = barrel.wall.map_or(f64::INFINITY, |w| w.stiffness_n_m);
    let mut all = vec![
        ("barrel", "width_m", barrel.width_m),
        ("barrel", "grip_stiffness_N_m", behind(wall_n_m, world.pad.stiffness_n_m)),
        ("barrel", "wall_stiffness_N_m", wall_n_m),
        ("barrel", "leak_kg_s", barrel.content.map_or(0.0, |c| c.leak_kg_s)),
    ];
    if let Some(cable) = &barrel.cable {
        all.extend([
            ("cable", "stiffness_N_m", cable.stiffness_n_m),
            ("cable", "anchor_x_m", cable.anchor_m.x),
            ("cable", "anchor_y_m", cable.anchor_m.y + off_m),
            ("cable", "length_m", cable.length_m),
        ]);
    }
    all.into_iter().map(|(object, name, value)| ((object.to_owned(), name.to_owned()), value)).collect()
}

/// Movements: how long, s, and where to.
fn plan(world: &World, rng: &mut StdRng) -> Vec<(f64, Wanted)> {
    let barrel = &world.blocks[0];
    let at = barrel.start.center_m + Vec2::new(0.0, rng.random_range(-0.001..0.001));
    let open = Wanted { middle: at, apart_m: barrel.width_m + 0.006, pinch_n: 0.0 };
    let above = |wanted: Wanted, by: f64| Wanted { middle: wanted.middle + Vec2::new(0.0, by), ..wanted };
    let least_n = 0.5 * barrel.mass_kg * world.gravity_m_s2 / barrel.finger_friction;
    let pinch_n = 2.4 * least_n * rng.random_range(0.9..1.2);
    let held = Wanted { apart_m: barrel.width_m, pinch_n, ..open };
    // The arm gives under the weight.
    let sag_m = 0.5 * barrel.mass_kg * world.gravity_m_s2 / HandImpedance::default().stiffness_n_m;
    let lifted = above(held, sag_m + rng.random_range(0.008..0.012));
    let mut plan = vec![(1.0, above(open, 0.015)), (0.7, open), (0.5, held), (0.5, held), (1.0, lifted), (1.5, lifted)];
    if let Some(cable) = &barrel.cable {
        // Along an arc about where it is tied, drawn a little beyond the cable's length.
        let reach_m = cable.length_m + rng.random_range(0.002..0.004);
        let height_m = lifted.middle.y - sag_m - cable.anchor_m.y;
        let low = (height_m / reach_m).clamp(-0.9, 0.9).asin();
        let high = low + rng.random_range(0.3..0.5);
        let place = |angle: f64| Wanted {
            middle: cable.anchor_m + Vec2::new(angle.cos(), angle.sin()) * reach_m + Vec2::new(0.0, sag_m),
            ..lifted
        };
        plan.push((1.8, place(low)));
        plan.extend((1..=8).map(|k| (0.35, place(low + (high - low) * f64::from(k) / 8.0))));
        plan.push((0.8, place(high)));
    } else {
        plan.push((1.5, Wanted { middle: lifted.middle + Vec2::new(0.02, 0.004), ..lifted }));
        plan.push((0.8, plan[plan.len() - 1].1));
    }
    let down = above(held, -0.0006);
    let squeeze = |share: f64| Wanted { pinch_n: share * pinch_n, ..down };
    let last = [(1.5, lifted), (1.0, down), (0.4, down), (0.8, squeeze(1.3)), (0.8, squeeze(1.3)), (0.8, squeeze(0.3))];
    plan.extend(last);
    plan.extend([(0.5, Wanted { middle: down.middle, ..open }), (0.8, above(open, 0.015)), (1.0, above(open, 0.015))]);
    plan
}

/// Steps the world; returns every fifth step, how far above the barrel's middle it was held on the mean, and how far it turned.
fn perform(world: &World, plan: &[(f64, Wanted)]) -> (Vec<TickRecord>, f64, f64) {
    let arm = HandImpedance::default();
    let mut state = State::resting(world);
    let tips = |w: &Wanted| {
        let half = Vec2::new(0.5 * w.apart_m - w.pinch_n / arm.stiffness_n_m, 0.0);
        [w.middle - half, w.middle + half]
    };
    let (mut ticks, mut offsets, mut turned_rad) = (Vec::new(), Vec::new(), 0.0_f64);
    let mut from = plan[0].1;
    let (mut place, mut velocity) = (tips(&from), [Vec2::zeros(); 2]);
    let mut count = 0_usize;
    for (span_s, to) in plan {
        let (a, b) = (tips(&from), tips(to));
        for k in 0..(span_s / STEP_S) as usize {
            let s = (k as f64 + 1.0) * STEP_S / span_s;
            let (share, rate) = (s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s), 30.0 * (s * (1.0 - s)).powi(2) / span_s);
            for f in 0..2 {
                let wanted = (a[f] + (b[f] - a[f]) * share, (b[f] - a[f]) * rate);
                arm.advance(&mut place[f], &mut velocity[f], wanted, -state.tip_force_n[f], STEP_S);
            }
            let input = Input { tip_in_world: place, tip_velocity: velocity };
            step(world, &mut state, &input, STEP_S);
            if count.is_multiple_of(5) {
                let (tip_force_n, label) = (state.tip_force_n, true_label(world, &state));
                ticks.push(TickRecord { time_s: state.time_s, input, tip_force_n, label, ..TickRecord::default() });
                if state.bodies[0].cable_n > 0.0 {
                    let lift = tip_force_n.map(|f| f.y / world.pad.shear_stiffness_n_m);
                    let middle = 0.5 * (place[0].y - lift[0] + place[1].y - lift[1]);
                    offsets.push(middle - state.bodies[0].center_m.y);
                    turned_rad = turned_rad.max(state.bodies[0].angle_rad.abs());
                }
            }
            count += 1;
        }
        from = *to;
    }
    let off_m = offsets.iter().sum::<f64>() / offsets.len().max(1) as f64;
    (ticks, off_m, turned_rad)
}

/// Scores of one seed, a level of noise each.
pub fn scores(seed: u64) -> Vec<Scores> {
    let world = barrel_world(seed);
    let sensors = LEVELS.map(|level| SensorModel::TYPICAL.noisier(level));
    let handling = handle(&world, seed, &sensors);
    handling.recordings.iter().map(|recording| score_one(recording, &handling, &world)).collect()
}

fn score_one(recording: &Recording, handling: &Handling, world: &World) -> Scores {
    let analysis = analyse(std::slice::from_ref(recording), &Options::default()).expect("it was lifted");
    let fit = analysis.fit;
    let mut truth = handling.truth.clone();
    // A leaking barrel has the stated weight at the time that the fit names.
    let at_s = fit.parameter("barrel", "weight_N").and_then(|p| {
        let words: Vec<&str> = p.how.split_whitespace().collect();
        words.windows(2).find(|w| w[1] == "s")?[0].parse::<f64>().ok()
    });
    let mass_kg = handling.mass_kg.0 - handling.mass_kg.1 * at_s.expect("the time of the weight is stated");
    truth.insert(("barrel".to_owned(), "weight_N".to_owned()), mass_kg * world.gravity_m_s2);
    let volume = 0.25 * std::f64::consts::PI * world.blocks[0].width_m.powi(2) * world.blocks[0].height_m;
    truth.insert(("barrel".to_owned(), "density_kg_m3".to_owned()), mass_kg / volume);
    let found = fit.value("cable", "stiffness_N_m").is_some();
    assert!(!found || world.blocks[0].cable.is_some(), "{}: a cable where there is none", recording.name);
    score(&fit, &truth)
}
