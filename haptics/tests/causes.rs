//! The pages in `docs/causes/` are those of the catalogue, and none is missing or left over.

#[path = "../examples/causes/pages.rs"]
mod pages;

use haptics::law::causes;
use std::collections::BTreeSet;

#[test]
fn the_written_pages_are_those_of_the_catalogue() {
    for (name, text) in pages::pages() {
        let written = std::fs::read_to_string(pages::folder().join(&name)).unwrap_or_default();
        // Windows may have checked the pages out with its own ends of lines.
        let written = written.replace("\r\n", "\n");
        assert!(
            written == text,
            "docs/causes/{name} is not what the laws say; `cargo run -p haptics --example causes` writes it"
        );
    }
}

/// Ids stand in saved worlds, in JSON and in other people's scripts.
#[test]
fn every_cause_stands_in_the_vocabulary_and_no_id_was_ever_changed() {
    let written = std::fs::read_to_string(pages::vocabulary_file()).expect("the vocabulary");
    let stands: BTreeSet<&str> = written.lines().collect();
    let lines: Vec<String> = causes().map(pages::vocabulary_line).collect();
    let wanted: BTreeSet<&str> = lines.iter().map(String::as_str).collect();
    let (lost, new): (Vec<_>, Vec<_>) = (stands.difference(&wanted).collect(), wanted.difference(&stands).collect());
    assert!(lost.is_empty(), "users' files have these ids, which no cause has any more: {lost:?}");
    assert!(new.is_empty(), "`cargo run -p haptics --example causes` adds {new:?} to docs/causes/ids.txt");
}

#[test]
fn every_cause_has_its_page_and_no_page_is_left_over() {
    let pages = causes().map(|entry| entry.id).chain(["other", "README"]).map(|id| format!("{id}.md"));
    let wanted: BTreeSet<String> = pages.chain(["ids.txt".to_owned()]).collect();
    let listed = std::fs::read_dir(pages::folder()).expect("the folder is there");
    let there: BTreeSet<String> =
        listed.map(|file| file.expect("listed").file_name().to_string_lossy().into_owned()).collect();
    assert_eq!(there, wanted);
}

#[test]
fn every_page_says_all_four_things_and_the_law() {
    for (name, text) in pages::pages().iter().filter(|(name, _)| name != "README.md" && name != "other.md") {
        for title in ["What it is", "How it shows", "What mimics it", "Which motion reveals it", "Parameters"] {
            assert!(text.contains(&format!("## {title}\n\n")), "{name}: {title}");
        }
        assert!(!text.contains("//!") && !text.contains("[`"), "{name}: marks of the source");
    }
    let friction = pages::pages().into_iter().find(|(name, _)| name == "coulomb-friction.md").expect("it has a page").1;
    assert!(friction.contains("## The law\n\nCoulomb friction: Fc sgn(v)") && friction.contains("(Coulomb 1785)"));
}
