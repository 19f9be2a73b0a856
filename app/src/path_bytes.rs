//! Paths in files of ours, whatever bytes they have: a file may be called what is no text, and must be found again all the same.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::path::PathBuf;

/// A path as it stands in a file: text, or its bytes where it is none.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
pub enum Kept {
    /// What nearly every path is.
    Text(String),
    /// As the system has it.
    Bytes(Vec<u8>),
}

/// One path, perhaps one, or several.
pub trait Paths: Sized {
    /// How it stands in a file.
    type Kept: Serialize + DeserializeOwned;
    /// To the file.
    fn keep(&self) -> Self::Kept;
    /// From the file.
    fn found(kept: Self::Kept) -> Self;
}

impl Paths for PathBuf {
    type Kept = Kept;

    fn keep(&self) -> Kept {
        match self.to_str() {
            Some(text) => Kept::Text(text.to_owned()),
            #[cfg(unix)]
            None => Kept::Bytes(std::os::unix::ffi::OsStrExt::as_bytes(self.as_os_str()).to_vec()),
            // Elsewhere a name that is no text cannot be written down exactly.
            #[cfg(not(unix))]
            None => Kept::Text(self.to_string_lossy().into_owned()),
        }
    }

    fn found(kept: Kept) -> Self {
        match kept {
            Kept::Text(text) => text.into(),
            #[cfg(unix)]
            Kept::Bytes(bytes) => <std::ffi::OsString as std::os::unix::ffi::OsStringExt>::from_vec(bytes).into(),
            #[cfg(not(unix))]
            Kept::Bytes(bytes) => String::from_utf8_lossy(&bytes).into_owned().into(),
        }
    }
}

impl<T: Paths> Paths for Option<T> {
    type Kept = Option<T::Kept>;

    fn keep(&self) -> Self::Kept {
        self.as_ref().map(T::keep)
    }

    fn found(kept: Self::Kept) -> Self {
        kept.map(T::found)
    }
}

impl<T: Paths> Paths for Vec<T> {
    type Kept = Vec<T::Kept>;

    fn keep(&self) -> Self::Kept {
        self.iter().map(T::keep).collect()
    }

    fn found(kept: Self::Kept) -> Self {
        kept.into_iter().map(T::found).collect()
    }
}

/// For `#[serde(with = "…")]`.
pub fn serialize<T: Paths, S: Serializer>(paths: &T, serializer: S) -> Result<S::Ok, S::Error> {
    paths.keep().serialize(serializer)
}

/// For `#[serde(with = "…")]`.
pub fn deserialize<'de, T: Paths, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    T::Kept::deserialize(deserializer).map(T::found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Kept {
        #[serde(with = "super")]
        one: PathBuf,
        #[serde(with = "super", default)]
        perhaps: Option<PathBuf>,
    }

    #[cfg(unix)]
    #[test]
    fn a_name_that_is_no_text_is_found_again_and_text_stays_text() {
        let odd = PathBuf::from(<std::ffi::OsString as std::os::unix::ffi::OsStringExt>::from_vec(vec![b'a', 0xff]));
        let kept = Kept { one: odd.clone(), perhaps: Some(odd) };
        let text = serde_json::to_string(&kept).expect("JSON");
        assert_eq!(serde_json::from_str::<Kept>(&text).expect("the same"), kept);
        let plain = Kept { one: PathBuf::from("a.csv"), perhaps: None };
        assert_eq!(serde_json::to_string(&plain).expect("JSON"), r#"{"one":"a.csv","perhaps":null}"#);
        assert_eq!(serde_json::from_str::<Kept>(r#"{"one":"a.csv"}"#).expect("an older file"), plain);
    }
}
