//! Stage 2 by a hidden Markov model that starts from the rules' result (thesis, chapter 3.2, names it as the alternative).
//!
//! States are those that the rules saw for a while. Their Gaussians start at the samples of the rules and are refined
//! by a few steps of Baum–Welch under a prior that keeps them near. The rules stay the meaning: a state whose mean no
//! longer satisfies its own rule goes back to its start, and a warning says so.

use super::evidence::Evidence;
use super::runs::{ISLAND_S, LEAST_RUN_S, majority, runs_of};
use super::segmentation::{Method, Segmentation, StatePosterior};
use crate::hmm::{
    Chain, Covariance, Gaussian, HmmError, Model, Prior, Training, baum_welch, forward_backward, viterbi,
};
use foundation::cancellation;
use foundation::estimate::EstimateError;
use foundation::tasks::SystemState;

/// Time over which calmed signals are correlated, s: samples that come faster count less, so that the rate of the log does not
/// change what a second of it says.
const CORRELATION_S: f64 = 0.03;
/// A state lasts about so long, s; the data may say otherwise.
const DWELL_S: f64 = 0.5;
/// In how many such stays the transitions of the prior were seen.
const PRIOR_STAYS: f64 = 10.0;
/// Weight of the rules' samples in the prior, against the same samples in training.
const PRIOR_SHARE: f64 = 0.5;
/// Least effective samples of the prior of a state.
const PRIOR_LEAST: f64 = 5.0;
/// Standard deviation that no channel of a state falls below, in thresholds: thresholds lie five deviations above the noise.
const FLOOR: f64 = 0.2;
/// Samples of the spread within all states that are mixed into that of a state which was seen only briefly.
const SHARED_SAMPLES: f64 = 5.0;
/// Steps of Baum–Welch at most, and the gain that is worth another one.
const MOST_STEPS: usize = 8;
const LEAST_GAIN: f64 = 0.1;
/// A transition that contact does not make by itself (a block in the air is not on the ground's side of free motion).
const UNLIKELY: f64 = 0.05;
/// Level, in thresholds, at which a mean channel must agree with the rules: that of their hysteresis or the threshold itself.
const LEVELS: [f64; 2] = [0.7, 1.0];
/// Rules and model that differ in more than this share of the samples are said to.
const DISAGREEMENT: f64 = 0.05;

/// The most probable path through a recording, and the posterior of every sample.
pub struct Decoded {
    /// State of every sample.
    pub path: Vec<SystemState>,
    /// Probabilities.
    pub posterior: StatePosterior,
    /// Sentences.
    pub warnings: Vec<String>,
}

impl Decoded {
    /// A segmentation whose intervals stage 3 made of the path, with the model's probabilities.
    pub fn into_segmentation(self, mut by_path: Segmentation) -> Segmentation {
        for interval in by_path.states.iter_mut().filter(|i| self.posterior.states.contains(&i.state)) {
            interval.probability = self.posterior.mean(interval.state, interval.first, interval.end);
        }
        Method::Hmm.name().clone_into(&mut by_path.method);
        by_path.warnings.extend(self.warnings);
        by_path.posterior = Some(self.posterior);
        by_path
    }
}

/// Trains on a recording and decodes it.
pub fn decode(time_s: &[f64], evidence: &Evidence) -> Result<Decoded, EstimateError> {
    let n = evidence.raw.len();
    let period_s = if n > 1 { (time_s[n - 1] - time_s[0]) / (n - 1) as f64 } else { 1.0 };
    let period_s = if period_s.is_finite() && period_s > 0.0 { period_s } else { 1.0 };
    let smooth = majority(time_s, &evidence.raw);
    let states = shown(time_s, &smooth, evidence.channels);
    let starts = starts(evidence, &smooth, &states);

    // Training needs no more samples than there is news.
    let stride = ((0.5 * CORRELATION_S / period_s) as usize).clamp(1, (n / 200).max(1));
    let thinned: Vec<f64> =
        evidence.values.chunks_exact(evidence.channels).step_by(stride).flatten().copied().collect();
    let weight = |step: f64| (step * period_s / CORRELATION_S).min(1.0);
    let trainer = Trainer {
        states: &states,
        starts: &starts,
        values: &thinned,
        weight: weight(stride as f64),
        dwell: (DWELL_S / (period_s * stride as f64)).clamp(2.0, (n as f64 / 4.0).max(2.0)),
        judge: &evidence.judge,
        channels: evidence.channels,
    };
    let trained = trainer.train();
    cancellation::check()?;
    let (model, warnings) = trained.map_err(|error| EstimateError::Other(error.to_string()))?;
    let chain = slowed(&model.chain, stride as f64).map_err(|error| EstimateError::Other(error.to_string()))?;
    let log_emissions = model.log_emissions(&evidence.values, weight(1.0));
    cancellation::check()?;
    let (path, _) = viterbi(&chain, &log_emissions);
    cancellation::check()?;
    let known = forward_backward(&chain, &log_emissions).posterior;
    let path = without_passages(time_s, path.iter().map(|s| states[usize::from(*s)]).collect());
    let posterior = StatePosterior { states, values: known.iter().map(|p| *p as f32).collect() };
    let mut decoded = Decoded { path, posterior, warnings };
    decoded.compare(&smooth);
    Ok(decoded)
}

impl Decoded {
    fn compare(&mut self, rules: &[SystemState]) {
        let differing = self.path.iter().zip(rules).filter(|(a, b)| a != b).count();
        if differing as f64 > DISAGREEMENT * rules.len() as f64 {
            self.warnings.push(format!(
                "the hidden Markov model and the rules differ in {:.0} % of the samples; look at both before using either",
                100.0 * differing as f64 / rules.len() as f64
            ));
        }
    }
}

/// Leaves short visits without a state: forces fall through the values of other states when an object is dropped, and a contact
/// that oscillates is in none. Stage 3 divides such gaps between their neighbours when they are short.
fn without_passages(time_s: &[f64], mut path: Vec<SystemState>) -> Vec<SystemState> {
    for run in
        runs_of(time_s, &path).iter().filter(|run| run.length <= ISLAND_S + 1e-9 && run.end - run.first < time_s.len())
    {
        path[run.first..run.end].fill(SystemState::NoState);
    }
    path
}

/// States that the rules saw for a while, without a break and in enough samples for a mean and a covariance; at least the most
/// frequent one. A state of two noisy samples would be no more than an invitation to training.
fn shown(time_s: &[f64], smooth: &[SystemState], channels: usize) -> Vec<SystemState> {
    let runs = runs_of(time_s, smooth);
    let mut seen: Vec<(SystemState, usize)> = Vec::new();
    for run in runs.iter().filter(|r| r.length >= LEAST_RUN_S && r.end - r.first > 1) {
        match seen.iter_mut().find(|(state, _)| *state == run.state) {
            Some((_, samples)) => *samples += run.end - run.first,
            None => seen.push((run.state, run.end - run.first)),
        }
    }
    let enough = seen.into_iter().filter(|(_, samples)| *samples > channels);
    let mut states: Vec<SystemState> = enough.map(|(state, _)| state).collect();
    if states.is_empty() {
        states.extend(runs.iter().max_by_key(|r| r.end - r.first).map(|r| r.state));
    }
    states.sort_by_key(|s| *s as u8);
    states
}

/// Start of a state, and the number of samples in which the rules saw it.
struct Start {
    emission: Gaussian,
    samples: usize,
}

/// Mean and covariance of the samples of each state by the rules, sample by sample and after smoothing.
fn starts(evidence: &Evidence, smooth: &[SystemState], states: &[SystemState]) -> Vec<Start> {
    let d = evidence.channels;
    let rows = |state: SystemState| {
        let named = evidence.raw.iter().zip(smooth).map(move |(raw, calm)| *raw == state && *calm == state);
        let named = evidence.values.chunks_exact(d).zip(named).filter(|(_, named)| *named).map(|(row, _)| row);
        named.filter(|row| row.iter().all(|v| v.is_finite()))
    };
    let moments: Vec<(Vec<f64>, nalgebra::DMatrix<f64>, usize)> = states
        .iter()
        .map(|state| {
            let count = rows(*state).count();
            let mean: Vec<f64> =
                (0..d).map(|c| rows(*state).map(|row| row[c]).sum::<f64>() / count.max(1) as f64).collect();
            let mut products = nalgebra::DMatrix::zeros(d, d);
            for row in rows(*state) {
                for a in 0..d {
                    for b in 0..d {
                        products[(a, b)] += (row[a] - mean[a]) * (row[b] - mean[b]);
                    }
                }
            }
            (mean, products, count)
        })
        .collect();
    let all: usize = moments.iter().map(|m| m.2).sum();
    let shared =
        moments.iter().map(|m| &m.1).fold(nalgebra::DMatrix::zeros(d, d), |sum, m| sum + m) / all.max(1) as f64;
    moments
        .into_iter()
        .map(|(mean, products, samples)| {
            let spread = (products + &shared * SHARED_SAMPLES) / (samples as f64 + SHARED_SAMPLES);
            Start { emission: Gaussian::new(mean, Covariance::Full(spread), &vec![FLOOR * FLOOR; d]), samples }
        })
        .collect()
}

struct Trainer<'a> {
    states: &'a [SystemState],
    starts: &'a [Start],
    values: &'a [f64],
    weight: f64,
    /// Usual stay in a state, in training samples.
    dwell: f64,
    judge: &'a dyn Fn(&[f64], f64) -> SystemState,
    channels: usize,
}

impl Trainer<'_> {
    fn train(&self) -> Result<(Model, Vec<String>), HmmError> {
        let emissions: Vec<Gaussian> = self.starts.iter().map(|s| s.emission.clone()).collect();
        let chain = Chain::sticky(self.states.len(), self.dwell, &affinity(self.states))?;
        let transitions = chain.transition().iter().map(|p| p * self.dwell * PRIOR_STAYS).collect();
        let total: usize = self.starts.iter().map(|s| s.samples).sum();
        let effective = self.weight * (self.values.len() / self.channels) as f64 / total.max(1) as f64;
        // No rule defines the look of `no state`: training would only let it take the samples of others.
        let believed = |(state, start): (&SystemState, &Start)| match state {
            SystemState::NoState => f64::INFINITY,
            _ => (PRIOR_SHARE * effective * start.samples as f64).max(PRIOR_LEAST),
        };
        let mut training = Training {
            most_steps: MOST_STEPS,
            least_gain: LEAST_GAIN,
            weight: self.weight,
            floor: vec![FLOOR * FLOOR; self.channels],
            prior: Some(Prior {
                emissions: emissions.clone(),
                emission_samples: self.states.iter().zip(self.starts).map(believed).collect(),
                transitions,
            }),
        };
        let start = Model::new(chain, emissions)?;
        let mut model = baum_welch(start.clone(), self.values, &training)?.model;
        let strayed: Vec<usize> = (0..self.states.len()).filter(|s| self.strayed(*s, &model)).collect();
        if !strayed.is_empty() {
            if let Some(prior) = &mut training.prior {
                for state in &strayed {
                    prior.emission_samples[*state] = f64::INFINITY;
                }
            }
            model = baum_welch(start, self.values, &training)?.model;
        }
        let warnings = strayed.iter().map(|s| {
            format!(
                "training moved the state {} to values that contradict its rule; it was put back to what the rules saw",
                self.states[*s].name()
            )
        });
        Ok((model, warnings.collect()))
    }

    /// True if a state's mean satisfied its rule at the start and no longer does.
    fn strayed(&self, state: usize, model: &Model) -> bool {
        let fits = |g: &Gaussian| LEVELS.iter().any(|level| (self.judge)(g.mean(), *level) == self.states[state]);
        fits(&self.starts[state].emission) && !fits(&model.emissions[state])
    }
}

/// Affinity of one state to another: transitions by the nature of contact are likely, the rest must be shown by the
/// data.
fn affinity(states: &[SystemState]) -> Vec<f64> {
    use SystemState::{FreeMotion, HoldAboveGround, HoldOnGround, NoState, Penetration, SlidingOnGround};
    let likely = |a: SystemState, b: SystemState| match (a, b) {
        // A needle goes through a sheet that it has pressed in, and is drawn out before it is free.
        (FreeMotion, Penetration | HoldAboveGround | SlidingOnGround)
        | (Penetration, FreeMotion)
        | (HoldAboveGround, SlidingOnGround) => false,
        (FreeMotion, HoldOnGround) | (HoldOnGround, HoldAboveGround | SlidingOnGround) | (NoState, _) => true,
        _ => !matches!(a, HoldOnGround | HoldAboveGround | SlidingOnGround),
    };
    let one = |a: SystemState, b: SystemState| if likely(a, b) || likely(b, a) { 1.0 } else { UNLIKELY };
    states.iter().flat_map(|a| states.iter().map(move |b| one(*a, *b))).collect()
}

/// The chain for samples that come `stride` times as fast.
fn slowed(chain: &Chain, stride: f64) -> Result<Chain, HmmError> {
    let k = chain.states();
    let mut transition = chain.transition().to_vec();
    for from in 0..k {
        let row = &mut transition[from * k..(from + 1) * k];
        let mut leaving = 0.0;
        for to in (0..k).filter(|to| *to != from) {
            row[to] /= stride;
            leaving += row[to];
        }
        row[from] = 1.0 - leaving;
    }
    // Any state may come first: the recording's first training sample is not the first sample.
    Chain::new(vec![1.0 / k as f64; k], transition)
}

#[cfg(test)]
mod tests {
    use super::*;
    use SystemState::{Holding, Turning};
    use rand::{SeedableRng as _, rngs::StdRng};
    use rand_distr::{Distribution as _, Normal};

    /// Turning from one level of a single channel, as `judge_level` says.
    fn judge_level(mean: &[f64], level: f64) -> SystemState {
        if mean[0].sinh() > level { Turning } else { Holding }
    }

    /// A channel that is at each level for a number of samples of 10 ms, with the states that the rules see there.
    fn evidence(parts: &[(f64, SystemState, usize)], spread: f64) -> (Vec<f64>, Evidence) {
        let mut rng = StdRng::seed_from_u64(21);
        let noise = Normal::new(0.0, spread).expect("a spread");
        let (mut values, mut raw) = (Vec::new(), Vec::new());
        for (level, state, samples) in parts {
            values.extend((0..*samples).map(|_| level + noise.sample(&mut rng)));
            raw.extend(std::iter::repeat_n(*state, *samples));
        }
        let time = (0..raw.len()).map(|i| i as f64 * 0.01).collect();
        (time, Evidence { channels: 1, values, raw, judge: Box::new(judge_level) })
    }

    #[test]
    fn corrects_what_the_rules_named_wrongly_and_knows_where_it_is_unsure() {
        // The rules flicker within the turn and end it late.
        let parts = [
            (0.1, Holding, 100),
            (3.0, Turning, 60),
            (3.0, Holding, 8),
            (3.0, Turning, 60),
            (0.1, Turning, 12),
            (0.1, Holding, 100),
        ];
        let (time, evidence) = evidence(&parts, 0.3);
        let decoded = decode(&time, &evidence).expect("decodes");
        for (i, state) in decoded.path.iter().enumerate() {
            let truth = if (100..228).contains(&i) { Turning } else { Holding };
            assert!(*state == truth || i.abs_diff(100) < 2 || i.abs_diff(228) < 2, "sample {i}");
        }
        assert!(decoded.posterior.at(50, Holding) > 0.99 && decoded.posterior.at(164, Turning) > 0.99);
        assert_eq!(decoded.posterior.at(50, SystemState::FreeMotion), 0.0, "never shown");
    }

    #[test]
    fn a_state_that_training_moves_against_its_rule_is_put_back_and_said() {
        // The rules' turning was seen for a moment. A level that is nearer to it than to rest, but still below its
        // threshold, lasts for long and draws its Gaussian down.
        let at = |level: f64, samples| {
            let emission =
                Gaussian::new(vec![level], Covariance::Full(nalgebra::DMatrix::identity(1, 1) * 0.04), &[0.04]);
            Start { emission, samples }
        };
        let values = [vec![-0.5; 400], vec![0.4; 1500], vec![-0.5; 400]].concat();
        let trainer = Trainer {
            states: &[Turning, Holding],
            starts: &[at(1.2, 5), at(-0.5, 800)],
            values: &values,
            weight: 1.0,
            dwell: 50.0,
            judge: &judge_level,
            channels: 1,
        };
        let (model, warnings) = trainer.train().expect("trains");
        assert!(warnings.len() == 1 && warnings[0].contains("turning"), "{warnings:?}");
        assert_eq!(model.emissions[0].mean(), [1.2]);
    }

    #[test]
    fn constant_channels_one_state_and_missing_numbers_are_no_trouble() {
        let (time, mut evidence) = evidence(&[(0.0, Holding, 300)], 0.0);
        let decoded = decode(&time, &evidence).expect("decodes");
        assert!(decoded.path.iter().all(|s| *s == Holding) && decoded.posterior.values.iter().all(|p| *p == 1.0));
        evidence.values.fill(f64::NAN);
        let decoded = decode(&time, &evidence).expect("decodes");
        assert!(decoded.posterior.values.iter().all(|p| p.is_finite()));
    }

    #[test]
    fn rules_and_model_far_apart_are_said() {
        let mut decoded = Decoded {
            path: vec![Holding; 100],
            posterior: StatePosterior { states: vec![Holding], values: vec![1.0; 100] },
            warnings: Vec::new(),
        };
        decoded.compare(&[vec![Turning; 10], vec![Holding; 90]].concat());
        assert!(decoded.warnings[0].contains("10 %"), "{:?}", decoded.warnings);
    }
}
