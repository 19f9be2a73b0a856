//! A force law in one coordinate: the state that it sees, its role in the equation of motion, and the trait that every law implements.

use super::entry::{Entry, Kind, ParameterSpec};
use super::memory::Memory;

/// Most parameters that a single law has.
pub const MAX_PARAMETERS: usize = 5;

/// The state of one coordinate at one instant, as every law sees it.
///
/// Laws of an angle on a coordinate that is a path length (a crank's handle: s = R θ) carry R as a parameter of their own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Time since the start, s.
    pub time_s: f64,
    /// Coordinate, m or rad.
    pub position: f64,
    /// Its rate, m/s or rad/s.
    pub velocity: f64,
    /// Its second derivative, m/s² or rad/s².
    pub acceleration: f64,
    /// Direction of motion in −1 … 1. The caller decides how a noisy sign is smoothed; the servo passes the direction of
    /// the impending slip.
    pub direction: f64,
    /// Normal (constraint) force, N.
    pub normal_force_n: f64,
    /// Component of the upward unit vector along +coordinate (cos θ for a crank measured from the horizontal).
    pub up_along: f64,
}

/// A law's part in the equation of motion of a coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The inertia of the coordinate itself: m is read, not the force.
    Inertia,
    /// Gravity on a carried mass: acts across the motion, too, and is not behind a gap.
    Gravity,
    /// A force that acts whether or not the coordinate moves.
    Smooth,
    /// The same, too steep for an explicit step: [`Law::stiffness`] is taken implicitly.
    Stiff,
    /// Resists motion in proportion to speed or faster; nothing at rest.
    Viscous,
    /// Dry friction: proportional to [`Motion::direction`], holds at rest.
    Dry,
    /// Dry friction that bends before it slides: a stiff spring with its memory, dry friction without.
    Presliding,
    /// A gap before everything that resists motion (viscous, dry, presliding).
    Gap,
}

/// A physical law in one coordinate. The sign convention is that of a *drive*: the term is the force a tool must exert
/// along +coordinate to make the motion happen.
pub trait Law: Sync {
    /// Its page of the catalogue.
    fn entry(&self) -> &'static Entry;
    /// Its part in the equation of motion.
    fn role(&self) -> Role;
    /// Stable id (`docs/causes/README.md`, or a base term such as `weight`).
    fn id(&self) -> &'static str {
        self.entry().id
    }
    /// Plant or instrument.
    fn kind(&self) -> Kind {
        self.entry().kind
    }
    /// A short name for people.
    fn title(&self) -> &'static str {
        self.entry().title
    }
    /// The parameters, in the order of the regressor's columns.
    fn parameters(&self) -> &'static [ParameterSpec] {
        self.entry().parameters
    }
    /// True when the term is dry friction: proportional to [`Motion::direction`] and able to hold the coordinate at rest.
    fn is_dry(&self) -> bool {
        matches!(self.role(), Role::Dry | Role::Presliding)
    }
    /// True when the force goes with [`Motion::normal_force_n`].
    fn feels_load(&self) -> bool {
        false
    }
    /// True when the force goes with time, place, speed and direction alone: neither with the acceleration nor with a load nor with where
    /// up is.
    fn is_of_path(&self) -> bool {
        !self.feels_load() && !matches!(self.role(), Role::Inertia | Role::Gravity)
    }
    /// The law that this one is times [`Motion::direction`], parameter by parameter, where there is one.
    fn times_direction(&self) -> Option<&'static dyn Law> {
        None
    }
    /// True when the law has a memory that [`Law::advance`] moves.
    fn remembers(&self) -> bool {
        false
    }
    /// Regressor row: `columns[i]` = d(force)/d(parameter i), of the linear parameters, with nonlinear and fixed ones unset.
    /// A law that means nothing without those leaves its columns as they are: [`Effect::columns`](super::Effect::columns) gives them at its values.
    fn regressor(&self, _motion: &Motion, _columns: &mut [f64; MAX_PARAMETERS]) {}
    /// The law's force, N or N m. A law with memory returns its developed force, the limit in a long motion.
    fn force(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS]) -> f64 {
        let mut columns = [0.0; MAX_PARAMETERS];
        self.regressor(motion, &mut columns);
        columns.iter().zip(parameters).map(|(c, p)| c * p).sum()
    }
    /// The law's force with its memory, N or N m.
    fn force_with(&self, motion: &Motion, parameters: &[f64; MAX_PARAMETERS], _memory: &Memory) -> f64 {
        self.force(motion, parameters)
    }
    /// d(force)/d(coordinate) towards [`Motion::direction`], of stiff and presliding laws, N/m or N m/rad.
    fn stiffness(&self, _motion: &Motion, _parameters: &[f64; MAX_PARAMETERS], _memory: &Memory) -> f64 {
        0.0
    }
    /// Engagement of a gap: 1 where the parts behind it are felt, 0 within it.
    fn engaged(&self, _motion: &Motion, _parameters: &[f64; MAX_PARAMETERS], _memory: &Memory) -> f64 {
        1.0
    }
    /// Moves the memory over `dt_s` at [`Motion::velocity`].
    fn advance(&self, _motion: &Motion, _parameters: &[f64; MAX_PARAMETERS], _memory: &mut Memory, _dt_s: f64) {}
}

/// A finite force for the servo: no number of a file or a device may leave it with a NaN.
#[inline]
pub(super) fn tame(force: f64) -> f64 {
    /// Far beyond any hand or device, N or N m.
    const LARGEST: f64 = 1e12;
    if force.is_nan() { 0.0 } else { force.clamp(-LARGEST, LARGEST) }
}
