//! The blind battery in a minute: what is hidden must be named, and nothing where nothing is.
//!
//! A new seed every day, printed for replay: `TOUCHSTONE_SEED=20400 cargo test -p tests --test blind`. The whole battery is
//! `touchstone bench blind`. Demands leave room for the luck of few cases: a test fails when so few hits
//! would come up once in ten thousand days if the program were as good as demanded. What is demanded here is what the program reaches
//! so far; what it should reach stands in `docs/diagnosis.md`.

use blind::{Counts, Experiments, Figures, Row, Set, Share, ask, battery, report};
use estimator::diagnose::diagnose;
use std::sync::OnceLock;
use std::time::{SystemTime, UNIX_EPOCH};

/// Chance of a false alarm of one assertion, a day.
const LUCK: f64 = 1e-4;

/// Days since 1970, unless told.
fn seed() -> u64 {
    let told = std::env::var("TOUCHSTONE_SEED").ok().and_then(|text| text.parse().ok());
    told.unwrap_or_else(|| SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |time| time.as_secs() / 86_400))
}

/// All answers, made once for all tests.
fn rows() -> &'static [Row] {
    static ROWS: OnceLock<Vec<Row>> = OnceLock::new();
    ROWS.get_or_init(|| {
        let seed = seed();
        println!("blind battery: TOUCHSTONE_SEED={seed} repeats it");
        let jobs = battery(Counts::FAST, seed);
        let rows = ask(&jobs, &|recordings, options| diagnose(recordings, options).map_err(|e| e.to_string()));
        println!("{}", report(&rows));
        rows
    })
}

/// Fails when the share is below what luck explains at a true share of `demanded`.
fn at_least(what: &str, share: Share, demanded: f64) {
    assert!(share.of > 0, "{what}: no case asks for it");
    assert!(
        share.at_most(LUCK) >= demanded,
        "{what}: {share}, demanded {demanded}; TOUCHSTONE_SEED={} repeats it",
        seed()
    );
}

/// Fails when the share is above what luck explains at a true share of `allowed`.
fn at_most(what: &str, share: Share, allowed: f64) {
    assert!(share.of > 0, "{what}: no case asks for it");
    assert!(
        share.at_least(LUCK) <= allowed,
        "{what}: {share}, allowed {allowed}; TOUCHSTONE_SEED={} repeats it",
        seed()
    );
}

fn of(set: Set, keep: impl Fn(&Row) -> bool) -> Vec<&'static Row> {
    rows().iter().filter(|r| r.set == set && !r.missed && keep(r)).collect()
}

#[test]
fn nothing_is_found_where_nothing_is() {
    let figures = Figures::of(rows());
    at_most("false alarms from 100 Hz on", figures.false_alarms, 0.03);
    at_most("false alarms at 20 Hz", figures.false_alarms_20_hz, 0.06);
    at_most("nulls that are called unexplained", figures.null_flags, 0.02);
}

#[test]
fn the_hidden_cause_comes_first() {
    let strong = of(Set::Single, |r| r.ratio >= 1.0);
    at_least("right or equal at effect/noise 1 and 2", Share::count(strong, Row::first_right_or_equal), 0.92);
    let half = of(Set::Single, |r| r.ratio == 0.5);
    at_least("right or equal at effect/noise 0.5", Share::count(half, Row::first_right_or_equal), 0.85);
    at_least("precision", Figures::of(rows()).precision, 0.88);
}

#[test]
fn what_cannot_be_told_apart_is_listed() {
    let figures = Figures::of(rows());
    at_least("truth in the ambiguity set", figures.in_set, 0.98);
    assert!(figures.set_size <= 1.4, "ambiguity sets hold {:.2} causes; TOUCHSTONE_SEED={}", figures.set_size, seed());
}

#[test]
fn proposed_experiments_settle_what_was_open() {
    let experiments = Experiments::of(rows());
    at_least("open cases in which only what is hidden is left", experiments.settled, 0.85);
    let unsaid = rows().iter().filter_map(Row::proposed).find(|f| !(0.0..=1.0).contains(&f.expected_power));
    assert!(unsaid.is_none(), "{unsaid:?}");
}

#[test]
fn two_effects_are_both_found() {
    let pairs = of(Set::Pair, |_| true);
    at_least("both of two", Share::count(pairs, Row::all_right), 0.78);
}

#[test]
fn what_has_no_name_is_not_given_one() {
    at_most("nameless effects that are named without a flag", Figures::of(rows()).nameless_named, 0.03);
}

#[test]
fn every_recording_is_answered() {
    let failed: Vec<String> = rows().iter().filter(|r| r.answer.is_err()).map(blind::tables::line).collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
