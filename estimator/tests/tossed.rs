//! Thrown bodies, blind: own integrator, scale, friction and tracker drawn.

use estimator::identify::mechanism;
use haptics::recording::{Channel, Meta, Recording};
use nalgebra::{UnitQuaternion, Vector3};
use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
use rand_distr::StandardNormal;

/// True scale of lengths and friction.
struct Truth {
    scale: f64,
    friction: f64,
}

/// One throw: flight with spin about a centre beside the tracked point, one blow after which it lies flat, then sliding to rest.
fn throw(rng: &mut StdRng, truth: &Truth, beside: Vector3<f64>, noise_m: f64, trial: usize) -> Recording {
    let dt = 1.0 / 148.0;
    let mut place = Vector3::new(0.2, 0.1, rng.random_range(0.15..0.35));
    let mut speed = Vector3::new(rng.random_range(-1.5..1.5), rng.random_range(-1.5..1.5), rng.random_range(-0.5..0.5));
    let spin = Vector3::from_fn(|_, _| rng.random_range(-4.0..4.0));
    let mut turned = UnitQuaternion::from_scaled_axis(Vector3::from_fn(|_, _| rng.random_range(-2.0..2.0)));
    let mut flying = true;
    let mut rows: Vec<[f64; 7]> = Vec::new();
    for _ in 0..110 {
        let seen = (place + turned * beside) * truth.scale;
        let q = turned.quaternion();
        let shaken: [f64; 3] = std::array::from_fn(|k| seen[k] + noise_m * rng.sample::<f64, _>(StandardNormal));
        rows.push([shaken[0], shaken[1], shaken[2], q.w, q.i, q.j, q.k]);
        for _ in 0..100 {
            let part = dt / 100.0;
            if flying {
                speed.z -= 9.81 * part;
                place += speed * part;
                turned = UnitQuaternion::from_scaled_axis(spin * part) * turned;
                if place.z < 0.05 {
                    flying = false;
                    speed = Vector3::new(0.6 * speed.x, 0.6 * speed.y, 0.0);
                }
            } else if speed.norm() > 0.0 {
                let slower = (speed.norm() - truth.friction * 9.81 * part).max(0.0);
                speed = speed.normalize() * slower;
                place += speed * part;
            }
        }
    }
    let names = ["x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"];
    let channels = names
        .iter()
        .enumerate()
        .map(|(k, name)| Channel {
            name: (*name).to_owned(),
            unit: if k < 3 { "m" } else { "" }.to_owned(),
            values: rows.iter().map(|r| r[k]).collect(),
        })
        .collect();
    let time_s = Some((0..rows.len()).map(|i| i as f64 * dt).collect());
    let meta = Meta { up: Some("z".to_owned()), ..Meta::default() };
    Recording { name: format!("throw {trial}"), time_s, channels, meta, ..Recording::default() }
}

#[test]
fn scale_and_friction_of_a_thrown_body_come_with_errors_that_hold() {
    let worlds = 40;
    let mut held = [0; 2];
    for seed in 0..worlds {
        let mut rng = StdRng::seed_from_u64(9000 + seed);
        let truth = Truth { scale: rng.random_range(0.93..1.07), friction: rng.random_range(0.1..0.5) };
        let beside = Vector3::from_fn(|_, _| rng.random_range(-0.01..0.01));
        let noise_m = rng.random_range(3e-5..3e-4);
        let throws: Vec<Recording> = (0..20).map(|k| throw(&mut rng, &truth, beside, noise_m, k)).collect();
        let fit = mechanism::fit(&throws).expect("a thrown body is a result");
        for (k, (name, true_value)) in
            [("length_scale", truth.scale), ("friction", truth.friction)].into_iter().enumerate()
        {
            let found = fit.parameter("body", name).expect("listed");
            let (value, error) = (found.value.expect("identified"), found.std_error.expect("an error"));
            held[k] += usize::from((value - true_value).abs() < 1.96 * error);
            assert!(
                (value / true_value - 1.0).abs() < 0.06,
                "seed {seed} {name}: {value} ± {error}, true {true_value}"
            );
        }
        let off = (truth.scale - 1.0).abs() > 0.03;
        assert!(!off || fit.warnings.iter().any(|w| w.contains("falls with")), "seed {seed}: {:?}", fit.warnings);
    }
    println!("{held:?} of {worlds} in their 95 % intervals");
    assert!(held.iter().all(|h| h * 100 >= 85 * worlds as usize), "{held:?}");
}

#[test]
fn what_does_not_fall_is_no_thrown_body() {
    let n = 200;
    let values = |of: &dyn Fn(f64) -> f64| (0..n).map(|i| of(f64::from(i) / 100.0)).collect::<Vec<f64>>();
    let channel = |name: &str, values: Vec<f64>| Channel { name: name.to_owned(), unit: "m".to_owned(), values };
    let drawer = Recording {
        name: "drawer".to_owned(),
        time_s: Some(values(&|t| t)),
        channels: vec![
            channel("x_m", values(&|t| 0.1 * t * t)),
            channel("y_m", values(&|_| 0.2)),
            channel("z_m", values(&|_| 0.3)),
        ],
        meta: Meta { up: Some("z".to_owned()), ..Meta::default() },
        ..Recording::default()
    };
    assert!(estimator::identify::tossed::fit(&[drawer]).is_none());
}
