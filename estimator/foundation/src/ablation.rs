//! Constants that vary at run time, for `touchstone bench ablation`.
//!
//! The bench copies the sources and turns every numeric constant into a function whose body is `value(index, …)`. One
//! build then holds all variants of all constants (mutant schemata: Untch, Offutt & Harrold 1993). The program itself
//! is built without this module.

use std::array;
use std::ops::RangeInclusive;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};

/// Number of constants at most.
const CAPACITY: usize = 4096;
/// Index that no constant has.
const NOTHING: usize = usize::MAX;

static READ: [AtomicBool; CAPACITY] = [const { AtomicBool::new(false) }; CAPACITY];
static VARIED: AtomicUsize = AtomicUsize::new(NOTHING);
static FACTOR_BITS: AtomicU64 = AtomicU64::new(0);

/// Type of a constant that can be multiplied.
pub trait Scale {
    /// The value times a factor.
    #[must_use]
    fn scaled(self, factor: f64) -> Self;
}

impl Scale for f64 {
    fn scaled(self, factor: f64) -> Self {
        self * factor
    }
}

macro_rules! whole_numbers {
    ($($kind:ty)*) => {$(
        impl Scale for $kind {
            // One body for all widths.
            #[allow(clippy::cast_lossless)]
            fn scaled(self, factor: f64) -> Self {
                (self as f64 * factor).round() as Self
            }
        }
    )*};
}
whole_numbers!(usize u64 u32 u16 u8 isize i64 i32);

impl<T: Scale, const N: usize> Scale for [T; N] {
    fn scaled(self, factor: f64) -> Self {
        let mut values = self.into_iter();
        array::from_fn(|_| values.next().expect("as many values as places").scaled(factor))
    }
}

impl<T: Scale> Scale for RangeInclusive<T> {
    fn scaled(self, factor: f64) -> Self {
        let (low, high) = self.into_inner();
        low.scaled(factor)..=high.scaled(factor)
    }
}

/// A constant: its value, or its value times the factor if it is varied. Notes that it was read.
pub fn value<T: Scale>(index: usize, value: T) -> T {
    READ[index].store(true, Ordering::Relaxed);
    if VARIED.load(Ordering::Relaxed) == index {
        value.scaled(f64::from_bits(FACTOR_BITS.load(Ordering::Relaxed)))
    } else {
        value
    }
}

/// Multiplies the constant `index` by `factor` from now on, and no other constant.
pub fn vary(index: usize, factor: f64) {
    FACTOR_BITS.store(factor.to_bits(), Ordering::Relaxed);
    VARIED.store(index, Ordering::Relaxed);
}

/// Every constant has its own value again. Returns the indices that were read since the last call.
pub fn reset() -> Vec<usize> {
    VARIED.store(NOTHING, Ordering::Relaxed);
    (0..CAPACITY).filter(|&index| READ[index].swap(false, Ordering::Relaxed)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_constant_is_varied_and_reads_are_noted() {
        drop(reset());
        vary(7, 0.5);
        assert_eq!((value(7, 8.0), value(8, 8.0), value(7, 5_usize), value(7, [2.0, 4.0])), (4.0, 8.0, 3, [1.0, 2.0]));
        assert_eq!(value(7, 1.0..=3.0), 0.5..=1.5);
        assert_eq!(reset(), [7, 8]);
        assert_eq!((value(7, 8.0), reset(), reset()), (8.0, vec![7], vec![]));
    }
}
