//! Work on other threads; it brings back a change and knows no feature.

pub mod jobs;
