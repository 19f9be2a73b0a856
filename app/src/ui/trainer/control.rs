//! The passivity controller's switch: the observer always watches, the controller acts on choice.

use crate::ui::trainer::live::{Operator, Trainer};

/// The most damping that can be chosen, N s/m: forces stay within the device's limits anyhow.
pub const MOST_CONTROL_N_S_M: f64 = 50.0;
/// The most damping when nothing else was said, N s/m: a few times what a small planar device has of itself.
pub const USUAL_CONTROL_N_S_M: f64 = 2.0;

impl Trainer {
    /// Most damping that the passivity controller may add, N s/m; `None`: it is off.
    pub fn control_n_s_m(&self) -> Option<f64> {
        self.control_n_s_m
    }

    /// Switches the passivity controller. A running servo is started anew; the world stays as it is, and the scripted operator
    /// starts over.
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
