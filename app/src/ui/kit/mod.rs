//! Colours, sizes, icons and widgets that every part of the window uses.

pub mod icons;
pub mod markdown;
#[cfg(feature = "sound")]
pub mod sound;
pub mod theme;
pub mod tooltips;
pub mod widgets;
