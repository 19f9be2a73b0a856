//! Other files of the same run, whose channels are put on the log's clock.

mod correlation;
mod edges;
mod grid;
mod offset;
mod refine;
mod shift;

use crate::JOINED;
use crate::errors::LogError;
use crate::mcap::resample;
use crate::origin::Dated;
use crate::raw::Cells;
use crate::{NO_CLOCK, NO_KNOWN_COLUMN, units};
use haptics::recording::{Channel, JoinedFile, RESAMPLED, Recording, Warning};
use std::path::{Path, PathBuf};

/// The recordings of a log, with the channels of the files that its sidecar joins. `path`: the log. `read`: reads another
/// file, without the files that it may join.
pub fn files(
    mut own: Vec<Dated>,
    path: &Path,
    read: &dyn Fn(&Path) -> Result<Vec<Dated>, LogError>,
) -> Result<Vec<Recording>, LogError> {
    let files = own.first().map(|first| first.recording.meta.join.clone()).unwrap_or_default();
    for file in &files {
        let other = Other::read(path, file, read)?;
        let from = other.times_in(&own)?;
        for Dated { recording, .. } in &mut own {
            other.put_on(recording, &from)?;
        }
    }
    Ok(own.into_iter().map(|dated| dated.recording).collect())
}

/// A file that is joined.
struct Other<'a> {
    file: &'a JoinedFile,
    path: PathBuf,
    dated: Dated,
}

/// Times of the file's samples on the log's clock, s, and a sentence about them.
struct Times {
    time_s: Vec<f64>,
    said: String,
}

impl<'a> Other<'a> {
    /// Reads the one recording of a file. `log`: the log that joins it.
    fn read(
        log: &Path,
        file: &'a JoinedFile,
        read: &dyn Fn(&Path) -> Result<Vec<Dated>, LogError>,
    ) -> Result<Self, LogError> {
        let path = log.parent().unwrap_or(Path::new("")).join(&file.file);
        let refused = |why: &str| Err(LogError::Join { why: why.to_owned(), path: path.clone() });
        let same = |a: &Path| a.canonicalize().ok();
        if same(&path).is_some_and(|other| same(log) == Some(other)) {
            return refused("it is the log itself; name the other file");
        }
        let mut recordings = read(&path)?;
        let count = recordings.len();
        let (Some(dated), true) = (recordings.pop(), count == 1) else {
            return refused(&format!("it holds {count} recordings; choose one with \"select\" in its sidecar"));
        };
        if !dated.recording.meta.join.is_empty() {
            return refused("its sidecar joins files itself; join all of them in the sidecar of the log");
        }
        if dated.recording.time_s.is_none() {
            return refused("it has no clock; state \"rate_hz\" in its sidecar");
        }
        Ok(Self { file, path, dated })
    }

    /// Name of the file, for a sentence.
    fn name(&self) -> String {
        self.path
            .file_name()
            .map_or_else(|| self.path.display().to_string(), |name| name.to_string_lossy().into_owned())
    }

    fn refused(&self, why: String) -> LogError {
        LogError::Join { why, path: self.path.clone() }
    }

    /// Times of the file's samples on the clock of the log.
    fn times_in(&self, own: &[Dated]) -> Result<Times, LogError> {
        let times = own.iter().map(|dated| dated.recording.time_s.as_deref());
        let Some(times) = times.collect::<Option<Vec<&[f64]>>>() else {
            return Err(self.refused("the log has no clock; state \"rate_hz\" in its sidecar".to_owned()));
        };
        if times.windows(2).any(|w| w[1].first() <= w[0].last()) {
            let why = format!("the clocks of the log's {} runs start again; choose one run with \"select\"", own.len());
            return Err(self.refused(why));
        }
        let shift = shift::between(own, &self.dated, self.file).map_err(|why| self.refused(why))?;
        let time = self.dated.recording.time_s.as_deref().unwrap_or_default();
        Ok(Times { time_s: time.iter().map(|&t| shift.moved(t)).collect(), said: shift.said })
    }

    /// Puts the channels that the log lacks onto its clock. Rows of the log outside the file's times, or in its gaps, are
    /// left out. `from`: times of the file's samples.
    fn put_on(&self, recording: &mut Recording, from: &Times) -> Result<(), LogError> {
        let other = &self.dated.recording;
        let new: Vec<&Channel> = other.channels.iter().filter(|c| recording.channel(&c.name).is_none()).collect();
        if new.is_empty() {
            let why = "the log has all of its channels already; give them other names with \"columns\" in its sidecar";
            return Err(self.refused(why.to_owned()));
        }
        let time = recording.time_s.clone().unwrap_or_default();
        let covered = resample::covered(&from.time_s, &time);
        let kept: Vec<usize> = (0..time.len()).filter(|&row| covered[row]).collect();
        if kept.len() < 2 {
            let ends = |time: &[f64]| (time.first().copied().unwrap_or(0.0), time.last().copied().unwrap_or(0.0));
            let ((a, b), (c, d)) = (ends(&from.time_s), ends(&time));
            let why = format!(
                "it runs from {a:.3} to {b:.3} s on the log's clock, and {} from {c:.3} to {d:.3} s; state another offset_s",
                recording.name
            );
            return Err(self.refused(why));
        }
        recording.keep(&kept);
        let to: Vec<f64> = kept.iter().map(|&row| time[row]).collect();
        for channel in new {
            if let Cells::Numbers(values) = resample::onto(&to, &from.time_s, &Cells::Numbers(channel.values.clone())) {
                recording.channels.push(Channel { values, ..channel.clone() });
            }
        }
        let is_known = recording.channels.iter().any(|c| units::is_program_name(&c.name));
        recording.warnings.retain(|w| w.kind != NO_KNOWN_COLUMN || !is_known);
        recording.warnings.extend(self.warnings(from, &to, time.len()));
        Ok(())
    }

    /// Warnings of a join onto the times `to`, s, of a log with so many `rows` before.
    fn warnings(&self, from: &Times, to: &[f64], rows: usize) -> Vec<Warning> {
        let name = self.name();
        let about = |kind: &str, text: String| Warning { kind: kind.to_owned(), text, ..Warning::default() };
        let joined = format!("`{name}` is joined: {}; {} of {rows} rows lie within its times", from.said, to.len());
        let put = resample::describe(&name, &from.time_s, to);
        let mut said = vec![about(JOINED, joined), about(RESAMPLED, put)];
        if resample::is_slower(&from.time_s, to) {
            let text = format!(
                "`{name}` is slower than the log: its values between samples are interpolated, so standard errors come out \
                 too small; join the faster file to the slower one"
            );
            said.push(about(JOINED, text));
        }
        // Its own sidecar settles them, and its rows are others.
        let own =
            self.dated.recording.warnings.iter().filter(|w| ![NO_CLOCK, NO_KNOWN_COLUMN].contains(&w.kind.as_str()));
        said.extend(own.map(|w| Warning {
            text: format!("{name}: {}", w.text),
            spans: Vec::new(),
            suggested: None,
            ..w.clone()
        }));
        said
    }
}

#[cfg(test)]
mod tests;
