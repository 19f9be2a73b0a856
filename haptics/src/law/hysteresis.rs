//! Presliding friction: F = Fc z, Fc dz/ds = σ (1 − z sgn(v)/g(v)) (Dahl 1968). With Fs > Fc and vs, g(v) = 1 + (Fs/Fc − 1)
//! exp(−(v/vs)²): LuGre with σ1 = 0 (Canudas de Wit et al. 1995; σ2 is the viscous law). With a shape β below 1 the way back
//! is stiffer by (2β − 1)|z|, not |z|: Bouc–Wen with n = 1 (Wen 1976); β = ½ unloads at σ, β = 1 (or 0, unset) is Dahl.
//! Fc ≥ 0, σ ≥ 0, ½ ≤ β ≤ 1: never generates energy. σ → ∞ is Coulomb friction. The memory is z, solved exactly over
//! each step.

use super::entry::{Entry, Kind, POSITIVE, ParameterSpec};
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role};
use super::memory::Memory;

/// Presliding hysteresis; equation and sign in the module's head.
#[derive(Clone, Copy, Debug)]
pub struct Hysteresis;

static ENTRY: Entry = Entry {
    id: "hysteresis",
    kind: Kind::Plant,
    title: "Presliding hysteresis",
    equation: "Fc z, dz/ds = (stiffness/Fc) (1 − z sgn(v))",
    what: "Friction that behaves like a spring before it slides: asperities bend over microns to tenths of \
           millimetres.",
    shows: "As rounded corners of the force at reversals and as elastic return after small pushes.",
    mimics: "Backlash mimics it at one load, a delay or a smoothing filter at one speed. Long strokes show its Coulomb \
             level only.",
    reveals: "Small strokes, reversals and a change of load reveal it.",
    parameters: &[
        ParameterSpec::nonlinear("Fc", "N", "N m", POSITIVE),
        ParameterSpec::nonlinear("stiffness", "N/m", "N m/rad", POSITIVE),
        ParameterSpec::nonlinear("shape", "1", "1", (0.0, 1.0)),
        ParameterSpec::nonlinear("dFs", "N", "N m", POSITIVE),
        ParameterSpec::nonlinear("vs", "m/s", "rad/s", POSITIVE),
    ],
};

/// Level of z while sliding: Fs(v)/Fc.
fn peak(motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
    if parameters[3] > 0.0 && parameters[0] > 0.0 {
        (1.0 + parameters[3] / parameters[0] * super::stribeck::falling(motion.velocity, parameters[4])).min(1e6)
    } else {
        1.0
    }
}

/// 2β − 1, in 0 … 1.
fn unloading(parameters: &[f64; MAX_PARAMETERS]) -> f64 {
    if parameters[2] > 0.0 { (2.0 * parameters[2] - 1.0).clamp(0.0, 1.0) } else { 1.0 }
}

impl Law for Hysteresis {
    fn entry(&self) -> &'static Entry {
        &ENTRY
    }

    fn role(&self) -> Role {
        Role::Presliding
    }

    fn remembers(&self) -> bool {
        true
    }

    fn force(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        parameters[0].max(0.0) * peak(motion, parameters) * motion.direction
    }

    fn force_with(&self, _motion: &Motion, parameters: &[f64; MAX_PARAMETERS], memory: &Memory) -> f64 {
        parameters[0].max(0.0) * memory[0]
    }

    fn stiffness(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS], memory: &Memory) -> f64 {
        let bent = memory[0] * motion.direction / peak(motion, parameters);
        let slope = if bent >= 0.0 { 1.0 - bent } else { 1.0 - unloading(parameters) * bent };
        parameters[1] * slope.max(0.0)
    }

    fn advance(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS], memory: &mut Memory, dt_s: f64) {
        let way = motion.velocity * dt_s;
        let (peak, back) = (peak(motion, parameters), unloading(parameters));
        // In units of Fc/σ, along the way: bent < 0 unloads first.
        let mut left =
            if way == 0.0 { 0.0 } else { way.abs() * parameters[1].max(0.0) / parameters[0].max(f64::MIN_POSITIVE) };
        let mut bent = memory[0] * way.signum();
        if bent < 0.0 {
            let curve = back / peak;
            let straight = curve < 1e-9;
            let to_zero = if straight { -bent } else { (-curve * bent).ln_1p() / curve };
            if left < to_zero {
                bent =
                    if straight { bent + left } else { (1.0 - (1.0 - curve * bent) * (-curve * left).exp()) / curve };
                left = 0.0;
            } else {
                (bent, left) = (0.0, left - to_zero);
            }
        }
        if left > 0.0 {
            bent = peak - (peak - bent) * (-left / peak).exp();
        }
        if bent.is_finite() {
            memory[0] = bent * way.signum();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Effect, Inertia, Memories, ViscousFriction, step_coordinate_with};
    use super::*;

    fn moved(values: &[f64; MAX_PARAMETERS], memory: &mut Memory, way_m: f64) -> f64 {
        let motion = Motion { velocity: way_m, ..Motion::default() };
        Hysteresis.advance(&motion, values, memory, 1.0);
        Hysteresis.force_with(&motion, values, memory)
    }

    #[test]
    fn one_effect() {
        // Dahl after 1 mm from rest: Fc (1 − exp(−σ x/Fc)) = 2 (1 − 1/e) N with σ = 2000 N/m, in one step or in a thousand.
        let values = [2.0, 2000.0, 0.0, 0.0, 0.0];
        let expected = 2.0 * (1.0 - (-1.0_f64).exp());
        assert!((moved(&values, &mut [0.0; 2], 1e-3) - expected).abs() < 1e-12);
        let mut memory = [0.0; 2];
        for _ in 0..1000 {
            moved(&values, &mut memory, 1e-6);
        }
        assert!((2.0 * memory[0] - expected).abs() < 1e-9);
        // Back from there: (1 + z) exp(−x/l) = 1, so the force is zero after l ln(1 + z), l = 1 mm.
        assert!(moved(&values, &mut memory, -1e-3 * (2.0 - (-1.0_f64).exp()).ln()).abs() < 1e-9);
    }

    #[test]
    fn options() {
        // Bouc–Wen with β = ½ unloads along a straight line of slope σ: from 1.2 N, 0.1 mm back are 0.2 N less.
        let mut memory = [0.6, 0.0];
        assert!((moved(&[2.0, 2000.0, 0.5, 0.0, 0.0], &mut memory, -1e-4) - 1.0).abs() < 1e-12);
        // LuGre sliding slowly carries Fs = Fc + dFs.
        let creeping = moved(&[2.0, 2000.0, 0.0, 0.5, 1e9], &mut [0.0; 2], 1.0);
        assert!((creeping - 2.5).abs() < 1e-9);
    }

    #[test]
    fn presliding_returns_and_no_energy_is_made() {
        // 0.1 kg at rest, pulled with 1 % of Fc and let go: it comes back to l ln(1/(1 − 0.01²)) = 1e-4 l (l = 1 mm).
        let effects = [
            Effect::new(&Inertia, &[0.1]),
            Effect::new(&Hysteresis, &[2.0, 2000.0]),
            Effect::new(&ViscousFriction, &[20.0]),
        ];
        let (mut motion, mut memories) = (Motion::default(), Memories::default());
        for tick in 0..6000 {
            let drive = if tick < 3000 { 0.02 } else { 0.0 };
            (motion.position, motion.velocity) =
                step_coordinate_with(&effects, &motion, &mut memories, drive, 0.0, 1e-3);
        }
        assert!((motion.position - 1e-7).abs() < 2e-8, "{}", motion.position);
        // Thrown at 0.1 m/s it stops; kinetic plus stored energy ½ (Fc z)²/σ never rises.
        let (mut motion, mut memories) = (Motion { velocity: 0.1, ..Motion::default() }, Memories::default());
        let mut least = f64::MAX;
        for _ in 0..2000 {
            (motion.position, motion.velocity) =
                step_coordinate_with(&effects[..2], &motion, &mut memories, 0.0, 0.0, 1e-3);
            let energy = 0.05 * motion.velocity.powi(2) + 0.5 * (2.0 * memories.get(1)[0]).powi(2) / 2000.0;
            assert!(energy <= least * (1.0 + 1e-12), "{energy} after {least}");
            least = energy;
        }
        assert!(motion.velocity.abs() < 1e-6);
    }
}
