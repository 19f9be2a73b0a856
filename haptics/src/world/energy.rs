//! Stored energy of a world: an operator may get it back without the world being active.

use super::driven::crank_motion;
use super::model::{Crank, World};
use super::state::State;
use crate::law::{Role, inertia};

/// Kinetic and potential energy of a world's bodies, handle and knob, J, up to a constant. The energy in pressed pads,
/// contacts and sheets is left out: the operator put it in, and less than that comes back.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stored {
    /// Angle up to which the handle's springs and weights have been added up, rad.
    angle_rad: Option<f64>,
    /// Energy that they hold, J.
    crank_j: f64,
}

impl Stored {
    /// The energy now. Call it with every tick: the energy of the crank's laws depends on the way.
    pub fn update(&mut self, world: &World, state: &State) -> f64 {
        let crank_j = world.crank.as_ref().map_or(0.0, |crank| self.crank(crank, state));
        bodies_j(world, state) + crank_j + switch_j(world, state)
    }

    fn crank(&mut self, crank: &Crank, state: &State) -> f64 {
        let angle_rad = state.crank.angle_rad;
        let before_rad = self.angle_rad.replace(angle_rad).unwrap_or(angle_rad);
        let way_m = crank.radius_m * (angle_rad - before_rad);
        let middle = crank_motion(crank, state.time_s, 0.5 * (before_rad + angle_rad), state.crank.rate_rad_s, 0.0);
        let gives_back = |role| matches!(role, Role::Gravity | Role::Smooth | Role::Stiff);
        let force_n: f64 =
            crank.effects.iter().filter(|e| e.enabled && gives_back(e.role())).map(|e| e.force(&middle)).sum();
        self.crank_j += force_n * way_m;
        let speed_m_s = crank.radius_m * state.crank.rate_rad_s;
        self.crank_j + 0.5 * inertia(&crank.effects) * speed_m_s * speed_m_s
    }
}

/// Bodies in motion, in height and on stretched cables, J.
pub(super) fn bodies_j(world: &World, state: &State) -> f64 {
    let bodies = world.blocks.iter().zip(&state.bodies).map(|(block, body)| {
        let mass_kg = block.mass_kg - body.leaked_kg;
        let stretch_m = |c: &super::block::Cable| ((body.center_m - c.anchor_m).norm() - c.length_m).max(0.0);
        0.5 * mass_kg * body.velocity_m_s.norm_squared()
            + 0.5 * block.inertia_kg_m2() * body.rate_rad_s.powi(2)
            + mass_kg * world.gravity_m_s2 * body.center_m.y
            + block
                .guide
                .as_ref()
                .map_or(0.0, |g| 0.5 * g.stiffness_n_m * (body.center_m - g.point(body.guided.at).0).norm_squared())
            + block.cable.as_ref().map_or(0.0, |c| 0.5 * c.stiffness_n_m * stretch_m(c).powi(2))
    });
    bodies.sum()
}

/// Knob in motion, in height, and its curve half way between both branches, J.
fn switch_j(world: &World, state: &State) -> f64 {
    let Some(switch) = &world.switch else { return 0.0 };
    let knob = &state.switch;
    let height_m = switch.knob_in_world(knob.at_m).y;
    0.5 * switch.mass_kg * knob.rate_m_s.powi(2)
        + switch.mass_kg * world.gravity_m_s2 * height_m
        + switch.curve.held_j(knob.at_m)
}
