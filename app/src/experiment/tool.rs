//! Insertions by a single tool, as on a test stand: the needle follows its command, and its sensor reads the membrane's
//! force.

use super::captured::place_m;
use super::motion_plan::rate_hz;
use super::perform::what_is_known;
use super::sensing::see_through;
use super::timetable;
use crate::experiment::like::Like;
use crate::experiment::simulated::SIMULATED;
use estimator::diagnose::{Experiment, Insertions, Suspect};
use estimator::signal::noise::white_noise_under_fast_motion;
use haptics::law::object::MembraneHistory;
use haptics::recording::{Channel, Meta, Recording, Task};
use rand::SeedableRng;
use rand::rngs::StdRng;
use rand_distr::{Distribution, Normal};

/// Rest before and after, s, and maximum step of the membrane's law, s.
const REST_S: f64 = 0.5;
const STEP_S: f64 = 1e-4;
/// Interval between checks for cancellation, samples.
const LOOKS: usize = 500;

/// True if a single tool was recorded, not two fingers.
pub fn is_tool(recording: &Recording) -> bool {
    recording.channel("fx_N").is_some() && recording.channel("fx1_N").is_none()
}

/// Simulated recording; `None` if `goes_on` returns false. An error is a sentence.
pub fn insert(
    suspect: &Suspect,
    (asked, like): (&Experiment, &Like<'_>),
    about: &str,
    seed: u64,
    goes_on: &dyn Fn(f64) -> bool,
) -> Result<Option<Recording>, String> {
    let motion = Insertions::of(asked).ok_or_else(|| timetable::unknown(asked))?;
    let membrane = suspect.world.membrane.as_ref().ok_or("There is no sheet in this world.")?;
    let rate = rate_hz(like.recording)?;
    let count = ((motion.duration_s() + 2.0 * REST_S) * rate) as usize;
    let parts = (1.0 / (rate * STEP_S)).ceil().max(1.0) as usize;
    let step_s = 1.0 / (rate * parts as f64);
    let mut history = MembraneHistory::default();
    let (mut insertion, mut rows) = (0, Vec::with_capacity(count));
    for sample in 0..count {
        let (mut x_m, mut depth_m, mut out_n) = (0.0, 0.0, 0.0);
        for part in 0..parts {
            let time_s = sample as f64 / rate + part as f64 * step_s - REST_S;
            let (k, share) = motion.place(time_s);
            if k != insertion {
                (insertion, history) = (k, MembraneHistory::default());
            }
            let place = |k: usize| place_m(membrane, motion.count(), k);
            x_m = if k + 1 < motion.count() { place(k) + (place(k + 1) - place(k)) * share } else { place(k) };
            depth_m = motion.depth_m(time_s);
            let rate_m_s = (motion.depth_m(time_s + step_s) - motion.depth_m(time_s - step_s)) / (2.0 * step_s);
            out_n = membrane.law.force_n(depth_m, rate_m_s, &mut history);
        }
        // Up is positive: a force of the needle on the membrane points down.
        rows.push([x_m, -depth_m, 0.0, -out_n]);
        if sample % LOOKS == 0 && !goes_on(sample as f64 / count as f64) {
            return Ok(None);
        }
    }
    let mut recording = seen(&rows, rate, like.recording, seed);
    recording.name = format!("simulated, {about}");
    see_through(&mut recording, &suspect.fault, 0.0);
    recording.meta.gravity_m_s2 = like.recording.meta.gravity_m_s2;
    recording.meta.other.insert(SIMULATED.to_owned(), about.into());
    recording.meta.known.extend(what_is_known(asked));
    Ok(Some(recording))
}

/// Tool's recording by sensors with the noise of another.
fn seen(rows: &[[f64; 4]], rate_hz: f64, like: &Recording, seed: u64) -> Recording {
    let mut rng = StdRng::seed_from_u64(seed ^ 0x1005);
    let mut channel = |k: usize, name: &str, unit: &str| {
        let noise = like.channel(name).map_or(0.0, white_noise_under_fast_motion);
        let white = Normal::new(0.0, noise.max(0.0)).ok();
        let values = rows.iter().map(|row| row[k] + white.map_or(0.0, |white| white.sample(&mut rng))).collect();
        Channel { name: name.to_owned(), unit: unit.to_owned(), values }
    };
    let channels =
        vec![channel(0, "x_m", "m"), channel(1, "y_m", "m"), channel(2, "fx_N", "N"), channel(3, "fy_N", "N")];
    Recording {
        time_s: Some((0..rows.len()).map(|k| k as f64 / rate_hz).collect()),
        channels,
        meta: Meta { task: Some(Task::Needle), ..Meta::default() },
        ..Recording::default()
    }
}
