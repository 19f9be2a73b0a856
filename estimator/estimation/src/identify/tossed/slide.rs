//! Sliding flat: height and orientation stay, the speed falls evenly.

use super::pose::Track;
use crate::identify::limits::LEAST_OF_PARABOLA;
use foundation::signal::derive::polynomial;
use nalgebra::Vector3;

/// Time on either side over which velocities are taken, s.
/// Choice: halved, 5 of 6 answers change; doubled, 5 of 6 answers change (3 to right).
const VELOCITY_REACH_S: f64 = 0.0135;
/// Least speed of a slide, as the time in which free fall makes it, s: a slower body may stick or creep.
/// Choice: halved, 0 of 6 answers change; doubled, 1 of 6 answers change.
const SLOW_S: f64 = 0.005;
/// Largest angular velocity of a slide, rad/s: a faster body rolls or spins.
/// Choice: halved or doubled, none of 6 answers changes.
const TURNING_RAD_S: f64 = 0.6;
/// Largest speed of rising or falling in a flat slide, as such a time, s.
/// Choice: halved or doubled, none of 6 answers changes.
const RISING_S: f64 = 0.003;
/// Largest range of heights in a slide, as the time in which a body falls through it, s.
/// Choice: halved or doubled, none of 6 answers changes.
const LEVEL_S: f64 = 0.02;
/// Limits of a flat slide by noise, in multiples of its effect.
/// Choice: halved or doubled, none of 6 answers changes.
const SLIDE_NOISES: f64 = 3.5;
/// Largest ratio of these limits to the plain ones.
/// Choice: halved or doubled, none of 6 answers changes.
const LOOSER: f64 = 2.0;
/// Largest speed of the edge's spin, as a share of the body's speed: friction then still goes against the speed, all
/// but 4 % of it.
/// Derived: 0.25 · 0.4² = 4 %.
const SPINNING: f64 = 0.4;
/// Distance of the contact from a body's axis, in half widths of a cube.
/// Derived: the middle of that of an even pressure (0.8) and four corners (1.4).
const FOOT: f64 = 1.1;
/// Distance of the contact from the axis of a body of unknown width, as the time in which a body falls through it, s.
/// Derived: 1.1 half widths of a body about a decimetre wide, as hands throw them.
const FOOT_S: f64 = 0.106;
/// Relative difference, between an even pressure and four corners, of the friction that does not go against the speed.
/// Choice: halved or doubled, none of 6 answers changes.
const FOOT_ERROR: f64 = 0.6;
/// Least duration of a slide that is judged, s.
/// Choice: halved or doubled, none of 6 answers changes.
const LEAST_SLIDE_S: f64 = 0.05;

/// One slide.
#[derive(Clone, Debug)]
pub struct Slide {
    /// Deceleration, m/s².
    pub slowing_m_s2: f64,
    /// Share of the friction that goes against the motion of the middle, a sample: the rest stops the turning.
    pub direct: Vec<f64>,
    /// Number of samples.
    pub samples: usize,
    /// Index of the track.
    pub track: usize,
    /// First sample in the track.
    pub first: usize,
}

impl Slide {
    /// Friction over load, where falling is so much.
    pub fn friction(&self, fall_m_s2: f64) -> f64 {
        self.slowing_m_s2 / self.mean_direct() / fall_m_s2
    }

    fn mean_direct(&self) -> f64 {
        self.direct.iter().sum::<f64>() / self.samples as f64
    }
}

/// Share of a mean friction that is unknown because the foot is.
pub fn unknown_of_foot(slides: &[Slide]) -> f64 {
    let indirect: f64 = slides.iter().map(|s| 1.0 - s.mean_direct()).sum();
    FOOT_ERROR * indirect / slides.len().max(1) as f64
}

/// Limits of a flat slide.
struct Flat {
    foot_m: f64,
    slow_m_s: f64,
    level_m: f64,
    rising_m_s: f64,
    turning_rad_s: f64,
}

/// The slides of all tracks. `half_width_m`: of a cube, where it is known.
pub fn slides(tracks: &[Track], half_width_m: Option<f64>, gravity_m_s2: f64) -> Vec<Slide> {
    let falls_m = |time_s: f64| 0.5 * gravity_m_s2 * time_s.powi(2);
    let noise = |which: fn((f64, f64)) -> f64| {
        let mut all: Vec<f64> = tracks.iter().map(|t| which(t.slope_noise(t.steps(VELOCITY_REACH_S)))).collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or(0.0)
    };
    let limit = |plain: f64, noise: f64| plain.max(SLIDE_NOISES * noise).min(LOOSER * plain);
    let flat = Flat {
        foot_m: half_width_m.map_or(falls_m(FOOT_S), |half| FOOT * half),
        slow_m_s: gravity_m_s2 * SLOW_S,
        level_m: falls_m(LEVEL_S),
        rising_m_s: limit(gravity_m_s2 * RISING_S, noise(|n| n.0)),
        turning_rad_s: limit(TURNING_RAD_S, noise(|n| n.1)),
    };
    let all = tracks.iter().enumerate();
    all.flat_map(|(k, track)| of_track(track, &flat).into_iter().map(move |s| Slide { track: k, ..s })).collect()
}

/// Speed of the edge's spin relative to the speed of the middle at a sample; `None` if the body does not slide flat.
fn spinning(track: &Track, i: usize, flat: &Flat) -> Option<f64> {
    let reach = track.steps(VELOCITY_REACH_S);
    let (velocity, spin) = (track.velocity(i, reach), track.spin(i, reach));
    let speed = velocity.x.hypot(velocity.y);
    let spinning = flat.foot_m * spin.z.abs() / speed;
    let is_flat = speed > flat.slow_m_s
        && velocity.z.abs() < flat.rising_m_s
        && spin.norm() < flat.turning_rad_s
        && spinning < SPINNING;
    is_flat.then_some(spinning)
}

fn of_track(track: &Track, flat: &Flat) -> Vec<Slide> {
    let n = track.points.len();
    let reach = track.steps(VELOCITY_REACH_S);
    if n <= 2 * reach {
        return Vec::new();
    }
    let spins: Vec<Option<f64>> = (0..n).map(|i| spinning(track, i, flat)).collect();
    let height = |i: usize| track.points[i].z;
    let mut found = Vec::new();
    let mut start = None;
    for i in 0..=n {
        let goes_on =
            i < n && spins[i].is_some() && start.is_none_or(|s: usize| (height(i) - height(s)).abs() < flat.level_m);
        match (start, goes_on) {
            (None, true) => start = Some(i),
            (Some(first), false) => {
                // Both ends still see samples before and after.
                found.extend(slide(track, first + reach, i.saturating_sub(reach), &spins));
                start = None;
            }
            _ => {}
        }
    }
    found
}

/// The share of friction that goes against the motion of the middle, for contact on a ring of the foot's size, to
/// second order.
fn direct(spinning: f64) -> f64 {
    1.0 - 0.25 * spinning * spinning
}

/// The way along the mean direction, as a parabola.
fn slide(track: &Track, first: usize, end: usize, spins: &[Option<f64>]) -> Option<Slide> {
    if end < first + LEAST_OF_PARABOLA || track.time_s[end - 1] - track.time_s[first] < LEAST_SLIDE_S {
        return None;
    }
    let (points, time) = (&track.points[first..end], &track.time_s[first..end]);
    let total = points[points.len() - 1] - points[0];
    let along = Vector3::new(total.x, total.y, 0.0).try_normalize(1e-9)?;
    let way: Vec<f64> = points.iter().map(|p| along.dot(&(p - points[0]))).collect();
    let since: Vec<f64> = time.iter().map(|t| t - time[0]).collect();
    let fitted = polynomial(&since, &way, 2);
    let slowing_m_s2 = -2.0 * fitted.get(2)?;
    let direct = spins[first..end].iter().map(|s| direct(s.unwrap_or(0.0))).collect();
    (slowing_m_s2 > 0.0).then_some(Slide { slowing_m_s2, direct, samples: points.len(), track: 0, first })
}
