//! A recording played through a world.

use crate::ui::calibrate::replay_frames::Film;
use crate::ui::plots::levels::Levels;
use estimator::simulate::Simulation;
use std::sync::Arc;

/// A recording played through a world.
#[derive(Clone, Debug)]
pub struct Replayed {
    /// Predicted forces.
    pub simulation: Option<Arc<Simulation>>,
    /// Their curves in shown units, by channel name.
    pub curves: Vec<(String, Arc<Levels>)>,
    /// Positions of everything at all times.
    pub film: Option<Arc<Film>>,
}
