//! Channels with a cause in them, with one that is there only where it is fitted, and with one that has no name.

/// A channel without words.
struct NoWords;

impl Told for NoWords {}

use crate::diagnose::Variable;
use crate::diagnose::answer::build::{Evidence, answer};
use crate::diagnose::answer::part::Part;
use crate::diagnose::answer::part::Told;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::selection::channel::Channel;
use crate::diagnose::selection::comparison::View;
use crate::diagnose::selection::comparison::{ChannelFit, Compared};
use crate::diagnose::selection::held_out_gain::{gain, holds_out};
use crate::diagnose::selection::layout::Layout;
use crate::diagnose::selection::layout::Use;
use crate::diagnose::selection::rules::Rules;
use foundation::tasks::SystemState;
use haptics::law::Kind;
use rand::{RngExt as _, SeedableRng as _};
use std::f64::consts::TAU;

const ROWS: usize = 480;
const NOISE: f64 = 0.1;

fn noise(seed: u64) -> Vec<f64> {
    let mut rng = rand::rngs::StdRng::seed_from_u64(seed);
    let mut normal = move || {
        let (a, b): (f64, f64) = (rng.random_range(1e-12..1.0), rng.random());
        NOISE * (-2.0 * a.ln()).sqrt() * (TAU * b).cos()
    };
    (0..ROWS).map(|_| normal()).collect()
}

/// To and fro, as a direction of motion does.
fn to_and_fro() -> Vec<f64> {
    (0..ROWS).map(|i| if i / 7 % 2 == 0 { 1.0 } else { -1.0 }).collect()
}

fn compared(y: Vec<f64>, candidates: Vec<Candidate>) -> ChannelFit {
    let channel = Channel {
        target: y,
        baseline: vec![vec![1.0; ROWS]],
        candidates,
        layout: Layout::of(vec![0; ROWS], &[true; ROWS], 0.02),
        rules: Rules::of_observations(),
        resisting: Vec::new(),
        errors: Vec::new(),
    };
    channel.fit().expect("a constant fits")
}

fn cause() -> Candidate {
    Candidate::one("coulomb-friction", Kind::Plant, "Fc", "N", to_and_fro())
}

/// `locked`: how large it is where nothing is fitted.
fn with(size: f64, locked: f64, seed: u64) -> Vec<f64> {
    let uses = compared(noise(seed), vec![cause()]).system.uses;
    let here = |i: usize| if matches!(uses[i], Use::Locked(_)) { locked } else { size };
    noise(seed).iter().zip(to_and_fro()).enumerate().map(|(i, (n, c))| n + here(i) * c).collect()
}

#[test]
fn what_makes_more_of_an_error_where_it_was_not_fitted_is_no_cause() {
    for seed in 0..4 {
        let there = compared(with(0.05, 0.05, seed), vec![cause()]);
        assert_eq!(there.picks(), [0], "seed {seed}");
        let not_there = compared(with(0.05, -0.05, seed), vec![cause()]);
        assert!(not_there.picks().is_empty(), "seed {seed}: {:?}", not_there.chosen);
    }
}

#[test]
fn a_floor_above_what_is_left_makes_no_share_certain() {
    let study = compared(with(0.08, 0.08, 1), vec![cause()]);
    let true_floor = gain(&study, 0, 0.9 * NOISE);
    // Measured where more was going on than noise.
    let high = gain(&study, 0, 1.5 * NOISE);
    for gain in [&true_floor, &high] {
        assert!(gain.no_share.is_none() && (0.4..=1.0).contains(&gain.share_of_explainable), "{gain:?}");
        assert!(gain.interval[0] < 0.999 && gain.interval[0] > 0.0, "{gain:?}");
    }
}

#[test]
fn what_no_held_out_row_could_show_has_no_share() {
    let uses = compared(noise(2), vec![cause()]).system.uses;
    let mut late = to_and_fro();
    late.iter_mut().zip(&uses).filter(|(_, u)| matches!(u, Use::Locked(_))).for_each(|(c, _)| *c = 0.0);
    let y: Vec<f64> = noise(2).iter().zip(&late).map(|(n, c)| n + 0.2 * c).collect();
    let only_fitted = Candidate::one("coulomb-friction", Kind::Plant, "Fc", "N", late);
    let study = compared(y, vec![only_fitted]);
    // Not asked, it is not refuted either.
    assert_eq!(study.picks(), [0]);
    let gain = gain(&study, 0, NOISE);
    assert!(gain.no_share.is_some() && gain.share_of_explainable == 0.0 && gain.interval == [0.0; 2], "{gain:?}");
}

#[test]
fn what_has_no_name_has_a_gain_and_a_size() {
    let wave: Vec<f64> = (0..ROWS).map(|i| (0.05 * i as f64).cos()).collect();
    let y: Vec<f64> = noise(3).iter().zip(&wave).map(|(n, c)| n + 0.1 * c).collect();
    let expression = Some("cos(0.05 i)".to_owned());
    let strange = Candidate { expression, ..Candidate::one("other", Kind::Plant, "amplitude", "", wave) };
    let study = compared(y, vec![strange]);
    let (along, state) = (vec![true; ROWS], vec![SystemState::Turning; ROWS]);
    let view = View::of(Vec::new(), Vec::new(), |_| Variable::Place);
    let compared = Compared { study, channel: "something", unit: "N", floor: NOISE, along, state, view };
    let part = Part::of(&compared, &NoWords);
    let found = answer(&[part], Evidence::default());
    let [cause] = found.causes.as_slice() else { panic!("{:?}", found.causes) };
    assert!(cause.gain.share_of_explainable > 0.5 && cause.gain.unit.as_deref() == Some("N"), "{cause:?}");
    assert!(cause.posterior > 0.9 && (cause.parameters[0].value - 0.1).abs() < 0.03, "{cause:?}");
    assert!(cause.evidence.contains("something"), "{}", cause.evidence);
}

/// The first rows of the same, too few to keep any out of the choice.
fn short(size: f64, seed: u64) -> ChannelFit {
    const FEW: usize = 44;
    let (noise, column) = (noise(seed), to_and_fro());
    let channel = Channel {
        target: noise.iter().zip(&column).map(|(n, c)| n + size * c).take(FEW).collect(),
        baseline: vec![vec![1.0; FEW]],
        candidates: vec![Candidate::one("coulomb-friction", Kind::Plant, "Fc", "N", column[..FEW].to_vec())],
        layout: Layout::of(vec![0; FEW], &[true; FEW], 0.02),
        rules: Rules::of_observations(),
        resisting: Vec::new(),
        errors: Vec::new(),
    };
    channel.fit().expect("a constant fits")
}

#[test]
fn where_nothing_can_be_kept_out_of_the_choice_a_cause_must_be_beyond_doubt() {
    for seed in 0..12 {
        let found = short(0.3, seed);
        assert!(!holds_out(&found) && found.picks() == [0], "seed {seed}");
        let worth = gain(&found, 0, NOISE);
        assert!(
            worth.in_turn && worth.share_of_explainable > 0.8 && worth.no_share.is_none(),
            "seed {seed}: {worth:?}"
        );
        let small = short(0.08, seed);
        assert!(
            small.chosen.iter().all(|c| c.score >= small.rules.confirmed * small.rules.threshold),
            "seed {seed}: {:?}",
            small.chosen
        );
    }
}

/// Friction that rises near rest is a change of friction: without any, a falling-off and a rising curve would together
/// pass for a constant.
#[test]
fn what_lifts_dry_friction_is_not_asked_for_where_there_is_none() {
    let speed = |i: usize| 0.3 + 0.25 * (i as f64 / 40.0).sin();
    let lifted = |share: f64| (0..ROWS).map(|i| share * (-(speed(i) / 0.5).powi(2)).exp()).collect::<Vec<f64>>();
    let asked = |is_dry: bool| {
        let channel = Channel {
            target: lifted(1.0).iter().zip(noise(3)).map(|(a, b)| a + b).collect(),
            baseline: Vec::new(),
            candidates: vec![Candidate::one("stribeck", Kind::Plant, "dmu", "1", lifted(1.0)).positive()],
            layout: Layout::of(vec![0; ROWS], &[true; ROWS], 0.02),
            rules: Rules::of_observations().with_friction(is_dry),
            resisting: Vec::new(),
            errors: Vec::new(),
        };
        channel.fit()
    };
    assert_eq!(asked(true).expect("a curve").picks(), [0]);
    assert!(asked(false).expect("a curve").picks().is_empty());
}

/// A law that is nearly the model's own must not be given to the model where the whitening is learnt.
#[test]
fn a_cause_beside_a_term_of_the_model_that_is_nearly_the_same_keeps_its_size() {
    let direction = to_and_fro();
    let slow = |i: usize| if i < ROWS / 2 { 0.9 } else { 1.1 };
    let load: Vec<f64> = direction.iter().enumerate().map(|(i, d)| slow(i) * d).collect();
    let channel = Channel {
        target: load.iter().zip(&direction).zip(noise(5)).map(|((l, d), n)| 10.0 * l + 10.0 * d + n).collect(),
        baseline: vec![load],
        candidates: vec![Candidate::one("coulomb-friction", Kind::Plant, "Fc", "N", direction).positive()],
        layout: Layout::of(vec![0; ROWS], &[true; ROWS], 0.02),
        rules: Rules::of_observations(),
        resisting: Vec::new(),
        errors: Vec::new(),
    };
    let study = channel.fit().expect("two terms");
    let strongest = study.system.coefficients.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
    assert!(study.picks() == [0] && strongest < 0.3, "{:?}", study.system.coefficients);
}

/// Single observations are held out three at a time and need no margin between training and held-out rows.
#[test]
fn a_dozen_of_single_observations_can_be_tested() {
    let n = 16;
    let channel = Channel {
        target: (0..n).map(|i| if i % 2 == 0 { 2.0 } else { 1.0 } + 0.1 * noise(7)[i]).collect(),
        baseline: Vec::new(),
        candidates: vec![Candidate::one(
            "velocity-loss",
            Kind::Plant,
            "e",
            "1",
            (0..n).map(|i| if i % 2 == 0 { 2.0 } else { 1.0 }).collect(),
        )],
        layout: Layout::of((0..n).collect(), &vec![true; n], 1.0),
        rules: Rules::of_observations(),
        resisting: Vec::new(),
        errors: Vec::new(),
    };
    let study = channel.fit().expect("a line");
    assert_eq!(study.picks(), [0]);
    let locked = study.system.uses.iter().filter(|u| matches!(u, Use::Locked(_))).count();
    assert!(locked > 0 && study.system.uses.iter().all(|u| *u != Use::Guard), "{:?}", study.system.uses);
}
