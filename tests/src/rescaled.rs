//! A recording of the same motion with other units of length and force.
//!
//! Time keeps its unit. With powers of two as factors every product is exact, so a program without absolute lengths and forces
//! gives the same answer to the last digits.

use haptics::recording::{HandMeta, Prior, Recording};

/// Numbers by which lengths and forces are multiplied; masses follow as force × time² / length.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// Of lengths.
    pub length: f64,
    /// Of forces.
    pub force: f64,
}

/// Units of columns and parameters with their exponents of length and force; longer ones come first.
const UNITS: [(&str, i32, i32); 13] = [
    ("N_s_m", -1, 1),
    ("kg_m2", 1, 1),
    ("m_s2", 1, 0),
    ("kgm2", 1, 1),
    ("N_m", -1, 1),
    ("m_s", 1, 0),
    ("rad", 0, 0),
    ("rad_s", 0, 0),
    ("Nm", 1, 1),
    ("kg", -1, 1),
    ("N", 0, 1),
    ("m", 1, 0),
    ("C", 0, 0),
];

impl Scale {
    /// Factor of a column or a parameter with this name.
    pub fn of(self, name: &str) -> f64 {
        let unit = UNITS.iter().find(|(unit, ..)| name.strip_suffix(unit).is_some_and(|stem| stem.ends_with('_')));
        let (_, length, force) = unit.copied().unwrap_or(("", 0, 0));
        self.length.powi(length) * self.force.powi(force)
    }

    /// The same recording in these units.
    pub fn recording(self, recording: &Recording) -> Recording {
        let mut other = recording.clone();
        for channel in &mut other.channels {
            let factor = self.of(&channel.name);
            channel.values.iter_mut().for_each(|value| *value *= factor);
        }
        let meta = &mut other.meta;
        meta.gravity_m_s2 = Some(meta.gravity() * self.length);
        let hand = recording.meta.hand();
        let base = |k: usize| Some([hand.fingers[k].base_m.x * self.length, hand.fingers[k].base_m.y * self.length]);
        meta.hand = Some(HandMeta {
            link_m: Some(hand.fingers[0].link_m * self.length),
            base1_m: base(0),
            base2_m: base(1),
            ..HandMeta::default()
        });
        meta.known.iter_mut().for_each(|(name, value)| *value *= self.of(name));
        for (name, Prior { mean, std }) in &mut meta.prior {
            let factor = self.of(name);
            (*mean, *std) = (*mean * factor, *std * factor);
        }
        other
    }
}
