//! Settings of segmentation and fit: everything about the estimation that a user chooses, and can undo.

use crate::tasks::Chosen;
use crate::text::sentence::sentence;
use crate::ui::document::prepared::Prepared;
use estimator::estimate::Parameter;
use estimator::segment::definition::Definition;
use estimator::segment::{Method, Thresholds};
use haptics::recording::{Prior, Recording, Segment, Task};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Settings of segmentation and fit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct FitChoice {
    /// The task; absent: told from the recording.
    pub task: Option<Task>,
    /// A task of the user's, which is like `task`.
    pub own: Option<Arc<Definition>>,
    /// Thresholds given by hand; absent: chosen above the noise.
    pub thresholds: Option<Thresholds>,
    /// Method of segmentation into states.
    pub method: Method,
    /// Intervals that were set by hand, by recording.
    pub segments: BTreeMap<usize, Arc<Vec<Segment>>>,
    /// Prior statements about parameters.
    pub stated: Stated,
    /// Only this time enters the fit, s.
    pub only_s: Option<(f64, f64)>,
}

/// Prior statements about parameters; names as in sidecars.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Stated {
    /// Values that are not to be estimated.
    pub known: BTreeMap<String, f64>,
    /// Prior distributions.
    pub prior: BTreeMap<String, Prior>,
    /// Least and largest values.
    pub bounds: BTreeMap<String, [Option<f64>; 2]>,
}

impl Stated {
    /// The name under which a parameter is stated. Fits of cranks and mechanisms take what is known by its plain name.
    pub fn name_of(parameter: &Parameter) -> String {
        match parameter.object.as_str() {
            "crank" | "mechanism" => parameter.name.clone(),
            _ => parameter.full_name(),
        }
    }

    /// Number of statements.
    pub fn len(&self) -> usize {
        self.known.len() + self.prior.len() + self.bounds.len()
    }

    /// True when nothing is stated.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Forgets what is stated of one parameter.
    pub fn forget(&mut self, name: &str) {
        self.known.remove(name);
        self.prior.remove(name);
        self.bounds.remove(name);
    }
}

impl FitChoice {
    /// The task with its rules for a recording, where that is known.
    pub fn definition(&self, prepared: &Prepared) -> Option<Result<Definition, String>> {
        let recording = &prepared.recording;
        let found = match (&self.own, self.task) {
            (Some(own), _) => Ok((**own).clone()),
            (None, Some(task)) => Definition::built_in(task),
            (None, None) => Definition::of(recording, prepared.task?),
        };
        Some(found.map_err(|error| sentence(&error.to_string())))
    }

    /// Every recording as it is chosen to be read.
    pub fn given_to_all(&self, recordings: &[Arc<Prepared>]) -> Vec<Recording> {
        recordings.iter().enumerate().map(|(index, p)| self.given_to(index, &p.recording)).collect()
    }

    /// A recording that is of the chosen task, with what is stated and set by hand in its sidecar.
    pub fn given_to(&self, index: usize, recording: &Recording) -> Recording {
        let mut recording = recording.clone();
        match (&self.own, self.task) {
            (Some(own), _) => Chosen::Own(Box::new((**own).clone())).give_to(&mut recording),
            (None, Some(task)) => Chosen::BuiltIn(task).give_to(&mut recording),
            (None, None) => {}
        }
        let meta = &mut recording.meta;
        if let Some(segments) = self.segments.get(&index) {
            meta.segments.clone_from(segments);
        }
        meta.known.extend(self.stated.known.clone());
        meta.prior.extend(self.stated.prior.clone());
        meta.bounds.extend(self.stated.bounds.clone());
        recording
    }

    /// The part of a recording that enters the fit.
    pub fn cut(&self, recording: Recording) -> Recording {
        let Some((from, to)) = self.only_s else { return recording };
        let Some(times) = &recording.time_s else { return recording };
        let (first, end) = (times.partition_point(|t| *t < from), times.partition_point(|t| *t <= to));
        part_of(&recording, first, end)
    }
}

/// Samples `first..end` of a recording.
fn part_of(recording: &Recording, first: usize, end: usize) -> Recording {
    let mut part = recording.clone();
    part.time_s = recording.time_s.as_ref().map(|t| t[first..end].to_vec());
    for channel in &mut part.channels {
        channel.values = channel.values[first..end].to_vec();
    }
    part.labels = None;
    part
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::recording::Channel;

    fn ramp() -> Recording {
        let values: Vec<f64> = (0..100).map(f64::from).collect();
        Recording {
            time_s: Some(values.iter().map(|v| 0.1 * v).collect()),
            channels: vec![Channel { name: "q_m".into(), unit: "m".into(), values }],
            ..Recording::default()
        }
    }

    #[test]
    fn only_the_chosen_time_is_left() {
        let choice = FitChoice { only_s: Some((2.0, 3.0)), ..FitChoice::default() };
        let part = choice.cut(ramp());
        assert_eq!((part.len(), part.channels[0].values[0]), (11, 20.0));
        let outside = FitChoice { only_s: Some((200.0, 300.0)), ..FitChoice::default() };
        assert_eq!(outside.cut(ramp()).len(), 0);
        assert_eq!(FitChoice::default().cut(ramp()), ramp());
    }

    #[test]
    fn what_is_stated_goes_into_the_sidecar_of_every_recording_and_segments_into_their_own() {
        let mut choice = FitChoice::default();
        choice.stated.known.insert("weight_N".to_owned(), 1.0);
        let segment = Segment { t0: 0.0, t1: 1.0, state: "free-motion".to_owned(), subtask: None };
        choice.segments.insert(1, Arc::new(vec![segment]));
        let all = choice.given_to_all(&[ramp(), ramp()].map(|r| Arc::new(Prepared::new(r))));
        assert!(all.iter().all(|r| r.meta.known["weight_N"] == 1.0));
        assert_eq!(all.iter().map(|r| r.meta.segments.len()).collect::<Vec<_>>(), [0, 1]);
    }

    #[test]
    fn a_choice_survives_a_file() {
        let mut choice = FitChoice { task: Some(Task::Crank), only_s: Some((1.0, 2.0)), ..FitChoice::default() };
        choice.stated.bounds.insert("friction_mu".to_owned(), [Some(0.0), None]);
        choice.stated.prior.insert("weight_N".to_owned(), Prior { mean: 1.0, std: 0.1 });
        let text = serde_json::to_string(&choice).expect("written");
        assert_eq!(serde_json::from_str::<FitChoice>(&text).expect("read"), choice);
    }
}
