//! Dry friction of a model, to which causes that are a share of it refer.

use haptics::law::{Effect, Motion};

/// Dry friction of a model: a constant part, N or N m, and a part in proportion to the load.
pub(crate) struct DryFriction {
    pub(crate) level_n: f64,
    pub(crate) mu: f64,
}

impl DryFriction {
    pub(crate) fn of(laws: &[Effect]) -> Self {
        let at = |normal_force_n: f64| {
            let motion = Motion { direction: 1.0, normal_force_n, ..Motion::default() };
            laws.iter().filter(|e| e.law().is_dry()).map(|e| e.force(&motion)).sum::<f64>()
        };
        Self { level_n: at(0.0).max(0.0), mu: (at(1.0) - at(0.0)).max(0.0) }
    }

    /// The laws of a cause that is a share of it, of which each needs its part: of the constant part, and of the part
    /// in proportion to the load.
    pub(crate) fn parts(&self, of_level: Effect, of_load: Effect) -> Vec<Effect> {
        let parts = [(of_level, self.level_n), (of_load, self.mu)];
        parts.into_iter().filter(|(_, size)| *size > 0.0).map(|(law, _)| law).collect()
    }
}
