//! Switches with something hidden: a hand throws the knob over at many speeds in the stepped world, instruments of our own look.

use super::sensor::{Instruments, look};
use super::{Case, Truth};
use crate::captured::draw_curve;
use blind::Chance;
use estimator::diagnose::{Experiment, Options};
use estimator::pipeline;
use haptics::Vec2;
use haptics::device::HandImpedance;
use haptics::law::object::CurvePoint;
use haptics::recording::{Recording, Task};
use haptics::servo::TickRecord;
use haptics::world::{Input, State, Switch, World, presets, step, true_label};
use rand::SeedableRng;
use rand::rngs::StdRng;

/// What is hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Nothing; no world.
    Nothing,
    /// Nothing, beside a world that was captured from another recording.
    NothingInWorld,
    /// A knob that damps.
    Viscous,
    /// More friction after a while.
    Change,
    /// A resting force.
    Bias,
    /// A drift of the force.
    Drift,
    /// Forces that come late.
    Delay,
    /// Pads that harden.
    Hardening,
    /// More friction than in the world.
    Coulomb,
    /// More friction in one direction than in the world.
    OneWay,
    /// A spring that the world does not have.
    Spring,
    /// A bind at one place.
    Bind,
    /// A gain of the forces.
    Gain,
    /// A stop that is nearer than the world's.
    Stop,
}

impl Kind {
    /// All of them.
    pub const ALL: [(&'static str, Self); 14] = [
        ("switch: nothing", Self::Nothing),
        ("switch: nothing (world)", Self::NothingInWorld),
        ("switch: viscous", Self::Viscous),
        ("switch: change", Self::Change),
        ("switch: bias", Self::Bias),
        ("switch: drift", Self::Drift),
        ("switch: delay", Self::Delay),
        ("switch: hardening", Self::Hardening),
        ("switch: friction (world)", Self::Coulomb),
        ("switch: one way (world)", Self::OneWay),
        ("switch: spring (world)", Self::Spring),
        ("switch: bind (world)", Self::Bind),
        ("switch: gain (world)", Self::Gain),
        ("switch: stop (world)", Self::Stop),
    ];

    fn has_world(self) -> bool {
        use Kind::{Bind, Coulomb, Gain, NothingInWorld, OneWay, Spring, Stop};
        matches!(self, NothingInWorld | Coulomb | OneWay | Spring | Bind | Gain | Stop)
    }
}

/// What happens beside the world and the instruments.
#[derive(Clone, Copy, Debug, Default)]
struct Beside {
    /// More friction in both directions, N, from when on, s.
    change: Option<(f64, f64)>,
    /// Forces come so many milliseconds late.
    late_ms: usize,
}

/// A throw: how long it takes, s, how far beyond the stop the finger is wanted, m, and how long it is left there, s.
#[derive(Clone, Copy, Debug)]
struct Throw {
    takes_s: f64,
    beyond_m: f64,
    stays_s: f64,
}

/// A case of a kind.
pub fn make(kind: Kind, seed: u64) -> (Case, Truth) {
    let (case, truth, _) = made(kind, seed, false);
    (case, truth)
}

/// The same with another recording of the same switch by the same instruments.
pub fn twice(kind: Kind, seed: u64) -> (Case, Truth, Recording) {
    let (case, truth, again) = made(kind, seed, true);
    (case, truth, again.expect("it was asked for"))
}

/// A case beside a captured world in which the switch is thrown to one side only, once a recording, and put back in between: what rubs
/// more both ways, or one way, looks alike.
pub fn to_one_side(kind: Kind, seed: u64) -> (Case, Truth) {
    let (_, truth, at) = hidden(kind, seed);
    let mut chance = Chance::new(seed, 84);
    let mut once = || {
        let throw = Throw { takes_s: chance.between(2.0, 3.5), beyond_m: 4e-3, stays_s: 0.4 };
        record_throws(&at, &[throw], &mut chance)
    };
    let recordings = vec![once(), once(), once()];
    let captured = record(&at.before, &Instruments::default(), Beside::default(), &mut chance);
    let known = pipeline::analyse(&[captured], &pipeline::Options::default()).expect("it was thrown both ways").world;
    (Case { recordings, options: Options { world: Some(known), ..Options::default() } }, truth)
}

/// The same switch, thrown as was asked for; nothing for a motion that is none of a switch's.
pub fn as_asked(kind: Kind, seed: u64, asked: &Experiment, by: u64) -> Option<Recording> {
    let (_, _, at) = hidden(kind, seed);
    let mut chance = Chance::new(by, 84);
    let switch = at.world.switch.as_ref().expect("a switch");
    let knob_m = switch.knob_in_world(switch.curve.points.last().expect("an end").at_m).x;
    let beyond_m = asked.half_range - knob_m - 3e-3;
    let pace = |k: usize| [0.15, 1.0, 0.4][(k / 2) % 3] * chance_near_one(k);
    let takes_s = |k: usize| 1.875 * 2.0 * asked.half_range / (pace(k) * asked.fast);
    let mut throws: Vec<Throw> = Vec::new();
    while asked.id == "throw-slow-fast" && throws.iter().map(|t| t.takes_s + 1.0).sum::<f64>() < asked.seconds {
        throws.push(Throw { takes_s: takes_s(throws.len()), beyond_m, stays_s: 0.35 });
    }
    (!throws.is_empty()).then(|| record_throws(&at, &throws, &mut chance))
}

/// Nobody is as fast every time.
fn chance_near_one(k: usize) -> f64 {
    1.0 + 0.05 * (2.3 * k as f64).sin()
}

/// A switch with what is hidden in it.
struct Hidden {
    before: World,
    world: World,
    instruments: Instruments,
    beside: Beside,
}

fn hidden(kind: Kind, seed: u64) -> (Chance, Truth, Hidden) {
    let mut chance = Chance::new(seed, 83);
    let before = drawn(seed, &mut chance);
    let mut world = before.clone();
    let (mut instruments, mut beside, mut truth) = (Instruments::default(), Beside::default(), Truth::default());
    hide(kind, &mut world, (&mut instruments, &mut beside), &mut truth, &mut chance);
    (chance, truth, Hidden { before, world, instruments, beside })
}

fn made(kind: Kind, seed: u64, twice: bool) -> (Case, Truth, Option<Recording>) {
    let (mut chance, truth, Hidden { before, world, instruments, beside }) = hidden(kind, seed);
    let recording = record(&world, &instruments, beside, &mut chance);
    let known = kind.has_world().then(|| {
        let captured = record(&before, &Instruments::default(), Beside::default(), &mut chance);
        pipeline::analyse(&[captured], &pipeline::Options::default()).expect("it was thrown both ways").world
    });
    let again = twice.then(|| record(&world, &instruments, beside, &mut chance));
    (Case { recordings: vec![recording], options: Options { world: known, ..Options::default() } }, truth, again)
}

/// A switch with everything about it drawn; its knob hardly damps.
fn drawn(seed: u64, chance: &mut Chance) -> World {
    let mut world = presets::switch();
    world.pad.stiffness_n_m = chance.between(2000.0, 3500.0);
    if let Some(switch) = &mut world.switch {
        let half = draw_curve(switch, &mut StdRng::seed_from_u64(seed ^ 0x00d1_a65e));
        switch.curve.stop_n_m = world.pad.stiffness_n_m * chance.between(1.0, 6.0);
        switch.lever_m = 2.0 * half / chance.between(0.35, 0.7);
        switch.knob_radius_m = chance.between(0.005, 0.007);
        switch.damping_n_s_m = 0.05;
    }
    world
}

fn points(world: &mut World) -> &mut Vec<CurvePoint> {
    &mut world.switch.as_mut().expect("a switch").curve.points
}

fn harder(points: &mut [CurvePoint], by_n: f64) {
    for point in points {
        point.forward_n += by_n;
        point.backward_n -= by_n;
    }
}

fn hide(
    kind: Kind,
    world: &mut World,
    (instruments, beside): (&mut Instruments, &mut Beside),
    truth: &mut Truth,
    chance: &mut Chance,
) {
    match kind {
        Kind::Nothing | Kind::NothingInWorld => {}
        Kind::Viscous => {
            let c = chance.of_order(1.5, 8.0);
            world.switch.as_mut().expect("a switch").damping_n_s_m += c;
            truth.hidden = vec!["viscous-friction"];
            truth.value = Some(("c", c));
        }
        Kind::Change => {
            let by_n = chance.of_order(0.04, 0.2);
            beside.change = Some((by_n, chance.between(7.0, 16.0)));
            truth.hidden = vec!["friction-change"];
            truth.value = Some(("change", by_n));
        }
        Kind::Bias => {
            let finger = usize::from(chance.happens(0.5));
            let bias = chance.of_order(0.01, 0.05) * chance.sign();
            instruments.bias_n[finger].x = bias;
            truth.hidden = vec!["force-bias"];
            truth.value = Some((["bx1", "bx2"][finger], bias));
        }
        Kind::Drift => {
            let finger = usize::from(chance.happens(0.5));
            let rate = chance.of_order(2e-3, 10e-3) * chance.sign();
            instruments.drift_n_s[finger].x = rate;
            truth.hidden = vec!["force-drift"];
            truth.value = Some((["rx1", "rx2"][finger], rate));
        }
        Kind::Delay => {
            beside.late_ms = chance.pick(&[10, 15, 20, 25]);
            truth.hidden = vec!["time-delay"];
            truth.value = Some(("tau", 1e-3 * beside.late_ms as f64));
        }
        Kind::Hardening => {
            // At a newton the give is that of a pad a half to twice as stiff.
            let soft = world.pad.stiffness_n_m;
            world.pad.cubic_n_m3 = chance.of_order(0.3, 1.2) * soft.powi(3);
            truth.hidden = vec!["stiffness-hardening"];
        }
        Kind::Coulomb => {
            let by_n = chance.of_order(0.2, 0.5);
            harder(points(world), by_n);
            truth.hidden = vec!["coulomb-friction"];
            truth.value = Some(("Fc", by_n));
        }
        Kind::OneWay => one_way(world, truth, chance),
        Kind::Spring => {
            let k = chance.of_order(80.0, 120.0);
            for point in points(world) {
                point.forward_n += k * point.at_m;
                point.backward_n += k * point.at_m;
            }
            truth.hidden = vec!["return-spring"];
            truth.value = Some(("k", k));
        }
        Kind::Bind => {
            bind(world, chance);
            truth.hidden = vec!["local-resistance"];
        }
        Kind::Gain => {
            instruments.gain = 1.0 + chance.of_order(0.2, 0.4) * chance.sign();
            truth.hidden = vec!["force-gain"];
            truth.value = Some(("g - 1", instruments.gain - 1.0));
        }
        Kind::Stop => stop(world, truth, chance),
    }
}

/// The right stop is nearer than it was.
fn stop(world: &mut World, truth: &mut Truth, chance: &mut Chance) {
    let nearer = chance.of_order(1.0e-3, 2.0e-3);
    let curve = &mut world.switch.as_mut().expect("a switch").curve;
    let end = curve.points.last().expect("an end").at_m - nearer;
    let (forward_n, backward_n) = (curve.force_n(end, 1.0), curve.force_n(end, 0.0));
    *curve.points.last_mut().expect("an end") = CurvePoint { at_m: end, forward_n, backward_n };
    truth.hidden = vec!["added-constraint"];
    truth.value = Some(("right stop is nearer by", nearer));
}

/// More friction in one direction.
fn one_way(world: &mut World, truth: &mut Truth, chance: &mut Chance) {
    let (by_n, right) = (chance.of_order(0.25, 0.6), chance.happens(0.5));
    for point in points(world) {
        if right {
            point.forward_n += by_n;
        } else {
            point.backward_n -= by_n;
        }
    }
    truth.hidden = vec!["friction-asymmetry"];
    truth.value = Some((if right { "dFc to the right" } else { "dFc to the left" }, by_n));
}

/// A triangle of resistance between a stop and the top of the curve, on the way that fingers push in both directions.
fn bind(world: &mut World, chance: &mut Chance) {
    let by_n = chance.of_order(0.25, 0.45);
    let curve = &mut world.switch.as_mut().expect("a switch").curve;
    let (low, high) = (curve.points[0].at_m, curve.points[1].at_m);
    let (middle, half) = (low + (high - low) * chance.between(0.5, 0.6), 0.35 * (high - low));
    let more = [(middle - half, 0.0), (middle, by_n), (middle + half, 0.0)].map(|(at_m, more)| CurvePoint {
        at_m,
        forward_n: curve.force_n(at_m, 1.0) + more,
        backward_n: curve.force_n(at_m, 0.0) - more,
    });
    curve.points.extend(more);
    curve.points.sort_by(|a, b| a.at_m.total_cmp(&b.at_m));
}

fn record(world: &World, instruments: &Instruments, beside: Beside, chance: &mut Chance) -> Recording {
    let throws = throws(chance);
    record_way(world, instruments, beside, &throws, chance)
}

fn record_throws(at: &Hidden, throws: &[Throw], chance: &mut Chance) -> Recording {
    record_way(&at.world, &at.instruments, at.beside, throws, chance)
}

fn record_way(
    world: &World,
    instruments: &Instruments,
    beside: Beside,
    throws: &[Throw],
    chance: &mut Chance,
) -> Recording {
    let switch = world.switch.as_ref().expect("a switch");
    let way = way(switch, throws, chance.between(1.0, 2.0));
    let mut ticks = act(world, beside, &way, switch.knob_radius_m + 3e-3);
    let forces: Vec<[Vec2; 2]> =
        (0..ticks.len()).map(|k| ticks[k.saturating_sub(beside.late_ms)].tip_force_n).collect();
    ticks.iter_mut().zip(forces).for_each(|(tick, force)| tick.tip_force_n = force);
    let every = chance.pick(&[1, 2, 5]);
    look(world, &ticks, every, instruments, Task::Switch, chance)
}

fn throws(chance: &mut Chance) -> Vec<Throw> {
    let count = 2 * chance.pick(&[5, 6, 7]);
    let each = |chance: &mut Chance| Throw {
        takes_s: chance.of_order(0.8, 2.6),
        beyond_m: chance.between(2e-3, 6e-3),
        stays_s: chance.between(0.2, 0.5),
    };
    (0..count).map(|_| each(chance)).collect()
}

/// Where the middle of both fingers is wanted: times, s, and places, m.
fn way(switch: &Switch, throws: &[Throw], free_s: f64) -> Vec<(f64, Vec2)> {
    let ends = [switch.curve.points.first(), switch.curve.points.last()].map(|p| p.map_or(0.0, |p| p.at_m));
    let start = switch.knob_in_world(switch.start_m);
    let mut way = vec![(0.0, start), (free_s, start)];
    let then = |way: &mut Vec<(f64, Vec2)>, takes_s: f64, place: Vec2| {
        let now = way[way.len() - 1].0;
        way.push((now + takes_s, place));
    };
    for (k, throw) in throws.iter().enumerate() {
        let right = k % 2 == 0;
        let end = switch.knob_in_world(ends[usize::from(right)]);
        let push = Vec2::new(if right { 3e-3 + throw.beyond_m } else { -3e-3 - throw.beyond_m }, 0.0);
        then(&mut way, throw.takes_s, end + push);
        then(&mut way, throw.stays_s, end + push);
        then(&mut way, 0.4, end);
        then(&mut way, 0.25, end);
    }
    let last = way[way.len() - 1].1;
    then(&mut way, free_s, last);
    way
}

fn act(world: &World, beside: Beside, way: &[(f64, Vec2)], half_m: f64) -> Vec<TickRecord> {
    const STEP_S: f64 = 2e-4;
    let arm = HandImpedance::default();
    let half = [Vec2::new(-half_m, 0.0), Vec2::new(half_m, 0.0)];
    let (mut place, mut velocity) = (half.map(|h| way[0].1 + h), [Vec2::zeros(); 2]);
    let (mut state, mut now) = (State::resting(world), world.clone());
    let mut ticks = Vec::new();
    let steps = (way[way.len() - 1].0 / STEP_S) as usize;
    for k in 0..steps {
        let t = (k as f64 + 1.0) * STEP_S;
        if let Some((by_n, from_s)) = beside.change.filter(|_| k % 25 == 0) {
            now = world.clone();
            harder(points(&mut now), by_n * ((t - from_s) / 0.5).clamp(0.0, 1.0));
        }
        let next = way.partition_point(|w| w.0 <= t).clamp(1, way.len() - 1);
        let ((t0, from), (t1, to)) = (way[next - 1], way[next]);
        let s = ((t - t0) / (t1 - t0)).clamp(0.0, 1.0);
        let (share, rate) = (s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s), 30.0 * (s * (1.0 - s)).powi(2) / (t1 - t0));
        for f in 0..2 {
            let wanted = (from + (to - from) * share + half[f], (to - from) * rate);
            arm.advance(&mut place[f], &mut velocity[f], wanted, -state.tip_force_n[f], STEP_S);
        }
        let input = Input { tip_in_world: place, tip_velocity: velocity };
        step(&now, &mut state, &input, STEP_S);
        if k % 5 == 0 {
            let (tip_force_n, label) = (state.tip_force_n, true_label(&now, &state));
            ticks.push(TickRecord { time_s: state.time_s, input, tip_force_n, label, ..TickRecord::default() });
        }
    }
    ticks
}
