//! Unexplained residual of a crank's path, and arcs that are too short to determine their circle.

use super::path::{Arm, Path};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::selection::comparison::ChannelFit;
use foundation::signal::noise::white_noise;
use haptics::Vec2;
use haptics::law::Kind;

/// Generic waves round a turn, and slow ones over the recording.
const PATH_WAVES: u32 = 4;
const SLOW_PATH_WAVES: u32 = 4;
/// Ratio of the path's residual to its noise from which a reason is expected.
const STRANGE_PATH_RATIO: f64 = 2.0;
/// An arc whose bulge is no more than this many times the noise of one place, or whose radius is known to no better
/// than this share, is short.
const BULGE: f64 = 12.0;
const UNSURE: f64 = 0.05;

/// Generic terms of a path: waves around the turn (those of first order belong to the circle's centre) and slow
/// changes.
fn generic(path: &Path, outward: &[Vec2]) -> Vec<Candidate> {
    let angle = |i: usize| outward[i].y.atan2(outward[i].x);
    let column = |of: &dyn Fn(usize) -> f64| (0..path.points.len()).map(of).collect::<Vec<f64>>();
    let term = |expression: String, columns: Vec<Vec<f64>>| {
        let linear = columns.iter().map(|_| ("amplitude", "m")).collect();
        Candidate { expression: Some(expression), ..Candidate::several("other", Kind::Plant, columns, linear) }
    };
    let waves = (2..=PATH_WAVES).map(|n| {
        let wave = |of: fn(f64) -> f64| column(&|i| of(f64::from(n) * angle(i)));
        term(format!("cos({n} theta + phi) of the path"), vec![wave(f64::cos), wave(f64::sin)])
    });
    let (start_s, span_s) = (path.points.first().map_or(0.0, |p| p.time_s), path.span_s().max(1e-9));
    let slow = (1..=SLOW_PATH_WAVES).map(|k| {
        let wave = |i: usize| (std::f64::consts::PI * f64::from(k) * (path.points[i].time_s - start_s) / span_s).cos();
        term(format!("cos({k} pi t/T) of the path"), vec![column(&wave)])
    });
    waves.chain(slow).collect()
}

/// The comparison of the path with generic terms beside the causes found; `None` if the residual is near the noise.
pub fn unexplained(path: &Path, arm: &Arm, study: &ChannelFit) -> Option<ChannelFit> {
    let left = study.residual_of(&study.picks(), study.solved.as_ref()?);
    let rms = (left.iter().map(|r| r * r).sum::<f64>() / left.len().max(1) as f64).sqrt();
    if rms < STRANGE_PATH_RATIO * white_noise(&study.y) {
        return None;
    }
    let outward: Vec<Vec2> = path.points.iter().map(|p| (p.position - arm.center_m).normalize()).collect();
    Some(study.beside(generic(path, &outward)))
}

/// Sentence on an arc that is too short, for the noise of its positions, to determine its circle well. The error is the
/// drift of a centre estimated from ever less of a slow motion.
pub fn short_arc(path: &Path, arm: &Arm, study: &ChannelFit) -> Option<String> {
    let solved = study.solved.as_ref()?;
    let mut before = 0.0_f64;
    let angles = path.points.iter().map(|point| {
        let arm = arm.arm(point.index, point.position);
        let wrapped = arm.y.atan2(arm.x);
        before = wrapped + ((before - wrapped) / std::f64::consts::TAU).round() * std::f64::consts::TAU;
        before
    });
    let [low, high] = angles.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], a| [l.min(a), h.max(a)]);
    let arc_rad = (high - low).min(std::f64::consts::TAU);
    let bulge_m = arm.radius_m * (1.0 - (0.5 * arc_rad).cos());
    let noise_m = white_noise(&study.y);
    let variance = solved.variance(study.system.rows);
    let error_m = (variance * solved.inverse[(0, 0)]).sqrt();
    (bulge_m < BULGE * noise_m || error_m > UNSURE * arm.radius_m).then(|| {
        format!(
            "the handle went over {:.0}° only, an arc that bulges by {:.2} mm where one place is known to {:.3} mm: the radius is {:.1} mm give or take {:.1}, and \
             a circle may well come out too small; a centre that seems to wander in so slow or short a motion need not move: turn further",
            arc_rad.to_degrees(),
            1e3 * bulge_m,
            1e3 * noise_m,
            1e3 * arm.radius_m,
            1e3 * error_m
        )
    })
}
