//! The path before the force: centre and radius of a crank, and the causes that distort the circle.

use super::candidate::Candidate;
use super::force::leave_out_what_harms;
use super::select::{Chosen, Selection};
use super::system::{Held, Rows, Solved, System, solve, uses};
use super::white::whitener;
use crate::estimate::EstimateError;
use crate::identify::linear::least_squares;
use crate::signal::noise::white_noise;
use haptics::Vec2;
use haptics::law::Kind;

/// A grasp that moves on the handle; the parameter of one that moves along the arm.
const SLIP: &str = "fingertip-slip";
const OUTWARD: &str = "dr";
/// Parameters of a finger's joint and first link, of one finger and of two.
const OF_THE_FINGER: [&str; 2] = ["delta", "link_error"];
const OF_FINGERS: [[&str; 2]; 2] = [["delta1", "link_error1"], ["delta2", "link_error2"]];
/// Generic waves round a turn, and slow ones over the recording.
const WAVES: u32 = 4;
const SLOW: u32 = 4;
/// A path that is off its circle by more than this many times its noise should have a reason.
const STRANGE: f64 = 2.0;
/// Starts of a slip that are tried.
const SLIP_STARTS: usize = 24;
/// When a creep of the grasp begins, and for how long it goes on, in shares of the recording.
const CREEP_STARTS: [f64; 4] = [0.0, 0.25, 0.5, 0.75];
const CREEPS: [f64; 3] = [0.25, 0.5, 1.0];
/// How much farther apart they are than slips.
const CREEPS_APART: f64 = 4.0;
/// A jump is looked for at so many times, this part of the rows away from the ends, and must gain so much in 2 ln(likelihood) of white rows.
const JUMPS: usize = 240;
const JUMP_MARGIN: usize = 50;
const JUMPED: f64 = 100.0;
/// A breath of ridge keeps equal columns apart.
const JUMP_RIDGE: f64 = 1e-9;
/// Rounds of the linearised circle fit, and those after which the time of a slip is known well enough.
const ROUNDS: usize = 8;
const CLOSER: usize = 5;

/// One held sample.
pub struct PathPoint {
    /// Row of the signals.
    pub index: usize,
    pub stretch: usize,
    pub time_s: f64,
    pub position: Vec2,
    pub force: Vec2,
    /// ∂position/∂(top joint angle) and ∂position/∂(length of the first link) of each finger, where joints were recorded.
    pub joints: [Option<[Vec2; 2]>; 2],
    /// A mean of points on an arc lies inside it by this over the radius, m².
    pub inside_m2: f64,
}

/// What the geometry is found from.
pub struct Path {
    pub points: Vec<PathPoint>,
    pub period_s: f64,
    /// Two pads hold the handle: their give belongs to the model.
    pub two_fingered: bool,
}

impl Path {
    fn span_s(&self) -> f64 {
        let ends = self.points.first().zip(self.points.last());
        ends.map_or(0.0, |(first, last)| last.time_s - first.time_s)
    }
}

/// The circle that the handle follows.
#[derive(Clone, Debug)]
pub struct Arm {
    /// m
    pub center_m: Vec2,
    pub radius_m: f64,
    /// What is subtracted from the measured position of a signals' row, m.
    pub shifts: Vec<Vec2>,
    /// What the whole arm stands wrongly turned by, rad: a circle does not show it, the directions of the forces do.
    pub turn_rad: f64,
}

impl Arm {
    /// From the centre to the handle, m.
    pub fn arm(&self, row: usize, position: Vec2) -> Vec2 {
        let arm = position - self.shifts.get(row).copied().unwrap_or_else(Vec2::zeros) - self.center_m;
        if self.turn_rad == 0.0 { arm } else { nalgebra::Rotation2::new(self.turn_rad) * arm }
    }
}

/// The circle, and what was found to distort it.
pub struct Geometry {
    pub arm: Arm,
    pub study: Study,
}

impl Geometry {
    /// By what share the path is too large for a known radius, and the error of that.
    pub fn too_large(&self, known_m: f64) -> Option<[f64; 2]> {
        let solved = self.study.solved.as_ref()?;
        let variance = solved.rss / (self.study.system.rows - solved.columns.len() as f64).max(1.0);
        Some([self.arm.radius_m / known_m - 1.0, (variance * solved.inverse[(0, 0)]).sqrt() / known_m])
    }
}

/// How far the causes of the last round displaced a point, m.
#[derive(Clone, Copy, Debug, Default)]
struct Displaced {
    exact: Vec2,
    /// In proportion to the parameters.
    linear: Vec2,
}

/// One comparison of causes: everything that words and figures are made of.
pub struct Study {
    pub candidates: Vec<Candidate>,
    pub chosen: Vec<Chosen>,
    pub system: System,
    /// All chosen, solved on the rows that train.
    pub solved: Option<Solved>,
    /// The target.
    pub y: Vec<f64>,
    pub base: Vec<Vec<f64>>,
    pub weight: Vec<f64>,
}

impl Study {
    /// Candidates that were chosen.
    pub fn picks(&self) -> Vec<usize> {
        self.chosen.iter().map(|c| c.candidate).collect()
    }
}

/// Fits the circle and asks what distorts it. `signals`: number of rows of the signals; `threshold`: least score of a cause.
pub fn geometry(path: &Path, signals: usize, threshold: f64) -> Result<Geometry, EstimateError> {
    let positions: Vec<Vec2> = path.points.iter().map(|p| p.position).collect();
    let mut center_m = circle(&positions)?;
    let mut shift_m = vec![Vec2::zeros(); signals];
    let mut bent = vec![Displaced::default(); path.points.len()];
    let mut radius_m = 0.0;
    let mut study = None;
    let mut coarse = Course::coarse(path);
    coarse.extend(jump(path, center_m));
    let mut courses = coarse.clone();
    let mut step_s = path.span_s() / SLIP_STARTS as f64;
    for round in 0..ROUNDS {
        let made = compare(path, (center_m, &bent), &courses, threshold)?;
        let Some(solved) = &made.solved else {
            return Err(EstimateError::Other("no circle fits the handle's path".to_owned()));
        };
        radius_m = solved.values[0];
        let step = Vec2::new(solved.values[1], solved.values[2]);
        center_m += step;
        bent = corrections(path, &made, &mut shift_m, center_m);
        // Slips that were found are looked for more and more closely.
        step_s *= 0.5;
        let found = made.chosen.iter().map(|c| &made.candidates[c.candidate]).filter(|c| c.id == SLIP);
        let finer: Vec<Course> = found.flat_map(|c| Course::of(c).around(step_s)).collect();
        let settled = step.norm() < 1e-8 && (finer.is_empty() || round > CLOSER);
        courses = [coarse.as_slice(), &finer].concat();
        study = Some(made);
        if settled && round > 1 {
            break;
        }
    }
    let study = study.ok_or_else(|| EstimateError::Other("no circle was fitted".to_owned()))?;
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

/// When the grasp jumped, if it did once and by much: two circles of one radius, before and after, leave least. A slip that is large beside the noise is
/// not seen by comparing one here and there: what is left between its time and the tried one looks like a noise with a memory, beside which no slip
/// is better than another.
fn jump(path: &Path, center_m: Vec2) -> Option<Course> {
    let outward = |p: &PathPoint| (p.position - center_m).normalize();
    let row = |p: &PathPoint| {
        let out = outward(p);
        [1.0, out.x, out.y, (p.position - center_m).norm()]
    };
    let products = |p: &PathPoint| {
        let row = nalgebra::Vector4::from(row(p));
        row * row.transpose()
    };
    let whole: nalgebra::Matrix4<f64> = path.points.iter().map(products).sum();
    // Columns: 1, out x, out y before and after; out x, out y, 1 after; the distance.
    let left = |after: &nalgebra::Matrix4<f64>| -> Option<f64> {
        let part = |i: usize, j: usize| match (i / 3, j / 3) {
            (0, 0) => whole[(i, j)],
            _ => after[(i % 3, j % 3)],
        };
        let right = nalgebra::Vector6::from_fn(|i, _| if i < 3 { whole[(i, 3)] } else { after[(i % 3, 3)] });
        let normal = nalgebra::Matrix6::from_fn(|i, j| part(i, j) * if i == j { 1.0 + JUMP_RIDGE } else { 1.0 });
        let solved = normal.cholesky()?.solve(&right);
        Some(whole[(3, 3)] - solved.dot(&right))
    };
    let n = path.points.len();
    let every = n.div_ceil(JUMPS).max(1);
    let mut after = whole;
    let mut best: Option<(f64, usize)> = None;
    for (k, point) in path.points.iter().enumerate() {
        let inside = k * JUMP_MARGIN > n && (n - k) * JUMP_MARGIN > n;
        if k % every == 0
            && inside
            && let Some(left) = left(&after)
            && best.is_none_or(|(least, _)| left < least)
        {
            best = Some((left, k));
        }
        after -= products(point);
    }
    let (least, k) = best?;
    let right = whole.fixed_view::<3, 1>(0, 3).into_owned();
    let plain = whole[(3, 3)] - whole.fixed_view::<3, 3>(0, 0).into_owned().cholesky()?.solve(&right).dot(&right);
    let much = n as f64 * (plain / least.max(1e-300)).ln();
    (much > JUMPED).then(|| Course { start_s: path.points[k].time_s, duration_s: None })
}

fn compare(
    path: &Path,
    (center_m, bent): (Vec2, &[Displaced]),
    courses: &[Course],
    threshold: f64,
) -> Result<Study, EstimateError> {
    let arms: Vec<Vec2> = path.points.iter().map(|p| p.position - center_m).collect();
    let outward: Vec<Vec2> = arms.iter().map(Vec2::normalize).collect();
    // What is known of the displacement enters as it is, and stays in the target as its columns can take it.
    let distance = |i: usize| (arms[i] - bent[i].exact).norm() + outward[i].dot(&bent[i].linear);
    let y: Vec<f64> = (0..arms.len()).map(|i| distance(i) + path.points[i].inside_m2 / arms[i].norm()).collect();
    let column = |f: &dyn Fn(usize) -> f64| (0..y.len()).map(f).collect::<Vec<f64>>();
    let mut base = vec![vec![1.0; y.len()], column(&|i| outward[i].x), column(&|i| outward[i].y)];
    if path.two_fingered {
        base.push(column(&|i| outward[i].x * path.points[i].force.x));
        base.push(column(&|i| outward[i].y * path.points[i].force.y));
    }
    let candidates = candidates(path, &outward, courses);
    let stretch: Vec<usize> = path.points.iter().map(|p| p.stretch).collect();
    let (testable, weight) = (vec![Held::Fully; y.len()], vec![1.0; y.len()]);
    let time_s: Vec<f64> = path.points.iter().map(|p| p.time_s).collect();
    let rows = Rows {
        y: &y,
        stretch: &stretch,
        testable: &testable,
        time_s: &time_s,
        weight: &weight,
        period_s: path.period_s,
    };
    // The whitening must not swallow what it is to leave: it comes from the residual of everything together.
    let unwhitened = System::new(&base, &candidates, &rows, Vec::new());
    let picks =
        Selection { system: &unwhitened, candidates: &candidates, threshold, dry: true, one_loss: false }.greedy();
    let columns = unwhitened.columns(&picks);
    let solved = solve(&unwhitened.train, &columns, unwhitened.train.ncols() - 1)
        .ok_or_else(|| EstimateError::Other("no circle fits the handle's path".to_owned()))?;
    let residual = residual(&y, &base, &candidates, &picks, &solved);
    let coefficients = whitener(&residual, &rows, &uses(&rows));
    let system = System::new(&base, &candidates, &rows, coefficients);
    let chosen = Selection { system: &system, candidates: &candidates, threshold, dry: true, one_loss: false }.run(&[]);
    let picks: Vec<usize> = chosen.iter().map(|c| c.candidate).collect();
    let solved = system.solve(&picks);
    let mut study = Study { candidates, chosen, system, solved, y, base, weight };
    // What a line misses of pads that harden, or one slip of two, looks like another cause, weakly, where it was fitted.
    leave_out_what_harms(&mut study, &stretch, threshold, &|_, _| true);
    Ok(study)
}

/// What is left of `y`.
pub fn residual(y: &[f64], base: &[Vec<f64>], candidates: &[Candidate], picks: &[usize], solved: &Solved) -> Vec<f64> {
    let columns: Vec<&Vec<f64>> = base.iter().chain(picks.iter().flat_map(|p| &candidates[*p].columns)).collect();
    (0..y.len()).map(|i| y[i] - columns.iter().zip(&solved.values).map(|(c, v)| c[i] * v).sum::<f64>()).collect()
}

fn candidates(path: &Path, outward: &[Vec2], courses: &[Course]) -> Vec<Candidate> {
    let points = &path.points;
    let column = |f: &dyn Fn(usize) -> f64| (0..points.len()).map(f).collect::<Vec<f64>>();
    let mut found = Vec::new();
    if !path.two_fingered {
        let normal = column(&|i| outward[i].dot(&points[i].force));
        found.push(Candidate::one("pad-compliance", Kind::Plant, "give", "m/N", normal).positive());
    }
    let names = if path.two_fingered { OF_FINGERS.as_slice() } else { &[OF_THE_FINGER] };
    for (finger, [delta, link_error]) in names.iter().enumerate() {
        if points.iter().all(|p| p.joints[finger].is_some()) {
            let of = |k: usize| column(&|i| points[i].joints[finger].map_or(0.0, |j| outward[i].dot(&j[k])));
            found.push(Candidate::one("joint-offset", Kind::Instrument, delta, "rad", of(0)));
            found.push(Candidate::one("length-scale", Kind::Instrument, link_error, "m", of(1)));
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
        // The grasp moves over a handle that keeps its direction, or along the arm of one that turns with it.
        let columns = vec![gone(&|i| outward[i].x), gone(&|i| outward[i].y)];
        let across = Candidate::several(SLIP, Kind::Plant, columns, vec![("dx", "m"), ("dy", "m")]);
        found.extend([across, Candidate::one(SLIP, Kind::Plant, OUTWARD, "m", gone(&|_| 1.0))].map(dated));
    }
    found
}

/// What is left of a path that no known cause explains: waves round the turn (a circle has none beyond its centre's) and slow changes.
fn generic(path: &Path, outward: &[Vec2]) -> Vec<Candidate> {
    let angle = |i: usize| outward[i].y.atan2(outward[i].x);
    let column = |of: &dyn Fn(usize) -> f64| (0..path.points.len()).map(of).collect::<Vec<f64>>();
    let term = |expression: String, columns: Vec<Vec<f64>>| {
        let linear = columns.iter().map(|_| ("amplitude", "m")).collect();
        Candidate { expression: Some(expression), ..Candidate::several("other", Kind::Plant, columns, linear) }
    };
    let waves = (2..=WAVES).map(|n| {
        let wave = |of: fn(f64) -> f64| column(&|i| of(f64::from(n) * angle(i)));
        term(format!("cos({n} theta + phi) of the path"), vec![wave(f64::cos), wave(f64::sin)])
    });
    let (start_s, span_s) = (path.points.first().map_or(0.0, |p| p.time_s), path.span_s().max(1e-9));
    let slow = (1..=SLOW).map(|k| {
        let wave = |i: usize| (std::f64::consts::PI * f64::from(k) * (path.points[i].time_s - start_s) / span_s).cos();
        term(format!("cos({k} pi t/T) of the path"), vec![column(&wave)])
    });
    waves.chain(slow).collect()
}

/// What is left of the path beside the causes that were found, if it is much more than the noise and goes with something: the generic term, its score
/// and the comparison with it in place.
pub fn unexplained(path: &Path, arm: &Arm, study: &Study) -> Option<(Study, usize, f64)> {
    let picks = study.picks();
    let solved = study.solved.as_ref()?;
    let left = residual(&study.y, &study.base, &study.candidates, &picks, solved);
    let rms = (left.iter().map(|r| r * r).sum::<f64>() / left.len().max(1) as f64).sqrt();
    if rms < STRANGE * white_noise(&study.y) {
        return None;
    }
    let outward: Vec<Vec2> = path.points.iter().map(|p| (p.position - arm.center_m).normalize()).collect();
    let candidates: Vec<Candidate> =
        picks.iter().map(|p| study.candidates[*p].clone()).chain(generic(path, &outward)).collect();
    let chosen = study.chosen.iter().enumerate().map(|(k, c)| Chosen { candidate: k, rivals: Vec::new(), ..c.clone() });
    let chosen: Vec<Chosen> = chosen.collect();
    let made = |candidates: Vec<Candidate>| -> Option<(Study, usize, f64)> {
        let stretch: Vec<usize> = path.points.iter().map(|p| p.stretch).collect();
        let testable = vec![Held::Fully; study.y.len()];
        let time_s: Vec<f64> = path.points.iter().map(|p| p.time_s).collect();
        let rows = Rows {
            y: &study.y,
            stretch: &stretch,
            testable: &testable,
            time_s: &time_s,
            weight: &study.weight,
            period_s: path.period_s,
        };
        let coefficients = study.system.coefficients.clone();
        let system = System::new(&study.base, &candidates, &rows, coefficients);
        let picks: Vec<usize> = (0..chosen.len()).collect();
        let selection =
            Selection { system: &system, candidates: &candidates, threshold: 0.0, dry: true, one_loss: false };
        let (term, score) = selection.unexplained(&picks)?;
        let solved = system.solve(&picks);
        let (y, base, weight) = (study.y.clone(), study.base.clone(), study.weight.clone());
        Some((Study { candidates, chosen, system, solved, y, base, weight }, term, score))
    };
    made(candidates)
}

/// When a grasp slips, and for how long it creeps; at once without a duration.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Course {
    start_s: f64,
    duration_s: Option<f64>,
}

impl Course {
    fn of(slip: &Candidate) -> Self {
        Self { start_s: slip.searched[0].value, duration_s: slip.searched.get(1).map(|d| d.value) }
    }

    /// Share of the way that is behind it.
    fn gone(self, time_s: f64) -> f64 {
        let since_s = time_s - self.start_s;
        self.duration_s.map_or(f64::from(u8::from(since_s >= 0.0)), |d| (since_s / d.max(1e-12)).clamp(0.0, 1.0))
    }

    /// What is tried at first. A grasp that creeps looks like a centre that wanders.
    fn coarse(path: &Path) -> Vec<Self> {
        let first = path.points.first().map_or(0.0, |p| p.time_s);
        let span_s = path.span_s();
        let slips = (1..SLIP_STARTS)
            .map(|k| Self { start_s: first + span_s * k as f64 / SLIP_STARTS as f64, duration_s: None });
        let creeps = CREEP_STARTS
            .iter()
            .flat_map(|start| CREEPS.map(|d| Self { start_s: first + span_s * start, duration_s: Some(span_s * d) }));
        slips.chain(creeps).collect()
    }

    /// What lies around one that was found, and itself.
    fn around(self, step_s: f64) -> Vec<Self> {
        // Creeps were tried farther apart.
        let wide_s = if self.duration_s.is_some() { CREEPS_APART * step_s } else { step_s };
        let starts = [-1.0, -0.5, 0.0, 0.5, 1.0].map(|s| self.start_s + s * wide_s);
        let Some(duration_s) = self.duration_s else {
            return starts.map(|start_s| Self { start_s, duration_s: None }).to_vec();
        };
        let lasts = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|s| duration_s + s * wide_s).into_iter().filter(|d| *d > step_s);
        // What looked like a creep may have gone at once in the middle of it.
        let middle_s = self.start_s + 0.5 * duration_s;
        let at_once = [-1.0, -0.5, 0.0, 0.5, 1.0].map(|s| Self { start_s: middle_s + s * wide_s, duration_s: None });
        lasts.flat_map(|d| starts.map(|start_s| Self { start_s, duration_s: Some(d) })).chain(at_once).collect()
    }
}

/// Which finger a cause of the joints is about.
fn finger(candidate: &Candidate) -> usize {
    usize::from(candidate.linear.first().is_some_and(|(name, _)| name.ends_with('2')))
}

/// What the found causes displaced the positions by.
fn corrections(path: &Path, study: &Study, shift_m: &mut [Vec2], center_m: Vec2) -> Vec<Displaced> {
    shift_m.fill(Vec2::zeros());
    let Some(solved) = &study.solved else { return vec![Displaced::default(); path.points.len()] };
    let give = if path.two_fingered { Vec2::new(solved.values[3], solved.values[4]) } else { Vec2::zeros() };
    let of = |point: &PathPoint| {
        let outward = (point.position - center_m).normalize();
        let mut shift = point.force.component_mul(&give);
        let mut bow = Vec2::zeros();
        let mut at = study.base.len();
        for chosen in &study.chosen {
            let candidate = &study.candidates[chosen.candidate];
            let value = solved.values[at];
            shift += match (candidate.id, point.joints[finger(candidate)]) {
                ("pad-compliance", _) => outward * (value * outward.dot(&point.force)),
                ("joint-offset", Some(joint)) => {
                    // The second link turns about its joint: on an arc, not along its tangent.
                    bow += Vec2::new(joint[0].y, -joint[0].x) * (1.0 - value.cos()) + joint[0] * (value.sin() - value);
                    joint[0] * value
                }
                ("length-scale", Some(joint)) => joint[1] * value,
                (SLIP, _) if candidate.columns.len() == 1 => {
                    outward * (value * Course::of(candidate).gone(point.time_s))
                }
                (SLIP, _) => Vec2::new(value, solved.values[at + 1]) * Course::of(candidate).gone(point.time_s),
                _ => Vec2::zeros(),
            };
            at += candidate.columns.len();
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
