//! One window, stepped.

use super::windows::Errors;
use haptics::device::HandImpedance;
use haptics::law::{Effect, Memories, Motion, advance, inertia, step_coordinate_with};

/// Longest integration step of a coordinate with its own inertia, s.
/// Choice: halved or doubled, none of 2 answers changes.
const INTEGRATION_STEP_S: f64 = 1e-3;
/// Longest integration step of a coordinate that a hand holds, s.
/// Choice: halved or doubled, none of 48 answers changes.
const HELD_STEP_S: f64 = 2.5e-4;
/// Mass of the fingertips that move a handle without inertia, kg.
/// Derived: with the damping of the hand (9 N s/m) its time constant is 0.56 ms, over twice the step of 0.25 ms.
const TIP_KG: f64 = 5e-3;

/// A moment of a window.
#[derive(Clone, Copy, Debug, Default)]
pub struct Moment {
    pub motion: Motion,
    /// Measured force less the assumed sensor faults, N or N m.
    pub drive: f64,
    /// Other measured quantities that the laws depend on.
    pub beside: [f64; 2],
}

/// Force against the motion from other terms than laws of the catalogue, as a function of the motion and of the other
/// quantities measured then.
pub type Acts<'a> = dyn FnMut(&Motion, [f64; 2]) -> f64 + 'a;

/// One side of a comparison.
pub struct Side<'a> {
    pub effects: &'a [Effect],
    /// Memory of the laws at the first moment.
    pub memory: Memories,
    pub acts: &'a mut Acts<'a>,
    /// True if the measured force alone drives it; otherwise a simulated hand holds it.
    pub driven: bool,
}

/// Follows the measured motion from one row to the next.
pub fn follow(effects: &[Effect], [before, now]: [&Motion; 2], memory: &mut Memories) {
    let step_s = (now.time_s - before.time_s).max(1e-9);
    let velocity = (now.position - before.position) / step_s;
    advance(effects, &Motion { velocity, ..*now }, memory, step_s);
}

/// Memory of the laws after a measured motion.
pub fn remembered(effects: &[Effect], past: &[Motion]) -> Memories {
    let mut memory = Memories::default();
    past.windows(2).for_each(|pair| follow(effects, [&pair[0], &pair[1]], &mut memory));
    memory
}

/// Errors over a window of rows. `row`: measured motion and driving force of a row.
pub fn over(window: &[usize], row: &dyn Fn(usize) -> (Motion, f64), side: Side<'_>) -> Errors {
    let moment = |i: &usize| {
        let (motion, drive) = row(*i);
        Moment { motion, drive, ..Moment::default() }
    };
    run(&window.iter().map(moment).collect::<Vec<Moment>>(), side)
}

/// Sum of squared errors over a window, and their number: of the position, or of the force of the hand.
pub fn run(moments: &[Moment], side: Side<'_>) -> Errors {
    let Side { effects, mut memory, acts, driven } = side;
    let Some(Moment { motion: first, .. }) = moments.first() else { return (0.0, 0.0) };
    let (mut position, mut velocity) = (first.position, first.velocity);
    let hand = HandImpedance::default();
    let extra = if driven { 0.0 } else { (TIP_KG - inertia(effects)).max(0.0) };
    let (mut sum, mut count) = (0.0, 0.0);
    for pair in moments.windows(2) {
        let (from, to) = (&pair[0].motion, &pair[1].motion);
        let span_s = (to.time_s - from.time_s).max(1e-9);
        let step_s = if driven { INTEGRATION_STEP_S } else { HELD_STEP_S };
        // A window is shorter than four seconds. A clock with a wrong unit would ask for work by its seconds.
        let parts = (span_s.min(4.0) / step_s).ceil().max(1.0);
        let mut held_n = 0.0;
        for part in 0..parts as usize {
            let x = (part as f64 + 0.5) / parts;
            let between = |a: f64, b: f64| a + x * (b - a);
            if !driven {
                let (wanted, speed) = (between(from.position, to.position), between(from.velocity, to.velocity));
                held_n = hand.stiffness_n_m * (wanted - position) + hand.damping_n_s_m * (speed - velocity);
            }
            let motion = Motion {
                time_s: between(from.time_s, to.time_s),
                position,
                velocity,
                acceleration: 0.0,
                direction: velocity.signum(),
                normal_force_n: between(from.normal_force_n, to.normal_force_n),
                up_along: between(from.up_along, to.up_along),
            };
            let beside = [0, 1].map(|k| between(pair[0].beside[k], pair[1].beside[k]));
            let drive = between(pair[0].drive, pair[1].drive) + held_n - acts(&motion, beside);
            (position, velocity) = step_coordinate_with(effects, &motion, &mut memory, drive, extra, span_s / parts);
        }
        let error = if driven { position - to.position } else { held_n };
        sum += error * error;
        count += 1.0;
    }
    (sum, count)
}
