//! A needle through a sheet.

use haptics::law::object::MembranePhase;
use haptics::world::State;
use schemars::JsonSchema;
use serde::Serialize;

/// After the sheet gave way the needle has this long to stop, s.
pub const OVERSHOOT_WINDOW_S: f64 = 0.5;

/// A hole that was made.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Puncture {
    /// When the sheet gave way, s.
    pub time_s: f64,
    /// How far the point was beyond the undisturbed sheet then, m.
    pub insertion_m: f64,
    /// How much farther it went in the half second after, m.
    pub overshoot_m: f64,
    /// Where along the sheet, m from its middle, to the right.
    pub along_m: f64,
    /// Force of the sheet just before, N.
    pub force_n: f64,
}

/// Of a needle.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize)]
pub struct NeedleMeasures {
    /// Holes in their order.
    pub punctures: Vec<Puncture>,
    /// Places of the sheet that were touched.
    pub touched: usize,
    /// Deepest insertion, m.
    pub deepest_m: f64,
}

/// Watches a needle from tick to tick.
#[derive(Default)]
pub struct Watch {
    found: NeedleMeasures,
    phase: MembranePhase,
    force_n: f64,
}

impl Watch {
    /// The next state, at the recording's clock, s.
    pub fn see(&mut self, time_s: f64, state: &State) {
        let membrane = &state.membrane;
        self.found.touched = membrane.touched;
        self.found.deepest_m = self.found.deepest_m.max(membrane.insertion_m);
        if membrane.phase == MembranePhase::Penetration && self.phase == MembranePhase::Insertion {
            let hole = membrane.active.and_then(|k| membrane.holes.get(k));
            self.found.punctures.push(Puncture {
                time_s,
                insertion_m: membrane.insertion_m,
                overshoot_m: 0.0,
                along_m: hole.map_or(0.0, |hole| hole.along_m),
                force_n: self.force_n.abs(),
            });
        }
        if let Some(last) = self.found.punctures.last_mut().filter(|p| time_s - p.time_s <= OVERSHOOT_WINDOW_S) {
            last.overshoot_m = last.overshoot_m.max(membrane.insertion_m - last.insertion_m);
        }
        (self.phase, self.force_n) = (membrane.phase, membrane.force_n);
    }

    /// All that was seen.
    pub fn end(self) -> NeedleMeasures {
        self.found
    }
}
