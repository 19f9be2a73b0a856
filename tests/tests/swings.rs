//! Pendulums whose torque a controller makes out of the motion, and one that a hand moves: ratios are known, and what the
//! torque cannot tell is not told.

use blind::Chance;
use estimator::diagnose::{Options, Verdict, diagnose};
use estimator::estimate::{Fit, Parameter};
use estimator::identify::mechanism::fit;
use haptics::recording::{Channel, Recording};

/// Seeds on which nothing was chosen.
const SEED: u64 = 7_440_001;
const PENDULUMS: u64 = 16;

/// A real pendulum: per unit of its inertia, and the controller's own properties.
struct Pendulum {
    inertia_kg_m2: f64,
    /// 1/s².
    gravity_over_inertia: f64,
    dry_nm: f64,
    viscous_nm_s: f64,
    /// Time constant of the motor, s.
    lag_s: f64,
}

impl Pendulum {
    fn draw(chance: &mut Chance) -> Self {
        let inertia_kg_m2 = chance.between(0.05, 0.5);
        let gravity_over_inertia = chance.between(10.0, 40.0);
        let moment = inertia_kg_m2 * gravity_over_inertia;
        Self {
            inertia_kg_m2,
            gravity_over_inertia,
            dry_nm: chance.between(0.02, 0.06) * moment,
            viscous_nm_s: chance.between(0.0, 0.006) * moment,
            lag_s: chance.between(0.001, 0.006),
        }
    }

    fn moment_nm(&self) -> f64 {
        self.inertia_kg_m2 * self.gravity_over_inertia
    }

    /// Swings for 30 s under a commanded torque of (time, angle, rate), which is recorded at 200 Hz with its noise.
    fn swing(&self, chance: &mut Chance, command: &dyn Fn(f64, f64, f64) -> f64) -> Recording {
        const STEPS: usize = 50;
        let (period_s, samples) = (0.005, 6000);
        let step_s = period_s / STEPS as f64;
        let (mut q, mut v, mut torque, mut held) = (0.1, 0.0_f64, 0.0, 0.0);
        let acceleration = |q: f64, v: f64, torque: f64| {
            let friction = self.dry_nm * (v / 0.002).tanh() + self.viscous_nm_s * v;
            (torque - friction - self.moment_nm() * q.sin()) / self.inertia_kg_m2
        };
        let mut columns = vec![Vec::new(); 4];
        for k in 0..samples {
            let quantum = 0.0015_f64;
            let read = (q / quantum).round() * quantum;
            let rate = v + 0.02 * chance.normal();
            for (column, value) in columns.iter_mut().zip([
                f64::from(k) * period_s,
                read,
                rate,
                held + 0.002 * self.moment_nm() * chance.normal(),
            ]) {
                column.push(value);
            }
            held = command(f64::from(k) * period_s, read, rate);
            for _ in 0..STEPS {
                torque += (held - torque) * step_s / self.lag_s;
                // Midpoint rule.
                let (q_half, v_half) = (q + 0.5 * step_s * v, v + 0.5 * step_s * acceleration(q, v, torque));
                q += step_s * v_half;
                v += step_s * acceleration(q_half, v_half, torque);
            }
        }
        recording(columns)
    }
}

fn recording(columns: Vec<Vec<f64>>) -> Recording {
    let mut columns = columns.into_iter();
    let time_s = columns.next();
    let channels = [("q_rad", "rad"), ("dq_rad_s", "rad/s"), ("tau_Nm", "N m")]
        .into_iter()
        .zip(columns)
        .map(|((name, unit), values)| Channel { name: name.to_owned(), unit: unit.to_owned(), values })
        .collect();
    Recording { name: "swing".to_owned(), time_s, channels, ..Recording::default() }
}

fn parameter<'a>(fit: &'a Fit, name: &str) -> Option<&'a Parameter> {
    fit.parameters.iter().find(|p| p.name == name).filter(|p| p.identified)
}

/// Distance from a truth in standard errors; `None` if it is not identified.
fn off(fit: &Fit, name: &str, truth: f64) -> Option<f64> {
    let p = parameter(fit, name)?;
    Some((p.value? - truth).abs() / p.std_error?)
}

#[test]
fn a_torque_that_follows_the_speed_tells_the_ratio_and_no_false_inertia() {
    let mut chance = Chance::new(SEED, 1);
    let (mut ratios, mut missed) = (0, Vec::new());
    for k in 0..PENDULUMS {
        let pendulum = Pendulum::draw(&mut chance);
        let push_nm = pendulum.dry_nm + chance.between(0.04, 0.2) * pendulum.moment_nm();
        let swing = pendulum.swing(&mut chance, &|_, q, v| if q.abs() < 2.0 { push_nm * v.signum() } else { 0.0 });
        let fit = fit(std::slice::from_ref(&swing)).expect("a fit");
        let ratio = off(&fit, "gravity_moment_per_inertia_rad_s2", pendulum.gravity_over_inertia);
        ratios += usize::from(ratio.is_some_and(|off| off < 4.0));
        let truths = [
            ("inertia_kg_m2", pendulum.inertia_kg_m2),
            ("gravity_moment_Nm", pendulum.moment_nm()),
            ("coulomb_Nm", pendulum.dry_nm),
        ];
        for (name, truth) in truths {
            if let Some(off) = off(&fit, name, truth).filter(|off| *off > 3.0) {
                missed.push(format!(
                    "{k}: {name} {truth:.3} by {off:.1} errors, {:?}",
                    parameter(&fit, name).map(|p| (p.value, p.std_error))
                ));
            }
        }
        let found = diagnose(&[swing], &Options::default()).expect("an answer");
        let of = |name: &str| parameter(&fit, name).and_then(|p| p.value);
        let stated = of("gravity_moment_per_inertia_rad_s2").map(|r| r / pendulum.gravity_over_inertia);
        let by_values =
            of("gravity_moment_Nm").zip(of("inertia_kg_m2")).map(|(g, j)| g / j / pendulum.gravity_over_inertia);
        println!(
            "{k} {stated:.4?} {by_values:.4?} ratio off {ratio:.1?} {:?} {:?}",
            found.verdict,
            found.certain().iter().map(|c| &c.id).collect::<Vec<_>>()
        );
        let certain: Vec<_> = found.certain().into_iter().filter(|c| c.standing.is_some()).collect();
        assert!(certain.is_empty(), "{k}: {certain:?}");
        assert_ne!(found.verdict, Verdict::None);
    }
    println!("{ratios} ratios; {missed:#?}");
    assert!(ratios >= 14, "{ratios} of {PENDULUMS} ratios");
    assert!(missed.len() <= 2, "{missed:#?}");
}

#[test]
fn a_torque_of_its_own_tells_inertia_gravity_and_friction() {
    let mut chance = Chance::new(SEED, 2);
    let (mut told, mut missed) = (0, Vec::new());
    for k in 0..PENDULUMS {
        let pendulum = Pendulum::draw(&mut chance);
        let size_nm = 0.5 * pendulum.moment_nm();
        let waves: Vec<[f64; 2]> = (0..6).map(|_| [chance.between(0.2, 4.0), chance.between(0.0, 6.0)]).collect();
        let swing = pendulum.swing(&mut chance, &|t, _, _| {
            waves.iter().map(|[rate, phase]| size_nm / 2.5 * (rate * t + phase).sin()).sum()
        });
        let fit = fit(&[swing]).expect("a fit");
        for (name, truth) in [("inertia_kg_m2", pendulum.inertia_kg_m2), ("gravity_moment_Nm", pendulum.moment_nm())] {
            match off(&fit, name, truth) {
                Some(off) if off > 4.0 => missed.push(format!("{k}: {name} {truth:.3} by {off:.1} errors")),
                found => told += usize::from(found.is_some()),
            }
        }
    }
    println!("{told} told; {missed:#?}");
    assert!(told >= 28 && missed.len() <= 2, "{told} {missed:#?}");
}

#[test]
fn a_hand_that_moves_a_compensated_pendulum_shows_no_inertia_and_no_friction() {
    let mut chance = Chance::new(SEED, 3);
    for k in 0..PENDULUMS {
        let (moment_nm, rate) = (chance.between(0.5, 10.0), chance.between(0.5, 3.0));
        let mut columns = vec![Vec::new(); 4];
        for i in 0..6000 {
            let t = 0.005 * f64::from(i);
            let q = 0.9 * (rate * t).sin() + 0.3 * (2.3 * rate * t + 1.0).sin();
            let v = rate * (0.9 * (rate * t).cos() + 0.69 * (2.3 * rate * t + 1.0).cos());
            let torque = moment_nm * (q.sin() + 0.002 * chance.normal());
            for (column, value) in
                columns.iter_mut().zip([t, q + 4e-4 * chance.normal(), v + 0.02 * chance.normal(), torque])
            {
                column.push(value);
            }
        }
        let fit = fit(&[recording(columns)]).expect("a fit");
        let inertia = parameter(&fit, "inertia_kg_m2").and_then(|p| p.value);
        assert!(inertia.is_none(), "{k}: {inertia:?}");
        let dry = parameter(&fit, "coulomb_Nm").and_then(|p| p.value);
        assert!(dry.is_none_or(|dry| dry.abs() < 2e-3 * moment_nm), "{k}: {dry:?}");
    }
}
