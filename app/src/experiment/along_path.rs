//! A mechanism's motion as a tool sees it that holds on to it: places and forces in the frame of its recording.

use crate::experiment::like::Like;
use estimator::signal::noise::white_noise_under_fast_motion;
use haptics::recording::{Channel, Recording};
use haptics::world::MechanismPath;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rand_distr::{Distribution, Normal};

/// Columns of a tool's place, m, and of its force on the environment, N.
pub(super) const PLACES: [&str; 3] = ["x_m", "y_m", "z_m"];
const FORCES: [&str; 3] = ["fx_N", "fy_N", "fz_N"];

/// The motion and the drive of a recording along a coordinate (its first channel and its last), as a tool on `path` has them, whose sensors
/// have the columns and the noise of `like`. What the hand pushes across is not there: no force along the path depends on it.
pub fn seen_by_tool(along: &Recording, path: &MechanismPath, like: &Like<'_>, seed: u64) -> Recording {
    let mut rng = StdRng::seed_from_u64(seed ^ 0x70_01);
    let (Some(position), Some(drive)) = (along.channels.first(), along.channels.last()) else {
        return along.clone();
    };
    let course: Vec<(f64, f64)> = position.values.iter().copied().zip(drive.values.iter().copied()).collect();
    let mut channels = Vec::new();
    for (axis, name) in PLACES.iter().enumerate() {
        let place = |k: usize| path.point_m(course[k].0)[axis];
        channels.extend(channel(name, "m", like, &mut rng, &place, course.len()));
    }
    for (axis, name) in FORCES.iter().enumerate() {
        let force = |k: usize| path.force_n(course[k].0, course[k].1)[axis];
        channels.extend(channel(name, "N", like, &mut rng, &force, course.len()));
    }
    Recording { channels, ..along.clone() }
}

/// A column with white noise as in `like`; nothing where that has none.
fn channel(
    name: &str,
    unit: &str,
    like: &Like<'_>,
    rng: &mut StdRng,
    of: &dyn Fn(usize) -> f64,
    count: usize,
) -> Option<Channel> {
    let noise = white_noise_under_fast_motion(like.recording.channel(name)?);
    let white = Normal::new(0.0, noise.max(0.0)).ok();
    let values = (0..count).map(|k| of(k) + white.map_or(0.0, |white| white.sample(rng))).collect();
    Some(Channel { name: name.to_owned(), unit: unit.to_owned(), values })
}
