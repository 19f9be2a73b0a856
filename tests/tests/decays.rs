//! Pendulums that swing until they hang: the loss of each half swing tells dry friction, viscous friction and drag apart.

use blind::Chance;
use estimator::diagnose::{Findings, Options, diagnose};
use haptics::recording::{Channel, Recording};

/// A seed on which nothing was chosen.
const SEED: u64 = 7_460_001;

/// Decay from rest at 250 Hz, behind an encoder. `losses`: dry, viscous and quadratic, per unit of inertia; `wears`:
/// change of the dry friction in the end, as a share.
fn decay(chance: &mut Chance, losses: [f64; 3], wears: f64) -> Recording {
    let gravity = chance.between(20.0, 60.0);
    let [dry, viscous, drag] = losses;
    let (mut q, mut v) = (chance.between(0.7, 1.3), 0.0_f64);
    let acceleration = |q: f64, v: f64, level: f64| {
        -gravity * q.sin() - level * dry * (v / 1e-4).tanh() - viscous * v - drag * v * v.abs()
    };
    let (period_s, steps) = (0.004, 40);
    let step_s = period_s / f64::from(steps);
    let quantum = 0.000_436_f64;
    let mut places = Vec::new();
    for k in 0..18_000 {
        let level = 1.0 + wears * f64::from(k) / 18_000.0;
        places.push((q / quantum).round() * quantum);
        for _ in 0..steps {
            let (q_half, v_half) = (q + 0.5 * step_s * v, v + 0.5 * step_s * acceleration(q, v, level));
            q += step_s * v_half;
            v += step_s * acceleration(q_half, v_half, level);
        }
    }
    Recording {
        name: "decay".to_owned(),
        time_s: Some((0..places.len()).map(|k| period_s * k as f64).collect()),
        channels: vec![Channel { name: "q_rad".to_owned(), unit: "rad".to_owned(), values: places }],
        ..Recording::default()
    }
}

fn asked(recording: Recording, baseline: &str) -> Findings {
    let options = Options { baseline: Some(baseline.to_owned()), ..Options::default() };
    diagnose(&[recording], &options).expect("an answer")
}

fn certain(found: &Findings) -> Vec<&str> {
    let mut names: Vec<&str> = found.certain().into_iter().map(|c| c.id.as_str()).collect();
    names.sort_unstable();
    names
}

#[test]
fn dry_friction_and_drag_are_told_from_viscous_friction() {
    let mut chance = Chance::new(SEED, 1);
    for k in 0..6 {
        let losses = [chance.between(0.03, 0.08), 0.0, chance.between(0.003, 0.008)];
        let found = asked(decay(&mut chance, losses, 0.0), "mass+viscous");
        assert_eq!(certain(&found), ["coulomb-friction", "quadratic-drag"], "{k}: {:?}", found.causes);
        for (id, truth) in [("coulomb-friction", losses[0]), ("quadratic-drag", losses[2])] {
            let value = found.causes.iter().find(|c| c.id == id).map_or(0.0, |c| c.parameters[0].value);
            assert!((value / truth - 1.0).abs() < 0.1, "{k}: {id} {truth} {value}");
        }
    }
}

#[test]
fn losses_of_the_model_are_no_causes() {
    let mut chance = Chance::new(SEED, 2);
    for k in 0..6 {
        let losses = [chance.between(0.02, 0.06), chance.between(0.01, 0.03), 0.0];
        let found = asked(decay(&mut chance, losses, 0.0), "mass+viscous+coulomb");
        assert!(certain(&found).is_empty(), "{k}: {:?}", found.causes);
        let found = asked(decay(&mut chance, [0.0, losses[1], 0.0], 0.0), "mass+viscous");
        assert!(certain(&found).is_empty(), "{k}: {:?}", found.causes);
    }
}

#[test]
fn dry_friction_that_changes_with_time_is_no_drag() {
    let mut chance = Chance::new(SEED, 3);
    for k in 0..6 {
        let losses = [chance.between(0.03, 0.08), chance.between(0.005, 0.02), 0.0];
        let wears = [-0.4, 0.6, -0.1, 0.15, -0.05, 0.05][k];
        let found = asked(decay(&mut chance, losses, wears), "mass+viscous+coulomb");
        println!(
            "{k} {wears} {:?} {:?}",
            found.causes.iter().map(|c| (&c.id, c.posterior)).collect::<Vec<_>>(),
            found.alternatives
        );
        assert!(!certain(&found).contains(&"quadratic-drag"), "{k}: {:?}", found.causes);
    }
}
