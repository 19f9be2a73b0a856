//! The fitted mechanism as a world, and the force that it predicts for a measured motion.

use super::report::{OBJECT, PHASE};
use super::signals::Raw;
use super::{path, regress, signals};
use crate::constraint;
use foundation::estimate::{ConstraintKind, EstimateError, Fit};
use haptics::law::{
    Coordinate, CoulombFriction, EccentricMass, Effect, ForceBias, Inertia, Motion, ViscousFriction, drive_forces,
};
use haptics::recording::Recording;
use haptics::world::Mechanism;

/// The mechanism of a world file: laws with the fitted values, the path with its zero at the start of `recording`, the blur
/// of its velocity noise. Parameters that were not identified are left out; friction below zero counts as none.
pub fn world(fit: &Fit, recording: &Recording) -> Mechanism {
    let path = fit
        .constraints
        .iter()
        .find(|c| matches!(c.kind, ConstraintKind::Revolute | ConstraintKind::Prismatic))
        .and_then(|c| path::from_constraint(c, recording));
    let angular = fit.parameters.iter().any(|p| p.object == OBJECT && p.name == "inertia_kg_m2");
    let raw = signals::raw(recording, path.as_ref()).ok();
    let pieces = raw.as_ref().and_then(|raw| signals::pieces(raw, &recording.name).ok()).unwrap_or_default();
    let noise = pieces.iter().map(|p| p.velocity_noise).fold(0.0, f64::max);
    Mechanism {
        coordinate: if angular { Coordinate::Angular } else { Coordinate::Linear },
        path,
        effects: effects(fit),
        direction_blur: signals::noise_blur(noise),
    }
}

fn effects(fit: &Fit) -> Vec<Effect> {
    let either = |a: &str, b: &str| fit.value(OBJECT, a).or_else(|| fit.value(OBJECT, b));
    let mut effects = Vec::new();
    if let Some(inertia) = either("mass_kg", "inertia_kg_m2") {
        effects.push(Effect::new(&Inertia, &[inertia.max(0.0)]));
    }
    if let Some(viscous) = either("viscous_N_s_m", "viscous_Nm_s") {
        effects.push(Effect::new(&ViscousFriction, &[viscous.max(0.0)]));
    }
    let coulomb = either("coulomb_N", "coulomb_Nm");
    // Constant resistance that one direction cannot split: a mechanism at hand most likely has friction.
    if let Some(dry) = coulomb.or_else(|| either("resistance_N", "resistance_Nm").map(f64::abs)) {
        effects.push(Effect::new(&CoulombFriction, &[dry.max(0.0)]));
    }
    if let Some(moment) = fit.value(OBJECT, "gravity_moment_Nm") {
        let phase = fit.value(OBJECT, PHASE).unwrap_or(0.0);
        effects.push(Effect::new(&EccentricMass, &[moment * phase.cos(), -moment * phase.sin()]));
    }
    if let Some(offset) = either("offset_N", "offset_Nm") {
        effects.push(Effect::new(&ForceBias, &[offset]));
    }
    effects
}

/// Least size of a direction of motion that is certain, of 1.
/// Choice: no case of the ablation reads it.
const MOVES: f64 = 0.99;
/// Share of the square of dry friction that a stop or a turn leaves open at most, as the fit weighs its samples.
/// Derived: 0.1²; the friction is then told to a tenth of itself.
const LEFT_OPEN: f64 = 0.01;

/// Prediction of the laws for a measured motion.
pub struct Prediction {
    /// Force at every sample, N or N m.
    pub force: Vec<f64>,
    /// True for samples with a prediction: at rest, and as far around it as the filter reaches, dry friction holds any
    /// load.
    pub is_told: Vec<bool>,
}

/// The force (N, or N m) that the mechanism needs at every sample of the recording's motion.
pub fn predict(mechanism: &Mechanism, recording: &Recording) -> Result<Prediction, EstimateError> {
    let raw = signals::raw(recording, mechanism.path.as_ref())?;
    let motion = signals::motion(&raw, mechanism);
    let holds = mechanism.effects.iter().any(|e| e.law().is_dry());
    let open = open_share(&raw);
    let told = |(m, open): (&Motion, &f64)| !holds || m.direction.abs() > MOVES && *open < LEFT_OPEN;
    let is_told = motion.iter().zip(&open).map(told).collect();
    Ok(Prediction { force: drive_forces(&mechanism.effects, &motion), is_told })
}

/// Uncertain share of each sample in the square of its dry friction: near a stop or a reversal the filter has mixed
/// holding and braking friction. 0 if the motion is too short to be filtered.
fn open_share(raw: &Raw) -> Vec<f64> {
    let mut open = vec![0.0; raw.time_s.len()];
    for piece in signals::pieces(raw, "").unwrap_or_default() {
        let share = regress::direction_uncertainty(&piece);
        for (time_s, open) in raw.time_s.iter().zip(&mut open).skip(piece.first) {
            let at = ((time_s - piece.start_s) / piece.period_s).round();
            match share.get(at.max(0.0) as usize) {
                Some(share) => *open = *share,
                None => break,
            }
        }
    }
    open
}

/// The measured force along the mechanism's coordinate, N or N m; `None` for a free motion.
pub fn measured(mechanism: &Mechanism, recording: &Recording) -> Result<Option<Vec<f64>>, EstimateError> {
    Ok(signals::raw(recording, mechanism.path.as_ref())?.force)
}

/// The path of a recording by itself, when its constraint is decided.
pub fn path_of(recording: &Recording) -> Option<haptics::world::MechanismPath> {
    path::from_constraint(&constraint::detect_in(recording)?, recording)
}
