//! Structured force that no law describes: a catalogue cause is not certain because of it, and a hidden one is still found.

use blind::certain::{Alone, Beside};
use blind::sets::{StructureCounts, structured};
use blind::{Counted, Row, Share, ask};
use estimator::diagnose::{Verdict, diagnose};

/// A seed on which nothing was chosen.
const SEED: u64 = 4711;
/// Probability of a worse result by chance, beyond which the test fails.
const LUCK: f64 = 0.01;

fn rows() -> Vec<Row> {
    let counts = StructureCounts { cranks: [2, 1], long_cranks: [1, 1], mechanisms: [2, 1] };
    ask(&structured(counts, SEED), &|recordings, options| diagnose(recordings, options).map_err(|e| e.to_string()))
}

fn at_most(name: &str, share: Share, demanded: f64) {
    assert!(share.of > 0, "{name}: no case");
    assert!(share.at_least(LUCK) <= demanded, "{name}: {share}, demanded at most {demanded}");
}

fn at_least(name: &str, share: Share, demanded: f64) {
    assert!(share.of > 0, "{name}: no case");
    assert!(share.at_most(LUCK) >= demanded, "{name}: {share}, demanded at least {demanded}");
}

#[test]
fn structure_gives_no_certain_name_and_hides_none() {
    let rows = rows();
    let of = |keep: &dyn Fn(&Row) -> bool| -> Vec<&Row> { rows.iter().filter(|r| keep(r)).collect() };
    for (name, own, demanded) in [
        ("cranks of 20 s", of(&|r| r.bench.is_crank() && r.seconds < 40.0), 0.02),
        ("cranks of 60 s", of(&|r| r.bench.is_crank() && r.seconds > 40.0), 0.05),
        ("mechanisms", of(&|r| !r.bench.is_crank()), 0.015),
    ] {
        let alone = Alone::of(&own);
        at_most(&format!("{name}: false certain names"), alone.fair, demanded);
        at_most(&format!("{name}: ambiguous"), alone.ambiguous, 0.1);
        assert!(alone.floor <= 1.3, "{name}: the structure raises the noise floor {:.2} times", alone.floor);
        let beside = Beside::of(&own);
        at_least(&format!("{name}: right, or in the stated set"), beside.in_set, 0.9);
        assert!(beside.false_certain[1] <= 0.2, "{name}: {} false certain names a case", beside.false_certain[1]);
    }
    let names = rows.iter().flat_map(Row::names).filter(|n| n.posterior >= 0.95 && !n.is_tolerated);
    at_least("names said with 95 %", Share::count(names, |n| n.is_right), 0.93);
}

#[test]
fn a_structured_force_is_stated_with_its_size_and_variables() {
    let counts = StructureCounts { cranks: [1, 0], long_cranks: [0, 0], mechanisms: [0, 0] };
    let jobs = structured(counts, SEED + 1);
    let found = ask(&jobs, &|recordings, options| diagnose(recordings, options).map_err(|e| e.to_string()));
    let stated = found.iter().filter(|r| {
        let answer = r.answer.as_ref().expect("it can be diagnosed");
        let error = answer.model_error.as_ref();
        answer.verdict == Verdict::Unexplained && error.is_some_and(|e| e.rms_n > 0.0 && !e.over.is_empty())
    });
    assert!(2 * stated.count() > found.len(), "most structures are seen");
}
