//! Kinds and intervals on made paths with white and strongly correlated errors.

use super::*;
use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
use rand_distr::StandardNormal;

/// Error along a path of `n` samples with standard deviation `sigma`: AR(1) with a correlation length of `length` samples.
fn path_error(rng: &mut StdRng, n: usize, sigma: f64, length: f64) -> Vec<f64> {
    let rho = if length > 0.0 { (-1.0 / length).exp() } else { 0.0 };
    let mut state: f64 = rng.sample(StandardNormal);
    (0..n)
        .map(|_| {
            state = rho * state + (1.0 - rho * rho).sqrt() * rng.sample::<f64, _>(StandardNormal);
            sigma * state
        })
        .collect()
}

/// A tilted arc in space.
fn arc(radius: f64, sweep: f64, n: usize, sigma: f64, length: f64, seed: u64) -> Vec<Vector3<f64>> {
    let mut rng = StdRng::seed_from_u64(seed);
    let errors: Vec<Vec<f64>> = (0..3).map(|_| path_error(&mut rng, n, sigma, length)).collect();
    let (x, y) = (Vector3::new(0.8, 0.6, 0.0), Vector3::new(0.0, 0.0, 1.0));
    (0..n)
        .map(|i| {
            let a = 0.4 + sweep * i as f64 / n as f64;
            Vector3::new(0.5, -0.2, 0.1)
                + radius * (x * a.cos() + y * a.sin())
                + Vector3::new(errors[0][i], errors[1][i], errors[2][i])
        })
        .collect()
}

fn line(length_m: f64, n: usize, sigma: f64, length: f64, seed: u64) -> Vec<Vector3<f64>> {
    let mut rng = StdRng::seed_from_u64(seed);
    let errors: Vec<Vec<f64>> = (0..3).map(|_| path_error(&mut rng, n, sigma, length)).collect();
    let along = Vector3::new(0.6, -0.64, 0.48);
    (0..n)
        .map(|i| along * (length_m * i as f64 / n as f64) + Vector3::new(errors[0][i], errors[1][i], errors[2][i]))
        .collect()
}

fn look(points: &[Vector3<f64>]) -> Constraint {
    detect(points, None, &Context::default())
}

#[test]
fn a_door_a_drawer_and_a_carried_block_are_told_apart() {
    let door = look(&arc(0.4, 1.3, 500, 1e-3, 20.0, 1));
    assert_eq!(door.kind, ConstraintKind::Revolute, "{door:#?}");
    let axis = door.direction.as_ref().expect("an axis");
    let true_axis = Vector3::new(0.8, 0.6, 0.0).cross(&Vector3::z());
    assert!((Vector3::new(axis[0], axis[1], axis[2]).dot(&true_axis)).abs() > 0.999);
    assert!((door.coverage_rad.expect("an angle") - 1.3).abs() < 0.05);
    let drawer = look(&line(0.45, 300, 1e-3, 20.0, 2));
    assert_eq!(drawer.kind, ConstraintKind::Prismatic, "{drawer:#?}");
    let direction = drawer.direction.as_ref().expect("a direction");
    assert!((direction[0] - 0.6).abs() < 0.01 && (direction[2] - 0.48).abs() < 0.01);
    let carried: Vec<Vector3<f64>> = (0..600)
        .map(|i| {
            let t = f64::from(i) * 0.01;
            Vector3::new(0.1 * (1.3 * t).sin(), 0.06 * (2.9 * t).sin(), 0.0)
        })
        .collect();
    assert_eq!(look(&carried).kind, ConstraintKind::Free);
}

#[test]
fn a_full_turn_in_the_plane_and_many_turns() {
    for turns in [1.0, 5.0] {
        let points: Vec<Vector3<f64>> = (0..2000)
            .map(|i| {
                let a = std::f64::consts::TAU * turns * f64::from(i) / 2000.0;
                Vector3::new(0.01 + 0.02 * a.cos(), -0.1 + 0.02 * a.sin(), 0.0)
            })
            .collect();
        let found = detect(&points, None, &Context { planar: true, ..Context::default() });
        assert_eq!(found.kind, ConstraintKind::Revolute, "{found:?}");
        let center = found.center_m.expect("a centre");
        assert!(center.len() == 2 && (center[0] - 0.01).abs() < 1e-5 && (center[1] + 0.1).abs() < 1e-5);
        assert!((found.radius_m.expect("a radius") - 0.02).abs() < 1e-6);
        assert!((found.coverage_rad.expect("an angle") - std::f64::consts::TAU * turns).abs() < 0.05);
        assert_eq!(found.direction.as_deref(), Some(&[0.0, 0.0, 1.0][..]));
    }
}

/// Share of 95 % intervals that hold the radius, and of wrong kinds.
fn coverage(radius: f64, sweep: f64, sigma: f64, length: f64) -> (f64, usize) {
    let (trials, mut hits, mut wrong) = (60, 0, 0);
    for seed in 0..trials {
        let found = look(&arc(radius, sweep, 400, sigma, length, 100 + seed));
        wrong += usize::from(matches!(found.kind, ConstraintKind::Prismatic | ConstraintKind::Free));
        let Some((low, high)) = found.radius_interval_m else { continue };
        hits += u32::from(low <= radius && high.is_none_or(|h| radius <= h));
    }
    (f64::from(hits) / trials as f64, wrong)
}

#[test]
fn radius_intervals_are_honest_for_any_arc_and_any_correlation() {
    // 60 trials: a coverage of 0.95 has a standard error of 0.028.
    for (radius, sweep) in [(0.3, 1.6), (0.3, 0.8), (0.3, 0.4), (0.7, 1.0)] {
        for (sigma, length) in [(5e-4, 0.0), (1e-3, 10.0), (2e-3, 60.0), (3e-3, 300.0)] {
            let (share, wrong) = coverage(radius, sweep, sigma, length);
            println!("R {radius} sweep {sweep} σ {sigma} length {length}: coverage {share}, wrong kind {wrong}");
            assert!(share > 0.88, "R {radius} sweep {sweep} σ {sigma} length {length}: {share}");
            assert_eq!(wrong, 0, "R {radius} sweep {sweep} σ {sigma} length {length}");
        }
    }
}

#[test]
fn a_line_is_never_called_a_circle() {
    let mut straight = 0;
    for (sigma, length) in [(5e-4, 0.0), (1e-3, 20.0), (2e-3, 60.0), (3e-3, 300.0)] {
        for seed in 0..100 {
            let found = look(&line(0.45, 300, sigma, length, 500 + seed));
            assert!(
                matches!(found.kind, ConstraintKind::Prismatic | ConstraintKind::Undecided),
                "σ {sigma} length {length}: {found:?}"
            );
            straight += u32::from(found.kind == ConstraintKind::Prismatic);
        }
    }
    println!("{straight} of 400 lines decided");
    assert!(straight > 200, "{straight}");
}

#[test]
fn a_short_arc_is_hardly_ever_called_a_slide() {
    let (mut slides, mut all) = (0, 0);
    for (radius, sweep) in [(0.3, 0.1), (0.3, 0.2), (0.6, 0.15), (0.6, 0.3), (1.0, 0.2), (1.0, 0.4)] {
        for (sigma, length) in [(5e-4, 0.0), (1e-3, 20.0), (2e-3, 60.0)] {
            let seeds = (0..15).map(|seed| look(&arc(radius, sweep, 300, sigma, length, 900 + seed)).kind);
            let wrong = seeds.filter(|k| *k == ConstraintKind::Prismatic).count();
            if wrong > 0 {
                println!("R {radius} sweep {sweep} σ {sigma} length {length}: {wrong} of 15");
            }
            slides += wrong;
            all += 15;
        }
    }
    println!("{slides} of {all} short arcs called a slide");
    assert!(100 * slides <= 2 * all, "{slides} of {all}");
}

#[test]
fn dwelling_does_not_move_the_answer() {
    let mut points = arc(0.4, 1.3, 500, 0.0, 0.0, 1);
    let still = points[100];
    points.splice(100..100, std::iter::repeat_n(still, 3000));
    let found = look(&points);
    assert!((found.radius_m.expect("a radius") - 0.4).abs() < 1e-4);
}

#[test]
fn a_pull_outward_is_a_positive_constraint_force() {
    let points = arc(0.4, 1.3, 500, 1e-4, 5.0, 1);
    let center = Vector3::new(0.5, -0.2, 0.1);
    let forces: Vec<Vector3<f64>> =
        points.iter().enumerate().map(|(i, p)| (p - center).normalize() * (6.0 + (0.1 * i as f64).sin())).collect();
    let found = detect(&points, Some(&forces), &Context::default());
    assert!((found.constraint_force_n.expect("a force") - 6.0).abs() < 0.05 && found.rigid == Some(true));
}

#[test]
fn hardly_anything_is_undecided_and_nothing_panics() {
    for points in [
        vec![],
        vec![Vector3::zeros(); 1],
        vec![Vector3::zeros(); 100],
        vec![Vector3::repeat(f64::NAN); 100],
        line(0.1, 5, 0.0, 0.0, 1),
    ] {
        assert_eq!(look(&points).kind, ConstraintKind::Undecided);
    }
    assert_eq!(look(&line(0.5, 200, 0.0, 0.0, 1)).kind, ConstraintKind::Prismatic);
    // A short arc is left open rather than called a slide.
    assert_ne!(look(&arc(0.3, 0.25, 200, 1e-3, 50.0, 3)).kind, ConstraintKind::Revolute);
}

#[test]
fn sparse_paths_are_decided_where_their_evidence_suffices_and_never_wrongly() {
    // Points at uneven places, as someone marks them by hand.
    let sparse = |n: usize, seed: u64, at: &dyn Fn(f64) -> Vector3<f64>, sigma: f64| -> Vec<Vector3<f64>> {
        let mut rng = StdRng::seed_from_u64(seed);
        let mut places: Vec<f64> = (0..n).map(|_| rng.random::<f64>()).collect();
        places.sort_by(f64::total_cmp);
        let mut noise = || sigma * rng.sample::<f64, _>(StandardNormal);
        places.into_iter().map(|u| at(u) + Vector3::new(noise(), noise(), noise())).collect()
    };
    let on_arc = |radius: f64, sweep: f64| {
        move |u: f64| Vector3::new(radius * (sweep * u).cos(), 0.0, radius * (sweep * u).sin())
    };
    let on_line = |u: f64| Vector3::new(0.3 * u, 0.1 * u, 0.0);
    let (mut arcs, mut lines) = (0, 0);
    for seed in 0..30 {
        let door = look(&sparse(20, seed, &on_arc(0.1, 1.92), 5e-4));
        assert_ne!(door.kind, ConstraintKind::Prismatic, "{}", door.evidence);
        let (low, high) = door.radius_interval_m.expect("an interval");
        assert!(low <= 0.1 && high.is_none_or(|h| h >= 0.1), "{low} {high:?}");
        arcs += usize::from(door.kind == ConstraintKind::Revolute);
        let drawer = look(&sparse(12, 100 + seed, &on_line, 1e-3));
        assert_ne!(drawer.kind, ConstraintKind::Revolute, "{}", drawer.evidence);
        lines += usize::from(drawer.kind == ConstraintKind::Prismatic);
        // Short parts of wide doors bend by no more than their noise: nothing may be said.
        let piece = look(&sparse(12, 200 + seed, &on_arc(0.5, 0.15), 1e-3));
        assert_ne!(piece.kind, ConstraintKind::Prismatic, "{}", piece.evidence);
        let bent = look(&sparse(14, 300 + seed, &on_arc(0.3, 0.5), 2e-3));
        assert_ne!(bent.kind, ConstraintKind::Prismatic, "{}", bent.evidence);
        // Nor of a hand that wanders.
        let wander = |u: f64| Vector3::new(0.2 * (7.0 * u).sin(), 0.2 * (4.0 * u).cos(), 0.1 * (9.0 * u).sin());
        let free = look(&sparse(16, 400 + seed, &wander, 1e-3));
        assert!(!matches!(free.kind, ConstraintKind::Revolute | ConstraintKind::Prismatic), "{}", free.evidence);
    }
    println!("{arcs} of 30 sparse arcs and {lines} of 30 sparse lines decided");
    assert!(arcs > 20 && lines > 10, "{arcs} {lines}");
}

#[test]
fn a_winding_path_is_a_screw_and_hinges_and_slides_are_screws_without_and_with_all_pitch() {
    let mut rng = StdRng::seed_from_u64(5);
    let points: Vec<Vector3<f64>> = (0..600)
        .map(|i| 0.02 * f64::from(i))
        .map(|a| Vector3::new(0.05 * a.cos(), 0.05 * a.sin(), 0.004 * a))
        .map(|p| p + Vector3::from_fn(|_, _| 2e-4 * rng.sample::<f64, _>(StandardNormal)))
        .collect();
    let found = look(&points);
    assert_eq!(found.kind, ConstraintKind::Screw, "{}", found.evidence);
    let pitch = found.screw.and_then(|s| s.pitch_m_rad).expect("a pitch");
    assert!((pitch - 0.004).abs() < 4e-4, "{pitch}");
    let door = look(&arc(0.4, 1.3, 500, 5e-4, 5.0, 1));
    assert_eq!(door.screw.and_then(|s| s.pitch_m_rad), Some(0.0));
    let drawer = look(&line(0.45, 300, 5e-4, 5.0, 2));
    assert!(drawer.screw.is_some_and(|s| s.pitch_m_rad.is_none()));
}

/// One pass along a bent way: the path alone does not say whether something guides it, the force does.
#[test]
fn force_across_a_bent_path_tells_a_guide_from_a_free_hand() {
    let (mut guided, mut free) = (0, 0);
    for seed in 0..20 {
        let mut rng = StdRng::seed_from_u64(seed);
        let time: Vec<f64> = (0..1500).map(|i| f64::from(i) * 0.004).collect();
        let at = |t: f64| Vector3::new(0.05 * t, 0.06 * (1.4 * t).sin(), 0.0);
        let acceleration = |t: f64| Vector3::new(0.0, -0.06 * 1.96 * (1.4 * t).sin(), 0.0);
        let mut noise = |sigma: f64| {
            Vector3::new(
                sigma * rng.sample::<f64, _>(StandardNormal),
                sigma * rng.sample::<f64, _>(StandardNormal),
                0.0,
            )
        };
        let points: Vec<Vector3<f64>> = time.iter().map(|t| at(*t) + noise(1e-4)).collect();
        let carried: Vec<Vector3<f64>> =
            time.iter().map(|t| 0.2 * (acceleration(*t) + Vector3::new(0.0, 9.81, 0.0)) + noise(0.02)).collect();
        let pressed: Vec<Vector3<f64>> = carried
            .iter()
            .zip(&time)
            .map(|(f, t)| {
                let along = (at(t + 1e-4) - at(*t)).normalize();
                f + Vector3::new(-along.y, along.x, 0.0) * (0.8 + 0.3 * (2.0 * t).sin())
            })
            .collect();
        let context = Context { planar: true, time_s: Some(time), up: Vector3::y(), ..Context::default() };
        let with = |forces: &[Vector3<f64>]| detect(&points, Some(forces), &context);
        assert_eq!(detect(&points, None, &context).kind, ConstraintKind::Undecided);
        let (a, b) = (with(&pressed), with(&carried));
        assert_ne!(a.kind, ConstraintKind::Free, "seed {seed}: {}", a.evidence);
        assert_ne!(b.kind, ConstraintKind::Spline, "seed {seed}: {}", b.evidence);
        guided += usize::from(a.kind == ConstraintKind::Spline && a.guide.is_some());
        free += usize::from(b.kind == ConstraintKind::Free);
    }
    println!("{guided} of 20 guided, {free} of 20 free");
    assert!(guided >= 18 && free >= 15, "{guided} {free}");
}
