//! Carried blocks with something hidden: the stepped world and the scripted operator make the motion, instruments of our own look.

use super::sensor::{Instruments, look};
use super::{Case, Truth};
use crate::generate::{Act, Errors, act, stacking_world};
use blind::Chance;
use estimator::diagnose::{Experiment, Options};
use estimator::pipeline;
use haptics::Vec2;
use haptics::device::Skill;
use haptics::law::contact::FingertipSlip;
use haptics::recording::{Recording, Span, Task};
use haptics::world::{Cable, Content, World};

/// What is hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Nothing, beside a world that was calibrated on another recording.
    Nothing,
    /// Pads that give, beside rigid widths: the thesis's widths that were 7 % short.
    Pads,
    /// Pads that harden, beside a world whose pads do not.
    Hardening,
    /// A slip when the block touches the ground: the thesis's height that was 9 % off.
    GroundSlip,
    /// A slip while the block is in the air, beside a world with known heights.
    AirSlip,
    /// Nothing, beside plain means, in motion that is fast enough for inertia: that is what a mass does.
    Fast,
    /// A block that leaks; the hand lets go before and after.
    Leak,
    /// The same, cut off before the hand lets go.
    LeakCut,
    /// A drift of the vertical force.
    Drift,
    /// The same, cut off before the hand lets go.
    DriftCut,
    /// A resting force.
    Bias,
    /// A gain of the forces; the weights are known.
    Gain,
    /// One vertical channel reads some of the grip.
    Cross,
    /// A cable at the first block.
    Cable,
    /// Positions are too large or small; the widths are known.
    Scale,
    /// Forces are read later than the motion.
    Late,
}

impl Kind {
    /// All of them.
    pub const ALL: [(&'static str, Self); 16] = [
        ("nothing", Self::Nothing),
        ("pads", Self::Pads),
        ("hardening", Self::Hardening),
        ("slip on the ground", Self::GroundSlip),
        ("slip in the air", Self::AirSlip),
        ("nothing, carried fast", Self::Fast),
        ("leak", Self::Leak),
        ("leak, cut off", Self::LeakCut),
        ("drift", Self::Drift),
        ("drift, cut off", Self::DriftCut),
        ("bias", Self::Bias),
        ("gain", Self::Gain),
        ("cross-talk", Self::Cross),
        ("cable", Self::Cable),
        ("scale", Self::Scale),
        ("late forces", Self::Late),
    ];

    /// Whether the thesis's plain model is the one to start from.
    fn is_plain(self) -> bool {
        matches!(self, Self::Pads | Self::GroundSlip | Self::Fast)
    }
}

/// Fine steps between two ticks that are kept.
pub(super) const KEPT: usize = 5;

pub(super) fn skill(chance: &mut Chance, kind: Kind) -> Skill {
    let pace = if kind == Kind::Fast { chance.between(0.6, 0.85) } else { chance.between(0.8, 1.3) };
    Skill {
        pace,
        pinch_n: chance.between(1.4, 2.4),
        wander: chance.between(1.0, 2.5),
        tremor_m: chance.between(0.04e-3, 0.1e-3),
        ..Skill::default()
    }
}

fn perform(world: &World, skill: Skill, seed: u64) -> Act {
    act(world, seed, skill, &Errors { mistakes: &[], fumbles: Vec::new(), looks: false }, KEPT)
}

/// Whether a block that stands until `to_s` does not any more: a slip that pulls at it lifts it up again.
fn lifts_off(world: &World, skill: Skill, seed: u64, to_s: f64) -> bool {
    let done = perform(world, skill, seed);
    let mut late = done.ticks.iter().filter(|t| (to_s - 0.2..to_s - 0.05).contains(&t.time_s));
    late.any(|t| t.label != "hold-on-ground")
}

/// Times at which a stretch of one label begins and ends, s, in order.
fn spans(of: &Act, label: &str) -> Vec<(f64, f64)> {
    let mut found: Vec<(f64, f64)> = Vec::new();
    let mut before = "";
    for tick in &of.ticks {
        if tick.label == label {
            match found.last_mut() {
                Some(last) if before == label => last.1 = tick.time_s,
                _ => found.push((tick.time_s, tick.time_s)),
            }
        }
        before = tick.label;
    }
    found.retain(|(a, b)| b - a > 0.3);
    found
}

fn end_at(recording: &Recording, time_s: f64) -> Recording {
    let end = recording.time_s.as_ref().map_or(0, |t| t.partition_point(|t| *t < time_s));
    recording.slice(Span { first: 0, end })
}

/// A case of a kind.
pub fn make(kind: Kind, seed: u64) -> (Case, Truth) {
    let (case, truth, _) = made(kind, seed, false);
    (case, truth)
}

/// The same with another recording of the same blocks by the same instruments.
pub fn twice(kind: Kind, seed: u64) -> (Case, Truth, Recording) {
    let (case, truth, again) = made(kind, seed, true);
    (case, truth, again.expect("it was asked for"))
}

/// Friction at which nothing slips.
pub(super) const FIRM: f64 = 1.5;

/// The blocks of a case, and who holds them.
struct Object {
    before: World,
    world: World,
    instruments: Instruments,
    truth: Truth,
    skill: Skill,
    every: usize,
}

fn drawn(kind: Kind, seed: u64, chance: &mut Chance) -> Object {
    let (before, _) = stacking_world(seed ^ 0x51ab_1e57);
    let skill = skill(chance, kind);
    let every = chance.pick(&[1, 2, 4]);
    let (mut world, mut instruments, mut truth) = (before.clone(), Instruments::default(), Truth::default());
    if kind.is_plain() {
        truth.besides = vec!["pad-compliance"];
    }
    hide(kind, &mut world, &mut instruments, &mut truth, (skill, seed), chance);
    if truth.hidden.is_empty() {
        // Where fingers slip by themselves something is there.
        world.blocks.iter_mut().for_each(|block| block.finger_friction = FIRM);
    }
    Object { before, world, instruments, truth, skill, every }
}

/// The blocks of a case, in the motion that an answer asked for; nothing for one that nobody knows.
pub fn as_asked(kind: Kind, seed: u64, asked: &Experiment, hand: u64) -> Option<Recording> {
    let object = drawn(kind, seed, &mut Chance::new(seed, 77));
    super::perform::carry(&object.world, asked, &object.instruments, object.every, &mut Chance::new(hand, 101))
}

fn made(kind: Kind, seed: u64, twice: bool) -> (Case, Truth, Option<Recording>) {
    let mut chance = Chance::new(seed, 77);
    let Object { before, world, instruments, truth, skill, every } = drawn(kind, seed, &mut chance);
    let done = perform(&world, skill, seed);
    let mut recording = look(&world, &done.ticks, every, &instruments, Task::BlockStack, &mut chance);
    if matches!(kind, Kind::LeakCut | Kind::DriftCut) {
        // The hand has not let go since it gripped the block.
        let first = spans(&done, "hold-above-ground")[0];
        recording = end_at(&recording, first.1 - 0.05);
        if kind == Kind::DriftCut {
            // Hardly anything is free before, either.
            let gripped = spans(&done, "hold-on-ground")[0].0;
            let start = recording.time_s.as_ref().map_or(0, |t| t.partition_point(|t| *t < gripped - 0.6));
            recording = recording.slice(Span { first: start, end: recording.len() });
        }
    }
    let state = |recording: &mut Recording| {
        for (block, name) in world.blocks.iter().zip(["block-1", "block-2"]) {
            let known = &mut recording.meta.known;
            match kind {
                Kind::Gain => known.insert(format!("{name}.weight_N"), block.mass_kg * world.gravity_m_s2),
                Kind::Scale => known.insert(format!("{name}.width_m"), block.width_m),
                _ => None,
            };
        }
    };
    state(&mut recording);
    let known = (!kind.is_plain()).then(|| calibrated(&before, seed, &mut chance));
    let again = twice.then(|| {
        let done = perform(&world, skill, seed ^ 0xa6a1);
        let mut again = look(&world, &done.ticks, every, &instruments, Task::BlockStack, &mut chance);
        state(&mut again);
        again
    });
    (Case { recordings: vec![recording], options: Options { world: known, ..Options::default() } }, truth, again)
}

/// The world as another recording without anything hidden shows it.
pub(super) fn calibrated(world: &World, seed: u64, chance: &mut Chance) -> World {
    let done = perform(world, Skill { wander: 2.0, ..Skill::default() }, seed ^ 0xca11);
    let recording = look(world, &done.ticks, 1, &Instruments::default(), Task::BlockStack, chance);
    pipeline::analyse(&[recording], &pipeline::Options::default()).expect("blocks were carried").world
}

fn hide(
    kind: Kind,
    world: &mut World,
    instruments: &mut Instruments,
    truth: &mut Truth,
    (skill, seed): (Skill, u64),
    chance: &mut Chance,
) {
    let stiffness = world.pad.stiffness_n_m;
    match kind {
        Kind::Nothing | Kind::Fast => {}
        Kind::Pads => {
            truth.hidden = vec!["pad-compliance"];
            truth.value = Some(("k", stiffness));
        }
        Kind::Hardening => {
            let usual_m = skill.pinch_n / stiffness;
            let k3 = chance.of_order(0.15, 0.8) * stiffness / usual_m.powi(2);
            world.pad.cubic_n_m3 = k3;
            truth.hidden = vec!["stiffness-hardening"];
        }
        Kind::GroundSlip | Kind::AirSlip => slip(kind, world, truth, (skill, seed), chance),
        Kind::Leak | Kind::LeakCut => {
            let block = &mut world.blocks[0];
            let leak_kg_s = chance.of_order(0.8e-3, 3e-3);
            block.content = Some(Content { mass_kg: 0.7 * block.mass_kg, leak_kg_s, leaks_from_s: Some(0.0) });
            truth.hidden = vec!["mass-change"];
            truth.value = Some(("rate", -leak_kg_s * world.gravity_m_s2));
            if kind == Kind::LeakCut {
                truth.equals = vec!["force-drift"];
            }
        }
        Kind::Drift | Kind::DriftCut => {
            let rate = chance.of_order(3e-3, 20e-3) * chance.sign();
            let finger = usize::from(chance.happens(0.5));
            instruments.drift_n_s[finger].y = rate;
            truth.hidden = vec!["force-drift"];
            if kind == Kind::Drift {
                truth.value = Some((["ry1", "ry2"][finger], rate));
            } else {
                truth.equals = vec!["mass-change"];
            }
        }
        Kind::Bias => {
            for finger in 0..2 {
                instruments.bias_n[finger] =
                    Vec2::new(chance.of_order(0.01, 0.05) * chance.sign(), chance.of_order(0.01, 0.05) * chance.sign());
            }
            truth.hidden = vec!["force-bias"];
            truth.value = Some(("by1", instruments.bias_n[0].y));
        }
        Kind::Gain => {
            instruments.gain = 1.0 + chance.of_order(0.03, 0.15) * chance.sign();
            truth.hidden = vec!["force-gain"];
            truth.value = Some(("g - 1", instruments.gain - 1.0));
        }
        Kind::Cross => {
            let (finger, kappa) = (usize::from(chance.happens(0.5)), chance.of_order(0.05, 0.2) * chance.sign());
            instruments.cross[finger] = kappa;
            // The fingers press against each other: which of them it is shows hardly.
            truth.hidden = vec!["force-cross-axis"];
        }
        Kind::Cable => cable(world, truth, chance),
        Kind::Scale => {
            instruments.scale = 1.0 + chance.of_order(0.005, 0.05) * chance.sign();
            truth.hidden = vec!["length-scale"];
            truth.value = Some(("epsilon", instruments.scale - 1.0));
        }
        Kind::Late => {
            instruments.late_s = chance.between(0.02, 0.08);
            truth.hidden = vec!["time-delay"];
            truth.value = Some(("tau", instruments.late_s));
            truth.near = vec![("tau", instruments.late_s, 4e-3)];
        }
    }
}

/// The grasp point moves on the block, at once or within a fifth of a second.
fn slip(kind: Kind, world: &mut World, truth: &mut Truth, (skill, seed): (Skill, u64), chance: &mut Chance) {
    let done = perform(world, skill, seed);
    let (label, share) =
        if kind == Kind::AirSlip { ("hold-above-ground", (0.2, 0.8)) } else { ("hold-on-ground", (0.0, 0.6)) };
    let spans = spans(&done, label);
    // On the ground: when the first block has been put down.
    let (from, to) = if kind == Kind::AirSlip { spans[0] } else { spans[1] };
    let way = chance.of_order(0.5e-3, 1.6e-3) * chance.sign();
    let slip = FingertipSlip {
        way_m: Vec2::new(0.0, way),
        t0_s: from + chance.between(share.0, share.1) * (to - from),
        duration_s: chance.between(0.0, 0.2),
    };
    world.pad.slip = Some(slip);
    let lifts = kind == Kind::GroundSlip && lifts_off(world, skill, seed, to);
    // The other way round the fingers press the block down as they slip.
    let way = if lifts { -way } else { way };
    world.pad.slip = Some(FingertipSlip { way_m: Vec2::new(0.0, way), ..slip });
    truth.hidden = vec!["fingertip-slip"];
    if kind == Kind::GroundSlip {
        // A slip at once may be said to begin anywhere between two rows, one that takes a while where it is under way.
        truth.near = vec![("t0", slip.t0_s, 0.1), ("dy", way, 0.15 * way.abs())];
    }
}

/// A carry of stacked blocks, in the record of which the tips go on by `way_m` over a tenth of a second, `since_s` after the first block has been
/// put down, until it is let go; and when that begins, s.
pub fn slipped(seed: u64, since_s: f64, way_m: f64) -> (Recording, f64) {
    const LENGTH_S: f64 = 0.1;
    let mut chance = Chance::new(seed, 78);
    let (world, _) = stacking_world(seed);
    let done = perform(&world, Skill { wander: 2.0, ..Skill::default() }, seed);
    let (touches, lets_go) = spans(&done, "hold-on-ground")[1];
    let mut recording = look(&world, &done.ticks, 1, &Instruments::default(), Task::BlockStack, &mut chance);
    let time_s = recording.time_s.clone().unwrap_or_default();
    let begins = touches + since_s;
    for channel in &mut recording.channels {
        let (is_place, is_rate) = (channel.name.starts_with('y'), channel.name.starts_with("vy"));
        for (value, t) in channel.values.iter_mut().zip(&time_s).filter(|(_, t)| (begins..lets_go).contains(*t)) {
            let share = (t - begins) / LENGTH_S;
            if is_place {
                *value += way_m * share.min(1.0);
            } else if is_rate && share < 1.0 {
                *value += way_m / LENGTH_S;
            }
        }
    }
    (recording, begins)
}

/// From where the first block starts it is carried to the right: the cable gets taut on the way.
fn cable(world: &mut World, truth: &mut Truth, chance: &mut Chance) {
    let block = &mut world.blocks[0];
    let start = block.start.center_m;
    let anchor_m = start + Vec2::new(-chance.between(0.01, 0.04), chance.between(-0.01, 0.02));
    let stiffness_n_m = chance.of_order(12.0, 40.0);
    let length_m = (anchor_m - start).norm() + chance.between(0.004, 0.016);
    block.cable = Some(Cable { anchor_m, length_m, stiffness_n_m, damping_n_s_m: 0.2 });
    truth.hidden = vec!["added-constraint"];
    truth.value = Some(("k", stiffness_n_m));
}
