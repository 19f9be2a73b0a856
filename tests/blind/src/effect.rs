//! What can be hidden, by the names that an answer uses.

/// What is hidden in a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // the ids below say what each is
pub enum Effect {
    Asymmetry,
    Coulomb,
    Stribeck,
    Viscous,
    Drag,
    Inertia,
    Ripple,
    Eccentric,
    Tilt,
    Spring,
    Backlash,
    Hysteresis,
    Leak,
    FrictionChange,
    Local,
    Cable,
    Pad,
    Slip,
    Delay,
    Bias,
    Drift,
    CrossAxis,
    Gain,
    Saturation,
    JointOffset,
    LengthScale,
    AxisSign,
    ChannelFault,
    // No table of causes knows these.
    PositionViscous,
    SquareFriction,
    SquaredLoad,
    Shaking,
    // Structured model error: no law of the catalogue describes these.
    SensorWander,
    SensorCreep,
    AngleField,
    SpeedField,
    LoadField,
    StateField,
    FrictionOverAngle,
    FrictionWander,
    GraspCreep,
    Ringing,
    Hum,
    Steps,
}

/// Where an effect shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shows {
    /// In the force along the motion.
    Force,
    /// In the path, which is no circle any more.
    Path,
    /// Without any statistics: a size has no meaning.
    Grossly,
}

impl Effect {
    /// Everything that has a name.
    pub const NAMED: [Self; 28] = [
        Self::Asymmetry,
        Self::Coulomb,
        Self::Stribeck,
        Self::Viscous,
        Self::Drag,
        Self::Inertia,
        Self::Ripple,
        Self::Eccentric,
        Self::Tilt,
        Self::Spring,
        Self::Backlash,
        Self::Hysteresis,
        Self::Leak,
        Self::FrictionChange,
        Self::Local,
        Self::Cable,
        Self::Pad,
        Self::Slip,
        Self::Delay,
        Self::Bias,
        Self::Drift,
        Self::CrossAxis,
        Self::Gain,
        Self::Saturation,
        Self::JointOffset,
        Self::LengthScale,
        Self::AxisSign,
        Self::ChannelFault,
    ];

    /// What has no name.
    pub const NAMELESS: [Self; 4] = [Self::PositionViscous, Self::SquareFriction, Self::SquaredLoad, Self::Shaking];

    /// Structured model error.
    pub const STRUCTURES: [Self; 12] = [
        Self::SensorWander,
        Self::SensorCreep,
        Self::AngleField,
        Self::SpeedField,
        Self::LoadField,
        Self::StateField,
        Self::FrictionOverAngle,
        Self::FrictionWander,
        Self::GraspCreep,
        Self::Ringing,
        Self::Hum,
        Self::Steps,
    ];

    /// The name, as answers have it.
    pub fn id(self) -> &'static str {
        match self {
            Self::Asymmetry => "friction-asymmetry",
            Self::Coulomb => "coulomb-friction",
            Self::Stribeck => "stribeck",
            Self::Viscous => "viscous-friction",
            Self::Drag => "quadratic-drag",
            Self::Inertia => "inertia",
            Self::Ripple => "position-ripple",
            Self::Eccentric => "eccentric-mass",
            Self::Tilt => "gravity-tilt",
            Self::Spring => "return-spring",
            Self::Backlash => "backlash",
            Self::Hysteresis => "hysteresis",
            Self::Leak => "mass-change",
            Self::FrictionChange => "friction-change",
            Self::Local => "local-resistance",
            Self::Cable => "added-constraint",
            Self::Pad => "pad-compliance",
            Self::Slip => "fingertip-slip",
            Self::Delay => "time-delay",
            Self::Bias => "force-bias",
            Self::Drift => "force-drift",
            Self::CrossAxis => "force-cross-axis",
            Self::Gain => "force-gain",
            Self::Saturation => "force-saturation",
            Self::JointOffset => "joint-offset",
            Self::LengthScale => "length-scale",
            Self::AxisSign => "axis-sign",
            Self::ChannelFault => "channel-fault",
            Self::PositionViscous => "(viscous friction that depends on the angle)",
            Self::SquareFriction => "(friction that changes in steps with the angle)",
            Self::SquaredLoad => "(friction with the square of the load)",
            Self::Shaking => "(shaking from outside)",
            Self::SensorWander => "structure:sensor-wander",
            Self::SensorCreep => "structure:sensor-creep",
            Self::AngleField => "structure:angle-field",
            Self::SpeedField => "structure:speed-field",
            Self::LoadField => "structure:load-field",
            Self::StateField => "structure:state-field",
            Self::FrictionOverAngle => "structure:friction-over-angle",
            Self::FrictionWander => "structure:friction-wander",
            Self::GraspCreep => "structure:grasp-creep",
            Self::Ringing => "structure:ringing",
            Self::Hum => "structure:hum",
            Self::Steps => "structure:steps",
        }
    }

    /// The effect of an id.
    pub fn from_id(id: &str) -> Option<Self> {
        Self::NAMED.into_iter().chain(Self::NAMELESS).chain(Self::STRUCTURES).find(|effect| effect.id() == id)
    }

    /// True for what no table of causes knows.
    pub fn is_nameless(self) -> bool {
        Self::NAMELESS.contains(&self)
    }

    /// True for structured model error.
    pub fn is_structure(self) -> bool {
        Self::STRUCTURES.contains(&self)
    }

    /// True for what only a force sensor tells, and the handle does not feel.
    pub fn is_in_force_sensor(self) -> bool {
        matches!(
            self,
            Self::Delay
                | Self::Bias
                | Self::Drift
                | Self::CrossAxis
                | Self::Gain
                | Self::Saturation
                | Self::SensorWander
                | Self::SensorCreep
                | Self::Ringing
                | Self::Hum
                | Self::Steps
        )
    }

    /// Where it shows.
    pub fn shows(self) -> Shows {
        match self {
            Self::Pad | Self::Slip | Self::JointOffset | Self::LengthScale => Shows::Path,
            Self::AxisSign | Self::ChannelFault => Shows::Grossly,
            _ => Shows::Force,
        }
    }

    /// False for what an instrument makes out of the same motion: that need not be simulated again for another size.
    pub fn acts_on_motion(self) -> bool {
        !matches!(
            self,
            Self::Bias
                | Self::Drift
                | Self::CrossAxis
                | Self::Gain
                | Self::Saturation
                | Self::JointOffset
                | Self::LengthScale
                | Self::AxisSign
                | Self::ChannelFault
                | Self::SensorWander
                | Self::SensorCreep
                | Self::Ringing
                | Self::Hum
                | Self::Steps
        )
    }

    /// True where a crank that one finger turns can have it and show it.
    pub fn on_crank(self) -> bool {
        self != Self::Viscous // part of every crank
    }

    /// True where a crank held by two fingers is worth a case of its own: what sits in one finger is seen with one.
    pub fn on_two_fingers(self) -> bool {
        self.on_crank()
            && self.shows() == Shows::Force
            && !matches!(self, Self::CrossAxis | Self::Gain | Self::Saturation | Self::Delay | Self::GraspCreep)
    }

    /// True where a mechanism with one degree of freedom can have it and show it. A gap without a load to cross it, and
    /// friction that is known to be dry, are left to the crank.
    pub fn on_mechanism(self, angular: bool) -> bool {
        match self {
            Self::Eccentric => angular,
            Self::Asymmetry
            | Self::Coulomb
            | Self::Viscous
            | Self::Stribeck
            | Self::Drag
            | Self::Ripple
            | Self::Spring
            | Self::Hysteresis
            | Self::FrictionChange
            | Self::Local
            | Self::Delay
            | Self::Drift
            | Self::Saturation
            | Self::ChannelFault
            | Self::PositionViscous
            | Self::SquareFriction => true,
            _ if self.is_structure() => !matches!(self, Self::LoadField | Self::GraspCreep),
            _ => false,
        }
    }

    /// The forms that can be seen on a crank (or on a mechanism, where dry friction by direction is only an offset).
    pub fn forms_on(self, crank: bool) -> std::ops::Range<u32> {
        if self == Self::Asymmetry && !crank { 1..2 } else { 0..self.forms() }
    }

    /// Number of functional forms; the first is that of the textbooks (and of the dictionary).
    pub fn forms(self) -> u32 {
        match self {
            Self::ChannelFault | Self::Local => 4,
            Self::Asymmetry | Self::Stribeck | Self::FrictionChange | Self::Slip | Self::AxisSign | Self::Backlash => 3,
            Self::Drag
            | Self::Ripple
            | Self::Spring
            | Self::Hysteresis
            | Self::Leak
            | Self::Pad
            | Self::Delay
            | Self::Drift
            | Self::JointOffset
            | Self::LengthScale
            | Self::SensorWander
            | Self::SensorCreep
            | Self::AngleField
            | Self::LoadField
            | Self::FrictionOverAngle
            | Self::FrictionWander
            | Self::GraspCreep
            | Self::Ringing => 2,
            _ => 1,
        }
    }

    /// The form in words.
    pub fn form(self, form: u32) -> &'static str {
        match (self, form) {
            (Self::Asymmetry, 0) => "load friction by direction",
            (Self::Asymmetry, 1) => "viscous friction by direction",
            (Self::Asymmetry, _) => "dry friction by direction",
            (Self::Stribeck, 0) => "Gaussian",
            (Self::Stribeck, 1) => "rational",
            (Self::Drag, 1) => "power 2.5",
            (Self::Ripple, 1) => "triangular",
            (Self::Backlash, 1) => "soft edges",
            (Self::Backlash, 2) => "behind what sticks",
            (Self::Hysteresis, 0) => "Dahl",
            (Self::Hysteresis, _) => "Bouc-Wen, exponent 2",
            (Self::Stribeck, _) | (Self::Leak | Self::Drift, 1) => "exponential",
            (Self::FrictionChange, 0) => "warming up",
            (Self::FrictionChange, 1) => "linear",
            (Self::FrictionChange, _) => "sudden",
            (Self::Local, 0) => "smooth bind",
            (Self::Local, 1) => "smooth obstacle",
            (Self::Local, 2) => "box bind",
            (Self::Local, _) => "box obstacle",
            (Self::Spring | Self::Pad, 1) => "hardening",
            (Self::Slip, 1) => "two slips",
            (Self::Slip, 2) => "creep",
            (Self::Delay, 1) => "lag",
            (Self::JointOffset, 0) | (Self::LengthScale, 1) => "top link",
            (Self::JointOffset, _) | (Self::LengthScale, 0) => "bottom link",
            (Self::AxisSign, 0) => "fy mirrored",
            (Self::AxisSign, 1) => "fx mirrored",
            (Self::AxisSign, _) => "fx and fy swapped",
            (Self::ChannelFault, 0) => "stuck force",
            (Self::ChannelFault, 1) => "dropped samples",
            (Self::ChannelFault, 2) => "coarse force",
            (Self::ChannelFault, _) => "stuck motion",
            (Self::SensorWander | Self::FrictionWander, 1) => "three scales",
            (Self::SensorCreep, 1) => "two memories",
            (Self::AngleField | Self::FrictionOverAngle, 0) => "bumps",
            (Self::AngleField | Self::FrictionOverAngle, _) => "value noise",
            (Self::LoadField, 1) => "of its magnitude",
            (Self::GraspCreep, 0) => "by itself",
            (Self::GraspCreep, _) => "after the force",
            (Self::Ringing, 1) => "harder after long ways",
            _ => "plain",
        }
    }
}
