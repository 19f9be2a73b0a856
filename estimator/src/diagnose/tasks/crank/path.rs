//! Path of a crank: centre and radius, and the causes that distort the circle.
//!
//! Unexplained residual of a crank's path, and arcs that are too short to determine their circle.

use super::grasp_slip::{Course, SLIP_STARTS, jump};
use super::path_points::{Path, PathPoint};
use crate::diagnose::data::limits::MOST_ROUNDS;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::{fingertip_slip, joint_offset, length_scale, pad_compliance};
use crate::diagnose::model_error::competition::compete;
use crate::diagnose::model_error::of_path::discrepancies;
use crate::diagnose::model_error::standing::Competition;
use crate::diagnose::selection::channel::{Channel, leave_out_what_is_unsure};
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::layout::{Blocks, Layout};
use crate::diagnose::selection::refinement::{Refinement, refined};
use crate::diagnose::selection::rules::Rules;
use estimation::regression::linear::least_squares;
use foundation::estimate::EstimateError;
use foundation::signal::noise::white_noise;
use foundation::words::amount;
use haptics::Vec2;
use haptics::law::Kind;

/// Slip of the grasp on the handle, and the parameter of a slip along the arm.
const SLIP: &str = fingertip_slip::ID;
const OUTWARD: &str = "dr";
/// Parameters of a finger's joint and first link, of one finger and of two.
const OF_THE_FINGER: [&str; 2] = ["delta", "link_error"];
const OF_FINGERS: [[&str; 2]; 2] = [["delta1", "link_error1"], ["delta2", "link_error2"]];

/// The circle that the handle follows.
#[derive(Clone, Debug)]
pub struct Arm {
    /// m
    pub center_m: Vec2,
    pub radius_m: f64,
    /// Offset subtracted from the measured position of a signals' row, m.
    pub shifts: Vec<Vec2>,
    /// Rotation error of the whole arm, rad. A circle does not show it, the directions of the forces do.
    pub turn_rad: f64,
}

impl Arm {
    /// From the centre to the handle, m.
    pub fn arm(&self, row: usize, position: Vec2) -> Vec2 {
        let arm = position - self.shifts.get(row).copied().unwrap_or_else(Vec2::zeros) - self.center_m;
        if self.turn_rad == 0.0 { arm } else { nalgebra::Rotation2::new(self.turn_rad) * arm }
    }
}

/// Angle of a vector, rad, within half a turn of `near`.
pub fn unwrapped(vector: Vec2, near: f64) -> f64 {
    let wrapped = vector.y.atan2(vector.x);
    wrapped + ((near - wrapped) / std::f64::consts::TAU).round() * std::f64::consts::TAU
}

/// The circle, and the causes found that distort it.
pub struct Geometry {
    pub arm: Arm,
    pub study: ChannelFit,
}

impl Geometry {
    /// Relative excess of the path over a known radius, with its standard error.
    pub fn too_large(&self, known_m: f64) -> Option<[f64; 2]> {
        let solved = self.study.solved.as_ref()?;
        Some([self.arm.radius_m / known_m - 1.0, solved.std_error(0, self.study.system.rows) / known_m])
    }
}

/// Displacement of a point by the causes of the last round, m.
#[derive(Clone, Copy, Debug, Default)]
struct Displaced {
    exact: Vec2,
    /// In proportion to the parameters.
    linear: Vec2,
}

/// The circle in the making.
struct Circling<'a> {
    path: &'a Path,
    rules: Rules,
    coarse: Vec<Course>,
    /// Courses of a slip to try in this round: the coarse ones, and finer ones around those found.
    courses: Vec<Course>,
    step_s: f64,
    center_m: Vec2,
    radius_m: f64,
    /// Last step of the centre, m.
    moved_m: f64,
    bent: Vec<Displaced>,
    shift_m: Vec<Vec2>,
}

impl Refinement for Circling<'_> {
    fn compare(&mut self, _: Option<ChannelFit>) -> Result<ChannelFit, EstimateError> {
        let made = compare(self.path, (self.center_m, &self.bent), &self.courses, self.rules)?;
        let solved = made.solved.as_ref().ok_or_else(no_circle)?;
        self.radius_m = solved.values[0];
        let step = Vec2::new(solved.values[1], solved.values[2]);
        self.moved_m = step.norm();
        self.center_m += step;
        self.bent = corrections(self.path, &made, &mut self.shift_m, self.center_m);
        Ok(made)
    }

    fn close_in(&mut self, made: &ChannelFit, round: usize) -> bool {
        // The grid around found slips becomes finer.
        self.step_s *= 0.5;
        let found = made.chosen.iter().map(|c| &made.candidates[c.candidate]).filter(|c| c.id == SLIP);
        let finer: Vec<Course> = found.flat_map(|c| Course::of(c).around(self.step_s)).collect();
        let is_settled = self.moved_m < 1e-6 * self.radius_m && finer.is_empty() && round > 1;
        self.courses = [self.coarse.as_slice(), &finer].concat();
        !is_settled
    }
}

/// Fits the circle and its distortions. `signals`: number of rows of the signals.
pub fn geometry(path: &Path, signals: usize, rules: Rules) -> Result<Geometry, EstimateError> {
    let positions: Vec<Vec2> = path.points.iter().map(|p| p.position).collect();
    let center_m = circle(&positions)?;
    let mut coarse = Course::coarse(path);
    coarse.extend(jump(path, center_m));
    let mut circling = Circling {
        path,
        rules,
        courses: coarse.clone(),
        coarse,
        step_s: path.span_s() * SLIP_STARTS.spacing(),
        center_m,
        radius_m: 0.0,
        moved_m: f64::INFINITY,
        bent: vec![Displaced::default(); path.points.len()],
        shift_m: vec![Vec2::zeros(); signals],
    };
    let study = refined(&mut circling, MOST_ROUNDS - 1)?;
    let Circling { center_m, radius_m, shift_m, .. } = circling;
    Ok(Geometry { arm: Arm { center_m, radius_m, shifts: shift_m, turn_rad: 0.0 }, study })
}

/// Kåsa's circle (1976).
fn circle(points: &[Vec2]) -> Result<Vec2, EstimateError> {
    let mean = points.iter().sum::<Vec2>() / points.len().max(1) as f64;
    let column = |f: &dyn Fn(Vec2) -> f64| points.iter().map(|p| f(p - mean)).collect::<Vec<f64>>();
    let columns = [column(&|p| 2.0 * p.x), column(&|p| 2.0 * p.y), vec![1.0; points.len()]];
    let fit = least_squares(&columns, &column(&|p| p.norm_squared()), None)?;
    Ok(mean + Vec2::new(fit.values[0], fit.values[1]))
}

fn compare(
    path: &Path,
    (center_m, bent): (Vec2, &[Displaced]),
    courses: &[Course],
    rules: Rules,
) -> Result<ChannelFit, EstimateError> {
    let arms: Vec<Vec2> = path.points.iter().map(|p| p.position - center_m).collect();
    let outward: Vec<Vec2> = arms.iter().map(Vec2::normalize).collect();
    // The known displacement enters exactly. The target keeps its linear part, which the regressors explain.
    let distance = |i: usize| (arms[i] - bent[i].exact).norm() + outward[i].dot(&bent[i].linear);
    let y: Vec<f64> = (0..arms.len()).map(|i| distance(i) + path.points[i].inside_m2 / arms[i].norm()).collect();
    let column = |f: &dyn Fn(usize) -> f64| (0..y.len()).map(f).collect::<Vec<f64>>();
    let mut base = vec![vec![1.0; y.len()], column(&|i| outward[i].x), column(&|i| outward[i].y)];
    base.extend(path.pad_axes().iter().map(|a| column(&|i| outward[i][*a] * path.points[i].force[*a])));
    let channel = Channel::new(y, base, candidates(path, &outward, courses), layout(path), rules);
    let mut study = channel.select(None).map_err(|_| no_circle())?;
    // Misfit of hardening pads, or of two slips by one, looks like another weak cause in the fitted rows.
    leave_out_what_is_unsure(&mut study);
    Ok(study)
}

fn no_circle() -> EstimateError {
    EstimateError::Other("no circle fits the handle's path".to_owned())
}

/// The points of a path as rows.
pub fn layout(path: &Path) -> Layout {
    let segment: Vec<usize> = path.points.iter().map(|p| p.stretch).collect();
    let testable = vec![true; segment.len()];
    let time_s = path.points.iter().map(|p| p.time_s).collect();
    Layout { time_s, blocks: Blocks::None, ..Layout::of(segment, &testable, path.period_s) }
}

fn candidates(path: &Path, outward: &[Vec2], courses: &[Course]) -> Vec<Candidate> {
    let points = &path.points;
    let column = |f: &dyn Fn(usize) -> f64| (0..points.len()).map(f).collect::<Vec<f64>>();
    let mut found = Vec::new();
    if !path.two_fingered {
        let normal = column(&|i| outward[i].dot(&points[i].force));
        found.push(Candidate::one(pad_compliance::ID, Kind::Plant, "give", "m/N", normal).positive());
    }
    let names = if path.two_fingered { OF_FINGERS.as_slice() } else { &[OF_THE_FINGER] };
    for (finger, [delta, link_error]) in names.iter().enumerate() {
        if points.iter().all(|p| p.joints[finger].is_some()) {
            let of = |k: usize| column(&|i| points[i].joints[finger].map_or(0.0, |j| outward[i].dot(&j[k])));
            found.push(Candidate::one(joint_offset::ID, Kind::Instrument, delta, "rad", of(0)));
            found.push(Candidate::one(length_scale::ID, Kind::Instrument, link_error, "m", of(1)));
        }
    }
    for course in courses {
        let gone = |of: &dyn Fn(usize) -> f64| column(&|i| course.gone(points[i].time_s) * of(i));
        let dated = |slip: Candidate| {
            let slip = slip.at("time", course.start_s, "s");
            match course.duration_s {
                Some(duration_s) => slip.at("duration", duration_s, "s"),
                None => slip,
            }
        };
        // The grasp slips along a handle of constant direction, or along the arm of one that turns with it.
        let columns = vec![gone(&|i| outward[i].x), gone(&|i| outward[i].y)];
        let across = Candidate::several(SLIP, Kind::Plant, columns, vec![("dx", "m"), ("dy", "m")]);
        found.extend([across, Candidate::one(SLIP, Kind::Plant, OUTWARD, "m", gone(&|_| 1.0))].map(dated));
    }
    found
}

/// Finger of a joint cause.
fn finger(candidate: &Candidate) -> usize {
    usize::from(candidate.linear.first().is_some_and(|(name, _)| name.ends_with('2')))
}

/// Displacement of the positions by the causes found.
fn corrections(path: &Path, study: &ChannelFit, shift_m: &mut [Vec2], center_m: Vec2) -> Vec<Displaced> {
    shift_m.fill(Vec2::zeros());
    let Some(solved) = &study.solved else { return vec![Displaced::default(); path.points.len()] };
    let found = study.found();
    let mut give = Vec2::zeros();
    path.pad_axes().iter().zip(&solved.values[3..]).for_each(|(axis, value)| give[*axis] = *value);
    let of = |point: &PathPoint| {
        let outward = (point.position - center_m).normalize();
        let mut shift = point.force.component_mul(&give);
        let mut bow = Vec2::zeros();
        for (candidate, values) in &found {
            let value = values[0];
            shift += match (candidate.id, point.joints[finger(candidate)]) {
                (pad_compliance::ID, _) => outward * (value * outward.dot(&point.force)),
                (joint_offset::ID, Some(joint)) => {
                    // The second link rotates about its joint: its error moves the tip on an arc, not along the
                    // tangent.
                    bow += Vec2::new(joint[0].y, -joint[0].x) * (1.0 - value.cos()) + joint[0] * (value.sin() - value);
                    joint[0] * value
                }
                (length_scale::ID, Some(joint)) => joint[1] * value,
                (SLIP, _) if candidate.regressors.len() == 1 => {
                    outward * (value * Course::of(candidate).gone(point.time_s))
                }
                (SLIP, _) => Vec2::new(value, values[1]) * Course::of(candidate).gone(point.time_s),
                _ => Vec2::zeros(),
            };
        }
        Displaced { exact: shift + bow, linear: shift }
    };
    let all: Vec<Displaced> = path.points.iter().map(of).collect();
    for (point, displaced) in path.points.iter().zip(&all) {
        if let Some(to) = shift_m.get_mut(point.index) {
            *to = displaced.exact;
        }
    }
    all
}

/// Relative error of the radius from which an arc is short.
/// Choice: halved or doubled, none of 43 answers changes.
const UNSURE: f64 = 0.05;

/// Sentence on an arc that is too short, for the noise of its positions, to determine its circle well. The error is the
/// drift of a centre estimated from ever less of a slow motion.
pub fn short_arc(path: &Path, arm: &Arm, study: &ChannelFit) -> Option<String> {
    let solved = study.solved.as_ref()?;
    let mut before = 0.0_f64;
    let angles = path.points.iter().map(|point| {
        before = unwrapped(arm.arm(point.index, point.position), before);
        before
    });
    let [low, high] = angles.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], a| [l.min(a), h.max(a)]);
    let arc_rad = (high - low).min(std::f64::consts::TAU);
    let bulge_m = arm.radius_m * (1.0 - (0.5 * arc_rad).cos());
    let noise_m = white_noise(&study.target);
    let error_m = solved.std_error(0, study.system.rows);
    (error_m > UNSURE * arm.radius_m).then(|| {
        format!(
            "the handle went over {:.0}° only, an arc that bulges by {} where one place is known to {}: the radius is {} give or take {}, and \
             a circle may well come out too small; a centre that seems to wander in so slow or short a motion need not move: turn further",
            arc_rad.to_degrees(),
            amount(bulge_m, "m"),
            amount(noise_m, "m"),
            amount(arm.radius_m, "m"),
            amount(error_m, "m")
        )
    })
}

/// Causes of the path beside its structured errors.
pub fn competition(path: &Path, arm: &Arm, study: &ChannelFit) -> Option<Competition> {
    let outward: Vec<Vec2> = path.points.iter().map(|p| (p.position - arm.center_m).normalize()).collect();
    let time_s: Vec<f64> = path.points.iter().map(|p| p.time_s).collect();
    compete(study, &discrepancies(&outward, &time_s))
}
