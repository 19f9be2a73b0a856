//! The coordinate that a diagnosis of a mechanism counts in: what it found holds in other recordings where that is
//! theirs, too.

use super::regression_data::Track;
use estimation::identify::mechanism::path::{keeps_to, spare_m};
use foundation::estimate::EstimateError;
use foundation::words::amount;
use haptics::law::Coordinate;
use haptics::recording::Recording;
use haptics::world::MechanismPath;

/// Kind of coordinate, length or angle, and the path along which a tool's is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along {
    coordinate: Coordinate,
    /// Path of the first tool that has one, and the largest offset of other paths from it, m. None if the coordinate is
    /// a recorded channel.
    path: Option<(MechanismPath, f64)>,
}

impl Along {
    /// Of the recordings that are diagnosed, with the path of each.
    pub fn of(coordinate: Coordinate, recordings: &[Recording], paths: &[Option<MechanismPath>]) -> Self {
        let path = recordings.iter().zip(paths).find_map(|(like, path)| {
            let path = (*path)?;
            Some((path, spare_m(&path, like)?))
        });
        Self { coordinate, path }
    }

    /// Path along which another recording's coordinate is measured: `None` if it has the coordinate itself.
    ///
    /// # Errors
    /// One sentence where the place in it is not the place in what was diagnosed.
    pub fn path_of(&self, recording: &Recording) -> Result<Option<MechanismPath>, EstimateError> {
        let name = &recording.name;
        let own = ["q_m", "q_rad"].into_iter().find(|q| recording.channel(q).is_some());
        let refused = |why: String| Err(EstimateError::Other(why));
        match (&self.path, own) {
            (None, Some(_)) => Ok(None),
            (None, None) => refused(format!(
                "{name} is a tool's path, and what was diagnosed has its coordinate as a column: the two places cannot be compared; validate on a log with that column"
            )),
            (Some(_), Some(column)) => refused(format!(
                "{name} has its coordinate as the column {column}, and what was diagnosed is a tool's path: the two places cannot be compared; validate on a path in the same frame"
            )),
            (Some((path, spare_m)), None) if keeps_to(recording, path, *spare_m) => Ok(Some(*path)),
            (Some((_, spare_m)), None) => refused(format!(
                "{name} does not keep to the path of what was diagnosed, within {}: it is another object, or the frame was moved; validate on a recording of the same object in the same frame",
                amount(*spare_m, "m")
            )),
        }
    }

    /// Checks that another recording has the same kind of coordinate.
    ///
    /// # Errors
    /// One sentence if one coordinate is a length and the other an angle.
    pub fn demand(&self, coordinate: Coordinate, recording: &Recording) -> Result<(), EstimateError> {
        if coordinate == self.coordinate {
            return Ok(());
        }
        Err(EstimateError::Other(format!(
            "{} moves {}, and what was diagnosed moves {}: validate on a recording of the same object",
            recording.name,
            in_words(coordinate),
            in_words(self.coordinate)
        )))
    }
}

/// Checks that recordings to be diagnosed together have the same kind of coordinate.
///
/// # Errors
/// One sentence if one coordinate is a length and the other an angle.
pub fn one_kind(first: &Track, other: &Track, recording: &Recording) -> Result<(), EstimateError> {
    if first.coordinate == other.coordinate {
        return Ok(());
    }
    Err(EstimateError::Other(format!(
        "{} moves {}, and the recordings before it move {}: diagnose recordings of one and the same object together",
        recording.name,
        in_words(other.coordinate),
        in_words(first.coordinate)
    )))
}

fn in_words(coordinate: Coordinate) -> &'static str {
    if coordinate == Coordinate::Linear { "along a line" } else { "about an axis" }
}

/// Error for diagnoses that have no coordinate.
pub fn none(recording: &Recording) -> EstimateError {
    EstimateError::Other(format!(
        "what was found in thrown bodies, transmissions and paths without a clock is not measured on other recordings yet ({}); leave out --validate, or give all logs together",
        recording.name
    ))
}
