pub(crate) mod proposal;
pub(crate) mod separation;
pub(crate) mod strokes;
pub(crate) mod waypoints;
