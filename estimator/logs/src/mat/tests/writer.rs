//! Writer of MATLAB files for tests, after the description of the format; it shares nothing with the reader.

use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::Write as _;

/// Value that can be written.
#[derive(Clone, Debug)]
pub enum V {
    Doubles(Vec<u32>, Vec<f64>),
    Singles(Vec<u32>, Vec<f32>),
    Shorts(Vec<u32>, Vec<i16>),
    Longs(Vec<u32>, Vec<i64>),
    /// Doubles that are stored as bytes, as MATLAB stores whole numbers.
    Bytes(Vec<u32>, Vec<u8>),
    Logical(Vec<u32>, Vec<u8>),
    Chars(Vec<&'static str>),
    Cells(Vec<u32>, Vec<V>),
    Structs(Vec<u32>, Vec<&'static str>, Vec<V>),
    Complex(Vec<f64>),
    Sparse,
    Object(&'static str),
}

/// Column of numbers.
pub fn column(values: &[f64]) -> V {
    V::Doubles(vec![values.len() as u32, 1], values.to_vec())
}

/// Structure with one element.
pub fn one(fields: Vec<(&'static str, V)>) -> V {
    let (names, values) = fields.into_iter().unzip();
    V::Structs(vec![1, 1], names, values)
}

/// Column of texts in cells.
pub fn texts(texts: &[&'static str]) -> V {
    V::Cells(vec![texts.len() as u32, 1], texts.iter().map(|text| V::Chars(vec![text])).collect())
}

/// Form of a file of level 5.
#[derive(Clone, Copy, Debug)]
pub struct Form {
    pub big: bool,
    pub packed: bool,
}

impl Form {
    pub const ALL: [Self; 4] = [
        Self { big: false, packed: false },
        Self { big: false, packed: true },
        Self { big: true, packed: false },
        Self { big: true, packed: true },
    ];

    fn ordered<const N: usize>(self, mut little: [u8; N]) -> [u8; N] {
        if self.big {
            little.reverse();
        }
        little
    }

    fn word(self, value: u32) -> [u8; 4] {
        self.ordered(value.to_le_bytes())
    }

    /// Whole file.
    pub fn file(self, variables: &[(&str, V)]) -> Vec<u8> {
        let elements: Vec<Vec<u8>> = variables.iter().map(|(name, value)| self.value(name, value)).collect();
        self.of_elements(&elements)
    }

    /// Whole file of elements.
    pub fn of_elements(self, elements: &[Vec<u8>]) -> Vec<u8> {
        let mut file = b"MATLAB 5.0 MAT-file, written by a test".to_vec();
        file.resize(124, b' ');
        file.extend(self.ordered([0, 1]));
        file.extend(if self.big { b"MI" } else { b"IM" });
        for element in elements {
            file.extend(if self.packed { self.packed(element) } else { element.clone() });
        }
        file
    }

    pub fn packed(self, element: &[u8]) -> Vec<u8> {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(6));
        encoder.write_all(element).expect("memory");
        let bytes = encoder.finish().expect("memory");
        [&self.word(15)[..], &self.word(bytes.len() as u32), &bytes].concat()
    }

    /// Element with its tag, the short way where it fits.
    pub fn element(self, kind: u32, data: &[u8]) -> Vec<u8> {
        if (1..=4).contains(&data.len()) {
            let mut small = [self.word(kind | (data.len() as u32) << 16).to_vec(), data.to_vec()].concat();
            small.resize(8, 0);
            return small;
        }
        let mut long = [&self.word(kind)[..], &self.word(data.len() as u32), data].concat();
        long.resize(long.len().next_multiple_of(8), 0);
        long
    }

    /// Array with parts behind its name.
    pub fn array(self, class: u32, dims: &[u32], name: &str, parts: &[Vec<u8>]) -> Vec<u8> {
        let dims: Vec<u8> = dims.iter().flat_map(|d| self.word(*d)).collect();
        let flags = [self.word(class), self.word(0)].concat();
        let head = [self.element(6, &flags), self.element(5, &dims), self.element(1, name.as_bytes())].concat();
        let body = [head, parts.concat()].concat();
        [&self.word(14)[..], &self.word(body.len() as u32), &body].concat()
    }

    pub fn value(self, name: &str, value: &V) -> Vec<u8> {
        let doubles = |values: &[f64]| values.iter().flat_map(|v| self.ordered(v.to_le_bytes())).collect::<Vec<u8>>();
        match value {
            V::Doubles(dims, values) => self.array(6, dims, name, &[self.element(9, &doubles(values))]),
            V::Singles(dims, values) => {
                let data: Vec<u8> = values.iter().flat_map(|v| self.ordered(v.to_le_bytes())).collect();
                self.array(7, dims, name, &[self.element(7, &data)])
            }
            V::Shorts(dims, values) => {
                let data: Vec<u8> = values.iter().flat_map(|v| self.ordered(v.to_le_bytes())).collect();
                self.array(10, dims, name, &[self.element(3, &data)])
            }
            V::Longs(dims, values) => {
                let data: Vec<u8> = values.iter().flat_map(|v| self.ordered(v.to_le_bytes())).collect();
                self.array(14, dims, name, &[self.element(12, &data)])
            }
            V::Bytes(dims, values) => self.array(6, dims, name, &[self.element(2, values)]),
            V::Logical(dims, values) => self.array(9 | 0x200, dims, name, &[self.element(2, values)]),
            V::Chars(rows) => {
                let columns = rows.iter().map(|row| row.encode_utf16().count()).max().unwrap_or(0);
                let padded = |row: &&str| row.encode_utf16().chain(std::iter::repeat(32)).take(columns).collect();
                let rows: Vec<Vec<u16>> = rows.iter().map(padded).collect();
                let units = (0..columns).flat_map(|c| rows.iter().map(move |row| row[c]));
                let data: Vec<u8> = units.flat_map(|unit| self.ordered(unit.to_le_bytes())).collect();
                self.array(4, &[rows.len() as u32, columns as u32], name, &[self.element(4, &data)])
            }
            V::Cells(dims, items) => {
                self.array(1, dims, name, &items.iter().map(|item| self.value("", item)).collect::<Vec<_>>())
            }
            V::Structs(dims, names, values) => {
                let all: Vec<u8> = names.iter().flat_map(|n| n.bytes().chain(std::iter::repeat(0)).take(32)).collect();
                let mut parts = vec![self.element(5, &self.word(32)), self.element(1, &all)];
                parts.extend(values.iter().map(|value| self.value("", value)));
                self.array(2, dims, name, &parts)
            }
            V::Complex(values) => {
                let part = self.element(9, &doubles(values));
                self.array(6 | 0x800, &[values.len() as u32, 1], name, &[part.clone(), part])
            }
            V::Sparse => {
                let places = self.element(5, &self.word(0));
                self.array(5, &[3, 3], name, &[places.clone(), places, self.element(9, &doubles(&[1.0]))])
            }
            V::Object(class) => {
                let flags = self.element(6, &[self.word(17), self.word(0)].concat());
                let texts = [name, "MCOS", class].map(|text| self.element(1, text.as_bytes())).concat();
                let content = self.value("", &V::Bytes(vec![6, 1], vec![1, 2, 3, 4, 5, 6]));
                let body = [flags, texts, content].concat();
                [&self.word(14)[..], &self.word(body.len() as u32), &body].concat()
            }
        }
    }
}

/// Variable of a file of level 4: doubles, or text where `content` is 1.
pub fn level4(big: bool, content: u32, name: &str, rows: u32, columns: u32, values: &[f64]) -> Vec<u8> {
    let ordered = |mut bytes: Vec<u8>| {
        if big {
            bytes.reverse();
        }
        bytes
    };
    let code = if big { 1000 + content } else { content };
    let header = [code, rows, columns, 0, name.len() as u32 + 1];
    let mut bytes: Vec<u8> = header.iter().flat_map(|word| ordered(word.to_le_bytes().to_vec())).collect();
    bytes.extend(name.bytes().chain([0]));
    bytes.extend(values.iter().flat_map(|v| ordered(v.to_le_bytes().to_vec())));
    bytes
}
