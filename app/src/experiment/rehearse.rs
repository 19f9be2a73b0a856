//! Predicted outcome of an experiment: it is simulated on every object that the diagnosis leaves open, and each
//! recording is diagnosed.

use super::tool::{insert, is_tool};
use crate::experiment::like::Like;
use crate::experiment::motion_plan::MotionPlan;
use crate::experiment::perform::perform;
use crate::experiment::timetable::Timetable;
use estimator::diagnose::{Experiment, Findings, NextExperiment, Suspect};
use estimator::signal::noise::white_noise_under_fast_motion;
use haptics::recording::{Recording, Task};

/// Probability below which an alternative counts as excluded (as in the estimator's settling of several recordings).
const OPEN: f64 = 0.047;

/// Single performance on one object.
#[derive(Clone, Debug)]
pub struct Round {
    /// True if only the simulated cause remains among the alternatives to be discriminated.
    pub settled: bool,
    /// Diagnosed causes, strongest first.
    pub named: Vec<String>,
    /// Remaining alternatives.
    pub open: Vec<String>,
    /// The recording.
    pub recording: Recording,
}

/// Outcome for one object.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Simulated cause.
    pub id: String,
    /// Its performances.
    pub rounds: Vec<Round>,
    /// Reason why there are none, in a sentence.
    pub problem: Option<String>,
}

impl Outcome {
    /// Number of rounds with the correct answer.
    pub fn settled(&self) -> usize {
        self.rounds.iter().filter(|r| r.settled).count()
    }
}

/// Simulated experiment.
#[derive(Clone, Debug)]
pub struct Rehearsal {
    /// Outcomes, one per candidate object.
    pub outcomes: Vec<Outcome>,
}

impl Rehearsal {
    /// Number of rounds with the correct answer, and of all.
    pub fn settled(&self) -> (usize, usize) {
        (self.outcomes.iter().map(Outcome::settled).sum(), self.outcomes.iter().map(|o| o.rounds.len()).sum())
    }
}

impl Like<'_> {
    /// Noise of one sample of a finger, N: the diagnosis of needles and switches states that of means.
    fn sample_noise_n(&self) -> f64 {
        let is_captured = matches!(self.recording.meta.task, Some(Task::Needle | Task::Switch));
        let own = self.recording.channel("fx1_N").filter(|_| is_captured).map(white_noise_under_fast_motion);
        own.unwrap_or(self.noise_n)
    }
}

/// Way to perform the experiment on an object.
enum Way {
    /// Held by two fingers.
    Held(Box<Timetable>),
    /// Driven along the coordinate of a mechanism without a handle.
    Driven(MotionPlan),
    /// Performed with a single tool that is a needle.
    Tool,
}

impl Way {
    fn new(suspect: &Suspect, (asked, like): (&Experiment, &Like<'_>), motion: &str) -> Result<Self, String> {
        if suspect.world.membrane.is_some() && is_tool(like.recording) {
            return Ok(Self::Tool);
        }
        if suspect.world.mechanism.is_some() && suspect.world.crank.is_none() {
            return MotionPlan::new(asked).map(Self::Driven);
        }
        Timetable::new(&suspect.world, asked, motion).map(|table| Self::Held(Box::new(table.leaking_once_held())))
    }

    /// Recording of the performance; `None` if `goes_on` returned false.
    fn perform(
        &self,
        suspect: &Suspect,
        (asked, like): (&Experiment, &Like<'_>),
        seed: u64,
        goes_on: &dyn Fn(f64) -> bool,
    ) -> Result<Option<Recording>, String> {
        let about = format!("as if {}", suspect.id.replace('-', " "));
        match self {
            Self::Held(table) => {
                Ok(perform(table, asked, &about, (&suspect.fault, like.sample_noise_n()), seed, goes_on))
            }
            Self::Tool => insert(suspect, (asked, like), &about, seed, goes_on),
            Self::Driven(plan) => plan.perform(suspect, &about, like, seed, goes_on),
        }
    }
}

/// Simulates the experiment `rounds` times on each candidate that it should discriminate, and calls `again` with the
/// additional recording. An error is a sentence, or `None` if `goes_on` returned false.
pub fn rehearse(
    suspects: &[Suspect],
    next: &NextExperiment,
    (rounds, like): (u64, Like<'_>),
    again: &dyn Fn(&Recording) -> Result<Findings, String>,
    goes_on: &dyn Fn(f64) -> bool,
) -> Result<Rehearsal, Option<String>> {
    let asked = next.experiment.as_ref().ok_or("This experiment is known in words only.".to_owned())?;
    let wanted: Vec<&Suspect> = suspects.iter().filter(|s| next.separates.contains(&s.id)).collect();
    if wanted.is_empty() {
        return Err(Some("No object can be simulated for what is open here.".to_owned()));
    }
    let total = wanted.len() as f64 * rounds as f64;
    let mut outcomes = Vec::new();
    for (k, suspect) in wanted.iter().enumerate() {
        let mut outcome = Outcome { id: suspect.id.clone(), rounds: Vec::new(), problem: None };
        let way = match Way::new(suspect, (asked, &like), &next.motion) {
            Ok(way) => way,
            Err(problem) => {
                outcome.problem = Some(problem);
                outcomes.push(outcome);
                continue;
            }
        };
        for round in 0..rounds {
            let before = (k as f64 * rounds as f64 + round as f64) / total;
            // Half of the time is for the motion, half for the diagnosis.
            let tell = |share: f64| goes_on(before + 0.5 * share / total);
            let recording = match way.perform(suspect, (asked, &like), 1 + round, &tell) {
                Ok(recording) => recording.ok_or(None)?,
                Err(problem) => {
                    outcome.problem = Some(problem);
                    break;
                }
            };
            match again(&recording) {
                Ok(answer) => outcome.rounds.push(judged(&answer, &suspect.id, &next.separates, recording)),
                Err(problem) => outcome.problem = Some(problem),
            }
            if !goes_on(before + 1.0 / total) {
                return Err(None);
            }
        }
        outcomes.push(outcome);
    }
    let missing = next.separates.iter().filter(|id| suspects.iter().all(|s| s.id != **id));
    outcomes.extend(missing.map(|id| Outcome {
        id: id.clone(),
        rounds: Vec::new(),
        problem: Some("No object can be simulated with this in it.".to_owned()),
    }));
    Ok(Rehearsal { outcomes })
}

fn judged(answer: &Findings, id: &str, separates: &[String], recording: Recording) -> Round {
    let named: Vec<String> = answer.causes.iter().map(|c| c.id.clone()).collect();
    let open: Vec<String> = answer.alternatives.iter().filter(|a| a.posterior > OPEN).map(|a| a.id.clone()).collect();
    let others = separates.iter().filter(|s| *s != id);
    let excluded = others.clone().all(|s| !named.contains(s) && !open.contains(s));
    Round { settled: excluded && named.iter().any(|n| n == id), named, open, recording }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::headless::gallery::samples::leaking;
    use blind::{Bench, Effect, Spec};
    use estimator::diagnose::{Options, SensorFault, Verdict, diagnose, suspects};
    use haptics::recording::Channel;
    use haptics::world::MechanismPath;
    use rand::SeedableRng;
    use rand::rngs::StdRng;
    use rand_distr::{Distribution, Normal};

    /// Recording with an open question, with the inputs of a rehearsal.
    struct Asked {
        recording: [Recording; 1],
        options: Options,
        answer: Findings,
        next: NextExperiment,
        suspects: Vec<Suspect>,
    }

    impl Asked {
        fn of(recording: Recording, options: Options) -> Self {
            let recording = [recording];
            let answer = diagnose(&recording, &options).expect("an answer");
            assert_eq!(answer.verdict, Verdict::Ambiguous, "{:?}", answer.causes);
            let next = answer.next_experiment.clone().expect("an experiment");
            let suspects = suspects(&recording, &options, &answer).expect("worlds");
            Self { recording, options, answer, next, suspects }
        }

        fn again(&self, more: &Recording) -> Result<Findings, String> {
            let both = [self.recording[0].clone(), more.clone()];
            diagnose(&both, &self.options).map_err(|error| error.to_string())
        }

        /// Twice on each candidate, with this noise of a force sample.
        fn rehearsed(&self, noise_n: f64, goes_on: &dyn Fn(f64) -> bool) -> Result<Rehearsal, Option<String>> {
            let like = Like { recording: &self.recording[0], noise_n };
            rehearse(&self.suspects, &self.next, (2, like), &|more| self.again(more), goes_on)
        }

        /// Checks that each of these causes is settled in both rounds.
        fn settles(&self, noise_n: f64, ids: &[&str]) {
            let rehearsal = self.rehearsed(noise_n, &|_| true).expect("rehearsed");
            for id in ids {
                let outcome = rehearsal.outcomes.iter().find(|o| o.id == *id).expect("it is open");
                let came_out: Vec<_> = outcome.rounds.iter().map(|r| (&r.named, &r.open)).collect();
                let found = (outcome.settled(), outcome.rounds.len());
                assert_eq!(found, (2, 2), "{id}: {came_out:?} {:?}", outcome.problem);
            }
        }
    }

    fn spec(bench: Bench, rate_hz: f64) -> Spec {
        Spec { rate_hz, ..Spec::hiding(vec![(Effect::Eccentric, 0)], 2.0, bench) }
    }

    #[test]
    fn a_hung_weight_would_tell_an_eccentric_mass_from_a_tilt_whichever_it_is() {
        let first = blind::make(&spec(Bench::OneFinger, 100.0), 3).0.recordings.remove(0);
        let asked = Asked::of(first, Options::default());
        let ids: Vec<&str> = asked.suspects.iter().map(|s| s.id.as_str()).collect();
        assert_eq!(ids, ["eccentric-mass", "gravity-tilt"]);
        asked.settles(asked.answer.noise_floor_n, &ids);
        assert_eq!(asked.rehearsed(asked.answer.noise_floor_n, &|share| share < 0.3).err(), Some(None));
    }

    #[test]
    fn a_carry_would_tell_a_leak_from_a_drift_of_the_sensor_whichever_it_is() {
        let asked = Asked::of(leaking().expect("performed"), Options::default());
        asked.settles(asked.answer.noise_floor_n / std::f64::consts::SQRT_2, &["mass-change", "force-drift"]);
        let drifts = asked.suspects.iter().find(|s| s.id == "force-drift").expect("a suspect");
        let leaks = asked.suspects.iter().find(|s| s.id == "mass-change").expect("a suspect");
        assert!(leaks.world.blocks[0].content.is_some() && leaks.fault == SensorFault::default());
        assert!(drifts.world.blocks[0].content.is_none() && drifts.fault != SensorFault::default());
    }

    #[test]
    fn a_mechanisms_experiment_is_rehearsed_along_its_coordinate_and_settles_the_question_on_the_real_one_too() {
        let (mut case, _, object) = blind::case::make_with_object(&spec(Bench::Angular, 250.0), &[], 4);
        let options = Options { baseline: Some("mass+viscous+coulomb".to_owned()), ..Options::default() };
        let asked = Asked::of(case.recordings.remove(0), options);
        asked.settles(asked.answer.noise_floor_n, &["eccentric-mass", "gravity-tilt"]);
        // The real object, moved by the generator's own hand as the diagnosis requests.
        let motion = asked.next.experiment.as_ref().expect("for a program");
        let real = object.perform(motion, 9).expect("the hand knows the motion");
        let answer = asked.again(&real).expect("an answer");
        let settled = judged(&answer, "eccentric-mass", &asked.next.separates, real);
        assert!(settled.settled, "{:?} or {:?}", settled.named, settled.open);
    }

    /// Hinge of a generated recording, moved by a tool on its handle in a horizontal plane.
    fn led_by_a_tool(along: &Recording, noise: [f64; 2], seed: u64) -> Recording {
        const HANDLE_M: f64 = 0.25;
        let mut rng = StdRng::seed_from_u64(seed);
        let channel = |name: &str| along.channel(name).expect("a mechanism's column");
        let (angle, torque) = (channel("q_rad"), channel("tau_Nm"));
        let mut made = |name: &str, noise: f64, of: &dyn Fn(f64, f64) -> f64| {
            let white = Normal::new(0.0, noise).expect("a spread");
            let values = angle.iter().zip(torque).map(|(q, tau)| of(*q, *tau) + white.sample(&mut rng)).collect();
            Channel { name: name.to_owned(), unit: String::new(), values }
        };
        // The hand also pulls outwards, with a varying force: only then is the hinge noticeable.
        let pull_n = |q: f64| 2.0 + (3.0 * q).sin();
        let channels = vec![
            made("x_m", noise[0], &|q, _| 0.4 + HANDLE_M * q.cos()),
            made("y_m", noise[0], &|q, _| 0.1 + HANDLE_M * q.sin()),
            made("fx_N", noise[1], &|q, tau| -tau / HANDLE_M * q.sin() + pull_n(q) * q.cos()),
            made("fy_N", noise[1], &|q, tau| tau / HANDLE_M * q.cos() + pull_n(q) * q.sin()),
        ];
        let mut recording = Recording { channels, labels: None, ..along.clone() };
        recording.meta.up = Some("none".to_owned());
        recording
    }

    #[test]
    fn what_a_tool_leads_along_its_path_is_rehearsed_as_the_tool_sees_it() {
        let (mut case, _, object) = blind::case::make_with_object(&spec(Bench::Angular, 250.0), &[], 4);
        let first = led_by_a_tool(&case.recordings.remove(0), [5e-6, 2e-3], 1);
        let task = Some(Task::Mechanism);
        let options = Options { task, baseline: Some("mass+viscous+coulomb".to_owned()), ..Options::default() };
        let asked = Asked::of(first, options);
        let ids: Vec<&str> = asked.next.separates.iter().map(String::as_str).collect();
        asked.settles(asked.answer.noise_floor_n, &ids);
        // The real object, moved as the diagnosis requests: its angle is relative to the start of the first recording.
        let suspect = asked.suspects.first().expect("a suspect");
        let path = suspect.world.mechanism.as_ref().and_then(|m| m.path).expect("a circle");
        let MechanismPath::Revolute { zero, axis, .. } = path else { panic!("a hinge turns: {path:?}") };
        assert!(axis[2].abs() > 0.99, "{axis:?}");
        let mut motion = asked.next.experiment.clone().expect("for a program");
        motion.middle = axis[2].signum() * motion.middle + zero[1].atan2(zero[0]);
        let real = led_by_a_tool(&object.perform(&motion, 9).expect("the hand knows the motion"), [5e-6, 2e-3], 2);
        let answer = asked.again(&real).expect("an answer");
        assert!(answer.causes.iter().any(|c| c.id == "eccentric-mass"), "{:?}", answer.causes);
    }
}
