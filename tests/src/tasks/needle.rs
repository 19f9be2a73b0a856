//! Needles with something hidden. A tool's way and its sheet are written down here, in steps of 50 µs; the hand's needle is the stepped
//! world's.

use super::sensor::{Instruments, look};
use super::sheet::{Plan, Sheet, perform};
use super::{Case, Truth};
use crate::generate::{Errors, act};
use blind::Chance;
use estimator::diagnose::{Experiment, Options};
use estimator::pipeline;
use haptics::Vec2;
use haptics::device::Skill;
use haptics::recording::{Recording, Task};
use haptics::world::{World, presets};

/// What is hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Nothing: a linear sheet that slides freely off the shaft, and the plain model.
    Nothing,
    /// Nothing, in the stepped world, beside the world itself.
    NothingInWorld,
    /// A sheet that hardens.
    Hardening,
    /// A dent that stays: less force on the way out.
    Dent,
    /// Friction of the shaft.
    Shaft,
    /// Drag of the shaft.
    Drag,
    /// Friction that is another one in the second hole.
    Change,
    /// A drift of the force.
    Drift,
    /// A resting force, in the stepped world, beside the world itself.
    Bias,
    /// A sheet that is pierced at another force the second time.
    Puncture,
    /// Friction that grows with the length in the hole.
    Longer,
    /// Friction, and more of it at one place in the hole.
    Catch,
    /// Friction, and a force that comes late.
    Late,
}

impl Kind {
    /// All that the whole battery asks for.
    pub const ALL: [(&'static str, Self); 10] = [
        ("needle: nothing", Self::Nothing),
        ("needle: nothing (hand)", Self::NothingInWorld),
        ("needle: hardening", Self::Hardening),
        ("needle: dent", Self::Dent),
        ("needle: shaft", Self::Shaft),
        ("needle: drag", Self::Drag),
        ("needle: change", Self::Change),
        ("needle: drift", Self::Drift),
        ("needle: bias (hand)", Self::Bias),
        ("needle: puncture", Self::Puncture),
    ];
}

/// A case of a kind.
pub fn make(kind: Kind, seed: u64) -> (Case, Truth) {
    let mut chance = Chance::new(seed, 78);
    match kind {
        Kind::NothingInWorld | Kind::Bias => hand(kind, seed, &mut chance),
        _ => {
            let (case, truth, _) = tool(kind, &mut chance);
            (case, truth)
        }
    }
}

/// A case of a tool with another recording of the same sheet.
pub fn twice(kind: Kind, seed: u64) -> (Case, Truth, Recording) {
    let mut chance = Chance::new(seed, 78);
    let (case, truth, (sheet, drift_n_s)) = tool(kind, &mut chance);
    let usual = plan(&sheet, &mut chance);
    let again = perform(&sheet, drift_n_s, &usual, &mut chance);
    (case, truth, again)
}

/// A case that a stand pushed in, and to and fro in the hole, at one speed: what rubs there is the same at any speed, or is not.
pub fn at_one_speed(kind: Kind, seed: u64) -> (Case, Truth) {
    let mut chance = Chance::new(seed, 78);
    let (mut case, truth, (sheet, drift_n_s)) = tool(kind, &mut chance);
    let even = stand(&sheet, &mut chance);
    case.recordings = vec![perform(&sheet, drift_n_s, &even, &mut chance)];
    (case, truth)
}

/// The same sheet under a tool that does what was asked for; nothing for a motion that is none of a needle's.
pub fn as_asked(kind: Kind, seed: u64, asked: &Experiment, by: u64) -> Option<Recording> {
    let (_, _, (sheet, drift_n_s)) = tool(kind, &mut Chance::new(seed, 78));
    let mut chance = Chance::new(by, 78);
    let wanted = follow(asked, &mut chance)?;
    Some(perform(&sheet, drift_n_s, &wanted, &mut chance))
}

/// With the sheet and the drift.
fn tool(kind: Kind, chance: &mut Chance) -> (Case, Truth, (Sheet, f64)) {
    let mut truth = Truth::default();
    let mut sheet = Sheet::plain(chance);
    let mut drift_n_s = 0.0;
    match kind {
        Kind::Hardening => {
            let usual_m = sheet.puncture_n[0] / sheet.stiffness_n_m;
            sheet.cubic_n_m3 = chance.of_order(0.15, 1.0) * sheet.stiffness_n_m / usual_m.powi(2);
            truth.hidden = vec!["stiffness-hardening"];
            truth.value = Some(("k3", sheet.cubic_n_m3));
        }
        Kind::Dent => {
            sheet.dent = chance.between(0.12, 0.45);
            truth.hidden = vec!["hysteresis"];
        }
        Kind::Shaft | Kind::Change => {
            let dry = chance.of_order(0.06, 0.25);
            sheet.dry_n = [dry; 2];
            truth.hidden = vec!["coulomb-friction"];
            if kind == Kind::Change {
                sheet.dry_n[1] = dry * chance.pick(&[0.4, 0.55, 1.6, 2.2]);
                truth.besides = vec!["coulomb-friction"];
                truth.hidden = vec!["friction-change"];
            } else {
                truth.value = Some(("Fc", dry));
            }
        }
        Kind::Drag => {
            sheet.drag_n_s_m = chance.of_order(3.0, 15.0);
            truth.hidden = vec!["viscous-friction"];
            truth.value = Some(("c", sheet.drag_n_s_m));
        }
        Kind::Drift => {
            drift_n_s = chance.of_order(3e-3, 20e-3) * chance.sign();
            truth.hidden = vec!["force-drift"];
            truth.value = Some(("rate", drift_n_s));
        }
        Kind::Longer => {
            sheet.dry_n_m = chance.between(12.0, 25.0);
            truth.hidden = vec!["other:depth sgn(v)"];
            truth.value = Some(("A", sheet.dry_n_m));
        }
        Kind::Catch => {
            sheet.dry_n = [chance.between(0.1, 0.2); 2];
            sheet.catch = (sheet.deep_m() + 3.2e-3, 1.5e-3, chance.between(0.3, 0.6));
            truth.besides = vec!["coulomb-friction"];
            truth.hidden = vec!["local-resistance"];
        }
        Kind::Late => {
            sheet.dry_n = [chance.between(0.1, 0.25); 2];
            sheet.late_s = chance.between(0.03, 0.06);
            truth.besides = vec!["coulomb-friction"];
            truth.hidden = vec!["time-delay"];
            truth.value = Some(("tau", sheet.late_s));
        }
        Kind::Puncture => {
            sheet.puncture_n[1] = sheet.puncture_n[0] * chance.pick(&[0.6, 0.7, 1.4, 1.7]);
            truth.hidden = vec!["other:puncture force over time"];
        }
        _ => {}
    }
    let usual = plan(&sheet, chance);
    let recordings = vec![perform(&sheet, drift_n_s, &usual, chance)];
    (Case { recordings, options: Options::default() }, truth, (sheet, drift_n_s))
}

/// In a little, back, through, to and fro in the hole at two speeds, out; the same at another place.
pub fn plan(sheet: &Sheet, chance: &mut Chance) -> Plan {
    let through = |force: f64| {
        let mut x = 0.0;
        while sheet.elastic_n(x) < force {
            x += 1e-6;
        }
        x
    };
    let outside = -chance.between(4e-3, 7e-3);
    let mut turns = vec![(1.0, outside)];
    let mut cross = vec![(0.0, 0.0)];
    for puncture in sheet.puncture_n {
        let deep = through(puncture);
        let start = turns[turns.len() - 1].0;
        let shares = [
            (1.2, 0.6 * deep),
            (1.0, -1.5e-3),
            (1.6, deep + 5e-3),
            (0.7, deep + 2e-3),
            (0.25, deep + 5e-3),
            (0.4, deep + 1.5e-3),
            (1.2, deep + 4e-3),
            (1.5, outside),
            (0.8, outside),
        ];
        let mut at = start;
        for (long, place) in shares {
            at += long * chance.between(0.8, 1.2);
            turns.push((at, place));
        }
        let side = cross[cross.len() - 1].1;
        cross.extend([(at, side), (at + 0.8, side + 8e-3)]);
        turns.push((at + 1.0, outside));
    }
    Plan { turns, cross, is_even: false }
}

/// Through once, and to and fro in the hole, all at one speed.
fn stand(sheet: &Sheet, chance: &mut Chance) -> Plan {
    let (deep, speed_m_s) = (sheet.deep_m(), chance.between(4e-3, 7e-3));
    let outside = -chance.between(4e-3, 7e-3);
    let mut turns = vec![(0.0, outside), (1.0, outside)];
    let mut go = |place: f64| {
        let (at, from) = turns[turns.len() - 1];
        turns.push((at + (place - from).abs() / speed_m_s, place));
    };
    go(deep + 6e-3);
    for _ in 0..4 {
        go(deep + 1.5e-3);
        go(deep + 6e-3);
    }
    go(outside);
    Plan { turns, cross: vec![(0.0, 0.0)], is_even: true }
}

/// What was asked for, after its description: for each insertion some way in and out, through, slow and fast strokes in the hole, out.
fn follow(asked: &Experiment, chance: &mut Chance) -> Option<Plan> {
    let (deep, full) = (asked.middle - asked.half_range, asked.middle + asked.half_range);
    let mut turns = vec![(0.0, -4e-3), (1.0, -4e-3)];
    let mut cross = vec![(0.0, 0.0)];
    let strokes = |slow: f64| [(deep, slow), (full, slow), (deep, slow), (full, slow)];
    while asked.id == "pierce-slow-fast" && turns[turns.len() - 1].0 < asked.seconds {
        let mut moves = vec![(0.6 * deep, 0.2), (-4e-3, 1.0), (full, 0.5)];
        moves.extend(strokes(0.15).into_iter().chain(strokes(1.0)).chain(strokes(1.0)));
        moves.push((-4e-3, 0.5));
        for (place, pace) in moves {
            let (at, from) = turns[turns.len() - 1];
            let takes_s = 1.875 * (place - from).abs() / (pace * asked.fast) * chance.between(0.95, 1.05);
            turns.push((at + takes_s.max(0.15), place));
        }
        let ((at, _), side) = (turns[turns.len() - 1], cross[cross.len() - 1].1);
        cross.extend([(at, side), (at + 0.8, side + 8e-3)]);
        turns.push((at + 1.0, -4e-3));
    }
    (turns.len() > 2).then_some(Plan { turns, cross, is_even: false })
}

fn hand(kind: Kind, seed: u64, chance: &mut Chance) -> (Case, Truth) {
    let mut world: World = presets::needle();
    if let Some(membrane) = &mut world.membrane {
        membrane.law.stiffness_n_m = chance.between(180.0, 400.0);
        membrane.law.puncture_n = chance.between(1.1, 1.8);
        membrane.law.friction_n = chance.between(0.15, 0.35);
    }
    let skill = Skill { pace: chance.between(0.9, 1.3), ..Skill::default() };
    let mut truth = Truth::default();
    let mut instruments = Instruments::default();
    if kind == Kind::Bias {
        instruments.bias_n[0] = Vec2::new(0.0, chance.of_order(0.02, 0.06) * chance.sign());
        truth.hidden = vec!["force-bias"];
    }
    let once = |seed: u64, with: &Instruments, chance: &mut Chance| {
        let done = act(&world, seed, skill, &Errors { mistakes: &[], fumbles: Vec::new(), looks: false }, 5);
        look(&world, &done.ticks, 1, with, Task::Needle, chance)
    };
    let before = once(seed ^ 0xca11, &Instruments::default(), chance);
    let known = pipeline::analyse(&[before], &pipeline::Options::default()).expect("it is pushed in").world;
    let recording = once(seed, &instruments, chance);
    (Case { recordings: vec![recording], options: Options { world: Some(known), ..Options::default() } }, truth)
}
