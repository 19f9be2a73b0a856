//! Touchstone beside a program that it shares nothing with: MuJoCo. Skipped with a word where Python has no `mujoco`.
//!
//! Logs that MuJoCo makes are fitted and replayed (`fits.rs`), worlds that are exported to it are run there (`exports.rs`).
//! `TOUCHSTONE_WRITE_VALIDATION=1 cargo test -p tests --test mujoco` writes the tables of `docs/validation.md` anew.

mod exports;
mod fits;
mod table;

use table::Table;

#[test]
fn what_mujoco_made_is_found_and_replayed() {
    let Some(made) = fits::made() else { return };
    let (found, replayed) = (fits::found(&made), fits::replayed(&made));
    table::keep("fits", &found);
    table::keep("replays", &replayed);
    found.demand();
    replayed.demand();
}

#[test]
fn what_is_exported_does_the_same_in_mujoco() {
    let Some(table) = exports::compared() else { return };
    table::keep("exports", &table);
    table.demand();
}

#[test]
fn a_table_with_a_row_that_is_off_is_refused() {
    let row =
        |found: f64| table::Row { labels: vec!["a".to_owned()], shown: Vec::new(), found, wanted: 1.0, tolerance: 0.1 };
    let table = |found| Table { head: Vec::new(), rows: vec![row(1.0), row(found)] };
    assert!(table(1.05).off().is_empty());
    assert_eq!(table(1.2).off().len(), 1);
    assert_eq!(table(f64::NAN).off().len(), 1);
}
