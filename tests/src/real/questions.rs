//! The questions. The known answers were measured by others: published values, and figures that plain methods give
//! (`../shared/data/*/ANSWERS.md`).

/// Knowledge about an answer.
#[derive(Clone, Debug)]
pub enum Expected {
    /// A parameter of a fit, in the unit of its name.
    Value {
        /// Its name.
        parameter: &'static str,
        /// Range of the values that others measured.
        between: [f64; 2],
    },
    /// A parameter that the recording does not show.
    NotIdentified {
        /// Its name.
        parameter: &'static str,
    },
    /// A fault of the recording that must be said.
    Warned {
        /// Part of the sentence.
        word: &'static str,
    },
    /// Causes of which one must be certain.
    Named {
        /// Any of these.
        any: &'static [&'static str],
        /// Others that are true as well.
        tolerated: &'static [&'static str],
    },
    /// No cause may be certain.
    NothingCertain {
        /// Except these.
        tolerated: &'static [&'static str],
    },
    /// Something is there beyond the noise.
    NotNone,
}

/// A question about one log.
#[derive(Clone, Debug)]
pub struct Question {
    /// The log, in the folder of the measurements.
    pub log: &'static str,
    /// Its sidecar.
    pub sidecar: &'static str,
    /// Base model of a diagnosis.
    pub baseline: Option<&'static str>,
    /// In words.
    pub asked: &'static str,
    /// The known answer.
    pub expected: Expected,
}

const fn value(
    (log, sidecar): (&'static str, &'static str),
    asked: &'static str,
    parameter: &'static str,
    between: [f64; 2],
) -> Question {
    Question { log, sidecar, baseline: None, asked, expected: Expected::Value { parameter, between } }
}

const fn unknown(
    (log, sidecar): (&'static str, &'static str),
    asked: &'static str,
    parameter: &'static str,
) -> Question {
    Question { log, sidecar, baseline: None, asked, expected: Expected::NotIdentified { parameter } }
}

const fn named(
    (log, sidecar): (&'static str, &'static str),
    baseline: Option<&'static str>,
    asked: &'static str,
    any: &'static [&'static str],
    tolerated: &'static [&'static str],
) -> Question {
    let expected =
        if any.is_empty() { Expected::NothingCertain { tolerated } } else { Expected::Named { any, tolerated } };
    Question { log, sidecar, baseline, asked, expected }
}

const fn not_none((log, sidecar): (&'static str, &'static str), asked: &'static str) -> Question {
    Question { log, sidecar, baseline: None, asked, expected: Expected::NotNone }
}

const fn warned((log, sidecar): (&'static str, &'static str), asked: &'static str, word: &'static str) -> Question {
    Question { log, sidecar, baseline: None, asked, expected: Expected::Warned { word } }
}

const SWING: &str = r#"{"columns":{"t_s":"time_s","q_rad":"angle_rad","dq_rad_s":"speed_rad_s","tau_Nm":"torque_Nm"}}"#;
const ENERGY: (&str, &str) = ("dfki_pendulum/swing_energy.csv", SWING);
const KILOGRAM: (&str, &str) = ("dfki_pendulum/swing_1kg.csv", SWING);
const LEARNED: (&str, &str) = ("dfki_pendulum/swing_rl.csv", SWING);
const NOISY: (&str, &str) = ("dfki_pendulum/swing_noisy.csv", SWING);
const HAND: (&str, &str) = ("dfki_pendulum/hand_moved.csv", SWING);
const AXIS: &str = r#"{"columns":{"t_s":"time_s","q_m":"position_m","f_N":"force_N"}}"#;
const EMPS: (&str, &str) = ("emps/emps_identification.csv", AXIS);
const PULSES: (&str, &str) = ("emps/emps_pulses.csv", AXIS);
const JOINT: &str =
    r#"{"columns":{"t_s":"time_s","q_rad":"angle_rad","dq_rad_s":"speed_rad_s","tau_Nm":"friction_torque_Nm"}}"#;
const SLOW: (&str, &str) = ("franka_joint7/slow.csv", JOINT);
const MIDDLE: (&str, &str) = ("franka_joint7/middle.csv", JOINT);
const FAST: (&str, &str) = ("franka_joint7/fast.csv", JOINT);
const COMMANDED: (&str, &str) = (
    "motor_steps/steps.csv",
    r#"{"columns":{"trial":"run","t_s":"time_s","q_rad":"angle_rad","dq_rad_s":"speed_rad_s","tau_Nm":"torque_command_Nm"}}"#,
);
const MEASURED: (&str, &str) = (
    "motor_steps/steps.csv",
    r#"{"columns":{"trial":"run","t_s":"time_s","q_rad":"angle_rad","dq_rad_s":"speed_rad_s","tau_Nm":"torque_measured_Nm"}}"#,
);
const CART: (&str, &str) = (
    "pendulum_decay/cart_pendulum_decay.csv",
    r#"{"columns":{"t_s":"time_s","q_rad":"angle_rad"},"known":{"mass_kg":0.107,"com_m":0.23}}"#,
);
const ARM: (&str, &str) = (
    "pendulum_decay/arm_pendulum_decay.csv",
    r#"{"columns":{"t_s":"time_s","q_rad":"angle_rad"},"known":{"mass_kg":0.096,"com_m":0.195}}"#,
);
const DOOR: (&str, &str) = (
    "cabinet_pull/kitchen_cabinet_run1.csv",
    r#"{"columns":{"x_m":"tip_x_m","y_m":"tip_y_m","z_m":"tip_z_m","fx_N":"fx_wrist_sensor_N","fy_N":"fy_wrist_sensor_N","fz_N":"fz_wrist_sensor_N"}}"#,
);
const DAY_1: (&str, &str) = ("wrist_payload/poses_day1.csv", "{}");
const DAY_2: (&str, &str) = ("wrist_payload/poses_day2.csv", "{}");
const WIPING: (&str, &str) = ("wiping_segments/demos.csv", r#"{"columns":{"trial":"demo","t_s":"time_s"}}"#);
const CUBES: (&str, &str) =
    ("cube_toss/tosses.csv", r#"{"columns":{"trial":"toss"},"up":"z","known":{"half_width_m":0.0524}}"#);

const RATIO: &str = "gravity_moment_per_inertia_rad_s2";
const COULOMB: &[&str] = &["coulomb-friction"];
const VISCOUS: &[&str] = &["viscous-friction"];

/// All questions, set by set.
pub static QUESTIONS: &[Question] = &[
    value(ENERGY, "gravity moment over inertia, 1/s²", RATIO, [19.2, 19.6]),
    value(ENERGY, "inertia, kg m²", "inertia_kg_m2", [0.15, 0.182]),
    value(ENERGY, "Coulomb friction, N m", "coulomb_Nm", [0.18, 0.21]),
    named(ENERGY, None, "no cause shows behind a torque that follows the speed", &[], &[]),
    value(KILOGRAM, "gravity moment over inertia, 1/s²", RATIO, [19.4, 19.6]),
    value(KILOGRAM, "inertia, kg m²", "inertia_kg_m2", [0.15, 0.30]),
    named(KILOGRAM, None, "no cause shows behind a torque that follows the speed", &[], &[]),
    value(LEARNED, "gravity moment over inertia, 1/s²", RATIO, [19.3, 19.6]),
    value(LEARNED, "inertia, kg m²", "inertia_kg_m2", [0.169, 0.182]),
    value(LEARNED, "gravity moment, N m", "gravity_moment_Nm", [3.3, 3.56]),
    value(LEARNED, "Coulomb friction, N m", "coulomb_Nm", [0.18, 0.21]),
    named(LEARNED, None, "gravity is missing", &["eccentric-mass", "gravity-tilt"], COULOMB),
    value(NOISY, "gravity moment over inertia, 1/s²", RATIO, [19.3, 20.5]),
    value(NOISY, "inertia, kg m²", "inertia_kg_m2", [0.14, 0.17]),
    value(NOISY, "gravity moment, N m", "gravity_moment_Nm", [2.84, 3.4]),
    not_none(NOISY, "gravity is missing: not nothing"),
    unknown(HAND, "inertia under a compensating torque", "inertia_kg_m2"),
    unknown(HAND, "Coulomb friction under a compensating torque", "coulomb_Nm"),
    unknown(HAND, "viscous friction under a compensating torque", "viscous_Nm_s"),
    value(EMPS, "mass, kg", "mass_kg", [94.6, 95.2]),
    value(EMPS, "viscous friction, N s/m", "viscous_N_s_m", [195.0, 205.0]),
    value(EMPS, "Coulomb friction, N", "coulomb_N", [20.3, 21.3]),
    named(EMPS, Some("mass+viscous"), "Coulomb friction is missing", COULOMB, &["friction-asymmetry", "force-bias"]),
    named(EMPS, None, "friction differs by direction", &["friction-asymmetry"], &["force-bias", "stribeck"]),
    named(PULSES, Some("mass+viscous"), "Coulomb friction is missing", COULOMB, &["friction-asymmetry", "force-bias"]),
    named(PULSES, None, "friction differs by direction", &["friction-asymmetry"], &["force-bias", "stribeck"]),
    warned(SLOW, "the clock runs at half speed", "rate that"),
    warned(MIDDLE, "the clock runs at half speed", "rate that"),
    warned(FAST, "the clock runs at half speed", "rate that"),
    value(SLOW, "Coulomb friction, N m", "coulomb_Nm", [0.19, 0.21]),
    value(MIDDLE, "Coulomb friction, N m", "coulomb_Nm", [0.22, 0.24]),
    unknown(SLOW, "inertia, which the torque does not hold", "inertia_kg_m2"),
    unknown(MIDDLE, "inertia, which the torque does not hold", "inertia_kg_m2"),
    unknown(FAST, "inertia, which the torque does not hold", "inertia_kg_m2"),
    named(SLOW, None, "a constant, by bias or by direction", &["force-bias", "friction-asymmetry"], &["stribeck"]),
    named(MIDDLE, None, "a constant, by bias or by direction", &["force-bias", "friction-asymmetry"], &["stribeck"]),
    value(COMMANDED, "inertia, kg m²", "inertia_kg_m2", [1.2e-4, 1.3e-4]),
    value(COMMANDED, "Coulomb friction, N m", "coulomb_Nm", [0.0235, 0.0245]),
    value(COMMANDED, "offset, N m", "offset_Nm", [0.0090, 0.0096]),
    named(
        COMMANDED,
        Some("mass+viscous"),
        "a bias and Coulomb friction",
        COULOMB,
        &["force-bias", "friction-asymmetry"],
    ),
    named(COMMANDED, None, "a bias", &["force-bias", "friction-asymmetry"], &[]),
    value(MEASURED, "Coulomb friction, N m", "coulomb_Nm", [0.0365, 0.037]),
    value(MEASURED, "offset, N m", "offset_Nm", [0.0080, 0.0086]),
    value(CART, "inertia about the pivot, kg m²", "inertia_kg_m2", [7.21e-3, 7.25e-3]),
    value(ARM, "inertia about the pivot, kg m²", "inertia_kg_m2", [4.55e-3, 4.57e-3]),
    value(CART, "Coulomb friction, N m", "coulomb_Nm", [3.0e-4, 4.5e-4]),
    unknown(CART, "viscous friction beside dry friction and drag", "viscous_Nm_s"),
    named(CART, Some("mass+viscous"), "dry friction is missing", COULOMB, &["quadratic-drag"]),
    named(CART, None, "drag is missing", &["quadratic-drag"], &[]),
    named(ARM, None, "drag is missing", &["quadratic-drag"], &[]),
    named(
        DOOR,
        None,
        "the torque falls with the angle",
        &["local-resistance", "return-spring"],
        &["axis-sign", "force-bias", "channel-fault"],
    ),
    value(DAY_1, "weight of a payload, N", "weight_N", [10.80, 10.81]),
    value(DAY_1, "bias of the sensor along z, N", "force_bias_z_N", [-13.08, -13.07]),
    value(DAY_2, "weight of a payload, N", "weight_N", [12.145, 12.155]),
    value(DAY_2, "bias of the sensor along x, N", "force_bias_x_N", [-3.46, -3.45]),
    named(DAY_2, None, "the bias carries most of the reading", &["force-bias"], &["mass-change"]),
    not_none(WIPING, "wiping is no motion along a line: not nothing"),
    named(CUBES, None, "lengths are 2 % short", &["length-scale"], &["load-friction", "velocity-loss"]),
    named(ENERGY, Some("mass+viscous"), "no cause shows behind a torque that follows the speed", &[], COULOMB),
    named(KILOGRAM, Some("mass"), "no cause shows behind a torque that follows the speed", &[], COULOMB),
    named(
        EMPS,
        Some("mass"),
        "viscous friction is missing",
        VISCOUS,
        &["coulomb-friction", "friction-asymmetry", "force-bias"],
    ),
];
