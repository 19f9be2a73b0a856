//! One coordinate under its laws as a joint of other simulators: inertia, damper, Coulomb friction, spring, stops,
//! weight.
//!
//! No law is repeated here: each is evaluated at motions that isolate one of its parameters.

use super::frame::Vec3;
use super::scene::Scene;
use super::{Fate, Remark};
use haptics::law::{
    AddedConstraint, Coordinate as Unit, CoulombFriction, EccentricMass, Effect, Enters, Entry, GravityTilt, Inertia,
    Kind, Law as _, Motion, ReturnSpring, Role, ViscousFriction, Weight,
};
use std::f64::consts::FRAC_PI_2;

/// Joint coordinate of a file.
pub struct Coordinate {
    /// True for a revolute joint, false for a prismatic one.
    pub turns: bool,
    /// Axis of rotation or direction of sliding, in the world's frame; unit vector.
    pub axis: Vec3,
    /// Initial position, m or rad.
    pub start: f64,
    /// Viscous damping, N s/m or N m s/rad.
    pub damping: f64,
    /// Coulomb friction, N or N m.
    pub dry: f64,
    /// Stiffness, N/m or N m/rad, and rest position, m or rad.
    pub spring: Option<(f64, f64)>,
    /// Lower and upper limit of the position, m or rad.
    pub range: [Option<f64>; 2],
    /// Stiffness of the stops, N/m or N m/rad, if known.
    pub stop: Option<f64>,
}

/// Effect of a coordinate's laws, along the file's coordinate.
pub struct Laws {
    /// Inertia, kg or kg m².
    pub inertia: f64,
    /// Drive force against gravity at the coordinate's zero and a quarter turn further, N or N m; equal for a slide.
    pub weight: [f64; 2],
    /// All other laws.
    pub joint: Coordinate,
}

/// Coordinate in terms of its laws and of the file.
pub struct Seen<'a> {
    /// Name in remarks.
    pub object: &'a str,
    /// Axis of rotation or direction of sliding.
    pub axis: Vec3,
    /// True if it rotates in the file.
    pub turns: bool,
    /// Travel of the laws' coordinate per unit of the file's: a crank's arm, otherwise 1.
    pub arm: f64,
    /// Initial position, in the file's coordinate.
    pub start: f64,
    /// `up · t` at the file's zero and a quarter turn further.
    pub up_along: [f64; 2],
}

/// Evaluates the laws and remarks on effects that a joint cannot have.
pub fn read(effects: &[Effect], seen: &Seen<'_>, scene: &mut Scene) -> Laws {
    let joint = Coordinate {
        turns: seen.turns,
        axis: seen.axis,
        start: seen.start,
        damping: 0.0,
        dry: 0.0,
        spring: None,
        range: [None, None],
        stop: None,
    };
    let mut laws = Laws { inertia: 0.0, weight: [0.0; 2], joint };
    for effect in effects.iter().filter(|effect| effect.enabled) {
        let (fate, how) = laws.take(effect, seen);
        let what = effect.law().id().to_owned();
        scene.remarks.push(Remark { object: seen.object.to_owned(), what, fate, how });
    }
    laws
}

impl Laws {
    fn take(&mut self, effect: &Effect, seen: &Seen<'_>) -> (Fate, String) {
        let at = |motion: Motion| seen.arm * effect.force(&motion);
        let id = effect.law().id();
        if id == Inertia.id() {
            // As in the integrator: inertia is the law's only value.
            self.inertia += seen.arm * seen.arm * haptics::law::inertia(std::slice::from_ref(effect));
            return (Fate::Kept, "mass and inertia of the body".to_owned());
        }
        if id == Weight.id() || id == GravityTilt.id() || (id == EccentricMass.id() && seen.turns) {
            for (weight, (turn, up_along)) in
                self.weight.iter_mut().zip([0.0, FRAC_PI_2].into_iter().zip(seen.up_along))
            {
                let position = if seen.turns { seen.arm * turn } else { 0.0 };
                *weight += at(Motion { position, up_along, ..Motion::default() });
            }
            return (Fate::Kept, "where the mass lies, or how much of it weighs".to_owned());
        }
        if id == ViscousFriction.id() {
            self.joint.damping += seen.arm * at(Motion { velocity: 1.0, direction: 1.0, ..Motion::default() });
            return (Fate::Kept, "the joint's damping".to_owned());
        }
        if effect.law().feels_load() {
            return (Fate::LeftOut, why_not(effect.law().entry()));
        }
        if id == CoulombFriction.id() || effect.role() == Role::Presliding {
            // Faster than any motion: the asymptotic value of such friction.
            self.joint.dry += at(Motion { velocity: 1e3, direction: 1.0, ..Motion::default() }).max(0.0);
            return if id == CoulombFriction.id() {
                (Fate::Kept, "the joint's dry friction".to_owned())
            } else {
                (Fate::Approximate, "dry friction that does not bend before it slides".to_owned())
            };
        }
        if id == ReturnSpring.id() || id == AddedConstraint.id() {
            return self.take_spring(effect, seen);
        }
        (Fate::LeftOut, why_not(effect.law().entry()))
    }

    /// A spring, or a stop at one side.
    fn take_spring(&mut self, effect: &Effect, seen: &Seen<'_>) -> (Fate, String) {
        let side = value(effect, "side").unwrap_or(0.0);
        if side != 0.0 {
            let place = value(effect, "place").unwrap_or(0.0) / seen.arm;
            let end = usize::from(side > 0.0);
            let nearer = |old: f64| if side > 0.0 { old.min(place) } else { old.max(place) };
            self.joint.range[end] = Some(self.joint.range[end].map_or(place, nearer));
            return (Fate::Approximate, "a stop as hard as the program makes it".to_owned());
        }
        let at = |place: f64| seen.arm * effect.force(&Motion { position: seen.arm * place, ..Motion::default() });
        let step = if seen.turns { 0.01 } else { 1e-3 };
        let slope = |h: f64| (at(seen.start + h) - at(seen.start - h)) / (2.0 * h);
        let stiffness = slope(step);
        if stiffness <= 0.0 {
            return (Fate::LeftOut, "a force that is the same everywhere is no spring".to_owned());
        }
        // Two springs combine into one, at rest where their forces cancel.
        let rest = seen.start - at(seen.start) / stiffness;
        let (before, before_rest) = self.joint.spring.unwrap_or((0.0, 0.0));
        let total = before + stiffness;
        self.joint.spring = Some((total, (before * before_rest + stiffness * rest) / total));
        if (slope(100.0 * step) / stiffness - 1.0).abs() > 1e-6 {
            (Fate::Approximate, "as stiff everywhere as it is at the start".to_owned())
        } else {
            (Fate::Kept, "the joint's spring".to_owned())
        }
    }
}

/// The value of a law's parameter.
fn value(effect: &Effect, name: &str) -> Option<f64> {
    let index = effect.law().parameters().iter().position(|spec| spec.name == name)?;
    effect.values.get(index).copied()
}

/// Reason why a joint cannot represent a law.
fn why_not(entry: &Entry) -> String {
    if entry.kind == Kind::Instrument {
        return "a fault of the measurement, not of the object".to_owned();
    }
    let values: Vec<&str> = entry.parameters.iter().filter(|p| p.enters != Enters::Fixed).map(|p| p.name).collect();
    format!("joints have no {} ({} with {})", entry.title.to_lowercase(), entry.equation, values.join(", "))
}

/// True if a mechanism's coordinate is an angle.
pub fn turns(unit: Unit) -> bool {
    unit == Unit::Angular
}
