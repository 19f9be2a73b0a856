//! Encoding, delimiter, header and first row of a file, told by its first bytes.

use super::cells::{Cells, Notation, number, record_end};
use super::decimal::Decimal;
use super::dialect::Dialect;
use super::encoding::{self, Encoding};
use super::layout::Layout;
use super::{above, calendar, labview, layout, long_table, serial_log, twincat, unit_cells};
use crate::errors::LogError;
use crate::raw::place_of;
use crate::{format, stated_rate};
use haptics::recording::Meta;
use std::borrow::Cow;
use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::Path;

/// Number of bytes that are looked at to tell a table from something else.
const SNIFF_BYTES: usize = 1 << 16;
/// Looks at the beginning and the end of a file; an error when it cannot be a table. `meta`: the sidecar, if it is known.
pub fn sniff(path: &Path, meta: Option<&Meta>) -> Result<Dialect, LogError> {
    let io = |error: std::io::Error| LogError::Io { reason: error.to_string(), path: path.to_path_buf() };
    let mut start = Vec::with_capacity(SNIFF_BYTES);
    File::open(path).map_err(io)?.take(SNIFF_BYTES as u64).read_to_end(&mut start).map_err(io)?;
    if let Some(what) = format::foreign(&start) {
        return Err(LogError::NotATable { why: what.to_owned(), path: path.to_path_buf() });
    }
    let (encoding, is_short) = (encoding::of(&start), start.len() < SNIFF_BYTES);
    let end = match encoding {
        Encoding::Utf16(_) => None,
        _ => end_before_zeros(path).map_err(io)?,
    };
    let behind = end.map_or(usize::MAX, |end| end as usize);
    start.truncate(behind);
    let whole = |start: &[u8]| {
        let mut all = if is_short { start.to_vec() } else { std::fs::read(path).map_err(io)? };
        all.truncate(behind);
        Ok(all)
    };
    let mut notes = Vec::new();
    notes.extend(end.map(|_| "the zeros behind the text, which a logger reserves, are not read".to_owned()));
    let mut text = None;
    if encoding != Encoding::Utf8 && !is_binary(&start, encoding) {
        text = Some(encoding::decoded(whole(&start)?, encoding));
        notes.extend((encoding == Encoding::Latin1).then(|| "the text is not UTF-8: it is read as Latin-1".to_owned()));
    }
    let beginning = |text: &[u8]| text[..text.len().min(SNIFF_BYTES)].to_vec();
    start = text.as_deref().map_or(start, beginning);
    let all = || text.clone().map_or_else(|| whole(&start), Ok);
    let made = laid_out_anew(&start, is_short, meta, path, &all)?;
    let (clocks, is_long, units) = (made.clocks, made.is_long, made.units);
    notes.extend(made.note.map(str::to_owned));
    text = made.text.or(text);
    start = text.as_deref().map_or(start, beginning);
    let mut found = dialect(&start, meta, path)?;
    found.name_columns();
    let above = String::from_utf8_lossy(&start[..(found.start as usize).min(start.len())]);
    found.rate = above.lines().find_map(|line| Some((line.to_owned(), stated_rate::of_line(line)?)));
    found.notes.splice(0..0, notes);
    if found.units.is_empty() {
        found.units = units;
    }
    if end.is_some() && text.is_none() {
        found.end = end;
    } else {
        found.leave_summary_out(path, text.as_deref()).map_err(io)?;
    }
    (found.text, found.clocks, found.is_long) = (text, clocks, is_long);
    Ok(found)
}

/// A text that was laid out anew as a table.
#[derive(Default)]
struct LaidOutAnew {
    /// None if the text is a table already.
    text: Option<Vec<u8>>,
    clocks: Vec<(usize, usize)>,
    is_long: bool,
    units: Vec<String>,
    note: Option<&'static str>,
}

/// Measurements of LabVIEW, exports of `TwinCAT`, logs of serial monitors, columns of even width, long tables, and cells with units as a table.
/// `all`: the whole text.
fn laid_out_anew(
    start: &[u8],
    is_short: bool,
    meta: Option<&Meta>,
    path: &Path,
    all: &dyn Fn() -> Result<Vec<u8>, LogError>,
) -> Result<LaidOutAnew, LogError> {
    let none = LaidOutAnew::default();
    Ok(if labview::is_measurement(start) {
        let made = labview::table(&all()?, path)?;
        LaidOutAnew { text: Some(made.text), clocks: made.clocks, ..none }
    } else if twincat::is_scope(start) {
        let made = twincat::table(&all()?);
        made.map_or(none, |made| LaidOutAnew { text: Some(made.text), clocks: made.clocks, ..LaidOutAnew::default() })
    } else if let Some(kind) = serial_log::kind(start, !is_short) {
        LaidOutAnew { text: Some(serial_log::tabbed(&all()?, kind)), ..none }
    } else if let Some(width) = encoding::blank_width(start, !is_short) {
        LaidOutAnew { text: Some(encoding::tabbed(&all()?, width)), ..none }
    } else if let Some(columns) = long_table::columns(start, meta) {
        let all = all()?;
        let made = long_table::wide(&all, &columns);
        let is_long = made.is_some();
        LaidOutAnew { text: Some(made.unwrap_or(all)), is_long, note: is_long.then_some(long_table::NOTE), ..none }
    } else if let Some(found) = unit_cells::of(start, meta) {
        LaidOutAnew { text: Some(found.taken_out(&all()?)), units: found.units, ..none }
    } else {
        none
    })
}

/// End of a text before zeros that fill the rest of its file, bytes; none without them.
fn end_before_zeros(path: &Path) -> std::io::Result<Option<u64>> {
    let mut file = File::open(path)?;
    let length = file.seek(SeekFrom::End(0))?;
    let mut block = vec![0; SNIFF_BYTES.min(length as usize)];
    let mut end = length;
    while end > 0 {
        // All of the file is looked at only if all of it is zeros.
        let size = if end == length { 1 } else { block.len().min(end as usize) };
        file.seek(SeekFrom::Start(end - size as u64))?;
        file.read_exact(&mut block[..size])?;
        let last = block[..size].iter().rposition(|b| *b != 0);
        end -= (size - last.map_or(0, |last| last + 1)) as u64;
        if last.is_some() {
            break;
        }
    }
    Ok((1..length).contains(&end).then_some(end))
}

/// True for bytes that no text holds.
fn is_binary(start: &[u8], encoding: Encoding) -> bool {
    let is_control = |b: &u8| *b < 0x20 && !matches!(b, b'\t' | b'\n' | b'\r' | 0x0c);
    !matches!(encoding, Encoding::Utf16(_)) && start.iter().any(is_control)
}

/// Notation and layout by the beginning of a text. `meta`: the sidecar, if it is known.
pub(super) fn dialect(start: &[u8], meta: Option<&Meta>, path: &Path) -> Result<Dialect, LogError> {
    let not_a_table = |why: &str| LogError::NotATable { why: why.to_owned(), path: path.to_path_buf() };
    if let Some(what) = format::foreign(start) {
        return Err(not_a_table(what));
    }
    if start.contains(&0) {
        return Err(not_a_table("binary data"));
    }
    let text = start.strip_prefix("\u{feff}".as_bytes()).unwrap_or(start);
    if text.iter().all(u8::is_ascii_whitespace) {
        return Err(LogError::Empty { path: path.to_path_buf() });
    }
    let (mut at, mut line) = (0, 1);
    let mut stated = None;
    let header_line = loop {
        if at >= text.len() {
            return Err(LogError::HeaderOnly { path: path.to_path_buf() });
        }
        let end = memchr::memchr(b'\n', &text[at..]).map_or(text.len(), |n| at + n);
        let one = &text[at..end];
        stated = stated.or_else(|| stated_delimiter(one));
        if !one.starts_with(b"#") && !one.trim_ascii().is_empty() && stated_delimiter(one).is_none() {
            break one;
        }
        (at, line) = (end + 1, line + 1);
    };
    if let Some(found) = laid_out(&text[at..], &text[..at], (stated, delimiter_of(header_line)), meta) {
        let before = (start.len() - text.len() + at) as u64;
        return Ok(Dialect { start: before + found.start, line: line + found.line, ..found });
    }
    let notation =
        Notation { delimiter: stated.unwrap_or_else(|| delimiter_of(header_line)), decimal: Decimal::Either };
    // A quoted name may hold line ends.
    let end = record_end(text, at, notation.delimiter).unwrap_or(text.len());
    let header = &text[at..end];
    if header.len() >= SNIFF_BYTES - 3 {
        return Err(not_a_table("the first line has more than 64 KiB, too long for a header of column names"));
    }
    let headers = names(header, notation.delimiter);
    if headers.iter().all(|h| number(h.as_bytes(), notation).is_some()) {
        return Err(LogError::NoHeader { path: path.to_path_buf() });
    }
    if header.trim_ascii_end().contains(&b'\r') && !header.contains(&b'"') {
        return Err(not_a_table("its lines end with carriage returns only; save it with line feeds"));
    }
    let line = line + 1 + memchr::memchr_iter(b'\n', header).count() as u64;
    let decimal = if notation.delimiter == b',' { Decimal::Point } else { Decimal::Either };
    let start = (start.len() - text.len() + end + 1) as u64;
    Ok(Dialect { notation: Notation { decimal, ..notation }, headers, start, line, ..Dialect::default() })
}

/// The delimiter in a first line `sep=;`.
fn stated_delimiter(line: &[u8]) -> Option<u8> {
    let line = line.trim_ascii_end();
    let sign = line.strip_prefix(b"sep=").or_else(|| line.strip_prefix(b"SEP="))?;
    if let [one] = sign { Some(*one) } else { line.len().eq(&4).then_some(b'\t') }
}

/// Header, units and first row as the rows of numbers show them; places count from the start of `text`. `comments`: those
/// above. The delimiter is that which leaves numbers in the largest share of the columns.
fn laid_out(
    text: &[u8],
    comments: &[u8],
    (stated, of_first_line): (Option<u8>, u8),
    meta: Option<&Meta>,
) -> Option<Dialect> {
    let candidates = match stated {
        Some(delimiter) => vec![delimiter],
        None => vec![of_first_line, b'\t', b';', b',', b'|'],
    };
    let mut best: Option<Dialect> = None;
    for delimiter in candidates {
        let share = best.as_ref().map_or(0.0, |found| found.body.share());
        if share < 1.0
            && let Some(found) = divided(text, comments, (delimiter, stated.is_some()), meta)
            && found.body.share() > share
        {
            best = Some(found);
        }
    }
    best
}

/// Layout of a text whose cells this delimiter divides. A table of one column may have one that is stated.
fn divided(text: &[u8], comments: &[u8], (delimiter, is_stated): (u8, bool), meta: Option<&Meta>) -> Option<Dialect> {
    let mut records = layout::records(text, delimiter, layout::LOOKED_AT);
    // The last record may have been cut off.
    if text.len() + 3 >= SNIFF_BYTES && records.last().is_some_and(|r| r.end == text.len()) {
        records.pop();
    }
    let mapped = Mapped::of(meta);
    let (mut notation, mut grouped) = notation_of(&records, comments, delimiter);
    let mut found = mapped.layout(&records, comments, notation);
    // Another table may stand above the one that the sidecar maps.
    let has_names = |found: &Layout| mapped.are_in(&found.names);
    if !found.as_ref().is_some_and(has_names)
        && let Some(header) = records.iter().position(|record| mapped.are_in(&record.cells))
    {
        records.drain(..header);
        (notation, grouped) = notation_of(&records, comments, delimiter);
        found = mapped.layout(&records, comments, notation);
    }
    let found = found.filter(|found| found.width > 1 || is_stated)?;
    let first = &records[found.first];
    let mut dialect = Dialect {
        notation,
        headers: found.names,
        units: found.units.map_or_else(Vec::new, |k| units_of(&records[k], first)),
        first: first.cells.clone(),
        start: first.start as u64,
        line: first.line,
        body: found.body,
        ..Dialect::default()
    };
    dialect.note_decimals(grouped);
    if dialect.units.is_empty()
        && let Some((units, comment)) = above::units(comments, &dialect.headers, delimiter)
    {
        dialect.units = units;
        dialect.notes.push(format!("the units are those of the comment `{comment}`"));
    }
    let lines = &records[..found.header.unwrap_or(0)];
    let texts = String::from_utf8_lossy(comments);
    let texts = texts.lines().map(Cow::from);
    let texts = texts.chain(lines.iter().map(|line| String::from_utf8_lossy(&text[line.start..line.end])));
    let texts: Vec<Cow<'_, str>> = texts.collect();
    let has_scale = meta.is_some_and(|meta| !meta.scale.is_empty());
    let above = texts.iter().map(AsRef::as_ref);
    let facts = above::facts(above, &dialect.headers, &mut dialect.units, (delimiter, has_scale));
    dialect.notes.extend(facts);
    dialect.notes.extend(lines.iter().find_map(|line| above::factors(&line.cells, found.width, notation)));
    take_upper_names(&mut dialect.headers, lines);
    let header = found.header.map_or(0, |k| records[k].line);
    let unread = header.saturating_sub(u64::from(found.units.is_some_and(|k| Some(k) < found.header)));
    if unread > 0 {
        dialect.notes.push(format!("{unread} line(s) above the header are not read"));
    }
    Some(dialect)
}

/// Names of the file's columns that the sidecar maps.
struct Mapped<'a>(Vec<&'a str>);

impl<'a> Mapped<'a> {
    fn of(meta: Option<&'a Meta>) -> Self {
        let sources = meta.into_iter().flat_map(|meta| meta.columns.values());
        Self(sources.map(String::as_str).filter(|source| !source.is_empty()).collect())
    }

    /// True if there are such names and all of them are among these.
    fn are_in(&self, names: &[String]) -> bool {
        !self.0.is_empty() && self.0.iter().all(|mapped| names.iter().any(|name| name == mapped))
    }

    /// Layout of records. Columns that are mapped by their places only need no names above them.
    fn layout(&self, records: &[layout::Record], comments: &[u8], notation: Notation) -> Option<Layout> {
        let is_by_place = !self.0.is_empty() && self.0.iter().all(|mapped| place_of(mapped).is_some());
        let unnamed = is_by_place.then(|| layout::without_names(records, notation)).flatten();
        let named = || layout::of(records, notation).or_else(|| layout::below_comment(records, comments, notation));
        unnamed.or_else(named)
    }
}

/// Marks between and within the numbers of the rows, and true if marks stand between thousands or both are decimal. Lines above
/// and below the rows say nothing about them: a date or a version has points of its own.
fn notation_of(records: &[layout::Record], comments: &[u8], delimiter: u8) -> (Notation, bool) {
    let later = &records[records.len() / 2..];
    let is_worded = 2 * later.iter().filter(|record| layout::begins_with_word(record)).count() > later.len();
    let marks = |rows: &[layout::Record]| {
        let rows = rows.iter().filter(|record| layout::begins_with_word(record) == is_worded);
        Decimal::of(rows.map(|record| record.cells.as_slice()))
    };
    let guess = Notation { delimiter, decimal: marks(later).0 };
    let found = layout::of(records, guess).or_else(|| layout::below_comment(records, comments, guess));
    let rows = &records[found.map_or(0, |found| found.first)..];
    let (decimal, grouped) = marks(rows);
    if delimiter != b',' || decimal != Decimal::Either {
        return (Notation { delimiter, decimal }, grouped);
    }
    // A comma in quotes stands for thousands, unless some cell shows decimals behind it.
    let notation = Notation { delimiter, decimal: Decimal::Point };
    let is_grouped = |cell: &String| cell.contains(',') && number(cell.as_bytes(), notation).is_some();
    (notation, rows.iter().any(|record| record.cells.iter().any(is_grouped)))
}

/// Gives a column without a name the names that stand above it, as in a table of several levels: `stage.position`.
fn take_upper_names(headers: &mut [String], above: &[layout::Record]) {
    let width = headers.len();
    for (column, name) in headers.iter_mut().enumerate().filter(|(_, name)| name.is_empty()) {
        let levels =
            above.iter().filter(|record| record.cells.len() == width).map(|record| record.cells[column].as_str());
        *name = levels.filter(|level| !level.is_empty()).collect::<Vec<_>>().join(".");
    }
}

/// Texts of units; a time of the calendar has none, whatever stands there.
fn units_of(units: &layout::Record, first: &layout::Record) -> Vec<String> {
    let cells = first.cells.iter().map(|cell| calendar::parse(cell).is_some());
    let of = |(unit, is_stamp): (&String, bool)| if is_stamp { String::new() } else { unit.clone() };
    units.cells.iter().zip(cells.chain(std::iter::repeat(false))).map(of).collect()
}

pub(super) fn names(header: &[u8], delimiter: u8) -> Vec<String> {
    let mut cells = Cells::default();
    cells.split(header, delimiter);
    (0..cells.len()).map(|i| String::from_utf8_lossy(cells.get(header, i)).into_owned()).collect()
}

/// The most frequent of tab, semicolon, comma and bar outside quotes.
pub(super) fn delimiter_of(header: &[u8]) -> u8 {
    let mut quoted = false;
    let mut counts = [(b'|', 0), (b'\t', 0), (b';', 0), (b',', 0)];
    for &byte in header {
        quoted ^= byte == b'"';
        if let Some(entry) = counts.iter_mut().find(|(d, _)| *d == byte && !quoted) {
            entry.1 += 1;
        }
    }
    counts.into_iter().max_by_key(|&(_, n)| n).map_or(b',', |(d, _)| d)
}
