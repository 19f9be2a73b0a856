//! Files that were open before.

use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Largest number of kept files.
const MOST: usize = 10;

/// Files that were open, the newest first.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Recent(#[serde(with = "crate::path_bytes")] Vec<PathBuf>);

impl Recent {
    /// A file was opened or saved.
    pub fn note(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
        self.0.retain(|known| *known != path);
        self.0.insert(0, path);
        self.0.truncate(MOST);
    }

    /// The newest first.
    pub fn files(&self) -> &[PathBuf] {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newest_stands_first_and_once() {
        let mut recent = Recent::default();
        for index in 0..12 {
            recent.note(Path::new(&format!("/logs/{index}.csv")));
        }
        recent.note(Path::new("/logs/5.csv"));
        assert_eq!(recent.files().len(), MOST);
        assert_eq!(recent.files()[0], Path::new("/logs/5.csv"));
        assert_eq!(recent.files().iter().filter(|p| p.ends_with("5.csv")).count(), 1);
    }
}
