//! Contact and free motion, told by the force.

use foundation::signal::noise::white_noise;
use nalgebra::Vector3;

/// Fewer samples of contact or of free motion tell nothing.
pub(super) const LEAST_SAMPLES: usize = 12;
/// Least force in contact, in multiples of its noise.
const NOISES: f64 = 6.0;
/// Least force in contact, as a share of the strongest push (the weight of a moving tool is less).
const CONTACT_SHARE: f64 = 0.2;
/// Below this share the tool is free.
const FREE_SHARE: f64 = 0.08;
/// Largest scatter of free samples, as a share of the largest force that still counts as free.
const QUIET_SHARE: f64 = 0.35;
/// The strongest push is this quantile of the force's size, so that a knock does not set it.
const STRONG: f64 = 0.9;
/// Share of the samples, those of the least force, that a first idea of the sensor's zero comes from.
const QUIET: f64 = 0.1;
/// Cosine of the largest angle of a push from its mean, 60°.
const WITHIN_COSINE: f64 = 0.5;
/// Share of the contact that may be outside that angle.
const STRAY_SHARE: f64 = 0.02;

/// Positions and forces of the pressing tool.
#[derive(Clone, Copy, Debug)]
pub struct Pressed<'a> {
    /// Positions, m.
    pub points: &'a [Vector3<f64>],
    /// Force of the tool on the surface, N.
    pub forces: &'a [Vector3<f64>],
    /// Times, s, where there is a clock.
    pub time_s: Option<&'a [f64]>,
    /// All in the x-y plane.
    pub planar: bool,
}

/// Samples of contact and of free motion.
#[derive(Clone, Debug)]
pub(super) struct Split {
    pub contact: Vec<bool>,
    pub free: Vec<bool>,
    /// Force less the sensor's zero, N.
    pub force: Vec<Vector3<f64>>,
    /// Mean direction of the push, a unit vector into the surface.
    pub push: Vector3<f64>,
    /// White noise of a coordinate, m.
    pub position_noise_m: f64,
}

impl Split {
    /// `None` when there is not enough of both, or when the force pulls as well as pushes.
    pub(super) fn of(pressed: &Pressed<'_>) -> Option<Self> {
        let (points, forces) = (pressed.points, pressed.forces);
        let finite = |v: &[Vector3<f64>]| v.iter().all(|v| v.iter().all(|x| x.is_finite()));
        if points.len() != forces.len() || points.len() < 4 * LEAST_SAMPLES || !finite(points) || !finite(forces) {
            return None;
        }
        let noise = worst_noise(forces);
        let mut zero = quiet_mean(forces);
        let (mut sizes, mut free) = (Vec::new(), Vec::new());
        let mut strong = 0.0;
        for _ in 0..3 {
            sizes = forces.iter().map(|f| (f - zero).norm()).collect::<Vec<f64>>();
            let mut sorted = sizes.clone();
            sorted.sort_by(f64::total_cmp);
            strong = sorted[((sorted.len() - 1) as f64 * STRONG) as usize];
            let least = (NOISES * noise).max(FREE_SHARE * strong);
            free = sizes.iter().map(|s| *s < least).collect::<Vec<bool>>();
            zero = mean(forces.iter().zip(&free).filter(|(_, free)| **free).map(|(f, _)| f))?;
        }
        let least = (NOISES * noise).max(CONTACT_SHARE * strong);
        let contact: Vec<bool> = sizes.iter().map(|s| *s > least).collect();
        let count = |flags: &[bool]| flags.iter().filter(|f| **f).count();
        if count(&contact) < LEAST_SAMPLES || count(&free) < LEAST_SAMPLES {
            return None;
        }
        let force: Vec<Vector3<f64>> = forces.iter().map(|f| f - zero).collect();
        let pushes = || force.iter().zip(&contact).filter(|(_, c)| **c).map(|(f, _)| f);
        // Free is where nothing acts but noise; a force that only turns its direction passes by any zero, too.
        let quiet: f64 = force.iter().zip(&free).filter(|(_, free)| **free).map(|(f, _)| f.norm_squared()).sum();
        let loose = (NOISES * noise).max(FREE_SHARE * strong);
        if (quiet / count(&free) as f64).sqrt() > QUIET_SHARE * loose {
            return None;
        }
        let push = mean(pushes())?.try_normalize(1e-12)?;
        let stray = pushes().filter(|f| f.dot(&push) < WITHIN_COSINE * f.norm()).count();
        let one_way = stray as f64 <= STRAY_SHARE * count(&contact) as f64;
        let position_noise_m = worst_noise(points);
        one_way.then_some(Self { contact, free, force, push, position_noise_m })
    }

    /// Runs of contact as ranges of samples.
    pub(super) fn runs(&self) -> Vec<std::ops::Range<usize>> {
        let mut found: Vec<std::ops::Range<usize>> = Vec::new();
        for (i, _) in self.contact.iter().enumerate().filter(|(_, c)| **c) {
            match found.last_mut() {
                Some(run) if run.end == i => run.end = i + 1,
                _ => found.push(i..i + 1),
            }
        }
        found
    }
}

fn worst_noise(values: &[Vector3<f64>]) -> f64 {
    (0..3).map(|k| white_noise(&values.iter().map(|v| v[k]).collect::<Vec<f64>>())).fold(0.0, f64::max)
}

/// Mean of the forces of least size.
fn quiet_mean(forces: &[Vector3<f64>]) -> Vector3<f64> {
    let mut order: Vec<&Vector3<f64>> = forces.iter().collect();
    order.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    let count = ((forces.len() as f64 * QUIET) as usize).max(1);
    order.iter().take(count).copied().sum::<Vector3<f64>>() / count as f64
}

pub(super) fn mean<'v>(values: impl Iterator<Item = &'v Vector3<f64>>) -> Option<Vector3<f64>> {
    let (sum, count) = values.fold((Vector3::zeros(), 0.0), |(sum, count), v| (sum + v, count + 1.0));
    (count > 0.0).then(|| sum / count)
}
