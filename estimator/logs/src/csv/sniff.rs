//! Encoding, delimiter, header and first row of a file, told by its first bytes.

use super::cells::{Cells, Decimal, Notation, number, record_end};
use super::dialect::Dialect;
use super::encoding::{self, Encoding};
use super::{labview, layout};
use crate::errors::LogError;
use crate::format;
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

/// Number of bytes that are looked at to tell a table from something else.
const SNIFF_BYTES: usize = 1 << 16;
/// Looks at the beginning and the end of a file; an error when it cannot be a table.
pub fn sniff(path: &Path) -> Result<Dialect, LogError> {
    let io = |error: std::io::Error| LogError::Io { reason: error.to_string(), path: path.to_path_buf() };
    let mut start = Vec::with_capacity(SNIFF_BYTES);
    File::open(path).map_err(io)?.take(SNIFF_BYTES as u64).read_to_end(&mut start).map_err(io)?;
    if let Some(what) = format::foreign(&start) {
        return Err(LogError::NotATable { why: what.to_owned(), path: path.to_path_buf() });
    }
    let (encoding, is_short) = (encoding::of(&start), start.len() < SNIFF_BYTES);
    let whole = |start: &[u8]| if is_short { Ok(start.to_vec()) } else { std::fs::read(path).map_err(io) };
    let mut notes = Vec::new();
    let (mut text, mut clocks) = (None, Vec::new());
    if encoding != Encoding::Utf8 && !is_binary(&start, encoding) {
        text = Some(encoding::decoded(whole(&start)?, encoding));
        notes.extend((encoding == Encoding::Latin1).then(|| "the text is not UTF-8: it is read as Latin-1".to_owned()));
    }
    let beginning = |text: &[u8]| text[..text.len().min(SNIFF_BYTES)].to_vec();
    start = text.as_deref().map_or(start, beginning);
    if labview::is_measurement(&start) {
        let all = text.map_or_else(|| whole(&start), Ok)?;
        let made = labview::table(&all, path)?;
        (text, clocks) = (Some(made.text), made.clocks);
    } else if is_blank_separated(&start) {
        let all = text.map_or_else(|| whole(&start), Ok)?;
        text = Some(encoding::tabbed(&all));
    }
    start = text.as_deref().map_or(start, beginning);
    let mut found = dialect(&start, path)?;
    found.notes.splice(0..0, notes);
    found.leave_summary_out(path, text.as_deref()).map_err(io)?;
    (found.text, found.clocks) = (text, clocks);
    Ok(found)
}

/// True for bytes that no text holds.
fn is_binary(start: &[u8], encoding: Encoding) -> bool {
    let is_control = |b: &u8| *b < 0x20 && !matches!(b, b'\t' | b'\n' | b'\r' | 0x0c);
    !matches!(encoding, Encoding::Utf16(_)) && start.iter().any(is_control)
}

/// True for a text whose cells only blanks divide.
fn is_blank_separated(start: &[u8]) -> bool {
    let text = start.strip_prefix("\u{feff}".as_bytes()).unwrap_or(start);
    let lines = text.split(|b| *b == b'\n').filter(|line| !line.trim_ascii().is_empty() && !line.starts_with(b"#"));
    let mut lines = lines.take(20).peekable();
    let has_blanks = |line: &[u8]| {
        line.trim_ascii().contains(&b' ') && !line.iter().any(|b| matches!(b, b'\t' | b';' | b',' | b'"'))
    };
    let widths = |line: &[u8]| line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).count();
    let Some(width) = lines.peek().map(|line| widths(line)) else { return false };
    let mut last = text.len() == SNIFF_BYTES;
    lines.all(|line| {
        last = false;
        has_blanks(line) && widths(line) == width
    }) && !last
}

pub(super) fn dialect(start: &[u8], path: &Path) -> Result<Dialect, LogError> {
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
    if let Some(found) = laid_out(&text[at..], stated, delimiter_of(header_line)) {
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

/// Header, units and first row as the rows of numbers show them; places count from the start of `text`.
fn laid_out(text: &[u8], stated: Option<u8>, of_first_line: u8) -> Option<Dialect> {
    let candidates = match stated {
        Some(delimiter) => vec![delimiter],
        None => vec![of_first_line, b'\t', b';', b','],
    };
    candidates.into_iter().find_map(|delimiter| {
        let mut records = layout::records(text, delimiter, layout::LOOKED_AT);
        // The last record may have been cut off.
        if text.len() + 3 >= SNIFF_BYTES && records.last().is_some_and(|r| r.end == text.len()) {
            records.pop();
        }
        let cells = records.iter().flat_map(|r| r.cells.iter().map(String::as_str));
        let (decimal, grouped) = Decimal::of(cells, delimiter);
        let notation = Notation { delimiter, decimal };
        let found = layout::of(&records, notation).filter(|found| found.width > 1 || stated.is_some())?;
        let [header, first] = [found.header, found.first].map(|k| &records[k]);
        let mut headers = header.cells.clone();
        headers.resize(found.width, String::new());
        let units = found.units.map_or_else(Vec::new, |k| records[k].cells.clone());
        let first_cells = first.cells.clone();
        let mut dialect = Dialect {
            notation,
            headers,
            units,
            first: first_cells,
            start: first.start as u64,
            line: first.line,
            body: found.body,
            ..Dialect::default()
        };
        dialect.note_decimals(grouped);
        let unread = records[found.header].line - usize::from(found.units.is_some_and(|k| k < found.header)) as u64;
        if found.header > 0 && unread > 0 {
            let lines = unread;
            dialect.notes.push(format!("{lines} line(s) above the header are not read"));
        }
        Some(dialect)
    })
}

fn names(header: &[u8], delimiter: u8) -> Vec<String> {
    let mut cells = Cells::default();
    cells.split(header, delimiter);
    (0..cells.len()).map(|i| String::from_utf8_lossy(cells.get(header, i)).into_owned()).collect()
}

/// The most frequent of tab, semicolon and comma outside quotes.
fn delimiter_of(header: &[u8]) -> u8 {
    let mut quoted = false;
    let mut counts = [(b'\t', 0), (b';', 0), (b',', 0)];
    for &byte in header {
        quoted ^= byte == b'"';
        if let Some(entry) = counts.iter_mut().find(|(d, _)| *d == byte && !quoted) {
            entry.1 += 1;
        }
    }
    counts.into_iter().max_by_key(|&(_, n)| n).map_or(b',', |(d, _)| d)
}
