//! Work of the recording thread.

use super::folder::{self, Marker};
use super::{Order, Shared, Wish};
use crate::text::sentence::sentence;
use estimator::log::{Attachment, LogError, McapStream};
use haptics::recording::Meta;
use haptics::servo::TickRecord;
use haptics::servo::recorder::{COLUMNS, Rows, facts};
use haptics::servo::tap::Tap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Interval at which the ring is emptied; it holds seconds. The thread polls, because a tick of the servo may not wake
/// a thread.
const REST: Duration = Duration::from_millis(25);
/// Interval between progress reports to the window.
const TOLD_EVERY: Duration = Duration::from_millis(100);
/// Interval between checks that the file still exists.
const LOOKED_EVERY: Duration = Duration::from_secs(1);
/// Minimum number of ticks of a usable file.
const FEWEST_TICKS: u64 = 2;

/// Records until requested otherwise, until the servo is gone, or until the disk fails.
pub(super) fn run(tap: Tap, order: &Order, shared: &Shared) {
    let mut files = Vec::new();
    let problem = record(tap, order, shared, &mut files).err();
    if shared.wish() == Wish::Discard {
        for path in &files {
            // It may be missing already.
            let _ = std::fs::remove_file(path);
        }
    }
    let mut status = shared.status();
    status.problem = problem;
    status.ended = true;
}

/// Writes file after file, and adds each to `files`.
fn record(tap: Tap, order: &Order, shared: &Shared, files: &mut Vec<PathBuf>) -> Result<(), String> {
    let rows = Rows::new(order.sensors, order.seed);
    let mut source = Source { tap, shared, rows, held: None, start_s: None, last_s: None, told: Instant::now() };
    loop {
        let mut file = Growing::begin(order, files.len())?;
        files.push(file.path.clone());
        shared.begin(&file.path, files.len());
        let filled = source.fill(&mut file, order.file_bytes);
        let (path, ticks) = (file.path.clone(), file.stream.rows());
        let full = file.end(filled, shared)?;
        if ticks < FEWEST_TICKS && shared.wish() != Wish::Discard {
            let _ = std::fs::remove_file(&path);
            files.pop();
            // The earlier files are a recording all the same.
            let before = files.last().ok_or("The recording is too short to be calibrated from.")?;
            shared.begin(before, files.len());
        }
        if !full {
            return Ok(());
        }
    }
}

/// File that is being written.
struct Growing {
    path: PathBuf,
    marker: Marker,
    stream: McapStream,
    meta: Meta,
}

impl Growing {
    fn begin(order: &Order, earlier: usize) -> Result<Self, String> {
        let (path, marker) = folder::reserve(&order.folder, &order.world.name)?;
        let mut meta = facts(&order.world);
        meta.known.extend(order.stated.known.clone());
        meta.other.extend(order.stated.other.clone());
        meta.other.insert("servo".to_owned(), order.servo.to_json());
        if earlier > 0 {
            meta.other.insert("recording_continued".to_owned(), serde_json::json!({ "earlier_files": earlier }));
        }
        let columns = COLUMNS.map(str::to_owned);
        match McapStream::create_labelled(&path, &columns, &meta, &attachments(order)) {
            Ok(stream) => Ok(Self { path, marker, stream, meta }),
            Err(error) => {
                marker.remove();
                // The file is empty.
                let _ = std::fs::remove_file(&path);
                Err(sentence(&error.to_string()))
            }
        }
    }

    /// Writes the metadata known only now, and the end of the file. True if another file follows.
    fn end(mut self, filled: Result<bool, String>, shared: &Shared) -> Result<bool, String> {
        let status = shared.status().clone();
        let recorder =
            serde_json::json!({ "ticks": self.stream.rows(), "dropped": status.dropped, "left_out": status.left_out });
        self.meta.other.insert("servo".to_owned(), shared.servo().to_json());
        self.meta.other.insert("recorder".to_owned(), recorder);
        self.meta.other.extend(shared.late());
        let (stream, meta) = (self.stream, &self.meta);
        let ended = filled.and_then(|full| {
            stream.finish_with(meta).map_err(|error| sentence(&error.to_string()))?;
            Ok(full)
        });
        // The problem is reported: nobody has to look for the file at the next start.
        self.marker.remove();
        let mut status = shared.status();
        status.earlier_ticks = status.ticks;
        status.earlier_bytes += std::fs::metadata(&self.path).map_or(0, |facts| facts.len());
        status.bytes = status.earlier_bytes;
        ended
    }
}

fn attachments(order: &Order) -> Vec<Attachment> {
    let json = |name: &str, data: String| Attachment {
        name: name.to_owned(),
        media_type: "application/json".to_owned(),
        data: data.into_bytes(),
    };
    let device = order.device.as_ref().and_then(|spec| serde_json::to_string_pretty(spec).ok());
    let world = json("world.json", order.world.to_json());
    std::iter::once(world).chain(device.map(|text| json("device.json", text))).collect()
}

/// Source of the ticks, independent of their file.
struct Source<'a> {
    tap: Tap,
    shared: &'a Shared,
    rows: Rows,
    /// Tick that found its file full.
    held: Option<TickRecord>,
    /// Time of the first tick in the servo's clock, s.
    start_s: Option<f64>,
    /// Time of the last row, s from the first one.
    last_s: Option<f64>,
    told: Instant,
}

impl Source<'_> {
    /// Fills a file; true if it is full and ticks remain.
    fn fill(&mut self, file: &mut Growing, most_bytes: u64) -> Result<bool, String> {
        let mut looked = Instant::now();
        loop {
            // Read before the ring is emptied: everything up to this moment is in the file.
            let over = self.tap.is_over();
            while let Some(tick) = self.held.take().or_else(|| self.tap.pop()) {
                if file.stream.bytes() >= most_bytes && file.stream.rows() >= FEWEST_TICKS {
                    self.held = Some(tick);
                    self.tell(file);
                    return Ok(true);
                }
                self.write(&tick, file).map_err(|error| self.refused(&error, &file.path))?;
                // A ring that is never empty must not hide the progress.
                if self.told.elapsed() >= TOLD_EVERY {
                    self.tell(file);
                }
                if self.shared.wish() == Wish::Discard {
                    return Ok(false);
                }
            }
            file.stream.poll().map_err(|error| self.refused(&error, &file.path))?;
            self.tell(file);
            if over {
                return Ok(false);
            }
            if looked.elapsed() >= LOOKED_EVERY {
                looked = Instant::now();
                still_there(&file.path)?;
            }
            std::thread::sleep(REST);
        }
    }

    fn write(&mut self, tick: &TickRecord, file: &mut Growing) -> Result<(), LogError> {
        let time_s = tick.time_s - *self.start_s.get_or_insert(tick.time_s);
        let row = self.rows.row(tick);
        let stands_still = self.last_s.is_some_and(|last_s| time_s <= last_s);
        if stands_still || !time_s.is_finite() || row.iter().any(|value| !value.is_finite()) {
            self.shared.status().left_out += 1;
            return Ok(());
        }
        self.last_s = Some(time_s);
        file.stream.push_labelled(time_s, &row, tick.label)
    }

    fn tell(&mut self, file: &Growing) {
        self.told = Instant::now();
        let mut status = self.shared.status();
        status.ticks = status.earlier_ticks + file.stream.rows();
        status.bytes = status.earlier_bytes + file.stream.bytes();
        status.length_s = self.last_s.unwrap_or(0.0);
        status.dropped = self.tap.dropped();
    }

    fn refused(&self, error: &LogError, path: &Path) -> String {
        let why = match error {
            LogError::Write { reason, .. } => reason.clone(),
            other => other.to_string(),
        };
        let (length, path) = (crate::text::format::clock(self.last_s.unwrap_or(0.0)), path.display());
        format!(
            "The recording ended after {length} because the disk refused it ({why}); what was written until then is kept, \
             training goes on: {path}."
        )
    }
}

/// Error if the file was removed: it would still accept bytes, which nobody could read.
fn still_there(path: &Path) -> Result<(), String> {
    match std::fs::metadata(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Err(format!(
            "The recording ended because its file was moved or removed while it was written: {}.",
            path.display()
        )),
        // A folder that is temporarily unreadable is no reason to end.
        _ => Ok(()),
    }
}
