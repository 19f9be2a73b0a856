//! Writing a text file whole or not at all.

use std::path::Path;

/// Writes beside the file first, so that a crash or a full disk leaves the old one or the new one.
pub fn write_whole(path: &Path, text: &str) -> Result<(), String> {
    haptics::text_file::write(path, text).map_err(|e| {
        format!("The file cannot be written ({e}); check the folder and its permissions: {}", path.display())
    })
}
