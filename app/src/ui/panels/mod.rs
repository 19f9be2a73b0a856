//! One panel a file, behind one trait; [`list`] names them all.

pub mod answers;
pub mod device_detail;
pub mod devices;
pub mod list;
pub mod remote;
