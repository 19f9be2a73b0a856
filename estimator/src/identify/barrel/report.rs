//! What the barrel's recording shows, in the words of a fit.

use super::cable::Cable;
use super::pull::{GEOMETRY, GROWTH, Pull, STIFFNESS};
use super::signals::Signals;
use super::wall::Grip;
use super::zero::Zero;
use super::{CABLE, OBJECT};
use crate::constraint::{Carry, carried};
use crate::estimate::{Constraint, ConstraintKind, Fit, Parameter, Sided, Yielding};
use haptics::Vec2;
use haptics::recording::Recording;

/// Width of a barrel whose sides' give could not be measured: the thesis's blocks came out 7 % too narrow.
const UNKNOWN_COMPRESSION: f64 = 0.07;
/// A wall's give counts when it is this many standard errors above zero.
const SEEN: f64 = 3.0;
/// What a cable's pull is off by along and across, as a share of it: fingers that move the barrel feel it a little late, and their
/// sensors' axes are not quite those of their positions.
const PULL_SHARE: f64 = 1e-3;
/// What that does to the distance of the anchor and to the stiffness, as a share.
const GEOMETRY_SHARE: f64 = 2e-3;
const STIFFNESS_SHARE: f64 = 0.01;
/// Held a little above or below where the cable is tied, the barrel swings by about this way, m, and by this way while the pull grows.
const SWINGS_M: f64 = 2.5e-4;
const SWINGS_AS_PULLED_M: f64 = 5e-5;
/// Stiffness of a hand whose give was not seen, N/m.
const HAND_N_M: f64 = 1000.0;

/// Everything that was found out.
pub(super) struct Seen<'a> {
    pub(super) recording: &'a Recording,
    pub(super) signals: &'a Signals,
    pub(super) grip: Grip,
    pub(super) zero: Zero,
    pub(super) pull: Pull,
    /// The same with pads that give one standard error more, along x and along y.
    pub(super) others: Vec<Pull>,
    pub(super) rows: usize,
    pub(super) gravity: f64,
    /// What the sidecar states: N/m, m, kg.
    pub(super) pad_n_m: Option<f64>,
    pub(super) height_m: Option<f64>,
    pub(super) empty_kg: Option<f64>,
}

type Value = (f64, f64);

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

    fn given(&self, object: &str, name: &str, (value, error): Value, how: &str) -> Parameter {
        Parameter::identified(object, name, value, error, self.rows, how)
    }

    fn missing(&self, object: &str, name: &str, why: &str) -> Parameter {
        Parameter::unidentified(object, name, self.rows, why)
    }

    /// Mass in the middle of the time that it hung, kg.
    fn mass_kg(&self) -> Value {
        let zero_kg = if self.gravity > 0.0 { self.zero.error_n / self.gravity } else { f64::INFINITY };
        let change = |other: &Pull| other.values[0] - self.pull.values[0];
        let pull_kg = if self.gravity > 0.0 { PULL_SHARE * self.strongest_n() / self.gravity } else { 0.0 };
        let own = self.pull.around.std_errors[0].hypot(zero_kg).hypot(pull_kg);
        (self.pull.values[0], self.others.iter().map(change).fold(own, f64::hypot))
    }

    fn weight(&self) -> Vec<Parameter> {
        let (mass, error) = self.mass_kg();
        let when = format!(" while it hung, at {:.2} s in the middle", self.pull.middle_s);
        let how = format!("force of both fingers{when}, less accelerations, zero and the cable's pull");
        vec![
            self.given(OBJECT, "weight_N", (mass * self.gravity, error * self.gravity), &how),
            self.given(OBJECT, "mass_kg", (mass, error), "weight divided by gravity"),
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
        Parameter::identified(OBJECT, "width_m", value, error, self.grip.samples, how)
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
        let series = self.given(OBJECT, SERIES, stiffness(give), "give of one pad and the wall behind it together");
        let wall = match self.pad_n_m {
            None => {
                let why = "pad and wall give together, and this recording does not tell whose share is whose; state the pads' \
                           own stiffness as known pad_stiffness_N_m (from a block or a crank)";
                self.missing(OBJECT, WALL, why)
            }
            Some(pad_n_m) => {
                let left = give - 1.0 / pad_n_m;
                if left > SEEN * error {
                    let how = "what pads of the stated stiffness leave of the give of the sides";
                    self.given(OBJECT, WALL, stiffness(left), how)
                } else if left > -SEEN * error {
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

    /// What may be in it: mass per volume of a cylinder as wide as the barrel.
    fn contents(&self) -> Vec<Parameter> {
        const DENSITY: &str = "density_kg_m3";
        let (mass, mass_error) = self.mass_kg();
        let (width, width_error) = self.width_m();
        let Some(height) = self.height_m else {
            let why = "fingers at the sides do not show how tall it is; state it as known height_m";
            return vec![self.missing(OBJECT, DENSITY, why)];
        };
        let volume = 0.25 * std::f64::consts::PI * width * width * height;
        let over = |kg: f64| {
            let density = kg / volume;
            (density, density * (mass_error / kg).hypot(2.0 * width_error / width))
        };
        let how = "mass over the volume of a cylinder of the measured width and the stated height";
        let mut found = vec![self.given(OBJECT, DENSITY, over(mass), how)];
        if let Some(empty) = self.empty_kg {
            let content = mass - empty;
            found.push(self.given(
                OBJECT,
                "content_mass_kg",
                (content, mass_error),
                "mass less the stated empty_mass_kg",
            ));
            if content > SEEN * mass_error {
                let how = "mass of the contents over the volume of the whole barrel";
                found.push(self.given(OBJECT, "content_density_kg_m3", over(content), how));
            }
        }
        found
    }

    fn leak(&self) -> Parameter {
        const LEAK: &str = "leak_kg_s";
        let Some((drift, drift_error)) = self.zero.drift_n_s.filter(|_| self.gravity > 0.0) else {
            let why = "a leak cannot be told from a drift of the force sensors: free motion is needed before the first grip and \
                       after the last";
            return self.missing(OBJECT, LEAK, why);
        };
        if !self.pull.around.identified[GROWTH] {
            return self.missing(OBJECT, LEAK, "it did not hang long enough to change its weight");
        }
        let value = drift / self.gravity - self.pull.values[GROWTH];
        // From slack to taut and back within the time that it hung.
        let pull_n_s = PULL_SHARE * self.strongest_n() / self.hung_s();
        let own = self.pull.around.std_errors[GROWTH].hypot(drift_error.hypot(pull_n_s) / self.gravity);
        let error = self.others.iter().map(|o| o.values[GROWTH] - self.pull.values[GROWTH]).fold(own, f64::hypot);
        let clear = if value > SEEN * error { "it loses weight" } else { "no loss stands out of the error" };
        let how = format!("how its weight falls while it hangs, less the drift of the sensors' zero: {clear}");
        self.given(OBJECT, LEAK, (value, error), &how)
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

    /// A value of the cable with its own error and what softer pads would change.
    fn of_cable(&self, own: f64, of: impl Fn(&Pull, &Cable) -> Option<f64>) -> Option<Value> {
        let value = |pull: &Pull| of(pull, pull.cable.as_ref()?);
        let best = value(&self.pull)?;
        let changes = self.others.iter().map(|other| value(other).map_or(0.0, |v| v - best));
        Some((best, changes.fold(own, f64::hypot)))
    }

    fn cable(&self) -> Vec<Parameter> {
        const GEOMETRIC: [&str; 3] = ["anchor_x_m", "anchor_y_m", "length_m"];
        let Some(cable) = &self.pull.cable else {
            let why = "nothing but its weight pulled at it; move it farther, also upwards";
            return vec![self.missing(CABLE, "stiffness_N_m", why)];
        };
        let errors = &self.pull.around.std_errors;
        let [angle, taut] = [errors[GEOMETRY], errors[GEOMETRY + 1].hypot(self.signals.resolution_m)];
        let mut found = Vec::new();
        let mut push = |name: &str, value: Option<Value>, how: &str| {
            found.extend(value.map(|value| self.given(CABLE, name, value, how)));
        };
        let how = "rise of the pull beyond the place where it sets in";
        push("stiffness_N_m", self.stiffness_n_m(), how);
        let how = "direction in which it holds back, from the horizontal, where it was taut";
        push("direction_rad", self.of_cable(angle, |_, c| Some(c.angle_rad)), how);
        let u = cable.away();
        let how = "where it gets taut, straight away from where it is tied";
        for (name, k) in [("taut_x_m", 0), ("taut_y_m", 1)] {
            let error = (taut * u[k]).hypot(self.signals.resolution_m);
            push(name, self.of_cable(error, |_, c| Some((c.about_m + c.away() * c.taut_m)[k])), how);
        }
        let strongest = self.strongest_n();
        let tension_error = strongest * errors[STIFFNESS] / self.pull.values[STIFFNESS];
        push(
            "largest_tension_N",
            Some((strongest, tension_error)),
            "stiffness times the farthest way beyond that place",
        );
        let (Some(anchor), Some(length)) = (cable.anchor_m(), cable.length_m()) else {
            let why = "the pull hardly turned: where it is tied, and so its length, stays open; move the barrel along an arc while \
                       the cable is taut";
            found.extend(GEOMETRIC.map(|name| self.missing(CABLE, name, why)));
            return found;
        };
        let [_, _, bend] = [0, 1, 2].map(|k| errors[GEOMETRY + k]);
        let far = 1.0 / cable.bend_1_m;
        // Along the pull the distance is uncertain, across it the direction.
        let covariance = self.pull.around.covariance[(GEOMETRY, GEOMETRY + 2)];
        let across = Vec2::new(-u.y, u.x);
        let model_m = (GEOMETRY_SHARE * far).hypot(SWINGS_M);
        let anchor_error = |k: usize| {
            let (by_angle, by_bend) = (-across[k] * far, u[k] * far * far);
            let square = (by_angle * angle).powi(2) + (by_bend * bend).powi(2) + 2.0 * by_angle * by_bend * covariance;
            square.max(0.0).sqrt().hypot(self.signals.resolution_m).hypot(model_m)
        };
        let with = self.pull.around.covariance[(GEOMETRY + 1, GEOMETRY + 2)];
        let square = (far * far * bend).powi(2) + taut * taut - 2.0 * far * far * with;
        let length_error = square.max(0.0).sqrt().hypot(model_m);
        let how = "where the directions of its pull meet, for the middle of the grip";
        let [x, y] = [0, 1].map(|k| self.of_cable(anchor_error(k), |_, c| c.anchor_m().map(|a| a[k])));
        let length_of = self.of_cable(length_error, |_, c| c.length_m());
        debug_assert!(anchor.iter().all(|v| v.is_finite()) && length.is_finite());
        for (name, value) in GEOMETRIC.into_iter().zip([x, y, length_of]) {
            let how = if name == "length_m" { "from there to where the pull sets in" } else { how };
            found.extend(value.map(|value| self.given(CABLE, name, value, how)));
        }
        found
    }

    fn stiffness_n_m(&self) -> Option<Value> {
        let stiffness = self.pull.values.get(STIFFNESS)?;
        let stretch_m = self.strongest_n() / stiffness;
        let model = stiffness * STIFFNESS_SHARE.hypot(SWINGS_AS_PULLED_M / stretch_m);
        let own = self.pull.around.std_errors[STIFFNESS].hypot(model);
        self.of_cable(own, |p, _| Some(p.values[STIFFNESS]))
    }

    fn strongest_n(&self) -> f64 {
        let Some(cable) = &self.pull.cable else { return 0.0 };
        let give = self.grip.give_m_n();
        let give = Vec2::new(give[0].0, give[1].0);
        let place = |i: usize| self.signals.position[i] - self.signals.net_n[i].component_mul(&give);
        let stretch = self.signals.hanging().concat().into_iter().map(|i| cable.stretch(place(i)).0);
        self.pull.values[STIFFNESS] * stretch.fold(0.0, f64::max)
    }

    /// The cable as a constraint from one side; without one, whether anything else guides the barrel.
    fn constraint(&self) -> Option<Constraint> {
        let samples = self.signals.hanging().concat();
        let bias = self.signals.levels.bias_n;
        let tested = carried(&Carry {
            object: OBJECT,
            recording: &self.recording.name,
            signals: &self.signals.task,
            samples: &samples,
            bias_n: bias[0] + bias[1] + self.zero.net_n,
            bias_error_n: self.zero.error_n,
            gravity: self.gravity,
        });
        let Some(cable) = &self.pull.cable else { return tested };
        let blank = Constraint::blank(Some(self.recording.name.clone()), "");
        let (stiffness, error) = self.stiffness_n_m()?;
        let hand = self.grip.sides.as_ref().map_or(HAND_N_M, |s| 2.0 / s.give_m_per_n);
        let away = cable.away();
        Some(Constraint {
            kind: ConstraintKind::Unilateral,
            object: Some(OBJECT.to_owned()),
            center_m: cable.anchor_m().map(|a| vec![a.x, a.y]),
            radius_m: cable.length_m(),
            direction: Some(vec![away.x, away.y]),
            rigid: Some(false),
            sided: Some(Sided::OneSided),
            constraint_force_n: Some(-self.strongest_n()),
            yielding: Some(Yielding {
                stiffness_n_m: Some(stiffness),
                interval_n_m: ((stiffness - 1.96 * error).max(0.0), Some(stiffness + 1.96 * error)),
                manipulator_n_m: hand,
            }),
            evidence: format!(
                "a cable: a pull of up to {:.2} N that sets in beyond one place and grows with {stiffness:.0} N/m, taut in {} of {} \
                 independent samples",
                self.strongest_n(),
                self.pull.taut,
                self.rows
            ),
            ..tested.unwrap_or(blank)
        })
    }
}
