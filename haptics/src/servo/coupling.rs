//! Virtual coupling between the device and a world that is stiffer than the device can render.
//!
//! The operator's device hangs on a spring and damper whose other end is the fingertip in the world, the *proxy* (Colgate et
//! al. 1995; Adams & Hannaford 1999; the god object of Zilles & Salisbury 1995 is its limit for a rigid world). Spring and
//! damper are computed from the device's physical damping b, its Coulomb friction `f_c`, its resolution Δ, the period T and an
//! extra delay, so that the sampled coupling alone is passive on this device, whatever the world does at the other end:
//! K (T/2 + `t_d`) + B ≤ b and K/2 + B/T ≤ `f_c`/Δ. The operator then feels the pad and the coupling in series.
//!
//! The proxy has no mass: every tick it goes to the balance of coupling and contact, with the stiffness and damping of
//! its present contacts taken implicitly. It therefore neither rings nor drags, and it is stable for any pad.

use super::passivity::{friction_per_step_n_m, passive_damping, passive_stiffness};
use crate::Vec2;
use crate::device::{DeviceSpec, Sample};
use crate::world::{Contact, Input, State, Surface, World};
use nalgebra::Matrix2;

/// Share of the passive range that the coupling uses.
pub const MARGIN: f64 = 0.9;
/// Share of the passive damping that the coupling's own damper uses up.
pub const DAMPER_SHARE: f64 = 0.1;
/// A device that states neither damping nor friction renders nothing that is provably passive. It gets this spring, N/m, or a
/// softer one where there is delay: one that [`HAND_DAMPING_N_S_M`] makes passive.
pub const SOFTEST_N_M: f64 = 40.0;
/// Damping of any hand that holds a device, N s/m (a tenth of that of a relaxed finger).
pub const HAND_DAMPING_N_S_M: f64 = 0.5;

/// The spring and damper between device and proxy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupling {
    /// Stiffness, N/m.
    pub stiffness_n_m: f64,
    /// Damping, N s/m.
    pub damping_n_s_m: f64,
}

impl Coupling {
    /// The stiffest coupling that is passive on a device at a period (s), with an extra delay (s) in the loop.
    pub fn passive(spec: &DeviceSpec, period_s: f64, delay_s: f64) -> Self {
        let damping = DAMPER_SHARE * passive_damping(spec, period_s);
        let lag_s = 0.5 * period_s + delay_s;
        let sampled = (MARGIN * spec.damping_n_s_m - damping) / lag_s;
        let quantised = 2.0 * (MARGIN * friction_per_step_n_m(spec) - damping / period_s);
        let stiffness = sampled.min(quantised);
        if stiffness > 0.0 {
            return Self { stiffness_n_m: stiffness, damping_n_s_m: damping };
        }
        Self { stiffness_n_m: SOFTEST_N_M.min(HAND_DAMPING_N_S_M / lag_s), damping_n_s_m: 0.0 }
    }

    /// The coupling that a device needs in a world; `None` when it renders the pads directly, or renders no force at all.
    pub fn needed(spec: &DeviceSpec, world: &World, period_s: f64, delay_s: f64) -> Option<Self> {
        if !spec.force_feedback {
            return None;
        }
        // A fingertip may press on one surface and stick to another at a right angle: both act along one line.
        // A device feels a pad only as stiff as it is at the largest force of the device: beyond, its force is held.
        let stiffness = world.pad.elastic().stiffness_at_n_m(spec.max_force_n) + world.pad.shear_stiffness_n_m;
        let damping = world.pad.damping_n_s_m + world.pad.shear_damping_n_s_m;
        let direct = stiffness <= passive_stiffness(spec, damping, period_s, delay_s);
        (!direct).then(|| Self::passive(spec, period_s, delay_s))
    }

    /// Stiffness of the coupling and a stiffness in series, N/m: the operator's feel of an object.
    pub fn felt_n_m(&self, stiffness_n_m: f64) -> f64 {
        self.stiffness_n_m * stiffness_n_m / (self.stiffness_n_m + stiffness_n_m)
    }
}

/// The fingertips in the world, on their couplings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proxy {
    coupling: Coupling,
    tips: Input,
}

impl Proxy {
    /// Starts where the fingers are.
    pub fn new(coupling: Coupling, tips: Input) -> Self {
        Self { coupling, tips }
    }

    /// Its coupling.
    pub fn coupling(&self) -> Coupling {
        self.coupling
    }

    /// The same fingertips on another coupling.
    pub fn with_coupling(self, coupling: Coupling) -> Self {
        Self { coupling, ..self }
    }

    /// Moves the tips to where coupling and contact balance: the world's input for this tick.
    pub fn follow(&mut self, device: &Sample, world: &World, state: &State, dt_s: f64) -> Input {
        for finger in 0..2 {
            let moved = self.advance(finger, device, world, state, dt_s);
            let (tip, velocity) = (&mut self.tips.tip_in_world[finger], &mut self.tips.tip_velocity[finger]);
            if moved.x.is_finite() && moved.y.is_finite() {
                *tip += moved;
                *velocity = moved / dt_s;
            } else {
                // A world that has blown up must not take the finger with it.
                (*tip, *velocity) = (device.tip_in_world[finger], Vec2::zeros());
            }
        }
        self.tips
    }

    /// The balance of coupling and contact, both linear in the displacement Δp of this tick: K (x − p − Δp) + B (v −
    /// Δp/T) + F − `K_c` (Δp − `v_o` T) − `B_c` (Δp/T − `v_p`) = 0. F, `K_c`, `B_c` are the contacts' force, stiffness
    /// and damping after the tick before, and `v_o` is the speed of the touched object.
    fn advance(&self, finger: usize, device: &Sample, world: &World, state: &State, dt_s: f64) -> Vec2 {
        let sliding_on = self.balance(finger, device, world, state, dt_s, false);
        // A contact that slides has no stiffness along the surface as long as it slides on. At a reversal of the tip it
        // sticks, with the pad's shear stiffness: otherwise the friction would throw a softly coupled tip back and
        // forth.
        let turns = state.contacts.iter().any(|c| {
            c.on == Surface::Finger(finger as u8)
                && c.sliding
                && (sliding_on - surface_velocity(state, c) * dt_s).dot(&c.tangent()) * c.tangent_force_n > 0.0
        });
        if turns { self.balance(finger, device, world, state, dt_s, true) } else { sliding_on }
    }

    fn balance(
        &self,
        finger: usize,
        device: &Sample,
        world: &World,
        state: &State,
        dt_s: f64,
        all_stick: bool,
    ) -> Vec2 {
        let Coupling { stiffness_n_m, damping_n_s_m } = self.coupling;
        let stretch = device.tip_in_world[finger] - self.tips.tip_in_world[finger];
        let mut force = stretch * stiffness_n_m + device.tip_velocity[finger] * damping_n_s_m;
        let mut impedance = Matrix2::identity() * (stiffness_n_m + damping_n_s_m / dt_s);
        force -= state.tip_force_n[finger];
        for contact in state.contacts.iter().filter(|c| c.on == Surface::Finger(finger as u8)) {
            let (spring, damper) = stiffness_of(contact, world, all_stick || !contact.sliding);
            let carried = surface_velocity(state, contact) * dt_s;
            force += spring * carried + damper * self.tips.tip_velocity[finger];
            impedance += spring + damper / dt_s;
        }
        // Symmetric and positive: the coupling alone makes it so.
        impedance.try_inverse().map_or_else(Vec2::zeros, |inverse| inverse * force)
    }

    /// Force on the operator's fingers, N.
    pub fn force_n(&self, device: &Sample) -> [Vec2; 2] {
        [0, 1].map(|finger| {
            (self.tips.tip_in_world[finger] - device.tip_in_world[finger]) * self.coupling.stiffness_n_m
                + (self.tips.tip_velocity[finger] - device.tip_velocity[finger]) * self.coupling.damping_n_s_m
        })
    }
}

/// Stiffness and damping of a contact, N/m and N s/m: change of its force with the tip's position and velocity.
fn stiffness_of(contact: &Contact, world: &World, sticks: bool) -> (Matrix2<f64>, Matrix2<f64>) {
    let along = contact.normal * contact.normal.transpose();
    let (mut spring, mut damper) = (Matrix2::zeros(), Matrix2::zeros());
    if contact.normal_force_n > 0.0 {
        spring += along * world.pad.elastic().stiffness_n_m(contact.depth_m);
        damper += along * world.pad.damping_n_s_m;
    }
    if sticks {
        let tangent = contact.tangent();
        let across = tangent * tangent.transpose();
        spring += across * world.pad.shear_stiffness_n_m;
        damper += across * world.pad.shear_damping_n_s_m;
    }
    (spring, damper)
}

/// Velocity of the surface that a finger touches, at the contact, m/s.
fn surface_velocity(state: &State, contact: &Contact) -> Vec2 {
    match contact.by {
        Surface::Block(index) => state.bodies.get(usize::from(index)).map_or_else(Vec2::zeros, |body| {
            let arm = contact.point_m - body.center_m;
            body.velocity_m_s + Vec2::new(-arm.y, arm.x) * body.rate_rad_s
        }),
        Surface::Handle => state.crank.handle_velocity,
        Surface::Knob => state.switch.knob_velocity,
        Surface::Floor | Surface::Plane | Surface::Membrane | Surface::Cup | Surface::Base | Surface::Finger(_) => {
            Vec2::zeros()
        }
    }
}

#[cfg(test)]
mod tests;
