//! Several recordings of one needle and one sheet, diagnosed together: what no single one can show is named, and nothing is named that
//! is not there.
//!
//! Each case pushes a tool in twice, at two places; it is cut in two between them. A new seed every day, as in `diagnose_tasks`.

use blind::Share;
use estimator::diagnose::{Findings, Options, Verdict, diagnose};
use haptics::recording::{Recording, Span};
use std::time::{SystemTime, UNIX_EPOCH};
use tests::tasks::needle::{Kind, make};

/// Cases of each kind.
const CASES: u64 = 6;
/// Chance of a false alarm of one assertion, a day.
const LUCK: f64 = 1e-4;

fn seed() -> u64 {
    let told = std::env::var("TOUCHSTONE_SEED").ok().and_then(|text| text.parse().ok());
    let today = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |time| time.as_secs() / 86_400);
    told.unwrap_or_else(today)
}

/// The two insertions of a case as recordings of their own, with clocks of their own.
fn halves(kind: Kind, number: u64) -> [Recording; 2] {
    let (case, _) = make(kind, seed().wrapping_mul(613).wrapping_add(number));
    let whole = &case.recordings[0];
    // On the way to the other place, 8 mm aside, the tool is far outside.
    let cut = whole.channel("x_m").expect("a tool").iter().position(|x| *x > 4e-3).expect("there are two places");
    let part = |name: &str, first: usize, end: usize| {
        let mut part = whole.slice(Span { first, end });
        name.clone_into(&mut part.name);
        let start = part.time_s.as_ref().map_or(0.0, |t| t[0]);
        part.time_s.iter_mut().flatten().for_each(|t| *t -= start);
        part
    };
    [part("first", 0, cut), part("second", cut, whole.len())]
}

fn asked(recordings: &[Recording]) -> Findings {
    diagnose(recordings, &Options::default()).expect("the tool is pushed in")
}

fn names(diagnosis: &Findings, id: &str) -> bool {
    diagnosis.causes.iter().any(|c| c.id == id)
}

/// Fails when the share is below what luck explains at a true share of `demanded`.
fn at_least(what: &str, hits: usize, of: usize, demanded: f64) {
    let share = Share { hits, of };
    println!("{what}: {share}");
    assert!(share.at_most(LUCK) >= demanded, "{what}: {share}; TOUCHSTONE_SEED={} repeats it", seed());
}

/// Friction that is another one in the second hole needs both holes.
#[test]
fn what_changes_from_one_recording_to_the_next_is_named() {
    let (mut alone, mut together) = (0, 0);
    for number in 0..CASES {
        let both = halves(Kind::Change, number);
        alone += usize::from(both.iter().any(|r| names(&asked(std::slice::from_ref(r)), "friction-change")));
        let answer = asked(&both);
        println!("{number}: {:?} {:?}", answer.causes.iter().map(|c| &c.id).collect::<Vec<_>>(), answer.warnings);
        together += usize::from(names(&answer, "friction-change"));
    }
    at_least("named together", together, CASES as usize, 0.93);
    assert!(alone <= 1, "{alone} of {CASES} named a change that one hole cannot show");
}

#[test]
fn a_sheet_that_gives_way_at_another_force_is_told_with_the_recordings() {
    let mut told = 0;
    for number in 0..CASES {
        let answer = asked(&halves(Kind::Puncture, number));
        let cause = answer.causes.iter().find(|c| c.id.starts_with("other:puncture"));
        told += usize::from(cause.is_some_and(|c| c.evidence.contains("of first") && c.evidence.contains("of second")));
    }
    at_least("told", told, CASES as usize, 0.93);
}

/// Two recordings know a curve better than one, and nothing new where nothing is.
#[test]
fn more_recordings_sharpen_and_invent_nothing() {
    let (mut named, mut sharper, mut quiet) = (0, 0, 0);
    for number in 0..CASES {
        let both = halves(Kind::Hardening, number);
        let (one, two) = (asked(&both[..1]), asked(&both));
        let error =
            |d: &Findings| d.causes.iter().find(|c| c.id == "stiffness-hardening").map(|c| c.parameters[0].std_error);
        named += usize::from(error(&two).is_some());
        sharper += usize::from(error(&two).zip(error(&one)).is_none_or(|(two, one)| two < one));
        let nothing = asked(&halves(Kind::Nothing, number));
        println!("{number}: {:?}", nothing.causes.iter().map(|c| &c.id).collect::<Vec<_>>());
        quiet += usize::from(nothing.verdict == Verdict::None);
    }
    at_least("named", named, CASES as usize, 0.93);
    at_least("sharper", sharper, CASES as usize, 0.9);
    at_least("nothing where nothing is", quiet, CASES as usize, 0.93);
}

/// What rubs by the length in the hole or at one place of it, and forces that come late, each within what it is known by.
#[test]
fn what_a_hole_does_and_forces_that_come_late_are_named() {
    for kind in [Kind::Longer, Kind::Catch, Kind::Late] {
        let (mut named, mut beside) = (0, 0);
        for number in 0..CASES {
            let (case, truth) = make(kind, seed().wrapping_mul(613).wrapping_add(number));
            let answer = asked(&case.recordings);
            let told = answer.causes.iter().find(|c| truth.hidden.contains(&c.id.as_str()));
            let near = |value: f64, of: f64| (value / of - 1.0).abs() < 0.1;
            let right = told.filter(|c| {
                truth.value.is_none_or(|(name, of)| c.parameters.iter().any(|p| p.name == name && near(p.value, of)))
            });
            println!(
                "{kind:?} {number}: {:?}",
                answer.causes.iter().map(|c| (&c.id, &c.parameters)).collect::<Vec<_>>()
            );
            named += usize::from(right.is_some());
            beside += answer.causes.len() - told.iter().count();
        }
        at_least(&format!("{kind:?}"), named, CASES as usize, 0.9);
        assert!(beside <= 2 * CASES as usize, "{kind:?}: {beside} others");
    }
}

/// A recording without a push is left out, with a word; when none has one, that is the answer.
#[test]
fn recordings_without_a_push_take_no_part() {
    let [first, second] = halves(Kind::Nothing, 77);
    let force = first.channel("fy_N").expect("a force");
    // Before anything is touched.
    let touched = force.iter().position(|f| f.abs() > 0.3).expect("it is pushed in");
    let idle = Recording { name: "idle".to_owned(), ..first.slice(Span { first: 0, end: touched / 2 }) };
    let answer = asked(&[idle.clone(), second]);
    assert!(answer.warnings.iter().any(|w| w.starts_with("idle takes no part")), "{:?}", answer.warnings);
    assert!(diagnose(&[idle.clone(), idle], &Options::default()).is_err());
}
