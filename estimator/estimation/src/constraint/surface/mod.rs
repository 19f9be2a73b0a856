//! A surface that pushes one way: a tool, or a carried object, presses on a table or a wall, slides along it and comes
//! off.
//!
//! Force splits the recording into contact and free motion. A surface has three signs. In contact the position follows
//! a plane, deeper under a harder push. The push never turns into a pull. Off the plane, on the free side, nothing
//! holds the tool. All three are required: a rail pulled from one side only, or a spring, has no free side and is not
//! called a surface. The reality of the push is a test with a stated rate of false alarms ([`test`]).

mod fit;
mod friction;
mod split;
mod test;

pub use friction::Rubbing;
pub use split::Pressed;

use super::existence::FALSE_ALARMS;
use super::yielding::{Manipulator, judge};
use fit::Plane;
use foundation::estimate::{Constraint, ConstraintKind, Sided, Touched};
use nalgebra::Vector3;
use split::Split;

/// Stiffness of a hand of which nothing is known, N/m.
const HAND_N_M: f64 = 2000.0;
/// Largest distance from the plane of contact: in multiples of the noise, as a share of the way along it, or in m.
const CLOSE_NOISES: f64 = 5.0;
const CLOSE_SHARE: f64 = 0.01;
const CLOSE_M: f64 = 3e-4;
/// Least distance of the tool off the plane, m; `OFF_NOISES`: the same in multiples of the distance from it in contact.
const OFF_M: f64 = 1e-3;
const OFF_NOISES: f64 = 5.0;
/// Free samples behind the plane, beside where it was touched, that speak against it: a share of all free ones.
const BEHIND_SHARE: f64 = 0.02;
/// Angle that friction could turn a push by where the tool never slid, rad (a coefficient of 0.5).
const CONE_RAD: f64 = 0.46;

/// The surface that `pressed` shows, if it shows one; `name`: of the recording.
pub fn find(pressed: &Pressed<'_>, name: Option<String>) -> Option<Constraint> {
    let split = Split::of(pressed)?;
    let plane = Plane::fit(pressed, &split)?;
    let close = (CLOSE_NOISES * split.position_noise_m).max(CLOSE_SHARE * plane.reach_m).max(CLOSE_M);
    if plane.rms_m > close || plane.bends(close) {
        return None;
    }
    let off = OFF_M.max(OFF_NOISES * plane.rms_m);
    let height: Vec<f64> = pressed.points.iter().map(|p| plane.height_m(p)).collect();
    let free: Vec<usize> = (0..height.len()).filter(|&i| split.free[i]).collect();
    let above = free.iter().filter(|&&i| height[i] > off).count();
    let under = free.iter().filter(|&&i| height[i] < -off && plane.beside(&pressed.points[i])).count();
    if above < split::LEAST_SAMPLES || under as f64 > BEHIND_SHARE * free.len() as f64 {
        return None;
    }
    let existence = test::existence(pressed, &split, &plane)?;
    if existence.exists != Some(true) {
        return None;
    }
    let rubbing = friction::rubbing(pressed, &split, &plane);
    let numbers =
        |v: Vector3<f64>| -> Vec<f64> { v.iter().take(if pressed.planar { 2 } else { 3 }).copied().collect() };
    let tilt = if plane.slid { plane.tilt_error_rad } else { plane.tilt_error_rad.hypot(CONE_RAD / 2.0) };
    let mut found = Constraint::blank(name, &sentence(&plane, &existence, pressed, above));
    found.kind = ConstraintKind::Unilateral;
    found.direction = Some(numbers(plane.normal));
    found.std_error = [("direction_rad".to_owned(), tilt), ("point_m".to_owned(), plane.offset_error_m)].into();
    found.coverage_m = Some(plane.reach_m);
    found.residual_m = Some(plane.rms_m);
    found.constraint_force_n = Some(existence.unexplained_n);
    found.existence = Some(existence);
    found.sided = Some(Sided::OneSided);
    if let Some((give, error)) = plane.give_m_n {
        let hand = Manipulator { stiffness_n_m: HAND_N_M, give_m_n: (0.0, 0.0) };
        (found.rigid, found.yielding) = judge(give, error, &hand);
    }
    found.surface = Some(Touched {
        point_m: numbers(plane.point_m()),
        normal: numbers(plane.normal),
        offset_std_error_m: plane.offset_error_m,
        tilt_std_error_rad: tilt,
        friction: rubbing.map(|r| r.coefficient),
        friction_std_error: rubbing.map(|r| r.std_error),
        touched_from_m: numbers(plane.touched[0]),
        touched_to_m: numbers(plane.touched[1]),
    });
    Some(found)
}

fn sentence(plane: &Plane, existence: &foundation::estimate::Existence, pressed: &Pressed<'_>, above: usize) -> String {
    let slid = if plane.slid {
        format!("slides over {:.0} mm of it within {:.2} mm", 1e3 * plane.reach_m, 1e3 * plane.rms_m)
    } else {
        "never slides along it, so that its slant is known from the push only".to_owned()
    };
    format!(
        "something pushes with {:.3} ± {:.3} N where the tool is at a plane and with nothing in {above} of {} samples off it (p {}, false \
         alarms {:.0} %); the tool {slid}, and is never pulled",
        existence.unexplained_n,
        existence.std_error_n,
        pressed.points.len(),
        super::existence::probability(existence.p_value),
        100.0 * FALSE_ALARMS
    )
}
