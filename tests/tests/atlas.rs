//! The residual atlas of tasks without one coordinate: what was hidden stands there as a suspect of its channel, over the variable that it is best
//! seen against, and what it takes is what was left over.

use estimator::diagnose::Variable;
use estimator::diagnose::atlas::{Against, Channel};
use estimator::diagnose::{Findings, Options, diagnose};
use haptics::recording::{Channel as Column, Recording, Task};
use tests::tasks::{Case, needle, switch, throw};

/// The answer with its atlas.
fn answered(case: &Case) -> Findings {
    let options = Options { atlas: true, ..case.options.clone() };
    diagnose(&case.recordings, &options).expect("it can be diagnosed")
}

/// The suspect of this name, in the channel where it has most evidence.
fn suspect<'a>(answer: &'a Findings, id: &str) -> (&'a Channel, &'a Against) {
    let all = answer.atlas.channels.iter().flat_map(|c| c.suspects.iter().map(move |s| (c, s)));
    let of_id = all.filter(|(_, s)| s.id == id);
    of_id.max_by(|a, b| a.1.score.total_cmp(&b.1.score)).unwrap_or_else(|| panic!("{id} is no suspect"))
}

/// What is left where a suspect could be, before and after it took its part: mean squares.
fn left_over((channel, suspect): (&Channel, &Against)) -> (f64, f64) {
    let n = suspect.rows.len() as f64;
    let parts = suspect.rows.iter().zip(&suspect.taken).map(|(row, taken)| (channel.left[*row], *taken));
    let (before, after) = parts.fold((0.0, 0.0), |(b, a), (left, t)| (b + left * left, a + (left - t).powi(2)));
    (before / n, after / n)
}

/// Every channel is whole, and the hidden cause takes most of what is left of its own.
fn look(what: &str, answer: &Findings, id: &str, variable: Variable, most_left: f64) {
    for channel in &answer.atlas.channels {
        let n = channel.left.len();
        assert!(channel.recording.is_empty() || channel.recording.len() == n, "{what}: {}", channel.name);
        assert!(channel.way.is_empty() || channel.way.len() == n, "{what}: {}", channel.name);
        for s in &channel.suspects {
            assert!(s.rows.len() == s.over.len() && s.rows.len() == s.taken.len(), "{what}: {}", s.id);
            assert!(s.rows.iter().all(|row| *row < n) && s.over.iter().all(|v| v.is_finite()), "{what}: {}", s.id);
        }
        assert!(channel.suspects.is_sorted_by(|a, b| a.score >= b.score), "{what}: most evidence first");
    }
    let found = suspect(answer, id);
    assert_eq!(found.1.variable, variable, "{what}");
    let (before, after) = left_over(found);
    assert!(after < most_left * before, "{what}: {id} leaves {after:.3e} of {before:.3e} in the {}", found.0.name);
    assert!(found.1.score > 20.0, "{what}: it scores {}", found.1.score);
}

#[test]
fn needles_have_an_atlas_of_sheet_and_shaft() {
    let cases = [
        (needle::Kind::Hardening, "stiffness-hardening", Variable::Depth, 0.5),
        (needle::Kind::Dent, "hysteresis", Variable::Depth, 0.6),
        (needle::Kind::Shaft, "coulomb-friction", Variable::Velocity, 0.5),
        (needle::Kind::Drift, "force-drift", Variable::Time, 0.9),
    ];
    for (kind, id, variable, most_left) in cases {
        let answer = answered(&needle::make(kind, 411).0);
        look(&format!("{kind:?}"), &answer, id, variable, most_left);
        assert!(answer.atlas.channels.iter().any(|c| c.name == "force on the shaft"), "{kind:?}");
    }
}

#[test]
fn switches_have_an_atlas_of_throws_curve_and_stops() {
    let cases = [
        (switch::Kind::Viscous, "viscous-friction", Variable::Velocity, 0.9),
        (switch::Kind::Change, "friction-change", Variable::Time, 0.97),
        (switch::Kind::Bind, "local-resistance", Variable::Place, 0.9),
        (switch::Kind::Hardening, "stiffness-hardening", Variable::Force, 0.9),
    ];
    for (kind, id, variable, most_left) in cases {
        let answer = answered(&switch::make(kind, 413).0);
        look(&format!("{kind:?}"), &answer, id, variable, most_left);
    }
}

#[test]
fn thrown_bodies_have_an_atlas_of_all_slides_and_of_all_impacts() {
    let answer = answered(&throw::make(throw::Kind::Dry, 417).0);
    look("dry", &answer, "load-friction", Variable::Time, 0.5);
    assert!(suspect(&answer, "load-friction").0.recording.is_empty(), "all slides together");
    let answer = answered(&throw::make(throw::Kind::Loss, 417).0);
    look("loss", &answer, "velocity-loss", Variable::Velocity, 0.7);
    // A wrong scale is told from the falls themselves: it is named, and no channel has it.
    let answer = answered(&throw::make(throw::Kind::Scale, 417).0);
    assert!(answer.causes.iter().any(|c| c.id == "length-scale"));
    assert!(answer.atlas.channels.iter().flat_map(|c| &c.suspects).all(|s| s.id != "length-scale"));
}

fn column(name: &str, values: Vec<f64>) -> Column {
    Column { name: name.to_owned(), unit: String::new(), values }
}

/// Evenly spread numbers around zero, of variance 1: the additive recurrence of the golden ratio, through the sum of four.
fn noise(k: usize) -> f64 {
    let one = |j: usize| ((4 * k + j) as f64 * 0.754_877_666_246_693).fract() - 0.5;
    (0..4).map(one).sum::<f64>() * 3.0_f64.sqrt()
}

#[test]
fn a_transmissions_lost_motion_stands_over_its_input_by_direction() {
    const HALF_GAP: f64 = 0.02;
    let time: Vec<f64> = (0..6_000).map(|k| f64::from(k) * 0.005).collect();
    let input: Vec<f64> = time.iter().map(|t| (1.1 * t).sin() + 0.3 * (2.7 * t).sin()).collect();
    let mut place = input[0];
    let output: Vec<f64> = input
        .iter()
        .enumerate()
        .map(|(k, q)| {
            place = f64::clamp(place, q - HALF_GAP, q + HALF_GAP);
            0.5 * place + 2e-4 * noise(k)
        })
        .collect();
    let mut recording = Recording {
        name: "gears".to_owned(),
        time_s: Some(time),
        channels: vec![column("q_rad", input), column("q_out_rad", output)],
        ..Recording::default()
    };
    recording.meta.task = Some(Task::Mechanism);
    let answer = answered(&Case { recordings: vec![recording], options: Options::default() });
    look("gears", &answer, "backlash", Variable::Place, 0.3);
    let (channel, found) = suspect(&answer, "backlash");
    assert!(channel.is_angular && !channel.way.is_empty());
    // Forwards the output is behind, backwards ahead: what the suspect takes says so.
    let mean = |sign: f64| {
        let own: Vec<f64> =
            found.rows.iter().zip(&found.taken).filter(|(r, _)| channel.way[**r] * sign > 0.3).map(|p| *p.1).collect();
        own.iter().sum::<f64>() / own.len() as f64
    };
    assert!(
        (mean(1.0) + 0.5 * HALF_GAP).abs() < 0.2 * HALF_GAP && (mean(-1.0) - 0.5 * HALF_GAP).abs() < 0.2 * HALF_GAP
    );
}

#[test]
fn a_path_without_a_clock_has_an_atlas_over_its_way() {
    const RADIUS_M: f64 = 0.5;
    let angle: Vec<f64> = (0..900).map(|k| 0.2 + 1.3 * f64::from(k) / 899.0).collect();
    // A latch that is passed, beside some friction.
    let force = |q: f64| 2.0 + 6.0 * (-0.5 * ((q - 0.5) / 0.08).powi(2)).exp();
    let at = |of: &dyn Fn(usize, f64) -> f64| angle.iter().enumerate().map(|(k, q)| of(k, *q)).collect::<Vec<f64>>();
    let mut recording = Recording {
        name: "door".to_owned(),
        time_s: None,
        channels: vec![
            column("x_m", at(&|k, q| RADIUS_M * q.cos() + 2e-4 * noise(k))),
            column("y_m", at(&|k, q| RADIUS_M * q.sin() + 2e-4 * noise(k + 7_001))),
            column("fx_N", at(&|k, q| -force(q) * q.sin() + 0.2 * noise(k + 14_003))),
            column("fy_N", at(&|k, q| force(q) * q.cos() + 0.2 * noise(k + 21_001))),
        ],
        ..Recording::default()
    };
    recording.meta.task = Some(Task::Mechanism);
    let answer = answered(&Case { recordings: vec![recording], options: Options::default() });
    look("door", &answer, "local-resistance", Variable::Place, 0.3);
    let (channel, _) = suspect(&answer, "local-resistance");
    assert!(channel.is_angular && channel.unit == "N m");
}
