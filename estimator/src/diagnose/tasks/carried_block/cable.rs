//! Cables and walls that a carried block may meet: a search over all directions and distances, refined at the best.

use super::rows::{Place, Rows};
use crate::diagnose::hypotheses::added_constraint;
use crate::diagnose::hypotheses::axis::Axis;
use crate::diagnose::hypotheses::candidate::{Candidate, Shape};
use crate::diagnose::selection::comparison::ChannelFit;
use estimation::regression::linear::least_squares;
use haptics::Vec2;
use haptics::law::{AddedConstraint, Kind};
use haptics::world::Cable;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;

/// Tried directions of the anchor from the middle of the carries, in turns.
/// Choice: no case of the ablation reads it.
const ANCHOR_DIRECTIONS: Axis = Axis::cells(20);
/// Tried inverse distances of the anchor, in 1/half ranges; 0 is a wall.
/// Choice: no case of the ablation reads it.
const NEARNESS: Axis = Axis::even(0.0, 0.6, 3);
/// Tried shares of the carries in which the cable is slack.
/// Choice: no case of the ablation reads it.
const SLACK_SHARES: Axis = Axis::even(0.15, 0.88, 5);
/// Number of starting points that are refined.
/// Choice: no case of the ablation reads it.
const REFINED: usize = 4;
/// Number of halvings of the step of a refinement.
/// Derived: the last step is 1/512 of the first one, below the errors of any cable seen.
const CABLE_HALVINGS: usize = 9;
/// Most moves with one step size. Without a cable the search does not converge.
/// Choice: no case of the ablation reads it.
const MOVES: usize = 15;
/// Distance of the anchor, in half ranges, from which a cable is a wall.
/// Derived: at 200 half ranges the circle about the anchor departs from a line by only 1/400 of a half range.
const FAR: f64 = 200.0;

/// Anchor of a cable, relative to the middle of the carries. Direction, rad; inverse distance, in 1/half ranges; travel
/// away from the anchor at which it becomes taut, in half ranges.
#[derive(Clone, Copy, Debug)]
struct Tie([f64; 3]);

/// Extent of the carries.
struct Field {
    middle: Vec2,
    range_m: f64,
}

impl Field {
    fn anchor_and_length(&self, tie: Tie) -> (Vec2, f64) {
        let Tie([direction, nearness, taut]) = tie;
        let away = self.range_m / nearness.clamp(1.0 / FAR, 0.95);
        let anchor = self.middle + away * Vec2::new(direction.cos(), direction.sin());
        // A cable of negative length would pull beyond any possible place.
        (anchor, (away + taut * self.range_m).max(0.0))
    }
}

/// The strongest cables beside `base`, each at one of the blocks.
pub fn cables(rows: &Rows<'_>, y: &[f64], base: &[Vec<f64>], weight: &[f64]) -> Vec<Candidate> {
    let explains = Explains::of(y, base, weight);
    (1..=rows.blocks()).flat_map(|number| at_block(rows, number, &explains, weight)).collect()
}

fn at_block(rows: &Rows<'_>, number: usize, explains: &Explains, weight: &[f64]) -> Vec<Candidate> {
    let places: Vec<Vec2> = rows
        .all
        .iter()
        .filter(|r| r.place == (Place::Carried { number, axis: 1 }))
        .map(|r| Vec2::new(rows.seen[r.recording].place[0][r.i], rows.seen[r.recording].place[1][r.i]))
        .collect();
    if places.is_empty() {
        return Vec::new();
    }
    let middle = places.iter().sum::<Vec2>() / places.len() as f64;
    let range_m = places.iter().map(|p| (p - middle).norm()).fold(0.0, f64::max);
    if range_m <= 0.0 {
        return Vec::new();
    }
    let field = Field { middle, range_m };
    let worth = |tie: Tie| {
        let (anchor, length) = field.anchor_and_length(tie);
        explains.worth(&pull(rows, number, anchor, length), weight)
    };
    let mut tried: Vec<(f64, Tie)> = Vec::new();
    for (turn, nearness) in ANCHOR_DIRECTIONS.values().flat_map(|turn| NEARNESS.values().map(move |d| (turn, d))) {
        let direction = TAU * turn;
        let (anchor, away) = field.anchor_and_length(Tie([direction, nearness, 0.0]));
        let mut lengths: Vec<f64> = places.iter().map(|p| ((p - anchor).norm() - away) / range_m).collect();
        lengths.sort_by(f64::total_cmp);
        for slack in SLACK_SHARES.values() {
            let tie = Tie([direction, nearness, lengths[(slack * (lengths.len() - 1) as f64) as usize]]);
            tried.push((worth(tie), tie));
        }
    }
    tried.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut found: Vec<Candidate> = Vec::new();
    for (_, start) in tried.into_iter().take(REFINED) {
        let (anchor, length) = field.anchor_and_length(refined(start, &worth));
        found.push(one(rows, number, anchor, length));
    }
    found
}

/// Pattern search (Hooke & Jeeves 1961).
fn refined(start: Tie, worth: &dyn Fn(Tie) -> f64) -> Tie {
    let mut best = (worth(start), start);
    let mut steps = [0.15, 0.15, 0.15];
    for _ in 0..CABLE_HALVINGS {
        for _ in 0..MOVES {
            let before = best.0;
            for (k, step) in steps.into_iter().enumerate() {
                for sign in [1.0, -1.0] {
                    let mut tie = best.1;
                    tie.0[k] += sign * step;
                    tie.0[1] = tie.0[1].max(0.0);
                    let now = worth(tie);
                    if now > best.0 {
                        best = (now, tie);
                    }
                }
            }
            if best.0 <= before * (1.0 + 1e-4) {
                break;
            }
        }
        steps = steps.map(|s| 0.5 * s);
    }
    best.1
}

/// Residual of the base model, for the part that a regressor explains of it.
struct Explains {
    own: DMatrix<f64>,
    left: DVector<f64>,
}

impl Explains {
    fn of(y: &[f64], base: &[Vec<f64>], weight: &[f64]) -> Self {
        let used: Vec<&Vec<f64>> = base.iter().filter(|c| c.iter().any(|v| *v != 0.0)).collect();
        let own = DMatrix::from_fn(y.len(), used.len(), |i, j| used[j][i] * weight[i]).qr().q();
        let y = DVector::from_fn(y.len(), |i, _| y[i] * weight[i]);
        let left = &y - &own * own.tr_mul(&y);
        Self { own, left }
    }

    /// Sum of squares that the regressor explains with a positive coefficient.
    fn worth(&self, column: &[f64], weight: &[f64]) -> f64 {
        let column = DVector::from_fn(column.len(), |i, _| column[i] * weight[i]);
        let beside = &column - &self.own * self.own.tr_mul(&column);
        let (along, size) = (beside.dot(&self.left), beside.norm_squared());
        if along > 0.0 && size > 1e-6 * column.norm_squared() { along * along / size } else { 0.0 }
    }
}

/// Force along an axis that a cable to a block asks of the hand, N, at a place, m, and a velocity, m/s. It damps while
/// it is taut.
pub fn pull_n(cable: &Cable, place_m: Vec2, velocity_m_s: Vec2, axis: usize) -> f64 {
    let away = place_m - cable.anchor_m;
    let length = away.norm().max(f64::MIN_POSITIVE);
    let damped = if length > cable.length_m { velocity_m_s.dot(&away) / length } else { 0.0 };
    let along = AddedConstraint::cable_n(cable.stiffness_n_m, cable.length_m, length) + cable.damping_n_s_m * damped;
    along * away[axis] / length
}

/// The same, row by row, of one to this block.
pub fn pulls(rows: &Rows<'_>, tied: usize, cable: &Cable) -> Vec<f64> {
    rows.carried(|seen, row, number, axis| {
        let both = |of: &[Vec<f64>; 2]| Vec2::new(of[0][row.i], of[1][row.i]);
        if number == tied { pull_n(cable, both(&seen.place), both(&seen.velocity), axis) } else { 0.0 }
    })
}

/// Force that a cable of 1 N/m demands of the hand, N.
fn pull(rows: &Rows<'_>, tied: usize, anchor_m: Vec2, length_m: f64) -> Vec<f64> {
    pulls(rows, tied, &Cable { anchor_m, length_m, stiffness_n_m: 1.0, damping_n_s_m: 0.0 })
}

/// Standard errors of stiffness, anchor and length of a found cable, with the uncertainty of its searched values.
/// `None` if they cannot be computed.
pub fn errors(rows: &Rows<'_>, study: &ChannelFit) -> Option<[f64; 4]> {
    /// Steps of the differences, m.
    /// Derived: far above rounding (1e-16 m) and far below the distance of an anchor, whose squared share is the error.
    const STEP_M: f64 = 1e-4;
    let picks = study.picks();
    let place = picks.iter().position(|p| study.candidates[*p].id == added_constraint::ID)?;
    let cable = &study.candidates[picks[place]];
    let value = |k: usize| cable.searched.get(k).map_or(0.0, |s| s.value);
    let at = [value(0), value(1), value(2)];
    let tied = rows.touched(&cable.regressors[0]);
    let k = study.solved.as_ref()?.values[study.system.own(&picks, place).start];
    let mut columns: Vec<Vec<f64>> = cable.regressors.iter().map(|column| column.to_vec()).collect();
    columns.extend((0..3).map(|p| {
        let moved = |step: f64| {
            let mut to = at;
            to[p] += step;
            pull(rows, tied, Vec2::new(to[0], to[1]), to[2])
        };
        let (after, before) = (moved(STEP_M), moved(-STEP_M));
        after.iter().zip(&before).map(|(a, b)| k * (a - b) / (2.0 * STEP_M)).collect()
    }));
    columns.extend(study.baseline.iter().filter(|c| c.iter().any(|v| *v != 0.0)).cloned());
    let others = study.picks().into_iter().filter(|p| *p != picks[place]);
    columns.extend(others.flat_map(|p| study.candidates[p].regressors.iter().map(|column| column.to_vec())));
    let squares: Vec<f64> = study.layout.weight.iter().map(|w| w * w).collect();
    let fit = least_squares(&columns, &study.target, Some(&squares)).ok()?;
    Some([fit.std_errors[0], fit.std_errors[2], fit.std_errors[3], fit.std_errors[4]])
}

fn one(rows: &Rows<'_>, tied: usize, anchor: Vec2, length_m: f64) -> Candidate {
    let damping = pulls(rows, tied, &Cable { anchor_m: anchor, length_m, stiffness_n_m: 0.0, damping_n_s_m: 1.0 });
    let columns = vec![pull(rows, tied, anchor, length_m), damping];
    Candidate::several(added_constraint::ID, Kind::Plant, columns, vec![("k", "N/m"), ("c", "N s/m")])
        .positive()
        .shaped(Shape::Damped)
        .at("anchor x", anchor.x, "m")
        .at("anchor y", anchor.y, "m")
        .at("length", length_m, "m")
}
