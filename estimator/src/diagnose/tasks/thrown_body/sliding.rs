//! Causes that slow a sliding body: dry friction, or a resistance that depends on the speed.

use crate::diagnose::answer::part::{Found, Told};
use crate::diagnose::contract::{CauseParameter, RolloutOf};
use crate::diagnose::data::limits::FEWEST;
use crate::diagnose::data::row_means::spread;
use crate::diagnose::free_run::channel::{Fit, Forward};
use crate::diagnose::free_run::windows::Errors;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::stribeck::SPEEDS;
use crate::diagnose::hypotheses::variable::Variable;
use crate::diagnose::hypotheses::{load_friction, quadratic_drag, stribeck, viscous_friction};
use crate::diagnose::selection::channel::Channel;
use crate::diagnose::selection::comparison::{Compared, View};
use crate::diagnose::selection::layout::Layout;
use crate::diagnose::selection::rules::{Rules, THRESHOLD_SLOW};
use crate::diagnose::tasks::thrown_body::powers;
use estimation::identify::tossed::Tossed;
use estimation::identify::tossed::pose::Track;
use estimation::identify::tossed::slide::Slide;
use foundation::estimate::EstimateError;
use foundation::signal::derive::polynomial;
use foundation::tasks::SystemState;
use haptics::law::Kind;
use nalgebra::{DVector, Vector3};

/// One slide: times, distance along its direction, speed, and the share of friction against it.
struct Way {
    time_s: Vec<f64>,
    place_m: Vec<f64>,
    speed_m_s: Vec<f64>,
    direct: Vec<f64>,
}

/// Compares the causes that slow the body. `mu`: friction of the model; `scatter`: as in [`Slides`].
pub fn sliding(seen: &Tossed, mu: f64, scatter: f64) -> Result<Option<Slides>, EstimateError> {
    if seen.slides.len() < FEWEST {
        return Ok(None);
    }
    let ways: Vec<Way> = seen.slides.iter().filter_map(|s| way(seen, s)).collect();
    let mut speeds: Vec<f64> = ways.iter().flat_map(|w| w.speed_m_s.iter().copied()).collect();
    speeds.sort_by(f64::total_cmp);
    let usual = speeds.get(speeds.len() * 9 / 10).copied().unwrap_or(1.0);
    let fall = seen.fall.down_m_s2;
    // A deceleration, integrated twice, takes the place of a force: only differences within a slide count.
    let slowed = |w: &Way, of: &dyn Fn(usize) -> f64| within(w, &integrated(w, &|i| -of(i)));
    let all = |of: &dyn Fn(f64) -> f64| -> Vec<f64> {
        ways.iter().flat_map(|w| slowed(w, &|i| of(w.speed_m_s[i]))).collect()
    };
    // Dry friction acts on every point of the foot against that point's own motion. A resistance in proportion to the
    // speed depends on the mean motion alone.
    let all_dry = |of: &dyn Fn(f64) -> f64| -> Vec<f64> {
        ways.iter().flat_map(|w| slowed(w, &|i| w.direct[i] * of(w.speed_m_s[i]))).collect()
    };
    let moved: Vec<f64> = ways.iter().flat_map(|w| within(w, &w.place_m)).collect();
    let dry = all_dry(&|_| fall);
    let y: Vec<f64> = moved.iter().zip(&dry).map(|(m, d)| m - mu * d).collect();
    // A change of friction smaller than the scatter between slides is within the uncertainty of their common friction.
    let differ = differ(&ways, fall);
    let least = |of: &dyn Fn(f64) -> f64| {
        differ * fall / spread(&speeds.iter().map(|v| of(*v)).collect::<Vec<f64>>()).max(f64::MIN_POSITIVE)
    };
    let follows = |id, name, unit, of: &dyn Fn(f64) -> f64| {
        Candidate::one(id, Kind::Plant, name, unit, all(of)).positive().at_least(least(of))
    };
    let mut candidates = vec![
        Candidate::one(load_friction::ID, Kind::Plant, "mu", "1", dry),
        follows(viscous_friction::ID, "c/m", "1/s", &|v| v),
        follows(quadratic_drag::ID, "k/m", "1/m", &|v| v * v),
    ];
    for share in SPEEDS.values() {
        let vs = share * usual;
        let falls_off = |v: f64| fall * (-(v / vs).powi(2)).exp();
        let bent = Candidate::one(stribeck::ID, Kind::Plant, "dmu", "1", all_dry(&falls_off));
        candidates.push(bent.positive().at_least(least(&falls_off)).at("vs", vs, "m/s"));
    }
    let stretch: Vec<usize> = ways.iter().enumerate().flat_map(|(k, w)| w.time_s.iter().map(move |_| k)).collect();
    let n = y.len();
    let floor = floor(&ways);
    let period_s = ways.first().map_or(0.01, |w| w.time_s[1] - w.time_s[0]);
    let along = vec![true; n];
    let layout = Layout::of(stretch, &along, period_s);
    // Friction that rises as the body stops requires dry friction.
    let rules = Rules { threshold: THRESHOLD_SLOW, ..Rules::of_channel(period_s) }.with_friction(mu > 0.0);
    let study = Channel::new(y, Vec::new(), candidates, layout, rules).fit()?;
    let each = |of: fn(&Way) -> &Vec<f64>| ways.iter().flat_map(of).copied().collect::<Vec<f64>>();
    let over = vec![(Variable::Time, each(|w| &w.time_s)), (Variable::Velocity, each(|w| &w.speed_m_s))];
    // A single slide is short, so all are shown together.
    let view = View::of(Vec::new(), over, best_seen);
    let (channel, state) = ("way of the slides", vec![SystemState::SlidingOnGround; n]);
    let step_s = seen.tracks.first().map_or(0.0, Track::step_s);
    let compared = Compared { study, channel, unit: "m", floor, along, state, view };
    Ok(Some(Slides { compared, step_s, scatter }))
}

/// The comparison. Its regressors are decelerations already integrated twice, each from its own start.
pub struct Slides {
    pub compared: Compared,
    /// Time between samples, s.
    step_s: f64,
    /// Standard error of the friction by the scatter of the slides, which is larger than that of their samples.
    scatter: f64,
}

/// Variable that best shows a cause.
fn best_seen(id: &str) -> Variable {
    if id == load_friction::ID { Variable::Time } else { Variable::Velocity }
}

impl Told for Slides {
    fn states(&self, _: usize, candidate: &Candidate, mut found: Vec<CauseParameter>) -> Vec<CauseParameter> {
        if candidate.id == load_friction::ID {
            for p in &mut found {
                p.std_error = p.std_error.hypot(self.scatter);
            }
        }
        found
    }

    fn shows(&self, found: &Found<'_>) -> String {
        match found.candidate.id {
            load_friction::ID => {
                let (value, error) = found.parameters.first().map_or((0.0, 0.0), |p| (p.value, p.std_error));
                format!(
                    "the body slows down evenly while it slides, whatever its speed: dry friction, mu = {value:.3} ± {error:.3}"
                )
            }
            viscous_friction::ID => "the faster the body slides, the more it slows down".to_owned(),
            quadratic_drag::ID => "the body slows down with the square of its speed".to_owned(),
            stribeck::ID => "the body slows down more just before it stops".to_owned(),
            other => format!("{other} shows in the slides"),
        }
    }
}

impl Forward for Slides {
    fn of(&self) -> (RolloutOf, &str) {
        (RolloutOf::Position, "m")
    }

    fn windows(&self) -> Vec<Vec<usize>> {
        let stretch = &self.compared.study.layout.segment;
        let rows: Vec<usize> = (0..stretch.len()).collect();
        rows.chunk_by(|a, b| stretch[*a] == stretch[*b]).map(<[usize]>::to_vec).collect()
    }

    fn window_s(&self) -> f64 {
        let longest = self.windows().iter().map(Vec::len).max().unwrap_or(0);
        self.step_s * longest.saturating_sub(1) as f64
    }

    fn errors(&self, fit: &Fit<'_>, window: &[usize]) -> Result<Errors, String> {
        let columns: Vec<(&[f64], f64)> = fit.columns().collect();
        Ok((window.iter().map(|i| fit.less(*i, &columns).powi(2)).sum(), window.len() as f64))
    }
}

fn way(seen: &Tossed, slide: &Slide) -> Option<Way> {
    let track = &seen.tracks[slide.track];
    let range = slide.first..slide.first + slide.samples;
    let (points, time) = (&track.points[range.clone()], &track.time_s[range]);
    let total = points[points.len() - 1] - points[0];
    let along = Vector3::new(total.x, total.y, 0.0).try_normalize(1e-9)?;
    let way_m: Vec<f64> = points.iter().map(|p| along.dot(&(p - points[0]))).collect();
    let time_s: Vec<f64> = time.iter().map(|t| t - time[0]).collect();
    let fitted = polynomial(&time_s, &way_m, 3);
    // Horner's rule for the derivative.
    let speed = |t: f64| fitted.iter().enumerate().skip(1).rev().fold(0.0, |sum, (k, c)| sum * t + k as f64 * c);
    let speed_m_s = time_s.iter().map(|t| f64::max(speed(*t), 0.0)).collect();
    Some(Way { time_s, place_m: way_m, speed_m_s, direct: slide.direct.clone() })
}

/// Distance by an acceleration from rest, m, with the trapezoidal rule.
fn integrated(way: &Way, acceleration: &dyn Fn(usize) -> f64) -> Vec<f64> {
    let (mut speed, mut place) = (0.0, 0.0);
    (0..way.time_s.len())
        .map(|i| {
            if i > 0 {
                let step = way.time_s[i] - way.time_s[i - 1];
                let (before, now) = (acceleration(i - 1), acceleration(i));
                place += speed * step + (2.0 * before + now) * step * step / 6.0;
                speed += 0.5 * (before + now) * step;
            }
            place
        })
        .collect()
}

/// A series less its own start and speed.
fn within(way: &Way, values: &[f64]) -> Vec<f64> {
    let n = values.len();
    let own = powers(n, 2, |i| way.time_s[i]).qr().q();
    let series = DVector::from_column_slice(values);
    (&series - &own * own.tr_mul(&series)).iter().copied().collect()
}

/// Scatter of the friction of single slides beyond their own noise and their dependence on speed, because a table is
/// not uniform: one standard deviation, as a friction coefficient.
fn differ(ways: &[Way], fall_m_s2: f64) -> f64 {
    let noise_m = floor(ways);
    // Friction of each slide by its own dry regressor: value, weight and mean speed.
    let each: Vec<(f64, f64, f64)> = ways
        .iter()
        .map(|w| {
            let (place, dry) = (within(w, &w.place_m), within(w, &integrated(w, &|i| -fall_m_s2 * w.direct[i])));
            let square: f64 = dry.iter().map(|d| d * d).sum();
            let friction = place.iter().zip(&dry).map(|(p, d)| p * d).sum::<f64>() / square.max(f64::MIN_POSITIVE);
            (friction, square, w.speed_m_s.iter().sum::<f64>() / w.speed_m_s.len() as f64)
        })
        .collect();
    let sum = |of: &dyn Fn(&(f64, f64, f64)) -> f64| each.iter().map(|e| e.1 * of(e)).sum::<f64>();
    let weights = sum(&|_| 1.0).max(f64::MIN_POSITIVE);
    let (friction, speed) = (sum(&|e| e.0) / weights, sum(&|e| e.2) / weights);
    let square = sum(&|e| (e.2 - speed).powi(2)).max(f64::MIN_POSITIVE);
    let slope = sum(&|e| (e.2 - speed) * (e.0 - friction)) / square;
    let left = sum(&|e| (e.0 - friction - slope * (e.2 - speed)).powi(2));
    let by_noise = (each.len() as f64 - 2.0).max(0.0) * noise_m * noise_m;
    ((left - by_noise).max(0.0) / weights).sqrt()
}

/// Residual of the paths from cubics, m.
fn floor(ways: &[Way]) -> f64 {
    let (mut sum, mut n) = (0.0, 0.0_f64);
    for way in ways.iter().filter(|w| w.time_s.len() > 5) {
        let own = powers(way.time_s.len(), 4, |i| way.time_s[i]).qr().q();
        let series = DVector::from_column_slice(&way.place_m);
        sum += (&series - &own * own.tr_mul(&series)).norm_squared();
        n += way.time_s.len() as f64 - 4.0;
    }
    (sum / n.max(1.0)).sqrt()
}
