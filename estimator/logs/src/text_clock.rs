//! Time columns of text in a container: times of the calendar or of the day become seconds.

use super::csv::calendar::{self, Days, Form};
use super::errors::{LogError, MAP_ANOTHER};
use super::plan::{Plan, Use};
use super::raw::{Cells, Raw};
use haptics::recording::Meta;
use std::path::Path;

/// Puts seconds since the first row in place of the text of a time column; nothing if the time is no text.
pub fn take(raw: &mut Raw, plan: &mut Plan, meta: &Meta, path: &Path) -> Result<Days, LogError> {
    let first: Vec<String> = raw.columns.iter().map(first_text).collect();
    plan.take_stamps(&raw.headers, &first, meta);
    let Some(column) = plan.time.filter(|column| matches!(plan.uses[*column], Use::Stamp { .. })) else {
        return Ok(Days::default());
    };
    let mut read = seconds(raw, column, plan.uses[column]);
    if read.is_err() && plan.turn_dates(&first) {
        read = seconds(raw, column, plan.uses[column]).or(read);
    }
    let (values, days) = read.map_err(|row| LogError::BadCell {
        row: row + 1,
        line: 0,
        column: raw.headers[column].clone(),
        what: format!("`{}` is not a time like the others", raw.columns[column].text(row)).into(),
        advice: MAP_ANOTHER,
        mend: None,
        path: path.to_path_buf(),
    })?;
    raw.columns[column] = Cells::Numbers(values);
    Ok(days)
}

fn first_text(cells: &Cells) -> String {
    match cells {
        Cells::Text(texts) => texts.get(0).unwrap_or_default().to_owned(),
        Cells::Numbers(_) => String::new(),
    }
}

/// Times of a column, s since the first row; the first row whose text is none, from 0.
fn seconds(raw: &Raw, column: usize, wanted: Use) -> Result<(Vec<f64>, Days), usize> {
    let (origin_ns, form) = match wanted {
        Use::Stamp { origin_ns, form } => (origin_ns, form),
        _ => (0, Form::default()),
    };
    let (mut values, mut days) = (Vec::with_capacity(raw.rows()), Days::default());
    for row in 0..raw.rows() {
        let time = raw.columns[column].text(row);
        let text = form.date.map_or_else(|| time.clone(), |date| format!("{} {time}", raw.columns[date].text(row)));
        let ns = form.read(&text).ok_or(row)?;
        days.look_at(form, &text, calendar::is_another_day(ns, origin_ns));
        values.push(1e-9 * ns.saturating_sub(origin_ns) as f64);
    }
    Ok((values, days))
}
