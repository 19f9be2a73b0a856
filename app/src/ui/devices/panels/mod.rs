//! Panels of the devices, one a file.

pub mod device_detail;
pub mod device_log;
pub mod device_row;
pub mod devices;
pub mod remote;
