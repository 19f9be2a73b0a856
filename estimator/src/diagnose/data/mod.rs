pub(crate) mod coordinate;
pub(crate) mod covariates;
pub(crate) mod direction;
pub(crate) mod interpolation;
pub(crate) mod known_weight;
pub(crate) mod regression_data;
pub(crate) mod row_means;
pub(crate) mod stick_phases;
