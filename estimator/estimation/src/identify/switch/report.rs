//! The captured curves as parameters. Forces are those needed along the motion, the knob's own weight in them; places
//! are the knob's middle in the world. Names of parameters of the way back (to the left) begin with `return_`.

use super::{Captured, Curves, OBJECT, PADS_IN_GIVE};
use foundation::estimate::{Fit, Parameter};
use haptics::recording::Recording;

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
        let unmodelled_n = self.curves.ways[side].as_ref().map_or([0.0; 2], |w| w.unmodelled_n);
        let fall = self.curves.ways[side].as_ref().map_or(0.0, |w| w.unmodelled_n[1] * w.values[2].abs() / w.values[0]);
        let peak = |c: &Curves| c.ways[side].as_ref().map(|way| (way.values[0], way.around.std_errors[0]));
        // Each with the columns' own errors by resampling beside it.
        let named = |name: &str, column: usize, own: f64, of: &dyn Fn(&Curves) -> Option<(f64, f64)>| {
            let found = self.parameter(&format!("{prefix}{name}"), self.with_errors(own, of), &how, &why);
            let drawn = |c: &Curves| {
                let drawn = c.ways[side].as_ref()?.resampled.as_ref()?[column];
                Some(if column == 3 { drawn.hypot(0.5 * c.resting_m) } else { drawn })
            };
            self.with_bootstrap(found, own, of, drawn)
        };
        vec![
            named("peak_force_N", 0, self.zero_error_n.hypot(unmodelled_n[0]), &peak),
            named("snap_position_m", 3, self.touched_m, &|c| c.snap_m(side)),
            named("rise_N_m", 1, 0.0, &|c| c.slope_n_m(side, false)),
            named("fall_N_m", 2, fall, &|c| c.slope_n_m(side, true)),
        ]
    }

    fn ends(&self) -> Vec<Parameter> {
        let why = "the knob was not pressed against this stop; push on for a moment when it has arrived";
        let how = "where the fingertip is without force, out of its place over force on the stop";
        let end = |side: usize, name: &str| {
            let found = self.parameter(name, self.with_errors(self.touched_m, |c| c.end_m(side)), how, why);
            let drawn = |c: &Curves| Some(c.stops[side].as_ref()?.end_resampled_m?.hypot(0.5 * c.resting_m));
            self.with_bootstrap(found, self.touched_m, |c| c.end_m(side), drawn)
        };
        let travel = self.with_errors(self.touched_m, Curves::travel_m);
        let travel =
            self.parameter("travel_m", travel, "between the stops on both sides", "both stops must be reached");
        let drawn = |c: &Curves, side: usize| c.stops[side].as_ref()?.end_resampled_m;
        let travel_drawn = |c: &Curves| Some(drawn(c, 0)?.hypot(drawn(c, 1)?).hypot(1.5_f64.sqrt() * c.resting_m));
        let falling_n = self.curves.ways.iter().flatten().map(|w| w.unmodelled_n[1]).fold(0.0, f64::max);
        let friction_own = falling_n.hypot(self.zero_error_n);
        let friction = self.with_errors(friction_own, Curves::friction_n);
        let friction = self.parameter(
            "friction_N",
            friction,
            "half of what both directions ask for together where the knob falls over",
            "friction shows only between a throw there and one back; this recording has one direction",
        );
        let width_of = |c: &Curves| Some((c.width_m?, c.resting_m));
        let width = self.parameter(
            "knob_width_m",
            self.with_errors(self.touched_m, width_of),
            "between the fingers when one leaves the knob at rest and the other meets it",
            "no finger met the knob where the other one had left it; throw it there and back",
        );
        // A touch is seen late in every throw alike: throws do not show it.
        let width_drawn = |c: &Curves| Some(c.width_resampled_m?.hypot(c.resting_m));
        vec![
            end(0, "right_end_position_m"),
            end(1, "left_end_position_m"),
            self.with_bootstrap(travel, self.touched_m, Curves::travel_m, travel_drawn),
            self.with_bootstrap(friction, friction_own, Curves::friction_n, |c| Some(c.friction_resampled_n()?.1)),
            self.with_bootstrap(width, self.touched_m, width_of, width_drawn),
        ]
    }

    /// Parameters that pushes from outside do not show.
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
