//! Trajectories of flights through air, fitted to the positions themselves: accelerations by differences drown drag in
//! noise.
//!
//! p' = v, v' = −σ g up − k |v| v + s × v: gravity in the scale σ of the lengths, quadratic drag (Rayleigh 1876), and the
//! lift of a spinning body in proportion to its speed (Magnus 1853). Every flight has its own initial state and spin; σ
//! and k are common to all. Nonlinear least squares of the positions (Gauss–Newton, one shooting interval a flight).

use super::flight::{Fall, end, least};
use super::pose::Track;
use crate::identify::limits::SIGNIFICANT;
use nalgebra::{DMatrix, DVector, Rotation3, Vector3};

/// Evidence, 2 ln(likelihood ratio) less the price of the parameters, from which a part of a model is beyond doubt.
/// Derived: below 1 in 20000 by chance.
pub const CLEAR: f64 = 20.0;

/// Free parameters of a model beside the initial states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Free {
    /// Scale of the lengths.
    pub scale: bool,
    /// Drag, common to all flights.
    pub drag: bool,
    /// Spin of each flight.
    pub spin: bool,
}

/// The likeliest model of all flights, and the evidence for each of its parts.
#[derive(Clone, Debug)]
pub struct Air {
    /// The likeliest model.
    pub best: Trajectories,
    /// The likeliest one with a free scale.
    pub scaled: Option<Trajectories>,
    /// Scale of the lengths.
    pub scale: Evidence,
    /// Drag.
    pub drag: Evidence,
    /// Spin.
    pub spin: Evidence,
}

/// Evidence for a part of a model of flights.
#[derive(Clone, Copy, Debug, Default)]
pub struct Evidence {
    /// 2 ln(likelihood ratio) of the best model with it and the best one without, less the price of the parameters.
    pub score: f64,
    /// True if it explains more than what the best model leaves above the noise.
    pub carries: bool,
    /// Residual RMS of the best model without it, m.
    pub rms_without_m: f64,
}

impl Evidence {
    /// True if this part of the model is beyond doubt.
    pub fn is_clear(&self) -> bool {
        self.carries && self.score > CLEAR
    }
}

/// Compares all models of the flights; `None` if none converges.
pub fn air(tracks: &[Track], gravity_m_s2: f64) -> Option<Air> {
    // The spin of a body whose orientations were recorded is no free parameter.
    let may_spin = tracks.iter().any(|track| track.turned.is_none());
    let all: Vec<([bool; 3], Trajectories)> = (0..if may_spin { 8 } else { 4 })
        .map(|k| [k & 1 > 0, k & 2 > 0, k & 4 > 0])
        .filter_map(|[scale, drag, spin]| {
            let found = fit(tracks, gravity_m_s2, Free { scale, drag, spin })?;
            (!drag || found.drag_per_m[0] > 0.0).then_some(([scale, drag, spin], found))
        })
        .collect();
    // The residual of the richest model tells how much its neighbours have in common.
    let rows = all.last()?.1.rows;
    let price = |found: &Trajectories| rows * found.mean_square_m2.max(1e-300).ln() + found.parameters * rows.ln();
    let least = |keep: &dyn Fn(&[bool; 3]) -> bool| {
        let kept = all.iter().filter(|(free, _)| keep(free)).map(|(_, found)| found);
        kept.min_by(|a, b| price(a).total_cmp(&price(b)))
    };
    let best = least(&|_| true)?.clone();
    let noises: Vec<f64> = flights(tracks).iter().filter_map(noise_m).map(|noise_m| noise_m * noise_m).collect();
    let structure_m2 = best.rms_m.powi(2) - noises.iter().sum::<f64>() / noises.len().max(1) as f64;
    let evidence = |part: usize| {
        let [without, with] = [false, true].map(|has| least(&|free| free[part] == has));
        let (Some(without), Some(with)) = (without, with) else { return Evidence::default() };
        let carries = without.rms_m.powi(2) - best.rms_m.powi(2) > structure_m2;
        Evidence { score: price(without) - price(with), carries, rms_without_m: without.rms_m }
    };
    let scaled = least(&|free| free[0]).cloned();
    Some(Air { scale: evidence(0), drag: evidence(1), spin: evidence(2), scaled, best })
}

impl Air {
    /// True if drag or spin bends the flights: their parabolas then do not show the scale of the lengths.
    pub fn bends(&self) -> bool {
        self.drag.is_clear() || self.spin.is_clear()
    }

    /// The fall beside drag and spin.
    pub fn fall(&self, parabolas: Fall, gravity_m_s2: f64) -> Fall {
        let Some(scaled) = &self.scaled else { return parabolas };
        let [down_m_s2, error_m_s2] = scaled.scale.map(|value| value * gravity_m_s2);
        Fall { down_m_s2, error_m_s2, ..parabolas }
    }
}

/// A fitted model of all flights.
#[derive(Clone, Debug)]
pub struct Trajectories {
    /// Recorded length over true length, and its standard error.
    pub scale: [f64; 2],
    /// Quadratic drag over the mass, 1/m, and its standard error.
    pub drag_per_m: [f64; 2],
    /// Largest lift over gravity.
    pub lift_share: f64,
    /// Residual RMS of a coordinate, m.
    pub rms_m: f64,
    /// Mean square of the residual, m².
    mean_square_m2: f64,
    /// Number of parameters.
    parameters: f64,
    /// Effective number of independent rows.
    rows: f64,
}

/// One flight.
struct Flight {
    time_s: Vec<f64>,
    points: Vec<Vector3<f64>>,
    /// Orientations of the body, if all tracks have them.
    turned: Option<Vec<Rotation3<f64>>>,
}

/// Values that all flights share: scale, drag over mass in 1/m, and the tracked point in the body, m.
#[derive(Clone, Copy, Debug)]
struct Common {
    scale: f64,
    drag_per_m: f64,
    point_m: Vector3<f64>,
}

/// Parameters of one flight: position, velocity, spin.
type Own = [Vector3<f64>; 3];

/// Number of a flight's own parameters.
fn own_size(free: Free) -> usize {
    if free.spin { 9 } else { 6 }
}

/// The long flights of some tracks.
fn flights(tracks: &[Track]) -> Vec<Flight> {
    let has_turned = tracks.iter().all(|track| track.turned.is_some());
    let of = |track: &Track| {
        let n = end(track);
        let flight = Flight {
            time_s: track.time_s[..n].iter().map(|time_s| time_s - track.time_s[0]).collect(),
            points: track.points[..n].to_vec(),
            turned: track.turned.as_ref().filter(|_| has_turned).map(|all| all[..n].to_vec()),
        };
        (n >= least(track)).then_some(flight)
    };
    tracks.iter().filter_map(of).collect()
}

/// Fits a model to all flights; `None` without any, or if it does not converge.
pub fn fit(tracks: &[Track], gravity_m_s2: f64, free: Free) -> Option<Trajectories> {
    let flights = flights(tracks);
    let mut own: Vec<Own> = flights.iter().map(start).collect::<Option<_>>()?;
    let has_turned = flights.iter().any(|flight| flight.turned.is_some());
    let shared = usize::from(free.scale) + usize::from(free.drag) + if has_turned { 3 } else { 0 };
    let size = own_size(free);
    let mut common = Common { scale: 1.0, drag_per_m: 0.0, point_m: Vector3::zeros() };
    let mut inverse = DMatrix::zeros(shared, shared);
    // Flights are nearly parabolas: each round of Gauss and Newton squares the error.
    for _ in 0..8 {
        let (mut normal, mut right) = (DMatrix::zeros(shared, shared), DVector::zeros(shared));
        let mut local = Vec::new();
        for (flight, own) in flights.iter().zip(&own) {
            let (jacobian, residual) = linearized(flight, own, &common, (gravity_m_s2, free));
            let (of_own, of_common) = (jacobian.columns(0, size), jacobian.columns(size, shared));
            // A flight in a plane shows one component of its spin.
            let solve = inverted(of_own.tr_mul(&of_own), 1e-9)?;
            let (cross, pull) = (of_own.tr_mul(&of_common), of_own.tr_mul(&residual));
            normal += of_common.tr_mul(&of_common) - cross.tr_mul(&(&solve * &cross));
            right += of_common.tr_mul(&residual) - cross.tr_mul(&(&solve * &pull));
            local.push((solve, cross, pull));
        }
        inverse = inverted(normal, 1e-12)?;
        let change = &inverse * right;
        for (own, (solve, cross, pull)) in own.iter_mut().zip(local) {
            let step = solve * (pull - cross * &change);
            own.iter_mut().flat_map(Vector3::iter_mut).zip(step.iter()).for_each(|(value, step)| *value += step);
        }
        let mut changes = change.iter();
        common.scale += if free.scale { *changes.next()? } else { 0.0 };
        common.drag_per_m += if free.drag { *changes.next()? } else { 0.0 };
        common.point_m.iter_mut().zip(changes).for_each(|(value, change)| *value += change);
        if !common.scale.is_finite() || !common.drag_per_m.is_finite() {
            return None;
        }
    }
    told(&flights, &own, (&common, &inverse), (gravity_m_s2, free))
}

/// Pseudo-inverse of normal equations, empty for none; `None` if they are not finite. Singular values below a share of the
/// largest one count as zero.
fn inverted(normal: DMatrix<f64>, share: f64) -> Option<DMatrix<f64>> {
    if normal.is_empty() {
        return Some(normal);
    }
    let largest = normal.amax();
    normal.iter().all(|v| v.is_finite()).then(|| normal.pseudo_inverse(share * largest).ok()).flatten()
}

fn told(
    flights: &[Flight],
    own: &[Own],
    (common, inverse): (&Common, &DMatrix<f64>),
    (gravity_m_s2, free): (f64, Free),
) -> Option<Trajectories> {
    let (mut square, mut together, mut rows, mut lift_share) = (0.0, 0.0, 0.0, 0.0_f64);
    for (flight, own) in flights.iter().zip(own) {
        let path = predicted(flight, own, common, gravity_m_s2);
        let left: Vec<Vector3<f64>> = flight.points.iter().zip(&path).map(|(p, (q, _))| p - q).collect();
        square += left.iter().map(Vector3::norm_squared).sum::<f64>();
        together += left.windows(2).map(|pair| pair[0].dot(&pair[1])).sum::<f64>();
        rows += 3.0 * left.len() as f64;
        let lift = path.iter().map(|(_, velocity)| own[2].cross(velocity).norm()).fold(0.0, f64::max);
        lift_share = lift_share.max(lift / gravity_m_s2);
    }
    // In a plane, the third coordinate and two components of the spin say nothing.
    let count = flights.len() as f64;
    let parameters =
        if free.spin { 7.0 } else { 6.0 } * count + f64::from(u8::from(free.scale)) + f64::from(u8::from(free.drag));
    let freedom = (rows - parameters).max(1.0);
    let alike = (together / square.max(f64::MIN_POSITIVE)).clamp(0.0, 0.95);
    let effective = (rows * (1.0 - alike) / (1.0 + alike)).max(parameters + 1.0);
    let variance = square / freedom * rows / effective;
    let error = |k: usize| (inverse[(k, k)] * variance).max(0.0).sqrt();
    let scale_error = if free.scale { error(0) } else { 0.0 };
    let drag_error = if free.drag { error(usize::from(free.scale)) } else { 0.0 };
    square.is_finite().then(|| Trajectories {
        scale: [common.scale, scale_error],
        drag_per_m: [common.drag_per_m, drag_error],
        lift_share,
        rms_m: (square / freedom).sqrt(),
        mean_square_m2: square / rows,
        parameters,
        rows: effective,
    })
}

/// Initial state by a cubic polynomial through the flight.
fn start(flight: &Flight) -> Option<Own> {
    let (solved, _) = polynomial(flight, 4)?;
    let row = |k: usize| Vector3::from_fn(|axis, _| solved[(k, axis)]);
    Some([row(0), row(1), Vector3::zeros()])
}

/// Positions and velocities at the samples of a flight.
fn predicted(flight: &Flight, own: &Own, common: &Common, gravity_m_s2: f64) -> Vec<(Vector3<f64>, Vector3<f64>)> {
    let [mut position, mut velocity, spin] = *own;
    let acceleration = |v: Vector3<f64>| {
        Vector3::new(0.0, 0.0, -common.scale * gravity_m_s2) - common.drag_per_m * v.norm() * v + spin.cross(&v)
    };
    let mut time_s = flight.time_s[0];
    let mut path = Vec::with_capacity(flight.time_s.len());
    for (i, to_s) in flight.time_s.iter().enumerate() {
        // Two steps of Runge and Kutta a sample: even at 30 Hz they are off by less than a micrometre.
        let h = 0.5 * (to_s - time_s);
        for _ in 0..2 {
            let a1 = acceleration(velocity);
            let a2 = acceleration(velocity + 0.5 * h * a1);
            let a3 = acceleration(velocity + 0.5 * h * a2);
            let a4 = acceleration(velocity + h * a3);
            position += h * velocity + h * h / 6.0 * (a1 + a2 + a3);
            velocity += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
        }
        time_s = *to_s;
        let beside = flight.turned.as_ref().map_or_else(Vector3::zeros, |turned| turned[i] * common.point_m);
        path.push((position + beside, velocity));
    }
    path
}

/// Jacobian of a flight's positions, own parameters first, and their residual.
fn linearized(
    flight: &Flight,
    own: &Own,
    common: &Common,
    (gravity_m_s2, free): (f64, Free),
) -> (DMatrix<f64>, DVector<f64>) {
    // The cube root of a double's rounding error.
    let by = 1e-6;
    let at = |own: &Own, common: &Common| -> Vec<f64> {
        predicted(flight, own, common, gravity_m_s2).iter().flat_map(|(p, _)| [p.x, p.y, p.z]).collect()
    };
    let here = at(own, common);
    let mut moved: Vec<(Own, Common)> = Vec::new();
    for k in 0..own_size(free) {
        let mut own = *own;
        own[k / 3][k % 3] += by;
        moved.push((own, *common));
    }
    let shared = [
        free.scale.then_some(Common { scale: common.scale + by, ..*common }),
        free.drag.then_some(Common { drag_per_m: common.drag_per_m + by, ..*common }),
    ];
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let points = axes.map(|axis| Common { point_m: common.point_m + by * axis, ..*common });
    let points = points.into_iter().filter(|_| flight.turned.is_some());
    moved.extend(shared.into_iter().flatten().chain(points).map(|common| (*own, common)));
    let there: Vec<Vec<f64>> = moved.iter().map(|(own, common)| at(own, common)).collect();
    let measured = flight.points.iter().flat_map(|p| [p.x, p.y, p.z]);
    let residual = DVector::from_iterator(here.len(), measured.zip(&here).map(|(m, h)| m - h));
    (DMatrix::from_fn(here.len(), there.len(), |i, j| (there[j][i] - here[i]) / by), residual)
}

/// True if all flights are free flights through air: drag, spin and a scale of at most `most_off` leave hardly more than
/// the noise of the positions, the drag takes energy out, and no flight is straight. Along a line, lift and drag could
/// carry the weight of what a hand leads.
pub fn is_flight(tracks: &[Track], gravity_m_s2: f64, most_off: f64) -> bool {
    let of = |scale| fit(tracks, gravity_m_s2, Free { scale, drag: true, spin: true });
    let is_like = |found: &Trajectories| (found.scale[0] - 1.0).abs() < most_off;
    [false, true].into_iter().filter_map(of).any(|found| is_like(&found) && flies(&flights(tracks), &found))
}

/// True if a model describes flights through air.
fn flies(flights: &[Flight], found: &Trajectories) -> bool {
    let noise_m = flights.iter().filter_map(noise_m).fold(0.0, f64::max);
    let [drag, error] = found.drag_per_m;
    let bends = flights.iter().all(|flight| off_line_m(flight) > SIGNIFICANT * found.rms_m);
    // A table tennis ball with a strong spin has a lift of 1.5 times its weight.
    let is_air = drag > -SIGNIFICANT * error && found.lift_share < 2.0;
    found.rms_m < SIGNIFICANT * noise_m && is_air && bends
}

/// RMS distance of a flight from the straight line along it, m.
fn off_line_m(flight: &Flight) -> f64 {
    let middle = flight.points.iter().sum::<Vector3<f64>>() / flight.points.len() as f64;
    let spread = flight.points.iter().map(|p| (p - middle) * (p - middle).transpose()).sum::<nalgebra::Matrix3<f64>>();
    let values = spread.symmetric_eigenvalues();
    ((values.sum() - values.max()).max(0.0) / flight.points.len() as f64).sqrt()
}

/// Noise of a coordinate, m: residual RMS of a polynomial of fourth degree, which bends more than any flight. `None` for
/// too few samples.
fn noise_m(flight: &Flight) -> Option<f64> {
    let (left, free) = polynomial(flight, 5)?.1;
    (free > 0).then(|| (left / free as f64).sqrt())
}

/// Coefficients of the polynomials through a flight, a row for each power and a column for each axis, the sum of their
/// squared residuals, m², and its degrees of freedom.
fn polynomial(flight: &Flight, size: usize) -> Option<(DMatrix<f64>, (f64, usize))> {
    let n = flight.time_s.len();
    let span_s = flight.time_s[n - 1].max(f64::MIN_POSITIVE);
    let powers = DMatrix::from_fn(n, size, |i, j| (0..j).map(|_| flight.time_s[i] / span_s).product());
    let points = DMatrix::from_fn(n, 3, |i, axis| flight.points[i][axis]);
    let mut solved = powers.clone().svd(true, true).solve(&points, 1e-12).ok()?;
    let left = (&points - powers * &solved).norm_squared();
    for (j, mut row) in solved.row_iter_mut().enumerate() {
        (0..j).for_each(|_| row /= span_s);
    }
    // In a plane, the third axis has no noise.
    let axes = (0..3).filter(|axis| points.column(*axis).variance() > 0.0).count();
    Some((solved, (left, axes * n.saturating_sub(size))))
}
