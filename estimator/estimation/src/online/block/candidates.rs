//! Candidate motions of a carried object and the information that each would add.

use super::grasp_record::GraspRecord;
use crate::online::information::matrices::{collected, per_second, with_copy};
use crate::online::information::motion::Motion;
use crate::online::information::problem::Problem;
use nalgebra::DMatrix;

/// Problems of a carried object: weight beside the bias, width beside the pads' give, friction.
pub(crate) fn block_problems(
    name: &str,
    object: &GraspRecord,
    bias_error: Option<f64>,
    bias_noise_n: f64,
    row_s: f64,
    free_row_s: f64,
) -> Vec<Problem> {
    vec![
        weight(name, object, bias_error, bias_noise_n, row_s, free_row_s),
        width(name, object, row_s),
        Problem {
            object: name.to_owned(),
            names: vec![("friction".to_owned(), 0)],
            information: DMatrix::zeros(1, 1),
            before: vec![1.0],
            // Only sliding shows it: a tenth of a second of it to about 3 %.
            motions: vec![
                (Motion::GoOn, DMatrix::zeros(1, 1)),
                (Motion::LoosenUntilItSlides, DMatrix::from_element(1, 1, 0.03_f64.powi(-2))),
            ],
        },
    ]
}

fn weight(
    name: &str,
    object: &GraspRecord,
    bias_error: Option<f64>,
    bias_noise_n: f64,
    row_s: f64,
    free_row_s: f64,
) -> Problem {
    let (collected, variance) = collected(&object.weight);
    let mut information = with_copy(&collected, 0);
    if let Some(error) = bias_error {
        information[(2, 2)] += error.powi(-2);
    }
    let rows = 1.0 / row_s;
    let seconds = (object.weight.rows() as f64 * row_s).max(row_s);
    let carry = |accelerations: &[f64]| -> DMatrix<f64> {
        let rows_of: Vec<Vec<f64>> = accelerations.iter().map(|a| vec![1.0, *a, 1.0]).collect();
        per_second(&rows_of, rows) / variance
    };
    let free_noise = if bias_noise_n > 0.0 { bias_noise_n } else { variance.sqrt() };
    let let_go = per_second(&[vec![0.0, 0.0, 1.0]], 1.0 / free_row_s) / (free_noise * free_noise);
    Problem {
        object: name.to_owned(),
        names: vec![("weight_N".to_owned(), 0), ("mass_kg".to_owned(), 0)],
        information,
        before: vec![10.0, 10.0, 10.0],
        motions: vec![
            (Motion::GoOn, with_copy(&(collected / seconds), 0)),
            (Motion::HoldAboveGround, carry(&[0.1, -0.1])),
            (Motion::LiftAndLower, carry(&[2.0, -2.0, 1.0, -1.0])),
            (Motion::LetGo, let_go),
        ],
    }
}

fn width(name: &str, object: &GraspRecord, row_s: f64) -> Problem {
    let (information, variance) = collected(&object.width);
    let seconds = (object.width.rows() as f64 * row_s).max(row_s);
    let (grip, spread) = object.grip_and_spread();
    let hold = |grips: &[f64], rate: f64| {
        let rows: Vec<Vec<f64>> =
            grips.iter().enumerate().map(|(k, f)| vec![1.0, *f, if k % 2 == 0 { rate } else { -rate }]).collect();
        per_second(&rows, 1.0 / row_s) / variance
    };
    let same = &information / seconds;
    Problem {
        object: name.to_owned(),
        names: vec![("width_m".to_owned(), 0)],
        information,
        before: vec![1.0, 0.01, 1.0],
        motions: vec![
            (Motion::GoOn, same),
            (Motion::HoldAboveGround, hold(&[grip - spread, grip + spread], 1e-4)),
            (Motion::SqueezeMoreAndLess, hold(&[0.6 * grip, 0.8 * grip, 1.2 * grip, 1.4 * grip], 1e-3)),
        ],
    }
}
