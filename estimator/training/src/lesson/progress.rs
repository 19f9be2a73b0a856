//! Progress of an attempt, from state to state: the same for a running world and for a recording that is played through
//! it.

use super::format::Lesson;
use super::goal::{Goal, LONGER_S, Rule, Seen, Standing, Watch, is_kept};
use haptics::Vec2;
use haptics::world::{State, World};

/// A hand faster than this has begun, m/s.
const BEGINS_M_S: f64 = 0.005;
/// Time between two looks from which the watcher is a window, s.
const PICTURE_S: f64 = 0.01;

/// Watches an attempt.
pub struct Progress {
    goals: Vec<(Goal, Watch)>,
    rules: Vec<(Rule, bool)>,
    world: World,
    switch: Option<crate::course::SwitchWatch>,
    seen: Seen,
    before: Option<(f64, Vec2)>,
    begun_s: Option<f64>,
    completed_at_s: Option<f64>,
    now_s: f64,
}

impl Progress {
    /// Nothing seen yet, for every sample of a recording.
    pub fn new(lesson: &Lesson, world: &World) -> Self {
        Self::watching(lesson, world, 0.0)
    }

    /// Nothing seen yet, for a window that looks sixty times a second. Its goals are a little harder to reach, so that
    /// a goal reached in the window is reached in the recording, too.
    pub fn live(lesson: &Lesson, world: &World) -> Self {
        let harder = |goal: &Goal| Goal { says: goal.says.clone(), kind: goal.kind.clone().stricter() };
        let lesson = Lesson { goals: lesson.goals.iter().map(harder).collect(), ..lesson.clone() };
        Self::watching(&lesson, world, LONGER_S)
    }

    fn watching(lesson: &Lesson, world: &World, longer_s: f64) -> Self {
        Self {
            goals: lesson.goals.iter().map(|goal| (goal.clone(), Watch::new(longer_s))).collect(),
            rules: lesson.rules.iter().map(|rule| (rule.clone(), true)).collect(),
            switch: crate::course::SwitchWatch::new(world),
            world: world.clone(),
            seen: Seen::default(),
            before: None,
            begun_s: None,
            completed_at_s: None,
            now_s: 0.0,
        }
    }

    /// The next state, at its time, s. States after the last goal change nothing but broken rules.
    pub fn see(&mut self, time_s: f64, state: &State) {
        let middle = 0.5 * (state.input.tip_in_world[0] + state.input.tip_in_world[1]);
        let (before_s, before) = self.before.unwrap_or((time_s, middle));
        let span_s = (time_s - before_s).max(0.0);
        self.now_s = time_s;
        // Steps of sensors are no speed: from one sample to the next both must show it. A slow window looks when a hand
        // that follows its pointer has come to rest already.
        if self.begun_s.is_none() && span_s > 0.0 {
            let fast = state.input.tip_velocity.iter().any(|v| v.norm() > BEGINS_M_S);
            let moved = (middle - before).norm() / span_s > BEGINS_M_S;
            self.begun_s = (moved && (fast || span_s >= PICTURE_S)).then_some(time_s);
        }
        self.before = Some((time_s, middle));
        self.seen.touched |= !state.contacts.is_empty() && state.tip_force_n.iter().any(|f| f.norm() > 0.05);
        if let Some(watch) = &mut self.switch {
            watch.see(state);
            self.seen.throws = watch.found().throws;
        }
        for (rule, kept) in &mut self.rules {
            *kept &= is_kept(&rule.kind, &self.world, state);
        }
        if self.completed_at_s.is_some() {
            return;
        }
        for (goal, watch) in &mut self.goals {
            watch.see(&goal.kind, &self.world, state, span_s, &self.seen);
        }
        if self.goals.iter().all(|(_, watch)| watch.standing().reached) {
            self.completed_at_s = Some(time_s);
        }
    }

    /// State of each goal, in the lesson's order.
    pub fn standings(&self) -> impl Iterator<Item = (&Goal, Standing)> {
        self.goals.iter().map(|(goal, watch)| (goal, watch.standing()))
    }

    /// The rules, and whether each was kept so far.
    pub fn rules(&self) -> impl Iterator<Item = (&Rule, bool)> {
        self.rules.iter().map(|(rule, kept)| (rule, *kept))
    }

    /// True once every goal was reached.
    pub fn is_completed(&self) -> bool {
        self.completed_at_s.is_some()
    }

    /// The rule that was broken, if one was.
    pub fn broken(&self) -> Option<&Rule> {
        self.rules.iter().find(|(_, kept)| !kept).map(|(rule, _)| rule)
    }

    /// From the hand's first motion until the last goal was reached, s.
    pub fn completed_s(&self) -> Option<f64> {
        Some(self.completed_at_s? - self.begun_s.unwrap_or(0.0))
    }

    /// From the hand's first motion until now, or until the last goal was reached, s.
    pub fn running_s(&self) -> f64 {
        self.begun_s.map_or(0.0, |begun_s| self.completed_at_s.unwrap_or(self.now_s) - begun_s)
    }
}
