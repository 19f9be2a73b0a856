//! The devices that move the fingers.

#[cfg(test)]
mod device_tests;
pub mod panels;
