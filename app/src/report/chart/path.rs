//! The path in space, with the detected constraints. Both axes have the same scale.

use super::bad;
use crate::report::chart::frame::{Frame, key, range_of};
use crate::ui::document::prepared::Prepared;
use estimator::estimate::{Constraint, ConstraintKind};
use haptics::Vec2;
use haptics::world::Guide;
use maud::{Markup, html};
use std::f64::consts::TAU;

/// Sides of the picture.
const SIZE: (f64, f64) = (470.0, 330.0);
/// Number of segments of a drawn circle.
const PIECES: u32 = 96;

/// Picture of the path; `None` if nothing moves in space.
pub fn path(prepared: &Prepared, constraints: &[&Constraint]) -> Option<Markup> {
    let points: Vec<Vec2> =
        prepared.path_samples.iter().filter_map(|&i| prepared.point_at(i)).map(|p| 1e3 * p).collect();
    if points.len() < 2 {
        return None;
    }
    let shapes: Vec<Shape> = constraints.iter().filter_map(|c| Shape::of(c, &points)).collect();
    let frame = frame(&points, &shapes);
    let inside = html! {
        @for shape in &shapes {
            path class="line found" style="stroke:var(--constraint)" d=(frame.line(shape.line.iter().map(|p| (p.x, p.y)))) {}
            @if let Some(center) = shape.center {
                @let (x, y) = (frame.right(center.x), frame.down(center.y));
                path class="line" style="stroke:var(--constraint);stroke-width:2"
                    d=(format!("M{:.1} {y:.1}h12M{x:.1} {:.1}v12", x - 6.0, y - 6.0)) {}
            }
        }
        path class="line" style="stroke:var(--measured)" d=(frame.line(course(prepared))) {}
    };
    let found = shapes.iter().map(|s| s.name).next();
    Some(html! {
        figure class="place" {
            figcaption {
                b { "Path, mm" }
                span class="keys" {
                    (key("measured", "measured"))
                    @if let Some(name) = found { (key("constraint", name)) }
                }
            }
            (frame.draw("Path through space, with what constrains it", &inside))
        }
    })
}

/// Points of the path, mm, with a NaN point in every gap.
fn course(prepared: &Prepared) -> impl Iterator<Item = (f64, f64)> {
    let runs = bad::stretches(prepared);
    let run = move |i: usize| runs.partition_point(|r| r.end <= i);
    let mut before = None;
    prepared.path_samples.iter().flat_map(move |&i| {
        let here = run(i);
        let broken = before.replace(here).is_some_and(|b| b != here);
        let place = prepared.point_at(i).map(|p| (1e3 * p.x, 1e3 * p.y));
        [broken.then_some((f64::NAN, f64::NAN)), place].into_iter().flatten()
    })
}

/// Drawing of a constraint, mm.
struct Shape {
    name: &'static str,
    line: Vec<Vec2>,
    center: Option<Vec2>,
}

impl Shape {
    fn of(constraint: &Constraint, points: &[Vec2]) -> Option<Self> {
        match constraint.kind {
            ConstraintKind::Revolute => circle(constraint),
            ConstraintKind::Prismatic => straight(constraint, points),
            ConstraintKind::Spline => guide(constraint),
            ConstraintKind::Unilateral => surface(constraint, points),
            _ => None,
        }
    }
}

/// Circle about its axis, in front view.
fn circle(constraint: &Constraint) -> Option<Shape> {
    let (center, radius) = (constraint.center_m.as_deref()?, constraint.radius_m?);
    let at = |v: &[f64], k: usize| v.get(k).copied().unwrap_or(0.0);
    let axis = constraint.direction.as_deref().filter(|d| d.len() == 3 && center.len() == 3);
    let axis = axis.map_or([0.0, 0.0, 1.0], |d| [d[0], d[1], d[2]]);
    let (u, v) = across(axis);
    let place = |k: u32| {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(PIECES)).sin_cos();
        let along = |i: usize| 1e3 * (at(center, i) + radius * (u[i] * cos + v[i] * sin));
        Vec2::new(along(0), along(1))
    };
    let center = 1e3 * Vec2::new(at(center, 0), at(center, 1));
    Some(Shape { name: "circle that was found", line: (0..=PIECES).map(place).collect(), center: Some(center) })
}

/// Two directions perpendicular to an axis and to each other.
fn across(axis: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let unit = |a: [f64; 3]| {
        let length = a.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-12);
        a.map(|x| x / length)
    };
    let axis = unit(axis);
    let other = if axis[0].abs() < 0.8 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let u = unit(cross(axis, other));
    (u, cross(axis, u))
}

/// Line through the middle of the path, as long as the path.
fn straight(constraint: &Constraint, points: &[Vec2]) -> Option<Shape> {
    let direction = constraint.direction.as_deref()?;
    let direction = Vec2::new(*direction.first()?, *direction.get(1)?);
    let middle = points.iter().sum::<Vec2>() / points.len() as f64;
    let squared = direction.norm_squared();
    if squared < 1e-9 {
        return None;
    }
    let along = |p: &Vec2| (p - middle).dot(&direction) / squared;
    let (low, high) = range_of(points.iter().map(along), 0.05);
    let line = vec![middle + direction * low, middle + direction * high];
    Some(Shape { name: "line that was found", line, center: None })
}

/// Curve of a guide, evaluated as in a world.
fn guide(constraint: &Constraint) -> Option<Shape> {
    let found = constraint.guide.as_ref()?;
    let points_m: Vec<Vec2> = found.points_m.iter().filter(|p| p.len() > 1).map(|p| Vec2::new(p[0], p[1])).collect();
    let guide = Guide { points_m, closed: found.closed, stiffness_n_m: 1.0, damping_n_s_m: 0.0, friction_n: 0.0 };
    let pieces = guide.pieces();
    let line = (0..=8 * pieces).map(|k| 1e3 * guide.point(k as f64 / 8.0).0).collect();
    (pieces > 0).then_some(Shape { name: "guide that was found", line, center: None })
}

/// Surface through the contact point, as long as the path.
fn surface(constraint: &Constraint, points: &[Vec2]) -> Option<Shape> {
    let touched = constraint.surface.as_ref()?;
    let two = |v: &[f64]| Some(Vec2::new(*v.first()?, *v.get(1)?));
    let (point, normal) = (1e3 * two(&touched.point_m)?, two(&touched.normal)?);
    let direction = Vec2::new(-normal.y, normal.x).try_normalize(1e-6)?;
    let (low, high) = range_of(points.iter().map(|p| (p - point).dot(&direction)), 0.05);
    let line = vec![point + direction * low, point + direction * high];
    Some(Shape { name: "surface that was found", line, center: None })
}

/// Ranges of path and shapes, with the same scale on both axes.
fn frame(points: &[Vec2], shapes: &[Shape]) -> Frame {
    // A circle much larger than its arc would leave nothing of the path visible.
    let seen = |pick: fn(&Vec2) -> f64| {
        let path = range_of(points.iter().map(pick), 0.0);
        let all = range_of(points.iter().chain(shapes.iter().flat_map(|s| &s.line)).map(pick), 0.0);
        let most = 4.0 * (path.1 - path.0).max(1e-3);
        if all.1 - all.0 > most { path } else { all }
    };
    let (x, y) = (seen(|p| p.x), seen(|p| p.y));
    let mut frame = Frame { size: SIZE, x, y, x_unit: Some("") };
    let (width, height) = frame.inner();
    let scale = 1.08 * ((x.1 - x.0) / width).max((y.1 - y.0) / height).max(1e-6);
    let about = |range: (f64, f64), length: f64| {
        let middle = 0.5 * (range.0 + range.1);
        (middle - 0.5 * scale * length, middle + 0.5 * scale * length)
    };
    (frame.x, frame.y) = (about(x, width), about(y, height));
    frame
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_is_round_and_goes_through_its_points() {
        let mut constraint = Constraint::blank(None, "");
        constraint.kind = ConstraintKind::Revolute;
        constraint.center_m = Some(vec![0.01, -0.02]);
        constraint.radius_m = Some(0.05);
        let shape = Shape::of(&constraint, &[]).expect("a circle");
        let center = shape.center.expect("a centre");
        assert!((center - Vec2::new(10.0, -20.0)).norm() < 1e-9);
        assert!(shape.line.iter().all(|p| ((p - center).norm() - 50.0).abs() < 1e-9));
        let frame = frame(&shape.line, std::slice::from_ref(&shape));
        let (wide, tall) = (frame.right(10.0) - frame.right(0.0), frame.down(0.0) - frame.down(10.0));
        assert!((wide - tall).abs() < 1e-9, "one scale: {wide} {tall}");
    }

    #[test]
    fn a_tilted_circle_is_an_ellipse() {
        let mut constraint = Constraint::blank(None, "");
        constraint.kind = ConstraintKind::Revolute;
        constraint.center_m = Some(vec![0.0, 0.0, 0.0]);
        constraint.direction = Some(vec![0.0, 1.0, 0.0]);
        constraint.radius_m = Some(0.1);
        let shape = Shape::of(&constraint, &[]).expect("a circle");
        assert!(shape.line.iter().all(|p| p.y.abs() < 1e-9), "seen from its edge");
    }
}
