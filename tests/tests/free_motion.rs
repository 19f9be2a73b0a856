//! Diagnoses of what moves without a force column: pendulums, carts, masses on springs. The generator (`tests/src/free_motion.rs`) has an
//! integrator, forms and sensors of its own.
//!
//! `TOUCHSTONE_TASK_CASES=40 cargo test --release -p tests --test free_motion -- --nocapture` prints the figures of
//! `docs/diagnosis.md`; without the number there is one case of each.

use estimator::diagnose::{Findings, Options, Verdict, diagnose, extended_world, validate};
use haptics::law::Role;
use haptics::recording::{Channel, Recording};
use rayon::prelude::*;
use tests::free_motion::{Case, Hidden};

fn asked(recording: &Recording, baseline: Option<&str>) -> Findings {
    let options = Options { baseline: baseline.map(str::to_owned), ..Options::default() };
    diagnose(std::slice::from_ref(recording), &options).expect("a free motion can be diagnosed")
}

/// A pendulum as one would build it: 1 rad, 200 Hz, a tenth of a degree.
fn pendulum(seed: u64, hidden: Hidden, size: f64) -> Case {
    Case {
        inertia: 0.01,
        moment: 0.25,
        viscous: 0.001,
        dry: 0.002,
        size,
        more: 0.4,
        zero_rad: 0.0,
        start: [1.0, 0.0],
        seconds: 25.0,
        rate_hz: 200.0,
        noise: 2e-4,
        step: 1e-5,
        rate_noise: None,
        known: vec![("inertia_kg_m2".to_owned(), 0.01)],
        ..Case::pendulum(seed, hidden, 1.0)
    }
}

#[test]
fn nothing_is_said_of_objects_without_anything_hidden() {
    let pendulums = (500..516).map(|seed| Case::pendulum(seed, Hidden::Nothing, 0.0));
    let cases: Vec<Case> = pendulums.chain((500..508).map(|seed| Case::cart(seed, Hidden::Nothing, 0.0))).collect();
    let loud: Vec<(u64, Vec<String>)> = cases
        .par_iter()
        .map(|case| (case.seed, asked(&case.recording(), None)))
        .filter(|(_, found)| found.verdict != Verdict::None)
        .map(|(seed, found)| (seed, found.diagnosis.causes.into_iter().map(|c| c.id).collect()))
        .collect();
    assert!(loud.is_empty(), "{loud:?}");
}

/// A cause, its size, the baseline, and its name.
type Kind = (Hidden, f64, Option<&'static str>, &'static str);

#[test]
fn what_is_hidden_in_a_pendulum_is_named_with_its_size() {
    let kinds: [Kind; 6] = [
        (Hidden::Viscous, 0.001, Some("mass"), "viscous-friction"),
        (Hidden::Coulomb, 0.002, Some("mass+viscous"), "coulomb-friction"),
        (Hidden::Drag, 0.001, None, "quadratic-drag"),
        (Hidden::Spring, 0.05, None, "return-spring"),
        (Hidden::Wall, 1.0, None, "added-constraint"),
        (Hidden::Place, 0.006, None, "local-resistance"),
    ];
    kinds.par_iter().for_each(|(hidden, size, baseline, id)| {
        let found = asked(&pendulum(1, *hidden, *size).recording(), *baseline);
        let cause = found.causes.iter().find(|c| c.id == *id).unwrap_or_else(|| panic!("{id}: {:?}", found.causes));
        let parameter = &cause.parameters[0];
        let off = (parameter.value - size).abs();
        assert!(off < 0.15 * size, "{id}: {parameter:?}, {size} is hidden");
        assert!(cause.evidence.contains("what the model leaves of the motion"), "{}", cause.evidence);
        if ["quadratic-drag", "return-spring"].contains(id) {
            assert!(off < 4.0 * parameter.std_error, "{parameter:?}");
        }
        if *id == "return-spring" {
            let forward = cause.gain.rollout.as_ref().expect("it can be run forward");
            assert!(forward.unit == "rad" && forward.interval[0] > 0.0, "{forward:?}");
        }
    });
}

#[test]
fn a_known_gravity_moment_gives_the_inertia_beside_a_hidden_spring() {
    let case = Case {
        known: vec![("mass_kg".to_owned(), 0.107), ("com_m".to_owned(), 0.25 / 9.81 / 0.107)],
        ..pendulum(2, Hidden::Spring, 0.05)
    };
    let turned = Case { zero_rad: -1.5, known: Vec::new(), ..case.clone() };
    let [known, unknown] = [case, turned].map(|case| asked(&case.recording(), None));
    let stiffness = |found: &Findings| found.causes.first().expect("a spring").parameters[0].clone();
    let of = |found: &Findings| found.effects.iter().find(|e| e.role() == Role::Inertia).expect("an inertia").values[0];
    assert!((of(&known) - 0.01).abs() < 2e-4, "{}", of(&known));
    assert!((stiffness(&known).value - 0.05).abs() < 4.0 * stiffness(&known).std_error, "{known:?}");
    // Measured from the horizontal, and nothing known: per unit of inertia, with units that say so.
    assert_eq!(unknown.causes[0].id, "return-spring");
    assert!((stiffness(&unknown).value - 5.0).abs() < 4.0 * stiffness(&unknown).std_error, "{:?}", unknown.causes);
    assert_eq!(unknown.baseline.unit.as_deref(), Some("rad/s²"));
    assert_eq!(stiffness(&unknown).unit, "1/s²");
    assert!(unknown.warnings[0].contains("nothing is known"), "{:?}", unknown.warnings);
    assert_eq!(of(&unknown).to_bits(), 1.0_f64.to_bits());
}

#[test]
fn a_mass_on_a_spring_a_slope_and_the_air_of_a_cart_are_named() {
    let kinds = [
        (Hidden::Spring, "return-spring", "k"),
        (Hidden::Tilt, "gravity-tilt", "angle"),
        (Hidden::Drag, "quadratic-drag", "k"),
    ];
    kinds.par_iter().for_each(|(hidden, id, name)| {
        let like = Case::cart(600, *hidden, 1.0);
        let known = vec![("mass_kg".to_owned(), like.inertia)];
        let case = Case { noise: 2e-5, step: 1e-6, rate_hz: 200.0, rate_noise: None, known, ..like };
        let found = asked(&case.recording(), None);
        let cause = found.causes.first().unwrap_or_else(|| panic!("{id}: {found:?}"));
        // A slope and friction by direction are one and the same constant force.
        let as_well = *id == "gravity-tilt" && found.alternatives.iter().any(|a| a.id == *id);
        assert!(cause.id == *id || as_well, "{id}: {:?}", found.causes);
        if cause.id == *id {
            let value = cause.parameters.iter().find(|p| p.name == *name).expect("its size").value;
            assert!((value - case.size).abs() < 0.05 * case.size, "{id}: {value}, {} is hidden", case.size);
        }
    });
}

#[test]
fn what_no_free_motion_shows_is_said_and_nothing_asks_for_a_hand() {
    let found = asked(&pendulum(3, Hidden::Drag, 0.001).recording(), None);
    for id in ["force-gain", "force-bias"] {
        let hidden = found.not_excited.iter().find(|n| n.id == id).unwrap_or_else(|| panic!("{id} was not said"));
        assert!(hidden.why.contains("no force column"), "{}", hidden.why);
    }
    let said = serde_json::to_string(&found.diagnosis).expect("JSON");
    for word in ["squeez", "pull", "grip", "force sensor's"] {
        assert!(!said.contains(word), "`{word}` is said of what nobody touches: {said}");
    }
    assert!(found.baseline.model.starts_with("inertia+eccentric-mass+"), "{}", found.baseline.model);
    assert!(found.diagnosis.next_experiment.is_none_or(|next| next.experiment.is_none()));
}

#[test]
fn an_answer_holds_on_another_swing_and_in_a_world() {
    let recording = pendulum(4, Hidden::Drag, 0.002).recording();
    let options = Options::default();
    let found = asked(&recording, None);
    let others = [Case { start: [0.7, 0.5], ..pendulum(5, Hidden::Drag, 0.002) }.recording()];
    let on = validate(&others, &options, &found).expect("figures");
    assert!(on[0].share > 0.5 && on[0].interval[0] > 0.0, "{on:?}");
    let world = extended_world(std::slice::from_ref(&recording), &options, &found).expect("a world");
    let laws = &world.mechanism.as_ref().expect("a mechanism").effects;
    let ids: Vec<&str> = laws.iter().map(|e| e.law().id()).collect();
    assert_eq!(ids, ["inertia", "eccentric-mass", "viscous-friction", "coulomb-friction", "quadratic-drag"]);
    world.check().expect("it can be stepped");
    // From that world nothing is left to find.
    let again =
        diagnose(&others, &Options { world: Some(world), ..Options::default() }).expect("it can be asked again");
    assert_eq!(again.verdict, Verdict::None, "{:?}", again.causes);
}

#[test]
fn driven_and_free_recordings_are_asked_apart() {
    let free = pendulum(6, Hidden::Nothing, 0.0).recording();
    let mut driven = free.clone();
    let values = vec![0.0; driven.len()];
    driven.channels.push(Channel { name: "tau_Nm".to_owned(), unit: "N m".to_owned(), values });
    let said = diagnose(&[free, driven], &Options::default()).expect_err("two kinds").to_string();
    assert!(said.contains("some recordings have a force column"), "{said}");
}

/// How a case is made out of a seed, what is hidden and how large that is.
type Make = fn(u64, Hidden, f64) -> Case;

#[test]
fn figures() {
    let count = std::env::var("TOUCHSTONE_TASK_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(1_u64);
    let makes: [(&str, Make); 2] = [("pendulum", Case::pendulum), ("cart", Case::cart)];
    let of_pendulums = [
        (Hidden::Nothing, None, ""),
        (Hidden::Viscous, Some("mass"), "viscous-friction"),
        (Hidden::Coulomb, Some("mass+viscous"), "coulomb-friction"),
        (Hidden::Drag, None, "quadratic-drag"),
        (Hidden::Spring, None, "return-spring"),
        (Hidden::Stribeck, None, "stribeck"),
        (Hidden::Change, None, "friction-change"),
        (Hidden::Place, None, "local-resistance"),
        (Hidden::Ripple, None, "position-ripple"),
        (Hidden::Wall, None, "added-constraint"),
        (Hidden::Tilt, None, "gravity-tilt"),
    ];
    for (object, make) in makes {
        for (hidden, baseline, id) in of_pendulums {
            let cart = object == "cart";
            if cart && matches!(hidden, Hidden::Wall | Hidden::Change) || !cart && hidden == Hidden::Tilt {
                continue;
            }
            for size in if hidden == Hidden::Nothing { vec![0.0] } else { vec![1.0, 4.0] } {
                let answers: Vec<Findings> = (7000..7000 + count)
                    .into_par_iter()
                    .map(|seed| asked(&make(seed, hidden, size).recording(), baseline))
                    .collect();
                let is = |of: &dyn Fn(&Findings) -> bool| answers.iter().filter(|found| of(found)).count();
                let silent = is(&|found| found.verdict == Verdict::None);
                let named = is(&|found| found.causes.iter().any(|c| c.id == id));
                let within = is(&|found| {
                    found.causes.iter().any(|c| c.id == id) || found.alternatives.iter().any(|a| a.id == id)
                });
                let own = |c: &str| c == id || baseline.is_some() && c == "coulomb-friction";
                let others = is(&|found| found.causes.iter().any(|c| !own(&c.id)));
                println!(
                    "{object} {hidden:?} {size}: silent {silent}, named {named}, within {within}, beside {others}, of {count}"
                );
                assert!(
                    hidden != Hidden::Nothing || 50 * (count as usize - silent) <= count as usize,
                    "nulls must stay silent"
                );
            }
        }
    }
}

/// What has come to rest is held by dry friction, which is anything up to its size there: the fit must not take it for motion.
#[test]
fn a_slide_that_comes_to_rest_shows_its_friction_by_where_it_moved() {
    let z: Vec<[f64; 2]> = (900..924)
        .into_par_iter()
        .map(|seed| {
            let like = Case::cart(seed, Hidden::Nothing, 0.0);
            let case = Case {
                // A second and more of standstill, and a usual encoder.
                seconds: like.seconds + 2.0,
                viscous: 5.0 * like.viscous,
                rate_hz: 200.0,
                noise: 2e-6,
                step: 1e-6,
                rate_noise: None,
                known: vec![("mass_kg".to_owned(), like.inertia)],
                ..like
            };
            let fit = estimator::identify::mechanism::fit(&[case.recording()]).expect("it moves");
            let off = |name: &str, truth: f64| {
                let found = fit.parameter("mechanism", name).unwrap_or_else(|| panic!("{name}: {:?}", fit.parameters));
                (found.value.expect("shown") - truth) / found.std_error.expect("has one")
            };
            assert!(!fit.parameter("mechanism", "coulomb_N").is_some_and(|p| p.identified), "one way shows no sign");
            [off("viscous_N_s_m", case.viscous), off("resistance_N", case.dry)]
        })
        .collect();
    println!("errors in standard errors: {z:.1?}");
    let far = z.iter().flatten().filter(|z| z.abs() > 3.0).count();
    assert!(far <= 2, "{far} of {} beyond three errors: {z:.1?}", 2 * z.len());
}
