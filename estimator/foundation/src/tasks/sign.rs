//! A signal against its threshold.

/// A signal against its threshold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// Above.
    Plus,
    /// Within.
    Zero,
    /// Below the negative threshold.
    Minus,
}

impl Sign {
    /// As written in files.
    pub fn symbol(self) -> char {
        match self {
            Self::Plus => '+',
            Self::Zero => '0',
            Self::Minus => '-',
        }
    }
}
