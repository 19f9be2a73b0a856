//! The cable that holds a barrel, as parameters and as a constraint from one side.

use super::cable::Cable;
use super::cable_force::{Column, Pull};
use super::report::{CABLE, OBJECT, Seen, Value, error_of};
use crate::constraint::{Carry, carried};
use crate::identify::pads::HAND_N_M;
use crate::regression::long_run_variance::HALF_INTERVAL;
use foundation::estimate::{Constraint, ConstraintKind, Parameter, Sided, Yielding};
use haptics::Vec2;
use nalgebra::DMatrix;

/// Uncertainty of the shift of the barrel's middle, as a share of it: held above or below its middle, a pulled barrel
/// turns in the grip.
/// Choice: no case of the ablation reads it.
const GRIP_TURN_SHARE: f64 = 0.25;
/// Uncertainty of that shift, as a share of the barrel's size.
/// Choice: no case of the ablation reads it.
const SWINGS: f64 = 0.0016;
/// The same while the pull grows.
/// Choice: no case of the ablation reads it.
const SWINGS_AS_PULLED: f64 = 5.6e-4;
/// Parameters that are identifiable only if the pull turns.
const GEOMETRIC: [&str; 3] = ["anchor_x_m", "anchor_y_m", "length_m"];

impl Seen<'_> {
    /// A value of the cable with its own error and the changes by softer pads.
    fn of_cable(&self, own: f64, of: impl Fn(&Pull, &Cable) -> Option<f64>) -> Option<Value> {
        let value = |pull: &Pull| of(pull, pull.cable.as_ref()?);
        let best = value(&self.taken.pull)?;
        let changes = self.taken.others.iter().map(|other| value(other).map_or(0.0, |v| v - best));
        Some((best, changes.fold(own, f64::hypot)))
    }

    pub(super) fn cable(&self) -> Vec<Parameter> {
        if let Some(way_m) = self.taken.slipped_m {
            let why = format!(
                "the barrel slid {:.2} mm in the grip while it was pulled: it was not where the fingers were; squeeze harder",
                1e3 * way_m.abs()
            );
            return ["stiffness_N_m"]
                .into_iter()
                .chain(GEOMETRIC)
                .map(|name| self.missing(CABLE, name, &why))
                .collect();
        }
        let Some(cable) = &self.taken.pull.cable else {
            let why = "nothing but its weight pulled at it; move it farther, also upwards";
            return vec![self.missing(CABLE, "stiffness_N_m", why)];
        };
        let u = cable.away();
        let mut found = Vec::new();
        let mut push = |name: &str, own: &dyn Fn(&DMatrix<f64>) -> f64, of: &dyn Fn(&Cable) -> f64, how: &str| {
            let value = |c: &DMatrix<f64>| self.of_cable(own(c), |_, cable| Some(of(cable)));
            found.extend(self.of_covariance(name, value, how));
        };
        let taut = |c: &DMatrix<f64>| error_of(c, Column::Geometry as usize + 1).hypot(self.signals.resolution_m);
        let how = "direction in which it holds back, from the horizontal, where it was taut";
        push("direction_rad", &|c| error_of(c, Column::Geometry as usize), &|cable| cable.angle_rad, how);
        let how = "where it gets taut, straight away from where it is tied";
        for (name, k) in [("taut_x_m", 0), ("taut_y_m", 1)] {
            let own = |c: &DMatrix<f64>| (taut(c) * u[k]).hypot(self.signals.resolution_m);
            push(name, &own, &|cable| (cable.about_m + cable.away() * cable.taut_m)[k], how);
        }
        let how = "rise of the pull beyond the place where it sets in";
        found.extend(self.of_covariance("stiffness_N_m", |c| self.stiffness_by(c), how));
        let strongest = self.strongest_n();
        let tension = |c: &DMatrix<f64>| {
            Some((
                strongest,
                strongest * error_of(c, Column::Stiffness as usize)
                    / self.taken.pull.values[Column::Stiffness as usize],
            ))
        };
        let how = "stiffness times the farthest way beyond that place";
        found.extend(self.of_covariance("largest_tension_N", tension, how));
        found.extend(self.tied(cable));
        found
    }

    /// A parameter of the cable from a covariance of the pull's regressors.
    fn of_covariance(&self, name: &str, of: impl Fn(&DMatrix<f64>) -> Option<Value>, how: &str) -> Option<Parameter> {
        of(&self.taken.pull.around.covariance)?;
        Some(self.given_by(CABLE, name, |c| of(c).unwrap_or_default(), how))
    }

    /// Anchor and length of the cable.
    fn tied(&self, cable: &Cable) -> Vec<Parameter> {
        if cable.anchor_m().is_none() {
            let why = "the pull hardly turned: where it is tied, and so its length, stays open; move the barrel along an arc while \
                       the cable is taut";
            return GEOMETRIC.map(|name| self.missing(CABLE, name, why)).to_vec();
        }
        let (u, far) = (cable.away(), 1.0 / cable.bend_1_m);
        // Along the pull the distance is uncertain, across it the direction.
        let across = Vec2::new(-u.y, u.x);
        let model_m = (SWINGS * self.signals.task.object_m()).hypot(GRIP_TURN_SHARE * self.taken.turned_m);
        let anchor_error = |k: usize, c: &DMatrix<f64>| {
            let (by_angle, by_bend) = (-across[k] * far, u[k] * far * far);
            let square = (by_angle * error_of(c, Column::Geometry as usize)).powi(2)
                + (by_bend * error_of(c, Column::Geometry as usize + 2)).powi(2)
                + 2.0 * by_angle * by_bend * c[(Column::Geometry as usize, Column::Geometry as usize + 2)];
            square.max(0.0).sqrt().hypot(self.signals.resolution_m).hypot(model_m)
        };
        let length_error = |c: &DMatrix<f64>| {
            let taut = error_of(c, Column::Geometry as usize + 1).hypot(self.signals.resolution_m);
            let square = (far * far * error_of(c, Column::Geometry as usize + 2)).powi(2) + taut * taut
                - 2.0 * far * far * c[(Column::Geometry as usize + 1, Column::Geometry as usize + 2)];
            square.max(0.0).sqrt().hypot(model_m)
        };
        let anchor = |k: usize| {
            move |c: &DMatrix<f64>| self.of_cable(anchor_error(k, c), |_, cable| cable.anchor_m().map(|a| a[k]))
        };
        let length = |c: &DMatrix<f64>| self.of_cable(length_error(c), |_, cable| cable.length_m());
        let how = "where the directions of its pull meet, for the middle of the grip";
        let found = [
            self.of_covariance(GEOMETRIC[0], anchor(0), how),
            self.of_covariance(GEOMETRIC[1], anchor(1), how),
            self.of_covariance(GEOMETRIC[2], length, "from there to where the pull sets in"),
        ];
        found.into_iter().flatten().collect()
    }

    fn stiffness_n_m(&self) -> Option<Value> {
        self.stiffness_by(&self.taken.pull.around.covariance)
    }

    fn stiffness_by(&self, covariance: &DMatrix<f64>) -> Option<Value> {
        let stiffness = self.taken.pull.values.get(Column::Stiffness as usize)?;
        let stretch_m = self.strongest_n() / stiffness;
        let model = stiffness
            * (SWINGS_AS_PULLED * self.signals.task.object_m()).hypot(GRIP_TURN_SHARE * self.taken.turned_m)
            / stretch_m;
        let own = error_of(covariance, Column::Stiffness as usize).hypot(model);
        self.of_cable(own, |p, _| Some(p.values[Column::Stiffness as usize]))
    }

    pub(super) fn strongest_n(&self) -> f64 {
        let Some(cable) = &self.taken.pull.cable else { return 0.0 };
        let give = self.grip.give_m_n();
        let give = Vec2::new(give[0].0, give[1].0);
        let place = |i: usize| self.signals.position[i] - self.signals.net_n[i].component_mul(&give);
        let stretch = self.signals.hanging().concat().into_iter().map(|i| cable.stretch(place(i)).0);
        self.taken.pull.values[Column::Stiffness as usize] * stretch.fold(0.0, f64::max)
    }

    /// The cable as a constraint from one side; without one, whether anything else guides the barrel.
    pub(super) fn constraint(&self) -> Option<Constraint> {
        let samples = self.signals.hanging().concat();
        let bias = self.signals.levels.bias_n;
        let tested = carried(&Carry {
            object: OBJECT,
            recording: &self.recording.name,
            signals: &self.signals.task,
            samples: &samples,
            bias_n: bias[0] + bias[1] + self.taken.zero.net_n,
            bias_error_n: self.taken.zero.error_n,
            gravity: self.gravity,
        });
        let Some(cable) = &self.taken.pull.cable else { return tested };
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
                interval_n_m: ((stiffness - HALF_INTERVAL * error).max(0.0), Some(stiffness + HALF_INTERVAL * error)),
                manipulator_n_m: hand,
            }),
            evidence: format!(
                "a cable: a pull of up to {:.2} N that sets in beyond one place and grows with {stiffness:.0} N/m, taut in {} of {} \
                 independent samples",
                self.strongest_n(),
                self.taken.pull.taut,
                self.taken.rows
            ),
            ..tested.unwrap_or(blank)
        })
    }
}
