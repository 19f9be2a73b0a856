//! Facts of columns in the schema of Arrow, which Parquet itself does not hold: durations, and units in a field's metadata.
//!
//! Writers keep that schema in the file's metadata, as a message of Arrow's format (a `FlatBuffer`) in base64. A message that
//! cannot be read states nothing.

use parquet::file::metadata::FileMetaData;

/// Key of the message.
const KEY: &str = "ARROW:schema";
/// Number of a duration among Arrow's types.
const DURATION: u8 = 18;

/// Facts of one column.
#[derive(Debug, Default, PartialEq)]
pub struct Field {
    pub name: String,
    /// Whole numbers of a duration in one second; none for other columns.
    pub per_second: Option<f64>,
    /// Text of the unit; empty if none is stated.
    pub unit: String,
}

/// Columns of the schema of Arrow that a file carries.
pub fn fields(about: &FileMetaData) -> Vec<Field> {
    let entries = about.key_value_metadata().map_or(&[][..], Vec::as_slice);
    let text = entries.iter().find(|entry| entry.key == KEY).and_then(|entry| entry.value.as_deref());
    text.and_then(of_base64).and_then(|bytes| of_message(&bytes)).unwrap_or_default()
}

fn of_base64(text: &str) -> Option<Vec<u8>> {
    const DIGITS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut count) = (0_u32, 0);
    for byte in text.bytes().filter(|byte| *byte != b'=') {
        let digit = DIGITS.iter().position(|digit| *digit == byte)?;
        (bits, count) = (bits << 6 | digit as u32, count + 6);
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count & 0xff) as u8);
        }
    }
    Some(bytes)
}

/// Fields of a message: version, kind, and schema; of a schema: order of bytes, and fields.
fn of_message(bytes: &[u8]) -> Option<Vec<Field>> {
    // Newer writers set a mark before the length.
    let start = if bytes.starts_with(&[0xff; 4]) { 8 } else { 4 };
    let tables = Tables(bytes.get(start..)?);
    let schema = tables.target(tables.entry(tables.target(0)?, 2)?)?;
    let fields = tables.items(tables.entry(schema, 1)?)?;
    Some(fields.map_while(|field| of_field(&tables, field)).collect())
}

/// Entries of a field: name, null, number of its type, type, dictionary, children, and metadata.
fn of_field(tables: &Tables<'_>, field: usize) -> Option<Field> {
    let name = tables.text(tables.entry(field, 0)?)?.to_owned();
    let kind = tables.entry(field, 2).and_then(|at| tables.0.get(at).copied());
    let per_second = || {
        let unit = tables.entry(tables.target(tables.entry(field, 3)?)?, 0);
        // An entry that is left out has the first value that the format names: milliseconds.
        unit.map_or(Some(1), |at| tables.u16(at)).and_then(|unit| [1.0, 1e3, 1e6, 1e9].get(unit).copied())
    };
    let metadata = || tables.items(tables.entry(field, 6)?);
    let unit = metadata().into_iter().flatten().map_while(|pair| {
        let [key, value] = [0, 1].map(|id| tables.entry(pair, id).and_then(|at| tables.text(at)));
        key.zip(value)
    });
    let unit = unit.into_iter().find(|(key, _)| matches!(*key, "unit" | "units"));
    let per_second = (kind == Some(DURATION)).then(per_second).flatten();
    Some(Field { name, per_second, unit: unit.map_or(String::new(), |(_, unit)| unit.to_owned()) })
}

/// Tables of a `FlatBuffer`. Places beyond its end have nothing.
struct Tables<'a>(&'a [u8]);

impl<'a> Tables<'a> {
    fn u16(&self, at: usize) -> Option<usize> {
        Some(usize::from(u16::from_le_bytes(*self.0.get(at..)?.first_chunk()?)))
    }

    fn u32(&self, at: usize) -> Option<usize> {
        usize::try_from(u32::from_le_bytes(*self.0.get(at..)?.first_chunk()?)).ok()
    }

    /// Place that the offset at `at` leads to.
    fn target(&self, at: usize) -> Option<usize> {
        at.checked_add(self.u32(at)?)
    }

    /// Place of an entry of a table; none if it is left out.
    fn entry(&self, table: usize, id: usize) -> Option<usize> {
        let back = i32::from_le_bytes(*self.0.get(table..)?.first_chunk()?);
        let entries = table.checked_add_signed(isize::try_from(back).ok()?.checked_neg()?)?;
        let at = 4 + 2 * id;
        let offset = if at < self.u16(entries)? { self.u16(entries.checked_add(at)?)? } else { 0 };
        (offset > 0).then(|| table + offset)
    }

    /// Places of the tables of the list that the offset at `at` leads to.
    fn items(&self, at: usize) -> Option<impl Iterator<Item = usize>> {
        let list = self.target(at)?;
        Some((0..self.u32(list)?).map_while(move |item| self.target(list.checked_add(4 + 4 * item)?)))
    }

    fn text(&self, at: usize) -> Option<&'a str> {
        let text = self.target(at)?;
        let length = self.u32(text)?;
        std::str::from_utf8(self.0.get(text..)?.get(4..)?.get(..length)?).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Schemas that pyarrow 21 writes: `stamp` as a duration in nanoseconds beside two doubles, and units of `t`, `pos`, `load`.
    const DURATIONS: &str = "/////9AAAAAQAAAAAAAKAAwABgAFAAgACgAAAAABBAAMAAAACAAIAAAABAAIAAAABAAAAAMAAABsAAAAMAAAAAQAAACw////AAABAxAAAAAUAAAABAAAAAAAAAADAAAAZl9OAJ7///8AAAIA2P///wAAAQMQAAAAFAAAAAQAAAAAAAAAAwAAAHFfbQDG////AAACABAAFAAIAAYABwAMAAAAEAAQAAAAAAABEhAAAAAcAAAABAAAAAAAAAAFAAAAc3RhbXAABgAIAAYABgAAAAAAAwAAAAAAAA==";
    const UNITS: &str = "/////2ABAAAQAAAAAAAKAAwABgAFAAgACgAAAAABBAAMAAAACAAIAAAABAAIAAAABAAAAAMAAADMAAAAYAAAAAQAAABS////AAABAxQAAABEAAAACAAAABQAAAAAAAAABAAAAGxvYWQAAAAAAQAAAAQAAABE////EAAAAAQAAAACAAAAa04AAAUAAAB1bml0cwAAAD7///8AAAIAqv///wAAAQMUAAAARAAAAAgAAAAQAAAAAAAAAAMAAABwb3MAAQAAAAQAAACY////EAAAAAQAAAACAAAAbW0AAAQAAAB1bml0AAAGAAYABAAGAAAAAgASABgACAAGAAcADAAAABAAFAASAAAAAAABAxQAAABMAAAACAAAABAAAAAAAAAAAQAAAHQAAAABAAAADAAAAAgADAAEAAgACAAAABAAAAAEAAAAAgAAAG1zAAAEAAAAdW5pdAAABgAIAAYABgAAAAAAAgAAAAAA";

    fn read(text: &str) -> Vec<(String, Option<f64>, String)> {
        let fields = of_message(&of_base64(text).expect("base64")).expect("a message");
        fields.into_iter().map(|field| (field.name, field.per_second, field.unit)).collect()
    }

    #[test]
    fn durations_and_units_are_read() {
        let of = |name: &str, per_second, unit: &str| (name.to_owned(), per_second, unit.to_owned());
        assert_eq!(read(DURATIONS), [of("stamp", Some(1e9), ""), of("q_m", None, ""), of("f_N", None, "")]);
        assert_eq!(read(UNITS), [of("t", None, "ms"), of("pos", None, "mm"), of("load", None, "kN")]);
    }

    #[test]
    fn a_damaged_message_states_nothing() {
        let whole = of_base64(UNITS).expect("base64");
        for at in 0..whole.len() {
            for byte in [0, 0x7f, 0xff] {
                let mut other = whole.clone();
                other[at] = byte;
                // A read beyond the end, or without an end, would show here.
                assert!(of_message(&other).is_none_or(|fields| fields.len() <= whole.len()));
            }
            let _ = of_message(&whole[..at]);
        }
    }
}
