//! What the recording thread does.

use super::folder;
use super::{Order, Shared, Wish};
use crate::ui::session::sentence;
use estimator::log::{Attachment, LogError, McapStream};
use haptics::recording::Meta;
use haptics::servo::TickRecord;
use haptics::servo::recorder::{COLUMNS, Rows, SensorModel, facts};
use haptics::servo::tap::Tap;
use std::path::Path;
use std::time::{Duration, Instant};

/// The ring is emptied this often; it holds seconds.
const REST: Duration = Duration::from_millis(25);
/// The window hears of the progress this often.
const TOLD_EVERY: Duration = Duration::from_millis(100);
/// It is looked this often whether the file is still there.
const LOOKED_EVERY: Duration = Duration::from_secs(1);
/// A recording with fewer ticks is nothing to measure from.
const FEWEST_TICKS: u64 = 2;

/// Records until told otherwise, until the servo is gone, or until the disk refuses.
pub(super) fn run(tap: Tap, order: &Order, shared: &Shared) {
    let problem = record(tap, order, shared).err();
    let mut status = shared.status();
    status.problem = problem;
    status.ended = true;
}

fn record(tap: Tap, order: &Order, shared: &Shared) -> Result<(), String> {
    let (path, marker) = folder::reserve(&order.folder, &order.world.name)?;
    let mut meta = facts(&order.world);
    meta.other.insert("servo".to_owned(), order.servo.to_json());
    let columns = COLUMNS.map(str::to_owned);
    let stream = match McapStream::create_labelled(&path, &columns, &meta, &attachments(order)) {
        Ok(stream) => stream,
        Err(error) => {
            marker.remove();
            // Nothing is in it.
            let _ = std::fs::remove_file(&path);
            return Err(sentence(&error.to_string()));
        }
    };
    shared.status().path = Some(path.clone());
    let rows = Rows::new(SensorModel::TYPICAL, order.seed);
    let mut writing =
        Writing { tap, shared, stream, rows, path: &path, start_s: None, last_s: 0.0, told: Instant::now() };
    let written = writing.until_over();
    writing.tell();
    let ticks = writing.stream.rows();
    // Closes it: the next recording may begin while this one gets its end.
    let Writing { stream, tap, .. } = writing;
    drop(tap);
    // What went wrong was or will be said: nobody has to look for the file.
    let ended = written.and_then(|()| finish(stream, &path, meta, shared));
    marker.remove();
    if shared.wish() == Wish::Discard {
        // It may be gone already.
        let _ = std::fs::remove_file(&path);
        return Ok(());
    }
    ended?;
    if ticks < FEWEST_TICKS {
        let _ = std::fs::remove_file(&path);
        return Err("The recording is too short to be calibrated from.".to_owned());
    }
    Ok(())
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

struct Writing<'a> {
    tap: Tap,
    shared: &'a Shared,
    stream: McapStream,
    rows: Rows,
    path: &'a Path,
    /// Time of the first tick in the servo's clock, s.
    start_s: Option<f64>,
    /// Time of the last row, s from the first one.
    last_s: f64,
    told: Instant,
}

impl Writing<'_> {
    fn until_over(&mut self) -> Result<(), String> {
        let mut looked = Instant::now();
        loop {
            // Asked before the ring is emptied: what came in until then is in the file.
            let over = self.tap.is_over();
            while let Some(tick) = self.tap.pop() {
                self.write(&tick).map_err(|error| self.refused(&error))?;
                // A ring that is never empty must not hide the progress.
                if self.told.elapsed() >= TOLD_EVERY {
                    self.tell();
                }
                if self.shared.wish() == Wish::Discard {
                    return Ok(());
                }
            }
            self.stream.poll().map_err(|error| self.refused(&error))?;
            self.tell();
            if over {
                return Ok(());
            }
            if looked.elapsed() >= LOOKED_EVERY {
                looked = Instant::now();
                self.look()?;
            }
            std::thread::sleep(REST);
        }
    }

    fn write(&mut self, tick: &TickRecord) -> Result<(), LogError> {
        let time_s = tick.time_s - *self.start_s.get_or_insert(tick.time_s);
        let row = self.rows.row(tick);
        let stands_still = self.stream.rows() > 0 && time_s <= self.last_s;
        if stands_still || !time_s.is_finite() || row.iter().any(|value| !value.is_finite()) {
            self.shared.status().left_out += 1;
            return Ok(());
        }
        self.last_s = time_s;
        self.stream.push_labelled(time_s, &row, tick.label)
    }

    /// A file that was removed takes bytes as before; they are nowhere.
    fn look(&self) -> Result<(), String> {
        match std::fs::metadata(self.path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Err(format!(
                "The recording ended because its file was moved or removed while it was written: {}.",
                self.path.display()
            )),
            // A folder that cannot be looked at for a moment is no reason to end.
            _ => Ok(()),
        }
    }

    fn tell(&mut self) {
        self.told = Instant::now();
        let mut status = self.shared.status();
        status.ticks = self.stream.rows();
        status.length_s = self.last_s;
        status.bytes = self.stream.bytes();
        status.dropped = self.tap.dropped();
    }

    fn refused(&self, error: &LogError) -> String {
        let why = match error {
            LogError::Write { reason, .. } => reason.clone(),
            other => other.to_string(),
        };
        let (length, path) = (crate::ui::format::clock(self.last_s), self.path.display());
        format!(
            "The recording ended after {length} because the disk refused it ({why}); what was written until then is kept, \
             training goes on: {path}."
        )
    }
}

/// Facts that are complete only now, and the end of the file.
fn finish(stream: McapStream, path: &Path, mut meta: Meta, shared: &Shared) -> Result<(), String> {
    let status = shared.status().clone();
    let recorder = serde_json::json!({ "ticks": status.ticks, "dropped": status.dropped, "left_out": status.left_out });
    meta.other.insert("servo".to_owned(), shared.servo().to_json());
    meta.other.insert("recorder".to_owned(), recorder);
    stream.finish_with(&meta).map_err(|error| sentence(&error.to_string()))?;
    shared.status().bytes = std::fs::metadata(path).map_or(status.bytes, |facts| facts.len());
    Ok(())
}
