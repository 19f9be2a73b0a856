//! Geometric constraints.
