//! What the scripted operator wants to do when: a list of minimum-jerk movements (Flash & Hogan 1985), made once.

use super::Skill;
use crate::Vec2;
use crate::world::{State, World};
use rand::RngExt;
use rand::rngs::StdRng;

/// Spare opening of the fingers around an object, m on both sides together.
const CLEARANCE_M: f64 = 0.006;
/// Height that objects are carried above what stands in the way, m.
const CARRY_HEIGHT_M: f64 = 0.012;

/// Where the pair of fingers is wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// Middle between the tips, m.
    pub center_m: Vec2,
    /// Distance between the tips, m.
    pub aperture_m: f64,
    /// Extra squeeze, N per finger.
    pub pinch_n: f64,
}

impl Goal {
    /// The goal that is fulfilled where the tips are.
    pub fn from_tips(tips: [Vec2; 2]) -> Self {
        Self { center_m: 0.5 * (tips[0] + tips[1]), aperture_m: tips[1].x - tips[0].x, pinch_n: 0.0 }
    }

    fn lerp(&self, to: &Self, share: f64) -> Self {
        Self {
            center_m: self.center_m + (to.center_m - self.center_m) * share,
            aperture_m: self.aperture_m + (to.aperture_m - self.aperture_m) * share,
            pinch_n: self.pinch_n + (to.pinch_n - self.pinch_n) * share,
        }
    }
}

/// One movement.
#[derive(Clone, Copy, Debug)]
enum Move {
    /// Straight, in minimum jerk.
    Reach { from: Goal, to: Goal },
    /// About a centre, in minimum jerk of the angle, pulling or pushing along the arm.
    Turn { center_m: Vec2, radius_m: f64, from_rad: f64, to_rad: f64, pull_m: f64, grasp: Goal },
}

#[derive(Clone, Copy, Debug)]
struct Phase {
    start_s: f64,
    end_s: f64,
    movement: Move,
}

/// The whole performance.
#[derive(Clone, Debug)]
pub struct Plan {
    phases: Vec<Phase>,
    current: usize,
}

impl Plan {
    /// Turn the crank if there is one, else unstack and restack the blocks, else look around.
    pub fn for_world(world: &World, state: &State, start: Goal, skill: Skill, rng: &mut StdRng) -> Self {
        let mut builder = Builder { phases: Vec::new(), now_s: 0.0, at: start, skill, rng };
        builder.wait(1.0);
        if world.crank.is_some() {
            builder.turn_crank(world, state);
        } else if world.blocks.is_empty() {
            builder.look_around(world);
        } else {
            builder.restack(world, state);
        }
        builder.wait(1.0);
        Self { phases: builder.phases, current: 0 }
    }

    /// Length, s.
    pub fn duration_s(&self) -> f64 {
        self.phases.last().map_or(0.0, |p| p.end_s)
    }

    /// Goal and its rate (per second; the rate's pinch is unused) at `now_s`, which must not go back.
    pub fn at(&mut self, now_s: f64) -> (Goal, Goal) {
        while self.current + 1 < self.phases.len() && now_s >= self.phases[self.current].end_s {
            self.current += 1;
        }
        let phase = &self.phases[self.current];
        let span_s = (phase.end_s - phase.start_s).max(1e-9);
        let u = ((now_s - phase.start_s) / span_s).clamp(0.0, 1.0);
        let share = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
        let rate = 30.0 * u * u * (1.0 - u) * (1.0 - u) / span_s;
        match phase.movement {
            Move::Reach { from, to } => {
                let rates = Goal {
                    center_m: (to.center_m - from.center_m) * rate,
                    aperture_m: (to.aperture_m - from.aperture_m) * rate,
                    pinch_n: 0.0,
                };
                (from.lerp(&to, share), rates)
            }
            Move::Turn { center_m, radius_m, from_rad, to_rad, pull_m, grasp } => {
                // A turn is steadier than a reach: blend minimum jerk with constant speed in the middle.
                let angle = from_rad + (to_rad - from_rad) * share;
                let (sin, cos) = angle.sin_cos();
                // The pull comes and goes over the turn: pushed as well as pulled, as exploration asks.
                let pull = pull_m * (0.35 + (std::f64::consts::PI * 3.0 * u).sin());
                let center = center_m + Vec2::new(cos, sin) * (radius_m + pull * (1.0 - (2.0 * u - 1.0).powi(8)));
                let speed = radius_m * (to_rad - from_rad) * rate;
                let rates = Goal { center_m: Vec2::new(-sin, cos) * speed, aperture_m: 0.0, pinch_n: 0.0 };
                (Goal { center_m: center, ..grasp }, rates)
            }
        }
    }
}

struct Builder<'a> {
    phases: Vec<Phase>,
    now_s: f64,
    at: Goal,
    skill: Skill,
    rng: &'a mut StdRng,
}

impl Builder<'_> {
    fn vary(&mut self, usual: f64, share: f64) -> f64 {
        usual * self.rng.random_range(1.0 - share..1.0 + share)
    }

    fn push(&mut self, usual_s: f64, movement: Move) {
        let span_s = self.vary(usual_s * self.skill.pace, 0.2);
        self.phases.push(Phase { start_s: self.now_s, end_s: self.now_s + span_s, movement });
        self.now_s += span_s;
    }

    fn reach(&mut self, usual_s: f64, to: Goal) {
        self.push(usual_s, Move::Reach { from: self.at, to });
        self.at = to;
    }

    fn wait(&mut self, usual_s: f64) {
        self.reach(usual_s, self.at);
    }

    fn look_around(&mut self, world: &World) {
        let workspace = world.hand.workspace;
        for corner in [(-0.5, 0.4), (0.5, 0.4), (0.5, -0.2), (-0.5, -0.2), (0.0, 0.0)] {
            let center_m = workspace.center_m + Vec2::new(corner.0, corner.1) * workspace.radius_m;
            self.reach(0.8, Goal { center_m, ..self.at });
        }
    }

    /// Moves a tower block by block to the other side of the middle, top first, so that it ends upside down.
    fn restack(&mut self, world: &World, state: &State) {
        let floor_m = world.floor.as_ref().map_or(state.bodies[0].center_m.y, |f| f.height_m);
        let mut order: Vec<usize> = (0..world.blocks.len()).collect();
        order.sort_by(|a, b| state.bodies[*b].center_m.y.total_cmp(&state.bodies[*a].center_m.y));
        let middle = world.hand.workspace.center_m.x;
        let from_x = state.bodies[order[0]].center_m.x;
        let to_x = middle + (middle - from_x) + self.rng.random_range(-0.001..0.001);
        let tower: f64 = world.blocks.iter().map(|b| b.height_m).sum();
        let clear_y = floor_m + tower + CARRY_HEIGHT_M;
        let mut base_y = floor_m;
        for index in order {
            let body = state.bodies[index].center_m;
            let block = &world.blocks[index];
            self.carry(body, block.width_m, Vec2::new(to_x, base_y + 0.5 * block.height_m), clear_y);
            base_y += block.height_m;
        }
    }

    fn carry(&mut self, from: Vec2, width_m: f64, to: Vec2, clear_y: f64) {
        let open = Goal { center_m: from, aperture_m: width_m + CLEARANCE_M, pinch_n: 0.0 };
        let grasp_dy = self.rng.random_range(-0.001..0.001);
        let up = |y: f64, goal: &Goal| Goal { center_m: Vec2::new(goal.center_m.x, y), ..*goal };
        self.reach(0.9, up(clear_y, &open));
        let around = Goal { center_m: from + Vec2::new(0.0, grasp_dy), ..open };
        self.reach(0.7, around);
        self.wait(0.2);
        let pinch_n = self.vary(self.skill.pinch_n, 0.25);
        let held = Goal { aperture_m: width_m, pinch_n, ..around };
        self.reach(0.5, held);
        // Leaning on it a little before lifting is what people do; it also separates holding from lifting.
        let lean_m = self.rng.random_range(0.0002..0.0006);
        let leaning = Goal { center_m: held.center_m - Vec2::new(0.0, lean_m), ..held };
        self.reach(0.25, leaning);
        self.wait(0.5);
        let carried = up(clear_y, &held);
        self.reach(0.8, carried);
        self.wait(0.3);
        let above = Goal { center_m: Vec2::new(to.x, clear_y), ..carried };
        self.reach(1.0, above);
        self.wait(0.3);
        let press_m = self.rng.random_range(0.0006..0.0012);
        let placed = Goal { center_m: to + Vec2::new(0.0, grasp_dy - press_m), ..above };
        self.reach(0.9, placed);
        self.wait(0.6);
        let released = Goal { aperture_m: width_m + CLEARANCE_M, pinch_n: 0.0, ..placed };
        self.reach(0.5, released);
        self.wait(0.2);
        self.reach(0.7, up(clear_y, &released));
    }

    fn turn_crank(&mut self, world: &World, state: &State) {
        let (Some(crank), Some(handle)) = (&world.crank, state.handle_in_world(world)) else { return };
        let open = Goal { center_m: handle, aperture_m: crank.handle_width_m + CLEARANCE_M, pinch_n: 0.0 };
        self.reach(1.0, open);
        self.wait(0.3);
        let pinch_n = self.vary(2.0 * self.skill.pinch_n, 0.2);
        let held = Goal { aperture_m: crank.handle_width_m, pinch_n, ..open };
        self.reach(0.5, held);
        self.wait(0.4);
        let turn = std::f64::consts::TAU;
        let mut angle = state.crank.angle_rad;
        for turns in [2.0, 1.25, -1.5, 0.25] {
            let to_rad = angle + turns * turn;
            let pull_m = self.rng.random_range(0.0008..0.0016);
            let movement = Move::Turn {
                center_m: crank.center_m,
                radius_m: crank.radius_m,
                from_rad: angle,
                to_rad,
                pull_m,
                grasp: held,
            };
            self.push(1.1 + 1.6 * turns.abs(), movement);
            angle = to_rad;
            let (sin, cos) = angle.sin_cos();
            self.at = Goal { center_m: crank.center_m + Vec2::new(cos, sin) * crank.radius_m, ..held };
            self.wait(0.3);
        }
        self.reach(0.5, Goal { aperture_m: crank.handle_width_m + 2.0 * CLEARANCE_M, pinch_n: 0.0, ..self.at });
    }
}
