//! The wishes of whoever asks for a picture.

use crate::video::reading::VideoSource;
use haptics::recording::{Recording, Task};
use haptics::world::World;
use std::path::PathBuf;

/// The wishes of whoever asks for a picture.
#[derive(Clone, Debug, Default)]
pub struct PictureInput {
    /// A log to load.
    pub log: Option<PathBuf>,
    /// Its sidecar, where it is not beside the log.
    pub meta: Option<PathBuf>,
    /// Recordings in memory, instead of a log.
    pub recordings: Vec<Recording>,
    /// The task; told from the recording when absent.
    pub task: Option<Task>,
    /// The world of the trainer; the two blocks when absent.
    pub world: Option<World>,
    /// A video of the hand.
    pub video: Option<VideoSource>,
    /// A person at the mouse instead of the scripted operator.
    pub by_hand: bool,
    /// Time of the cursor, s (in the trainer: of the scripted operator); two fifths of the way when absent.
    pub time_s: Option<f64>,
}
