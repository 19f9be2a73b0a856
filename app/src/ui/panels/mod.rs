//! One panel a file, behind one trait; [`list`] names them all.

pub mod list;
