//! Recording to the disk during training: a thread of its own takes every tick from the servo and writes it.
//!
//! Neither the servo nor the window waits for it, and memory does not grow with the length. A killed program leaves a
//! file that is readable up to its last second; [`folder`] finds it at the next start.

pub mod folder;
mod work;

use haptics::device::DeviceSpec;
use haptics::recording::Meta;
use haptics::servo::Privileges;
use haptics::servo::recorder::SensorModel;
use haptics::servo::tap::{Tap, TapSource};
use haptics::servo::timing::Timing;
use haptics::world::World;
use serde_json::{Map, Value};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// Maximum time for which a closing window waits for the end of the file.
const FAREWELL: Duration = Duration::from_secs(3);
/// File size above which a file is ended and followed by the next one, bytes: about four hours at 1 kHz. It is well
/// below the reader's limit.
pub const FILE_BYTES: u64 = 1 << 30;

/// Timing of the servo, for the sidecar.
#[derive(Clone, Copy, Debug, Default)]
pub struct ServoFacts {
    /// Measured timing.
    pub timing: Timing,
    /// Privileges granted by the system.
    pub privileges: Option<Privileges>,
}

impl ServoFacts {
    fn to_json(self) -> Value {
        let Self { timing, privileges } = self;
        serde_json::json!({ "why": timing.rate.sentence(), "timing": timing, "privileges": privileges })
    }
}

/// Settings of a recording.
#[derive(Clone, Debug)]
pub struct Order {
    /// Folder of the file; it is created if missing.
    pub folder: PathBuf,
    /// World of the recording.
    pub world: Arc<World>,
    /// Specification of the operator's device.
    pub device: Option<DeviceSpec>,
    /// Model of the hand's sensors.
    pub sensors: SensorModel,
    /// Seed of the sensor noise.
    pub seed: u64,
    /// File size above which the next file starts, bytes ([`FILE_BYTES`]).
    pub file_bytes: u64,
    /// Timing of the servo until now.
    pub servo: ServoFacts,
    /// Additional metadata of the sidecar: `known` values and further keys.
    pub stated: Meta,
}

/// Progress of a recording.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Status {
    /// The newest file, once there is one.
    pub path: Option<PathBuf>,
    /// Number of files.
    pub files: usize,
    /// Ticks written, in all files.
    pub ticks: u64,
    /// Duration that they cover, s.
    pub length_s: f64,
    /// Size of all files on the disk, bytes.
    pub bytes: u64,
    /// Ticks that were lost because the disk did not keep up.
    pub dropped: u64,
    /// Ticks that a file cannot store: a value is not a number, or time does not advance.
    pub left_out: u64,
    /// Reason why the recording ended by itself, in one sentence.
    pub problem: Option<String>,
    /// True if nothing more will be written.
    pub ended: bool,
    /// Ticks of the earlier files.
    earlier_ticks: u64,
    /// Size of the earlier files, bytes.
    earlier_bytes: u64,
}

/// Completed recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Finished {
    /// The file; the newest one if there are several.
    pub path: PathBuf,
    /// Final status.
    pub status: Status,
}

/// Fate of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
enum Wish {
    Record,
    Keep,
    Discard,
}

/// State shared by the window and the recording thread.
struct Shared {
    wish: AtomicU8,
    status: Mutex<Status>,
    servo: Mutex<ServoFacts>,
    late: Mutex<Map<String, Value>>,
}

impl Shared {
    fn wish(&self) -> Wish {
        match self.wish.load(Ordering::Relaxed) {
            0 => Wish::Record,
            1 => Wish::Keep,
            _ => Wish::Discard,
        }
    }

    fn status(&self) -> MutexGuard<'_, Status> {
        // The value is consistent after every assignment.
        self.status.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Sets the file that is now being written.
    fn begin(&self, path: &Path, files: usize) {
        let mut status = self.status();
        status.path = Some(path.to_path_buf());
        status.files = files;
    }

    /// Metadata for the end of the file.
    fn late(&self) -> Map<String, Value> {
        self.late.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn servo(&self) -> MutexGuard<'_, ServoFacts> {
        self.servo.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A running recording. Dropping it keeps the file.
pub struct Recorder {
    shared: Arc<Shared>,
    source: TapSource,
    thread: Option<JoinHandle<()>>,
    /// Closed at the end of the thread, for any reason.
    over: Receiver<()>,
}

impl Recorder {
    /// Starts to write every tick. Errors are one sentence; those of the disk come in [`Status::problem`].
    pub fn start(source: &TapSource, order: Order) -> Result<Self, String> {
        let tap = source.open().ok_or("The last recording is still being written; try again in a moment.")?;
        Self::begin(source, tap, order)
            .map_err(|error| format!("The system gave no thread for the recording ({error}); close other programs."))
    }

    fn begin(source: &TapSource, tap: Tap, order: Order) -> std::io::Result<Self> {
        let shared = Arc::new(Shared {
            wish: AtomicU8::new(Wish::Record as u8),
            status: Mutex::default(),
            servo: Mutex::new(order.servo),
            late: Mutex::default(),
        });
        let theirs = Arc::clone(&shared);
        let (running, over) = channel::<()>();
        let thread = std::thread::Builder::new().name("recorder".to_owned()).spawn(move || {
            let _running = running;
            work::run(tap, &order, &theirs);
        })?;
        Ok(Self { shared, source: source.clone(), thread: Some(thread), over })
    }

    /// Progress of the recording.
    pub fn status(&self) -> Status {
        self.shared.status().clone()
    }

    /// True if nothing more will be written.
    pub fn has_ended(&self) -> bool {
        self.shared.status().ended || self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Sets the servo timing for the end of the file.
    pub fn tell(&self, servo: ServoFacts) {
        *self.shared.servo() = servo;
    }

    /// Sets a sidecar entry for the end of the file, in addition to those of the start or as a replacement.
    pub fn state(&self, key: &str, value: Value) {
        self.shared.late.lock().unwrap_or_else(PoisonError::into_inner).insert(key.to_owned(), value);
    }

    /// Ends the recording: no further tick is taken, the file is finished in the background.
    pub fn stop(mut self) -> Stopping {
        self.end(Wish::Keep);
        Stopping { shared: Arc::clone(&self.shared), thread: self.thread.take() }
    }

    /// Ends the recording and removes its file.
    pub fn discard(mut self) {
        self.end(Wish::Discard);
        self.thread = None; // it does that alone
    }

    fn end(&self, wish: Wish) {
        self.shared.wish.store(wish as u8, Ordering::Relaxed);
        // Here and not on the thread: a world that is swapped in next must not get into the file. After the request is
        // set: the thread reads it once the tap is closed.
        self.source.close();
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        if self.thread.take().is_none() {
            return;
        }
        self.end(Wish::Keep);
        // Nothing is ever sent: the wait ends with the thread, or after the time limit if the disk hangs.
        let _ = self.over.recv_timeout(FAREWELL);
    }
}

/// A recording whose end is being written.
pub struct Stopping {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl Stopping {
    /// Waits for the end of the file; for a background thread. The error is one sentence.
    pub fn wait(mut self) -> Result<Finished, String> {
        let ended = self.thread.take().map(JoinHandle::join);
        let status = self.shared.status().clone();
        if ended.is_some_and(|joined| joined.is_err()) {
            return Err("An internal fault ended the recording; what was written until then is kept.".to_owned());
        }
        match (&status.problem, &status.path) {
            (Some(problem), _) => Err(problem.clone()),
            (None, Some(path)) => Ok(Finished { path: path.clone(), status }),
            (None, None) => Err("Nothing was recorded.".to_owned()),
        }
    }
}
