//! A plane that never moves and pushes one way: a table or a wall at any angle, as found in a recording.

use super::error::{WorldError, finite, not_negative, positive, range_error};
use crate::Vec2;
use serde::{Deserialize, Serialize};

/// Everything on the far side of a line in the plane of motion is solid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plane {
    /// A point of the surface, m in the world.
    pub point_m: Vec2,
    /// Out of the solid; a unit vector within 1 %.
    pub normal: Vec2,
    /// Stiffness at each point of contact, N/m, positive; in series with the pad under a finger.
    pub stiffness_n_m: f64,
    /// Damping of each point of contact under blocks, N s/m, ≥ 0.
    pub damping_n_s_m: f64,
    /// Friction coefficient against blocks and fingers, ≥ 0.
    pub friction: f64,
}

impl Plane {
    /// The unit normal, out of the solid.
    pub fn normal(&self) -> Vec2 {
        self.normal.normalize()
    }

    /// Depth of a point inside, m; negative outside.
    pub fn depth_m(&self, point_m: Vec2) -> f64 {
        self.normal().dot(&(self.point_m - point_m))
    }

    pub(super) fn check(&self) -> Result<(), WorldError> {
        for value in [self.point_m.x, self.point_m.y, self.normal.x, self.normal.y] {
            finite("the plane", "point_m and normal", value)?;
        }
        if (self.normal.norm() - 1.0).abs() > 0.01 {
            return Err(range_error("the plane", "normal", self.normal.norm(), "of length 1"));
        }
        positive("the plane", "stiffness_n_m", self.stiffness_n_m)?;
        not_negative("the plane", "damping_n_s_m", self.damping_n_s_m)?;
        not_negative("the plane", "friction", self.friction)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Block, Input, State, World, step};
    use super::*;

    fn slope(angle_rad: f64, friction: f64) -> World {
        let mut world = World::empty("slope");
        world.floor = None;
        let normal = Vec2::new(-angle_rad.sin(), angle_rad.cos());
        world.plane = Some(Plane {
            point_m: Vec2::new(0.0, -0.08),
            normal,
            stiffness_n_m: 8000.0,
            damping_n_s_m: 12.0,
            friction,
        });
        world
    }

    fn fingers(at: Vec2, velocity: Vec2) -> Input {
        Input { tip_in_world: [at, Vec2::new(1.0, 1.0)], tip_velocity: [velocity, Vec2::zeros()] }
    }

    #[test]
    fn a_block_slides_down_a_slope_as_galileo_says() {
        let (angle, mu) = (0.5_f64, 0.2);
        let mut world = slope(angle, mu);
        let mut block = Block::upright("block", 0.05, 0.02, 0.01, 0.0, 0.0);
        block.start.angle_rad = angle;
        let plane = world.plane.expect("a plane");
        block.start.center_m = plane.point_m + plane.normal() * 0.005;
        world.blocks = vec![block];
        world.check().expect("it can be stepped");
        let away = fingers(Vec2::new(-1.0, 1.0), Vec2::zeros());
        let mut state = State::new(&world, away.tip_in_world);
        for _ in 0..2000 {
            step(&world, &mut state, &away, 1e-4);
        }
        let speed = state.bodies[0].velocity_m_s.norm();
        let expected = 9.81 * (angle.sin() - mu * angle.cos()) * 0.2;
        assert!((speed / expected - 1.0).abs() < 0.02, "{speed} {expected}");
    }

    #[test]
    fn a_finger_feels_pad_and_plane_in_series_and_only_from_outside() {
        let world = slope(0.3, 0.4);
        world.check().expect("it can be stepped");
        let plane = world.plane.expect("a plane");
        let tip = plane.point_m - plane.normal() * 2e-4;
        let mut state = State::new(&world, [plane.point_m + plane.normal() * 0.01, Vec2::new(1.0, 1.0)]);
        for _ in 0..100 {
            step(&world, &mut state, &fingers(tip, Vec2::zeros()), 1e-3);
        }
        let pad = world.pad.stiffness_n_m;
        let expected = 2e-4 * pad * plane.stiffness_n_m / (pad + plane.stiffness_n_m);
        let force = -state.tip_force_n[0].dot(&plane.normal());
        assert!((force / expected - 1.0).abs() < 0.05, "{force} {expected}");
        let outside = plane.point_m + plane.normal() * 1e-3;
        for _ in 0..20 {
            step(&world, &mut state, &fingers(outside, Vec2::zeros()), 1e-3);
        }
        assert!(state.tip_force_n[0].norm() < 1e-12);
    }

    #[test]
    fn what_cannot_be_a_plane_is_said() {
        let changes: [fn(&mut Plane); 3] =
            [|p| p.normal = Vec2::zeros(), |p| p.stiffness_n_m = 0.0, |p| p.friction = -1.0];
        for change in changes {
            let mut world = slope(0.0, 0.3);
            if let Some(plane) = &mut world.plane {
                change(plane);
            }
            assert!(world.check().is_err());
        }
    }
}
