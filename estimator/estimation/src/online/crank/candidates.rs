//! Candidate motions of a crank and the information that each would add: rows made by the same laws.

use super::geometry::Circle;
use super::laws::Laws;
use crate::identify::crank::laws::{LAWS, NAMES, Place, column};
use crate::online::information::matrices::{collected, per_second, with_copy};
use crate::online::information::motion::Motion;
use crate::online::information::problem::Problem;
use haptics::law::Motion as Along;
use nalgebra::DMatrix;
use std::f64::consts::TAU;

/// Steps of a turn that candidates are sampled at.
const STEPS: usize = 96;

/// Problems of a crank: its laws beside the bias, its circle beside the give.
pub(crate) fn crank_problems(
    circle: &Circle,
    laws: &Laws,
    bias_error: Option<f64>,
    bias_noise_n: f64,
    free_row_s: f64,
) -> Vec<Problem> {
    let (normal_n, pull_n, speed_m_s) = laws.usual();
    let (information, variance) = collected(laws.fit());
    let turned = Turned {
        information,
        variance,
        seconds: laws.fit().rows() as f64 / Laws::rows_per_s(),
        normal_n,
        pull_n,
        speed_m_s,
        radius_m: circle.frame().map_or(0.02, |f| f.1),
        bias_error,
        bias_noise_n,
        free_row_s,
    };
    let (information, variance) = collected(circle.fit());
    let seconds = circle.fit().rows() as f64 / Circle::rows_per_s();
    let force_n = circle.usual_force_n();
    vec![rubbing(&turned), round(&Round { information, variance, seconds, normal_n, force_n })]
}

/// What was seen of a crank's laws.
pub(super) struct Turned {
    /// Information of the laws' columns.
    pub(super) information: DMatrix<f64>,
    /// What rows are divided by to become information.
    pub(super) variance: f64,
    /// For so long, s.
    pub(super) seconds: f64,
    /// Mean normal force and mean size of it, N.
    pub(super) normal_n: f64,
    pub(super) pull_n: f64,
    /// Mean speed, m/s.
    pub(super) speed_m_s: f64,
    pub(super) radius_m: f64,
    /// Error of the bias, N, once it was seen, and its noise from row to row.
    pub(super) bias_error: Option<f64>,
    pub(super) bias_noise_n: f64,
    /// Time between two rows in free motion, s.
    pub(super) free_row_s: f64,
}

/// What was seen of its circle.
pub(super) struct Round {
    /// Information of radius, centre and give.
    pub(super) information: DMatrix<f64>,
    /// What rows are divided by to become information.
    pub(super) variance: f64,
    /// For so long, s.
    pub(super) seconds: f64,
    /// Mean normal force, and mean size of the force, N.
    pub(super) normal_n: f64,
    pub(super) force_n: f64,
}

/// One way of turning: time along it from 0 to 1 → speed over the usual one, acceleration over usual speed times 1/s, normal force, N.
type Way<'a> = &'a dyn Fn(f64) -> (f64, f64, f64);

/// Information a second of turning in one way.
fn turning(seen: &Turned, way: Way<'_>) -> DMatrix<f64> {
    let (radius, speed) = (seen.radius_m, seen.speed_m_s.max(0.01));
    let row = |k: usize| {
        let phase = (k as f64 + 0.5) / STEPS as f64;
        let (share, acceleration, normal_force_n) = way(phase);
        let velocity = share * speed;
        let angle = TAU * 7.0 * phase;
        let along = Along {
            time_s: phase,
            position: radius * angle,
            velocity,
            acceleration: acceleration * speed,
            direction: velocity.signum(),
            normal_force_n,
            up_along: angle.cos(),
        };
        let mut columns: Vec<f64> = LAWS.iter().map(|law| column(*law, &along)).collect();
        columns.push(columns[Place::Weight as usize]);
        columns
    };
    let rows: Vec<Vec<f64>> = (0..STEPS).map(row).collect();
    per_second(&rows, Laws::rows_per_s()) / seen.variance
}

pub(super) fn rubbing(seen: &Turned) -> Problem {
    let variance = seen.variance;
    let mut information = with_copy(&seen.information, Place::Weight as usize);
    let bias = NAMES.len();
    if let Some(error) = seen.bias_error {
        information[(bias, bias)] += error.powi(-2);
    }
    let rows_per_s = Laws::rows_per_s();
    let seconds = seen.seconds.max(1.0 / rows_per_s);
    let (normal, pull) = (seen.normal_n, seen.pull_n.max(0.1));
    let turn = |way: Way<'_>| turning(seen, way);
    let way = |phase: f64| if phase < 0.5 { 1.0 } else { -1.0 };
    let speeds = |phase: f64| [0.4, 1.0, 2.0][(phase * 6.0) as usize % 3];
    // About one and a half swings of the speed a second.
    let swing = |phase: f64| (TAU * 11.0 * phase).sin_cos();
    let free_noise = if seen.bias_noise_n > 0.0 { seen.bias_noise_n } else { variance.sqrt() };
    let mut let_go = DMatrix::zeros(bias + 1, bias + 1);
    let_go[(bias, bias)] = 1.0 / (seen.free_row_s * free_noise * free_noise);
    Problem {
        object: "crank".to_owned(),
        names: NAMES.iter().enumerate().map(|(k, name)| ((*name).to_owned(), k)).collect(),
        information,
        before: vec![10.0, 10.0, 100.0, 10.0, 10.0, 10.0],
        motions: vec![
            (Motion::GoOn, with_copy(&(&seen.information / seconds), Place::Weight as usize)),
            (Motion::Reverse, turn(&|p| (way(p), 0.0, normal))),
            (Motion::OtherSpeeds, turn(&|p| (way(p) * speeds(p), 0.0, normal))),
            (
                Motion::Accelerate,
                turn(&|p| {
                    let (s, c) = swing(p);
                    (way(p) * (1.0 + 0.8 * s), way(p) * 0.8 * 9.0 * c, normal)
                }),
            ),
            (Motion::PushAndPull, turn(&|p| (way(p), 0.0, pull * 2.0 * (TAU * 3.3 * p).sin()))),
            (Motion::LetGo, let_go),
        ],
    }
}

pub(super) fn round(seen: &Round) -> Problem {
    let (information, variance) = (seen.information.clone(), seen.variance);
    let rows_per_s = Circle::rows_per_s();
    let seconds = seen.seconds.max(1.0 / rows_per_s);
    let (normal, force) = (seen.normal_n, seen.force_n.max(0.05));
    let turn = |radial: &dyn Fn(f64) -> f64, along: f64| {
        let row = |k: usize| {
            let phase = (k as f64 + 0.5) / STEPS as f64;
            let (s, c) = (TAU * 3.0 * phase).sin_cos();
            let way = if phase < 0.5 { along } else { -along };
            let (fx, fy) = (radial(phase) * c - way * s, radial(phase) * s + way * c);
            vec![1.0, c, s, c * fx, s * fy]
        };
        let rows: Vec<Vec<f64>> = (0..STEPS).map(row).collect();
        per_second(&rows, rows_per_s) / variance
    };
    let same = &information / seconds;
    Problem {
        object: "crank".to_owned(),
        names: ["radius_m", "center_x_m", "center_y_m"].iter().enumerate().map(|(k, n)| ((*n).to_owned(), k)).collect(),
        information,
        before: vec![1.0, 1.0, 1.0, 0.01, 0.01],
        motions: vec![
            (Motion::GoOn, same),
            (Motion::FullTurn, turn(&|_| normal, 0.0)),
            (Motion::Reverse, turn(&|_| normal, 0.5 * force)),
            (Motion::PushAndPull, turn(&|p| 2.0 * force * (TAU * 1.7 * p).sin(), 0.0)),
        ],
    }
}
