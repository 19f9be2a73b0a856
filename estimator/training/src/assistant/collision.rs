//! Time until moving things run into something. Outlines are moved on at their present velocities until they meet.

use haptics::Vec2;
use haptics::world::{Rect, State, Surface, World};
use serde::Serialize;

/// Softer than this is a touch, m/s.
pub const GENTLE_M_S: f64 = 0.06;
/// Reaction time of a person who sees something coming, s.
const REACTION_S: f64 = 0.2;
/// Deceleration with which a person then brakes, m/s².
const BRAKE_M_S2: f64 = 1.0;
/// As good as touching, m.
const TOUCH_M: f64 = 3e-4;
/// Distance below which things touch already, m.
const CONTACT_M: f64 = 5e-4;
/// Steps of a search.
const STEPS: usize = 24;

/// Something is about to hit something.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Collision {
    /// Point of the moving thing, m in the world.
    pub from_m: Vec2,
    /// Point of the obstacle, m in the world.
    pub to_m: Vec2,
    /// Time until the impact, s, and its standard error by the sensors and the lateness of the picture.
    pub in_s: (f64, f64),
    /// Speed of the impact, m/s.
    pub speed_m_s: f64,
}

/// An outline.
#[derive(Clone, Copy, Debug)]
enum Outline {
    /// A disc; a point when its radius is zero.
    Disc(Vec2, f64),
    Box(Rect),
    /// Everything below a line: a point of it, and its normal out of the solid.
    Half(Vec2, Vec2),
}

impl Outline {
    fn moved(self, by: Vec2) -> Self {
        match self {
            Self::Disc(center, radius) => Self::Disc(center + by, radius),
            Self::Box(rect) => Self::Box(Rect { center_m: rect.center_m + by, ..rect }),
            Self::Half(point, normal) => Self::Half(point + by, normal),
        }
    }
}

/// Distance between two outlines, m, negative inside, and the nearest points of the first and the second.
fn gap(a: &Outline, b: &Outline) -> (f64, Vec2, Vec2) {
    match (a, b) {
        (Outline::Disc(center, radius), Outline::Half(point, normal)) => {
            let height = (center - point).dot(normal);
            (height - radius, center - normal * *radius, center - normal * height)
        }
        (Outline::Disc(c, r), Outline::Disc(d, s)) => {
            let way = d - c;
            let along = way.try_normalize(1e-12).unwrap_or(Vec2::x());
            (way.norm() - r - s, c + along * *r, d - along * *s)
        }
        (Outline::Disc(center, radius), Outline::Box(rect)) => {
            let near = nearest(rect, *center);
            let way = near - center;
            let along = way.try_normalize(1e-12).unwrap_or(Vec2::x());
            (way.norm() - radius, center + along * *radius, near)
        }
        (Outline::Box(rect), Outline::Half(point, normal)) => corners(rect)
            .map(|c| ((c - point).dot(normal), c))
            .into_iter()
            .min_by(|x, y| x.0.total_cmp(&y.0))
            .map_or((f64::INFINITY, *point, *point), |(height, c)| (height, c, c - normal * height)),
        (Outline::Box(r), Outline::Box(s)) => {
            let there = corners(r).map(|c| (c, nearest(s, c)));
            let back = corners(s).map(|c| (nearest(r, c), c));
            let all = there.into_iter().chain(back).map(|(p, q)| ((q - p).norm(), p, q));
            all.min_by(|x, y| x.0.total_cmp(&y.0)).unwrap_or((f64::INFINITY, r.center_m, s.center_m))
        }
        (_, Outline::Disc(..)) | (Outline::Half(..), _) => {
            if matches!((a, b), (Outline::Half(..), Outline::Half(..))) {
                return (f64::INFINITY, Vec2::zeros(), Vec2::zeros());
            }
            let (far, p, q) = gap(b, a);
            (far, q, p)
        }
    }
}

fn corners(rect: &Rect) -> [Vec2; 4] {
    [0, 1, 2, 3].map(|k| rect.corner(k))
}

/// The point of a rectangle nearest to a point; the point itself inside.
fn nearest(rect: &Rect, point: Vec2) -> Vec2 {
    let local = rect.to_local(point);
    let kept = Vec2::new(local.x.clamp(-rect.half_m.x, rect.half_m.x), local.y.clamp(-rect.half_m.y, rect.half_m.y));
    rect.center_m + rect.axis_x * kept.x + rect.axis_y() * kept.y
}

/// A thing that moves by itself or with the hand.
struct Thing {
    outline: Outline,
    velocity_m_s: Vec2,
    /// Whose it is, so that nothing meets itself.
    surface: Surface,
}

/// The next thing that the hand, or an object in it, will hit too fast; `late_s`: age of the picture; `position_m`:
/// error of places.
pub fn next(world: &World, state: &State, late_s: f64, position_m: f64) -> Option<Collision> {
    let held = held(state);
    let (movers, others) = things(world, state, held);
    let mut soonest: Option<Collision> = None;
    for mover in &movers {
        for other in &others {
            if touching(state, mover.surface, other.surface) {
                continue;
            }
            let met = meet(mover, other, late_s, position_m);
            if let Some(met) = met.filter(|m| soonest.is_none_or(|s| m.in_s.0 < s.in_s.0)) {
                soonest = Some(met);
            }
        }
    }
    soonest
}

/// The body between both fingers.
pub fn held(state: &State) -> Option<usize> {
    let by = |finger: u8| {
        state.contacts.iter().filter_map(move |c| match (c.on, c.by) {
            (Surface::Finger(f), Surface::Block(k)) | (Surface::Block(k), Surface::Finger(f)) if f == finger => {
                Some(usize::from(k))
            }
            _ => None,
        })
    };
    by(0).find(|k| by(1).any(|other| other == *k))
}

fn touching(state: &State, a: Surface, b: Surface) -> bool {
    state.contacts.iter().any(|c| (c.on, c.by) == (a, b) || (c.on, c.by) == (b, a))
}

fn things(world: &World, state: &State, held: Option<usize>) -> (Vec<Thing>, Vec<Thing>) {
    let mut movers: Vec<Thing> = (0..2_u8)
        .map(|finger| Thing {
            outline: Outline::Disc(state.input.tip_in_world[usize::from(finger)], 0.0),
            velocity_m_s: state.input.tip_velocity[usize::from(finger)],
            surface: Surface::Finger(finger),
        })
        .collect();
    let mut others = fixed(world, state);
    for (k, (block, body)) in world.blocks.iter().zip(&state.bodies).enumerate() {
        let (sin, cos) = body.angle_rad.sin_cos();
        let half_m = 0.5 * Vec2::new(block.width_m, block.height_m);
        let outline = Outline::Box(Rect { center_m: body.center_m, half_m, axis_x: Vec2::new(cos, sin) });
        let surface = u16::try_from(k).map_or(Surface::Floor, Surface::Block);
        let thing = Thing { outline, velocity_m_s: body.velocity_m_s, surface };
        if held == Some(k) { movers.push(thing) } else { others.push(thing) }
    }
    if held.is_some() {
        // Held objects go with the fingers: things beside them matter, things between them do not.
        movers.retain(|m| !matches!(m.surface, Surface::Finger(_)) || m.velocity_m_s.norm() > GENTLE_M_S);
    }
    (movers, others)
}

/// Things that are fixed, or turn about an axis.
fn fixed(world: &World, state: &State) -> Vec<Thing> {
    let still = |outline: Outline, surface: Surface| Thing { outline, velocity_m_s: Vec2::zeros(), surface };
    let mut all = Vec::new();
    if let Some(floor) = &world.floor {
        all.push(still(Outline::Half(Vec2::new(0.0, floor.height_m), Vec2::y()), Surface::Floor));
    }
    if let Some(plane) = &world.plane {
        all.push(still(Outline::Half(plane.point_m, plane.normal.normalize()), Surface::Plane));
    }
    if let Some((crank, at)) = world.crank.as_ref().zip(state.handle_in_world(world)) {
        all.push(Thing {
            outline: Outline::Disc(at, 0.5 * crank.handle_width_m),
            velocity_m_s: state.crank.handle_velocity,
            surface: Surface::Handle,
        });
    }
    if let Some(switch) = &world.switch {
        all.push(Thing {
            outline: Outline::Disc(switch.knob_in_world(state.switch.at_m), switch.knob_radius_m),
            velocity_m_s: state.switch.knob_velocity,
            surface: Surface::Knob,
        });
    }
    all
}

/// Moves both on until they meet (conservative advancement): no step is longer than the gap allows.
fn meet(mover: &Thing, other: &Thing, late_s: f64, position_m: f64) -> Option<Collision> {
    let velocity = mover.velocity_m_s - other.velocity_m_s;
    let speed = velocity.norm();
    if speed < GENTLE_M_S || gap(&mover.outline, &other.outline).0 < CONTACT_M {
        return None;
    }
    let horizon_s = REACTION_S + late_s + 0.5 * speed / BRAKE_M_S2;
    let mut time_s = 0.0;
    for _ in 0..STEPS {
        let (far, from, to) = gap(&mover.outline.moved(velocity * time_s), &other.outline);
        if far < TOUCH_M {
            // The speed into the surface counts; sliding along it is no blow.
            let direction = (to - from).try_normalize(1e-9).unwrap_or_else(|| velocity / speed);
            let into_m_s = velocity.dot(&direction);
            let error_s = position_m.hypot(late_s * GENTLE_M_S) / speed;
            let from_m = from - velocity * time_s;
            let met = Collision { from_m, to_m: to, in_s: (time_s, error_s), speed_m_s: into_m_s };
            return (into_m_s > GENTLE_M_S).then_some(met);
        }
        time_s += far / speed;
        if time_s > horizon_s {
            return None;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::world::presets;

    fn moving(tip: Vec2, velocity: Vec2) -> (World, State) {
        let world = presets::stacking();
        let mut state = State::resting(&world);
        state.input.tip_in_world = [tip, Vec2::new(0.08, -0.01)];
        state.input.tip_velocity = [velocity, Vec2::zeros()];
        (world, state)
    }

    #[test]
    fn a_fast_finger_above_the_table_is_warned_and_a_slow_or_leaving_one_is_not() {
        let floor_m = presets::stacking().floor.expect("a table").height_m;
        let tip = Vec2::new(-0.09, floor_m + 0.02);
        let (world, state) = moving(tip, Vec2::new(0.0, -0.2));
        let met = next(&world, &state, 0.0, 2e-4).expect("it will hit the table");
        assert!((met.in_s.0 - 0.1).abs() < 0.005 && (met.speed_m_s - 0.2).abs() < 1e-6, "{met:?}");
        assert!((met.to_m - Vec2::new(-0.09, floor_m)).norm() < 1e-3);
        for velocity in [Vec2::new(0.0, -0.03), Vec2::new(0.0, 0.2), Vec2::new(-0.2, 0.0)] {
            let (world, state) = moving(tip, velocity);
            assert_eq!(next(&world, &state, 0.0, 2e-4), None, "{velocity:?}");
        }
    }

    #[test]
    fn a_late_picture_warns_earlier_and_says_how_unsure_it_is() {
        let floor_m = presets::stacking().floor.expect("a table").height_m;
        let (world, state) = moving(Vec2::new(-0.09, floor_m + 0.05), Vec2::new(0.0, -0.12));
        assert_eq!(next(&world, &state, 0.0, 2e-4), None, "time enough to see it");
        let late = next(&world, &state, 0.25, 2e-4).expect("too late to see it");
        assert!(late.in_s.1 > 0.1, "{late:?}");
    }

    #[test]
    fn a_finger_beside_a_block_meets_its_side_only_when_it_goes_there() {
        let world = presets::stacking();
        let state = State::resting(&world);
        let block = &world.blocks[0];
        let beside = state.bodies[0].center_m - Vec2::new(0.5 * block.width_m + 0.01, 0.0);
        let (world, down) = moving(beside, Vec2::new(0.0, 0.15));
        assert_eq!(next(&world, &down, 0.0, 2e-4), None);
        let (world, into) = moving(beside, Vec2::new(0.15, 0.0));
        let met = next(&world, &into, 0.0, 2e-4).expect("it hits the block");
        assert!((met.in_s.0 - 0.0667).abs() < 0.005, "{met:?}");
    }
}
