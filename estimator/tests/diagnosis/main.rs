//! Answers of the diagnosis for simulated recordings.

mod carried_block;
mod coordinates;
mod recorded;
mod sensor_zero;
