pub(crate) mod along_coordinate;
pub(crate) mod channel;
pub(crate) mod integrate;
pub(crate) mod pads;
pub(crate) mod windows;
