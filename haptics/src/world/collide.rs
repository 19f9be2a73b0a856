//! Touching surfaces, or surfaces that may touch before the tick is over: found once a tick, in a fixed order.
//!
//! They are found for the middle of the tick with everything in unforced motion: lever arms and directions of that
//! moment hold for the whole tick to second order, those of its start only to first.

mod ground;

use super::block::Block;
use super::contact::{Material, Touch, meeting};
use super::contact_point::{Contact, Surface};
use super::driven::handle;
use super::fixed::{Fixed, cup_wall, switch_base};
use super::model::World;
use super::rect::{Rect, point_in_rect, rect_rect};
use super::scratch::{Scratch, Solid};
use super::state::{BodyState, Input, State};
use crate::Vec2;

/// Half the height of a flat finger pad, m: how far off its middle it still touches the crank's handle.
pub const PAD_HALF_HEIGHT_M: f64 = 0.008;

/// A finger that is no deeper than this has come through a surface just now, m.
const ARRIVAL_M: f64 = 0.1e-3;

/// Looks up the contacts of the tick before. Touches are found in the same order every tick, so that the search
/// continues at the end of the last one and mostly hits at once.
struct Memory<'a> {
    before: &'a [Contact],
    next: usize,
}

impl Memory<'_> {
    fn find(&mut self, wanted: impl Fn(&Contact) -> bool) -> Option<&Contact> {
        let count = self.before.len();
        let index = (self.next..count).chain(0..self.next.min(count)).find(|i| wanted(&self.before[*i]))?;
        self.next = index + 1;
        Some(&self.before[index])
    }
}

/// A place where two surfaces are near each other.
struct Found {
    pair: (Surface, Surface),
    feature: u8,
    point_m: Vec2,
    normal: Vec2,
    depth_m: f64,
}

/// Gathers touches with the memory of the tick before.
struct Gather<'a> {
    world: &'a World,
    tips: [Vec2; 2],
    /// Distance that each tip goes within the tick, m.
    tip_sweep_m: [f64; 2],
    memory: Memory<'a>,
    touches: &'a mut Vec<Touch>,
    /// Largest possible compression of a fingertip within the tick, m.
    deepest_pad_m: &'a mut f64,
    solids: &'a [Solid],
    /// The first tick: whatever touches has touched before.
    begins: bool,
    /// Additional slip in the fingers in this tick, m (see [`crate::law::contact::FingertipSlip`]).
    slipped_m: Vec2,
}

/// Fills the scratch space of `state`: outlines, masses and touches as they are now, with the tips on their way to `input`.
pub(super) fn collide(world: &World, state: &mut State, input: &Input, dt_s: f64) {
    let State {
        scratch: Scratch { touches, solids, arm, deepest_pad_m }, bodies, contacts, time_s, input: before, ..
    } = state;
    solids.clear();
    solids.extend(world.blocks.iter().zip(&*bodies).map(|(block, body)| solid(block, body, world.gravity_m_s2, dt_s)));
    touches.clear();
    let begins = state.tick == 0;
    *deepest_pad_m = 0.0;
    let tips = [0, 1].map(|f| 0.5 * (before.tip_in_world[f] + input.tip_in_world[f]));
    let slipped_m = world
        .pad
        .slip
        .map_or_else(Vec2::zeros, |slip| slip.displacement_m(*time_s + dt_s) - slip.displacement_m(*time_s));
    let tip_sweep_m = [0, 1].map(|f| (input.tip_in_world[f] - before.tip_in_world[f]).norm());
    let memory = Memory { before: contacts, next: 0 };
    let handle_m = world.crank.as_ref().map(|crank| handle(crank, &state.crank, arm));
    let mut gather = Gather { world, tips, tip_sweep_m, memory, touches, deepest_pad_m, solids, begins, slipped_m };
    gather.floor();
    gather.plane();
    gather.blocks();
    gather.fingers();
    let handle_sweep_m = state.crank.handle_velocity.norm() * dt_s;
    gather.driven(handle_m, handle_sweep_m, state.switch.at_m);
}

/// A body's outline in the middle of the tick, how far it may come within the tick, and its mass.
fn solid(block: &Block, body: &BodyState, gravity_m_s2: f64, dt_s: f64) -> Solid {
    let (sin, cos) =
        if block.keeps_upright() { (0.0, 1.0) } else { (body.angle_rad + 0.5 * dt_s * body.rate_rad_s).sin_cos() };
    let half_m = 0.5 * Vec2::new(block.width_m, block.height_m);
    let reach_m = half_m.norm();
    let speed = body.velocity_m_s.norm() + reach_m * body.rate_rad_s.abs() + gravity_m_s2.abs() * dt_s;
    let mass_kg = block.mass_kg - body.leaked_kg;
    let turns = !block.keeps_upright();
    Solid {
        rect: Rect { center_m: body.center_m + 0.5 * dt_s * body.velocity_m_s, half_m, axis_x: Vec2::new(cos, sin) },
        reach_m,
        sweep_m: speed * dt_s,
        inverse_mass: 1.0 / mass_kg,
        inverse_inertia: if turns { 12.0 / (mass_kg * 4.0 * half_m.norm_squared()) } else { 0.0 },
        force_n: Vec2::zeros(),
        moment_n_m: 0.0,
    }
}

impl Gather<'_> {
    /// Adds a touch with its memory of the tick before.
    fn add(&mut self, found: &Found, material: &Material) {
        // The buffer is sized for the densest packing. Should that ever be wrong, the tick continues without this
        // touch, because growing here would allocate in the servo.
        if self.touches.len() >= self.touches.capacity() {
            return;
        }
        let Found { pair: (on, by), feature, point_m, normal, depth_m } = *found;
        let before = self.memory.find(|c| (c.on, c.by) == (on, by) && c.feature == feature);
        let mut contact = meeting((on, by), feature, point_m, normal, depth_m);
        let met = before.is_some();
        if let Some(before) = before {
            (contact.shear_m, contact.normal_force_n, contact.met_m_s) =
                (before.shear_m, before.normal_force_n, before.met_m_s);
        }
        let (arm_on_m, yield_on) = self.lever(on, found);
        let (arm_by_m, yield_by) = self.lever(by, found);
        let mut yield_1_kg = yield_on + yield_by;
        // Only the damper of a measured restitution asks for it.
        let slip_yield_1_kg = if material.impact_damping == 0.0 {
            0.0
        } else {
            self.yields(on, arm_on_m.dot(&normal)) + self.yields(by, arm_by_m.dot(&normal))
        };
        if let Surface::Finger(finger) = on {
            // From the middle of the tick to its end.
            let body_m = if let Surface::Block(index) = by { self.solids[usize::from(index)].sweep_m } else { 0.0 };
            let reach_m = depth_m + 0.5 * (self.tip_sweep_m[usize::from(finger)] + body_m);
            *self.deepest_pad_m = self.deepest_pad_m.max(reach_m);
            contact.shear_m -= self.slipped_m.dot(&contact.tangent());
            yield_1_kg = 0.0;
        }
        let closing_m_s = f64::NAN;
        let material = *material;
        let touch = Touch { contact, arm_on_m, arm_by_m, material, yield_1_kg, slip_yield_1_kg, met, closing_m_s };
        self.touches.push(touch);
    }

    /// From the centre of a body to the point, m, and how fast the body yields to a normal force there, 1/kg.
    #[inline]
    fn lever(&self, surface: Surface, found: &Found) -> (Vec2, f64) {
        let Surface::Block(index) = surface else { return (Vec2::zeros(), 0.0) };
        let solid = &self.solids[usize::from(index)];
        let arm_m = found.point_m - solid.rect.center_m;
        (arm_m, self.yields(surface, arm_m.perp(&found.normal)))
    }

    /// Mobility of a body under a force that passes its centre at this distance, m: its acceleration per force, 1/kg.
    #[inline]
    fn yields(&self, surface: Surface, passes_m: f64) -> f64 {
        let Surface::Block(index) = surface else { return 0.0 };
        let solid = &self.solids[usize::from(index)];
        solid.inverse_mass + solid.inverse_inertia * passes_m * passes_m
    }

    fn blocks(&mut self) {
        let solids = self.solids;
        for (i, a) in solids.iter().enumerate() {
            for (j, b) in solids.iter().enumerate().skip(i + 1) {
                let margin_m = a.sweep_m + b.sweep_m;
                let near = a.reach_m + b.reach_m + margin_m;
                if (a.rect.center_m - b.rect.center_m).norm_squared() > near * near {
                    continue;
                }
                let Some((normal, points)) = rect_rect(&a.rect, &b.rect, margin_m) else { continue };
                let material = block_material(&self.world.blocks[i], &self.world.blocks[j]);
                let pair = (Surface::Block(i as u16), Surface::Block(j as u16));
                for (point_m, depth_m, feature) in points.into_iter().flatten() {
                    self.add(&Found { pair, feature, point_m, normal, depth_m }, &material);
                }
            }
        }
    }

    fn fingers(&mut self) {
        for finger in 0..2_u8 {
            let tip = self.tips[usize::from(finger)];
            let tip_sweep_m = self.tip_sweep_m[usize::from(finger)];
            for (index, block) in self.world.blocks.iter().enumerate() {
                let Solid { rect, reach_m, sweep_m, .. } = self.solids[index];
                let margin_m = tip_sweep_m + sweep_m;
                let near = reach_m + margin_m;
                if (rect.center_m - tip).norm_squared() > near * near {
                    continue;
                }
                let pair = (Surface::Finger(finger), Surface::Block(index as u16));
                let kept = self.kept(pair);
                let Some((face, depth_m)) = point_in_rect(&rect, tip, kept, margin_m) else { continue };
                let mut material = pad_material(self.world, block.finger_friction);
                material.wall_n_m = block.wall.map_or(0.0, |wall| wall.stiffness_n_m);
                self.add(&Found { pair, feature: face, point_m: tip, normal: rect.face(face).0, depth_m }, &material);
            }
        }
        self.sheet();
        self.fixed();
    }

    /// A finger on the membrane: it is blunt and pierces nothing. A finger that came from above stays on the sheet
    /// until it lets go, so that the force depends on the depth alone; from the side or from below nothing is felt.
    fn sheet(&mut self) {
        let Some(membrane) = &self.world.membrane else { return };
        for finger in 0..2_u8 {
            let tip = self.tips[usize::from(finger)];
            let pair = (Surface::Finger(finger), Surface::Membrane);
            let depth_m = membrane.center_m.y - tip.y;
            let sweep_m = self.tip_sweep_m[usize::from(finger)];
            let held = self.kept(pair).is_some();
            let over_it = (tip.x - membrane.center_m.x).abs() < membrane.half_width_m;
            let arrives = over_it && depth_m > -sweep_m && depth_m < sweep_m + ARRIVAL_M;
            if held || arrives {
                let mut material = pad_material(self.world, self.world.floor.map_or(0.5, |f| f.friction));
                material.wall_n_m = membrane.law.stiffness_n_m;
                self.add(&Found { pair, feature: 0, point_m: tip, normal: Vec2::new(0.0, 1.0), depth_m }, &material);
            }
        }
    }

    /// Fingers on fixed objects. A finger that pushes the sheet down is inside of the cup and does not meet its wall.
    fn fixed(&mut self) {
        let (cup, base) = (self.world.membrane.as_ref().zip(self.world.floor.as_ref()), self.world.switch.as_ref());
        for finger in 0..2_u8 {
            let tip = self.tips[usize::from(finger)];
            let sweep_m = self.tip_sweep_m[usize::from(finger)];
            let on = Surface::Finger(finger);
            if let Some((membrane, floor)) = cup
                && self.kept((on, Surface::Membrane)).is_none()
            {
                let kept = self.kept((on, Surface::Cup));
                let wall = cup_wall(membrane, floor.height_m, tip, kept, (sweep_m, sweep_m + ARRIVAL_M));
                self.stand((on, Surface::Cup), tip, wall.as_ref());
            }
            if let Some(switch) = base {
                let kept = self.kept((on, Surface::Base));
                let base = switch_base(switch, tip, kept, sweep_m);
                self.stand((on, Surface::Base), tip, base.as_ref());
            }
        }
    }

    /// The face on which a pair pressed in the tick before.
    fn kept(&mut self, pair: (Surface, Surface)) -> Option<u8> {
        let feature = self.memory.find(|c| (c.on, c.by) == pair).map(|c| c.feature)?;
        // Start again at this pair: its contact is the next to be asked for.
        self.memory.next = self.memory.next.saturating_sub(1);
        Some(feature)
    }

    fn stand(&mut self, pair: (Surface, Surface), point_m: Vec2, found: Option<&Fixed>) {
        let Some(&Fixed { feature, normal, depth_m }) = found else { return };
        let material = pad_material(self.world, self.world.floor.map_or(0.5, |f| f.friction));
        self.add(&Found { pair, feature, point_m, normal, depth_m }, &material);
    }

    /// Fingers on the driven handle and knob. Depth and normal are found again in each part of the tick, because these
    /// surfaces move on curves.
    fn driven(&mut self, handle_m: Option<Vec2>, handle_sweep_m: f64, knob_at_m: f64) {
        if let (Some(crank), Some(handle)) = (&self.world.crank, handle_m) {
            for finger in 0..2_u8 {
                let tip = self.tips[usize::from(finger)];
                let pair = (Surface::Finger(finger), Surface::Handle);
                // The left pad faces right, the right pad faces left.
                let facing = if finger == 0 { 1.0 } else { -1.0 };
                let held = self.kept(pair).is_some();
                let level = (tip.y - handle.y).abs() < PAD_HALF_HEIGHT_M + 0.5 * crank.handle_width_m;
                let depth_m = facing * (tip.x - handle.x) + 0.5 * crank.handle_width_m;
                // A finger that comes down on it from above does not press on its side: that would be a blow out of
                // nothing.
                let arrives = depth_m < self.tip_sweep_m[usize::from(finger)] + handle_sweep_m + ARRIVAL_M;
                if level && (held || arrives || self.begins) {
                    let found = Found { pair, feature: 0, point_m: tip, normal: Vec2::new(-facing, 0.0), depth_m };
                    self.add(&found, &pad_material(self.world, crank.finger_friction));
                }
            }
        }
        if let Some(switch) = &self.world.switch {
            let knob = switch.knob_in_world(knob_at_m);
            for finger in 0..2_u8 {
                let tip = self.tips[usize::from(finger)];
                let away = tip - knob;
                let distance = away.norm();
                // Twice the radius: near enough to come to it within a tick, and a tip in the very middle has no side.
                if distance > 1e-9 && distance < 2.0 * switch.knob_radius_m {
                    let pair = (Surface::Finger(finger), Surface::Knob);
                    let depth_m = switch.knob_radius_m - distance;
                    let found = Found { pair, feature: 0, point_m: tip, normal: away / distance, depth_m };
                    self.add(&found, &pad_material(self.world, switch.finger_friction));
                }
            }
        }
    }
}

fn pad_material(world: &World, friction: f64) -> Material {
    Material {
        elastic: world.pad.elastic(),
        damping_n_s_m: world.pad.damping_n_s_m,
        impact_damping: 0.0,
        shear_stiffness_n_m: world.pad.shear_stiffness_n_m,
        shear_damping_n_s_m: world.pad.shear_damping_n_s_m,
        friction,
        wall_n_m: 0.0,
    }
}

fn block_material(a: &Block, b: &Block) -> Material {
    // Two surfaces in series; friction as the geometric mean, the usual choice when only single surfaces are known.
    let series = |x: f64, y: f64| if x + y > 0.0 { x * y / (x + y) } else { 0.0 };
    Material::hard(
        series(a.stiffness_n_m, b.stiffness_n_m),
        series(a.damping_n_s_m, b.damping_n_s_m),
        (a.block_friction * b.block_friction).sqrt(),
    )
}
