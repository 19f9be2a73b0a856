//! Hypotheses: everything that a diagnosis knows of a cause, one file a law or sensor fault. `all` lists them;
//! `hypothesis` is their trait; `library`, `grid` and `candidate` are that from which they make regressors.

pub(crate) mod all;
pub(crate) mod axis;
pub(crate) mod axis_sign;
pub(crate) mod candidate;
pub(crate) mod change_scan;
pub(crate) mod channel_fault;
pub(crate) mod covariate;
pub(crate) mod dictionary;
pub(crate) mod dry_share;
pub(crate) mod fingertip_slip;
pub(crate) mod force_cross_axis;
pub(crate) mod force_gain;
pub(crate) mod force_saturation;
pub(crate) mod free_motion;
pub(crate) mod grid;
pub(crate) mod hypothesis;
pub(crate) mod joint_offset;
pub(crate) mod law_forces;
pub(crate) mod length_scale;
pub(crate) mod pad_compliance;
pub(crate) mod regressor_cache;
pub(crate) mod relations;
pub(crate) mod sensor_fault;
pub(crate) mod stiffness_hardening;
pub(crate) mod time_delay;
pub(crate) mod variable;
pub(crate) mod velocity_loss;

macro_rules! modules {
    (causes { $($cause_file:ident: $cause:ident,)* } models { $($model_file:ident: $model:ident,)* }) => {
        $(pub(crate) mod $cause_file;)*
    };
}

haptics::laws!(modules);
