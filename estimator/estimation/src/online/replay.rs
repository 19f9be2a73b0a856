//! Recordings through the estimator that runs beside the servo.

use super::crank::recorded::crank_problems_of;
use super::estimator::Online;
use super::filter::Sample;
use super::information::{Enough, Wanted, judge};
use super::settings::Settings;
use super::state_tracker::FREE_ROW_S;
use foundation::estimate::{EstimateError, Fit};
use foundation::signal::task::task_signals;
use haptics::Vec2;
use haptics::recording::{Recording, Task};

/// Time between two recordings, s: nothing continues from one to the next.
const APART_S: f64 = 5.0;

/// Feeds recordings of one object one after the other. Errors: channels that are missing, no clock, a task without on-line estimates.
pub fn replay(recordings: &[Recording], task: Task, settings: &Settings) -> Result<Online, EstimateError> {
    let mut online: Option<Online> = None;
    let mut offset_s = 0.0;
    for recording in recordings {
        let signals = task_signals(recording)?;
        let n = signals.len();
        if n < 2 || recording.time_s.is_none() {
            return Err(EstimateError::Clockless {
                what: "following an estimate".to_owned(),
                recording: recording.name.clone(),
            });
        }
        let (first, last) = (signals.time_s[0], signals.time_s[n - 1]);
        let online = match &mut online {
            Some(online) => online,
            empty => empty.insert(Online::new(task, (last - first) / (n - 1) as f64, settings.clone())?),
        };
        for i in 0..n {
            let mut sample: Sample = [0.0; super::filter::CHANNELS];
            for (finger, tip) in signals.tips.iter().enumerate() {
                let at = |series: &Option<Vec<Vec2>>| series.as_ref().map_or_else(Vec2::zeros, |s| s[i]);
                let (velocity, force) = (at(&tip.velocity), at(&tip.force));
                let two = 2 * finger;
                (sample[two], sample[two + 1]) = (tip.position[i].x, tip.position[i].y);
                (sample[4 + two], sample[5 + two]) = (velocity.x, velocity.y);
                (sample[8 + two], sample[9 + two]) = (force.x, force.y);
            }
            online.push(offset_s + signals.time_s[i] - first, &sample);
        }
        offset_s += last - first + APART_S;
    }
    online.ok_or_else(|| EstimateError::Other("no recording was given; name at least one log".to_owned()))
}

/// Information that recordings of one object hold about every parameter of their fit, and the missing motion. Tasks
/// without on-line estimates get the motion that shows a parameter, and no seconds.
pub fn enough_for(recordings: &[Recording], task: Task, fit: &Fit, wanted: &Wanted) -> Vec<Enough> {
    let gravity_m_s2 = recordings.first().map_or(9.81, |r| r.meta.gravity());
    // A recording is judged as a whole: nothing of it is forgotten.
    let settings = Settings { memory_s: f64::INFINITY, gravity_m_s2, wanted: wanted.clone(), ..Settings::default() };
    match replay(recordings, task, &settings) {
        Ok(online) if online.knows_something() => online.enough(&fit.parameters),
        _ if task == Task::Crank => judge(&fit.parameters, &crank_problems_of(recordings, fit, FREE_ROW_S), wanted),
        _ => judge(&fit.parameters, &[], wanted),
    }
}
