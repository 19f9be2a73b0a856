//! A surface that pushes one way, found in logs of a tool: tables and walls at any slant, hard and soft, with little and much noise,
//! and everything that is none.

use estimator::constraint;
use estimator::estimate::{Constraint, ConstraintKind, Sided};
use estimator::pipeline::{Options, analyse};
use haptics::Vec2;
use haptics::recording::{Channel, Meta, Recording};
use haptics::world::{Floor, Input, State, World, step};
use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};

const SEEDS: u64 = 20;
/// Step of the generator, s; every fifth is recorded.
const STEP_S: f64 = 0.4e-3;
const EVERY: usize = 5;
const SECONDS: f64 = 12.0;

fn first_seed() -> u64 {
    std::env::var("TOUCHSTONE_SEED").ok().and_then(|s| s.parse().ok()).unwrap_or(0)
}

/// What only the generator knows.
#[derive(Clone, Copy, Debug)]
struct Truth {
    /// Out of the surface, in the log's frame.
    normal: Vec2,
    /// Height of the surface along it, m.
    height_m: f64,
    friction: f64,
    stiffness_n_m: f64,
}

/// Standard normal by Box and Muller.
fn normal(rng: &mut StdRng) -> f64 {
    let (u, v): (f64, f64) = (rng.random_range(1e-12..1.0), rng.random());
    (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

/// A slow hand's way: along, and depth under the surface (negative: above), m. Four touches, two of them slide there and back.
struct Way {
    span_m: f64,
    depth_m: [f64; 4],
    lift_m: f64,
    slides: bool,
    tremor: [f64; 4],
}

impl Way {
    fn drawn(rng: &mut StdRng, stiffness_n_m: f64, slides: bool) -> Self {
        let push_n = |rng: &mut StdRng| rng.random_range(0.8..3.0);
        Self {
            span_m: rng.random_range(0.02..0.06),
            depth_m: std::array::from_fn(|_| push_n(rng) / stiffness_n_m),
            lift_m: rng.random_range(0.004..0.012),
            slides,
            tremor: std::array::from_fn(|_| rng.random_range(0.0..std::f64::consts::TAU)),
        }
    }

    fn at(&self, t: f64) -> (f64, f64) {
        let part = t / SECONDS * 4.0;
        let (touch, u) = ((part.floor() as usize).min(3), part - part.floor());
        let smooth = |x: f64| {
            let x = x.clamp(0.0, 1.0);
            x * x * (3.0 - 2.0 * x)
        };
        // Free, down, in contact from 0.3 to 0.8, up.
        let down = smooth((u - 0.15) / 0.15) - smooth((u - 0.8) / 0.12);
        let press = self.depth_m[touch] * (1.0 + 0.3 * (9.0 * u + self.tremor[0]).sin());
        let depth = -self.lift_m + down * (self.lift_m + press);
        let slide = if self.slides {
            (std::f64::consts::TAU * (u - 0.3).clamp(0.0, 0.5) / 0.5 + self.tremor[1]).sin()
        } else {
            0.0
        };
        let shake = |f: f64, phase: f64| (std::f64::consts::TAU * f * t + phase).sin();
        let place = self.span_m * 0.5 * slide + 2e-3 * touch as f64 + 1e-5 * shake(8.3, self.tremor[2]);
        (place, depth + 5e-6 * shake(9.1, self.tremor[3]))
    }
}

/// Performs the way of a fingertip in the stepped world over a table, and turns the log by `slant` so that the table is a slope or
/// a wall.
fn perform(rng: &mut StdRng, soft: bool, slides: bool, noise: f64) -> (Recording, Truth) {
    let mut world = World::empty("surface");
    let friction = rng.random_range(0.1..0.9);
    let pad: f64 = if soft { rng.random_range(200.0..900.0) } else { rng.random_range(8_000.0..20_000.0) };
    world.pad.stiffness_n_m = pad;
    world.pad.thickness_m = 0.05;
    let height_m = rng.random_range(-0.1..-0.05);
    world.floor = Some(Floor { height_m, friction, ..Floor::default() });
    world.check().expect("it can be stepped");
    let way = Way::drawn(rng, pad, slides);
    let place = |t: f64| {
        let (x, depth) = way.at(t);
        Vec2::new(x, height_m - depth)
    };
    let far = Vec2::new(1.0, 1.0);
    let mut state = State::new(&world, [place(0.0), far]);
    let (mut time, mut tips, mut forces) = (Vec::new(), Vec::new(), Vec::new());
    for k in 0..(SECONDS / STEP_S) as usize {
        let t = (k + 1) as f64 * STEP_S;
        let velocity = (place(t + 1e-5) - place(t - 1e-5)) / 2e-5;
        let input = Input { tip_in_world: [place(t), far], tip_velocity: [velocity, Vec2::zeros()] };
        step(&world, &mut state, &input, STEP_S);
        if k.is_multiple_of(EVERY) {
            time.push(t);
            tips.push(place(t));
            forces.push(state.tip_force_n[0]);
        }
    }
    let slant = rng.random_range(-std::f64::consts::PI..std::f64::consts::PI);
    let recording = seen(rng, time, &tips, &forces, slant, noise);
    let normal = Vec2::new(-slant.sin(), slant.cos());
    (recording, Truth { normal, height_m, friction, stiffness_n_m: pad })
}

/// Through sensors: 15 µm and 10 mN times `noise`, a bias of up to 20 mN, steps of 10 µm and 2 mN; all turned by `slant`.
fn seen(rng: &mut StdRng, time: Vec<f64>, tips: &[Vec2], forces: &[Vec2], slant: f64, noise: f64) -> Recording {
    let (sin, cos) = slant.sin_cos();
    let turned = |v: &Vec2| Vec2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y);
    let bias = Vec2::new(rng.random_range(-0.02..0.02), rng.random_range(-0.02..0.02));
    let mut channel = |name: &str, unit: &str, of: &dyn Fn(usize) -> f64, sigma: f64, step: f64| Channel {
        name: name.to_owned(),
        unit: unit.to_owned(),
        values: (0..tips.len()).map(|i| ((of(i) + sigma * normal(rng)) / step).round() * step).collect(),
    };
    let channels = vec![
        channel("x_m", "m", &|i| turned(&tips[i]).x, noise * 15e-6, 1e-5),
        channel("y_m", "m", &|i| turned(&tips[i]).y, noise * 15e-6, 1e-5),
        channel("fx_N", "N", &|i| turned(&forces[i]).x + bias.x, noise * 0.01, 0.002),
        channel("fy_N", "N", &|i| turned(&forces[i]).y + bias.y, noise * 0.01, 0.002),
    ];
    let meta = Meta { up: Some("y".to_owned()), ..Meta::default() };
    Recording { name: "tool".to_owned(), time_s: Some(time), channels, meta, ..Recording::default() }
}

fn detect(recording: &Recording) -> Constraint {
    constraint::detect_in(recording).expect("a tool path")
}

/// Found, and with errors that hold the truth.
#[derive(Debug, Default)]
struct Tally {
    found: usize,
    normal: usize,
    height: usize,
    friction: usize,
    stiffness: usize,
    rigid: [usize; 3],
}

fn tally(soft: bool, slides: bool, noise: f64) -> Tally {
    let mut sum = Tally::default();
    for seed in first_seed()..first_seed() + SEEDS {
        let mut rng = StdRng::seed_from_u64(seed.wrapping_mul(0x9e37_79b9) ^ (noise * 8.0) as u64);
        let (recording, truth) = perform(&mut rng, soft, slides, noise);
        let found = detect(&recording);
        let Some(surface) = found.surface.clone().filter(|_| found.kind == ConstraintKind::Unilateral) else {
            println!("seed {seed} noise {noise}: {:?} {}", found.kind, found.evidence);
            continue;
        };
        assert_eq!(found.sided, Some(Sided::OneSided));
        assert!(found.existence.as_ref().is_some_and(|e| e.p_value < e.false_alarm_rate));
        let got = Vec2::new(surface.normal[0], surface.normal[1]);
        let angle = (got.x * truth.normal.y - got.y * truth.normal.x).atan2(got.dot(&truth.normal));
        let height = truth.normal.dot(&Vec2::new(surface.point_m[0], surface.point_m[1])) - truth.height_m;
        let within = |error: f64, std_error: f64| usize::from(error.abs() < 1.96 * std_error);
        sum.found += 1;
        sum.normal += within(angle, surface.tilt_std_error_rad);
        sum.height += within(height, surface.offset_std_error_m);
        if let (Some(value), Some(error)) = (surface.friction, surface.friction_std_error) {
            sum.friction += within(value - truth.friction, error);
            assert!((value - truth.friction).abs() < 0.15, "seed {seed}: {value} {truth:?}");
        }
        if let Some(give) = found.yielding {
            let (low, high) = give.interval_n_m;
            sum.stiffness += usize::from(low < truth.stiffness_n_m && high.is_none_or(|h| h > truth.stiffness_n_m));
        }
        let index = found.rigid.map_or(2, usize::from);
        sum.rigid[index] += 1;
        assert!(angle.abs() < if slides { 0.03 } else { 1.0 } && height.abs() < 1e-3, "seed {seed}: {angle} {height}");
        assert!(found.rigid != Some(soft), "seed {seed}: {:?} {truth:?}", found.yielding);
    }
    println!("soft {soft}, slides {slides}, noise × {noise}: {sum:?} of {SEEDS}");
    sum
}

#[test]
fn a_surface_is_found_at_any_slant_hard_or_soft_at_three_levels_of_noise() {
    for (soft, noise) in [(false, 0.3), (false, 1.0), (false, 3.0), (true, 0.3), (true, 1.0), (true, 3.0)] {
        let sum = tally(soft, true, noise);
        assert!(sum.found * 20 >= SEEDS as usize * 19, "{sum:?}");
        // 95 % intervals that hold the truth.
        let held = [sum.normal, sum.height, sum.stiffness];
        assert!(held.iter().all(|h| h * 10 >= sum.found * 8), "{sum:?}");
    }
}

#[test]
fn pressing_without_sliding_still_shows_a_surface_with_an_honest_slant() {
    let sum = tally(false, false, 1.0);
    assert!(sum.found * 20 >= SEEDS as usize * 19 && sum.normal * 10 >= sum.found * 9, "{sum:?}");
}

/// Motions in which nothing is pressed on: a free hand, a hand with a load (weight and inertia), a rail and a hinge that are pulled from
/// both sides or one, a spring.
fn without(kind: usize, rng: &mut StdRng, noise: f64) -> Recording {
    let mut draw = |low: f64, high: f64| rng.random_range(low..high);
    let tau = std::f64::consts::TAU;
    let waves: [[f64; 3]; 4] = std::array::from_fn(|_| [draw(0.005, 0.03), draw(0.1, 0.9), draw(0.0, tau)]);
    let (load_kg, radius, pull, spring) = (draw(0.05, 0.5), draw(0.03, 0.3), draw(0.5, 3.0), draw(20.0, 200.0));
    let slant = draw(-3.0, 3.0);
    let (mut time, mut tips, mut forces) = (Vec::new(), Vec::new(), Vec::new());
    for k in 0..6000 {
        let t = f64::from(k) * STEP_S * EVERY as f64;
        let wave = |w: &[f64; 3], d: i32| {
            let rate = tau * w[1];
            let (sin, cos) = (rate * t + w[2]).sin_cos();
            w[0] * match d {
                0 => sin,
                1 => rate * cos,
                _ => -rate * rate * sin,
            }
        };
        let pair = |d: i32| Vec2::new(wave(&waves[0], d) + wave(&waves[1], d), wave(&waves[2], d) + wave(&waves[3], d));
        let (tip, force) = match kind {
            0 => (pair(0), Vec2::zeros()),
            1 => (pair(0), (pair(2) + Vec2::new(0.0, 9.81)) * load_kg),
            // A rail along x: friction along, a pull across that changes its side or keeps it.
            2 | 3 => {
                let side = if kind == 2 { wave(&waves[2], 0) / waves[2][0] } else { 1.0 + 0.3 * (3.0 * t).sin() };
                (Vec2::new(pair(0).x, pull * side * 1e-4), Vec2::new(0.2 * pair(1).x.signum(), pull * side))
            }
            4 => {
                let angle = wave(&waves[0], 0) / waves[0][0];
                let out = Vec2::new(angle.cos(), angle.sin());
                (out * radius, out * pull + Vec2::new(-out.y, out.x) * 0.3)
            }
            _ => (pair(0), pair(0) * spring),
        };
        time.push(t);
        tips.push(tip);
        forces.push(force);
    }
    seen(rng, time, &tips, &forces, slant, noise)
}

#[test]
fn what_is_no_surface_is_called_one_no_more_often_than_stated() {
    let names = ["free hand", "load", "rail, both sides", "rail, one side", "hinge", "spring"];
    let mut alarms = 0;
    let mut total = 0;
    for (kind, name) in names.iter().enumerate() {
        for seed in first_seed()..first_seed() + SEEDS {
            for noise in [0.3, 1.0, 3.0] {
                let mut rng = StdRng::seed_from_u64(seed.wrapping_mul(0xd134_2543) ^ (kind as u64) << 40);
                let found = detect(&without(kind, &mut rng, noise));
                total += 1;
                if found.kind == ConstraintKind::Unilateral {
                    println!("{name}, seed {seed}, noise {noise}: {}", found.evidence);
                    alarms += 1;
                }
            }
        }
    }
    println!("{alarms} of {total} called a surface");
    // One in a hundred is stated; more than 22 of 1080 at that rate come once in 1000 runs.
    assert!(alarms <= 22, "{alarms} of {total}");
}

#[test]
fn the_fitted_world_holds_the_surface() {
    let mut rng = StdRng::seed_from_u64(first_seed() ^ 0xfe17);
    let (recording, truth) = perform(&mut rng, true, true, 1.0);
    let analysis = analyse(&[recording], &Options::default()).expect("a surface is a result");
    let friction = analysis.fit.value("surface", "friction").expect("it slid");
    let stiffness = analysis.fit.value("surface", "stiffness_N_m").expect("it gave way");
    assert!((friction - truth.friction).abs() < 0.1 && (stiffness / truth.stiffness_n_m - 1.0).abs() < 0.2);
    let plane = analysis.world.plane.expect("it can be felt");
    assert!(plane.normal().dot(&truth.normal) > 0.999 && (plane.friction - friction).abs() < 1e-9);
    assert!((plane.stiffness_n_m - stiffness).abs() < 1e-6);
    World::from_json(&analysis.world.to_json()).expect("the world file can be read again");
}
