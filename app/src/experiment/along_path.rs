//! A mechanism's motion as seen by a tool that holds it: positions and forces in the frame of its recording.

use crate::experiment::like::Like;
use estimator::signal::noise::white_noise_under_fast_motion;
use haptics::recording::{Channel, Recording};
use haptics::world::MechanismPath;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rand_distr::{Distribution, Normal};

/// Columns of a tool's position, m, and of its force on the environment, N.
pub(super) const PLACES: [&str; 3] = ["x_m", "y_m", "z_m"];
const FORCES: [&str; 3] = ["fx_N", "fy_N", "fz_N"];

/// Recording of a tool on `path`, converted from one along a coordinate (motion in its first channel, drive in its
/// last). The sensors have the columns and the noise of `like`. The force of the hand perpendicular to the path is
/// absent: no force along the path depends on it.
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

/// Column with white noise as in `like`; `None` where that has no such column.
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
