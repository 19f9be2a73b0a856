//! A constraint as a world that can be felt: a slider on a guide of its shape, in the middle of the hand's workspace.

use foundation::estimate::{Constraint, ConstraintKind};
use haptics::Vec2;
use haptics::world::{Block, Guide, Plane, World};
use nalgebra::Vector3;

/// Control points of an arc, a turn.
const POINTS_A_TURN: f64 = 24.0;
/// Share of the workspace's width that the path may take.
const ROOM: f64 = 1.5;
/// The slider, m and kg.
const SLIDER_M: f64 = 0.012;
const SLIDER_KG: f64 = 0.04;
/// Stiffness across the guide where it is rigid, N/m, and its damping, N s/m.
const STIFFNESS_N_M: f64 = 4000.0;
const DAMPING_N_S_M: f64 = 6.0;
/// More friction than this would only be a fight, N.
const MOST_FRICTION_N: f64 = 2.0;

/// Puts a slider on the path of `constraint` into `world`; `friction_n`: along it. Returns the scale of the path (1: true size),
/// or `None` when the constraint has no path that can be put into a plane.
pub fn add(world: &mut World, constraint: &Constraint, friction_n: f64) -> Option<f64> {
    let (points, closed) = path(constraint)?;
    let (mut low, mut high) = (Vec2::repeat(f64::INFINITY), Vec2::repeat(f64::NEG_INFINITY));
    for p in &points {
        (low, high) = (low.inf(p), high.sup(p));
    }
    let room = ROOM * world.hand.workspace.radius_m;
    let scale = (room / (high - low).norm().max(1e-9)).min(1.0);
    let middle = world.hand.workspace.center_m;
    let points_m: Vec<Vec2> = points.iter().map(|p| middle + (p - 0.5 * (low + high)) * scale).collect();
    let softer = constraint.yielding.and_then(|y| y.stiffness_n_m).filter(|_| constraint.rigid == Some(false));
    let guide = Guide {
        points_m,
        closed,
        stiffness_n_m: softer.unwrap_or(STIFFNESS_N_M).clamp(50.0, STIFFNESS_N_M),
        damping_n_s_m: DAMPING_N_S_M,
        friction_n: friction_n.clamp(0.0, MOST_FRICTION_N),
    };
    let start = guide.point(0.5 * guide.pieces() as f64).0;
    let mut slider = Block::upright("slider", SLIDER_KG, SLIDER_M, SLIDER_M, start.x, start.y - 0.5 * SLIDER_M);
    slider.guide = Some(guide);
    world.floor = None;
    world.blocks.push(slider);
    world.check().is_ok().then_some(scale).or_else(|| {
        world.blocks.pop();
        None
    })
}

/// Share of the workspace's radius by which a surface lies below its middle, along the normal.
const SURFACE_SHARE: f64 = 0.4;
/// Stiffness of a surface that is rigid, N/m, its damping under blocks, N s/m, and friction where nothing slid on it.
const SURFACE_N_M: f64 = 8000.0;
const SURFACE_N_S_M: f64 = 6.0;
const SURFACE_FRICTION: f64 = 0.4;

/// Puts the surface of `constraint` into `world`, slanted as it was found; `up`: upwards in the recording, zero in a level plane. A
/// surface in space is cut along its steepest line. Returns whether there was one.
pub fn add_surface(world: &mut World, constraint: &Constraint, up: Vector3<f64>) -> bool {
    let Some(surface) = constraint.surface.as_ref().filter(|_| constraint.kind == ConstraintKind::Unilateral) else {
        return false;
    };
    let normal = vector(&surface.normal);
    let flat = if normal.z == 0.0 {
        Vec2::new(normal.x, normal.y)
    } else {
        let rise = up.dot(&normal);
        Vec2::new((normal - up * rise).norm(), rise)
    };
    let Some(normal) = flat.try_normalize(1e-6) else { return false };
    let softer = constraint.yielding.and_then(|y| y.stiffness_n_m).filter(|_| constraint.rigid == Some(false));
    let room = &world.hand.workspace;
    let plane = Plane {
        point_m: room.center_m - normal * (SURFACE_SHARE * room.radius_m),
        normal,
        stiffness_n_m: softer.unwrap_or(SURFACE_N_M).clamp(20.0, SURFACE_N_M),
        damping_n_s_m: SURFACE_N_S_M,
        friction: surface.friction.unwrap_or(SURFACE_FRICTION).clamp(0.0, 2.0),
    };
    let before = (world.floor.take(), world.plane.replace(plane));
    let fine = world.check().is_ok();
    if !fine {
        (world.floor, world.plane) = before;
    }
    fine
}

/// The path in its own plane, m: x and y as recorded where it is planar.
fn path(constraint: &Constraint) -> Option<(Vec<Vec2>, bool)> {
    match constraint.kind {
        ConstraintKind::Spline => {
            let guide = constraint.guide.as_ref()?;
            let points: Vec<Vector3<f64>> = guide.points_m.iter().map(|p| vector(p)).collect();
            Some((flat(&points), guide.closed))
        }
        ConstraintKind::Prismatic => {
            let direction = vector(constraint.direction.as_ref()?);
            let half = 0.5 * constraint.coverage_m?;
            Some((flat(&[-direction * half, direction * half]), false))
        }
        ConstraintKind::Revolute => {
            let (radius, turned) = (constraint.radius_m?, constraint.coverage_rad?);
            let closed = turned >= std::f64::consts::TAU;
            let turned = turned.min(std::f64::consts::TAU);
            let n = ((POINTS_A_TURN * turned / std::f64::consts::TAU).ceil() as usize).max(4);
            // A cubic B-spline runs a little inside its control points: by (1 − cos Δ)/3 for steps of Δ.
            let step = turned / if closed { n } else { n - 1 } as f64;
            let outside = radius / (1.0 - (1.0 - step.cos()) / 3.0);
            let start = -std::f64::consts::FRAC_PI_2 - 0.5 * turned;
            let at = |k: usize| Vec2::new((start + step * k as f64).cos(), (start + step * k as f64).sin()) * outside;
            Some(((0..n).map(at).collect(), closed))
        }
        _ => None,
    }
}

fn vector(values: &[f64]) -> Vector3<f64> {
    let at = |i: usize| values.get(i).copied().unwrap_or(0.0);
    Vector3::new(at(0), at(1), at(2))
}

/// Points of a plane in space in that plane; as they are when it is x-y.
fn flat(points: &[Vector3<f64>]) -> Vec<Vec2> {
    if points.iter().all(|p| p.z == 0.0) {
        return points.iter().map(|p| Vec2::new(p.x, p.y)).collect();
    }
    let origin = points.iter().sum::<Vector3<f64>>() / points.len().max(1) as f64;
    let far = |d: &dyn Fn(&Vector3<f64>) -> f64| points.iter().max_by(|a, b| d(a).total_cmp(&d(b))).copied();
    let first = far(&|p| (p - origin).norm()).map_or_else(Vector3::x, |p| (p - origin).normalize());
    let aside = |p: &Vector3<f64>| (p - origin) - first * first.dot(&(p - origin));
    let second = far(&|p| aside(p).norm()).and_then(|p| aside(&p).try_normalize(1e-12)).unwrap_or_else(Vector3::zeros);
    points.iter().map(|p| Vec2::new(first.dot(&(p - origin)), second.dot(&(p - origin)))).collect()
}
