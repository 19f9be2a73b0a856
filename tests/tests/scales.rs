//! The answer does not depend on the units of length and force: a needle in micrometres and nanonewtons and a machine of tonnes are
//! judged as the thesis's objects are.

use blind::{Counts, battery};
use estimator::diagnose::{Findings, Options, diagnose};
use haptics::recording::Recording;
use rayon::prelude::*;
use tests::rescaled::Scale;
use tests::tasks::{Case, barrel, blocks, needle, slide, switch, throw};

const SEED: u64 = 20_261_127;
/// Micrometres with nanonewtons, and a machine of tonnes.
const SCALES: [Scale; 2] =
    [Scale { length: 1.0 / 1024.0, force: 1.0 / 1_048_576.0 }, Scale { length: 32.0, force: 1024.0 }];

struct Asked {
    name: String,
    recordings: Vec<Recording>,
    options: Options,
}

fn told(answer: &Result<Findings, impl std::fmt::Display>) -> String {
    match answer {
        Err(e) => format!("error: {e}"),
        Ok(answer) => {
            let causes: Vec<String> = answer.causes.iter().map(|c| format!("{} {:.3}", c.id, c.posterior)).collect();
            let others: Vec<&str> = answer.alternatives.iter().map(|a| a.id.as_str()).collect();
            let unseen: Vec<&str> = answer.not_excited.iter().map(|n| n.id.as_str()).collect();
            format!("{:?} {causes:?}, or {others:?}, not seen {unseen:?}", answer.verdict)
        }
    }
}

fn compare(asked: &Asked) -> Vec<String> {
    let plain = told(&diagnose(&asked.recordings, &asked.options));
    let other = |scale: &Scale| {
        let recordings: Vec<Recording> = asked.recordings.iter().map(|r| scale.recording(r)).collect();
        let now = told(&diagnose(&recordings, &asked.options));
        (now != plain).then(|| format!("{} {scale:?}\n   {plain}\n   {now}", asked.name))
    };
    SCALES.iter().filter_map(other).collect()
}

#[test]
fn the_answer_does_not_depend_on_the_units() {
    let mut all: Vec<Asked> = Vec::new();
    macro_rules! add {
        ($task:ident) => {
            for (k, (name, kind)) in $task::Kind::ALL.into_iter().enumerate() {
                let Case { recordings, options } = $task::make(kind, SEED + k as u64).0;
                // A world has lengths of its own.
                let options = Options { world: None, ..options };
                all.push(Asked { name: format!("{} {name}", stringify!($task)), recordings, options });
            }
        };
    }
    add!(blocks);
    add!(slide);
    add!(barrel);
    add!(needle);
    add!(switch);
    add!(throw);
    for job in battery(Counts::FAST, SEED).into_iter().step_by(8) {
        let (case, _) = job.make();
        let options = blind::score::options(&case);
        all.push(Asked { name: format!("{} {}", job.set.name(), job.seed), recordings: case.recordings, options });
    }
    let found: Vec<Vec<String>> = all.par_iter().with_max_len(1).map(compare).collect();
    let asked = all.len() * SCALES.len();
    let differing: Vec<String> = found.into_iter().flatten().collect();
    println!("{} of {asked} answers differ", differing.len());
    assert!(differing.is_empty(), "{} of {asked} answers differ:\n{}", differing.len(), differing.join("\n"));
}
