//! Content of the 3-D view of a recording: the hand at the cursor, the world with its bodies, path, forces,
//! constraints.

use super::path_extent::{bounds, force_scale, window};
use super::{markers, vectors};
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::prepared::Prepared;
use crate::ui::document::state::Document;
use crate::ui::session::Session;
use haptics::Vec2;
use haptics::world::{State, World};
use render::{Camera, ColorRole, ConstraintMarker, FingerStyle, Trajectory, ViewOptions};
use std::sync::Arc;

/// World of a recording: the fitted one, or an empty table with the recording's hand.
pub fn scene_world(calibration: &Calibration, prepared: &Prepared) -> Arc<World> {
    if let Some(analysis) = &calibration.analysis
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
    let sample = prepared.sample_at(session.document.cursor_s);
    let mut state = State::resting(world);
    let mut options = ViewOptions::default();
    if let Some(tips) = &prepared.tips {
        for (finger, tip) in tips.iter().enumerate() {
            state.input.tip_in_world[finger] = tip.position[sample];
            state.tip_force_n[finger] = tip.force.as_ref().map_or_else(Vec2::zeros, |f| f[sample]);
        }
        if let Some(film) = session.calibration.replay(session.document.current).and_then(|r| r.film.as_ref()) {
            film.pose(session.document.cursor_s, &mut state);
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
        options.trajectories = trajectories(&session.document, &session.calibration, prepared);
    }
    let markers: Vec<ConstraintMarker> =
        markers::of(&session.document, &session.calibration, prepared).into_iter().filter_map(|m| m.marker).collect();
    if session.layers.forces_on_path {
        options.force_vectors = vectors::net(&session.document, prepared);
    }
    if session.layers.unexplained {
        options.force_vectors.extend(vectors::unexplained(session, prepared, markers.first()));
    }
    options.vector_scale_m_per_n = force_scale(prepared);
    if session.layers.replay {
        options.predicted_force_n = vectors::tips(session, sample);
        options.ghost = virtual_hand(&state, world);
    }
    if session.layers.constraints {
        options.constraints = markers;
    }
    (state, options)
}

/// Hand on the virtual handle; `None` where the fingers do not turn a crank.
fn virtual_hand(state: &State, world: &World) -> Option<State> {
    let grasp = 0.5 * (state.input.tip_in_world[0] + state.input.tip_in_world[1]);
    let apart = state.handle_in_world(world)? - grasp;
    // Fingers elsewhere do not hold it.
    let holds = apart.norm() < world.crank.as_ref()?.handle_width_m;
    holds.then(|| {
        let mut ghost = state.clone();
        for tip in &mut ghost.input.tip_in_world {
            *tip += apart;
        }
        ghost
    })
}

/// Camera that shows the whole recording, with a nearby centre of rotation.
pub fn camera_for(document: &Document, calibration: &Calibration, prepared: &Prepared) -> Camera {
    match bounds(prepared) {
        Some((mut low, mut high)) if prepared.tool.is_some() => {
            let extent = (high - low).norm();
            for marked in markers::of(document, calibration, prepared) {
                if let Some(ConstraintMarker::Revolute { center_m, radius_m, .. }) = marked.marker
                    && radius_m < 1.5 * extent
                {
                    (low, high) = (low.inf(&center_m), high.sup(&center_m));
                }
            }
            // The switches cover the upper edge.
            high.y += 0.16 * (high - low).amax();
            let [low, high] = [low, high].map(|v| [v.x as f32, v.y as f32]);
            Camera { pitch_rad: 0.0, ..Camera::hand() }.framing(low.into(), high.into())
        }
        _ => Camera::workspace(),
    }
}

/// True if each finger has a path of its own; fingers on a crank share one.
pub fn follows_fingers(calibration: &Calibration, prepared: &Prepared) -> bool {
    let turns = calibration.analysis.as_ref().is_some_and(|a| a.world.crank.is_some());
    prepared.tips.is_some() && !turns
}

fn trajectories(document: &Document, calibration: &Calibration, prepared: &Prepared) -> Vec<Trajectory> {
    let samples = window(document, prepared);
    let curve = |points_m: Vec<Vec2>, role, width_px| Trajectory { points_m, role, width_px, dashed: false };
    match &prepared.tips {
        Some(tips) if follows_fingers(calibration, prepared) => (0..2)
            .map(|f| curve(samples.iter().map(|i| tips[f].position[*i]).collect(), ColorRole::Finger(f), 1.2))
            .collect(),
        _ => {
            let points = samples.iter().filter_map(|i| prepared.point_at(*i)).collect();
            vec![curve(points, ColorRole::Measured, 1.6)]
        }
    }
}
