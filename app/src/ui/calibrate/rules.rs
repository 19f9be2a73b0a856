//! The rules of a task while they are edited: a draft that is tried at once where it can be used.

use estimator::segment::SystemState;
use estimator::segment::definition::{Definition, StateRule, signals};
use haptics::recording::Task;

/// An open editor.
#[derive(Clone, Debug, PartialEq)]
pub struct Rules {
    /// As it was when the editor was opened.
    pub before: Definition,
    /// As it is now.
    pub draft: Definition,
    /// The name to save it under.
    pub name: String,
    /// Why the draft cannot be used.
    pub fault: Option<String>,
    /// Changed since it was last tried.
    pub untried: bool,
    /// The rule that was added in the last picture, to be scrolled to.
    pub added: Option<usize>,
}

impl Rules {
    /// An editor of a task.
    pub fn of(task: Definition) -> Self {
        let own = Task::from_name(&task.name).is_none();
        let name = if own { task.name.clone() } else { format!("my-{}", task.name) };
        Self { before: task.clone(), draft: task, name, fault: None, untried: false, added: None }
    }

    /// The states that the task's rules may name.
    pub fn states(&self) -> impl Iterator<Item = SystemState> + use<> {
        let like = self.draft.like;
        SystemState::ALL.into_iter().filter(move |state| match state {
            SystemState::FreeMotion => true,
            // No rule is needed for samples without a state.
            SystemState::NoState => false,
            SystemState::HoldOnGround | SystemState::HoldAboveGround | SystemState::SlidingOnGround => {
                matches!(like, Task::BlockStack | Task::Barrel)
            }
            SystemState::Turning | SystemState::Holding => {
                matches!(like, Task::Crank | Task::Mechanism | Task::Switch | Task::Payload)
            }
            _ => like == Task::Needle,
        })
    }

    /// Adds a rule for a state that has none yet, else for the first one. Above a rule that always holds: below it would never.
    pub fn add_state(&mut self) {
        let unused = self.states().find(|state| !self.draft.states.iter().any(|rule| rule.state == *state));
        let state = unused.unwrap_or(SystemState::FreeMotion);
        let first = signals(self.draft.like).first();
        let when = first.map(|(name, values)| ((*name).to_owned(), values[0].to_owned())).into_iter().collect();
        let rule = StateRule { state, when, shows: Vec::new() };
        let always = self.draft.states.iter().position(|rule| rule.when.is_empty());
        let place = always.unwrap_or(self.draft.states.len());
        self.draft.states.insert(place, rule);
        self.added = Some(place);
    }

    /// Switches one value of a signal in a rule; a signal whose values are all off or all on may be anything.
    pub fn switch(&mut self, rule: usize, signal: &str, value: char) {
        let Some(rule) = self.draft.states.get_mut(rule) else { return };
        let all = signals(self.draft.like).iter().find(|(name, _)| *name == signal).map_or(&[][..], |(_, all)| all);
        let before = rule.when.get(signal).cloned();
        let on = |c: char| before.as_ref().is_some_and(|values| values.contains(c)) != (c == value);
        let now: String = all.iter().filter_map(|v| v.chars().next()).filter(|c| on(*c)).collect();
        if now.is_empty() || now.chars().count() == all.len() {
            rule.when.remove(signal);
        } else {
            rule.when.insert(signal.to_owned(), now);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rules() -> Rules {
        Rules::of(Definition::built_in(Task::BlockStack).expect("the built-in task"))
    }

    #[test]
    fn signs_are_switched_one_by_one_and_all_of_them_mean_any() {
        let mut rules = rules();
        let lifted = rules.draft.states.iter().position(|r| r.state == SystemState::HoldAboveGround).expect("a rule");
        rules.switch(lifted, "net_force_y", '0');
        assert_eq!(rules.draft.states[lifted].when["net_force_y"], "+0");
        rules.switch(lifted, "net_force_y", '-');
        assert!(!rules.draft.states[lifted].when.contains_key("net_force_y"));
        rules.switch(lifted, "net_force_y", '-');
        assert_eq!(rules.draft.states[lifted].when["net_force_y"], "-");
        rules.switch(lifted, "net_force_y", '-');
        assert!(!rules.draft.states[lifted].when.contains_key("net_force_y"));
        rules.switch(99, "grip", '+');
        assert_eq!(rules.draft.fault(), None);
    }

    #[test]
    fn a_new_rule_is_usable_and_stands_above_the_one_that_always_holds() {
        let mut rules = Rules::of(Definition::built_in(Task::Crank).expect("the built-in task"));
        rules.add_state();
        assert_eq!(rules.draft.fault(), None);
        assert!(rules.draft.states.last().is_some_and(|rule| rule.when.is_empty()));
        assert_eq!((rules.draft.states.len(), rules.name.as_str()), (4, "my-crank"));
        let mut needle = Rules::of(Definition::built_in(Task::Needle).expect("the built-in task"));
        needle.add_state();
        assert_eq!(needle.draft.fault(), None);
    }
}
