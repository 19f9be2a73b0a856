//! A text for every sample, each distinct one kept once.

use std::fmt;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::ops::{Index, Range};

/// Number of distinct texts from which it is checked whether texts repeat at all.
const MANY: usize = 1 << 15;

/// A column of text: labels, names of trials or frames. Rows repeat each other, so a row takes four bytes and a text is kept once. Texts
/// that hardly ever repeat are kept one after the other: a row then takes eight bytes and its text.
#[derive(Clone, Default)]
pub struct Labels {
    /// Number of the text of every row.
    codes: Vec<u32>,
    /// All texts, one after the other.
    texts: String,
    /// End of each text in `texts`, bytes.
    ends: Vec<u32>,
    /// Places by hash: the number of a text plus one, or 0. A power of two of them, or none.
    places: Vec<u32>,
    /// True once looking texts up was found not to be worth its memory.
    ever_new: bool,
}

impl Labels {
    /// Appends one row. Texts beyond four gigabytes in all are kept as empty ones: no file that is read holds so many.
    pub fn push(&mut self, text: &str) {
        let code = match self.codes.last() {
            // Rows repeat each other: the last text is tried first.
            Some(&last) if self.text(last) == text => last,
            _ => self.find(text),
        };
        self.codes.push(code);
    }

    /// Appends the rows `range` of another column.
    pub fn extend_from(&mut self, other: &Self, range: Range<usize>) {
        range.for_each(|row| self.push(&other[row]));
    }

    /// Rows.
    pub fn len(&self) -> usize {
        self.codes.len()
    }

    /// True without rows.
    pub fn is_empty(&self) -> bool {
        self.codes.is_empty()
    }

    /// The text of a row, if there is such a row.
    pub fn get(&self, row: usize) -> Option<&str> {
        self.codes.get(row).map(|&code| self.text(code))
    }

    /// The texts of all rows.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &str> + Clone {
        self.codes.iter().map(|&code| self.text(code))
    }

    /// Rows with the same text one after the other, and the text.
    pub fn spans(&self) -> impl Iterator<Item = (Range<usize>, &str)> {
        let mut first = 0;
        self.codes.chunk_by(|&a, &b| a == b || self.text(a) == self.text(b)).map(move |run| {
            let range = first..first + run.len();
            first = range.end;
            (range, self.text(run[0]))
        })
    }

    /// The rows `range`.
    #[must_use]
    pub fn slice(&self, range: Range<usize>) -> Self {
        self.gathered(range)
    }

    /// The rows `rows`, in that order.
    #[must_use]
    pub fn gathered(&self, rows: impl IntoIterator<Item = usize>) -> Self {
        rows.into_iter().map(|row| &self[row]).collect()
    }

    /// The text of every row, when it is the same in all.
    pub fn constant(&self) -> Option<&str> {
        let mut spans = self.spans();
        let (_, text) = spans.next()?;
        spans.next().is_none().then_some(text)
    }

    /// Bytes held, about.
    pub fn bytes(&self) -> usize {
        4 * (self.codes.capacity() + self.ends.capacity() + self.places.capacity()) + self.texts.capacity()
    }

    /// Gives back the memory that only further rows need.
    pub fn shrink_to_fit(&mut self) {
        self.codes.shrink_to_fit();
        self.texts.shrink_to_fit();
        self.ends.shrink_to_fit();
    }

    fn text(&self, code: u32) -> &str {
        let code = code as usize;
        let first = code.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.texts[first as usize..self.ends[code] as usize]
    }

    /// The number of a text, which may be new.
    fn find(&mut self, text: &str) -> u32 {
        if self.ever_new {
            return self.keep(text);
        }
        if 2 * self.ends.len() >= self.places.len() {
            self.make_room();
            return self.find(text);
        }
        let place = self.place(text);
        if self.places[place] == 0 {
            self.places[place] = self.keep(text) + 1;
        }
        self.places[place] - 1
    }

    /// The place of a text: that where it is, or a free one.
    fn place(&self, text: &str) -> usize {
        let mut hasher = DefaultHasher::new();
        text.hash(&mut hasher);
        let most = self.places.len() - 1;
        let mut place = hasher.finish() as usize & most;
        while self.places[place] != 0 && self.text(self.places[place] - 1) != text {
            place = (place + 1) & most;
        }
        place
    }

    /// Twice the places, or none any more where nearly every text is new.
    fn make_room(&mut self) {
        let known = self.ends.len();
        self.ever_new = known >= MANY && 2 * known > self.codes.len();
        let room = if self.ever_new { 0 } else { (2 * self.places.len()).max(16) };
        self.places = vec![0; room];
        if self.ever_new {
            return;
        }
        for code in 0..known as u32 {
            let place = self.place(self.text(code));
            self.places[place] = code + 1;
        }
    }

    fn keep(&mut self, text: &str) -> u32 {
        let known = self.texts.len();
        let end = u32::try_from(known + text.len());
        if end.is_ok() {
            self.texts.push_str(text);
        }
        self.ends.push(end.unwrap_or(known as u32));
        self.ends.len() as u32 - 1
    }
}

impl Index<usize> for Labels {
    type Output = str;

    fn index(&self, row: usize) -> &str {
        self.text(self.codes[row])
    }
}

impl<T: AsRef<str>> FromIterator<T> for Labels {
    fn from_iter<I: IntoIterator<Item = T>>(texts: I) -> Self {
        let mut labels = Self::default();
        texts.into_iter().for_each(|text| labels.push(text.as_ref()));
        labels
    }
}

impl PartialEq for Labels {
    fn eq(&self, other: &Self) -> bool {
        self.len() == other.len() && self.iter().eq(other.iter())
    }
}

impl fmt::Debug for Labels {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.debug_map().entries(self.spans()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn rows_come_back(texts in proptest::collection::vec("[ab]{0,3}|[a-zä]{0,9}", 0..300), cut in 0..300_usize) {
            let labels: Labels = texts.iter().collect();
            prop_assert_eq!(labels.iter().collect::<Vec<_>>(), texts.iter().collect::<Vec<_>>());
            let cut = cut.min(texts.len());
            prop_assert_eq!(labels.slice(cut..texts.len()), texts[cut..].iter().collect::<Labels>());
            let mut joined = labels.slice(0..cut);
            joined.extend_from(&labels, cut..texts.len());
            prop_assert_eq!(&joined, &labels);
            prop_assert_eq!((labels.len(), labels.get(texts.len())), (texts.len(), None));
            let mut whole = Vec::new();
            let mut last = None;
            for (range, text) in labels.spans() {
                prop_assert!(!range.is_empty() && last.replace(text) != Some(text));
                whole.extend(range.map(|_| text));
            }
            prop_assert_eq!(whole, texts.iter().collect::<Vec<_>>());
            let same = texts.first().filter(|first| texts.iter().all(|t| t == *first));
            prop_assert_eq!(labels.constant(), same.map(String::as_str));
        }
    }

    #[test]
    fn repeated_texts_take_four_bytes_a_row() {
        let labels: Labels = (0..400_000).map(|i| format!("state {}", i % 700)).collect();
        assert!(labels.bytes() < 6 * labels.len() && &labels[1401] == "state 1", "{}", labels.bytes());
    }

    #[test]
    fn texts_that_are_ever_new_take_little_more_than_themselves() {
        let labels: Labels = (0..400_000).map(|i| format!("{:08}", i * 7)).collect();
        // Vectors grow by doubling.
        assert!(labels.bytes() <= 2 * (8 + 4 + 4) * labels.len(), "{}", labels.bytes());
        assert!(labels.iter().enumerate().all(|(i, text)| text.parse() == Ok(i * 7)));
        let again: Labels = (0..400_000).map(|i| format!("{:08}", i * 7)).collect();
        assert_eq!(labels, again);
    }
}
