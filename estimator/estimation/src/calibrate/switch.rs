//! A captured switch as one that can be felt.

use super::Builder;
use crate::identify::switch::{LEVER_TRAVELS, OBJECT, PADS_IN_GIVE, height_m};
use haptics::Vec2;
use haptics::law::object::{CurvePoint, ToggleCurve};
use haptics::recording::Recording;
use haptics::world::presets;

/// Mass of a knob: nothing shows it.
const KNOB_KG: f64 = 0.01;
/// Share of the give at the stops that belongs to the stops (see the fit's own assumption).
const STOP_IN_PADS: f64 = 1.0 / (PADS_IN_GIVE.0 - 1.0);

/// Travel of a switch of which one end was not seen, m.
const USUAL_TRAVEL_M: f64 = 16e-3;
/// Friction where it was not seen, N.
const ASSUMED_FRICTION_N: f64 = 0.1;

/// Places and forces of one direction, in the world's x, N along x.
type Line = Vec<(f64, f64)>;

impl Builder<'_> {
    /// The curve as captured, on an arc of assumed length; a direction that was not seen mirrors the other.
    pub(super) fn switch(&mut self, recording: &Recording) {
        let Some(mut switch) = presets::switch().switch else { return };
        let Some([there, back]) = self.lines() else { return self.note_nothing() };
        let low = there[0].0.min(back[0].0);
        let high = there[there.len() - 1].0.max(back[back.len() - 1].0);
        let (middle, travel) = (0.5 * (low + high), (high - low).max(1e-3));
        let lever_m = LEVER_TRAVELS * travel;
        self.assume("lever_m", lever_m, "1.9 times the travel; fingers that push do not show it");
        self.assume("mass_kg", KNOB_KG, "the knob snaps over without a finger on it");
        self.assume("reversal_m", switch.curve.reversal_m, "as in the built-in switch");
        let along = |x: f64| lever_m * ((x - middle) / lever_m).clamp(-0.99, 0.99).asin();
        // The weight of the knob is in the captured force; the world adds it again.
        let weight_n = KNOB_KG * self.world.gravity_m_s2;
        let mut places: Vec<f64> = there.iter().chain(&back).map(|p| p.0).collect();
        places.sort_by(f64::total_cmp);
        places.dedup_by(|a, b| (*a - *b).abs() < 1e-5);
        let points = places.iter().map(|&x| {
            let held = weight_n * (x - middle) / lever_m;
            let (forward_n, backward_n) = (on(&there, x) + held, on(&back, x) + held);
            // Noise must not let a cycle give energy.
            CurvePoint { at_m: along(x), forward_n: forward_n.max(backward_n), backward_n: backward_n.min(forward_n) }
        });
        switch.curve = ToggleCurve { points: points.collect(), ..switch.curve };
        if let Some(pad_n_m) = self.fit.value("pad", "stiffness_N_m") {
            switch.curve.stop_n_m = STOP_IN_PADS * pad_n_m;
        }
        self.assume("stop_stiffness_N_m", switch.curve.stop_n_m, "what pads as stated leave of the give at the stops");
        self.assume("damping_N_s_m", switch.damping_n_s_m, "as in the built-in switch");
        switch.knob_radius_m = 0.5 * self.take(OBJECT, "knob_width_m", 2.0 * switch.knob_radius_m).max(2e-3);
        (switch.lever_m, switch.mass_kg) = (lever_m, KNOB_KG);
        switch.start_m = along(low);
        let height = height_m(recording).unwrap_or(switch.pivot_m.y + lever_m);
        switch.pivot_m = Vec2::new(middle, height - lever_m);
        self.world.floor = None;
        self.world.switch = Some(switch);
        self.note_all(OBJECT);
    }

    /// Both directions from stop to stop, in rising order of x. Beyond the place where the knob leaves the finger a direction
    /// follows the other one, twice the friction apart; one that was not seen mirrors the other.
    fn lines(&mut self) -> Option<[Line; 2]> {
        let value = |name: &str| self.fit.value(OBJECT, name);
        let seen = ["", "return_"].map(|prefix| {
            let of = |name: &str| value(&format!("{prefix}{name}"));
            Some((of("snap_position_m")?, of("peak_force_N")?, of("rise_N_m")?))
        });
        let (there, back) = match seen {
            [Some(there), Some(back)] => (there, back),
            [Some(there), None] => {
                (there, (2.0 * value("right_end_position_m")? - USUAL_TRAVEL_M - there.0, there.1, there.2))
            }
            [None, Some(back)] => {
                ((2.0 * value("left_end_position_m")? + USUAL_TRAVEL_M - back.0, back.1, back.2), back)
            }
            [None, None] => return None,
        };
        if seen.iter().any(Option::is_none) {
            self.assume(
                "other_direction",
                0.0,
                "only one direction was thrown; the other is taken as its mirror image",
            );
        }
        let gap_n = 2.0 * self.take(OBJECT, "friction_N", ASSUMED_FRICTION_N).max(0.0);
        let ends = ["left_end_position_m", "right_end_position_m"].map(|name| self.fit.value(OBJECT, name));
        let (left, right) = match ends {
            [Some(left), Some(right)] => (left, right),
            [Some(left), None] => (left, left + USUAL_TRAVEL_M),
            [None, Some(right)] => (right - USUAL_TRAVEL_M, right),
            [None, None] => return None,
        };
        let start_n = there.1 - there.2 * (there.0 - left);
        let end_n = back.2 * (right - back.0) - back.1;
        let middle = [(left, start_n - gap_n), (there.0, there.1 - gap_n), (back.0, -back.1), (right, end_n)];
        let rising = middle.windows(2).all(|w| w[1].0 > w[0].0);
        let backward = middle.to_vec();
        let forward = middle.iter().map(|(x, f)| (*x, f + gap_n)).collect();
        rising.then_some([forward, backward])
    }

    fn assume(&mut self, name: &str, value: f64, why: &str) {
        self.note(OBJECT, name, value, None, haptics::world::Source::Assumed, why);
    }

    fn note_nothing(&mut self) {
        self.assume("curve", 0.0, "no throw was seen in either direction; the world has no switch");
    }
}

/// Force of a line at a place, N; straight on beyond its ends.
fn on(line: &Line, x: f64) -> f64 {
    let k = line.partition_point(|p| p.0 <= x).clamp(1, line.len() - 1);
    let ((a, fa), (b, fb)) = (line[k - 1], line[k]);
    fa + (fb - fa) * ((x - a) / (b - a).max(1e-6)).clamp(-0.5, 1.5)
}
