//! Every file of `docs/causes/`, as it should be: the catalogue's words and the docstrings of the laws' files.

use haptics::law::{Entry, Kind, causes, page};
use std::path::{Path, PathBuf};

/// Where the pages lie.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/causes")
}

/// The vocabulary: kind and id of every cause, in the order in which they came.
pub fn vocabulary_file() -> PathBuf {
    folder().join("ids.txt")
}

/// A line of the vocabulary.
pub fn vocabulary_line(entry: &Entry) -> String {
    let kind = match entry.kind {
        Kind::Plant => "plant",
        Kind::Instrument => "instrument",
    };
    format!("{kind} {}", entry.id)
}

/// Names and contents.
pub fn pages() -> Vec<(String, String)> {
    let mut pages: Vec<(String, String)> =
        causes().map(|entry| (format!("{}.md", entry.id), page::page(entry, &docstring(entry.id)))).collect();
    pages.push(("other.md".to_owned(), page::nameless()));
    pages.push(("README.md".to_owned(), page::index(causes())));
    pages
}

/// What stands after `//!` at the head of a law's file, without the marks of rustdoc; nothing for faults that have no file.
fn docstring(id: &str) -> String {
    let laws = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/law");
    let name = format!("{}.rs", id.replace('-', "_"));
    let text =
        [laws.join(&name), laws.join("contact").join(&name)].iter().find_map(|p| std::fs::read_to_string(p).ok());
    let text = text.unwrap_or_default();
    let lines = text.lines().map_while(|line| line.strip_prefix("//!")).map(str::trim_start);
    lines.collect::<Vec<_>>().join("\n").replace("[`", "`").replace("`]", "`")
}
