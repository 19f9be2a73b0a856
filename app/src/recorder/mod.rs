//! Recording to the disk while somebody trains: a thread of its own takes every tick from the servo and writes it.
//!
//! Neither the servo nor the window waits for it, and memory does not grow with the length. A killed program leaves a file that
//! opens up to its last second; [`folder`] finds it at the next start.

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

/// A window that is closed waits so long for the end of the file.
const FAREWELL: Duration = Duration::from_secs(3);
/// A file that has become so large is ended and followed by the next one, bytes: about four hours at 1 kHz. It stays well below what
/// the reader takes at once.
pub const FILE_BYTES: u64 = 1 << 30;

/// How the servo keeps its time, for the sidecar.
#[derive(Clone, Copy, Debug, Default)]
pub struct ServoFacts {
    /// What it measured.
    pub timing: Timing,
    /// What the system granted to it.
    pub privileges: Option<Privileges>,
}

impl ServoFacts {
    fn to_json(self) -> Value {
        let Self { timing, privileges } = self;
        serde_json::json!({ "why": timing.rate.sentence(), "timing": timing, "privileges": privileges })
    }
}

/// What is recorded, and where to.
#[derive(Clone, Debug)]
pub struct Order {
    /// Folder of the file; it is made if it is not there.
    pub folder: PathBuf,
    /// The world that is touched.
    pub world: Arc<World>,
    /// The device that touches it.
    pub device: Option<DeviceSpec>,
    /// How the hand's sensors see it.
    pub sensors: SensorModel,
    /// Draws the sensors' noise.
    pub seed: u64,
    /// A file that has become so large is followed by the next one, bytes ([`FILE_BYTES`]).
    pub file_bytes: u64,
    /// How the servo keeps its time until now.
    pub servo: ServoFacts,
    /// What else the sidecar states: its `known` values and further keys.
    pub stated: Meta,
}

/// How far a recording is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Status {
    /// The newest file, once there is one.
    pub path: Option<PathBuf>,
    /// Number of files.
    pub files: usize,
    /// Ticks that were written, to all files.
    pub ticks: u64,
    /// Time that they cover, s.
    pub length_s: f64,
    /// Size of all files on the disk, bytes.
    pub bytes: u64,
    /// Ticks that were lost because the disk did not keep up.
    pub dropped: u64,
    /// Ticks that a file cannot hold: a value is not a number, or time stands still.
    pub left_out: u64,
    /// Why the recording ended by itself, in one sentence.
    pub problem: Option<String>,
    /// True when nothing more will be written.
    pub ended: bool,
    /// Ticks of the files before this one.
    earlier_ticks: u64,
    /// Their size, bytes.
    earlier_bytes: u64,
}

/// A recording that is complete.
#[derive(Clone, Debug, PartialEq)]
pub struct Finished {
    /// The file; the newest one if there are several.
    pub path: PathBuf,
    /// What was recorded.
    pub status: Status,
}

/// What is to become of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
enum Wish {
    Record,
    Keep,
    Discard,
}

/// What the window and the recording thread have in common.
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
        // What is in it is whole after every assignment.
        self.status.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The file that is written now.
    fn begin(&self, path: &Path, files: usize) {
        let mut status = self.status();
        status.path = Some(path.to_path_buf());
        status.files = files;
    }

    /// What is stated at the end.
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
    /// Closed by the end of the thread, whatever ends it.
    over: Receiver<()>,
}

impl Recorder {
    /// Begins to write every tick. Errors are one sentence; those of the disk come in [`Status::problem`].
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

    /// How far it is.
    pub fn status(&self) -> Status {
        self.shared.status().clone()
    }

    /// True when nothing more will be written.
    pub fn has_ended(&self) -> bool {
        self.shared.status().ended || self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Keeps for the end of the file how the servo keeps its time.
    pub fn tell(&self, servo: ServoFacts) {
        *self.shared.servo() = servo;
    }

    /// Keeps for the end of the file what its sidecar states in addition, or in another way than at the beginning.
    pub fn state(&self, key: &str, value: Value) {
        self.shared.late.lock().unwrap_or_else(PoisonError::into_inner).insert(key.to_owned(), value);
    }

    /// Ends it: no further tick is taken, the file gets its end in the background.
    pub fn stop(mut self) -> Stopping {
        self.end(Wish::Keep);
        Stopping { shared: Arc::clone(&self.shared), thread: self.thread.take() }
    }

    /// Ends it, and its file is removed.
    pub fn discard(mut self) {
        self.end(Wish::Discard);
        self.thread = None; // it does that alone
    }

    fn end(&self, wish: Wish) {
        self.shared.wish.store(wish as u8, Ordering::Relaxed);
        // Here and not on the thread: a world that is swapped in next must not get into the file. After the wish: the thread asks
        // for it once the tap is closed.
        self.source.close();
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        if self.thread.take().is_none() {
            return;
        }
        self.end(Wish::Keep);
        // Nothing is ever sent: the wait ends with the thread, or when a disk that hangs has been given time enough.
        let _ = self.over.recv_timeout(FAREWELL);
    }
}

/// A recording whose end is being written.
pub struct Stopping {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl Stopping {
    /// Waits for the end of the file; a job for a thread in the background. The error is one sentence.
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
