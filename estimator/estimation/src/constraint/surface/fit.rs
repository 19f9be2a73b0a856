//! The plane of contact: height over the way along it and over the push.

use super::split::{Pressed, Split, mean};
use crate::regression::linear::{LinearFit, least_squares};
use nalgebra::{Matrix3, SymmetricEigen, Vector3};

/// Rows that the contact is averaged to, at most: neighbouring samples say the same.
const ROWS: usize = 400;
/// Least way of a sliding tool, m, and in multiples of the noise, from which the slant is taken from the positions.
const SLID_M: f64 = 3e-3;
const SLID_NOISES: f64 = 20.0;
/// A second direction of sliding counts from this share of the first on.
const SECOND_SHARE: f64 = 0.1;
/// Steps of the slant towards its end.
const STEPS: usize = 6;
/// Size of a bend in standard errors from which it is seen.
const SEEN: f64 = 3.0;
/// Share of the depth that a straight law of give gets wrong.
const GIVE_SHARE: f64 = 0.01;
/// Room beside the touched part that counts as part of it, as a share of its length.
const BESIDE_SHARE: f64 = 0.1;

/// A plane with its errors.
#[derive(Clone, Debug)]
pub(super) struct Plane {
    /// Out of the surface.
    pub normal: Vector3<f64>,
    /// Unit vector along the longest way of sliding.
    pub along: Vector3<f64>,
    /// Middle of the contact, m.
    middle: Vector3<f64>,
    /// Height of the unloaded surface over the middle of the contact, along the normal, m.
    offset_m: f64,
    pub offset_error_m: f64,
    pub tilt_error_rad: f64,
    /// Give, m/N, with its error, where the push varied.
    pub give_m_n: Option<(f64, f64)>,
    /// Length of the contact along `along`, m.
    pub reach_m: f64,
    /// Far enough for the slant to be known from it.
    pub slid: bool,
    pub rms_m: f64,
    /// Sagitta of the contact and its error, m.
    sagitta_m: (f64, f64),
    /// Ends of the touched part, m.
    pub touched: [Vector3<f64>; 2],
}

/// Means of neighbouring samples of contact.
pub(super) struct Rows {
    pub point: Vec<Vector3<f64>>,
    pub force: Vec<Vector3<f64>>,
}

impl Rows {
    pub(super) fn of(pressed: &Pressed<'_>, split: &Split) -> Self {
        let runs = split.runs();
        let total: usize = runs.iter().map(std::ops::Range::len).sum();
        let width = total.div_ceil(ROWS).max(1);
        let (mut point, mut force) = (Vec::new(), Vec::new());
        for run in runs {
            for start in run.clone().step_by(width) {
                let part = start..(start + width).min(run.end);
                point.extend(mean(pressed.points[part.clone()].iter()));
                force.extend(mean(split.force[part].iter()));
            }
        }
        Self { point, force }
    }
}

impl Plane {
    pub(super) fn fit(pressed: &Pressed<'_>, split: &Split) -> Option<Self> {
        let rows = Rows::of(pressed, split);
        let middle = mean(rows.point.iter())?;
        let (first, second) = ways(&rows, middle, split.push, pressed.planar);
        let extent = |axis: &Vector3<f64>| {
            let places = rows.point.iter().map(|p| axis.dot(&(p - middle)));
            let (low, high) =
                places.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h): (f64, f64), v| (l.min(v), h.max(v)));
            high - low
        };
        let enough = SLID_M.max(SLID_NOISES * split.position_noise_m);
        let slid = extent(&first) > enough;
        let both = slid && !pressed.planar && extent(&second) > enough.max(SECOND_SHARE * extent(&first));
        let mut frame = Frame { normal: -split.push, along: first, across: second };
        if slid {
            frame = frame.leaning_on_the_push(split.push, pressed.planar);
        }
        let mut solved = rows.solve(&frame, middle, slid, both, false)?;
        for _ in 0..STEPS {
            if !slid {
                break;
            }
            frame = frame.turned(solved.slants[0], solved.slants[1]);
            solved = rows.solve(&frame, middle, slid, both, false)?;
        }
        let bent = if slid { rows.solve(&frame, middle, slid, both, true) } else { None };
        let reach_m = extent(&frame.along);
        let ends = rows.ends(&frame, middle);
        Some(Self {
            normal: frame.normal,
            along: frame.along,
            middle,
            offset_m: solved.fit.values[0],
            offset_error_m: solved.fit.std_errors[0],
            tilt_error_rad: solved.slant_error,
            give_m_n: solved.give,
            sagitta_m: bent.map_or((0.0, f64::INFINITY), |b| {
                let half = 0.25 * reach_m * reach_m;
                (b.bend.0 * half, b.bend.1 * half)
            }),
            rms_m: solved.fit.rms,
            reach_m,
            slid,
            touched: ends,
        })
    }

    /// Above the surface, m; negative inside.
    pub(super) fn height_m(&self, point: &Vector3<f64>) -> f64 {
        self.normal.dot(&(point - self.middle)) - self.offset_m
    }

    /// A point of the unloaded surface in the middle of the contact, m.
    pub(super) fn point_m(&self) -> Vector3<f64> {
        self.middle + self.normal * self.offset_m
    }

    /// Over or under the part that was touched.
    pub(super) fn beside(&self, point: &Vector3<f64>) -> bool {
        let place = |p: &Vector3<f64>| self.along.dot(&(p - self.middle));
        let [from, to] = [place(&self.touched[0]), place(&self.touched[1])];
        let room = BESIDE_SHARE * (to - from);
        (from - room..=to + room).contains(&place(point))
    }

    /// The contact follows a bent line by more than `close_m`, and certainly so.
    pub(super) fn bends(&self, close_m: f64) -> bool {
        self.sagitta_m.0.abs() > close_m && self.sagitta_m.0.abs() > SEEN * self.sagitta_m.1
    }
}

/// Normal and two directions along the surface, right-handed.
#[derive(Clone, Copy)]
struct Frame {
    normal: Vector3<f64>,
    along: Vector3<f64>,
    across: Vector3<f64>,
}

impl Frame {
    /// The push less its part along the sliding, which is friction's.
    fn leaning_on_the_push(self, push: Vector3<f64>, planar: bool) -> Self {
        let out = -(push - self.along * self.along.dot(&push));
        let Some(normal) = out.try_normalize(1e-9) else { return self };
        let across = if planar { self.across } else { normal.cross(&self.along) };
        Self { normal, along: self.along, across }
    }

    /// After the heights were seen to rise by these slopes.
    fn turned(self, along: f64, across: f64) -> Self {
        let normal = (self.normal - self.along * along - self.across * across).normalize();
        let way = (self.along - normal * normal.dot(&self.along)).try_normalize(1e-9).unwrap_or(self.along);
        let side = self.across - normal * normal.dot(&self.across) - way * way.dot(&self.across);
        Self { normal, along: way, across: side.try_normalize(1e-9).unwrap_or(self.across) }
    }
}

struct Solved {
    fit: LinearFit,
    slants: [f64; 2],
    slant_error: f64,
    give: Option<(f64, f64)>,
    bend: (f64, f64),
}

impl Rows {
    fn solve(&self, frame: &Frame, middle: Vector3<f64>, slid: bool, both: bool, bent: bool) -> Option<Solved> {
        let place = |axis: &Vector3<f64>| self.point.iter().map(|p| axis.dot(&(p - middle))).collect::<Vec<f64>>();
        let push: Vec<f64> = self.force.iter().map(|f| -frame.normal.dot(f)).collect();
        let along = place(&frame.along);
        // Deeper where it is pushed harder: the offset is that of no push.
        let mut columns = vec![vec![1.0; push.len()], push.iter().map(|f| -f).collect()];
        if slid {
            columns.push(along.clone());
        }
        if both {
            columns.push(place(&frame.across));
        }
        if bent {
            columns.push(along.iter().map(|s| s * s).collect());
        }
        let fit = least_squares(&columns, &place(&frame.normal), None).ok()?;
        let at = |j: usize| (fit.values[j], fit.std_errors[j]);
        let (first, second) = (if slid { at(2) } else { (0.0, 0.0) }, if both { at(3) } else { (0.0, 0.0) });
        let bend = if bent { at(columns.len() - 1) } else { (0.0, 0.0) };
        let pressed = fit.values[1].abs() * range(&push);
        let slant_error = if slid {
            // A give that is not straight tips the plane where it is pressed unevenly.
            first.1.hypot(second.1).hypot(GIVE_SHARE * pressed / range(&along).max(f64::MIN_POSITIVE))
        } else {
            self.spread_rad(frame)
        };
        let give = fit.identified[1].then(|| at(1));
        Some(Solved { slants: [first.0, second.0], slant_error, give, bend, fit })
    }

    /// Standard deviation of the push's direction, rad.
    fn spread_rad(&self, frame: &Frame) -> f64 {
        let aside =
            |f: &Vector3<f64>| (f + frame.normal * -frame.normal.dot(f)).norm() / f.norm().max(f64::MIN_POSITIVE);
        let sum: f64 = self.force.iter().map(|f| aside(f).powi(2)).sum();
        (sum / self.force.len().max(1) as f64).sqrt()
    }

    fn ends(&self, frame: &Frame, middle: Vector3<f64>) -> [Vector3<f64>; 2] {
        let place = |p: &&Vector3<f64>| frame.along.dot(&(*p - middle));
        let end = |sign: f64| {
            let most = self.point.iter().max_by(|a, b| (sign * place(a)).total_cmp(&(sign * place(b))));
            most.copied().unwrap_or(middle)
        };
        [end(-1.0), end(1.0)]
    }
}

fn range(values: &[f64]) -> f64 {
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    high - low
}

/// The two directions of the contact at right angles to the push, the longer one first.
fn ways(rows: &Rows, middle: Vector3<f64>, push: Vector3<f64>, planar: bool) -> (Vector3<f64>, Vector3<f64>) {
    if planar {
        return (Vector3::new(-push.y, push.x, 0.0), Vector3::z());
    }
    let spread: Matrix3<f64> = rows
        .point
        .iter()
        .map(|p| p - middle)
        .map(|arm| arm - push * push.dot(&arm))
        .map(|arm| arm * arm.transpose())
        .sum();
    let eigen = SymmetricEigen::new(spread);
    let most = (0..3).max_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b])).unwrap_or(0);
    let first = eigen.eigenvectors.column(most).into_owned();
    let first = (first - push * push.dot(&first)).try_normalize(1e-9).unwrap_or_else(Vector3::x);
    (first, push.cross(&first))
}
