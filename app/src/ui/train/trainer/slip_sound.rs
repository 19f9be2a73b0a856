//! Audible quantities of a state: slip speed along a fingertip.

use haptics::world::{Contact, State, Surface};

/// Minimum normal force of an audible contact, N.
const LEAST_N: f64 = 0.02;

/// Fastest slip of a finger along a contact, m/s; 0 without slip.
pub fn slip_m_s(state: &State) -> f64 {
    let speed = |contact: &Contact| -> f64 {
        let ((Surface::Finger(finger), other) | (other, Surface::Finger(finger))) = (contact.on, contact.by) else {
            return 0.0;
        };
        let Some(tip) = state.input.tip_velocity.get(usize::from(finger)) else { return 0.0 };
        let carried = match other {
            Surface::Block(index) => state.bodies.get(usize::from(index)).map(|body| body.velocity_m_s),
            Surface::Handle => Some(state.crank.handle_velocity),
            Surface::Knob => Some(state.switch.knob_velocity),
            _ => None,
        };
        (tip - carried.unwrap_or_default()).dot(&contact.tangent()).abs()
    };
    let slipping = state.contacts.iter().filter(|c| c.sliding && c.normal_force_n > LEAST_N);
    slipping.map(speed).filter(|v| v.is_finite()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::Vec2;
    use haptics::world::{Input, presets, step};

    #[test]
    fn a_finger_that_is_drawn_along_the_table_slips_and_one_that_rests_on_it_does_not() {
        let world = presets::table();
        let floor_m = world.floor.as_ref().expect("a table").height_m;
        let mut state = State::resting(&world);
        let pressed = |speed_m_s: f64, state: &mut State| {
            for k in 0..300 {
                let x = speed_m_s * f64::from(k) * 1e-3;
                let tips = [Vec2::new(x - 0.02, floor_m - 2e-4), Vec2::new(0.05, floor_m + 0.05)];
                let velocity = [Vec2::new(speed_m_s, 0.0), Vec2::zeros()];
                step(&world, state, &Input { tip_in_world: tips, tip_velocity: velocity }, 1e-3);
            }
            slip_m_s(state)
        };
        assert!((pressed(0.05, &mut state) - 0.05).abs() < 1e-6);
        let mut state = State::resting(&world);
        assert_eq!(pressed(0.0, &mut state), 0.0);
    }
}
