pub(crate) mod motions;
pub(crate) mod predicted_rows;
pub(crate) mod proposal;
pub(crate) mod separation;
pub(crate) mod strokes;
pub(crate) mod waypoints;
