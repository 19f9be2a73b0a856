//! Messages in JSON: numbers, truth values and texts become cells as they are met, without a tree in between.

use super::topic::{MAX_ITEMS, Topic};
use serde::de::{DeserializeSeed, Error as _, MapAccess, SeqAccess, Visitor};
use std::fmt::{self, Write as _};

/// Puts one message into the current row of `topic`.
pub fn decode(data: &[u8], topic: &mut Topic, path: &mut String) -> Result<(), String> {
    let error = match read(data, topic, path) {
        Ok(()) => return Ok(()),
        Err(error) => error,
    };
    // Fields that were met before the fault keep their values: the first one counts.
    let Some(data) = without_nan(data) else { return Err(error) };
    read(&data, topic, path).map_err(|_| error)
}

fn read(data: &[u8], topic: &mut Topic, path: &mut String) -> Result<(), String> {
    path.clear();
    let mut reader = serde_json::Deserializer::from_slice(data);
    Value { topic, path }.deserialize(&mut reader).and_then(|()| reader.end()).map_err(|e| e.to_string())
}

/// The message with `null` for `NaN` and `Infinity`, which Python and JavaScript write although JSON has no such words;
/// none if there are none.
fn without_nan(data: &[u8]) -> Option<Vec<u8>> {
    const WORDS: [&[u8]; 3] = [b"NaN", b"-Infinity", b"Infinity"];
    let mut made = Vec::with_capacity(data.len());
    let (mut rest, mut in_text, mut any) = (data, false, false);
    while let Some((&first, after)) = rest.split_first() {
        if in_text && first == b'\\' {
            let (pair, after) = rest.split_at(rest.len().min(2));
            made.extend(pair);
            rest = after;
            continue;
        }
        in_text ^= first == b'"';
        if let Some(word) = WORDS.iter().find(|word| !in_text && rest.starts_with(word)) {
            made.extend(b"null");
            rest = &rest[word.len()..];
            any = true;
            continue;
        }
        made.push(first);
        rest = after;
    }
    any.then_some(made)
}

struct Value<'a> {
    topic: &'a mut Topic,
    path: &'a mut String,
}

impl Value<'_> {
    fn number<E: serde::de::Error>(self, value: f64) -> Result<(), E> {
        let column = self.topic.column(self.path, false).map_err(E::custom)?;
        self.topic.number(column, value);
        Ok(())
    }
}

impl<'de> DeserializeSeed<'de> for Value<'_> {
    type Value = ();

    fn deserialize<D: serde::Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Value<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_bool<E: serde::de::Error>(self, value: bool) -> Result<(), E> {
        self.number(f64::from(u8::from(value)))
    }

    fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<(), E> {
        self.number(value as f64)
    }

    fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<(), E> {
        self.number(value as f64)
    }

    fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<(), E> {
        self.number(value)
    }

    fn visit_str<E: serde::de::Error>(self, value: &str) -> Result<(), E> {
        let column = self.topic.column(self.path, true).map_err(E::custom)?;
        self.topic.text(column, value);
        Ok(())
    }

    /// `null`: no value.
    fn visit_unit<E: serde::de::Error>(self) -> Result<(), E> {
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<(), A::Error> {
        let length = self.path.len();
        for index in 0..MAX_ITEMS {
            let _ = write!(self.path, "[{index}]"); // writing into a string cannot fail
            let more = items.next_element_seed(Value { topic: self.topic, path: self.path })?;
            self.path.truncate(length);
            if more.is_none() {
                return Ok(());
            }
        }
        while items.next_element::<serde::de::IgnoredAny>()?.is_some() {
            self.topic.long_lists = true;
        }
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut members: A) -> Result<(), A::Error> {
        let length = self.path.len();
        while members.next_key_seed(Key { path: self.path })?.is_some() {
            if self.path.len() > 4096 {
                return Err(A::Error::custom("the name of a field is longer than 4096 characters"));
            }
            members.next_value_seed(Value { topic: self.topic, path: self.path })?;
            self.path.truncate(length);
        }
        Ok(())
    }
}

/// Appends a member's name to the path, without a string of its own.
struct Key<'a> {
    path: &'a mut String,
}

impl<'de> DeserializeSeed<'de> for Key<'_> {
    type Value = ();

    fn deserialize<D: serde::Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_str(self)
    }
}

impl Visitor<'_> for Key<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the name of a field")
    }

    fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<(), E> {
        if !self.path.is_empty() {
            self.path.push('.');
        }
        self.path.push_str(name);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_value_finds_its_column() {
        let mut topic = Topic::default();
        topic.begin(0, 0);
        let text = br#"{"t_s": 0.1, "tip": {"x": -3, "on": true}, "list": [1, 2.5], "state": "a\"b", "none": null}"#;
        decode(text, &mut topic, &mut String::new()).expect("decodes");
        topic.end();
        assert_eq!(topic.fields, ["t_s", "tip.x", "tip.on", "list[0]", "list[1]", "state"]);
        let cells: Vec<String> = topic.columns.iter().map(|c| c.text(0)).collect();
        assert_eq!(cells, ["0.1", "-3", "1", "1", "2.5", "a\"b"]);
    }

    #[test]
    fn words_for_no_number_are_no_value() {
        let mut topic = Topic::default();
        topic.begin(0, 0);
        let text = br#"{"effort": [NaN, 2], "text": "a \"NaN\" b", "far": -Infinity}"#;
        decode(text, &mut topic, &mut String::new()).expect("decodes");
        topic.end();
        let cells: Vec<(String, String)> =
            topic.fields.iter().cloned().zip(topic.columns.iter().map(|c| c.text(0))).collect();
        let wanted = [("effort[1]", "2"), ("text", "a \"NaN\" b")].map(|(f, c)| (f.to_owned(), c.to_owned()));
        assert_eq!(cells, wanted);
    }

    #[test]
    fn half_a_message_is_refused() {
        for text in ["", "{", "{\"a\":1", "{\"a\":1}x", "[1,", "nul", "{1:2}", "{\"a\":NaN", "{\"a\":Nan}"] {
            let mut topic = Topic::default();
            topic.begin(0, 0);
            assert!(decode(text.as_bytes(), &mut topic, &mut String::new()).is_err(), "{text}");
        }
        let deep = "[".repeat(100_000);
        let mut topic = Topic::default();
        topic.begin(0, 0);
        assert!(decode(deep.as_bytes(), &mut topic, &mut String::new()).is_err());
    }
}
