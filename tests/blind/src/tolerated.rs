//! Causes that describe a structure itself: whoever names them is not quite wrong.

use super::effect::Effect;

/// Ids that are left out of a fair count where a structure of that family is hidden. The table is tight: a cause stands in it if some
/// recordings of the family are, or nearly are, recordings of that cause.
pub fn tolerated(family: Effect) -> &'static [&'static str] {
    match family {
        // A slow zero: constant, straight, or with a quick change.
        Effect::SensorWander => &["force-bias", "force-drift", "force-step"],
        // The share that is remembered drifts, and it comes after its force as in a loop.
        Effect::SensorCreep => &["force-drift", "hysteresis"],
        // A force over the place: by one harmonic, one bump, the first harmonic of a crank, or a slope.
        Effect::AngleField => {
            &["position-ripple", "local-resistance", "eccentric-mass", "gravity-tilt", "return-spring"]
        }
        // A force over the speed: at low, at high speeds, and their straight parts.
        Effect::SpeedField => &["stribeck", "quadratic-drag", "viscous-friction", "coulomb-friction"],
        // Friction over the load: the straight line, and what is there without a load.
        Effect::LoadField => &["load-friction", "coulomb-friction"],
        // The straight parts of the network: in sine and cosine of the angle, and in the load with its sign.
        Effect::StateField => &["eccentric-mass", "gravity-tilt", "force-cross-axis", "friction-asymmetry"],
        // Dry friction over the place: one bump; one way round it is a force over the place.
        Effect::FrictionOverAngle => &["local-resistance", "position-ripple"],
        // It is that change of friction, but not a steady one.
        Effect::FrictionWander => &["friction-change"],
        // The grasp moves, by itself or as the pad gives way.
        Effect::GraspCreep => &["fingertip-slip", "pad-compliance"],
        // Coarse readings are a fault of the channel; the tread on which zero lies is a bias.
        Effect::Steps => &["channel-fault", "force-bias"],
        // No cause of the catalogue rings or hums.
        _ => &[],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_structures_are_tolerated_and_as_few_ids_as_can_be() {
        assert!(Effect::NAMED.into_iter().all(|effect| tolerated(effect).is_empty()));
        assert!(Effect::STRUCTURES.into_iter().all(|family| tolerated(family).len() <= 5));
    }
}
