//! Output of a transmission against its input.

use super::filtered_columns::Fine;
use super::grid::{Tried, closer};
use super::rows::{Columns, Row, Seen, constants, ratio};
use crate::diagnose::answer::part::{Found, Told};
use crate::diagnose::contract::CauseParameter;
use crate::diagnose::data::limits::SIGNIFICANT;
use crate::diagnose::data::row_means::spread;
use crate::diagnose::hypotheses::candidate::{Candidate, LEAST_SHARE, Shape};
use crate::diagnose::hypotheses::{backlash, hysteresis, pad_compliance, time_delay};
use crate::diagnose::recording::time_delay::CLOCKS_DIFFER_S;
use crate::diagnose::selection::channel::Channel;
use crate::diagnose::selection::comparison::{ChannelFit, Compared};
use crate::diagnose::tasks::transmission::{channel, compared, shows, view};
use foundation::estimate::EstimateError;
use foundation::signal::noise::white_noise;
use haptics::law::Kind;

/// Least effect on the output, as a share of its sensor's steps. A smaller one cannot be distinguished
/// from the steps: an output at rest reads one and the same step.
/// Derived: half a step is the largest rounding error of a reading.
const STEPS_OF_SENSOR: f64 = 0.5;

/// The comparison.
pub struct Way {
    pub compared: Compared,
    names: &'static Columns,
    /// Steps of the output's sensor.
    step: f64,
}

/// The output against the input.
pub fn way(seen: &Seen, names: &'static Columns) -> Result<Way, EstimateError> {
    let (low, high) = seen.ends();
    let kept: Vec<usize> = (0..seen.rows.len()).collect();
    let rows = &seen.rows;
    let of = |f: &dyn Fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<f64>>();
    let mut base = constants(rows);
    base.push(of(&|r| r.input));
    let lever = ratio(rows);
    let share = Shape::Share { least: LEAST_SHARE * lever, whole: f64::NEG_INFINITY };
    // A smaller motion of the output may be due to the steps of its sensor.
    let noise = white_noise(&rows.iter().map(|r| r.output).collect::<Vec<_>>());
    let smallest = (SIGNIFICANT * noise).max(STEPS_OF_SENSOR * seen.step);
    let least = |column: &[f64]| smallest / spread(column).max(f64::MIN_POSITIVE);
    let mut plain = Vec::new();
    for f in [|r: &Row| r.load, |r: &Row| r.force] {
        if rows.iter().all(|r| f(r).is_some()) {
            // The mean over a recording is removed, because it belongs to the zero of the output. A load may have
            // either sign.
            for sign in [1.0, -1.0] {
                let column = of(&|r| sign * f(r).unwrap_or(0.0));
                let least = least(&column);
                let gives = Candidate::one(pad_compliance::ID, Kind::Plant, "give", names.give, column);
                plain.push(gives.positive().at_least(least));
            }
        }
    }
    let late = of(&|r| -r.rate);
    let least_late = least(&late).max(CLOCKS_DIFFER_S * lever.abs());
    let rate_noise = seen.fine.iter().map(Fine::rate_noise).fold(0.0, f64::max);
    let delay = Candidate::one(time_delay::ID, Kind::Instrument, "tau", "s", late);
    plain.push(delay.at_least(least_late).noisy(rate_noise));
    let view = view(rows, names);
    let channel = channel(of(&|r| r.output), base, rows, &view);
    let once = |tried: &[Tried]| {
        let gap = |half: &f64| {
            let lost = seen.column(&kept, &|f| f.lost(*half));
            let cause = Candidate::one(backlash::ID, Kind::Plant, "share", "1", lost).positive().shaped(share);
            cause.at("delta", *half, names.unit)
        };
        let bend = |way: &f64| {
            let bent = seen.column(&kept, &|f| f.bent(*way)).iter().map(|z| -way * z).collect();
            let cause = Candidate::one(hysteresis::ID, Kind::Plant, "share", "1", bent).positive().shaped(share);
            cause.at("way", *way, names.unit)
        };
        let searched = tried[0].values().iter().map(gap).chain(tried[1].values().iter().map(bend));
        let candidates = searched.chain(plain.iter().cloned()).collect();
        Channel { candidates, ..channel.clone() }.fit()
    };
    let mut tried = [backlash::ID, hysteresis::ID].map(|id| Tried::new(id, high - low));
    let study = closer(&mut tried, &once)?;
    let compared = compared(study, view, ("output's place", names.unit), noise);
    Ok(Way { compared, names, step: seen.step })
}

impl Told for Way {
    fn shows(&self, found: &Found<'_>) -> String {
        shows(found)
    }

    /// Parameters for the input: the output moves by the ratio. Of a gap's share it is not known better than the gap is.
    fn states(&self, k: usize, _: &Candidate, mut found: Vec<CauseParameter>) -> Vec<CauseParameter> {
        let (study, names, step) = (&self.compared.study, self.names, self.step);
        let candidate = study.chosen[k].candidate;
        let own = &study.candidates[candidate];
        let ratio = study.solved.as_ref().map_or(1.0, |s| s.values[study.system.base - 1]);
        // An output at rest within a gap shows one step of its sensor, whatever its exact position.
        let unseen = step / 12.0_f64.sqrt() / ratio.abs();
        let searched = own.searched.first().map_or(f64::INFINITY, |s| s.value);
        for p in &mut found {
            match p.name.as_str() {
                "share" => {
                    let error = (p.std_error / ratio).abs();
                    (p.value, p.std_error) = (p.value / ratio, error.hypot(unseen / searched));
                }
                "delta" | "way" => p.std_error = p.std_error.hypot(unseen),
                "tau" => {
                    // Noise of a regressor biases its coefficient towards zero.
                    let small = p.value * noise_of_own(study, candidate);
                    (p.value, p.std_error) = (p.value / ratio, (p.std_error.hypot(small) / ratio).abs());
                }
                "k" if own.id == pad_compliance::ID => p.unit = format!("{}/{}", names.force_unit, names.unit),
                _ => {}
            }
        }
        found
    }
}

/// Noise share of a candidate's first regressor after whitening.
fn noise_of_own(study: &ChannelFit, candidate: usize) -> f64 {
    let system = &study.system;
    let first = system.places[candidate].start;
    let whitened = 1.0 + system.coefficients.iter().map(|a| a * a).sum::<f64>();
    let power = (system.train[(first, first)] / system.rows.max(1.0)).max(f64::MIN_POSITIVE);
    (study.candidates[candidate].noise.powi(2) * whitened / power).min(1.0)
}
