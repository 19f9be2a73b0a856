//! Properties that must hold for every law.

use super::*;
use proptest::prelude::*;

#[test]
fn ids_are_unique_and_bounds_are_ordered() {
    let all: Vec<_> = entries().collect();
    for (i, a) in all.iter().enumerate() {
        assert!(a.parameters.len() <= MAX_PARAMETERS, "{}", a.id);
        assert!(all[i + 1..].iter().all(|b| b.id != a.id), "{}", a.id);
        assert!(a.parameters.iter().all(|p| p.bounds.0 < p.bounds.1), "{}", a.id);
        for text in [a.what, a.shows, a.mimics, a.reveals] {
            assert!(text.len() > 20 && text.ends_with('.') && !text.contains("  "), "{}: {text}", a.id);
        }
        assert!(a.reveals.contains("reveal") && (a.shows.starts_with("As ") || a.shows.starts_with("In ")), "{}", a.id);
    }
}

#[test]
fn linear_means_linear_and_the_columns_sum_to_the_force() {
    let motion = Motion {
        time_s: 7.0,
        position: 0.013,
        velocity: -0.04,
        acceleration: 0.3,
        direction: -1.0,
        normal_force_n: 1.5,
        up_along: 0.6,
    };
    for &law in CATALOGUE {
        let effect = Effect::new(law, &[0.3, 0.2, 0.1, 0.05, 0.4]);
        let columns = effect.columns(&motion, &[0.0; 2]);
        let linear = |spec: &&ParameterSpec| spec.enters == Enters::Linear;
        if law.parameters().iter().any(|s| linear(&s)) {
            let specs = law.parameters().iter().zip(columns).zip(effect.values);
            let sum: f64 = specs.filter(|((s, _), _)| linear(s)).map(|((_, c), v)| c * v).sum();
            assert!((sum - effect.force(&motion)).abs() < 1e-12, "{}: {sum}", law.id());
        }
    }
}

#[test]
fn what_goes_with_the_path_alone_says_so() {
    let at = |position: f64, [acceleration, normal_force_n, up_along]: [f64; 3]| Motion {
        time_s: 7.0,
        position,
        velocity: -0.04,
        acceleration,
        direction: -0.8,
        normal_force_n,
        up_along,
    };
    for &law in CATALOGUE {
        let goes = |place: f64, third: f64| {
            let effect = Effect::new(law, &[0.3, 0.2, third, 0.05, 0.4]);
            let others = [[0.3, 1.5, 0.6], [-0.7, 1.5, 0.6], [0.3, -4.0, 0.6], [0.3, 1.5, -0.2]];
            let forces = others.map(|other| effect.force(&at(place, other)));
            forces.iter().any(|force| force.to_bits() != forces[0].to_bits())
        };
        let places = || (-20..20).map(|k| 0.01 * f64::from(k));
        // A tilt goes with where up is only without a third value, friction by direction with a load only with one.
        let goes = |place: f64| goes(place, 0.0) || goes(place, 0.1);
        assert_eq!(places().any(goes), !law.is_of_path(), "{}", law.id());
    }
}

#[test]
fn what_is_another_law_times_the_direction_is_that_to_the_bit() {
    let values = [0.3, 0.02, 0.1, 0.5, 0.4];
    let mut felt = 0;
    for (law, other) in CATALOGUE.iter().filter_map(|law| Some((law, law.times_direction()?))) {
        for position in (-20..20).map(|k| 0.01 * f64::from(k)) {
            let motion = Motion { time_s: 7.0, position, velocity: -0.04, direction: -0.8, ..Motion::default() };
            let (own, its) = (law.force(&motion, &values), other.force(&motion, &values) * motion.direction);
            assert_eq!(own.to_bits(), its.to_bits(), "{} at {position}", law.id());
            felt += u32::from(own != 0.0);
        }
    }
    assert!(felt > 5);
}

#[test]
fn what_goes_with_the_load_says_so() {
    let at = |position: f64, normal_force_n: f64| Motion {
        time_s: 7.0,
        position,
        velocity: -0.04,
        acceleration: 0.3,
        direction: -1.0,
        normal_force_n,
        up_along: 0.6,
    };
    for &law in CATALOGUE {
        let effect = Effect::new(law, &[0.3, 0.2, 0.1, 0.05, 0.4]);
        let goes = |place: f64| (effect.force(&at(place, 1.5)) - effect.force(&at(place, -4.0))).abs() > 1e-12;
        let places = || (-20..20).map(|k| 0.01 * f64::from(k));
        assert_eq!(places().any(goes), law.feels_load(), "{}", law.id());
    }
}

#[test]
fn stribeck_holds_at_rest_without_creep_and_breaks_away() {
    let effects =
        [Effect::new(&Inertia, &[0.1]), Effect::new(&CoulombFriction, &[0.3]), Effect::new(&Stribeck, &[0.5, 0.01])];
    let run = |drive: f64| {
        let mut motion = Motion::default();
        for _ in 0..1000 {
            (motion.position, motion.velocity) = step_coordinate(&effects, &motion, drive, 0.0, 1e-3);
        }
        motion
    };
    assert_eq!(run(0.7999).position, 0.0);
    // Away, it meets Fc alone: v = (0.81 − 0.3)/0.1 t, less the loss of the start.
    assert!(run(0.81).velocity > 3.0);
}

#[test]
fn energy_never_rises_without_work_in_any_dissipative_list() {
    let lists: [&[Effect]; 4] = [
        &[Effect::new(&CoulombFriction, &[0.1]), Effect::new(&Backlash, &[1e-3]), Effect::new(&Stribeck, &[0.1, 0.02])],
        &[Effect::new(&Hysteresis, &[0.2, 4000.0, 0.6, 0.1, 0.01]), Effect::new(&Backlash, &[5e-4])],
        &[Effect::new(&FrictionChange, &[0.1, 0.3, 1.0]), Effect::new(&LocalResistance, &[0.3, 0.02, 0.01])],
        &[Effect::new(&QuadraticDrag, &[0.5]), Effect::new(&ViscousFriction, &[0.2])],
    ];
    for list in lists {
        let mut effects = vec![Effect::new(&Inertia, &[0.05])];
        effects.extend_from_slice(list);
        let (mut motion, mut memories) = (Motion { velocity: 0.5, ..Motion::default() }, Memories::default());
        // Presliding may return its stored energy: at most ½ Fs²/σ = 1.1e-5 J, 0.02 m/s here.
        let mut fastest = 0.5_f64;
        for tick in 0..5000 {
            motion.time_s = f64::from(tick) * 1e-3;
            (motion.position, motion.velocity) = step_coordinate_with(&effects, &motion, &mut memories, 0.0, 0.0, 1e-3);
            assert!(motion.velocity.abs() <= fastest.max(0.022), "{list:?}");
            fastest = fastest.min(motion.velocity.abs());
        }
    }
}

fn finite() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -10.0..10.0_f64,
        1 => Just(0.0),
        1 => any::<f64>().prop_filter("finite", |x| x.is_finite()),
    ]
}

proptest! {
    #[test]
    fn no_finite_input_makes_a_nan(
        values in prop::array::uniform5(finite()),
        state in prop::array::uniform7(finite()),
        drive in finite(),
        steps in prop::collection::vec(finite(), 8),
        dt in 1e-6..1.0_f64,
    ) {
        let [time_s, position, velocity, acceleration, direction, normal_force_n, up_along] = state;
        let direction = direction.clamp(-1.0, 1.0);
        let mut motion = Motion { time_s, position, velocity, acceleration, direction, normal_force_n, up_along };
        for &law in CATALOGUE {
            let effects = [Effect::new(&Inertia, &[0.1]), Effect::new(&CoulombFriction, &[0.1]), Effect::new(law, &values)];
            let mut memories = Memories::default();
            for velocity in &steps {
                advance(&effects, &Motion { velocity: *velocity, ..motion }, &mut memories, dt);
                prop_assert!(memories.get(2).iter().all(|m| m.is_finite()), "{} {:?}", law.id(), memories.get(2));
            }
            prop_assert!(effects[2].force(&motion).is_finite(), "{}", law.id());
            prop_assert!(drive_force_with(&effects, &motion, &memories).is_finite(), "{}", law.id());
            for _ in 0..3 {
                let (q, v) = step_coordinate_with(&effects, &motion, &mut memories, drive, 0.0, dt);
                prop_assert!(q.is_finite() && v.is_finite(), "{} {q} {v}", law.id());
                (motion.position, motion.velocity) = (q, v);
            }
        }
    }
}
