//! One coordinate under a list of effects: their sum, the force for a given motion, and the integrator.

use super::effect::Effect;
use super::force_law::{Motion, Role, tame};
use super::memory::Memories;

/// The forces of a list of effects on one coordinate, split the way an integrator needs them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resistance {
    /// Everything that acts whether or not the coordinate moves, N or N m.
    pub smooth: f64,
    /// Dry friction level, N or N m, ≥ 0: opposes motion and holds at rest.
    pub dry: f64,
    /// Inertia that belongs to the coordinate itself, kg or kg m².
    pub inertia: f64,
    /// Slope of the viscous laws over the speed, N s/m or N m s/rad, ≥ 0: taken implicitly by the integrator, so that no damper,
    /// however strong, turns a motion round within a step.
    pub damping: f64,
    /// Slope of the stiff laws towards `motion.direction`, N/m or N m/rad, ≥ 0: taken implicitly by the integrator.
    pub stiffness: f64,
}

/// Sums `effects` for a coordinate that moves, or is about to move, towards `motion.direction`; laws with memory count as
/// developed (presliding as dry friction, gaps as closed).
///
/// Called by the servo at every tick: no allocation.
pub fn resistance(effects: &[Effect], motion: &Motion) -> Resistance {
    sum(effects, motion, None, true)
}

/// Sums `effects` with their memories.
pub fn resistance_with(effects: &[Effect], motion: &Motion, memories: &Memories) -> Resistance {
    sum(effects, motion, Some(memories), true)
}

/// Steepest slope over the position of the explicitly integrated laws, N/m or N m/rad, over positions from −`reach` to
/// `reach`: the step must be able to follow it.
pub fn explicit_stiffness(effects: &[Effect], reach: f64) -> f64 {
    const PLACES: i32 = 8;
    let step = 1e-4 * reach;
    let explicit = effects.iter().filter(|e| e.enabled && matches!(e.role(), Role::Smooth | Role::Stiff));
    explicit
        .map(|effect| {
            let at = |position: f64| effect.force(&Motion { position, ..Motion::default() });
            let slope = |place: i32| {
                let q = reach * f64::from(place) / f64::from(PLACES);
                let motion = Motion { position: q, ..Motion::default() };
                let taken = effect.law().stiffness(&motion, &effect.values, &super::memory::BLANK);
                ((at(q + step) - at(q - step)) / (2.0 * step) - taken).abs()
            };
            (-PLACES..=PLACES).map(slope).fold(0.0, f64::max)
        })
        .sum()
}

/// Sum of the inertia effects, kg or kg m².
pub fn inertia(effects: &[Effect]) -> f64 {
    effects.iter().filter(|e| e.enabled && e.role() == Role::Inertia).map(|e| e.values[0]).sum()
}

/// `smooth` false leaves out what does not depend on the direction: the second half of a step needs the rest only.
#[inline]
fn sum(effects: &[Effect], motion: &Motion, memories: Option<&Memories>, smooth: bool) -> Resistance {
    let mut total = Resistance::default();
    // Terms behind a gap: resistance to motion, apart from forces that act anyway.
    let (mut viscous, mut damping, mut gate) = (0.0, 0.0, 1.0_f64);
    for (index, effect) in effects.iter().enumerate().filter(|(_, e)| e.enabled) {
        match effect.role() {
            Role::Inertia => total.inertia += effect.values[0],
            Role::Gravity | Role::Smooth if smooth => total.smooth += effect.force(motion),
            Role::Viscous if smooth => {
                let force = effect.force(motion);
                viscous += force;
                // The slope from rest to here: exact for c v, and the safe one for a law that rises faster.
                damping += if motion.velocity == 0.0 { 0.0 } else { (force / motion.velocity).max(0.0) };
            }
            Role::Gravity | Role::Smooth | Role::Viscous => {}
            Role::Stiff => {
                total.smooth += effect.force(motion);
                total.stiffness += tame(effect.law().stiffness(motion, &effect.values, &super::memory::BLANK)).max(0.0);
            }
            // The term is along the direction of motion; its level opposes it.
            Role::Dry => {
                total.dry += match memories {
                    Some(memories) => effect.force_with(motion, memories.get(index)),
                    None => effect.force(motion),
                } * motion.direction;
            }
            Role::Presliding => match memories {
                Some(memories) => {
                    let memory = memories.get(index);
                    viscous += effect.force_with(motion, memory);
                    total.stiffness += tame(effect.law().stiffness(motion, &effect.values, memory)).max(0.0);
                }
                None => total.dry += effect.force(motion) * motion.direction,
            },
            Role::Gap => {
                if let Some(memories) = memories {
                    gate *= effect.law().engaged(motion, &effect.values, memories.get(index));
                }
            }
        }
    }
    total.smooth += gate * viscous;
    total.damping += gate * damping;
    total.dry = gate * total.dry.max(0.0);
    total
}

/// Total drive force for a given motion, N or N m: the prediction of a replay. Laws with memory count as developed; see
/// [`drive_force_with`].
pub fn drive_force(effects: &[Effect], motion: &Motion) -> f64 {
    effects.iter().map(|effect| effect.force(motion)).sum()
}

/// Total drive force for a given motion, N or N m, with the laws' memories. Call [`advance`] between samples.
pub fn drive_force_with(effects: &[Effect], motion: &Motion, memories: &Memories) -> f64 {
    let (mut free, mut behind, mut gate) = (0.0, 0.0, 1.0_f64);
    for (index, effect) in effects.iter().enumerate().filter(|(_, e)| e.enabled) {
        let memory = memories.get(index);
        match effect.role() {
            Role::Gap => gate *= effect.law().engaged(motion, &effect.values, memory),
            Role::Dry | Role::Viscous | Role::Presliding => behind += effect.force_with(motion, memory),
            _ => free += effect.force_with(motion, memory),
        }
    }
    free + gate * behind
}

/// Moves the laws' memories over `dt_s` of a motion at `motion.velocity`.
pub fn advance(effects: &[Effect], motion: &Motion, memories: &mut Memories, dt_s: f64) {
    for (index, effect) in effects.iter().enumerate().filter(|(_, e)| e.enabled) {
        if let (true, Some(memory)) = (effect.remembers(), memories.get_mut(index)) {
            effect.law().advance(motion, &effect.values, memory, dt_s);
        }
    }
}

/// Total drive force along a motion that is given sample by sample, N or N m, with the laws' memories of the samples
/// before: the prediction of a replay. The first sample finds every law at rest.
pub fn drive_forces(effects: &[Effect], motions: &[Motion]) -> Vec<f64> {
    let mut memories = Memories::default();
    let mut before: Option<&Motion> = None;
    let mut forces = Vec::with_capacity(motions.len());
    for motion in motions {
        if let Some(before) = before {
            // Memories follow the way that was gone, whatever velocity was measured.
            let dt_s = (motion.time_s - before.time_s).max(1e-9);
            let velocity = (motion.position - before.position) / dt_s;
            advance(effects, &Motion { velocity, ..*motion }, &mut memories, dt_s);
        }
        forces.push(drive_force_with(effects, motion, &memories));
        before = Some(motion);
    }
    forces
}

/// Advances one coordinate by `dt_s` under `drive` (N or N m): semi-implicit Euler with dry friction solved exactly, so that
/// a coordinate at rest stays at rest until the drive exceeds the friction level. Laws with memory count as developed.
///
/// Returns the new (position, velocity). `extra_inertia` is mass that other bodies add, kg or kg m²; the total must be > 0.
pub fn step_coordinate(effects: &[Effect], motion: &Motion, drive: f64, extra_inertia: f64, dt_s: f64) -> (f64, f64) {
    solve(effects, motion, None, drive, extra_inertia, dt_s)
}

/// [`step_coordinate`] with laws that remember; their memories are moved along.
pub fn step_coordinate_with(
    effects: &[Effect],
    motion: &Motion,
    memories: &mut Memories,
    drive: f64,
    extra_inertia: f64,
    dt_s: f64,
) -> (f64, f64) {
    let (position, velocity) = solve(effects, motion, Some(memories), drive, extra_inertia, dt_s);
    advance(effects, &Motion { velocity, ..*motion }, memories, dt_s);
    (position, velocity)
}

/// Inertia is at least this, kg or kg m²: a world without any is refused by its check.
const LEAST_INERTIA: f64 = 1e-9;

fn solve(
    effects: &[Effect],
    motion: &Motion,
    memories: Option<&Memories>,
    drive: f64,
    extra_inertia: f64,
    dt_s: f64,
) -> (f64, f64) {
    // First without dry friction: which way does it want to go?
    let mut probe = Motion { direction: motion.velocity.signum(), ..*motion };
    let all = sum(effects, &probe, memories, true);
    let inertia = (all.inertia + extra_inertia).max(LEAST_INERTIA);
    // m v' = m v + (drive − F − c v' − K v' dt − dry) dt: dampers and stiff laws are met where the step ends, so that they
    // neither ring nor overshoot.
    let braked = inertia + all.damping * dt_s;
    let push = inertia * motion.velocity + (drive - all.smooth + all.damping * motion.velocity) * dt_s;
    // Most ticks go on the way they went: only a turn asks the laws again.
    let ahead = if push.signum() == probe.direction {
        all
    } else {
        probe.direction = push.signum();
        sum(effects, &probe, memories, false)
    };
    let brake = ahead.dry * dt_s;
    let velocity = if push.abs() <= brake {
        0.0
    } else {
        (push - brake * push.signum()) / (braked + ahead.stiffness * dt_s * dt_s)
    };
    let position = motion.position + velocity * dt_s;
    if position.is_finite() && velocity.is_finite() { (position, velocity) } else { (motion.position, 0.0) }
}

#[cfg(test)]
mod tests {
    use super::super::{CoulombFriction, Hysteresis, Inertia};
    use super::*;

    #[test]
    fn a_replay_remembers_presliding_and_agrees_with_the_integrator() {
        // Pushed 0.1 mm into presliding of 0.4 N and 800 N/m (0.5 mm long) the level is 0.4 (1 − exp(−0.2)) N; there and
        // back it is not at zero.
        let effects = [Effect::new(&Hysteresis, &[0.4, 800.0])];
        let there = (0..=1000).map(|i| f64::from(i) * 1e-7);
        let back = (0..=1000).map(|i| 1e-4 - f64::from(i) * 1e-7);
        let motions: Vec<Motion> = there
            .chain(back)
            .enumerate()
            .map(|(i, position)| Motion { time_s: i as f64 * 1e-3, position, velocity: 1e-4, ..Motion::default() })
            .collect();
        let forces = drive_forces(&effects, &motions);
        assert!((forces[1000] / (0.4 * (1.0 - (-0.2_f64).exp())) - 1.0).abs() < 1e-2, "{}", forces[1000]);
        assert!(forces[2001] < -1e-3, "there and back it has turned round: {}", forces[2001]);
        assert_eq!(forces[0], 0.0);
    }

    #[test]
    fn dry_friction_holds_at_rest_and_stops_without_reversal() {
        let effects = [Effect::new(&Inertia, &[2.0]), Effect::new(&CoulombFriction, &[1.0])];
        let rest = Motion::default();
        assert_eq!(step_coordinate(&effects, &rest, 0.99, 0.0, 1e-3), (0.0, 0.0));
        let (_, v) = step_coordinate(&effects, &rest, -1.5, 0.0, 1e-3);
        assert!((v + 0.5 / 2.0 * 1e-3).abs() < 1e-15, "only the excess over Fc accelerates: {v}");
        let slow = Motion { velocity: 1e-5, ..rest };
        assert_eq!(step_coordinate(&effects, &slow, 0.0, 0.0, 1e-3).1, 0.0);
    }

    #[test]
    fn coulomb_spin_down_takes_m_v_over_fc() {
        // 2 kg at 0.5 m/s against 1 N stops after exactly 1 s and 0.25 m.
        let effects = [Effect::new(&Inertia, &[2.0]), Effect::new(&CoulombFriction, &[1.0])];
        let mut motion = Motion { velocity: 0.5, ..Motion::default() };
        let mut ticks = 0;
        while motion.velocity != 0.0 {
            (motion.position, motion.velocity) = step_coordinate(&effects, &motion, 0.0, 0.0, 1e-4);
            ticks += 1;
        }
        assert!((f64::from(ticks) * 1e-4 - 1.0).abs() < 2e-4);
        // Semi-implicit Euler is first order: error below v dt.
        assert!((motion.position - 0.25).abs() < 0.5 * 1e-4);
    }
}
