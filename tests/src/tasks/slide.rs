//! A block that two fingers slide over a table, with something hidden: steps of 50 µs written down here, instruments of our own.

use super::sensor::{Instruments, look};
use super::{Case, Truth};
use blind::Chance;
use estimator::diagnose::{Experiment, Options};
use haptics::Vec2;
use haptics::device::HandImpedance;
use haptics::recording::{Recording, Task};
use haptics::servo::TickRecord;
use haptics::world::{Input, presets};

/// What is hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Dry friction in proportion to the load, and the weight is known.
    Nothing,
    /// The same under a load that hardly changes, and nothing is known.
    NothingKnown,
    /// Friction that follows the speed beside the dry one.
    Viscous,
    /// Friction that follows the speed, and nothing dry.
    Wet,
    /// Friction that falls with the speed.
    Stribeck,
    /// A table that is tilted.
    Tilt,
    /// A resting force of the sensor.
    Bias,
    /// A constant force, and the fingers are never empty.
    TiltCut,
    /// Another friction in each direction.
    OneWay,
    /// Friction that changes as it wears.
    Change,
    /// A place where it binds.
    Bind,
    /// Forces that come late.
    Delay,
    /// A gain of the forces.
    Gain,
}

impl Kind {
    /// All of them.
    pub const ALL: [(&'static str, Self); 13] = [
        ("slide: nothing", Self::Nothing),
        ("slide: nothing known", Self::NothingKnown),
        ("slide: viscous", Self::Viscous),
        ("slide: wet", Self::Wet),
        ("slide: stribeck", Self::Stribeck),
        ("slide: tilt", Self::Tilt),
        ("slide: bias", Self::Bias),
        ("slide: tilt, cut off", Self::TiltCut),
        ("slide: one way", Self::OneWay),
        ("slide: change", Self::Change),
        ("slide: bind", Self::Bind),
        ("slide: delay", Self::Delay),
        ("slide: gain", Self::Gain),
    ];
}

/// The block and what is under it.
#[derive(Clone, Copy, Debug)]
struct Table {
    mass_kg: f64,
    width_m: f64,
    mu: f64,
    /// Share by which the friction is more to the right and less to the left.
    one_way: f64,
    /// Share of friction that is gone when it is fast, and how fast, m/s.
    falls: (f64, f64),
    /// Share that it changes by, and within how long, s.
    wears: (f64, f64),
    viscous_n_s_m: f64,
    /// Force of the tilt, N.
    pulls_n: f64,
    /// Place, half width, m, and force of a bind, N.
    binds: Option<(f64, f64, f64)>,
    /// Mean share of the weight that the fingers lift, and how much that varies.
    lifted: (f64, f64),
    pad_n_m: f64,
}

impl Table {
    fn drawn(chance: &mut Chance) -> Self {
        Self {
            mass_kg: chance.between(0.05, 0.15),
            width_m: chance.between(0.018, 0.028),
            mu: chance.between(0.15, 0.45),
            one_way: 0.0,
            falls: (0.0, 1.0),
            wears: (0.0, 1.0),
            viscous_n_s_m: 0.0,
            pulls_n: 0.0,
            binds: None,
            lifted: (chance.between(0.0, 0.25), chance.between(0.05, 0.15)),
            pad_n_m: chance.between(2000.0, 4000.0),
        }
    }

    fn weight_n(&self) -> f64 {
        9.81 * self.mass_kg
    }

    /// Dry friction if it slid at this speed, N.
    fn dry_n(&self, load_n: f64, speed_m_s: f64, t: f64) -> f64 {
        let (share, usual) = self.falls;
        let curve = 1.0 + share / (1.0 + (speed_m_s / usual).powi(2));
        let worn = 1.0 + self.wears.0 * (1.0 - (-t / self.wears.1).exp());
        self.mu * load_n * curve * worn * (1.0 + self.one_way * speed_m_s.signum())
    }
}

/// A case of a kind.
pub fn make(kind: Kind, seed: u64) -> (Case, Truth) {
    let (case, truth, _) = made(kind, seed, false);
    (case, truth)
}

/// The same with another recording of the same block by the same instruments, in which the fingers let go.
pub fn twice(kind: Kind, seed: u64) -> (Case, Truth, Recording) {
    let (case, truth, again) = made(kind, seed, true);
    (case, truth, again.expect("it was asked for"))
}

/// The block, its table and its sensors; forces come so many milliseconds late.
fn drawn(kind: Kind, chance: &mut Chance) -> (Table, Instruments, Truth, usize) {
    let mut table = Table::drawn(chance);
    let (mut instruments, mut truth, mut late) = (Instruments::default(), Truth::default(), 0);
    match kind {
        Kind::Nothing => {}
        Kind::NothingKnown => table.lifted = (0.1, 0.0),
        Kind::Viscous => {
            table.viscous_n_s_m = chance.of_order(0.3, 2.0);
            truth.hidden = vec!["viscous-friction"];
            truth.value = Some(("c", table.viscous_n_s_m));
        }
        Kind::Wet => {
            (table.mu, table.viscous_n_s_m) = (0.0, chance.of_order(1.0, 4.0));
            truth.hidden = vec!["viscous-friction"];
            truth.value = Some(("c", table.viscous_n_s_m));
        }
        Kind::Stribeck => {
            table.falls = (chance.of_order(0.3, 0.9), chance.of_order(0.008, 0.03));
            truth.hidden = vec!["stribeck"];
        }
        Kind::Tilt | Kind::TiltCut => {
            let angle = chance.of_order(0.015, 0.08) * chance.sign();
            table.pulls_n = table.weight_n() * f64::sin(angle);
            truth.hidden = vec!["gravity-tilt"];
            truth.equals = vec!["friction-asymmetry"];
            if kind == Kind::TiltCut {
                truth.equals.push("force-bias");
            } else {
                truth.value = Some(("angle", angle));
            }
        }
        Kind::Bias => {
            let bias = chance.of_order(0.01, 0.05) * chance.sign();
            instruments.bias_n[0].x = bias;
            truth.hidden = vec!["force-bias"];
            truth.value = Some(("b", bias));
        }
        Kind::OneWay => {
            table.one_way = chance.of_order(0.06, 0.25) * chance.sign();
            truth.hidden = vec!["friction-asymmetry"];
            truth.equals = vec!["gravity-tilt"];
        }
        Kind::Change => {
            table.wears = (chance.of_order(0.2, 0.5) * chance.sign(), chance.between(3.0, 12.0));
            truth.hidden = vec!["friction-change"];
        }
        Kind::Bind => {
            let by_n = table.mu * table.weight_n() * chance.of_order(0.4, 1.0);
            table.binds = Some((chance.between(-6e-3, 6e-3), chance.between(2e-3, 4e-3), by_n));
            truth.hidden = vec!["local-resistance"];
        }
        Kind::Delay => {
            late = chance.pick(&[5, 8, 12]);
            truth.hidden = vec!["time-delay"];
            truth.value = Some(("tau", 1e-3 * late as f64));
        }
        Kind::Gain => {
            instruments.gain = 1.0 + chance.of_order(0.15, 0.35) * chance.sign();
            truth.hidden = vec!["force-gain"];
            truth.value = Some(("g - 1", instruments.gain - 1.0));
            // The lift is told too large as well: a part of the friction seems to know no load.
            truth.besides = vec!["coulomb-friction"];
        }
    }
    (table, instruments, truth, late)
}

/// The block of a case, slid as an answer asked; nothing for a motion that nobody knows.
pub fn as_asked(kind: Kind, seed: u64, asked: &Experiment, hand: u64) -> Option<Recording> {
    if asked.id != "slide-let-go" || !(asked.fast > 0.0 && asked.half_range > 0.0) {
        return None;
    }
    let (table, instruments, _, late) = drawn(kind, &mut Chance::new(seed, 89));
    let mut chance = Chance::new(hand, 102);
    let way = asked_way(&table, asked, &mut chance);
    let mut recording = seen(&table, &instruments, late, &way, &mut chance);
    if kind != Kind::NothingKnown {
        recording.meta.known.insert("weight_N".to_owned(), table.weight_n());
    }
    Some(Recording { name: "asked".to_owned(), ..recording })
}

fn asked_way(table: &Table, asked: &Experiment, chance: &mut Chance) -> Vec<(f64, f64, f64)> {
    let open = table.width_m + 8e-3;
    let pinched = table.width_m - 4.0 / HandImpedance::default().stiffness_n_m;
    let mut way = vec![(0.0, 0.0, open), (asked.free_s, 0.0, open), (asked.free_s + 0.5, 0.0, pinched)];
    let mut side = 1.0;
    while way[way.len() - 1].0 < asked.free_s + 0.5 + asked.seconds {
        let (now, x, _) = way[way.len() - 1];
        let to = asked.middle + side * asked.half_range * chance.between(0.6, 1.0);
        let takes_s = 1.875 * (to - x).abs() / (asked.fast * chance.between(0.3, 1.0));
        way.push((now + takes_s.max(0.15), to, pinched));
        side = -side;
    }
    let (now, x, _) = way[way.len() - 1];
    way.extend([(now + 0.4, x, pinched), (now + 0.9, x, open), (now + 0.9 + asked.free_s, x, open)]);
    way
}

fn made(kind: Kind, seed: u64, twice: bool) -> (Case, Truth, Option<Recording>) {
    let mut chance = Chance::new(seed, 89);
    let (table, instruments, truth, late) = drawn(kind, &mut chance);
    let recorded = |lets_go: bool, chance: &mut Chance| {
        let mut recording = record(&table, &instruments, late, lets_go, chance);
        if kind != Kind::NothingKnown {
            recording.meta.known.insert("weight_N".to_owned(), table.weight_n());
        }
        recording
    };
    let recording = recorded(kind != Kind::TiltCut, &mut chance);
    let again = twice.then(|| Recording { name: "again".to_owned(), ..recorded(true, &mut chance) });
    (Case { recordings: vec![recording], options: Options::default() }, truth, again)
}

/// Where the hand is wanted: times, s, places, m, and openings beside the pinch, m.
fn plan(table: &Table, lets_go: bool, chance: &mut Chance) -> Vec<(f64, f64, f64)> {
    let open = table.width_m + 8e-3;
    let pinched = table.width_m - 2.0 * chance.between(1.5, 2.5) / HandImpedance::default().stiffness_n_m;
    let mut way =
        if lets_go { vec![(0.0, 0.0, open), (1.6, 0.0, open), (2.1, 0.0, pinched)] } else { vec![(0.0, 0.0, pinched)] };
    let then = |way: &mut Vec<(f64, f64, f64)>, takes_s: f64, x: f64, opening: f64| {
        let now = way[way.len() - 1].0;
        way.push((now + takes_s, x, opening));
    };
    then(&mut way, 0.4, 0.0, pinched);
    let mut x: f64 = 0.0;
    while way[way.len() - 1].0 < 20.0 {
        let to = (if x > 0.0 { -1.0 } else { 1.0 }) * chance.between(0.006, 0.022);
        let speed = chance.of_order(0.02, 0.2);
        then(&mut way, (1.875 * (to - x).abs() / speed).max(0.15), to, pinched);
        if chance.happens(0.3) {
            then(&mut way, chance.between(0.1, 0.4), to, pinched);
        }
        x = to;
    }
    if lets_go {
        then(&mut way, 0.4, x, pinched);
        then(&mut way, 0.5, x, open);
        then(&mut way, 1.6, x, open);
    }
    way
}

fn record(table: &Table, instruments: &Instruments, late: usize, lets_go: bool, chance: &mut Chance) -> Recording {
    let way = plan(table, lets_go, chance);
    seen(table, instruments, late, &way, chance)
}

fn seen(table: &Table, with: &Instruments, late: usize, way: &[(f64, f64, f64)], chance: &mut Chance) -> Recording {
    let mut ticks = slide(table, way, chance);
    let forces: Vec<[Vec2; 2]> = (0..ticks.len()).map(|k| ticks[k.saturating_sub(late)].tip_force_n).collect();
    ticks.iter_mut().zip(forces).for_each(|(tick, force)| tick.tip_force_n = force);
    let every = chance.pick(&[1, 2, 4]);
    look(&presets::stacking(), &ticks, every, with, Task::BlockStack, chance)
}

/// One tick a millisecond.
fn slide(table: &Table, way: &[(f64, f64, f64)], chance: &mut Chance) -> Vec<TickRecord> {
    const STEP_S: f64 = 5e-5;
    const PAD_DAMPING: f64 = 2.0;
    let arm = HandImpedance::default();
    let (floor_m, phases) = (0.01, [chance.between(0.0, 6.0), chance.between(0.0, 6.0)]);
    let tips = |x: f64, opening: f64| [Vec2::new(x - 0.5 * opening, floor_m), Vec2::new(x + 0.5 * opening, floor_m)];
    let (mut place, mut velocity) = (tips(way[0].1, way[0].2), [Vec2::zeros(); 2]);
    let (mut x, mut v) = (0.0_f64, 0.0_f64);
    let mut ticks = Vec::new();
    for k in 0..(way[way.len() - 1].0 / STEP_S) as usize {
        let t = (k as f64 + 1.0) * STEP_S;
        let next = way.partition_point(|w| w.0 <= t).clamp(1, way.len() - 1);
        let (a, b) = (way[next - 1], way[next]);
        let s = ((t - a.0) / (b.0 - a.0)).clamp(0.0, 1.0);
        let (share, rate) = (s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s), 30.0 * (s * (1.0 - s)).powi(2) / (b.0 - a.0));
        let (from, to) = (tips(a.1, a.2), tips(b.1, b.2));
        let sides = [1.0, -1.0];
        let pressed = [0, 1].map(|f: usize| {
            let depth = sides[f] * (place[f].x - (x - sides[f] * 0.5 * table.width_m));
            let closing = sides[f] * (velocity[f].x - v);
            if depth > 0.0 { (table.pad_n_m * depth + PAD_DAMPING * closing).max(0.0) } else { 0.0 }
        });
        let held = pressed[0].min(pressed[1]) > 0.3;
        let (mean, varies) = table.lifted;
        let wave = 0.6 * (1.9 * t + phases[0]).sin() + 0.4 * (4.3 * t + phases[1]).sin();
        let lift_n = if held { table.weight_n() * (mean + varies * wave) } else { 0.0 };
        let mut rubs = table.dry_n(table.weight_n() - lift_n, v, t);
        if let Some((at, half, by_n)) = table.binds {
            rubs += by_n * (1.0 - (x - at).abs() / half).max(0.0);
        }
        let drives = pressed[0] - pressed[1] + table.pulls_n;
        // The friction's slope at the old speed, at the new one: stable however steep.
        let brakes = rubs / (v * v + 1e-8).sqrt() + table.viscous_n_s_m;
        v = (v + STEP_S / table.mass_kg * drives) / (1.0 + STEP_S / table.mass_kg * brakes);
        x += v * STEP_S;
        for f in 0..2 {
            let wanted = (from[f] + (to[f] - from[f]) * share, (to[f] - from[f]) * rate);
            let back = Vec2::new(-sides[f] * pressed[f], 0.0);
            arm.advance(&mut place[f], &mut velocity[f], wanted, back, STEP_S);
        }
        if k % 20 == 0 {
            let tip_force_n = [0, 1].map(|f: usize| Vec2::new(sides[f] * pressed[f], 0.5 * lift_n));
            let input = Input { tip_in_world: place, tip_velocity: velocity };
            ticks.push(TickRecord { time_s: t, input, tip_force_n, ..TickRecord::default() });
        }
    }
    ticks
}
