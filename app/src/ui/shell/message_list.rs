//! Messages to the user.

use crate::text::file_name::name_of;
use std::path::Path;
use std::time::{Duration, Instant};

/// Severity of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// Something did not work.
    Error,
    /// Something was done.
    Done,
}

/// A message above the workspace.
#[derive(Clone, Debug, PartialEq)]
pub struct Banner {
    /// Severity.
    pub tone: Tone,
    /// One sentence.
    pub text: String,
    /// More about it, for those who point at it.
    pub hint: String,
    /// Time at which the message vanishes; `None` if it stays until it is dismissed.
    pub until: Option<Instant>,
}

/// Time for which the message of a completed action stays.
const DONE_LASTS: Duration = Duration::from_secs(6);

/// The messages above the workspace.
#[derive(Default)]
pub struct Messages {
    /// The oldest first.
    pub banners: Vec<Banner>,
}

impl Messages {
    /// Adds an error.
    pub fn fail(&mut self, text: impl Into<String>) {
        self.say(Tone::Error, text.into());
    }

    /// Adds a message; the same one is not shown twice.
    pub fn say(&mut self, tone: Tone, text: String) {
        let until = (tone == Tone::Done).then(|| Instant::now() + DONE_LASTS);
        match self.banners.iter_mut().find(|banner| banner.tone == tone && banner.text == text) {
            Some(banner) => banner.until = until,
            None => self.banners.push(Banner { tone, text, hint: String::new(), until }),
        }
    }

    /// Says that a file was written: its name, and the whole path for those who point at it.
    pub fn say_saved(&mut self, path: &Path) {
        let text = format!("Saved {}.", name_of(path));
        self.say(Tone::Done, text.clone());
        if let Some(banner) = self.banners.iter_mut().find(|b| b.text == text) {
            banner.hint = path.display().to_string();
        }
    }
}
