//! What an answer about a needle or a switch leaves open: the scripted operator rehearses what was asked for on every object that is not
//! excluded, and what a hand of our own then does on the hidden one leaves only what is hidden.

use app::experiment::like::Like;
use app::experiment::rehearse::{Rehearsal, rehearse};
use app::experiment::timetable::Timetable;
use estimator::diagnose::{Experiment, Findings, Verdict, diagnose, suspects};
use haptics::recording::Recording;
use tests::tasks::{Case, needle, switch};

/// Answers, rehearses with every suspect, and does it in truth; what is left must be `hidden` alone.
fn goes_through(case: &Case, hidden: &str, other: &str, perform: &dyn Fn(&Experiment) -> Option<Recording>) {
    let alone = diagnose(&case.recordings, &case.options).expect("an answer");
    assert_eq!(alone.verdict, Verdict::Ambiguous, "{:?}", ids(&alone));
    assert!(is_open(&alone, hidden) && is_open(&alone, other), "{:?} or {:?}", ids(&alone), alone.alternatives);
    let next = alone.next_experiment.clone().expect("something to record");
    let asked = next.experiment.clone().expect("a motion for a program");
    assert!((0.5..1.0).contains(&next.expected_power), "{}", next.expected_power);
    let with = |more: &Recording| {
        let both: Vec<Recording> = case.recordings.iter().chain([more]).cloned().collect();
        diagnose(&both, &case.options).map_err(|error| error.to_string())
    };
    let objects = suspects(&case.recordings, &case.options, &alone).expect("worlds");
    for object in &objects {
        let by_hand = Timetable::new(&object.world, &asked, &next.motion);
        assert!(by_hand.is_ok_and(|t| t.steps.len() > 4), "a person can do it in Train as if {}", object.id);
    }
    let like = Like { recording: &case.recordings[0], noise_n: alone.noise_floor_n };
    let rehearsed = rehearse(&objects, &next, (2, like), &with, &|_| true).expect("rehearsed");
    for id in [hidden, other] {
        let outcome = rehearsed.outcomes.iter().find(|o| o.id == id).expect("it is open");
        let came_out: Vec<_> = outcome.rounds.iter().map(|r| (&r.named, &r.open)).collect();
        assert_eq!(outcome.settled(), 2, "{id}: {came_out:?} {:?}", outcome.problem);
    }
    assert!(share_settled(&rehearsed) > 0.5, "{:?}", rehearsed.settled());
    let answer = with(&perform(&asked).expect("the hand knows the motion")).expect("an answer");
    assert!(
        ids(&answer).contains(&hidden) && !is_open(&answer, other),
        "{:?} or {:?}",
        ids(&answer),
        answer.alternatives
    );
}

fn share_settled(rehearsal: &Rehearsal) -> f64 {
    let (settled, all) = rehearsal.settled();
    settled as f64 / all.max(1) as f64
}

fn ids(answer: &Findings) -> Vec<&str> {
    answer.causes.iter().map(|c| c.id.as_str()).collect()
}

fn is_open(answer: &Findings, id: &str) -> bool {
    answer.causes.iter().any(|c| c.id == id) || answer.alternatives.iter().any(|a| a.id == id)
}

#[test]
fn at_one_speed_a_hole_that_drags_looks_like_one_that_rubs_until_the_needle_goes_slowly_and_fast() {
    for (kind, hidden, other) in [
        (needle::Kind::Shaft, "coulomb-friction", "viscous-friction"),
        (needle::Kind::Drag, "viscous-friction", "coulomb-friction"),
    ] {
        let (case, _) = needle::at_one_speed(kind, 1);
        goes_through(&case, hidden, other, &|asked| needle::as_asked(kind, 1, asked, 7));
    }
}

#[test]
fn thrown_to_one_side_a_knob_that_rubs_more_both_ways_looks_like_one_that_rubs_more_one_way() {
    for (kind, hidden, other) in [
        (switch::Kind::Coulomb, "coulomb-friction", "friction-asymmetry"),
        (switch::Kind::OneWay, "friction-asymmetry", "coulomb-friction"),
    ] {
        let (case, _) = switch::to_one_side(kind, 3);
        goes_through(&case, hidden, other, &|asked| switch::as_asked(kind, 3, asked, 7));
    }
}
