//! Report of a barrel's parameters from its recording, as a fit.

use super::cable::Cable;
use super::cable_force::{Column, Pull};
use super::sensor_zero::SensorZero;
use super::signals::Signals;
use super::wall_stiffness::Grip;
use crate::identify::limits::SIGNIFICANT;
use crate::identify::pads::UNKNOWN_COMPRESSION;
use crate::online::leak::{Series, Weighing, leak_or_drift};
use foundation::estimate::{Fit, Parameter};
use haptics::Vec2;
use haptics::recording::Recording;
use nalgebra::DMatrix;

/// The object's name in the results.
pub(crate) const OBJECT: &str = "barrel";
/// Object name of the cable that holds it.
pub(crate) const CABLE: &str = "cable";

/// Error of a cable's pull along and across, as a share of it: fingers that move the barrel feel it a little late, and
/// their sensors' axes are not quite those of their positions.
/// Choice: no case of the ablation reads it.
const PULL_SHARE: f64 = 2e-4;

/// Everything that was found out.
pub(super) struct Seen<'a> {
    pub(super) recording: &'a Recording,
    pub(super) signals: &'a Signals,
    pub(super) grip: Grip,
    pub(super) taken: Taken,
    pub(super) gravity: f64,
    /// Values stated in the sidecar: N/m, m, kg.
    pub(super) pad_n_m: Option<f64>,
    pub(super) height_m: Option<f64>,
    pub(super) empty_kg: Option<f64>,
}

pub(super) type Value = (f64, f64);

/// Standard error of a column by a covariance.
pub(super) fn error_of(covariance: &DMatrix<f64>, column: usize) -> f64 {
    covariance[(column, column)].max(0.0).sqrt()
}

impl Seen<'_> {
    pub(super) fn report(&self) -> Fit {
        let mut parameters = self.weight();
        parameters.push(self.width());
        parameters.extend(self.sides());
        parameters.extend(self.contents());
        parameters.push(self.leak());
        parameters.push(self.friction());
        parameters.extend(self.cable());
        let mut warnings = self.signals.segmentation.warnings.clone();
        if self.signals.lifts() > 1 {
            warnings.push(format!("{} lifts are taken as lifts of one barrel", self.signals.lifts()));
        }
        Fit {
            task: "barrel".to_owned(),
            parameters,
            constraints: self.constraint().into_iter().collect(),
            warnings,
            ..Fit::default()
        }
    }

    /// A value with its error by the fit's covariance, and beside it that by resampling: `of` gives both out of a covariance of the
    /// pull's columns.
    pub(super) fn given_by(
        &self,
        object: &str,
        name: &str,
        of: impl Fn(&DMatrix<f64>) -> Value,
        how: &str,
    ) -> Parameter {
        let drawn = self.taken.pull.resampled.as_ref().map(|r| of(r.covariance()).1);
        self.given(object, name, of(&self.taken.pull.around.covariance), how).with_bootstrap(drawn)
    }

    pub(super) fn given(&self, object: &str, name: &str, (value, error): Value, how: &str) -> Parameter {
        Parameter::identified(object, name, value, error, self.taken.rows, how)
    }

    pub(super) fn missing(&self, object: &str, name: &str, why: &str) -> Parameter {
        Parameter::unidentified(object, name, self.taken.rows, why)
    }

    /// Mass in the middle of the time that it hung, kg.
    fn mass_kg(&self) -> Value {
        self.mass_by(&self.taken.pull.around.covariance)
    }

    fn mass_by(&self, covariance: &DMatrix<f64>) -> Value {
        let zero_kg = if self.gravity > 0.0 { self.taken.zero.error_n / self.gravity } else { f64::INFINITY };
        let change = |other: &Pull| other.values[0] - self.taken.pull.values[0];
        let pull_kg = if self.gravity > 0.0 { PULL_SHARE * self.strongest_n() / self.gravity } else { 0.0 };
        let own = error_of(covariance, Column::Mass as usize).hypot(zero_kg).hypot(pull_kg);
        (self.taken.pull.values[0], self.taken.others.iter().map(change).fold(own, f64::hypot))
    }

    fn weight(&self) -> Vec<Parameter> {
        let times = |by: f64| move |(mass, error): Value| (mass * by, error * by);
        let when = format!(" while it hung, at {:.2} s in the middle", self.taken.pull.middle_s);
        let how = format!("force of both fingers{when}, less accelerations, zero and the cable's pull");
        vec![
            self.given_by(OBJECT, "weight_N", |c| times(self.gravity)(self.mass_by(c)), &how),
            self.given_by(OBJECT, "mass_kg", |c| self.mass_by(c), "weight divided by gravity"),
        ]
    }

    fn width_m(&self) -> Value {
        let resolution = std::f64::consts::SQRT_2 * self.signals.resolution_m;
        match &self.grip.sides {
            Some(sides) => (sides.width_m, sides.width_error_m.hypot(resolution)),
            None => (self.grip.mean_width_m, UNKNOWN_COMPRESSION * self.grip.mean_width_m),
        }
    }

    fn width(&self) -> Parameter {
        let how = match &self.grip.sides {
            Some(_) => "distance of the tips while held, extrapolated to zero grip force",
            None => "mean distance of the tips; the grip was too even to tell the give, so 7 % is added to the error",
        };
        let (value, error) = self.width_m();
        let resolution = std::f64::consts::SQRT_2 * self.signals.resolution_m;
        let resampled = self.grip.sides.and_then(|s| s.resampled).map(|(width, _)| width.hypot(resolution));
        Parameter::identified(OBJECT, "width_m", value, error, self.grip.samples, how).with_bootstrap(resampled)
    }

    /// Pad and wall together, and the wall by itself where the pads are known.
    fn sides(&self) -> [Parameter; 2] {
        const SERIES: &str = "grip_stiffness_N_m";
        const WALL: &str = "wall_stiffness_N_m";
        let Some(sides) = &self.grip.sides else {
            let why = "the grip varied too little to tell how the sides give; squeeze harder for a moment";
            return [SERIES, WALL].map(|name| self.missing(OBJECT, name, why));
        };
        let (give, error) = (sides.give_m_per_n, sides.give_error);
        let stiffness = |give: f64| (1.0 / give, error / (give * give));
        let resampled = sides.resampled.map(|(_, drawn)| drawn / (give * give));
        let series = self
            .given(OBJECT, SERIES, stiffness(give), "give of one pad and the wall behind it together")
            .with_bootstrap(resampled);
        let wall = match self.pad_n_m {
            None => {
                let why = "pad and wall give together, and this recording does not tell whose share is whose; state the pads' \
                           own stiffness as known pad_stiffness_N_m (from a block or a crank)";
                self.missing(OBJECT, WALL, why)
            }
            Some(pad_n_m) => {
                let left = give - 1.0 / pad_n_m;
                if left > SIGNIFICANT * error {
                    let how = "what pads of the stated stiffness leave of the give of the sides";
                    let drawn = sides.resampled.map(|(_, drawn)| drawn / (left * left));
                    self.given(OBJECT, WALL, stiffness(left), how).with_bootstrap(drawn)
                } else if left > -SIGNIFICANT * error {
                    let least = 1.0 / (left + 2.0 * error);
                    let why = format!("the pads explain all of the give: the wall is stiffer than {least:.0} N/m");
                    self.missing(OBJECT, WALL, &why)
                } else {
                    let why = format!("the sides give less than pads of {pad_n_m:.0} N/m do; check what is stated");
                    self.missing(OBJECT, WALL, &why)
                }
            }
        };
        [series, wall]
    }

    /// Density of the contents: mass per volume of a cylinder as wide as the barrel.
    fn contents(&self) -> Vec<Parameter> {
        const DENSITY: &str = "density_kg_m3";
        let (mass, mass_error) = self.mass_kg();
        let (width, width_error) = self.width_m();
        let Some(height) = self.height_m else {
            let why = "fingers at the sides do not show how tall it is; state it as known height_m";
            return vec![self.missing(OBJECT, DENSITY, why)];
        };
        let volume = 0.25 * std::f64::consts::PI * width * width * height;
        let over = |kg: f64, error: f64| {
            let density = kg / volume;
            (density, density * (error / kg).hypot(2.0 * width_error / width))
        };
        let how = "mass over the volume of a cylinder of the measured width and the stated height";
        let density = |c: &DMatrix<f64>| over(mass, self.mass_by(c).1);
        let mut found = vec![self.given_by(OBJECT, DENSITY, density, how)];
        if let Some(empty) = self.empty_kg {
            let content = mass - empty;
            let how = "mass less the stated empty_mass_kg";
            found.push(self.given_by(OBJECT, "content_mass_kg", |c| (content, self.mass_by(c).1), how));
            if content > SIGNIFICANT * mass_error {
                let how = "mass of the contents over the volume of the whole barrel";
                let density = |c: &DMatrix<f64>| over(content, self.mass_by(c).1);
                found.push(self.given_by(OBJECT, "content_density_kg_m3", density, how));
            }
        }
        found
    }

    fn leak(&self) -> Parameter {
        const LEAK: &str = "leak_kg_s";
        let Some((drift, drift_error)) = self.taken.zero.drift_n_s.filter(|_| self.gravity > 0.0) else {
            let why = "a leak cannot be told from a drift of the force sensors: free motion is needed before the first grip and \
                       after the last";
            return self.missing(OBJECT, LEAK, why);
        };
        if !self.taken.pull.around.identified[Column::Growth as usize] {
            return self.missing(OBJECT, LEAK, "it did not hang long enough to change its weight");
        }
        let value = drift / self.gravity - self.taken.pull.values[Column::Growth as usize];
        // From slack to taut and back within the time that it hung.
        let pull_n_s = PULL_SHARE * self.strongest_n() / self.hung_s();
        let systematic = drift_error.hypot(pull_n_s) / self.gravity;
        let change =
            |other: &Pull| other.values[Column::Growth as usize] - self.taken.pull.values[Column::Growth as usize];
        let error = |c: &DMatrix<f64>| {
            self.taken
                .others
                .iter()
                .map(change)
                .fold(error_of(c, Column::Growth as usize).hypot(systematic), f64::hypot)
        };
        let words = self.verdict().unwrap_or_default();
        let how = format!("how its weight falls while it hangs, less the drift of the sensors' zero; {words}");
        self.given_by(OBJECT, LEAK, |c| (value, error(c)), &how)
    }

    /// Verdict on the change of its weight, in words: leak, drift, both, or nothing.
    fn verdict(&self) -> Option<String> {
        let signals = self.signals;
        let hanging = signals.hanging().concat();
        let give = self.grip.give_m_n();
        let held_n = |i: usize| {
            let place = signals.position[i] - signals.net_n[i].component_mul(&Vec2::new(give[0].0, give[1].0));
            let pull = |c: &Cable| {
                let (stretch_m, away) = c.stretch(place);
                self.taken.pull.values[Column::Stiffness as usize] * stretch_m.max(0.0) * away.y
            };
            self.taken.pull.values[0] * signals.acceleration[i].y + self.taken.pull.cable.as_ref().map_or(0.0, pull)
        };
        let times = |samples: &[usize]| samples.iter().map(|i| signals.time_s[*i]).collect::<Vec<f64>>();
        let carried: Vec<f64> = hanging.iter().map(|i| signals.task.net_force_n[*i].y - held_n(*i)).collect();
        let free: Vec<f64> = signals.levels.free.iter().map(|i| signals.task.net_force_n[*i].y).collect();
        let (carried_s, free_s) = (times(&hanging), times(&signals.levels.free));
        let carried = Series { time_s: &carried_s, force_n: &carried };
        let free = Series { time_s: &free_s, force_n: &free };
        leak_or_drift(&Weighing::new(carried, free, self.gravity)).ok().map(|answer| answer.why)
    }

    fn hung_s(&self) -> f64 {
        let samples = self.signals.hanging().concat();
        let time = |i: Option<&usize>| i.map_or(0.0, |i| self.signals.time_s[*i]);
        (time(samples.last()) - time(samples.first())).max(1e-3)
    }

    fn friction(&self) -> Parameter {
        let held = self.signals.held();
        let firm = |i: &&usize| self.signals.grip_n[**i] > 0.25 * self.grip.mean_n;
        let largest = held.iter().filter(firm).map(|i| self.signals.ratio[*i]).fold(0.0, f64::max);
        let error = self.signals.levels.force_noise_n * largest.hypot(1.0) / self.grip.mean_n.max(1e-9);
        let how = "largest ratio of vertical to horizontal tip force while held; true friction is at least this";
        self.given(OBJECT, "friction_lower_bound", ((largest - error).max(0.0), error), how)
    }
}

/// Estimates on which the report is based.
pub(super) struct Taken {
    pub(super) pull: Pull,
    /// The same with pads that give one standard error more, along x and along y, and with the grip one higher.
    pub(super) others: Vec<Pull>,
    /// Displacement of its middle from that of the fingers by turning in the grip, m.
    pub(super) turned_m: f64,
    /// Slip of the barrel down in the grip while a cable pulled, m.
    pub(super) slipped_m: Option<f64>,
    pub(super) rows: usize,
    pub(super) zero: SensorZero,
}
