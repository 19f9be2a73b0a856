//! The captured curves as parameters. Forces are those needed along the motion, the knob's own weight in them; places are the
//! knob's middle in the world. What belongs to the way back (to the left) begins with `return_`.

use super::{Captured, Curves, OBJECT, PADS_IN_GIVE, TOUCHED_M};
use crate::estimate::{Fit, Parameter};
use haptics::recording::Recording;

/// Speed and mass of a knob on its way down add to the force what is not in the curve, N (one standard deviation).
const FALLING_N: f64 = 0.025;

/// Up to the peak it moves slowly, N.
const MOVING_N: f64 = 0.02;

impl Captured {
    /// All that the recording shows and does not show.
    pub(super) fn report(&self, recording: &Recording) -> Fit {
        let mut parameters: Vec<Parameter> = (0..2).flat_map(|side| self.direction(side)).collect();
        parameters.extend(self.ends());
        parameters.extend(self.hidden());
        parameters.extend(self.pad());
        let ways = ["to the right", "to the left"];
        let missing = (0..2).filter(|&side| self.curves.ways[side].is_none());
        let warnings = missing
            .map(|side| format!("{} shows no throw {}: half of the curve is missing", recording.name, ways[side]))
            .collect();
        Fit { task: "switch".to_owned(), parameters, warnings, ..Fit::default() }
    }

    fn parameter(&self, name: &str, found: Option<(f64, f64)>, how: &str, why_not: &str) -> Parameter {
        match found {
            Some((value, error)) => Parameter::identified(OBJECT, name, value, error, self.samples(), how),
            None => Parameter::unidentified(OBJECT, name, self.samples(), why_not),
        }
    }

    fn direction(&self, side: usize) -> Vec<Parameter> {
        let (prefix, way) = [("", "to the right"), ("return_", "to the left")][side];
        let why = format!("no throw {way} was seen: push the knob over to that side, past its snap");
        let how = format!("force over displacement {way}, one line up to the peak and one down from it");
        let value = |k: usize, own: f64| {
            self.with_errors(own, |c| {
                let way = c.ways[side].as_ref()?;
                Some((way.values[k], way.around.std_errors[k]))
            })
        };
        let fall = self.curves.ways[side].as_ref().map_or(0.0, |w| FALLING_N * w.values[2].abs() / w.values[0]);
        let snap = self.with_errors(TOUCHED_M, |c: &Curves| c.snap_m(side));
        let named = |name: &str, found| self.parameter(&format!("{prefix}{name}"), found, &how, &why);
        vec![
            named("peak_force_N", value(0, self.zero_error_n.hypot(MOVING_N))),
            named("snap_position_m", snap),
            named("rise_N_m", value(1, 0.0)),
            named("fall_N_m", value(2, fall)),
        ]
    }

    fn ends(&self) -> Vec<Parameter> {
        let why = "the knob was not pressed against this stop; push on for a moment when it has arrived";
        let how = "where the fingertip is without force, out of its place over force on the stop";
        let end = |side: usize| self.with_errors(TOUCHED_M, |c| c.end_m(side));
        let travel = self.with_errors(TOUCHED_M, Curves::travel_m);
        let friction = self.with_errors(FALLING_N, Curves::friction_n);
        let width = self.with_errors(TOUCHED_M, |c| Some((c.width_m?, c.resting_m)));
        vec![
            self.parameter("right_end_position_m", end(0), how, why),
            self.parameter("left_end_position_m", end(1), how, why),
            self.parameter("travel_m", travel, "between the stops on both sides", "both stops must be reached"),
            self.parameter(
                "friction_N",
                friction,
                "half of what both directions ask for together where the knob falls over",
                "friction shows only between a throw there and one back; this recording has one direction",
            ),
            self.parameter(
                "knob_width_m",
                width,
                "between the fingers when one leaves the knob at rest and the other meets it",
                "no finger met the knob where the other one had left it; throw it there and back",
            ),
        ]
    }

    /// What pushes from outside do not show.
    fn hidden(&self) -> Vec<Parameter> {
        let none = |name: &str, why: &str| self.parameter(name, None, "", why);
        let flight = "the knob snaps over without a finger on it; hold it between both while it is thrown slowly";
        vec![
            none("trough_force_N", flight),
            none("return_trough_force_N", flight),
            none("mass_kg", flight),
            none("damping_N_s_m", flight),
            none("reversal_m", "the motion turned at the stops only; turn round in the middle of the way, in touch"),
            none("lever_m", "fingers that push a round knob do not follow its arc; hold it between them"),
        ]
    }

    fn pad(&self) -> Vec<Parameter> {
        let Some((give, error)) = self.give_m_n else { return Vec::new() };
        let how = "out of the give at the stops, of which the pads are taken to have between 0.4 and all";
        let value = PADS_IN_GIVE.0 / give;
        let error = value * (PADS_IN_GIVE.1 / PADS_IN_GIVE.0).hypot(error / give);
        let why = format!(
            "finger and stop give {:.3} mm/N together; the share of each is an assumption, no measurement",
            1e3 * give
        );
        vec![
            Parameter::identified("pad", "stiffness_N_m", value, error, self.samples(), how),
            Parameter::unidentified(OBJECT, "stop_stiffness_N_m", self.samples(), &why),
        ]
    }
}
