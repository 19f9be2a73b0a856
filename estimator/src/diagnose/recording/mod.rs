pub(crate) mod delay_scan;
pub(crate) mod driving_force;
pub(crate) mod grip_axis_signs;
pub(crate) mod pads;
pub(crate) mod rate_signs;
pub(crate) mod sample_faults;
pub(crate) mod time_delay;
