//! Needles with something hidden. A tool's way and its sheet are written down here, in steps of 50 µs; the hand's needle is the stepped
//! world's.

use super::sensor::{Instruments, look};
use super::{Case, Truth};
use crate::generate::{Errors, act};
use blind::Chance;
use estimator::diagnose::{Experiment, Options};
use estimator::pipeline;
use haptics::Vec2;
use haptics::device::Skill;
use haptics::recording::{Channel, Meta, Recording, Task};
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

/// What the tool meets.
struct Sheet {
    stiffness_n_m: f64,
    cubic_n_m3: f64,
    dent: f64,
    puncture_n: [f64; 2],
    dry_n: [f64; 2],
    drag_n_s_m: f64,
    /// Dry friction by length in the hole.
    dry_n_m: f64,
    /// More of it: where, within how far, and how much at most.
    catch: (f64, f64, f64),
    /// By how much the force comes late, s.
    late_s: f64,
}

impl Sheet {
    fn elastic_n(&self, x: f64) -> f64 {
        self.stiffness_n_m * x + self.cubic_n_m3 * x.powi(3)
    }
}

/// A way through turning points (time, place): smooth, or at an even speed between them.
fn way(t: f64, turns: &[(f64, f64)], is_even: bool) -> f64 {
    let k = turns.partition_point(|(at, _)| *at <= t);
    let (Some(&(t0, from)), Some(&(t1, to))) = (k.checked_sub(1).and_then(|k| turns.get(k)), turns.get(k)) else {
        return if k == 0 { turns[0].1 } else { turns[turns.len() - 1].1 };
    };
    let s = (t - t0) / (t1 - t0);
    from + (to - from) * if is_even { s } else { s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s) }
}

/// With the sheet and the drift.
fn tool(kind: Kind, chance: &mut Chance) -> (Case, Truth, (Sheet, f64)) {
    let mut truth = Truth::default();
    let mut sheet = Sheet {
        stiffness_n_m: chance.between(120.0, 500.0),
        cubic_n_m3: 0.0,
        dent: 0.0,
        puncture_n: [chance.between(0.9, 2.0); 2],
        dry_n: [0.0; 2],
        drag_n_s_m: 0.0,
        dry_n_m: 0.0,
        catch: (0.0, 1.0, 0.0),
        late_s: 0.0,
    };
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

/// Where the tool is wanted: along its way in, and across.
struct Plan {
    turns: Vec<(f64, f64)>,
    cross: Vec<(f64, f64)>,
    /// A stand does it: at an even speed, without a tremor.
    is_even: bool,
}

/// In a little, back, through, to and fro in the hole at two speeds, out; the same at another place.
fn plan(sheet: &Sheet, chance: &mut Chance) -> Plan {
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

impl Sheet {
    /// Dry friction of a hole at a depth, N.
    fn dry_at_n(&self, place: usize, x: f64) -> f64 {
        let (at, within, most_n) = self.catch;
        let aside = ((x - at) / within).abs().min(1.0);
        self.dry_n[place] + self.dry_n_m * x + most_n * (1.0 - aside * aside).powi(2)
    }

    /// How deep it is pushed in when it gives way the first time, m.
    fn deep_m(&self) -> f64 {
        let mut x = 0.0;
        while self.elastic_n(x) < self.puncture_n[0] {
            x += 1e-6;
        }
        x
    }
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

/// The sheet under the tool, and what its instruments read.
fn perform(sheet: &Sheet, drift_n_s: f64, plan: &Plan, chance: &mut Chance) -> Recording {
    const FINE_S: f64 = 5e-5;
    let rate_hz = chance.pick(&[250.0, 500.0, 1000.0]);
    let every = (1.0 / (rate_hz * FINE_S)).round() as usize;
    let Plan { turns, cross, is_even } = plan;
    let tremor_m = if *is_even { 0.0 } else { 4e-5 };
    let end_s = turns[turns.len() - 1].0 + 0.5;
    let surface_m = chance.between(-0.02, 0.02);
    let bias = 0.03 * chance.normal();
    let phase = chance.between(0.0, 6.0);
    let (mut deepest, mut pierced, mut site, mut place) = (0.0_f64, false, 0_usize, 0_usize);
    let (mut time, mut depth, mut side) = (Vec::new(), Vec::new(), Vec::new());
    let (mut felt, mut force): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let mut before = turns[0].1;
    for fine in 0..(end_s / FINE_S) as usize {
        let t = fine as f64 * FINE_S;
        let across = way(t, cross, false);
        let here = (across / 8e-3).round() as usize;
        if here != site {
            (site, place, deepest, pierced) = (here, here.min(1), 0.0, false);
        }
        let x = way(t, turns, *is_even) + tremor_m * (50.0 * t + phase).sin();
        let speed = (x - before) / FINE_S;
        before = x;
        let mut f = 0.0;
        if pierced && x > 0.0 {
            // Rational in the speed: no kink at rest.
            f = sheet.dry_at_n(place, x) * speed / (speed * speed + 1e-8).sqrt() + sheet.drag_n_s_m * speed;
        } else if x > 0.0 {
            let left = sheet.dent * deepest;
            f = if x >= deepest {
                sheet.elastic_n(x)
            } else {
                sheet.elastic_n(deepest) * ((x - left) / (deepest - left)).max(0.0)
            };
            deepest = deepest.max(x);
            pierced = f >= sheet.puncture_n[place];
        }
        if fine % every == 0 {
            time.push(t);
            depth.push(((surface_m + x + 1e-5 * chance.normal()) / 5e-6).round() * 5e-6);
            side.push(across + 1e-5 * chance.normal());
            felt.push(f);
            force.push(bias + drift_n_s * t + 0.01 * chance.normal());
        }
    }
    let late = (sheet.late_s * rate_hz).round() as usize;
    for (i, read) in force.iter_mut().enumerate() {
        *read = ((*read + felt[i.saturating_sub(late)]) / 1e-3).round() * 1e-3;
    }
    let still: Vec<f64> = force.iter().map(|_| 0.01 * chance.normal()).collect();
    let down = |values: Vec<f64>| values.into_iter().map(|v| -v).collect::<Vec<f64>>();
    let channels = [("x_m", side), ("y_m", down(depth)), ("fx_N", still), ("fy_N", down(force))];
    let unit = |name: &str| if name.starts_with('f') { "N" } else { "m" }.to_owned();
    Recording {
        name: "case".to_owned(),
        time_s: Some(time),
        channels: channels.map(|(name, values)| Channel { name: name.to_owned(), unit: unit(name), values }).to_vec(),
        meta: Meta { task: Some(Task::Needle), ..Meta::default() },
        ..Recording::default()
    }
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
