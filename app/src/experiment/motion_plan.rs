//! Experiment on a directly driven mechanism: its desired coordinate over time. A person performs it on the real
//! machine according to the plan, the scripted operator on simulated ones.

use super::along_path::{PLACES, seen_by_tool};
use super::perform::what_is_known;
use super::sensing::see_along;
use crate::experiment::like::Like;
use crate::experiment::simulated::SIMULATED;
use estimator::diagnose::{Experiment, Strokes, Suspect};
use estimator::signal::noise::{white_noise, white_noise_under_fast_motion};
use haptics::device::{Pull, PullSensor};
use haptics::law::{Coordinate, EccentricMass, Effect, Inertia};
use haptics::recording::Recording;
use haptics::world::{Mechanism, MechanismPath};
use std::fmt::Write as _;

/// Rest before and after, s, and time in which it comes to rest: a machine that follows the plan must not be stopped
/// hard.
const REST_S: f64 = 0.5;
const SLOWS_S: f64 = 2.0;
/// Sampling rate of a plan in a file, Hz.
const FILE_HZ: f64 = 50.0;
/// Maximum sampling rate of a simulated recording, Hz.
const FASTEST_HZ: f64 = 1_000.0;

/// Desired coordinate over time.
#[derive(Clone, Debug)]
pub struct MotionPlan {
    strokes: Strokes,
    asked: Experiment,
}

impl MotionPlan {
    /// Plan of an experiment; an error gives the reason why there is none.
    pub fn new(asked: &Experiment) -> Result<Self, String> {
        let strokes = Strokes::of(asked).ok_or_else(|| {
            format!("Nobody here knows the motion `{}`; do it on the real object and load the recording.", asked.id)
        })?;
        Ok(Self { strokes, asked: asked.clone() })
    }

    /// Duration, s.
    pub fn duration_s(&self) -> f64 {
        self.asked.seconds + 0.5 * SLOWS_S + 2.0 * REST_S
    }

    /// Desired coordinate, m or rad.
    pub fn at(&self, time_s: f64) -> f64 {
        let slows_from_s = self.asked.seconds - 0.5 * SLOWS_S;
        // From there its clock slows down (cos²), until it stops at the last stroke.
        let slowing = ((time_s - REST_S - slows_from_s) / SLOWS_S).clamp(0.0, 1.0);
        let slowed_s = SLOWS_S * (0.5 * slowing + (std::f64::consts::PI * slowing).sin() / std::f64::consts::TAU);
        let moved_s = (time_s - REST_S).clamp(0.0, slows_from_s) + slowed_s;
        self.strokes.at(moved_s).coordinate
    }

    /// Lowest and highest coordinate, m or rad.
    pub fn range(&self) -> (f64, f64) {
        (self.asked.middle - self.asked.half_range, self.asked.middle + self.asked.half_range)
    }

    /// Plan as a table with the column names of logs: the coordinate over time.
    pub fn to_csv(&self, coordinate: Coordinate) -> String {
        self.table(&names(coordinate)[..1], &|q| vec![q])
    }

    /// Plan for a tool: its position over time, in the frame of its recording and in as many axes as that has.
    pub fn places_to_csv(&self, path: &MechanismPath, is_planar: bool) -> String {
        let axes = if is_planar { 2 } else { 3 };
        self.table(&PLACES[..axes], &|q| path.point_m(q)[..axes].to_vec())
    }

    fn table(&self, names: &[&str], row: &dyn Fn(f64) -> Vec<f64>) -> String {
        let mut text = format!("t_s,{}\n", names.join(","));
        for k in 0..=(self.duration_s() * FILE_HZ) as u32 {
            let time_s = f64::from(k) / FILE_HZ;
            let numbers: Vec<String> = row(self.at(time_s)).iter().map(|value| format!("{value:.6}")).collect();
            // Writing into a string cannot fail.
            let _ = writeln!(text, "{time_s:.3},{}", numbers.join(","));
        }
        text
    }

    /// Simulated recording of the scripted operator with the mechanism of a candidate cause, with the sensors of
    /// `like`. `None` if `goes_on` returns false; an error is a sentence.
    pub fn perform(
        &self,
        suspect: &Suspect,
        about: &str,
        like: &Like<'_>,
        seed: u64,
        goes_on: &dyn Fn(f64) -> bool,
    ) -> Result<Option<Recording>, String> {
        let mechanism = suspect.world.mechanism.as_ref().ok_or("There is no mechanism in this world.")?;
        let by_tool = like.recording.channel(names(mechanism.coordinate)[0]).is_none();
        if by_tool && mechanism.path.is_none() {
            return Err(
                "The tool's path is neither a line nor a circle, so it cannot be rehearsed. Do it on the real one and \
                        load the recording."
                    .to_owned(),
            );
        }
        let hung = self.hung(mechanism, suspect.hung_share, suspect.world.gravity_m_s2);
        let pull = Pull {
            mechanism: &hung,
            seconds: self.duration_s(),
            rate_hz: rate_hz(like.recording)?,
            wanted: &|time_s| self.at(time_s),
            half_range: self.asked.half_range,
            fast: self.asked.fast,
        };
        let Some(pulled) = pull.run(seed, goes_on)? else { return Ok(None) };
        // A tool has other sensors: their noise is added later.
        let sensor = if by_tool { PullSensor::default() } else { sensor(like.recording, mechanism.coordinate) };
        let name = format!("simulated, {about}");
        let mut recording = sensor.recording(&name, mechanism.coordinate, &pulled, seed);
        see_along(&mut recording, &suspect.fault);
        if let Some(path) = mechanism.path.as_ref().filter(|_| by_tool) {
            recording = seen_by_tool(&recording, path, like, seed);
        }
        recording.meta.gravity_m_s2 = like.recording.meta.gravity_m_s2;
        recording.meta.up.clone_from(&like.recording.meta.up);
        recording.meta.other.insert(SIMULATED.to_owned(), about.into());
        recording.meta.known.extend(what_is_known(&self.asked));
        if self.asked.added_weight_n > 0.0 {
            let lever = [("added_lever_m", self.asked.added_lever_m), ("added_level_rad", self.asked.middle)];
            recording.meta.known.extend(lever.map(|(name, value)| (name.to_owned(), value)));
        }
        Ok(Some(recording))
    }

    /// Mechanism with the added weight on its lever, which is horizontal in the middle of the motion.
    fn hung(&self, mechanism: &Mechanism, share: f64, gravity_m_s2: f64) -> Mechanism {
        let mut mechanism = mechanism.clone();
        let (weight_n, lever_m) = (self.asked.added_weight_n, self.asked.added_lever_m);
        if weight_n > 0.0 && mechanism.coordinate == Coordinate::Angular {
            let (sin, cos) = self.asked.middle.sin_cos();
            let moment = share * weight_n * lever_m;
            mechanism.effects.push(Effect::new(&EccentricMass, &[moment * sin, moment * cos]));
            let added = weight_n * lever_m * lever_m / gravity_m_s2.max(1e-9);
            mechanism.effects.push(Effect::new(&Inertia, &[added]));
        }
        mechanism
    }
}

/// Columns of the coordinate, its rate and the drive.
fn names(coordinate: Coordinate) -> [&'static str; 3] {
    match coordinate {
        Coordinate::Linear => ["q_m", "dq_m_s", "f_N"],
        Coordinate::Angular => ["q_rad", "dq_rad_s", "tau_Nm"],
    }
}

/// Sampling rate of the first recording, Hz.
pub(super) fn rate_hz(recording: &Recording) -> Result<f64, String> {
    let times = recording.time_s.as_deref().unwrap_or_default();
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    let usual = steps.get(steps.len() / 2).copied().filter(|step| *step > 0.0);
    let usual = usual.ok_or("The recording has no clock, so no motion can be planned after it.")?;
    Ok((1.0 / usual).min(FASTEST_HZ))
}

/// Sensors with the noise of a recording.
fn sensor(recording: &Recording, coordinate: Coordinate) -> PullSensor {
    let [position, rate, drive] = names(coordinate).map(|name| recording.channel(name));
    PullSensor {
        position: position.map_or(0.0, white_noise_under_fast_motion),
        rate: rate.map(white_noise),
        drive: drive.map_or(0.0, white_noise),
    }
}

#[cfg(test)]
mod tests {
    use super::super::timetable::tests::asked;
    use super::*;

    #[test]
    fn the_plan_rests_at_both_ends_stays_in_its_range_and_can_be_read_as_a_table() {
        let asked_for = Experiment { seconds: 20.0, ..asked("sweep-across") };
        let plan = MotionPlan::new(&asked_for).expect("a motion of the library");
        let (low, high) = plan.range();
        assert!((plan.at(0.0) - 12.0).abs() < 1e-12 && (plan.at(0.4) - 12.0).abs() < 1e-12);
        let all: Vec<f64> = (0..2_200).map(|k| plan.at(f64::from(k) * 0.01)).collect();
        assert!(all.iter().all(|q| (low - 1e-9..=high + 1e-9).contains(q)));
        assert!(all.iter().any(|q| *q > high - 0.05) && all.iter().any(|q| *q < low + 0.05), "it goes to both ends");
        let speeds: Vec<f64> = all.windows(2).map(|pair| (pair[1] - pair[0]) / 0.01).collect();
        let jolt = speeds.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        assert!(
            jolt < 0.3 && speeds[speeds.len() - 1].abs() < 1e-9,
            "it never starts or stops hard: {jolt} rad/s in 10 ms"
        );
        let text = plan.to_csv(Coordinate::Angular);
        assert!(text.starts_with("t_s,q_rad\n0.000,12.000000\n"));
        assert_eq!(text.lines().count(), 1 + 1 + (22.0 * FILE_HZ) as usize);
        let path = MechanismPath::Prismatic { origin_m: [0.5, 1.0, -2.0], direction: [0.0, 0.0, 1.0] };
        assert!(plan.places_to_csv(&path, true).starts_with("t_s,x_m,y_m\n0.000,0.500000,1.000000\n"));
        assert!(plan.places_to_csv(&path, false).starts_with("t_s,x_m,y_m,z_m\n0.000,0.500000,1.000000,10.000000\n"));
        assert!(MotionPlan::new(&asked("carry-still")).is_err_and(|why| why.ends_with('.')));
    }
}
