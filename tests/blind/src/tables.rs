//! What a battery comes out at, in words and tables.

use super::follow::Experiments;
use super::interval::{Share, quantile};
use super::score::{Figures, Row};
use super::sets::{RATIOS, Set};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Everything, for a person to read.
pub fn report(rows: &[Row]) -> String {
    let parts = [
        figures(&Figures::of(rows)),
        by_ratio_and_rate(rows),
        by_form(rows),
        confusion(rows),
        gains(rows),
        wrong(rows),
        hard_logs(rows),
        wrong_nulls(rows),
        nameless(rows),
        pairs(rows),
        equals(rows),
        experiments(rows),
        calibration(rows),
        times(rows),
    ];
    parts.join("\n")
}

fn figures(f: &Figures) -> String {
    let mut text = String::from("share [95 % interval] hits/cases\n");
    let lines = [
        ("right cause first, effect/noise >= 0.5", f.first_from_half.to_string()),
        ("… or one exactly equal to it there", f.first_or_equal_from_half.to_string()),
        ("right cause first, all main cases", f.first_all.to_string()),
        ("… or one exactly equal to it there", f.first_or_equal.to_string()),
        ("truth in the ambiguity set", f.in_set.to_string()),
        ("mean size of that set", format!("{:.2}", f.set_size)),
        ("false alarms, >= 100 Hz", f.false_alarms.to_string()),
        ("… at most, with 95 % confidence", at_most(f.false_alarms)),
        ("false alarms, 20 Hz", f.false_alarms_20_hz.to_string()),
        ("… at most, with 95 % confidence", at_most(f.false_alarms_20_hz)),
        ("unexplained on nulls", f.null_flags.to_string()),
        ("precision when it names", f.precision.to_string()),
        ("nameless effects: named without a flag", f.nameless_named.to_string()),
        ("nameless effects: flagged, >= 1", f.nameless_flagged.to_string()),
        ("pairs: both", f.both.to_string()),
        ("… or exact equals", f.both_or_equal.to_string()),
        ("pairs: spurious a case", format!("{:.3}", f.spurious)),
        ("… exact equals not counted", format!("{:.3}", f.spurious_beside_equals)),
        ("gain of the oracle's, median and 10th percentile", format!("{:.3} {:.3}", f.gain[0], f.gain[1])),
        ("… as right answers state it", format!("{:.3} {:.3}", f.gain_claimed[0], f.gain_claimed[1])),
        ("errors", f.errors.to_string()),
    ];
    for (what, value) in lines {
        let _ = writeln!(text, "  {what:<50} {value}");
    }
    text
}

/// One-sided bound.
fn at_most(share: Share) -> String {
    if share.of == 0 { "no cases".to_owned() } else { format!("{:.4}", share.at_most(0.05)) }
}

fn main_cases(rows: &[Row]) -> impl Iterator<Item = &Row> {
    rows.iter().filter(|r| r.set == Set::Single && !r.missed)
}

fn by_ratio_and_rate(rows: &[Row]) -> String {
    let mut text = String::from("right cause first, by effect/noise and by rate (Hz)\n");
    for ratio in RATIOS {
        let _ = writeln!(
            text,
            "  {ratio:>5}  first {}   in set {}",
            Share::count(main_cases(rows).filter(|r| r.ratio == ratio), Row::first_right),
            Share::count(main_cases(rows).filter(|r| r.ratio == ratio && r.alarmed()), Row::set_right),
        );
    }
    for rate in [100.0, 250.0, 500.0, 1000.0] {
        let of_rate = || main_cases(rows).filter(|r| r.rate_hz == rate);
        let _ = writeln!(text, "  {rate:>5}  first {}", Share::count(of_rate(), Row::first_right));
    }
    for bench in ["crank", "crank-2", "linear", "angular"] {
        let there = || main_cases(rows).filter(|r| r.bench.name() == bench);
        let _ = writeln!(text, "  {bench:>8}  first {}", Share::count(there(), Row::first_right));
    }
    let missed = Share::count(rows.iter().filter(|r| !r.ids().is_empty()), |r| r.missed);
    let _ =
        writeln!(text, "  not counted, because the motion cannot show the wanted size: {}/{}", missed.hits, missed.of);
    text
}

/// Groups rows by a name and counts.
fn grouped<'a>(rows: impl Iterator<Item = &'a Row>, name: impl Fn(&Row) -> String) -> BTreeMap<String, Vec<&'a Row>> {
    let mut groups: BTreeMap<String, Vec<&Row>> = BTreeMap::new();
    for row in rows {
        groups.entry(name(row)).or_default().push(row);
    }
    groups
}

fn by_form(rows: &[Row]) -> String {
    let mut text = String::from("by cause and functional form: first, in set, cases\n");
    let name =
        |r: &Row| r.hidden.first().map_or(String::new(), |(e, form)| format!("{:<18} {}", e.id(), e.form(*form)));
    for (group, rows) in grouped(main_cases(rows), name) {
        let first = rows.iter().filter(|r| r.first_right()).count();
        let set = rows.iter().filter(|r| r.set_right()).count();
        let _ = writeln!(text, "  {group:<48} {first:>3} {set:>3} {:>3}", rows.len());
    }
    text
}

/// What was said first where something (or nothing) was hidden, most often first; main cases and nulls.
pub fn confusion_counts(rows: &[Row]) -> Vec<(String, Vec<(String, usize)>)> {
    let counted = rows.iter().filter(|r| r.set == Set::Null || (r.set == Set::Single && !r.missed));
    let hidden = |r: &Row| if r.hidden.is_empty() { "(nothing)".to_owned() } else { r.ids().join(" + ") };
    let first = |r: &Row| r.named().first().map_or_else(|| r.said(), |first| (*first).to_owned());
    let said = |rows: Vec<&Row>| {
        let mut said: Vec<(String, usize)> =
            grouped(rows.into_iter(), first).into_iter().map(|(name, rows)| (name, rows.len())).collect();
        said.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
        said
    };
    grouped(counted, hidden).into_iter().map(|(id, rows)| (id, said(rows))).collect()
}

fn confusion(rows: &[Row]) -> String {
    let mut text = String::from("confusion: hidden → said (first cause; main cases and nulls)\n");
    for (id, said) in confusion_counts(rows) {
        let words: Vec<String> = said.iter().map(|(name, count)| format!("{name} {count}")).collect();
        let _ = writeln!(text, "  {id:<20} {}", words.join(", "));
    }
    text
}

/// Gain as a share of the oracle's by hidden cause: median and 10th percentile, and of how many cases with a force of their own
/// (effect over noise 0.5 and more).
pub fn gains_by_cause(rows: &[Row]) -> Vec<(String, [f64; 2], usize)> {
    let strong = main_cases(rows).filter(|r| r.ratio >= 0.5 && r.effect_n2.is_finite());
    grouped(strong, |r| r.ids().join(" + "))
        .into_iter()
        .map(|(id, rows)| {
            let gains: Vec<f64> = rows.iter().map(|r| r.gain_of_oracle()).collect();
            (id, [0.5, 0.1].map(|part| quantile(&gains, part)), rows.len())
        })
        .collect()
}

fn gains(rows: &[Row]) -> String {
    let mut text =
        String::from("gain as a share of the oracle's, effect/noise >= 0.5: median, 10th percentile, cases\n");
    for (id, [median, low], cases) in gains_by_cause(rows) {
        let _ = writeln!(text, "  {id:<20} {median:>7.3} {low:>7.3} {cases:>4}");
    }
    text
}

fn wrong(rows: &[Row]) -> String {
    let mut text = String::from("main cases of effect/noise 0.5 and more that were not named\n");
    for r in main_cases(rows).filter(|r| r.ratio >= 0.5 && !r.first_right_or_equal()) {
        let _ = writeln!(text, "  {}", line(r));
    }
    text
}

fn hard_logs(rows: &[Row]) -> String {
    let mut text =
        String::from("hard logs: first, in set, wrong name, said none or unexplained, cannot show it, cases\n");
    let name = |r: &Row| {
        let rate = if r.rate_hz < 100.0 { " 20 Hz" } else { "" };
        let short = if r.seconds < 6.0 { " 4 s" } else { "" };
        format!("{}{rate}{short}", r.log.name())
    };
    for (group, rows) in grouped(rows.iter().filter(|r| r.set == Set::Hard), name) {
        let count = |hit: &dyn Fn(&Row) -> bool| rows.iter().filter(|r| hit(r)).count();
        let _ = writeln!(
            text,
            "  {group:<16} {:>3} {:>3} {:>3} {:>3} {:>3} {:>3}",
            count(&|r| r.first_right()),
            count(&|r| r.set_right()),
            count(&|r| r.alarmed() && !r.first_right_or_equal()),
            count(&|r| !r.alarmed()),
            count(&|r| r.missed),
            rows.len()
        );
    }
    text
}

fn wrong_nulls(rows: &[Row]) -> String {
    let mut text = String::from("nulls that were not silent\n");
    for r in rows.iter().filter(|r| r.set == Set::Null && (r.alarmed() || r.flagged())) {
        let _ = writeln!(text, "  {}", line(r));
    }
    text
}

fn nameless(rows: &[Row]) -> String {
    let mut text = String::from("what has no name: flagged, named without a flag, silent, cases\n");
    let of_set = rows.iter().filter(|r| r.set == Set::Nameless);
    for (group, rows) in grouped(of_set, |r| format!("{} at {}", r.ids().join(" + "), r.ratio)) {
        let count = |hit: &dyn Fn(&Row) -> bool| rows.iter().filter(|r| hit(r)).count();
        let _ = writeln!(
            text,
            "  {group:<60} {:>3} {:>3} {:>3} {:>3}",
            count(&|r| r.flagged()),
            count(&|r| r.alarmed() && !r.flagged()),
            count(&|r| !r.alarmed() && !r.flagged()),
            rows.len()
        );
    }
    text
}

fn pairs(rows: &[Row]) -> String {
    let mut text = String::from("pairs that were not named exactly\n");
    let wrong = |r: &&Row| r.set == Set::Pair && !r.missed && !(r.all_right() && r.spurious() == 0);
    for r in rows.iter().filter(wrong) {
        let _ = writeln!(text, "  {}", line(r));
    }
    text
}

fn equals(rows: &[Row]) -> String {
    let mut text = String::from("exactly equal in their log: hidden = other, cases, both in the set\n");
    let with = rows.iter().filter(|r| r.hidden.len() == 1 && !r.equals.is_empty());
    for (group, rows) in grouped(with, |r| format!("{} = {}", r.ids().join(" + "), r.equals.join(", "))) {
        let both = rows.iter().filter(|r| {
            let set = r.ambiguity_set();
            r.set_right() && r.equals.iter().all(|e| set.contains(e))
        });
        let _ = writeln!(text, "  {group:<48} {:>3} {:>3}", rows.len(), both.count());
    }
    text
}

/// What came of the experiments that answers asked for.
pub fn experiments(rows: &[Row]) -> String {
    let e = Experiments::of(rows);
    let mut text =
        String::from("experiments that answers asked for, performed and diagnosed together with the first recording\n");
    let _ = writeln!(text, "  only what is hidden is left          {}", e.settled);
    let _ = writeln!(text, "  the question itself is answered      {}", e.answered);
    let _ = writeln!(text, "  stated probability, mean             {:.3}", e.expected_power);
    for (mean, settled) in &e.calibration {
        let _ = writeln!(text, "  stated {mean:.3}                         {settled}");
    }
    for (id, settled) in &e.by_motion {
        let _ = writeln!(text, "  {id:<36} {settled}");
    }
    for (r, f) in rows.iter().filter_map(|r| Some((r, r.proposed()?))).filter(|(r, _)| !r.missed && !r.settled()) {
        let now = match &f.answer {
            Ok(a) => a.causes.iter().map(|c| c.id.as_str()).collect::<Vec<_>>().join(" + "),
            Err(error) => error.clone(),
        };
        let or: Vec<String> =
            f.answer.iter().flat_map(|a| &a.alternatives).map(|a| format!("{} {:.2}", a.id, a.posterior)).collect();
        let asked = f.separates.join("/");
        let _ = writeln!(
            text,
            "  open: {} [{} for {asked}, {:.2}] → {now} (or {})",
            line(r),
            f.id,
            f.expected_power,
            or.join(", ")
        );
    }
    text
}

/// Stated probabilities in bins: their mean, and how often it was so.
pub fn calibration_bins(rows: &[Row]) -> Vec<(f64, Share)> {
    let edges = [0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.99, 1.0 + 1e-9];
    let beliefs = beliefs(rows);
    let bin = |edge: &[f64]| {
        let bin: Vec<&(f64, bool)> = beliefs.iter().filter(|(p, _)| *p >= edge[0] && *p < edge[1]).collect();
        let mean = bin.iter().map(|(p, _)| p).sum::<f64>() / bin.len() as f64;
        (mean, Share::count(bin, |(_, right)| *right))
    };
    edges.windows(2).map(bin).filter(|(_, share)| share.of > 0).collect()
}

/// Mean square error of the stated probabilities (Brier 1950), of how many, and how many were none.
pub fn brier(rows: &[Row]) -> (f64, usize, usize) {
    let beliefs = beliefs(rows);
    let (good, odd): (Vec<_>, Vec<_>) = beliefs.into_iter().partition(|(p, _)| (0.0..=1.0).contains(p));
    let sum = good.iter().map(|(p, right)| (p - f64::from(u8::from(*right))).powi(2)).sum::<f64>();
    (sum / good.len() as f64, good.len(), odd.len())
}

fn beliefs(rows: &[Row]) -> Vec<(f64, bool)> {
    rows.iter().filter(|r| matches!(r.set, Set::Single | Set::Null)).flat_map(Row::beliefs).collect()
}

fn calibration(rows: &[Row]) -> String {
    let mut text = String::from("calibration: stated probability → how often it was so\n");
    for (mean, right) in calibration_bins(rows) {
        let _ = writeln!(text, "  {mean:.3}  {right}");
    }
    let (score, of, odd) = brier(rows);
    let _ = writeln!(text, "  Brier score {score:.4} of {of}; no probabilities: {odd}");
    text
}

fn times(rows: &[Row]) -> String {
    let all: Vec<f64> = rows.iter().map(|r| r.took_s).collect();
    let per_sample: Vec<f64> = rows.iter().map(|r| 1e6 * r.took_s / (r.rate_hz * r.seconds)).collect();
    format!(
        "time an answer: median {:.3} s, 95 % {:.3} s, longest {:.3} s; median {:.1} µs a sample\n",
        quantile(&all, 0.5),
        quantile(&all, 0.95),
        quantile(&all, 1.0),
        quantile(&per_sample, 0.5)
    )
}

/// A case and its answer in one line, with what repeats it.
pub fn line(r: &Row) -> String {
    let hidden: Vec<String> = r.hidden.iter().map(|(e, form)| format!("{} ({})", e.id(), e.form(*form))).collect();
    format!(
        "seed {} {} {} {} Hz {:.0} s at {}: {} → {}",
        r.seed,
        r.bench.name(),
        r.log.name(),
        r.rate_hz,
        r.seconds,
        r.ratio,
        if hidden.is_empty() { "nothing".to_owned() } else { hidden.join(" + ") },
        r.said()
    )
}
