//! Warnings of imminent faults: too much force, a blow, the edge of the hand's reach.

use super::collision::{self, Collision};
use haptics::Vec2;
use haptics::world::{State, World};
use serde::Serialize;

/// Forces from this share of the limit on are near it.
const NEAR_FORCE: f64 = 0.8;
/// Distance from the edge of the workspace from which it is near, m.
const NEAR_EDGE_M: f64 = 0.008;
/// Time to the edge from which it is near, s.
const EDGE_SOON_S: f64 = 0.35;
/// Standard error of a force and of a place by good sensors (strain gauges, encoders of the master hand): N and m.
const FORCE_ERROR_N: f64 = 0.01;
const PLACE_ERROR_M: f64 = 2e-4;

/// Limits of the operator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// The most that a finger should press, N.
    pub limit_n: f64,
    /// Age of the picture, s.
    pub late_s: f64,
}

/// One thing to look out for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Warning {
    /// A finger presses nearly as much as allowed, or more.
    Force {
        /// 0 left, 1 right.
        finger: usize,
        /// N, and its standard error.
        force_n: (f64, f64),
        /// N.
        limit_n: f64,
        /// Surely above it: by more than two standard errors.
        over: bool,
    },
    /// Something will be hit.
    Collision(Collision),
    /// A finger comes to the edge of where it can go.
    Edge {
        /// 0 left, 1 right.
        finger: usize,
        /// Remaining distance, m, and its standard error; negative beyond the edge.
        left_m: (f64, f64),
        /// Nearest point of the edge, m in the world.
        at_m: Vec2,
    },
}

/// The warnings of one moment, at most one of each kind.
pub type Warnings = Vec<Warning>;

/// Present warnings.
pub fn warnings(world: &World, state: &State, load: &Load) -> Warnings {
    let force =
        (0..2).filter_map(|finger| too_hard(state, load, finger)).max_by(|a, b| strength(a).total_cmp(&strength(b)));
    let edge = (0..2).filter_map(|finger| edge(world, state, finger)).min_by(|a, b| room(a).total_cmp(&room(b)));
    let blow = collision::next(world, state, load.late_s, PLACE_ERROR_M).map(Warning::Collision);
    [force, blow, edge].into_iter().flatten().collect()
}

fn strength(warning: &Warning) -> f64 {
    if let Warning::Force { force_n, .. } = warning { force_n.0 } else { 0.0 }
}

fn room(warning: &Warning) -> f64 {
    if let Warning::Edge { left_m, .. } = warning { left_m.0 } else { f64::INFINITY }
}

fn too_hard(state: &State, load: &Load, finger: usize) -> Option<Warning> {
    let force = state.tip_force_n[finger].norm();
    let limit_n = load.limit_n;
    let warning = Warning::Force {
        finger,
        force_n: (force, FORCE_ERROR_N),
        limit_n,
        over: force > limit_n + 2.0 * FORCE_ERROR_N,
    };
    (limit_n > 0.0 && force > NEAR_FORCE * limit_n).then_some(warning)
}

fn edge(world: &World, state: &State, finger: usize) -> Option<Warning> {
    let workspace = world.hand.workspace;
    let tip = state.input.tip_in_world[finger];
    let left_m = workspace.margin_m(tip);
    let outward = (tip - workspace.center_m).try_normalize(1e-9)?;
    let speed = state.input.tip_velocity[finger].dot(&outward);
    let near = left_m < NEAR_EDGE_M || (speed > 0.0 && left_m < speed * EDGE_SOON_S);
    let at_m = workspace.center_m + outward * workspace.radius_m;
    near.then_some(Warning::Edge { finger, left_m: (left_m, PLACE_ERROR_M), at_m })
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::world::presets;

    const LOAD: Load = Load { limit_n: 3.0, late_s: 0.0 };

    #[test]
    fn a_hard_grip_is_near_the_limit_and_then_surely_over_it() {
        let world = presets::stacking();
        let mut state = State::resting(&world);
        let told =
            |state: &State| warnings(&world, state, &LOAD).into_iter().find(|w| matches!(w, Warning::Force { .. }));
        state.tip_force_n = [Vec2::new(2.0, 0.0), Vec2::new(-2.0, 0.0)];
        assert_eq!(told(&state), None);
        state.tip_force_n[1].x = -2.6;
        assert!(matches!(told(&state), Some(Warning::Force { finger: 1, over: false, .. })));
        state.tip_force_n[0].x = 3.1;
        assert!(matches!(told(&state), Some(Warning::Force { finger: 0, over: true, .. })));
    }

    #[test]
    fn the_edge_is_told_when_near_or_soon_and_never_in_the_middle() {
        let world = presets::stacking();
        let workspace = world.hand.workspace;
        let mut state = State::resting(&world);
        let told =
            |state: &State| warnings(&world, state, &LOAD).into_iter().find(|w| matches!(w, Warning::Edge { .. }));
        state.input.tip_in_world = [workspace.center_m; 2];
        assert_eq!(told(&state), None);
        state.input.tip_in_world[0] = workspace.center_m + Vec2::new(-workspace.radius_m + 0.03, 0.0);
        assert_eq!(told(&state), None);
        state.input.tip_velocity[0] = Vec2::new(-0.12, 0.0);
        assert!(matches!(told(&state), Some(Warning::Edge { finger: 0, .. })));
        state.input.tip_velocity[0] = Vec2::new(0.12, 0.0);
        assert_eq!(told(&state), None);
        state.input.tip_in_world[1] = workspace.center_m + Vec2::new(workspace.radius_m - 0.004, 0.0);
        assert!(
            matches!(told(&state), Some(Warning::Edge { finger: 1, left_m: (left, _), .. }) if (left - 0.004).abs() < 1e-9)
        );
    }
}
