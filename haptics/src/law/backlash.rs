//! Backlash: nothing behind the gap is felt within a gap of 2δ after each reversal. The friction, drag and presliding
//! of the list are multiplied by e = 0, then by e = 1 (play operator, Krasnosel’skii & Pokrovskii 1983). δ ≥ 0; δ = 0
//! is no gap. Inertia, gravity and springs stay on the handle's side, so that a gap can only take less energy, never
//! make any. The memory is the place within the gap, −δ … δ; it starts in the middle.

use super::entry::{Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};
use super::memory::Memory;

/// Backlash; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct Backlash;

static ENTRY: Entry = Entry {
    id: "backlash",
    kind: Kind::Plant,
    title: "Backlash",
    equation: "−(1 − e) F of the friction, e = 0 within 2δ of a reversal",
    what: "Play between the handle and what it moves.",
    shows: "As no resistance over a fixed distance after each reversal.",
    mimics: "Presliding hysteresis mimics it (its corner is rounded and grows with the load; a gap's is sharp and does \
             not), a delay at one speed. Without reversals it is not seen at all.",
    reveals: "Reversals at different speeds and loads reveal it.",
    parameters: &[ParameterSpec::nonlinear("delta", "m", "rad", POSITIVE)],
};

impl Law for Backlash {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Gap
    }

    fn remembers(&self) -> bool {
        true
    }

    fn force(&self, _motion: &Motion, _parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        0.0
    }

    fn engaged(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS], memory: &Memory) -> f64 {
        const TOUCHES: f64 = 1.0 - 1e-9;
        f64::from(memory[0] * motion.direction.signum() >= TOUCHES * parameters[0])
    }

    fn advance(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS], memory: &mut Memory, dt_s: f64) {
        let half = parameters[0].max(0.0);
        memory[0] = (memory[0] + motion.velocity * dt_s).max(-half).min(half);
    }
}

#[cfg(test)]
mod tests {
    use super::super::{CoulombFriction, Effect, Inertia, Memories, advance, drive_force_with, step_coordinate_with};
    use super::*;

    #[test]
    fn one_effect() {
        // Coulomb 2 N behind a gap of 2δ = 2 mm, moved in steps of 0.1 mm: 1 mm free from the middle, then 2 N; after the
        // reversal 2 mm free, then −2 N.
        let effects = [Effect::new(&CoulombFriction, &[2.0]), Effect::new(&Backlash, &[1e-3])];
        let mut memories = Memories::default();
        let mut forces = Vec::new();
        for tick in 0..60 {
            let direction = if tick < 20 { 1.0 } else { -1.0 };
            let motion = Motion { velocity: 0.1 * direction, direction, ..Motion::default() };
            forces.push(drive_force_with(&effects, &motion, &memories));
            advance(&effects, &motion, &mut memories, 1e-3);
        }
        assert!(forces[..10].iter().all(|f| *f == 0.0) && forces[10..20].iter().all(|f| *f == 2.0), "{forces:?}");
        assert!(forces[20..40].iter().all(|f| *f == 0.0) && forces[40..].iter().all(|f| *f == -2.0), "{forces:?}");
    }

    #[test]
    fn a_push_back_runs_through_the_gap_and_is_held_behind_it() {
        let effects =
            [Effect::new(&Inertia, &[0.1]), Effect::new(&CoulombFriction, &[2.0]), Effect::new(&Backlash, &[1e-3])];
        let mut memories = Memories::default();
        let mut motion = Motion::default();
        for _ in 0..2000 {
            (motion.position, motion.velocity) =
                step_coordinate_with(&effects, &motion, &mut memories, -1.0, 0.0, 1e-4);
        }
        // 1 N over 1 mm of play, then 1 N more than that against it: stops after 2 mm and holds.
        assert_eq!(motion.velocity, 0.0);
        assert!((motion.position + 2e-3).abs() < 3e-5, "{}", motion.position);
    }
}
