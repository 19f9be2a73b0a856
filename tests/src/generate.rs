//! Recordings of the scripted operator in worlds drawn at random.

use crate::fumble::{Clumsy, Fumble};
use haptics::Vec2;
use haptics::device::{Command, Device, Mistake, ScriptedOperator, Skill};
use haptics::law::{CoulombFriction, Effect, Inertia, LoadFriction, ViscousFriction, Weight};
use haptics::recording::Recording;
use haptics::servo::TickRecord;
use haptics::servo::recorder::{SensorModel, to_recording};
use haptics::world::{Block, Input, State, Surface, World, presets, step, true_label};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::collections::BTreeMap;

/// True values by (object, parameter name).
pub type Truth = BTreeMap<(String, String), f64>;

/// Strain gauges rest within this of zero, N.
const LARGEST_BIAS_N: f64 = 0.02;

/// A grip that holds, N.
const FIRM_N: f64 = 0.5;

/// Step of the generator, s: a fifth of the usual servo's.
pub const STEP_S: f64 = 0.2e-3;

/// Within a step, force and velocity belong to instants half a step apart, which looks like c · step / 2 of inertia on a crank
/// with viscous friction c: cranks are stepped more finely than that shows.
fn steps_per_step(world: &World) -> u32 {
    if world.crank.is_some() { 4 } else { 1 }
}

/// A recording and what only the generator knows about how it went.
pub struct Performance {
    /// What the sensors saw.
    pub recording: Recording,
    /// Mean height of the grasp points above the middle of the crank's handle, m: the circle that the fingers follow is the
    /// handle's, shifted by this. Zero without a crank.
    pub grasp_offset_y_m: f64,
    /// How well that mean is one, m: the grasp wanders on the handle by a micrometre within a turn.
    pub grasp_offset_error_m: f64,
    /// How far above the first body's middle it was held, pads without their give, m; `None` where no body was held.
    pub held_above_m: Option<f64>,
}

/// Performs the task of `world` and records every `every`-th fine step.
pub fn perform(world: &World, seed: u64, skill: Skill, every: usize, sensor: &SensorModel) -> Performance {
    perform_at_levels(world, seed, skill, every, std::slice::from_ref(sensor)).remove(0)
}

/// One and the same performance, seen by several sensors, all with the same bias of their forces.
pub fn perform_at_levels(
    world: &World,
    seed: u64,
    skill: Skill,
    every: usize,
    sensors: &[SensorModel],
) -> Vec<Performance> {
    perform_with_mistakes(world, seed, skill, &[], every, sensors)
}

/// The same by an operator who makes mistakes on purpose.
pub fn perform_with_mistakes(
    world: &World,
    seed: u64,
    skill: Skill,
    mistakes: &[Mistake],
    every: usize,
    sensors: &[SensorModel],
) -> Vec<Performance> {
    let done = act(world, seed, skill, &Errors { mistakes, fumbles: Vec::new(), looks: false }, every);
    let (grasp_offset_y_m, grasp_offset_error_m) = mean_of_parts(&done.offsets);
    sensors
        .iter()
        .map(|sensor| Performance {
            recording: done.seen_by(sensor, 1, world, seed),
            grasp_offset_y_m,
            grasp_offset_error_m,
            held_above_m: done.held_above_m,
        })
        .collect()
}

/// What goes wrong in a performance.
pub struct Errors<'a> {
    /// What the operator does wrong on purpose.
    pub mistakes: &'a [Mistake],
    /// Fingers that open when they should not.
    pub fumbles: Vec<Fumble>,
    /// Whether the operator sees that a block was lost, and fetches it.
    pub looks: bool,
}

/// What was done in a world, before any sensor looks at it.
pub struct Act {
    /// Every so many fine steps.
    pub ticks: Vec<TickRecord>,
    /// The block that both fingers hold at each of them; truth for assertions.
    pub held: Vec<Option<usize>>,
    /// The world's state at the end; truth for assertions.
    pub end: State,
    /// Height of grasp points above the handle's middle, m.
    offsets: Vec<f64>,
    /// How far above the first body's middle it was held, m.
    held_above_m: Option<f64>,
    bias_n: [Vec2; 2],
}

impl Act {
    /// A recording of every `every`-th tick by a sensor.
    pub fn seen_by(&self, sensor: &SensorModel, every: usize, world: &World, seed: u64) -> Recording {
        // An ideal sensor has no bias either.
        let bias_n = if *sensor == SensorModel::IDEAL { [Vec2::zeros(); 2] } else { self.bias_n };
        let biased = |tick: &TickRecord| TickRecord {
            tip_force_n: [0, 1].map(|f: usize| tick.tip_force_n[f] + bias_n[f]),
            ..*tick
        };
        let seen: Vec<TickRecord> = self.ticks.iter().step_by(every.max(1)).map(biased).collect();
        to_recording(&format!("seed {seed}"), world, &seen, 1, sensor, seed ^ 0x5eed)
    }
}

/// Interferes before each fine step: with the state, and with the tips that the world feels. Its last argument is the step, s.
pub type Meddle<'a> = dyn FnMut(&World, &mut State, &mut Input, f64) + 'a;

/// Performs the task of `world`; every `every`-th fine step is kept.
pub fn act(world: &World, seed: u64, skill: Skill, errors: &Errors<'_>, every: usize) -> Act {
    act_with(world, seed, skill, errors, every, &mut |_, _, _, _| {})
}

/// The same while something interferes that no world has. The kept tips are the operator's own.
pub fn act_with(
    world: &World,
    seed: u64,
    skill: Skill,
    errors: &Errors<'_>,
    every: usize,
    meddle: &mut Meddle<'_>,
) -> Act {
    let mut state = State::resting(world);
    let mut operator = ScriptedOperator::with_mistakes(world, &state, skill, errors.mistakes, seed);
    let mut hand = (!errors.fumbles.is_empty()).then(|| Clumsy::new(errors.fumbles.clone()));
    let mut rng = StdRng::seed_from_u64(seed ^ 0xb1a5);
    let bias_n = [(); 2].map(|()| Vec2::from_fn(|_, _| rng.random_range(-LARGEST_BIAS_N..LARGEST_BIAS_N)));
    let (mut ticks, mut held, mut offsets) = (Vec::new(), Vec::new(), Vec::new());
    let mut above = Vec::new();
    let mut count = 0_usize;
    while !operator.finished() {
        let parts = steps_per_step(world);
        let part_s = STEP_S / f64::from(parts);
        let mut input = Input::default();
        for _ in 0..parts {
            let sample = operator.exchange(&Command { force_n: state.tip_force_n.map(|f| -f) }, part_s);
            input = Input { tip_in_world: sample.tip_in_world, tip_velocity: sample.tip_velocity };
            if let Some(hand) = &mut hand {
                hand.spoil(&mut input, true_label(world, &state), state.time_s);
            }
            if errors.looks {
                operator.see(world, &state);
            }
            let mut felt = input;
            meddle(world, &mut state, &mut felt, part_s);
            step(world, &mut state, &felt, part_s);
        }
        if let Some(handle) = state.handle_in_world(world)
            && state.crank.rate_rad_s.abs() > 0.5
        {
            for contact in state.contacts.iter().filter(|c| c.by == Surface::Handle) {
                offsets.push(contact.point_m.y - handle.y - contact.shear_m * contact.tangent().y);
            }
        }
        above.extend(held_above_m(world, &state, &input));
        if count.is_multiple_of(every) {
            ticks.push(TickRecord {
                time_s: state.time_s,
                input,
                tip_force_n: state.tip_force_n,
                label: true_label(world, &state),
                ..TickRecord::default()
            });
            held.push(held_block(world, &state));
        }
        count += 1;
    }
    let held_above_m = (!above.is_empty()).then(|| mean_of_parts(&above).0);
    Act { ticks, held, end: state, offsets, held_above_m, bias_n }
}

/// How far above its middle the first body is held, m; nothing while it is not held firmly.
fn held_above_m(world: &World, state: &State, input: &Input) -> Option<f64> {
    let body = state.bodies.first()?;
    let place = |f: usize| input.tip_in_world[f].y - state.tip_force_n[f].y / world.pad.shear_stiffness_n_m;
    let is_firm = state.tip_force_n[0].x.min(-state.tip_force_n[1].x) > FIRM_N;
    is_firm.then(|| 0.5 * (place(0) + place(1)) - body.center_m.y)
}

/// The block that both fingers press.
pub(crate) fn held_block(world: &World, state: &State) -> Option<usize> {
    let pressed = |finger: u8, block: usize| {
        state
            .contacts
            .iter()
            .any(|c| c.on == Surface::Finger(finger) && c.by == Surface::Block(block as u16) && c.normal_force_n > 0.0)
    };
    (0..world.blocks.len()).find(|block| pressed(0, *block) && pressed(1, *block))
}

/// Mean of a series, and its standard error from the means of eight parts.
fn mean_of_parts(series: &[f64]) -> (f64, f64) {
    const PARTS: usize = 8;
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len().max(1) as f64;
    let total = mean(series);
    let length = (series.len() / PARTS).max(1);
    let spread: f64 = series.chunks_exact(length).map(|part| (mean(part) - total).powi(2)).sum();
    (total, spread.sqrt() / PARTS as f64)
}

/// Two blocks of random weight, size and friction, block 1 on block 2, with their truth.
pub fn stacking_world(seed: u64) -> (World, Truth) {
    let mut rng = StdRng::seed_from_u64(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let mut world = presets::stacking();
    let floor_m = world.floor.as_ref().map_or(0.0, |f| f.height_m);
    let left_m = -0.014;
    let mut draw = |low: f64, high: f64| rng.random_range(low..high);
    let (height_1, height_2) = (draw(0.011, 0.018), draw(0.010, 0.016));
    let mut lower = Block::upright("block-2", draw(0.03, 0.06), draw(0.020, 0.027), height_2, left_m, floor_m);
    let mut upper =
        Block::upright("block-1", draw(0.025, 0.05), draw(0.013, 0.019), height_1, left_m, floor_m + height_2);
    world.pad.stiffness_n_m = draw(1800.0, 4000.0);
    world.pad.shear_stiffness_n_m = draw(1000.0, 2500.0);
    let mut truth = Truth::new();
    let contact_n_m = draw(25_000.0, 55_000.0);
    for block in [&mut upper, &mut lower] {
        block.finger_friction = draw(0.7, 1.2);
        // Wood on wood, hard against the pads: their own give must not be mistaken for height. Twice as hard as the contact of
        // two of them, which give in series.
        block.stiffness_n_m = draw(50_000.0, 110_000.0);
        block.damping_n_s_m = 12.0;
        for (name, value) in [
            ("weight_N", block.mass_kg * world.gravity_m_s2),
            ("mass_kg", block.mass_kg),
            ("width_m", block.width_m),
            ("height_m", block.height_m),
            ("friction", block.finger_friction),
        ] {
            truth.insert((block.name.clone(), name.to_owned()), value);
        }
    }
    if let Some(floor) = &mut world.floor {
        floor.stiffness_n_m = contact_n_m;
        floor.damping_n_s_m = 12.0;
    }
    world.blocks = vec![upper, lower];
    note_pads(&world, &mut truth);
    (world, truth)
}

fn note_pads(world: &World, truth: &mut Truth) {
    for (name, value) in
        [("stiffness_N_m", world.pad.stiffness_n_m), ("shear_stiffness_N_m", world.pad.shear_stiffness_n_m)]
    {
        truth.insert(("pad".to_owned(), name.to_owned()), value);
    }
}

/// A crank of random size, weight and friction, with its truth.
pub fn crank_world(seed: u64) -> (World, Truth) {
    let mut rng = StdRng::seed_from_u64(seed.wrapping_mul(0xd134_2543_de82_ef95) ^ 0xc7a);
    let mut world = presets::crank();
    let mut draw = |low: f64, high: f64| rng.random_range(low..high);
    world.pad.stiffness_n_m = draw(1800.0, 4000.0);
    world.pad.shear_stiffness_n_m = draw(1500.0, 3000.0);
    let (weight, mu, viscous, coulomb, inertia) =
        (draw(0.1, 0.4), draw(0.03, 0.15), draw(0.4, 2.5), draw(0.02, 0.12), draw(0.03, 0.08));
    let mut truth = Truth::new();
    if let Some(crank) = &mut world.crank {
        crank.radius_m = draw(0.016, 0.025);
        crank.center_m.x += draw(-0.004, 0.004);
        crank.center_m.y += draw(-0.004, 0.004);
        crank.effects = vec![
            Effect::new(&Weight, &[weight]),
            Effect::new(&Inertia, &[inertia]),
            Effect::new(&LoadFriction, &[mu]),
            Effect::new(&ViscousFriction, &[viscous]),
            Effect::new(&CoulombFriction, &[coulomb]),
        ];
        for (name, value) in [
            ("weight_N", weight),
            ("friction_mu", mu),
            ("viscous_N_s_m", viscous),
            ("coulomb_N", coulomb),
            ("radius_m", crank.radius_m),
            ("handle_width_m", crank.handle_width_m),
            ("center_x_m", crank.center_m.x),
            ("center_y_m", crank.center_m.y),
            ("inertia_kg_m2", inertia * crank.radius_m.powi(2)),
        ] {
            truth.insert(("crank".to_owned(), name.to_owned()), value);
        }
    }
    note_pads(&world, &mut truth);
    (world, truth)
}
