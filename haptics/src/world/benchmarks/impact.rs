//! Impacts: energy after a bounce, flat and on a corner, and the absence of loss in an undamped one.

use super::super::*;
use super::AWAY;
use crate::Vec2;
use crate::law::contact::VelocityLoss;

const SIDE_M: f64 = 0.02;

/// A block of 20 mm and 50 g, turned by `angle_rad`, its lowest corner `height_m` above a smooth floor of restitution `e`.
fn above(e: f64, angle_rad: f64, height_m: f64) -> (World, State) {
    let mut world = World::empty("impact");
    world.floor = Some(Floor { height_m: 0.0, loss: Some(VelocityLoss { e, mu: 0.0 }), ..Floor::default() });
    let mut block = Block::upright("block-1", 0.05, SIDE_M, SIDE_M, 0.0, 0.0);
    let reach_m = 0.5 * SIDE_M * (angle_rad.sin().abs() + angle_rad.cos().abs());
    block.start = Pose { center_m: Vec2::new(0.0, height_m + reach_m), angle_rad };
    world.blocks = vec![block];
    world.check().expect("a valid world");
    let state = State::new(&world, AWAY);
    (world, state)
}

/// Kinetic and potential energy, J: all there is while nothing touches.
fn energy(world: &World, state: &State) -> f64 {
    let (block, body) = (&world.blocks[0], &state.bodies[0]);
    0.5 * block.mass_kg * body.velocity_m_s.norm_squared()
        + 0.5 * block.inertia_kg_m2() * body.rate_rad_s.powi(2)
        + block.mass_kg * world.gravity_m_s2 * body.center_m.y
}

/// Height of the lowest corner, m, and its velocity, m/s.
fn lowest(body: &BodyState) -> (f64, f64) {
    let (sin, cos) = body.angle_rad.sin_cos();
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| {
        let arm = 0.5 * SIDE_M * Vec2::new(x * cos - y * sin, x * sin + y * cos);
        (body.center_m.y + arm.y, body.velocity_m_s.y + body.rate_rad_s * arm.x)
    });
    corners.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).expect("four corners")
}

/// Energies between the bounces of `seconds`, J, from the start on.
fn energies(world: &World, state: &mut State, dt_s: f64, seconds: f64) -> Vec<f64> {
    let input = state.input;
    let (mut found, mut touched) = (vec![energy(world, state)], false);
    for _ in 0..(seconds / dt_s) as usize {
        step(world, state, &input, dt_s);
        let up = lowest(&state.bodies[0]).0 > 1e-4 && state.contacts.is_empty();
        if up && touched {
            found.push(energy(world, state));
        }
        touched = !up && (touched || !state.contacts.is_empty());
    }
    found
}

/// Largest gain and loss at a bounce, as shares of the energy above rest at the start, and the whole change. The block
/// is undamped and released at several heights and phases of the tick.
fn changes(angle_rad: f64, rate_hz: f64) -> (f64, f64, f64) {
    let (mut gain, mut loss, mut drift, mut bounces) = (0.0_f64, 0.0_f64, 0.0_f64, 0);
    for height_m in [0.005, 0.02, 0.05, 0.1_f64] {
        for phase in 0..5 {
            let landing_m_s = (2.0 * 9.81 * height_m).sqrt();
            let (world, mut state) = above(1.0, angle_rad, height_m + 0.2 * f64::from(phase) * landing_m_s / rate_hz);
            let found = energies(&world, &mut state, 1.0 / rate_hz, 1.5);
            let whole = found[0] - world.blocks[0].mass_kg * 9.81 * 0.5 * SIDE_M;
            for pair in found.windows(2) {
                gain = gain.max((pair[1] - pair[0]) / whole);
                loss = loss.max((pair[0] - pair[1]) / whole);
            }
            drift = drift.max((found[found.len() - 1] / found[0] - 1.0).abs() * found[0] / whole);
            bounces += found.len() - 1;
        }
    }
    assert!(bounces > 200, "only {bounces} bounces");
    (gain, loss, drift)
}

#[test]
fn an_undamped_block_bounces_without_gaining_or_losing() {
    for (rate_hz, most_lost) in [(1e3, 4e-3), (2e3, 1.5e-3), (4e3, 1.5e-3), (1e4, 3e-4)] {
        for angle_rad in [0.0, 0.1, 0.3, 0.785] {
            let (gain, loss, drift) = changes(angle_rad, rate_hz);
            let scene = format!("{angle_rad} rad at {rate_hz} Hz");
            assert!(gain < 1e-3, "{scene} gains {gain} of its energy at a bounce");
            assert!(loss < most_lost, "{scene} loses {loss} of its energy at a bounce");
            // Changes at single bounces do not add up.
            assert!(drift < 1e-2, "{scene} ends {drift} off after all its bounces");
        }
    }
}

/// Speed at which the lowest corner leaves over that at which it came, without gravity.
fn corner_restitution(e: f64, angle_rad: f64, rate_hz: f64, phase: f64) -> f64 {
    const SPEED_M_S: f64 = 0.05;
    let (mut world, mut state) = above(e, angle_rad, 0.0005 + phase * SPEED_M_S / rate_hz);
    // Stiff enough for a short impact: while it lasts, the turning body carries its corner round by itself, v (ω t)².
    world.floor.as_mut().expect("there is one").stiffness_n_m = 20_000.0;
    world.gravity_m_s2 = 0.0;
    state.bodies[0].velocity_m_s.y = -SPEED_M_S;
    let (input, mut touched) = (state.input, false);
    for _ in 0..(0.5 * rate_hz) as usize {
        step(&world, &mut state, &input, 1.0 / rate_hz);
        touched |= !state.contacts.is_empty();
        if touched && state.contacts.is_empty() {
            return lowest(&state.bodies[0]).1 / SPEED_M_S;
        }
    }
    panic!("it never left the floor")
}

#[test]
fn a_corner_lands_with_the_same_restitution_as_a_face() {
    // Newton's law holds for the point that touches: e of its approach speed, whatever mass it has behind it. On a corner
    // that is 1/(1/m + r²/I), down to 0.4 m for this block.
    for e in [0.2, 0.5, 0.8] {
        for degrees in [0.0, 5.0, 20.0, 45.0_f64] {
            for rate_hz in [1e3, 4e3, 1e5] {
                for phase in [0.0, 0.25, 0.5, 0.75] {
                    let found = corner_restitution(e, degrees.to_radians(), rate_hz, phase);
                    assert!((found - e).abs() < 0.03, "{found} of {e} at {degrees}° and {rate_hz} Hz");
                }
            }
        }
    }
}

#[test]
fn a_block_that_lands_while_it_slides_stops_when_paper_says() {
    // The floor's impulse on a body that ends at rest is its weight times the time, however it bounces and turns. The
    // friction of a sliding body has mu of that: v = mu g t, counted from its release.
    const SPEED_M_S: f64 = 1.2;
    const MU: f64 = 0.2;
    for e in [0.02, 0.1, 0.3, 0.5] {
        // Squares and low slabs; tall blocks where they do not bounce, because a corner that rocks does not only slide forwards.
        let shapes = [(0.0, 1.0), (3.0, 1.0), (9.0_f64, 1.0), (0.0, 3.0), (3.0, 3.0), (0.0, 0.5)];
        for (degrees, width) in shapes.into_iter().filter(|(_, width)| *width >= 1.0 || e < 0.2) {
            for rate_hz in [1e3, 8e3] {
                let (mut world, mut state) = above(e, degrees.to_radians(), 0.05);
                world.floor.as_mut().expect("there is one").loss = Some(VelocityLoss { e, mu: MU });
                world.blocks[0].block_friction = MU;
                world.blocks[0].width_m *= width;
                state.bodies[0].velocity_m_s.x = SPEED_M_S;
                let input = state.input;
                let slides = |state: &State| state.bodies[0].velocity_m_s.x > 1e-3;
                let mut ticks = 0;
                while slides(&state) && f64::from(ticks) < 2.0 * rate_hz {
                    step(&world, &mut state, &input, 1.0 / rate_hz);
                    ticks += 1;
                }
                let (took_s, paper_s) = (f64::from(ticks) / rate_hz, SPEED_M_S / (MU * 9.81));
                assert!(
                    (took_s / paper_s - 1.0).abs() < 0.02,
                    "{took_s} s, not {paper_s} s, with e = {e} at {degrees}°, {width} times as wide as high, at {rate_hz} Hz"
                );
            }
        }
    }
}

#[test]
fn a_corner_landing_takes_the_energy_that_paper_says() {
    // Falling at v, turned by 20°, the corner touches r = (5.98, −12.8) mm from the centre. The impulse (1 + e) v m_eff leaves
    // 1 − (1 − e²) m_eff/m of the energy, with m_eff/m = 1/(1 + 6 · (5.98/20)²) = 0.651 for a square (I = m a²/6).
    for (e, left) in [(0.2, 0.3749), (0.5, 0.5117), (0.8, 0.7656)] {
        let (mut world, mut state) = above(e, 20.0_f64.to_radians(), 0.0005);
        world.floor.as_mut().expect("there is one").stiffness_n_m = 20_000.0;
        world.gravity_m_s2 = 0.0;
        state.bodies[0].velocity_m_s.y = -0.1;
        let before = energy(&world, &state);
        let input = state.input;
        // 5 ms to the floor, 2 ms on it; the next corner comes later.
        for _ in 0..9 {
            step(&world, &mut state, &input, 1e-3);
        }
        let share = energy(&world, &state) / before;
        assert!((share - left).abs() < 0.02, "{share} left with e = {e}, not {left}");
    }
}
