//! What the 3-D view of a recording shows: the hand at the cursor, the world with its bodies, path, forces, constraints.

use crate::ui::prepare::Prepared;
use crate::ui::session::Session;
use estimator::estimate::{Constraint, ConstraintKind};
use haptics::Vec2;
use haptics::world::{State, World};
use render::{Camera, ColorRole, ConstraintMarker, FingerStyle, ForceVector, Trajectory, ViewOptions};
use std::sync::Arc;

/// Force vectors drawn along a path.
const VECTORS: usize = 48;

/// The world that stands behind a recording: the fitted one, else an empty table with the recording's hand.
pub fn scene_world(session: &Session, prepared: &Prepared) -> Arc<World> {
    if let Some(analysis) = &session.analysis
        && prepared.tips.is_some()
    {
        return Arc::new(analysis.world.clone());
    }
    let mut world = World::empty("Recording");
    world.hand = prepared.recording.meta.hand();
    if prepared.tips.is_none() {
        world.floor = None;
    }
    Arc::new(world)
}

/// State and options at the cursor.
pub fn options_for(session: &Session, prepared: &Prepared, world: &World) -> (State, ViewOptions) {
    let sample = prepared.sample_at(session.cursor_s);
    let mut state = State::resting(world);
    let mut options = ViewOptions::default();
    if let Some(tips) = &prepared.tips {
        for (finger, tip) in tips.iter().enumerate() {
            state.input.tip_in_world[finger] = tip.position[sample];
            state.tip_force_n[finger] = tip.force.as_ref().map_or_else(Vec2::zeros, |f| f[sample]);
        }
        if let Some(film) = session.replay().and_then(|r| r.film.as_ref()) {
            film.pose(session.cursor_s, &mut state);
        }
        options.show_contacts = session.layers.contacts;
    } else if let Some(tool) = &prepared.tool {
        options.fingers = FingerStyle::Tool;
        options.show_workspace = false;
        state.input.tip_in_world[0] = tool.position[sample];
        state.tip_force_n[0] = tool.force.as_ref().map_or_else(Vec2::zeros, |f| f[sample]);
        options.force_scale_m_per_n = force_scale(prepared);
    }
    if session.layers.path {
        options.trajectories = trajectories(session, prepared);
    }
    if session.layers.forces_on_path {
        options.force_vectors = force_vectors(session, prepared);
    }
    if session.layers.constraints {
        options.constraints = markers(session, prepared);
    }
    (state, options)
}

/// The camera that shows a recording whole, with a centre of rotation that is not far away.
pub fn camera_for(session: &Session, prepared: &Prepared) -> Camera {
    match bounds(prepared) {
        Some((mut low, mut high)) if prepared.tool.is_some() => {
            let extent = (high - low).norm();
            for marker in markers(session, prepared) {
                if let ConstraintMarker::Revolute { center_m, radius_m, .. } = marker
                    && radius_m < 1.5 * extent
                {
                    (low, high) = (low.inf(&center_m), high.sup(&center_m));
                }
            }
            let [low, high] = [low, high].map(|v| [v.x as f32, v.y as f32]);
            Camera { pitch_rad: 0.0, ..Camera::hand() }.framing(low.into(), high.into())
        }
        _ => Camera::workspace(),
    }
}

fn bounds(prepared: &Prepared) -> Option<(Vec2, Vec2)> {
    let points = prepared.path_samples.iter().filter_map(|i| prepared.point_at(*i));
    points.fold(None, |so_far, p| {
        let (low, high) = so_far.unwrap_or((p, p));
        Some((low.inf(&p), high.sup(&p)))
    })
}

/// Arrows of the usual force are a seventh of the path's extent.
fn force_scale(prepared: &Prepared) -> f32 {
    let extent = bounds(prepared).map_or(0.1, |(low, high)| (high - low).amax()).max(0.01);
    let mut sizes: Vec<f64> =
        prepared.path_samples.iter().filter_map(|i| Some(prepared.force_at(*i)?.norm())).collect();
    let usual = estimator::segment::threshold::percentile(&mut sizes, 0.9).max(1e-3);
    (0.15 * extent / usual) as f32
}

/// Samples of the path inside the plots' time window.
fn window(session: &Session, prepared: &Prepared) -> Vec<usize> {
    let (from, to) = session.view_s;
    let visible = |i: &&usize| prepared.times[**i] >= from && prepared.times[**i] <= to;
    prepared.path_samples.iter().filter(visible).copied().collect()
}

fn trajectories(session: &Session, prepared: &Prepared) -> Vec<Trajectory> {
    let samples = window(session, prepared);
    let curve = |points_m: Vec<Vec2>, role, width_px| Trajectory { points_m, role, width_px, dashed: false };
    let turns = session.analysis.as_ref().is_some_and(|a| a.world.crank.is_some());
    match &prepared.tips {
        Some(tips) if !turns => (0..2)
            .map(|f| curve(samples.iter().map(|i| tips[f].position[*i]).collect(), ColorRole::Finger(f), 1.2))
            .collect(),
        _ => {
            let points = samples.iter().filter_map(|i| prepared.point_at(*i)).collect();
            vec![curve(points, ColorRole::Measured, 1.6)]
        }
    }
}

fn force_vectors(session: &Session, prepared: &Prepared) -> Vec<ForceVector> {
    let samples = window(session, prepared);
    let every = samples.len().div_ceil(VECTORS).max(1);
    let vector = |i: &usize| {
        Some(ForceVector { at_m: prepared.point_at(*i)?, force_n: prepared.force_at(*i)?, role: ColorRole::Simulated })
    };
    samples.iter().step_by(every).filter_map(vector).collect()
}

fn markers(session: &Session, prepared: &Prepared) -> Vec<ConstraintMarker> {
    let Some(analysis) = &session.analysis else { return Vec::new() };
    let of_this = |c: &&Constraint| {
        session.recordings.len() < 2 || c.recording.as_deref().is_none_or(|name| names(prepared, name))
    };
    analysis.fit.constraints.iter().filter(of_this).filter_map(|c| marker(c, prepared)).collect()
}

fn names(prepared: &Prepared, name: &str) -> bool {
    prepared.recording.name == name || prepared.recording.trial.as_deref() == Some(name)
}

fn marker(constraint: &Constraint, prepared: &Prepared) -> Option<ConstraintMarker> {
    let planar = |v: &Vec<f64>| (v.len() >= 2).then(|| Vec2::new(v[0], v[1]));
    let std = |name: &str| constraint.std_error.get(name).copied().unwrap_or(0.0);
    match constraint.kind {
        ConstraintKind::Revolute => Some(ConstraintMarker::Revolute {
            center_m: planar(constraint.center_m.as_ref()?)?,
            radius_m: constraint.radius_m?,
            center_std_m: std("center_m"),
        }),
        ConstraintKind::Prismatic => {
            let (low, high) = bounds(prepared)?;
            Some(ConstraintMarker::Prismatic {
                origin_m: 0.5 * (low + high),
                direction: planar(constraint.direction.as_ref()?)?,
                length_m: constraint.coverage_m.unwrap_or((high - low).norm()),
                std_m: constraint.residual_m.unwrap_or(0.0),
            })
        }
        _ => None,
    }
}
