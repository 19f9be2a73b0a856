//! Parameters that a task's states show, and so the samples that fits take.

use super::definition::{Definition, StateRule, Step, Subtasks};
use super::state::SystemState;
use haptics::recording::Task;
use std::collections::BTreeMap;

/// Parameters that states may be said to show, by the task they are like.
pub fn parameters(like: Task) -> &'static [&'static str] {
    match like {
        Task::BlockStack | Task::Barrel => {
            &["force_bias", "weight_N", "width_m", "height_m", "friction_lower_bound", "friction"]
        }
        Task::Crank => &[
            "force_bias",
            "radius_m",
            "center_x_m",
            "center_y_m",
            "weight_N",
            "friction_mu",
            "viscous_N_s_m",
            "coulomb_N",
            "inertia_kg_m2",
            "constraint_stiffness_N_m",
        ],
        Task::Mechanism => &[
            "force_bias",
            "mass_kg",
            "inertia_kg_m2",
            "coulomb_N",
            "coulomb_Nm",
            "viscous_N_s_m",
            "viscous_Nm_s",
            "offset_N",
            "offset_Nm",
            "gravity_moment_Nm",
        ],
        Task::Needle => &[
            "force_bias",
            "stiffness_N_m",
            "hardening_N_m3",
            "puncture_force_N",
            "surface_position_m",
            "shaft_friction_N",
            "weight_N",
        ],
        Task::Payload => &["force_bias", "torque_bias", "weight_N", "com_m"],
        Task::Switch => &[
            "force_bias",
            "peak_force_N",
            "snap_position_m",
            "rise_N_m",
            "fall_N_m",
            "travel_m",
            "friction_N",
            "knob_width_m",
        ],
    }
}

impl Definition {
    /// True if the task says that a state shows a parameter.
    pub fn shows(&self, state: SystemState, parameter: &str) -> bool {
        self.states.iter().any(|rule| rule.state == state && rule.shows.iter().any(|name| name == parameter))
    }

    /// True if a state shows anything but the bias of the forces; every one does if the task states it for none.
    pub fn shows_something(&self, state: SystemState) -> bool {
        let of = |rule: &StateRule| rule.shows.iter().any(|name| name != "force_bias");
        !self.states.iter().any(of) || self.states.iter().any(|rule| rule.state == state && of(rule))
    }

    /// True if any state shows a parameter.
    pub fn is_shown(&self, parameter: &str) -> bool {
        self.states.iter().any(|rule| rule.shows.iter().any(|name| name == parameter))
    }

    /// Parameters that every state shows, by its name; states that show nothing are left out.
    pub fn shown_by_states(&self) -> BTreeMap<String, Vec<String>> {
        let mut shown: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for rule in self.states.iter().filter(|rule| !rule.shows.is_empty()) {
            let all = shown.entry(rule.state.name().to_owned()).or_default();
            all.extend(rule.shows.iter().filter(|name| !all.contains(name)).cloned().collect::<Vec<_>>());
        }
        shown
    }

    /// The steps of one object, in order; without an expected order those that are counted.
    pub fn steps_of_an_object(&self) -> &[Step] {
        match &self.subtasks {
            Subtasks::Ordered(ordered) => &ordered.repeat,
            Subtasks::Each(each) => &each.each,
        }
    }

    /// The subtasks of an object (from 1) whose state shows a parameter, in order. Without an expected order the n-th occurrence of
    /// the state that shows `main` is the n-th object; no other state can be told to belong to it.
    pub fn showing(&self, parameter: &str, main: &str, object: usize) -> Vec<String> {
        let all = self.steps_of_an_object();
        let counted = all.iter().find(|step| self.shows(step.state, main)).map(|step| step.state);
        let belongs = |step: &&Step| match (&self.subtasks, counted) {
            (Subtasks::Each(_), Some(state)) => step.state == state,
            _ => true,
        };
        let steps = all.iter().filter(belongs).filter(|step| self.shows(step.state, parameter));
        steps.map(|step| step.numbered(object).name).collect()
    }

    /// The subtasks of an object whose state shows a parameter, before and after the first one whose state shows `main`; none without
    /// an expected order.
    pub fn showing_around(&self, parameter: &str, main: &str, object: usize) -> [Vec<String>; 2] {
        let Subtasks::Ordered(ordered) = &self.subtasks else { return [Vec::new(), Vec::new()] };
        let steps = &ordered.repeat;
        let middle = steps.iter().position(|step| self.shows(step.state, main)).unwrap_or(steps.len());
        let of = |steps: &[Step]| {
            let shown = steps.iter().filter(|step| self.shows(step.state, parameter));
            shown.map(|step| step.numbered(object).name).collect()
        };
        [of(&steps[..middle]), of(&steps[middle..])]
    }
}
