//! The cable that holds a barrel, as parameters and as a constraint from one side.

use super::cable::Cable;
use super::pull::{GEOMETRY, Pull, STIFFNESS};
use super::report::{Seen, Value};
use super::{CABLE, OBJECT};
use crate::constraint::{Carry, carried};
use crate::estimate::{Constraint, ConstraintKind, Parameter, Sided, Yielding};
use haptics::Vec2;

/// Held above or below its middle, the barrel turns in the grip while it is pulled. Where that takes its middle is known to this share …
const TURN_SHARE: f64 = 0.25;
/// … and to this way, m, …
const SWINGS_M: f64 = 4e-5;
/// … and to this way while the pull grows.
const SWINGS_AS_PULLED_M: f64 = 1.4e-5;
/// Stiffness of a hand whose give was not seen, N/m.
const HAND_N_M: f64 = 1000.0;

impl Seen<'_> {
    /// A value of the cable with its own error and what softer pads would change.
    fn of_cable(&self, own: f64, of: impl Fn(&Pull, &Cable) -> Option<f64>) -> Option<Value> {
        let value = |pull: &Pull| of(pull, pull.cable.as_ref()?);
        let best = value(&self.taken.pull)?;
        let changes = self.taken.others.iter().map(|other| value(other).map_or(0.0, |v| v - best));
        Some((best, changes.fold(own, f64::hypot)))
    }

    pub(super) fn cable(&self) -> Vec<Parameter> {
        const GEOMETRIC: [&str; 3] = ["anchor_x_m", "anchor_y_m", "length_m"];
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
        let errors = &self.taken.pull.around.std_errors;
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
        let tension_error = strongest * errors[STIFFNESS] / self.taken.pull.values[STIFFNESS];
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
        let covariance = self.taken.pull.around.covariance[(GEOMETRY, GEOMETRY + 2)];
        let across = Vec2::new(-u.y, u.x);
        let model_m = SWINGS_M.hypot(TURN_SHARE * self.taken.turned_m);
        let anchor_error = |k: usize| {
            let (by_angle, by_bend) = (-across[k] * far, u[k] * far * far);
            let square = (by_angle * angle).powi(2) + (by_bend * bend).powi(2) + 2.0 * by_angle * by_bend * covariance;
            square.max(0.0).sqrt().hypot(self.signals.resolution_m).hypot(model_m)
        };
        let with = self.taken.pull.around.covariance[(GEOMETRY + 1, GEOMETRY + 2)];
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
        let stiffness = self.taken.pull.values.get(STIFFNESS)?;
        let stretch_m = self.strongest_n() / stiffness;
        let model = stiffness * SWINGS_AS_PULLED_M.hypot(TURN_SHARE * self.taken.turned_m) / stretch_m;
        let own = self.taken.pull.around.std_errors[STIFFNESS].hypot(model);
        self.of_cable(own, |p, _| Some(p.values[STIFFNESS]))
    }

    pub(super) fn strongest_n(&self) -> f64 {
        let Some(cable) = &self.taken.pull.cable else { return 0.0 };
        let give = self.grip.give_m_n();
        let give = Vec2::new(give[0].0, give[1].0);
        let place = |i: usize| self.signals.position[i] - self.signals.net_n[i].component_mul(&give);
        let stretch = self.signals.hanging().concat().into_iter().map(|i| cable.stretch(place(i)).0);
        self.taken.pull.values[STIFFNESS] * stretch.fold(0.0, f64::max)
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
                interval_n_m: ((stiffness - 1.96 * error).max(0.0), Some(stiffness + 1.96 * error)),
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
