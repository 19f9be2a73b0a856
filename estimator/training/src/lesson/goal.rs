//! Goals and rules of a lesson, judged from the world's states alone.

use haptics::Vec2;
use haptics::world::{Contact, State, Surface, World};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Additional time of a hold by [`Kind::stricter`], s.
pub(super) const LONGER_S: f64 = 0.15;
/// Time for which a condition on a place must hold before it counts, s.
const SETTLED_S: f64 = 0.5;
/// Longest interruption of a hold that is forgiven, s.
const GONE_S: f64 = 0.05;
/// Slower than this a block rests, m/s.
const RESTING_M_S: f64 = 0.002;

/// A goal with the words that people read.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Goal {
    /// What to do, in a few words.
    pub says: String,
    /// What it is.
    #[serde(flatten)]
    pub kind: Kind,
}

/// What can be asked for. Forces are in N of each finger, lengths in m.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Kind {
    /// Both fingers press the table, neither less nor more than said, for some time.
    Press {
        /// Least force, N.
        least_n: f64,
        /// Most force, N.
        most_n: f64,
        /// How long, s.
        for_s: f64,
    },
    /// Both fingers pinch a block, neither less nor more than said, for some time.
    Pinch {
        /// Its name.
        block: String,
        /// Least force, N.
        least_n: f64,
        /// Most force, N.
        most_n: f64,
        /// How long, s.
        for_s: f64,
    },
    /// A block is held up by both fingers for some time.
    HoldUp {
        /// Its name.
        block: String,
        /// How far above where it started, m.
        above_m: f64,
        /// How long, s.
        for_s: f64,
    },
    /// Blocks rest on each other, let go, the first below the second below the third …
    Stacked {
        /// Their names from below.
        order: Vec<String>,
        /// Most that a middle may be beside the one below, m.
        within_m: f64,
    },
    /// A block rests at a place of the table, let go.
    At {
        /// Its name.
        block: String,
        /// Where, m to the right.
        x_m: f64,
        /// Most that it may be beside that, m.
        within_m: f64,
    },
    /// The crank was turned so far, positive counter-clockwise.
    Turned {
        /// Turns.
        turns: f64,
    },
    /// The sheet was pierced.
    Pierced {
        /// How often.
        times: usize,
    },
    /// The switch was thrown.
    Thrown {
        /// How often.
        times: usize,
    },
    /// The cable that holds a block was pulled taut for some time.
    CableTaut {
        /// The block's name.
        block: String,
        /// How long, s.
        for_s: f64,
    },
    /// Everything was let go and rests.
    LetGo,
}

/// What must not happen.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Rule {
    /// What to keep to, in a few words.
    pub says: String,
    /// What it is.
    #[serde(flatten)]
    pub kind: Forbidden,
}

/// What can be forbidden.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(tag = "never", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Forbidden {
    /// A block's wall breaks.
    Break {
        /// Its name.
        block: String,
    },
    /// More than that runs out of a block.
    Spill {
        /// Its name.
        block: String,
        /// How much, kg.
        most_kg: f64,
    },
}

impl Kind {
    /// The same, a little harder to reach: what a window that looks sixty times a second takes for reached is then reached in every
    /// sample of the recording, too.
    #[must_use]
    pub fn stricter(self) -> Self {
        match self {
            Self::Press { least_n, most_n, for_s } => {
                Self::Press { least_n: 1.02 * least_n, most_n: 0.98 * most_n, for_s: for_s + LONGER_S }
            }
            Self::Pinch { block, least_n, most_n, for_s } => {
                Self::Pinch { block, least_n: 1.02 * least_n, most_n: 0.98 * most_n, for_s: for_s + LONGER_S }
            }
            Self::HoldUp { block, above_m, for_s } => {
                Self::HoldUp { block, above_m: 1.02 * above_m, for_s: for_s + LONGER_S }
            }
            Self::Stacked { order, within_m } => Self::Stacked { order, within_m: 0.98 * within_m },
            Self::At { block, x_m, within_m } => Self::At { block, x_m, within_m: 0.98 * within_m },
            Self::Turned { turns } => Self::Turned { turns: 1.005 * turns },
            Self::CableTaut { block, for_s } => Self::CableTaut { block, for_s: for_s + LONGER_S },
            same @ (Self::Pierced { .. } | Self::Thrown { .. } | Self::LetGo) => same,
        }
    }
}

/// A name in a goal that the world has nothing for; `None` when all is there.
pub(super) fn lacks(kind: &Kind, world: &World) -> Option<String> {
    let unknown = |name: &String| find(world, name).is_none().then(|| format!("there is no block `{name}`"));
    match kind {
        Kind::Pinch { block, .. } | Kind::HoldUp { block, .. } | Kind::At { block, .. } => unknown(block),
        Kind::CableTaut { block, .. } => unknown(block).or_else(|| {
            let tied = find(world, block).is_some_and(|k| world.blocks[k].cable.is_some());
            (!tied).then(|| format!("no cable holds `{block}`"))
        }),
        Kind::Stacked { order, .. } if order.len() < 2 => Some("a stack has two blocks or more".to_owned()),
        Kind::Stacked { order, .. } => order.iter().find_map(unknown),
        Kind::Press { .. } => world.floor.is_none().then(|| "there is no table".to_owned()),
        Kind::Turned { .. } => world.crank.is_none().then(|| "there is no crank".to_owned()),
        Kind::Pierced { .. } => world.membrane.is_none().then(|| "there is no sheet".to_owned()),
        Kind::Thrown { .. } => world.switch.is_none().then(|| "there is no switch".to_owned()),
        Kind::LetGo => None,
    }
}

/// The same for a rule.
pub(super) fn forbids_nothing(kind: &Forbidden, world: &World) -> Option<String> {
    let (Forbidden::Break { block } | Forbidden::Spill { block, .. }) = kind;
    find(world, block).is_none().then(|| format!("there is no block `{block}`"))
}

fn find(world: &World, name: &str) -> Option<usize> {
    world.blocks.iter().position(|block| block.name == name)
}

/// State of one goal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Standing {
    /// It counts as reached now.
    pub reached: bool,
    /// Share of its time that has been held, 0 to 1.
    pub share: f64,
}

/// Watches one goal from state to state.
#[derive(Clone, Debug)]
pub(super) struct Watch {
    settles_s: f64,
    held_s: f64,
    gone_s: f64,
    count: f64,
    was: bool,
    standing: Standing,
}

impl Watch {
    /// Watch of a goal; a condition on a place counts after `SETTLED_S` and `longer_s` more.
    pub(super) fn new(longer_s: f64) -> Self {
        Self {
            settles_s: SETTLED_S + longer_s,
            held_s: 0.0,
            gone_s: 0.0,
            count: 0.0,
            was: false,
            standing: Standing::default(),
        }
    }

    pub(super) fn standing(&self) -> Standing {
        self.standing
    }

    pub(super) fn see(&mut self, kind: &Kind, world: &World, state: &State, span_s: f64, seen: &Seen) {
        let names = |name: &String| find(world, name);
        match kind {
            Kind::Press { least_n, most_n, for_s } => {
                self.hold(pressed_within(state, Surface::Floor, *least_n, *most_n), span_s, *for_s);
            }
            Kind::Pinch { block, least_n, most_n, for_s } => {
                let now =
                    names(block).is_some_and(|k| pressed_within(state, Surface::Block(k as u16), *least_n, *most_n));
                self.hold(now, span_s, *for_s);
            }
            Kind::HoldUp { block, above_m, for_s } => {
                let up = names(block).is_some_and(|k| {
                    let start = world.blocks[k].start.center_m.y;
                    state.bodies.get(k).is_some_and(|b| b.center_m.y > start + above_m) && is_held(state, k)
                });
                self.hold(up, span_s, *for_s);
            }
            Kind::CableTaut { block, for_s } => {
                let taut = names(block).and_then(|k| state.bodies.get(k)).is_some_and(|b| b.cable_n > 0.05);
                self.hold(taut, span_s, *for_s);
            }
            Kind::Stacked { order, within_m } => {
                let order: Option<Vec<usize>> = order.iter().map(names).collect();
                self.settle(order.is_some_and(|order| are_stacked(state, &order, *within_m)), span_s);
            }
            Kind::At { block, x_m, within_m } => {
                let there = names(block).is_some_and(|k| {
                    state.bodies.get(k).is_some_and(|b| (b.center_m.x - x_m).abs() < *within_m) && rests(state, k)
                });
                self.settle(there, span_s);
            }
            Kind::LetGo => {
                let free = (0..state.bodies.len()).all(|k| rests(state, k)) && fingers_are_free(state);
                self.settle(free && seen.touched, span_s);
            }
            Kind::Turned { turns } => {
                let start = world.crank.as_ref().map_or(0.0, |crank| crank.start_rad);
                let gone = (state.crank.angle_rad - start) / TAU;
                self.count = if *turns < 0.0 { self.count.max(-gone) } else { self.count.max(gone) };
                self.counted(turns.abs());
            }
            Kind::Pierced { times } => {
                let piercing = state.membrane.phase == haptics::law::object::MembranePhase::Penetration;
                self.count += f64::from(u8::from(piercing && !self.was));
                self.was = piercing;
                self.counted(*times as f64);
            }
            Kind::Thrown { times } => {
                self.count = seen.throws as f64;
                self.counted(*times as f64);
            }
        }
    }

    /// Judges a goal that is reached after a hold of a certain time.
    fn hold(&mut self, now: bool, span_s: f64, for_s: f64) {
        // A tremor that leaves for a moment does not restart the time.
        self.gone_s = if now { 0.0 } else { self.gone_s + span_s };
        self.held_s = match (now, self.gone_s > GONE_S) {
            (true, _) => self.held_s + span_s,
            (false, false) => self.held_s,
            (false, true) => 0.0,
        };
        let share = if for_s > 0.0 { (self.held_s / for_s).min(1.0) } else { f64::from(u8::from(now)) };
        self.standing.reached |= share >= 1.0;
        self.standing.share = if self.standing.reached { 1.0 } else { share };
    }

    /// Judges a goal that counts only as long as its condition holds.
    fn settle(&mut self, now: bool, span_s: f64) {
        self.held_s = if now { self.held_s + span_s } else { 0.0 };
        self.standing =
            Standing { reached: self.held_s >= self.settles_s, share: (self.held_s / self.settles_s).min(1.0) };
    }

    fn counted(&mut self, wanted: f64) {
        let share = if wanted > 0.0 { (self.count / wanted).clamp(0.0, 1.0) } else { 1.0 };
        self.standing = Standing { reached: share >= 1.0, share };
    }
}

/// True if a rule is kept in a state.
pub(super) fn is_kept(kind: &Forbidden, world: &World, state: &State) -> bool {
    let body = |name: &str| find(world, name).and_then(|k| state.bodies.get(k));
    match kind {
        Forbidden::Break { block } => body(block).is_none_or(|b| !b.broken),
        Forbidden::Spill { block, most_kg } => body(block).is_none_or(|b| b.leaked_kg <= *most_kg),
    }
}

fn between(contact: &Contact, one: Surface, other: Surface) -> bool {
    (contact.on == one && contact.by == other) || (contact.by == one && contact.on == other)
}

fn force_between(state: &State, one: Surface, other: Surface) -> f64 {
    state.contacts.iter().filter(|c| between(c, one, other)).map(|c| c.normal_force_n).sum()
}

fn pressed_within(state: &State, on: Surface, least_n: f64, most_n: f64) -> bool {
    (0..2).all(|finger| (least_n..=most_n).contains(&force_between(state, Surface::Finger(finger), on)))
}

fn is_held(state: &State, block: usize) -> bool {
    (0..2)
        .all(|finger| state.contacts.iter().any(|c| between(c, Surface::Finger(finger), Surface::Block(block as u16))))
}

fn fingers_are_free(state: &State) -> bool {
    let is_finger = |s: Surface| matches!(s, Surface::Finger(_));
    !state.contacts.iter().any(|c| is_finger(c.on) || is_finger(c.by))
}

fn rests(state: &State, block: usize) -> bool {
    let Some(body) = state.bodies.get(block) else { return false };
    let touched =
        |finger: u8| state.contacts.iter().any(|c| between(c, Surface::Finger(finger), Surface::Block(block as u16)));
    body.velocity_m_s.norm() < RESTING_M_S && !touched(0) && !touched(1)
}

fn are_stacked(state: &State, order: &[usize], within_m: f64) -> bool {
    order.windows(2).all(|pair| {
        let on_it =
            state.contacts.iter().any(|c| between(c, Surface::Block(pair[0] as u16), Surface::Block(pair[1] as u16)));
        let at = |k: usize| state.bodies.get(k).map_or_else(Vec2::zeros, |b| b.center_m);
        let (below, above) = (at(pair[0]), at(pair[1]));
        on_it
            && above.y > below.y
            && (above.x - below.x).abs() < within_m
            && rests(state, pair[0])
            && rests(state, pair[1])
    })
}

/// Observations that several goals need.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seen {
    /// Something has been touched.
    pub touched: bool,
    /// Times the switch went over.
    pub throws: usize,
}
