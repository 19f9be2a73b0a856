//! Touches with the ground under everything: the table, and a plane at any angle.

use super::{Found, Gather, Material, Solid, pad_material};
use crate::Vec2;
use crate::world::block::Shape;
use crate::world::contact_point::Surface;

impl Gather<'_> {
    pub(super) fn floor(&mut self) {
        let Some(floor) = &self.world.floor else { return };
        let up = Vec2::new(0.0, 1.0);
        let impact_damping = floor.loss.map_or(0.0, |loss| loss.impact_damping());
        for (index, block) in self.world.blocks.iter().enumerate() {
            let Solid { rect, reach_m, sweep_m, .. } = self.solids[index];
            if rect.center_m.y - reach_m - sweep_m > floor.height_m {
                continue;
            }
            let pair = (Surface::Block(index as u16), Surface::Floor);
            let material = match &floor.loss {
                Some(loss) => Material { impact_damping, ..Material::hard(floor.stiffness_n_m, 0.0, loss.mu) },
                None => Material::hard(floor.stiffness_n_m, floor.damping_n_s_m, floor.friction),
            };
            if block.shape == Shape::Needle {
                let point_m = rect.center_m - rect.axis_y() * rect.half_m.y;
                let depth_m = floor.height_m - point_m.y;
                if depth_m > -sweep_m {
                    self.add(&Found { pair, feature: 0, point_m, normal: up, depth_m }, &material);
                }
                continue;
            }
            for corner in 0..4_u8 {
                let point_m = rect.corner(corner);
                let depth_m = floor.height_m - point_m.y;
                if depth_m > -sweep_m {
                    self.add(&Found { pair, feature: corner, point_m, normal: up, depth_m }, &material);
                }
            }
        }
        for finger in 0..2_u8 {
            let tip = self.tips[usize::from(finger)];
            let depth_m = floor.height_m - tip.y;
            if depth_m > -self.tip_sweep_m[usize::from(finger)] {
                let pair = (Surface::Finger(finger), Surface::Floor);
                self.add(
                    &Found { pair, feature: 0, point_m: tip, normal: up, depth_m },
                    &pad_material(self.world, floor.friction),
                );
            }
        }
    }

    /// A plane that was measured: hard for blocks, in series with the pad for fingers.
    pub(super) fn plane(&mut self) {
        let Some(plane) = &self.world.plane else { return };
        let normal = plane.normal();
        let material = Material::hard(plane.stiffness_n_m, plane.damping_n_s_m, plane.friction);
        for (index, block) in self.world.blocks.iter().enumerate() {
            let Solid { rect, reach_m, sweep_m, .. } = self.solids[index];
            if plane.depth_m(rect.center_m) < -(reach_m + sweep_m) {
                continue;
            }
            let corners = if block.shape == Shape::Needle { 1 } else { 4 };
            for corner in 0..corners {
                let point = rect.center_m - rect.axis_y() * rect.half_m.y;
                let point_m = if block.shape == Shape::Needle { point } else { rect.corner(corner) };
                let depth_m = plane.depth_m(point_m);
                if depth_m > -sweep_m {
                    let pair = (Surface::Block(index as u16), Surface::Plane);
                    self.add(&Found { pair, feature: corner, point_m, normal, depth_m }, &material);
                }
            }
        }
        for finger in 0..2_u8 {
            let tip = self.tips[usize::from(finger)];
            let depth_m = plane.depth_m(tip);
            if depth_m > -self.tip_sweep_m[usize::from(finger)] {
                let pair = (Surface::Finger(finger), Surface::Plane);
                let mut pad = pad_material(self.world, plane.friction);
                pad.wall_n_m = plane.stiffness_n_m;
                self.add(&Found { pair, feature: 0, point_m: tip, normal, depth_m }, &pad);
            }
        }
    }
}
