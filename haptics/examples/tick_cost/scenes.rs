//! The scenes that are timed: a world and one period of the fingers' path, tick by tick.

use haptics::Vec2;
use haptics::world::{Block, Floor, Input, State, World, presets};
use std::f64::consts::{FRAC_PI_2, TAU};

/// How far each pad is pressed in, m: 1 N at 2500 N/m, as firmly as people hold such blocks.
const SQUEEZE_M: f64 = 4e-4;

/// A world and what the fingers do in it. Every run starts from the state after the warm-up.
pub struct Scene {
    /// Short name, the same in `benches/peers.py`.
    pub name: &'static str,
    /// What is timed, in words.
    pub timed: &'static str,
    /// The world.
    pub world: World,
    /// Tick length, s.
    pub dt_s: f64,
    /// Times that the path is run before the timed state is kept.
    pub warm_up_periods: u32,
    /// One period of the fingers' path: one input a tick.
    pub path: Vec<Input>,
}

impl Scene {
    /// The state after the warm-up.
    pub fn start(&self) -> State {
        let mut state = State::new(&self.world, self.path.last().map_or([Vec2::zeros(); 2], |i| i.tip_in_world));
        for _ in 0..self.warm_up_periods {
            for input in &self.path {
                haptics::world::step(&self.world, &mut state, input, self.dt_s);
            }
        }
        state
    }
}

/// All timed scenes.
pub fn all() -> Vec<Scene> {
    let mut scenes = vec![held_block(1e-3, "pinch"), held_block(1e-4, "pinch-fine"), lifted_block()];
    scenes.extend([turned_crank("crank", 0.0), turned_crank("crank-turn", TAU)]);
    scenes.push(towers());
    scenes
}

/// A path of `ticks` from where the tips are at each instant (0 to 1 of the period); velocities by differences, as a device
/// reports them.
fn path(ticks: u32, dt_s: f64, tips: impl Fn(f64) -> [Vec2; 2]) -> Vec<Input> {
    let at = |tick: u32| tips(f64::from(tick) / f64::from(ticks));
    (1..=ticks)
        .map(|tick| {
            let (now, before) = (at(tick), at(tick - 1));
            Input { tip_in_world: now, tip_velocity: [0, 1].map(|f| (now[f] - before[f]) / dt_s) }
        })
        .collect()
}

/// Both tips at `half_m` to the sides of `center_m`.
fn around(center_m: Vec2, half_m: f64) -> [Vec2; 2] {
    [center_m - Vec2::new(half_m, 0.0), center_m + Vec2::new(half_m, 0.0)]
}

/// The upper block is pinched where it stands; the fingers move it 0.1 mm to and fro.
fn held_block(dt_s: f64, name: &'static str) -> Scene {
    let world = presets::stacking();
    let (upper_m, half_m) = (world.blocks[0].start.center_m, 0.5 * world.blocks[0].width_m - SQUEEZE_M);
    let tips = move |u: f64| around(upper_m + Vec2::new(1e-4 * (TAU * u).sin(), 0.0), half_m);
    let timed = "upper of two blocks pinched where it stands, moved 0.1 mm to and fro";
    Scene { name, timed, world, dt_s, warm_up_periods: 4, path: path(2_500, dt_s, tips) }
}

/// The minimum-jerk course from 0 to 1 (Flash & Hogan 1985), between `from` and `to`.
fn reach(u: f64, from: f64, to: f64) -> f64 {
    let s = ((u - from) / (to - from)).clamp(0.0, 1.0);
    s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)
}

/// A person's cycle of 2.5 s: close, lift by 15 mm with a tremor of 8.8 Hz, lower, open.
fn lifted_block() -> Scene {
    const LIFT_M: f64 = 0.015;
    const GAP_M: f64 = 0.004;
    let world = presets::stacking();
    let (upper_m, half_m) = (world.blocks[0].start.center_m, 0.5 * world.blocks[0].width_m);
    let tips = move |u: f64| {
        let closed = reach(u, 0.1, 0.25) - reach(u, 0.78, 0.9);
        let lifted = reach(u, 0.28, 0.45) - reach(u, 0.55, 0.74);
        let tremor = 5e-5 * (22.0 * TAU * u).sin() * closed;
        let half = half_m + GAP_M * (1.0 - closed) - SQUEEZE_M * closed + tremor;
        around(upper_m + Vec2::new(0.5 * tremor, LIFT_M * lifted + tremor), half)
    };
    let timed = "person's cycle: close, lift the upper block 15 mm with tremor, lower it onto the other, open";
    Scene { name: "lift", timed, world, dt_s: 1e-3, warm_up_periods: 1, path: path(2_500, 1e-3, tips) }
}

/// The crank's handle between both pads, carried round by `turn_rad` a period of 2.5 s, or (zero) moved 0.1 mm to and fro.
fn turned_crank(name: &'static str, turn_rad: f64) -> Scene {
    let world = presets::crank();
    let (center_m, radius_m, width_m) =
        world.crank.as_ref().map_or((Vec2::zeros(), 0.0, 0.0), |c| (c.center_m, c.radius_m, c.handle_width_m));
    let tips = move |u: f64| {
        let angle = -FRAC_PI_2 + turn_rad * u;
        let wobble = if turn_rad == 0.0 { 1e-4 * (TAU * u).sin() } else { 0.0 };
        let handle_m = center_m + radius_m * Vec2::new(angle.cos(), angle.sin());
        around(handle_m + Vec2::new(wobble, 0.0), 0.5 * width_m - 5e-4)
    };
    let timed = if turn_rad == 0.0 {
        "handle held by both pads, moved 0.1 mm to and fro"
    } else {
        "handle held by both pads, carried round once in 2.5 s"
    };
    Scene { name, timed, world, dt_s: 1e-3, warm_up_periods: 4, path: path(2_500, 1e-3, tips) }
}

/// Thirty blocks at rest in six towers of five; the fingers are away.
fn towers() -> Scene {
    let mut world = World::empty("Thirty stacked blocks");
    world.floor = Some(Floor { height_m: 0.0, ..Floor::default() });
    world.blocks = (0..30_u8)
        .map(|i| {
            let (tower, storey) = (f64::from(i / 5), f64::from(i % 5));
            Block::upright(&format!("block-{}", i + 1), 0.04, 0.02, 0.015, 0.03 * (tower - 2.5), 0.015 * storey)
        })
        .collect();
    let away = path(500, 1e-3, |_| around(Vec2::new(0.0, 0.2), 0.02));
    let timed = "thirty blocks at rest in six towers of five, the fingers away";
    Scene { name: "towers", timed, world, dt_s: 1e-3, warm_up_periods: 6, path: away }
}

/// The grip that is watched for creep: 0.2 kg, friction 0.9, 2.4 N pinch, in the air.
pub fn grip(dt_s: f64) -> Scene {
    let mut world = World::empty("Grip");
    world.floor = None;
    let mut block = Block::upright("block-1", 0.2, 0.03, 0.03, 0.0, 0.0);
    block.finger_friction = 0.9;
    block.start.center_m = Vec2::zeros();
    world.blocks = vec![block];
    let half_m = 0.015 - 2.4 / world.pad.stiffness_n_m;
    let tips = path(1, dt_s, |_| around(Vec2::zeros(), half_m));
    Scene { name: "grip", timed: "0.2 kg held by 2.4 N in the air", world, dt_s, warm_up_periods: 0, path: tips }
}
