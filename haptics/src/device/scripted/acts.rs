//! Acts that an operator is told to do, one after the other: lessons write their demonstrations as such a list.

use super::builder::{Builder, SPARE_PINCH};
use super::movement::{Goal, Job, Spin};
use crate::Vec2;
use crate::device::impedance::HandImpedance;
use crate::world::{Block, Shape, State, World};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Spare opening of the fingers around an object, m on both sides together.
const CLEARANCE_M: f64 = 0.006;
/// Height that objects are carried above any obstacle, m.
const CARRY_HEIGHT_M: f64 = 0.012;
/// Modulation of the speed of an even turn by a steady hand, relative.
const UNEVENNESS: f64 = 0.03;
/// A turn comes to its speed in this time, s.
const RAMP_S: f64 = 0.6;

/// One thing to do. Lengths are in m, forces in N of each finger, in the world's frame.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Act {
    /// Presses both fingers on the table for some time.
    Press {
        /// How hard, N.
        force_n: f64,
        /// How long, s.
        seconds: f64,
    },
    /// Pinches a block where it stands, for some time.
    Squeeze {
        /// Its name.
        block: String,
        /// How hard, N.
        force_n: f64,
        /// How long, s.
        seconds: f64,
    },
    /// Lifts a block, holds it up for some time and puts it back.
    Lift {
        /// Its name.
        block: String,
        /// How high, m.
        height_m: f64,
        /// How long, s.
        seconds: f64,
    },
    /// Carries a block to another place.
    Carry {
        /// Its name.
        block: String,
        /// Where its middle goes, m to the right.
        x_m: f64,
        /// The block that it is put on; absent: the table.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        on: Option<String>,
    },
    /// Turns the crank at an even speed.
    Turn {
        /// How many turns, positive counter-clockwise.
        turns: f64,
        /// Time of one turn, s.
        turn_s: f64,
    },
    /// Takes the needle and pushes it through the sheet.
    Pierce {
        /// Where, m from the middle of the sheet to the right.
        along_m: f64,
        /// How far the hand goes beyond the depth at which the sheet gives way, m.
        beyond_m: f64,
    },
    /// Weighs the barrel, finds out what holds it, squeezes its wall, and puts it back.
    Examine,
    /// Pushes the switch over, so many times, to and fro.
    Throw {
        /// How many times.
        times: usize,
    },
}

impl Act {
    /// Requirement of the act that the world does not meet, in one sentence; `None` if the act is possible.
    pub fn lacks(&self, world: &World) -> Option<String> {
        let missing = |name: &str| (block(world, name).is_none()).then(|| format!("there is no block `{name}`"));
        let without = |there: bool, what: &str| (!there).then(|| format!("there is no {what}"));
        match self {
            Self::Press { .. } => without(world.floor.is_some(), "table to press on"),
            Self::Squeeze { block, .. } | Self::Lift { block, .. } => missing(block),
            Self::Carry { block, on, .. } => missing(block)
                .or_else(|| on.as_ref().and_then(|on| missing(on)))
                .or_else(|| without(on.is_some() || world.floor.is_some(), "table to put the block on")),
            Self::Turn { .. } => without(world.crank.is_some(), "crank"),
            Self::Pierce { .. } => {
                without(world.membrane.is_some() && shaped(world, Shape::Needle), "needle with its sheet")
            }
            Self::Examine => without(shaped(world, Shape::Barrel), "barrel"),
            Self::Throw { .. } => without(world.switch.is_some(), "switch"),
        }
    }

    /// First number outside its possible range, in one sentence; `None` if all are within range.
    pub fn wrong(&self) -> Option<String> {
        let within = |name: &str, value: f64, least: f64, most: f64| {
            (!(least..=most).contains(&value)).then(|| format!("`{name}` is {value}, not between {least} and {most}"))
        };
        match self {
            Self::Press { force_n, seconds } | Self::Squeeze { force_n, seconds, .. } => {
                within("force_n", *force_n, 0.0, 12.0).or_else(|| within("seconds", *seconds, 0.0, 60.0))
            }
            Self::Lift { height_m, seconds, .. } => {
                within("height_m", *height_m, 0.0, 0.2).or_else(|| within("seconds", *seconds, 0.0, 60.0))
            }
            Self::Carry { x_m, .. } => within("x_m", *x_m, -1.0, 1.0),
            Self::Turn { turns, turn_s } => {
                within("turns", *turns, -50.0, 50.0).or_else(|| within("turn_s", *turn_s, 0.2, 60.0))
            }
            Self::Pierce { along_m, beyond_m } => {
                within("along_m", *along_m, -0.1, 0.1).or_else(|| within("beyond_m", *beyond_m, -0.05, 0.05))
            }
            Self::Throw { times } => within("times", *times as f64, 1.0, 50.0),
            Self::Examine => None,
        }
    }
}

fn block<'a>(world: &'a World, name: &str) -> Option<(usize, &'a Block)> {
    world.blocks.iter().enumerate().find(|(_, block)| block.name == name)
}

fn shaped(world: &World, shape: Shape) -> bool {
    world.blocks.iter().any(|block| block.shape == shape)
}

/// Predicted places of the objects after the acts so far.
pub(super) struct Places<'a> {
    world: &'a World,
    state: &'a State,
    centers_m: Vec<Vec2>,
    angle_rad: f64,
}

impl<'a> Places<'a> {
    pub fn new(world: &'a World, state: &'a State) -> Self {
        let centers_m = state.bodies.iter().map(|body| body.center_m).collect();
        Self { world, state, centers_m, angle_rad: state.crank.angle_rad }
    }

    /// Height at which a block's middle is above everything.
    fn clear_y_m(&self, index: usize) -> f64 {
        let top = |(k, at): (usize, &Vec2)| at.y + 0.5 * self.world.blocks[k].height_m;
        let others = self.centers_m.iter().enumerate().filter(|(k, _)| *k != index).map(top);
        others.fold(self.centers_m[index].y, f64::max) + 0.5 * self.world.blocks[index].height_m + CARRY_HEIGHT_M
    }

    /// A carried block as a job, and where it is taken from; nothing where it cannot be done.
    fn job(&mut self, act: &Act, builder: &mut Builder<'_>) -> Option<(Job, Vec2)> {
        let (name, to_m, lifted) = match act {
            Act::Lift { block: name, height_m, seconds } => {
                let at = *self.centers_m.get(block(self.world, name)?.0)?;
                (name, at, Some((at.y + height_m, *seconds)))
            }
            Act::Carry { block: name, x_m, on } => {
                let (_, carried) = block(self.world, name)?;
                let base_m = match on {
                    Some(on) => {
                        let (below, shape) = block(self.world, on)?;
                        self.centers_m.get(below)?.y + 0.5 * shape.height_m
                    }
                    None => self.world.floor?.height_m,
                };
                (name, Vec2::new(*x_m, base_m + 0.5 * carried.height_m), None)
            }
            _ => return None,
        };
        let (index, _) = block(self.world, name)?;
        let from = *self.centers_m.get(index)?;
        let beside_m = if lifted.is_some() { 0.0 } else { builder.scatter_m() };
        let to_m = to_m + Vec2::new(beside_m, 0.0);
        let mut job = Job::new(self.world, index, to_m, lifted.map_or_else(|| self.clear_y_m(index), |(y, _)| y));
        job.above_y_m = job.clear_y_m.max(from.y + 0.5 * self.world.blocks[index].height_m + 0.5 * CARRY_HEIGHT_M);
        job.hold_s = Some(lifted.map_or(0.0, |(_, seconds)| seconds));
        self.centers_m[index] = to_m;
        Some((job, from))
    }
}

impl Builder<'_> {
    /// Does one act; blocks that are carried become jobs, which are done again when they are lost.
    pub(super) fn act(&mut self, act: &Act, places: &mut Places<'_>, jobs: &mut Vec<Job>) {
        let (world, state) = (places.world, places.state);
        match act {
            Act::Press { force_n, seconds } => self.press(world, *force_n, *seconds),
            Act::Squeeze { block: name, force_n, seconds } => {
                let Some((index, shape)) = block(world, name) else { return };
                self.squeeze(places.centers_m[index], shape.width_m, *force_n, *seconds);
            }
            Act::Lift { .. } | Act::Carry { .. } => {
                let Some((job, from)) = places.job(act, self) else { return };
                jobs.push(job);
                self.carry(jobs.len() - 1, &job, from, job.width_m);
            }
            Act::Turn { turns, turn_s } => places.angle_rad = self.spin(world, places.angle_rad, *turns, *turn_s),
            Act::Pierce { along_m, beyond_m } => self.pierce_at(world, state, *along_m, *beyond_m),
            Act::Examine => self.examine_barrel(world, state, &[]),
            Act::Throw { times } => self.throw_switch(world, state, *times),
        }
    }

    /// Both fingers on the table: the arms' springs press as they are wanted below it.
    fn press(&mut self, world: &World, force_n: f64, seconds: f64) {
        let Some(floor) = &world.floor else { return };
        let above =
            Goal { center_m: Vec2::new(self.at().center_m.x, floor.height_m + 0.006), pinch_n: 0.0, ..self.at() };
        self.aim(0.9, above);
        self.wait(0.2);
        let force_n = self.choose_pinch(force_n, 0.1);
        let give_m = force_n / HandImpedance::default().stiffness_n_m + force_n / world.pad.stiffness_n_m;
        let pressed = Goal { center_m: Vec2::new(above.center_m.x, floor.height_m - give_m), ..above };
        self.reach(0.9, pressed);
        self.hold(seconds);
        self.reach(0.6, Goal { center_m: above.center_m + Vec2::new(0.0, 0.010), ..above });
    }

    fn squeeze(&mut self, at: Vec2, width_m: f64, force_n: f64, seconds: f64) {
        let open = Goal { center_m: at, aperture_m: width_m + CLEARANCE_M, pinch_n: 0.0 };
        self.aim(0.9, Goal { center_m: at + Vec2::new(0.0, 0.015), ..open });
        self.reach(0.7, open);
        self.wait(0.2);
        let pinch_n = self.choose_pinch(force_n, 0.1);
        self.reach(0.8, Goal { aperture_m: width_m, pinch_n, ..open });
        self.hold(seconds);
        self.reach(0.5, open);
        self.reach(0.7, Goal { center_m: at + Vec2::new(0.0, 0.015), ..open });
    }

    /// Takes the handle, turns it at an even speed, and lets go. Returns the angle at the end, rad.
    fn spin(&mut self, world: &World, from_rad: f64, turns: f64, turn_s: f64) -> f64 {
        let Some(crank) = &world.crank else { return from_rad };
        let on_circle = |angle: f64| crank.center_m + Vec2::new(angle.cos(), angle.sin()) * crank.radius_m;
        let open = Goal { center_m: on_circle(from_rad), aperture_m: crank.handle_width_m + CLEARANCE_M, pinch_n: 0.0 };
        self.aim(1.0, open);
        self.wait(0.3);
        let pinch_n = self.choose_pinch(SPARE_PINCH * self.skill().pinch_n, 0.1);
        let grasp = Goal { aperture_m: crank.handle_width_m, pinch_n, ..open };
        self.reach(0.5, grasp);
        self.wait(0.3);
        let to_rad = from_rad + turns * TAU;
        let span_s = turns.abs() * turn_s * self.skill().pace + RAMP_S;
        let uneven = UNEVENNESS * self.skill().wander.powi(2);
        let pull_m = 0.4 * self.skill().aim_error_m * self.between(0.8, 1.2) + 0.0003;
        let waves = [(); 2].map(|()| (self.between(0.4, 1.6), self.between(0.0, TAU)));
        self.turn_evenly(
            Spin {
                center_m: crank.center_m,
                radius_m: crank.radius_m,
                from_rad,
                to_rad,
                ramp_s: RAMP_S,
                pull_m,
                uneven,
                waves,
                grasp,
            },
            span_s,
            on_circle(to_rad),
        );
        self.wait(0.2);
        self.reach(0.4, Goal { aperture_m: crank.handle_width_m + 2.0 * CLEARANCE_M, pinch_n: 0.0, ..self.at() });
        // Up and away: a handle that swings back would come to rest on a finger.
        self.reach(0.7, Goal { center_m: self.at().center_m + Vec2::new(0.0, 0.030), ..self.at() });
        to_rad
    }

    /// Takes the needle out of its place and pierces the sheet once.
    fn pierce_at(&mut self, world: &World, state: &State, along_m: f64, beyond_m: f64) {
        let Some((held, [point_below_m, grip])) = self.take_needle(world, state) else { return };
        let Some(membrane) = &world.membrane else { return };
        let at = |point: Vec2| Goal { center_m: point + point_below_m + grip, ..held };
        let target = membrane.center_m + Vec2::new(along_m + self.scatter_m(), 0.0);
        let above = target + Vec2::new(0.0, 0.004);
        self.aim(0.9, at(above));
        self.wait(0.4);
        let beyond_m = beyond_m + self.scatter_m().abs();
        self.reach(2.6, at(target - Vec2::new(0.0, Self::piercing_depth_m(membrane) + beyond_m)));
        self.wait(0.6);
        self.reach(1.8, at(above));
        self.wait(0.3);
        self.reach(0.5, Goal { pinch_n: 0.0, ..self.at() });
    }
}

impl Spin {
    /// Angle and its rate at `time_s` of `span_s`: a soft start, an even middle with the hand's own waves, a soft end.
    pub(super) fn at(&self, time_s: f64, span_s: f64) -> (f64, f64) {
        let way = self.to_rad - self.from_rad;
        let ramp_s = self.ramp_s.min(0.5 * span_s);
        let speed = way / (span_s - ramp_s);
        // Smooth-step of the speed: its integral is u³ − u⁴/2.
        let started = |t: f64| {
            let u = (t / ramp_s).clamp(0.0, 1.0);
            let gone = ramp_s * (u.powi(3) - 0.5 * u.powi(4)) + (t - ramp_s).max(0.0);
            (gone, u * u * (3.0 - 2.0 * u))
        };
        let t = time_s.clamp(0.0, span_s);
        let ((gone, share), (left, share_left)) = (started(t), started(span_s - t));
        let in_first_half = t < 0.5 * span_s;
        let (even, even_rate) =
            if in_first_half { (speed * gone, speed * share) } else { (way - speed * left, speed * share_left) };
        let window = (share * share_left).powi(2);
        let (mut beside, mut beside_rate) = (0.0, 0.0);
        for (hertz, phase) in self.waves {
            let w = TAU * hertz;
            let amplitude = self.uneven * speed / w;
            beside += window * amplitude * (w * t + phase).sin();
            beside_rate += window * amplitude * w * (w * t + phase).cos();
        }
        (self.from_rad + even + beside, even_rate + beside_rate)
    }

    /// Goal of the hand, and its rate.
    pub(super) fn goal(&self, time_s: f64, span_s: f64) -> (Goal, Goal) {
        let (angle, rate) = self.at(time_s, span_s);
        let (sin, cos) = angle.sin_cos();
        // A badly aimed hand pulls off the circle, the same way all round.
        let share = (FRAC_PI_2 * 2.0 * (time_s / span_s.max(1e-9)).clamp(0.0, 1.0)).sin();
        let center_m = self.center_m + Vec2::new(cos, sin) * (self.radius_m + self.pull_m * share);
        let rates = Goal { center_m: Vec2::new(-sin, cos) * (self.radius_m * rate), aperture_m: 0.0, pinch_n: 0.0 };
        (Goal { center_m, ..self.grasp }, rates)
    }
}
