//! The passivity controller's switch: the observer always runs, the controller is optional.

use crate::ui::train::trainer::live::{Operator, Trainer};

/// Maximum damping that can be chosen, N s/m; forces stay within the device's limits anyway.
pub const MOST_CONTROL_N_S_M: f64 = 50.0;
/// Default limit of the damping, N s/m: a few times the damping of a small planar device.
pub const USUAL_CONTROL_N_S_M: f64 = 2.0;

impl Trainer {
    /// Maximum damping that the passivity controller may add, N s/m; `None` if it is off.
    pub fn control_n_s_m(&self) -> Option<f64> {
        self.control_n_s_m
    }

    /// Switches the passivity controller. A running servo restarts; the world keeps its state, and the scripted
    /// operator starts over.
    pub fn set_control(&mut self, most_n_s_m: Option<f64>) -> Result<(), String> {
        self.control_n_s_m = most_n_s_m.map(|most| most.clamp(0.1, MOST_CONTROL_N_S_M));
        match (self.engine.is_some(), self.operator) {
            (false, _) => Ok(()),
            (true, Operator::Scripted) => self.restart(),
            (true, Operator::You) => {
                self.pause();
                self.ensure_running()
            }
        }
    }
}
