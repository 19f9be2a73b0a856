//! Touchstone beside programs that it shares nothing with: MuJoCo, and Drake as a reader of SDF. Skipped with a word where
//! Python has no `mujoco` or `pydrake`.
//!
//! Logs that MuJoCo makes are fitted and replayed (`fits.rs`), its cranks are diagnosed blind (`hidden.rs`), and worlds that
//! are exported to it are run there (`exports.rs`).
//! `TOUCHSTONE_WRITE_VALIDATION=1 cargo test -p tests --test mujoco` writes the tables of `docs/validation.md` anew.

mod drake;
mod exports;
mod fits;
mod hidden;
mod seeds;
mod table;
mod thrown;

use table::Table;

#[test]
fn what_mujoco_made_is_found_and_replayed() {
    let Some(made) = fits::made(fits::SEED) else { return };
    let tables = seeds::tables(&made, fits::KNOWN);
    let others = seeds::others();
    for (name, table) in tables {
        let told = others.as_ref().map(|all| seeds::spread(all, name, &table));
        table::keep(name, &table, told.as_deref());
        table.demand();
    }
}

#[test]
fn what_mujoco_made_today_is_found_and_replayed() {
    let seed = seeds::today();
    println!("TOUCHSTONE_SEED={seed} repeats it");
    let Some(made) = fits::made(seed) else { return };
    for (_, table) in seeds::tables(&made, fits::UNSEEN) {
        table.demand();
    }
}

#[test]
fn hidden_effects_of_mujocos_cranks_are_named_and_nothing_else() {
    let Some(score) = hidden::scored() else { return };
    println!("{score:#?}");
    let is_quiet = score.alarms == 0 && 12 * score.misled <= score.logs;
    assert!(10 * score.named >= 9 * score.hidden && is_quiet, "{score:#?}");
}

#[test]
fn what_is_exported_does_the_same_in_mujoco() {
    let Some(table) = exports::compared() else { return };
    table::keep("exports", &table, None);
    table.demand();
}

#[test]
fn what_is_exported_opens_in_drake_and_swings_alike() {
    let Some(()) = drake::everything_is_there() else { return };
    let Some(table) = drake::compared() else { return };
    table::keep("drake", &table, None);
    table.demand();
}

#[test]
fn a_table_with_a_row_that_is_off_is_refused() {
    let row = |found: f64| table::Row {
        labels: vec!["a".to_owned()],
        shown: Vec::new(),
        found,
        wanted: 1.0,
        tolerance: 0.1,
        per: 1.0,
        places: 1,
    };
    let table = |found| Table { head: Vec::new(), rows: vec![row(1.0), row(found)] };
    assert!(table(1.05).off().is_empty());
    assert_eq!(table(1.2).off().len(), 1);
    assert_eq!(table(f64::NAN).off().len(), 1);
}
