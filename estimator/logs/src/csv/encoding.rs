//! Text that is not UTF-8, and blanks instead of a delimiter.

/// Encoding of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    Utf8,
    /// With the low byte first, or the high one.
    Utf16(bool),
    Latin1,
}

/// Encoding by the first bytes of a file. A character that they cut off is none of another encoding.
pub fn of(start: &[u8]) -> Encoding {
    match start {
        [0xff, 0xfe, ..] => Encoding::Utf16(true),
        [0xfe, 0xff, ..] => Encoding::Utf16(false),
        _ if std::str::from_utf8(start).is_err_and(|error| error.error_len().is_some()) => Encoding::Latin1,
        _ => Encoding::Utf8,
    }
}

/// The text as UTF-8.
pub fn decoded(bytes: Vec<u8>, encoding: Encoding) -> Vec<u8> {
    match encoding {
        Encoding::Utf8 => bytes,
        Encoding::Latin1 => bytes.into_iter().map(char::from).collect::<String>().into_bytes(),
        Encoding::Utf16(low_first) => {
            let unit = |pair: &[u8; 2]| if low_first { u16::from_le_bytes(*pair) } else { u16::from_be_bytes(*pair) };
            let units = bytes.as_chunks::<2>().0.iter().map(unit);
            char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect::<String>().into_bytes()
        }
    }
}

/// The text with one tab for every run of blanks between cells, and none around a line.
pub fn tabbed(text: &[u8]) -> Vec<u8> {
    let mut out = Vec::with_capacity(text.len());
    for line in text.split_inclusive(|b| *b == b'\n') {
        let is_comment = line.starts_with(b"#");
        let mut words = line.split(|b| matches!(b, b' ' | b'\t' | b'\r' | b'\n')).filter(|word| !word.is_empty());
        if is_comment {
            out.extend_from_slice(line.trim_ascii_end());
        } else {
            out.extend_from_slice(words.next().unwrap_or_default());
            words.for_each(|word| {
                out.push(b'\t');
                out.extend_from_slice(word);
            });
        }
        if line.ends_with(b"\n") {
            out.push(b'\n');
        }
    }
    out
}
