//! Carried, dropped, slipped and stacked blocks.

use haptics::world::{Contact, State, Surface, World};
use schemars::JsonSchema;
use serde::Serialize;
use std::f64::consts::FRAC_PI_2;

/// A block that falls farther than this after it was let go was dropped, m.
pub const DROP_M: f64 = 0.003;
/// Least way of a pad over a held object that is a slip, m.
pub const SLIP_M: f64 = 0.0005;
/// Slower than this a block rests, m/s.
const RESTING_M_S: f64 = 0.002;

/// A block fell out of the hand.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Drop {
    /// Which, from 0.
    pub block: usize,
    /// When it was let go, s.
    pub time_s: f64,
    /// How far it fell, m.
    pub height_m: f64,
}

/// A pad slid over a block that both fingers held.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Slip {
    /// Which block, from 0.
    pub block: usize,
    /// Which finger, 0 left, 1 right.
    pub finger: usize,
    /// When it began, s.
    pub time_s: f64,
    /// How far, m.
    pub way_m: f64,
}

/// A block that rests on another one at the end.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Stack {
    /// Which, from 0.
    pub upper: usize,
    /// On which.
    pub lower: usize,
    /// Middle of the upper one beside that of the lower one, m, to the right.
    pub offset_m: f64,
    /// The upper one's angle from the nearest upright one, rad, counter-clockwise.
    pub tilt_rad: f64,
}

/// Of the blocks of a world.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize)]
pub struct BlockMeasures {
    /// How often each was taken by both fingers.
    pub grasps: Vec<usize>,
    /// Blocks that fell.
    pub drops: Vec<Drop>,
    /// Pads that slid.
    pub slips: Vec<Slip>,
    /// Who rests on whom at the end.
    pub stacks: Vec<Stack>,
    /// Way of each block's middle while both fingers held it, m.
    pub carried_m: Vec<f64>,
    /// Straight way from where it was first taken to where it was last let go, m.
    pub displaced_m: Vec<f64>,
    /// Content that has run out of all of them, kg.
    pub spilled_kg: f64,
    /// Walls that broke.
    pub broken: usize,
    /// Since when everything has been resting, with nothing held, s; absent while something moves or is held at the end.
    pub at_rest_since_s: Option<f64>,
}

/// One block while it is watched.
#[derive(Clone, Debug, Default)]
struct One {
    held: bool,
    grasps: usize,
    taken_at: Option<haptics::Vec2>,
    left_at: Option<haptics::Vec2>,
    before: Option<haptics::Vec2>,
    carried_m: f64,
    /// Start of a fall that has not come to rest since: time, s, and height, m.
    falling: Option<(f64, f64)>,
    sliding: [Option<Slip>; 2],
}

/// Watches the blocks of a world from tick to tick.
pub struct Watch {
    blocks: Vec<One>,
    found: BlockMeasures,
    before_s: Option<f64>,
    end: Vec<(haptics::Vec2, f64, Vec<Contact>)>,
}

impl Watch {
    /// Nothing seen yet.
    pub fn new(world: &World) -> Self {
        let blocks = vec![One::default(); world.blocks.len()];
        Self { blocks, found: BlockMeasures::default(), before_s: None, end: Vec::new() }
    }

    /// The next state, at the recording's clock, s.
    pub fn see(&mut self, time_s: f64, state: &State) {
        let span_s = self.before_s.map_or(0.0, |before| time_s - before);
        self.before_s = Some(time_s);
        for (index, one) in self.blocks.iter_mut().enumerate() {
            one.see(index, (time_s, span_s), state, &mut self.found);
        }
        let still = state.bodies.iter().all(|b| b.velocity_m_s.norm() < RESTING_M_S);
        let free = self.blocks.iter().all(|b| !b.held);
        self.found.at_rest_since_s = (still && free).then(|| self.found.at_rest_since_s.unwrap_or(time_s));
        self.found.spilled_kg = state.bodies.iter().map(|b| b.leaked_kg).sum();
        self.found.broken = state.bodies.iter().filter(|b| b.broken).count();
        self.end.clear();
        let contacts = |index: usize| state.contacts.iter().filter(move |c| touches(c, index)).copied().collect();
        self.end.extend(state.bodies.iter().enumerate().map(|(k, b)| (b.center_m, b.angle_rad, contacts(k))));
    }

    /// All that was seen.
    pub fn end(mut self) -> BlockMeasures {
        for (index, one) in self.blocks.iter_mut().enumerate() {
            for finger in 0..2 {
                one.end_slip(finger, &mut self.found);
            }
            if let (Some((time_s, from_m)), Some((at, ..))) = (one.falling, self.end.get(index)) {
                note_drop(index, time_s, from_m - at.y, &mut self.found);
            }
        }
        self.found.grasps = self.blocks.iter().map(|b| b.grasps).collect();
        self.found.carried_m = self.blocks.iter().map(|b| b.carried_m).collect();
        let way = |b: &One| b.taken_at.zip(b.left_at.or(b.before)).map_or(0.0, |(from, to)| (to - from).norm());
        self.found.displaced_m = self.blocks.iter().map(way).collect();
        self.found.stacks = stacks(&self.end, &self.blocks);
        self.found
    }
}

impl One {
    fn see(&mut self, index: usize, (time_s, span_s): (f64, f64), state: &State, found: &mut BlockMeasures) {
        let Some(body) = state.bodies.get(index) else { return };
        let by = |finger: u8| state.contacts.iter().find(|c| joins(c, index, Surface::Finger(finger)));
        let fingers = [by(0), by(1)];
        let held = fingers.iter().all(Option::is_some);
        if held && !self.held {
            self.grasps += 1;
            self.taken_at.get_or_insert(body.center_m);
            self.falling = None;
        }
        if self.held && !held {
            self.left_at = Some(body.center_m);
            self.falling = Some((time_s, body.center_m.y));
        }
        self.held = held;
        if let (true, Some(before)) = (held, self.before) {
            self.carried_m += (body.center_m - before).norm();
        }
        self.before = Some(body.center_m);
        if let Some((let_go_s, from_m)) = self.falling
            && body.velocity_m_s.norm() < RESTING_M_S
            && state.contacts.iter().any(|c| touches(c, index))
        {
            note_drop(index, let_go_s, from_m - body.center_m.y, found);
            self.falling = None;
        }
        for (finger, contact) in fingers.into_iter().enumerate() {
            match contact.filter(|c| held && c.sliding) {
                Some(contact) => {
                    let tip = state.input.tip_velocity[finger];
                    let along = (tip - body.velocity_m_s).dot(&contact.tangent()).abs() * span_s;
                    let new = Slip { block: index, finger, time_s, way_m: 0.0 };
                    self.sliding[finger].get_or_insert(new).way_m += along;
                }
                None => self.end_slip(finger, found),
            }
        }
    }

    fn end_slip(&mut self, finger: usize, found: &mut BlockMeasures) {
        if let Some(slip) = self.sliding[finger].take().filter(|s| s.way_m > SLIP_M) {
            found.slips.push(slip);
        }
    }
}

fn note_drop(block: usize, time_s: f64, height_m: f64, found: &mut BlockMeasures) {
    if height_m > DROP_M {
        found.drops.push(Drop { block, time_s, height_m });
    }
}

/// True for a contact of the block with that surface.
fn joins(contact: &Contact, block: usize, other: Surface) -> bool {
    let is_block = |s: Surface| matches!(s, Surface::Block(k) if usize::from(k) == block);
    (is_block(contact.on) && contact.by == other) || (is_block(contact.by) && contact.on == other)
}

fn touches(contact: &Contact, block: usize) -> bool {
    let is_block = |s: Surface| matches!(s, Surface::Block(k) if usize::from(k) == block);
    is_block(contact.on) || is_block(contact.by)
}

/// Blocks that rest on each other, of those that are not held.
fn stacks(end: &[(haptics::Vec2, f64, Vec<Contact>)], blocks: &[One]) -> Vec<Stack> {
    let mut stacks = Vec::new();
    for (upper, (at, angle_rad, contacts)) in end.iter().enumerate() {
        let below = (0..end.len()).find(|lower| {
            let other = u16::try_from(*lower).map(Surface::Block);
            *lower != upper
                && end[*lower].0.y < at.y
                && other.is_ok_and(|o| contacts.iter().any(|c| joins(c, upper, o)))
        });
        if let Some(lower) = below.filter(|_| !blocks[upper].held) {
            let tilt_rad = angle_rad - (angle_rad / FRAC_PI_2).round() * FRAC_PI_2;
            stacks.push(Stack { upper, lower, offset_m: at.x - end[lower].0.x, tilt_rad });
        }
    }
    stacks
}
