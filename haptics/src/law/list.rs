//! The list of all laws of a coordinate: a new one is added here.

/// Calls a macro with all laws of a coordinate, in the order in which they are shown.
///
/// A line is the name of the law's file and its type. From it follow the module and the place in the catalogue, in
/// `estimator` also the module and the place of the hypothesis.
#[macro_export]
macro_rules! laws {
    ($with:ident) => {
        $with! {
            // Causes that a diagnosis can name. `estimator/src/diagnose/hypotheses` has a file of the same name.
            causes {
                inertia: Inertia,
                coulomb_friction: CoulombFriction,
                load_friction: LoadFriction,
                viscous_friction: ViscousFriction,
                friction_asymmetry: FrictionAsymmetry,
                stribeck: Stribeck,
                quadratic_drag: QuadraticDrag,
                hysteresis: Hysteresis,
                eccentric_mass: EccentricMass,
                gravity_tilt: GravityTilt,
                return_spring: ReturnSpring,
                position_ripple: PositionRipple,
                local_resistance: LocalResistance,
                backlash: Backlash,
                mass_change: MassChange,
                friction_change: FrictionChange,
                added_constraint: AddedConstraint,
                force_bias: ForceBias,
                force_drift: ForceDrift,
                force_step: ForceStep,
            }
            // Parts of models: the weight, the push under the name of `local-resistance`, the cable under that of
            // `added-constraint`, and the variants under load.
            models {
                weight: Weight,
                local_push: LocalPush,
                cable: Cable,
                load_hysteresis: LoadHysteresis,
                load_friction_change: LoadFrictionChange,
            }
        }
    };
}
