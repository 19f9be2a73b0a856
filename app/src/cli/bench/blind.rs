//! `touchstone bench blind`: generated recordings with hidden effects, and the detection rate of the diagnosis.

use super::super::{Output, progress};
use super::reliability;
use super::table::{Figure, Wanted};
use blind::certain::Reliability;
use clap::Args;
use estimator::diagnose::diagnose;
use schemars::JsonSchema;
use serde::Serialize;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// Arguments of `bench blind`.
#[derive(Args, Default)]
pub struct BlindBench {
    /// Some 170 cases out of 1400: a first look within a minute, with intervals as wide as that
    #[arg(long)]
    fast: bool,
    /// All of it: this goes without saying by now
    #[arg(long, hide = true, conflicts_with = "fast")]
    whole: bool,
    /// Repeats a battery; a new one every day when not given
    #[arg(long)]
    seed: Option<u64>,
    /// Recordings of cranks and mechanisms with structured model error instead, and how often certain names are right
    #[arg(long, conflicts_with_all = ["fast", "whole"])]
    structured: bool,
    /// Draws the reliability diagram of these recordings (SVG)
    #[arg(long, value_name = "FILE", requires = "structured")]
    picture: Option<PathBuf>,
    /// Only so many cases, spread over the battery: a first look
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..))]
    cases: Option<u64>,
}

/// What `bench blind --json` prints.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said {
    /// What repeats this battery.
    seed: u64,
    /// Whether it is the whole one.
    whole: bool,
    /// How long it took, generator included, s.
    took_s: f64,
    /// Figures of the battery; none of recordings with structured model error.
    #[serde(flatten)]
    counts: Option<blind::Said>,
    /// How often names are right, by their posterior, in recordings with structured model error.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    reliability: Vec<Bin>,
}

/// Names with nearly the same posterior.
#[derive(JsonSchema, Serialize)]
struct Bin {
    /// Ends of the bin.
    ends: [f64; 2],
    /// Mean posterior; none without names.
    stated: Option<f64>,
    /// Names, and how many of them are right.
    names: usize,
    right: usize,
    /// The same without names that describe the structure.
    fair_names: usize,
    fair_right: usize,
}

impl From<&Reliability> for Bin {
    fn from(Reliability { bin, stated, right, fair }: &Reliability) -> Self {
        Self {
            ends: *bin,
            stated: stated.is_finite().then_some(*stated),
            names: right.of,
            right: right.hits,
            fair_names: fair.of,
            fair_right: fair.hits,
        }
    }
}

impl BlindBench {
    pub(super) fn run(&self) -> anyhow::Result<Output> {
        let seed = self.seed.unwrap_or_else(today);
        let counts = if self.fast { blind::Counts::FAST } else { blind::Counts::WHOLE };
        let mut jobs = if self.structured {
            blind::structured(blind::StructureCounts::USUAL, seed)
        } else {
            blind::battery(counts, seed)
        };
        if let Some(cases) = self.cases {
            let (all, wanted) = (jobs.len(), usize::try_from(cases)?.min(jobs.len()));
            // Evenly spaced: the sets are in sequence.
            jobs = (0..wanted).map(|k| jobs[k * all / wanted].clone()).collect();
        }
        let (begun, done) = (Instant::now(), AtomicUsize::new(0));
        let rows = progress::during(&format!("asking {} cases, seed {seed}", jobs.len()), |share| {
            blind::ask(&jobs, &|recordings, options| {
                let answer = diagnose(recordings, options).map_err(|e| e.to_string());
                // Answers that request an experiment are diagnosed again.
                share.tell(((done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / jobs.len() as f64).min(1.0));
                answer
            })
        });
        let took_s = begun.elapsed().as_secs_f64();
        let text = format!(
            "{} cases, seed {seed}\n{}\n{took_s:.0} s in all, generator included\n",
            rows.len(),
            if self.structured { blind::certain::report(&rows) } else { blind::report(&rows) }
        );
        let bins = if self.structured { blind::certain::reliability(&rows) } else { Vec::new() };
        if let Some(file) = &self.picture {
            crate::write_whole::write_whole(file, &reliability::svg(&bins)).map_err(anyhow::Error::msg)?;
        }
        let said = Said {
            seed,
            whole: !self.fast && self.cases.is_none(),
            took_s,
            counts: (!self.structured).then(|| blind::Said::of(&rows)),
            reliability: bins.iter().map(Bin::from).collect(),
        };
        Ok(Output { text, json: serde_json::to_value(&said)? })
    }
}

/// Seed of the battery in `bench`'s table.
const SEED_OF_TABLE: u64 = 4242;

/// Figures with a target: the key, its label, and its bound (`docs/diagnosis.md`).
const WANTED: [(&str, &str, Wanted); 12] = [
    ("right_first_from_ratio_0.5", "hidden cause named first, ratio of 0.5 or more", Wanted::AtLeast(0.97)),
    ("right_first", "hidden cause named first, all ratios", Wanted::AtLeast(0.93)),
    ("truth_in_ambiguity_set", "hidden cause among those left open", Wanted::AtLeast(0.99)),
    ("ambiguity_set_size", "causes left open, on the average", Wanted::AtMost(1.3)),
    ("false_alarms", "nothing hidden and something named, 100 Hz or more", Wanted::AtMost(0.005)),
    ("false_alarms_20_hz", "nothing hidden and something named, 20 Hz", Wanted::AtMost(0.01)),
    ("precision", "named causes that are right", Wanted::AtLeast(0.985)),
    ("nameless_named", "cause outside of the catalogue named as one of it", Wanted::AtMost(0.02)),
    ("pairs_both", "two hidden causes, both named", Wanted::AtLeast(0.85)),
    ("pairs_spurious_a_case", "causes named too many beside two, a case", Wanted::AtMost(0.05)),
    ("experiments_settled", "experiments that left what is hidden alone", Wanted::AtLeast(0.9)),
    ("gain_of_oracle", "gain beside that of who knows, median", Wanted::AtLeast(0.97)),
];

/// Figures with a target from a battery's JSON; a share of no cases is not a figure.
pub(super) fn figures(json: &serde_json::Value) -> Vec<Figure> {
    let read = |(key, words, wanted): &(&str, &str, Wanted)| {
        let said = &json["figures"][*key];
        let value = ["share", "median"].iter().find_map(|of| said[*of].as_f64()).or_else(|| said.as_f64())?;
        let of = said["of"].as_u64().map(|of| format!(" ({of} cases)")).unwrap_or_default();
        Some(Figure::new(format!("{words}{of}"), value, "").wanted(*wanted))
    };
    WANTED.iter().filter_map(read).collect()
}

impl BlindBench {
    /// Battery of one fixed seed, so that figures of two versions are comparable; with `cases` only a preview of so
    /// many cases.
    pub(super) fn of_table(cases: Option<u64>) -> Self {
        Self { fast: cases.is_some(), seed: Some(SEED_OF_TABLE), cases, ..Self::default() }
    }
}

/// Days since 1970.
fn today() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |time| time.as_secs() / 86_400)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_cases_come_out_with_tables_and_intervals_and_can_be_repeated() {
        let bench = BlindBench { fast: true, seed: Some(3), cases: Some(4), ..BlindBench::default() };
        let output = bench.run().expect("cases are made and asked");
        assert!(output.text.starts_with("4 cases, seed 3\n"), "{}", output.text);
        for part in
            ["confusion: hidden", "calibration: stated", "false alarms, >= 100 Hz", "gain as a share of the oracle's"]
        {
            assert!(output.text.contains(part), "{part}: {}", output.text);
        }
        assert_eq!((output.json["cases"].as_u64(), output.json["seed"].as_u64()), (Some(4), Some(3)));
        let nulls = &output.json["figures"]["false_alarms"];
        assert!(nulls["of"].as_u64().is_some_and(|of| of >= 1), "the first case of a battery hides nothing: {nulls}");
        let [low, share, high] =
            [&nulls["interval"][0], &nulls["share"], &nulls["interval"][1]].map(|v| v.as_f64().expect("a number"));
        assert!(low <= share && share <= high && high - low > 0.9, "one case proves little: {nulls}");
        let named = figures(&output.json);
        assert!(named.iter().any(|f| f.name.contains("nothing hidden") && f.name.ends_with("cases)")), "{named:?}");
        let again = bench.run().expect("the same again");
        assert_eq!(again.json["confusion"], output.json["confusion"]);
    }

    #[test]
    fn recordings_with_structure_come_out_with_their_reliability_and_a_diagram() {
        let folder = tempfile::tempdir().expect("a folder");
        let picture = folder.path().join("reliability.svg");
        let bench = BlindBench {
            structured: true,
            seed: Some(3),
            cases: Some(3),
            picture: Some(picture.clone()),
            ..BlindBench::default()
        };
        let output = bench.run().expect("cases are made and asked");
        assert!(output.text.contains("posterior of a name"), "{}", output.text);
        let bins = output.json["reliability"].as_array().expect("bins");
        assert!(bins.len() == 5 && output.json.get("figures").is_none(), "{}", output.json);
        assert!(std::fs::read_to_string(picture).expect("a picture").ends_with("</svg>\n"));
    }
}
