//! A body that is thrown and slides out: free fall measures the scale of the positions, sliding measures its friction.
//!
//! Nothing of the body's shape is needed. In flight, every point of it that a tracker follows moves on a parabola (plus
//! the turning of that point about the centre of mass, which is fitted if orientations were recorded). The parabola's
//! acceleration is g times the scale of the positions. A body that slides flat slows down by μ g in the same scale, so
//! that their ratio is free of it.

pub mod flight;
pub mod pose;
pub mod slide;
pub mod trajectory;

use super::mechanism::path;
use crate::identify::limits::SIGNIFICANT;
use flight::Fall;
use foundation::estimate::{Fit, Parameter};
use haptics::recording::Recording;
use pose::Track;
use trajectory::Air;

/// The object's name.
const BODY: &str = "body";
/// Largest relative difference of a throw's acceleration from gravity. A larger error of scale or clock is of another
/// kind, and a body that falls more slowly is held by something.
/// Choice: halved or doubled, none of 6 answers changes.
const LIKE_GRAVITY: f64 = 0.2;
/// Share of the recordings that must begin with a fall.
/// Choice: halved or doubled, none of 6 answers changes.
const FALLING_SHARE: f64 = 0.5;

/// Estimates from recordings of one thrown body.
pub struct Tossed {
    /// One a recording.
    pub tracks: Vec<Track>,
    /// Parameters of all flights together.
    pub fall: Fall,
    /// Slides of all recordings.
    pub slides: Vec<slide::Slide>,
}

/// Flights and slides; `None` where the recordings are of no thrown body.
pub fn tossed(recordings: &[Recording]) -> Option<Tossed> {
    let first = recordings.first()?;
    if recordings.iter().any(|r| path::forces(r).is_some() || r.time_s.is_none()) {
        return None;
    }
    let up = path::up(first)?;
    let tracks: Vec<Track> = recordings.iter().filter_map(|r| Track::of(r, up)).collect();
    let gravity = first.meta.gravity();
    if tracks.is_empty() || gravity <= 0.0 {
        return None;
    }
    let fall = Fall::of(&tracks)?;
    if (fall.throws as f64) < FALLING_SHARE * recordings.len() as f64 {
        return None;
    }
    // One throw has nothing beside it that says the same: it must have ended in a blow, as nothing does that a path holds.
    let is_alone = tracks.len() == 1 && flight::end(&tracks[0]) == tracks[0].points.len();
    let falls = falls_like(&tracks, &fall, gravity) && !is_alone;
    if !falls && !trajectory::is_flight(&tracks, gravity, LIKE_GRAVITY) {
        return None;
    }
    let half_width_m = first.meta.known.get("half_width_m").copied().filter(|h| h.is_finite() && *h > 0.0);
    let slides = slide::slides(&tracks, half_width_m, gravity);
    Some(Tossed { tracks, fall, slides })
}

/// True if this is the acceleration of falling bodies.
fn falls_like(tracks: &[Track], fall: &Fall, gravity_m_s2: f64) -> bool {
    let like = |fall: &Fall| {
        (fall.down_m_s2 / gravity_m_s2 - 1.0).abs() < LIKE_GRAVITY && fall.aside_m_s2 < LIKE_GRAVITY * gravity_m_s2
    };
    // One short flight hardly tells falling from the turning of a point beside the middle, and its error says so: its own parabola is like a fall.
    like(fall) || (tracks.len() == 1 && Fall::of_points(tracks).as_ref().is_some_and(like))
}

/// The fit of recordings of one thrown body; `None` when they do not show one.
pub fn fit(recordings: &[Recording]) -> Option<Fit> {
    let Tossed { tracks, fall, slides } = tossed(recordings)?;
    let gravity = recordings.first()?.meta.gravity();
    let samples: usize = tracks.iter().map(|t| t.time_s.len()).sum();
    let bent = trajectory::air(&tracks, gravity).filter(Air::bends);
    let (fall, how) = match &bent {
        Some(air) => {
            (air.fall(fall, gravity), "trajectories through air of all flights, drag common, spin of each".to_owned())
        }
        None if fall.throws > 1 => {
            (fall, format!("parabolas of {} flights, one acceleration for all, errors by flight", fall.throws))
        }
        None => (fall, "the parabola of one flight, error by what its samples leave".to_owned()),
    };
    let identified = |name, value, error, how: &str| Parameter::identified(BODY, name, value, error, fall.samples, how);
    let by = format!("free fall over {gravity} m/s²: recorded length over true length, if the clock is right");
    let mut parameters = vec![
        identified("free_fall_m_s2", fall.down_m_s2, fall.error_m_s2, &how),
        identified("length_scale", fall.down_m_s2 / gravity, fall.error_m_s2 / gravity, &by),
    ];
    if let Some(air) = bent.filter(|air| air.drag.is_clear()) {
        let [drag, error] = air.best.drag_per_m;
        parameters.push(identified("drag_per_mass_1_m", drag, error, &how));
    }
    parameters.push(friction(&slides, &fall, samples));
    let why = "it needs the places of the corners, which the recording does not have";
    parameters.push(Parameter::unidentified(BODY, "restitution", samples, why));
    let mut warnings = Vec::new();
    if (fall.down_m_s2 - gravity).abs() > SIGNIFICANT * fall.error_m_s2 {
        warnings.push(format!(
            "the body falls with {:.3} ± {:.3} m/s² and not {gravity}: lengths are recorded {:+.1} % off, or the clock {:+.1} %",
            fall.down_m_s2,
            fall.error_m_s2,
            100.0 * (fall.down_m_s2 / gravity - 1.0),
            100.0 * ((gravity / fall.down_m_s2).sqrt() - 1.0)
        ));
    }
    Some(Fit { task: "mechanism".to_owned(), parameters, warnings, ..Fit::default() })
}

/// Mean over the slides, with the error of their scatter: a table is not alike everywhere.
fn friction(slides: &[slide::Slide], fall: &Fall, samples: usize) -> Parameter {
    let n = slides.len() as f64;
    if slides.len() < 2 {
        let why = "the body does not slide flat for long enough in two recordings at least; throw it flatter";
        return Parameter::unidentified(BODY, "friction", samples, why);
    }
    let values: Vec<f64> = slides.iter().map(|s| s.friction(fall.down_m_s2)).collect();
    let mean = values.iter().sum::<f64>() / n;
    let scatter = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0) / n).sqrt();
    let error = scatter.hypot(mean * fall.error_m_s2 / fall.down_m_s2).hypot(mean * slide::unknown_of_foot(slides));
    let how = format!(
        "slowing of {} slides over free fall, which is free of the scale of the positions; single slides scatter by {:.3}",
        slides.len(),
        scatter * n.sqrt()
    );
    Parameter::identified(BODY, "friction", mean, error, slides.iter().map(|s| s.samples).sum(), &how)
}
