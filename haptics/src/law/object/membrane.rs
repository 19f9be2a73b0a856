//! An elastic sheet that a needle pushes in, pierces and is drawn out of: force over depth with a history (thesis, 5.3.2:
//! stiffness as a function of the deepest insertion so far; phases as in Okamura, Simone & O'Leary 2004: elastic before the
//! puncture, friction along the shaft after it).
//!
//! The first push before the puncture follows k1 x + k3 x³. Drawn back, the sheet keeps a dent of `give` times the
//! deepest insertion. It unloads, and loads again up to there, on a steeper line: the energy between the lines is lost.
//! At `puncture_n` the needle goes through. From then on the hole only drags along the shaft, elastically up to
//! `friction_n`, and with `drag_n_s_m` of the speed. x is the insertion beyond the undisturbed surface, m; the force
//! pushes the needle out.

use serde::{Deserialize, Serialize};

/// Parameters of a sheet.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MembraneLaw {
    /// First stiffness, N/m, positive.
    pub stiffness_n_m: f64,
    /// Hardening, N/m³, ≥ 0.
    #[serde(default)]
    pub cubic_n_m3: f64,
    /// Share of the deepest insertion that stays as a dent, 0 … 0.9.
    #[serde(default)]
    pub give: f64,
    /// Force at which the needle goes through, N, positive.
    pub puncture_n: f64,
    /// Friction of the hole along the shaft, N, ≥ 0 and below the puncture force.
    pub friction_n: f64,
    /// Viscous part of the same, N s/m, ≥ 0.
    #[serde(default)]
    pub drag_n_s_m: f64,
}

/// Memory of one place of a sheet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MembraneHistory {
    /// Deepest insertion so far, m.
    pub deepest_m: f64,
    /// True if the needle has gone through here.
    pub punctured: bool,
    /// Place along the shaft at which the rim of the hole would be without force, as an insertion, m.
    rim_m: f64,
    /// Farthest insertion since the way last turned round, m, and whether it goes outwards.
    turn_m: f64,
    outwards: bool,
}

/// The way has turned round when the needle has come back by this, m: more than the tremor of a hand at rest.
const TURN_M: f64 = 0.3e-3;

/// Phase of the needle's motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MembranePhase {
    /// Not touching.
    #[default]
    Free,
    /// Pushing the sheet in.
    Insertion,
    /// Through it.
    Penetration,
    /// On the way out.
    Extraction,
}

impl MembraneLaw {
    /// Force of the first push at an insertion, N.
    pub fn loading_n(&self, insertion_m: f64) -> f64 {
        let x = insertion_m.max(0.0);
        (self.stiffness_n_m + self.cubic_n_m3 * x * x) * x
    }

    /// Force that pushes the needle out, N, at an insertion, m, and its rate, m/s (positive: going in). It moves the
    /// memory of the place along.
    pub fn force_n(&self, insertion_m: f64, rate_m_s: f64, history: &mut MembraneHistory) -> f64 {
        if insertion_m <= 0.0 {
            // Out of it: a hole closes around nothing, a dent remains.
            history.rim_m = 0.0;
            return 0.0;
        }
        if !history.punctured {
            let force = self.elastic_n(insertion_m, history.deepest_m);
            history.deepest_m = history.deepest_m.max(insertion_m);
            if force < self.puncture_n {
                return force;
            }
            history.punctured = true;
            // The sheet springs back along the shaft until friction holds it.
            history.rim_m = insertion_m - self.friction_n / self.stiffness_n_m;
        }
        history.deepest_m = history.deepest_m.max(insertion_m);
        let give_m = self.friction_n / self.stiffness_n_m;
        let stretch = (insertion_m - history.rim_m).clamp(-give_m, give_m);
        history.rim_m = insertion_m - stretch;
        // The drag of a rim that holds nothing yet is none: it grows with the stretch.
        self.stiffness_n_m * stretch + self.drag_n_s_m * rate_m_s
    }

    /// Slope of the force at an insertion, N/m: an integrator must be able to follow it.
    pub fn stiffness_n_m(&self, insertion_m: f64) -> f64 {
        let x = insertion_m.max(0.0);
        (self.stiffness_n_m + 3.0 * self.cubic_n_m3 * x * x) / (1.0 - self.give.clamp(0.0, 0.9))
    }

    /// Insertion at which a sheet that was never touched is pierced, m.
    pub fn puncture_depth_m(&self) -> f64 {
        // k1 x + k3 x³ rises steadily: Newton from the linear answer, which is never too small, converges from above.
        let mut x = self.puncture_n / self.stiffness_n_m;
        for _ in 0..30 {
            x -= (self.loading_n(x) - self.puncture_n) / (self.stiffness_n_m + 3.0 * self.cubic_n_m3 * x * x);
        }
        x
    }

    /// The phase at an insertion, m. At rest the last phase lasts: the motion counts as reversed after the needle has
    /// come back by more than a hand trembles.
    pub fn phase(insertion_m: f64, history: &mut MembraneHistory) -> MembranePhase {
        if insertion_m <= 0.0 {
            (history.turn_m, history.outwards) = (0.0, false);
            return MembranePhase::Free;
        }
        let sign = if history.outwards { -1.0 } else { 1.0 };
        history.turn_m = sign * (sign * history.turn_m).max(sign * insertion_m);
        if sign * (history.turn_m - insertion_m) > TURN_M {
            (history.turn_m, history.outwards) = (insertion_m, !history.outwards);
        }
        match (history.outwards, history.punctured) {
            (true, _) => MembranePhase::Extraction,
            (false, false) => MembranePhase::Insertion,
            (false, true) => MembranePhase::Penetration,
        }
    }

    fn elastic_n(&self, insertion_m: f64, deepest_m: f64) -> f64 {
        unloading_n(insertion_m, deepest_m, self.give, |x| self.loading_n(x))
    }
}

/// Force of a sheet that was pushed in to `deepest_m`, N: that of the first push beyond it, and a straight line to the
/// dent above it, a share `give` of the deepest insertion. `loading_n`: force of the first push at an insertion, m.
pub fn unloading_n(insertion_m: f64, deepest_m: f64, give: f64, loading_n: impl Fn(f64) -> f64) -> f64 {
    if insertion_m >= deepest_m {
        return loading_n(insertion_m);
    }
    let dent_m = give.clamp(0.0, 0.9) * deepest_m;
    loading_n(deepest_m) * ((insertion_m - dent_m) / (deepest_m - dent_m)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use MembranePhase::{Extraction, Free, Insertion, Penetration};

    const CUP: MembraneLaw = MembraneLaw {
        stiffness_n_m: 300.0,
        cubic_n_m3: 0.0,
        give: 0.4,
        puncture_n: 1.5,
        friction_n: 0.3,
        drag_n_s_m: 2.0,
    };

    /// Moves slowly through `way`, in steps of a micrometre, and returns the last force and the work done on the sheet, J.
    fn push(law: &MembraneLaw, way: &[f64], history: &mut MembraneHistory) -> (f64, f64) {
        let (mut x, mut force, mut work) = (way[0], 0.0, 0.0);
        for end in &way[1..] {
            let steps = ((end - x).abs() / 1e-6).round() as usize;
            let step = (end - x) / steps.max(1) as f64;
            for _ in 0..steps {
                x += step;
                force = law.force_n(x, 0.0, history);
                work += force * step;
            }
        }
        (force, work)
    }

    #[test]
    fn pushes_back_drops_at_the_puncture_and_drags_on_the_way_out() {
        let mut history = MembraneHistory::default();
        // 300 N/m · 4 mm = 1.2 N; at 5 mm 1.5 N it goes through and only 0.3 N of friction are left.
        assert!((push(&CUP, &[0.0, 4e-3], &mut history).0 - 1.2).abs() < 1e-3);
        assert!((CUP.puncture_depth_m() - 5e-3).abs() < 1e-12);
        assert!((push(&CUP, &[4e-3, 6e-3], &mut history).0 - 0.3).abs() < 1e-9);
        assert!(history.punctured);
        // Drawn out: the friction turns round over 2 · 0.3/300 = 2 mm, then −0.3 N.
        assert!((push(&CUP, &[6e-3, 3.5e-3], &mut history).0 + 0.3).abs() < 1e-9);
        assert_eq!(push(&CUP, &[3.5e-3, -1e-3], &mut history).0, 0.0);
        // In again: only friction, at most.
        assert!((push(&CUP, &[0.0, 6e-3], &mut history).0 - 0.3).abs() < 1e-9);
        // 10 mm/s add 0.02 N.
        assert!((CUP.force_n(6e-3, 0.01, &mut history) - 0.32).abs() < 1e-9);
    }

    #[test]
    fn its_stiffness_depends_on_the_deepest_insertion() {
        let mut history = MembraneHistory::default();
        push(&CUP, &[0.0, 4e-3], &mut history);
        // Dent 0.4 · 4 mm = 1.6 mm; at 2.8 mm it is half way between dent and 1.2 N.
        assert!((push(&CUP, &[4e-3, 2.8e-3], &mut history).0 - 0.6).abs() < 1e-3);
        assert_eq!(push(&CUP, &[2.8e-3, 1.5e-3], &mut history).0, 0.0, "within the dent nothing is felt");
        let again = push(&CUP, &[1.5e-3, 4.5e-3], &mut history).0;
        assert!((again - 1.35).abs() < 1e-3, "beyond the old depth it is as new: {again}");
    }

    #[test]
    fn a_cycle_takes_energy_and_never_gives_any() {
        for way in [vec![0.0, 4e-3, 0.0], vec![0.0, 4e-3, 1e-3, 4.5e-3, 0.0], vec![0.0, 8e-3, 2e-3, 7e-3, 0.0]] {
            let mut history = MembraneHistory::default();
            let (_, work) = push(&CUP, &way, &mut history);
            assert!(work > 1e-4, "{way:?}: {work}");
            let (_, second) = push(&CUP, &[0.0, 3e-3, 0.0], &mut history);
            assert!(second > -1e-6, "{way:?}: {second}");
        }
    }

    #[test]
    fn a_trembling_needle_at_rest_stays_in_its_phase() {
        let mut history = MembraneHistory::default();
        let mut phases = Vec::new();
        // In, at rest with a tremor of 0.1 mm, out, and at rest on the way.
        let tremble = |at: f64| (0..40).map(move |i| at + 1e-4 * f64::from(i).sin());
        let inwards = (0..=80).map(|i| f64::from(i) * 1e-4);
        let outwards = (0..=40).map(|i| 8e-3 - f64::from(i) * 1e-4);
        let rest_of_it = (0..=45).map(|i| 4e-3 - f64::from(i) * 1e-4);
        for x in inwards.chain(tremble(8e-3)).chain(outwards).chain(tremble(4e-3)).chain(rest_of_it) {
            CUP.force_n(x, 0.0, &mut history);
            let phase = MembraneLaw::phase(x, &mut history);
            if phases.last() != Some(&phase) {
                phases.push(phase);
            }
        }
        assert_eq!(phases, [Free, Insertion, Penetration, Extraction, Free]);
    }

    #[test]
    fn hardening_moves_the_puncture_nearer() {
        let law = MembraneLaw { cubic_n_m3: 3e7, ..CUP };
        let x = law.puncture_depth_m();
        assert!(x < 5e-3 && (law.loading_n(x) - 1.5).abs() < 1e-12);
    }
}
