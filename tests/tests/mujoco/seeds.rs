//! The same logs of other seeds: what the tables' own one hides.

use super::fits::{self, Made, UNSEEN, Within};
use super::table::{Row, Table};
use super::thrown;
use std::time::{SystemTime, UNIX_EPOCH};

/// Seeds that the document tells of beside its own.
const OTHERS: [u64; 8] = [1000, 2000, 3000, 4000, 5000, 6000, 7000, 8000];

/// A seed that nobody has seen: the day, or what repeats one.
pub fn today() -> u64 {
    let day = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |time| time.as_secs() / 86_400);
    std::env::var("TOUCHSTONE_SEED").ok().and_then(|text| text.parse().ok()).unwrap_or_else(day)
}

/// All comparisons of some logs, by the names of their places in the document.
pub fn tables(made: &Made, within: Within) -> [(&'static str, Table); 3] {
    [("fits", fits::found(made, within)), ("replays", fits::replayed(made, within)), ("thrown", thrown::compared(made))]
}

/// The tables of the other seeds; only where the document is written.
pub fn others() -> Option<Vec<[(&'static str, Table); 3]>> {
    std::env::var_os("TOUCHSTONE_WRITE_VALIDATION")?;
    OTHERS.iter().map(|seed| Some(tables(&fits::made(*seed)?, UNSEEN))).collect()
}

/// For each row of a table, what the other seeds have there: the least and the most, in the unit that the row is told in.
pub fn spread(others: &[[(&'static str, Table); 3]], name: &str, table: &Table) -> Vec<String> {
    let same = |row: &Row| -> Vec<f64> {
        let tables = others.iter().flatten().filter(|(other, _)| *other == name).flat_map(|(_, table)| &table.rows);
        tables
            .filter(|other| other.labels == row.labels)
            .map(|other| (other.found - other.wanted) / other.per)
            .collect()
    };
    let told = |row: &Row| {
        let mut all = same(row);
        all.sort_by(f64::total_cmp);
        match (all.first(), all.last()) {
            (Some(least), Some(most)) => format!("{least:.*} … {most:.*}", row.places, row.places),
            _ => "–".to_owned(),
        }
    };
    table.rows.iter().map(told).collect()
}
