//! Faults that make a task unusable, in words.

use super::definition::{Definition, MOST_CARRIES, Step, Subtasks, signals};
use super::shows;
use haptics::recording::Task;

impl Definition {
    /// Fault of the definition, and its remedy.
    pub fn fault(&self) -> Option<String> {
        if self.name.is_empty() || !self.name.chars().all(|c| c.is_alphanumeric() || "-_".contains(c)) {
            return Some(format!("the name `{}` must be of letters, digits, - and _", self.name));
        }
        if !(self.thresholds.leave > 0.0 && self.thresholds.leave <= 1.0) {
            return Some("`leave` must be above 0 and at most 1".to_owned());
        }
        let given = [self.thresholds.force_n, self.thresholds.velocity_m_s];
        if given.iter().flatten().any(|v| !(*v > 0.0 && v.is_finite())) {
            return Some("a threshold must be a positive number".to_owned());
        }
        if self.states.is_empty() {
            return Some("it has no states; give at least one".to_owned());
        }
        self.fault_of_rules().or_else(|| self.fault_of_steps())
    }

    fn fault_of_rules(&self) -> Option<String> {
        let known = signals(self.like);
        for rule in &self.states {
            let state = rule.state.name();
            for (signal, values) in &rule.when {
                let Some((_, allowed)) = known.iter().find(|(name, _)| name == signal) else {
                    let names: Vec<_> = known.iter().map(|(name, _)| *name).collect();
                    return Some(format!("the state {state} asks for `{signal}`; use one of {}", names.join(", ")));
                };
                let fits = if self.like == Task::Needle {
                    allowed.contains(&values.as_str())
                } else {
                    !values.is_empty() && values.chars().all(|c| allowed.contains(&c.to_string().as_str()))
                };
                if !fits {
                    return Some(format!(
                        "the state {state} wants {signal} to be `{values}`; use {}",
                        allowed.join(", ")
                    ));
                }
            }
            let parameters = shows::parameters(self.like);
            if let Some(name) = rule.shows.iter().find(|name| !parameters.contains(&name.as_str())) {
                return Some(format!(
                    "the state {state} shows `{name}`, which no fit of a task like {} knows; use {}",
                    self.like.name(),
                    parameters.join(", ")
                ));
            }
        }
        None
    }

    fn fault_of_steps(&self) -> Option<String> {
        let steps: Vec<&Step> = match &self.subtasks {
            Subtasks::Ordered(o) => {
                if o.first.is_empty() || o.repeat.is_empty() || !(1..=MOST_CARRIES).contains(&o.most) {
                    return Some(format!(
                        "ordered subtasks need steps in `first` and `repeat`, and `most` from 1 to {MOST_CARRIES}"
                    ));
                }
                if matches!(self.like, Task::Crank | Task::Mechanism | Task::Switch | Task::Needle | Task::Payload) {
                    return Some(format!("a task like {} has no expected order; use `each`", self.like.name()));
                }
                o.first.iter().chain(&o.repeat).collect()
            }
            Subtasks::Each(e) => e.each.iter().collect(),
        };
        let unnumbered = self.steps_of_an_object().iter().find(|step| !step.name.contains("{n}"));
        if let Some(step) = unnumbered {
            return Some(format!("the subtask {} comes once for every object; put {{n}} into its name", step.name));
        }
        let twice = (1..steps.len()).find(|at| steps[..*at].iter().any(|other| other.name == steps[*at].name));
        if let Some(at) = twice {
            return Some(format!("two subtasks are called {}; give each its own name", steps[at].name));
        }
        let unseen = steps.iter().find(|step| !self.states.iter().any(|rule| rule.state == step.state))?;
        Some(format!(
            "the subtask {} needs the state {}, for which there is no rule; add one",
            unseen.name,
            unseen.state.name()
        ))
    }
}
