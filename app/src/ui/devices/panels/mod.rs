//! Panels of the devices, one a file.

pub mod device_detail;
pub mod device_log;
pub mod device_row;
pub mod devices;
pub mod remote;

use crate::ui::shell::panel::Registration;

/// Panels that the window offers; a new one is added here.
pub static PANELS: &[&Registration] = &[&devices::REGISTRATION, &device_detail::REGISTRATION];
