//! Blocks that are lifted, carried and stacked with a structure or an effect in them.

use super::carry_effect::{Effect, Kind};
use super::family::{Family, Group};
use super::scale::{Scaled, rms, rms_beside, scaled};
use super::sensor::{ErringSensor, Moment};
use super::sets::{Job, Made};
use super::structure::Structure;
use crate::generate::{Act, Errors, act_with, held_block, stacking_world};
use crate::tasks::Case;
use crate::tasks::blocks::{FIRM, KEPT, Kind as Plain, calibrated, skill};
use crate::tasks::sensor::{Instruments, look};
use blind::Chance;
use blind::lag::Creep;
use estimator::diagnose::Options;
use haptics::Vec2;
use haptics::device::Skill;
use haptics::recording::{Recording, Task};
use haptics::servo::TickRecord;
use haptics::world::{Input, State, World};
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

/// From this pinch on a block is fully held, N: below it a field acts in part.
///
/// Choice: a third of a weak pinch.
const HELD_N: f64 = 0.5;

/// Blocks, who carries them, and with which instruments.
struct Object {
    world: World,
    skill: Skill,
    instruments: Instruments,
    every: usize,
    seed: u64,
    options: Options,
    knows_weights: bool,
}

/// Hidden structure and effect.
#[derive(Clone, Copy, Default)]
struct Hidden {
    structure: Option<Structure>,
    effect: Option<Effect>,
}

/// Error that something hidden brings into the readings of one tick: force of each finger, N, and its place, m.
#[derive(Clone, Copy, Debug, Default)]
struct Wrong {
    force_n: [Vec2; 2],
    tip_m: [Vec2; 2],
}

/// A performance: true forces, and the errors of structure and effect.
struct Run {
    act: Act,
    by_structure: Vec<Wrong>,
    by_effect: Vec<Wrong>,
    /// Only the force sensors have the structure.
    is_in_sensor: bool,
}

/// A case of a job, and the same without its structure.
pub fn make(job: &Job) -> Made {
    let object = drawn(job);
    let mut chance = Chance::new(job.seed, 52);
    let structure = Structure::drawn(job.family, job.form, Group::Blocks, &mut chance);
    let mut hidden =
        Hidden { structure: Some(structure), effect: job.carry_effect.map(|kind| Effect::drawn(kind, &mut chance)) };
    let size = |object: &Object, hidden: &Hidden| {
        let run = run(object, hidden);
        let mut ratios = vec![structure_ratio(object, &run)];
        ratios.extend(hidden.effect.map(|effect| effect_ratio(object, &effect, &run)));
        ratios
    };
    let limited = |k: usize, size: f64| match hidden.effect {
        Some(effect) if k > 0 => effect.kind.limited(size),
        _ => structure.limited(size),
    };
    let mut first = vec![structure.size];
    first.extend(hidden.effect.map(|effect| effect.size));
    let done: Scaled = scaled(&first, &job.ratios, &limited, &mut |sizes| size(&object, &with_sizes(&hidden, sizes)));
    hidden = with_sizes(&hidden, &done.sizes);
    let clean = Hidden { structure: None, ..hidden };
    Made {
        case: case(&object, &hidden),
        clean: case(&object, &clean),
        scaled: done,
        // Forces of both fingers are added.
        noise_n: SQRT_2 * object.instruments.force_n,
    }
}

fn with_sizes(hidden: &Hidden, sizes: &[f64]) -> Hidden {
    let mut hidden = *hidden;
    hidden.structure.iter_mut().for_each(|s| s.size = sizes[0]);
    hidden.effect.iter_mut().for_each(|e| e.size = sizes[1]);
    hidden
}

fn drawn(job: &Job) -> Object {
    let mut chance = Chance::new(job.seed, 51);
    let (before, _) = stacking_world(job.seed ^ 0x51ab_1e57);
    let skill = skill(&mut chance, Plain::Nothing);
    let every = chance.pick(&[1, 2, 4]);
    let force_n = chance.of_order(0.006, 0.015);
    let mut world = before.clone();
    world.blocks.iter_mut().for_each(|block| block.finger_friction = FIRM);
    let known = calibrated(&before, job.seed, &mut chance);
    Object {
        world,
        skill,
        instruments: Instruments { force_n, ..Instruments::default() },
        every,
        seed: job.seed,
        options: Options { world: Some(known), ..Options::default() },
        knows_weights: job.carry_effect == Some(Kind::Gain),
    }
}

fn as_array(v: Vec2) -> [f64; 2] {
    [v.x, v.y]
}

/// The structure and the effect at work between the steps.
struct Meddler {
    hidden: Hidden,
    creep: [Creep; 2],
    steps: usize,
    by_structure: Vec<Wrong>,
    by_effect: Vec<Wrong>,
}

impl Meddler {
    /// Changes a step, and notes by how much at every tick that is kept.
    fn meddle(&mut self, world: &World, state: &mut State, felt: &mut Input, step_s: f64) {
        let sunk_m = self.sunk_m(state, step_s);
        felt.tip_in_world.iter_mut().zip(sunk_m).for_each(|(tip, sunk)| *tip -= sunk);
        let mut by = [Vec2::zeros(); 2];
        if let Some(block) = held_block(world, state) {
            let share = (state.tip_force_n[0].x.min(-state.tip_force_n[1].x) / HELD_N).clamp(0.0, 1.0);
            let body = state.bodies[block];
            let (place, speed) = (as_array(body.center_m), as_array(body.velocity_m_s));
            by[0] = share * self.hidden.structure.map_or(Vec2::zeros(), |s| Vec2::from(s.field_n(place, speed)));
            let field = |e: Effect| e.field_n(world, block, body.velocity_m_s);
            let pushed = by[0] + share * self.hidden.effect.map_or(Vec2::zeros(), field);
            by[1] = self.hidden.effect.map_or(Vec2::zeros(), |e| e.in_world_n(world, state, block));
            state.bodies[block].velocity_m_s += step_s / world.blocks[block].mass_kg * pushed;
        }
        if self.steps.is_multiple_of(KEPT) {
            // Whatever pushes a block, the fingers push back, half each.
            let halves = |force: Vec2| [-0.5 * force; 2];
            self.by_structure.push(Wrong { force_n: halves(by[0]), tip_m: sunk_m });
            self.by_effect.push(Wrong { force_n: halves(by[1]), ..Wrong::default() });
        }
        self.steps += 1;
    }

    /// Way that each pad has sunk in, m.
    fn sunk_m(&mut self, state: &State, step_s: f64) -> [Vec2; 2] {
        let Some(pad) = self.hidden.structure.filter(|s| s.family == Family::GripCreep) else {
            return [Vec2::zeros(); 2];
        };
        let mut sunk = [Vec2::zeros(); 2];
        for (finger, creep) in self.creep.iter_mut().enumerate() {
            creep.follow(as_array(state.tip_force_n[finger]), pad.shape[0], step_s);
            sunk[finger] = pad.size * Vec2::from(creep.past(pad.form));
        }
        sunk
    }
}

fn run(object: &Object, hidden: &Hidden) -> Run {
    let mut world = object.world.clone();
    hidden.effect.iter().for_each(|effect| effect.hide(&mut world));
    let mut meddler = Meddler {
        hidden: *hidden,
        creep: Default::default(),
        steps: 0,
        by_structure: Vec::new(),
        by_effect: Vec::new(),
    };
    let errors = Errors { mistakes: &[], fumbles: Vec::new(), looks: false };
    let act = act_with(&world, object.seed, object.skill, &errors, KEPT, &mut |world, state, felt, step_s| {
        meddler.meddle(world, state, felt, step_s);
    });
    let Meddler { mut by_structure, mut by_effect, .. } = meddler;
    if let Some(structure) = hidden.structure.filter(|s| s.family.is_in_sensor()) {
        let told = told(&act.ticks, &structure);
        for ((wrong, told), tick) in by_structure.iter_mut().zip(told).zip(&act.ticks) {
            wrong.force_n = [0, 1].map(|f: usize| told[f] - tick.tip_force_n[f]);
        }
    }
    if let Some(effect) = hidden.effect.filter(Effect::is_in_reading) {
        let late = if effect.kind == Kind::Late { (effect.size / step_s(&act.ticks)).round() as usize } else { 0 };
        for (k, (wrong, tick)) in by_effect.iter_mut().zip(&act.ticks).enumerate() {
            let before = &act.ticks[k.saturating_sub(late)];
            wrong.force_n =
                [0, 1].map(|f: usize| effect.in_reading_n(f, tick.time_s, tick.tip_force_n[f], before.tip_force_n[f]));
        }
    }
    Run { act, by_structure, by_effect, is_in_sensor: hidden.structure.is_some_and(|s| s.family.is_in_sensor()) }
}

fn step_s(ticks: &[TickRecord]) -> f64 {
    ticks.get(1).map_or(1e-3, |tick| tick.time_s - ticks[0].time_s)
}

/// Forces as sensors with a structure tell them, tick by tick.
fn told(ticks: &[TickRecord], structure: &Structure) -> Vec<[Vec2; 2]> {
    let mut sensors = [0, 1].map(ErringSensor::new);
    let mut before = ticks.first().map_or("", |tick| tick.label);
    let step_s = step_s(ticks);
    let mut told = Vec::with_capacity(ticks.len());
    for tick in ticks {
        let is_struck = tick.label != before;
        before = tick.label;
        told.push([0, 1].map(|f: usize| {
            let place_m = as_array(tick.input.tip_in_world[f]);
            let now = Moment { time_s: tick.time_s, step_s, place_m, is_struck };
            Vec2::from(sensors[f].read(structure, as_array(tick.tip_force_n[f]), &now))
        }));
    }
    told
}

/// The recording, and what the program may know beside it.
fn case(object: &Object, hidden: &Hidden) -> Case {
    let run = run(object, hidden);
    let mut ticks = run.act.ticks;
    if let Some(structure) = hidden.structure.filter(|s| s.family.is_in_sensor()) {
        let told = told(&ticks, &structure);
        ticks.iter_mut().zip(told).for_each(|(tick, told)| tick.tip_force_n = told);
    }
    let mut instruments = object.instruments;
    hidden.effect.iter().for_each(|effect| effect.spoil(&mut instruments));
    let mut chance = Chance::new(object.seed, 53);
    let mut recording: Recording =
        look(&object.world, &ticks, object.every, &instruments, Task::BlockStack, &mut chance);
    if object.knows_weights {
        for (block, name) in object.world.blocks.iter().zip(["block-1", "block-2"]) {
            recording.meta.known.insert(format!("{name}.weight_N"), block.mass_kg * object.world.gravity_m_s2);
        }
    }
    Case { recordings: vec![recording], options: object.options.clone() }
}

/// Rows of one channel: a value, and the block that is held there.
type Rows = Vec<(f64, usize)>;

/// What `of` says of each tick in which a block is carried through the air, or held at all.
fn rows(run: &Run, wrong: &[Wrong], in_air: bool, of: &dyn Fn(&Wrong) -> f64) -> Rows {
    let ticks = run.act.ticks.iter().zip(&run.act.held).zip(wrong);
    let held = ticks.filter(|((tick, _), _)| !in_air || tick.label == "hold-above-ground");
    held.filter_map(|((_, held), wrong)| Some((of(wrong), (*held)?))).collect()
}

/// The errors while nothing is touched.
fn free<'a>(run: &'a Run, wrong: &'a [Wrong]) -> impl Iterator<Item = &'a Wrong> {
    run.act.ticks.iter().zip(wrong).filter(|(tick, _)| tick.label == "free-motion").map(|(_, wrong)| wrong)
}

/// Root mean square after one constant for each block.
fn beside_blocks(rows: &Rows, count: usize) -> f64 {
    let columns = (0..count).map(|block| rows.iter().map(|(_, held)| f64::from(u8::from(*held == block))).collect());
    rms_beside(rows.iter().map(|(value, _)| *value).collect(), columns.collect())
}

/// Size over noise in the channel that shows it best: force of both fingers across and up while a block is carried, force of free
/// fingers, distance of the tips, height of the grip. Weights, widths and heights of the blocks are open.
fn structure_ratio(object: &Object, run: &Run) -> f64 {
    let (force_n, place_m) = (SQRT_2 * object.instruments.force_n, object.instruments.position_m);
    let count = object.world.blocks.len();
    let of = |in_air: bool, of: &dyn Fn(&Wrong) -> f64| rows(run, &run.by_structure, in_air, of);
    let across: Vec<f64> = of(true, &|w| w.force_n[0].x + w.force_n[1].x).into_iter().map(|(value, _)| value).collect();
    let up = of(true, &|w| w.force_n[0].y + w.force_n[1].y);
    // Pads give by their force: a wrong force puts a distance off.
    let (hard, shear) = (object.world.pad.stiffness_n_m, object.world.pad.shear_stiffness_n_m);
    let give = |w: &Wrong, finger: usize| Vec2::new(w.force_n[finger].x / hard, w.force_n[finger].y / shear);
    let is_in_sensor = run.is_in_sensor;
    let tip = |w: &Wrong, finger: usize| if is_in_sensor { give(w, finger) } else { w.tip_m[finger] };
    let width = of(false, &|w| tip(w, 0).x - tip(w, 1).x);
    let height = of(false, &|w| 0.5 * (tip(w, 0).y + tip(w, 1).y));
    let free: Vec<f64> = free(run, &run.by_structure).flat_map(|w| w.force_n.map(as_array)).flatten().collect();
    [
        rms(&free) / object.instruments.force_n,
        rms(&across) / force_n,
        beside_blocks(&up, count) / force_n,
        beside_blocks(&width, count) / (SQRT_2 * place_m),
        beside_blocks(&height, count) / (FRAC_1_SQRT_2 * place_m),
    ]
    .into_iter()
    .fold(0.0, f64::max)
}

/// The same for an effect; free fingers show a fault of the instruments as well, as in the crate `blind`.
fn effect_ratio(object: &Object, effect: &Effect, run: &Run) -> f64 {
    let noise_n = object.instruments.force_n;
    let axis = |axis: usize| {
        let carried = rows(run, &run.by_effect, true, &|w| w.force_n[0][axis] + w.force_n[1][axis]);
        let mut values: Vec<f64> = carried.iter().map(|(value, _)| value / (SQRT_2 * noise_n)).collect();
        if axis == 1 && !object.knows_weights {
            let count = object.world.blocks.len();
            let columns = (0..count).map(|b| carried.iter().map(|(_, held)| f64::from(u8::from(*held == b))).collect());
            blind::measure::project_out(&mut values, columns.collect());
        }
        if effect.is_in_reading() {
            values.extend(free(run, &run.by_effect).flat_map(|w| w.force_n.map(|f| f[axis] / noise_n)));
        }
        rms(&values)
    };
    axis(0).max(axis(1))
}
