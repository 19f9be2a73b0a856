//! The coordinate that a diagnosis of a mechanism counts in: what it found holds in other recordings where that is
//! theirs, too.

use super::regression_data::Track;
use estimation::identify::mechanism::path::{keeps_to, spare_m};
use foundation::estimate::EstimateError;
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
                "{name} does not keep to the path of what was diagnosed, within {:.1} mm: it is another object, or the frame was moved; validate on a recording of the same object in the same frame",
                1e3 * spare_m
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::diagnose;
    use crate::diagnose::findings::Findings;
    use crate::diagnose::options::Options;
    use crate::diagnose::validate;
    use haptics::recording::Channel;

    const RADIUS_M: f64 = 0.3;

    /// A door that is opened and shut: inertia, Coulomb and viscous friction, and a spring that pulls from the closed
    /// position.
    fn door(name: &str, (begin_rad, swing_rad): (f64, f64), shifted_m: f64, phase: f64) -> Recording {
        let time: Vec<f64> = (0..6000).map(|i| f64::from(i) * 2e-3).collect();
        let noise = |i: usize, k: f64| ((i as f64 + phase) * k).sin() + ((i as f64 - phase) * 1.7 * k).cos();
        let (mut all, names) = (vec![Vec::new(); 4], ["x_m", "y_m", "fx_N", "fy_N"]);
        for (i, t) in time.iter().enumerate() {
            let w = 1.7;
            let angle = begin_rad + swing_rad * (1.0 - (w * t).cos());
            let (speed, acceleration) = (swing_rad * w * (w * t).sin(), swing_rad * w * w * (w * t).cos());
            let torque = 0.2 * acceleration + 0.3 * speed + 0.4 * speed.signum() + 1.5 * angle;
            let (sin, cos) = angle.sin_cos();
            let along_n = torque / RADIUS_M + 0.01 * noise(i, 12.9898);
            all[0].push(shifted_m + RADIUS_M * cos + 1e-6 * noise(i, 78.233));
            all[1].push(RADIUS_M * sin + 1e-6 * noise(i, 39.425));
            all[2].push(-along_n * sin + 0.5 * cos);
            all[3].push(along_n * cos + 0.5 * sin);
        }
        let channel = |(name, values): (&str, Vec<f64>)| Channel { name: name.to_owned(), unit: String::new(), values };
        let channels = names.into_iter().zip(all).map(channel).collect();
        Recording { name: name.to_owned(), time_s: Some(time), channels, ..Recording::default() }
    }

    #[test]
    fn a_slide_and_a_door_are_not_diagnosed_together() {
        let made = |column: &str, name: &str| {
            let path = door(name, (0.1, 0.5), 0.0, 1.0);
            let places = path.channels[0].values.clone();
            let force = path.channels[3].values.clone();
            let channel = |name: &str, values| Channel { name: name.to_owned(), unit: String::new(), values };
            let channels =
                vec![channel(column, places), channel(if column == "q_m" { "f_N" } else { "tau_Nm" }, force)];
            Recording { channels, ..path }
        };
        let both = [made("q_m", "slide"), made("q_rad", "door")];
        let said = diagnose(&both, &Options::default()).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(said.contains("door moves about an axis") && said.contains("move along a line"), "{said}");
    }

    fn asked(recording: &Recording) -> (Options, Findings) {
        let options = Options::default();
        let found = diagnose(std::slice::from_ref(recording), &options).expect("it can be diagnosed");
        (options, found)
    }

    #[test]
    fn what_depends_on_the_place_holds_on_another_path_that_begins_elsewhere() {
        let (options, found) = asked(&door("one", (0.1, 0.5), 0.0, 0.0));
        assert!(found.causes.iter().any(|c| c.id == "return-spring"), "{:?}", found.causes);
        for (begin, swing) in [(0.6, 0.25), (1.1, -0.5)] {
            let others = [door("two", (begin, swing), 0.0, 0.4), door("three", (begin, swing), 0.0, 0.7)];
            let on = validate(&others, &options, &found).expect("figures");
            assert!(on.len() == 2 && on.iter().all(|v| v.interval[0] > 0.9), "{begin} {swing}: {on:?}");
        }
    }

    #[test]
    fn what_cannot_be_compared_is_refused_in_a_sentence() {
        let (options, found) = asked(&door("one", (0.1, 0.5), 0.0, 0.0));
        let mut moved = vec![door("moved", (0.1, 0.5), 0.05, 0.1)];
        let said = |recordings: &[Recording], found: &Findings| {
            validate(recordings, &options, found).expect_err("another frame").to_string()
        };
        assert!(said(&moved, &found).contains("moved does not keep to the path"));
        let angle = moved[0].channels[0].values.clone();
        moved[0].channels = ["q_rad", "tau_Nm"]
            .map(|name| Channel { name: name.to_owned(), unit: String::new(), values: angle.clone() })
            .to_vec();
        assert!(said(&moved, &found).contains("the column q_rad"));
        let mut clockless = door("still", (0.1, 0.5), 0.0, 0.0);
        clockless.time_s = None;
        let (_, pulled) = asked(&clockless);
        assert!(said(&[clockless], &pulled).contains("leave out --validate"));
    }
}
