//! Cranks that MuJoCo turns, each with at most one hidden effect, diagnosed blind.

use estimator::diagnose::{Findings, Options, diagnose};
use estimator::log;
use serde_json::Value;

/// Posterior from which a cause is certain.
const CERTAIN: f64 = 0.95;
/// Seed and number of the logs; `TOUCHSTONE_SEED` and `TOUCHSTONE_TASK_CASES` ask for others.
const SEED: u64 = 900_301;
const LOGS: usize = 12;

/// Answers to the logs of one seed.
#[derive(Debug, Default)]
pub struct Score {
    pub logs: usize,
    /// Logs with a hidden effect.
    pub hidden: usize,
    /// Logs whose hidden effect was named.
    pub named: usize,
    /// Logs in which another cause was certain, and those among them without a hidden effect.
    pub misled: usize,
    pub alarms: usize,
    /// One line for each log that was not answered rightly.
    pub lines: Vec<String>,
}

/// Makes and diagnoses the logs; `None` without MuJoCo.
pub fn scored() -> Option<Score> {
    let asked = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let seed = asked("TOUCHSTONE_SEED").unwrap_or(SEED);
    let count = asked("TOUCHSTONE_TASK_CASES").map_or(LOGS, |count| count as usize);
    let [logs, truths] = [0, 1].map(|_| tempfile::tempdir().expect("a folder"));
    let [of_logs, of_truths] = [&logs, &truths].map(|folder| folder.path().to_str().expect("a plain path").to_owned());
    let arguments = [of_logs.as_str(), &of_truths, &seed.to_string(), &count.to_string()];
    tests::python::output_of("tests/mujoco/hidden_in_cranks.py", &arguments)?;
    let answers: Vec<(String, Findings)> = (0..count).map(|k| answer(&logs, &format!("crank-{k}"))).collect();
    let text = std::fs::read_to_string(truths.path().join("truth.json")).expect("the truth was written");
    let truth: Value = serde_json::from_str(&text).expect("it is JSON");
    let mut score = Score::default();
    for (name, found) in &answers {
        let effect = truth[name]["effect"].as_str().expect("an effect");
        score.add(name, effect, found);
    }
    Some(score)
}

fn answer(logs: &tempfile::TempDir, name: &str) -> (String, Findings) {
    let recordings = log::load(&logs.path().join(format!("{name}.csv")), None).expect("MuJoCo's log is read");
    (name.to_owned(), diagnose(&recordings, &Options::default()).expect("and diagnosed"))
}

impl Score {
    fn add(&mut self, name: &str, effect: &str, found: &Findings) {
        let is_certain = |id: &str| {
            let own = found.causes.iter().filter(|c| c.id == id).map(|c| c.posterior);
            // One crank does not tell a mass off its axis from a tilted plane: both are the same force.
            let same = |a: &&estimator::diagnose::Alternative| a.instead_of == id && a.id == "gravity-tilt";
            own.chain(found.alternatives.iter().filter(same).map(|a| a.posterior)).sum::<f64>() >= CERTAIN
        };
        let named = effect == "none" || is_certain(effect);
        let misleads = found.causes.iter().any(|c| c.posterior >= CERTAIN && !is_there(effect, &c.id));
        self.logs += 1;
        self.hidden += usize::from(effect != "none");
        self.named += usize::from(effect != "none" && named);
        self.misled += usize::from(misleads);
        self.alarms += usize::from(effect == "none" && misleads);
        if !named || misleads {
            let said: Vec<String> = found.causes.iter().map(|c| format!("{} {:.2}", c.id, c.posterior)).collect();
            self.lines.push(format!("{name}: {effect} is hidden, said is {said:?}"));
        }
    }
}

/// True if a log with this hidden effect has this cause: every handle has mass, and friction that changes or falls with
/// the speed is friction.
fn is_there(effect: &str, cause: &str) -> bool {
    let is_friction = ["stribeck", "friction-change"].contains(&effect);
    cause == effect || cause == "inertia" || is_friction && cause == "coulomb-friction"
}
