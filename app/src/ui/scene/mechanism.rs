//! A recording of one coordinate without a position in space, shown as a carriage on a rail or as a crank on its shaft.
//! The sizes are chosen for the picture, since the recording has none. The rail is as long as the recorded travel.

use crate::text::format;
use crate::ui::document::prepared::Prepared;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::plots::axes::{decimals, marks};
use egui::{Align2, FontId, Pos2, Rect, Ui};
use haptics::Vec2;
use haptics::world::{Block, Guide, State, World, presets};
use render::{Camera, ColorRole, FingerStyle, ForceVector, ViewOptions};
use std::sync::Arc;

/// Half the length of the rail, m.
const HALF_RAIL_M: f64 = 0.034;
/// Carriage: width and height, m.
const CARRIAGE_M: [f64; 2] = [0.014, 0.010];
/// The rail's height above the table, m.
const ABOVE_TABLE_M: f64 = 0.018;
/// Length of the arrow of the largest force, m.
const ARROW_M: f64 = 0.022;
/// Approximate number of steps between the numbers along the rail.
const NUMBERS: f64 = 5.0;

/// One coordinate at the cursor.
pub struct Mechanism {
    /// World with the carriage or crank of the picture.
    pub world: Arc<World>,
    /// State at the coordinate.
    pub state: State,
    /// View options with the force arrow.
    pub options: ViewOptions,
    /// Camera that shows everything.
    pub camera: Camera,
    /// Force as text.
    force: Option<String>,
    /// Numbers along the rail: position and text.
    numbers: Vec<(Vec2, String)>,
}

impl Mechanism {
    /// Mechanism at the cursor; `None` if the recording has no coordinate.
    pub fn of(prepared: &Prepared, cursor_s: f64) -> Option<Self> {
        let recording = &prepared.recording;
        let sample = prepared.sample_at(cursor_s);
        let now = |name: &str| recording.channel(name).map(|values| (values[sample], most(values)));
        match (recording.channel("q_m"), recording.channel("q_rad")) {
            (Some(q), _) => Some(Self::rail(q, sample, now("f_N"))),
            (None, Some(q)) => Some(Self::shaft(q[sample], now("tau_Nm"))),
            (None, None) => None,
        }
    }

    fn rail(q: &[f64], sample: usize, force: Option<(f64, f64)>) -> Self {
        let finite = || q.iter().copied().filter(|v| v.is_finite());
        let (low, high) = (finite().fold(f64::MAX, f64::min), finite().fold(f64::MIN, f64::max));
        let mut world = World::empty("Rail");
        let floor_m = world.floor.as_ref().map_or(0.0, |floor| floor.height_m);
        let y = floor_m + ABOVE_TABLE_M;
        let end = HALF_RAIL_M + 0.5 * CARRIAGE_M[0];
        let points_m = vec![Vec2::new(-end, y), Vec2::new(end, y)];
        let mut carriage = Block::upright("carriage", 0.1, CARRIAGE_M[0], CARRIAGE_M[1], 0.0, y - 0.5 * CARRIAGE_M[1]);
        let guide = Guide { points_m, closed: false, stiffness_n_m: 1.0, damping_n_s_m: 0.0, friction_n: 0.0 };
        carriage.guide = Some(guide);
        world.blocks = vec![carriage];
        let x_of = |value: f64| HALF_RAIL_M * (2.0 * (value - low) / (high - low).max(1e-12) - 1.0).clamp(-1.0, 1.0);
        let mut state = State::resting(&world);
        let at = Vec2::new(if q[sample].is_finite() { x_of(q[sample]) } else { 0.0 }, y);
        if let Some(body) = state.bodies.first_mut() {
            body.center_m = at;
        }
        let along = Vec2::new(1.0, 0.0);
        let round = if low < high { marks((1e3 * low, 1e3 * high), NUMBERS) } else { Vec::new() };
        let numbers = round.into_iter().map(|mark| {
            let text = format!("{} mm", format::number(mark.value, decimals(mark.step_size)));
            (Vec2::new(x_of(1e-3 * mark.value), y - 0.009), text)
        });
        let above = at + Vec2::new(0.0, 0.5 * CARRIAGE_M[1] + 0.004);
        Self {
            options: options(force, above, along),
            camera: framing([-end - 0.004, floor_m - 0.004], [end + 0.004, y + 0.020]),
            force: force.map(|(now, _)| format!("{} N", format::number(now, 2))),
            numbers: numbers.collect(),
            world: Arc::new(world),
            state,
        }
    }

    fn shaft(angle_rad: f64, torque: Option<(f64, f64)>) -> Self {
        let world = presets::crank();
        let mut state = State::resting(&world);
        state.crank.angle_rad = if angle_rad.is_finite() { angle_rad } else { 0.0 };
        let handle = state.handle_in_world(&world).unwrap_or_default();
        let (center, radius) = world.crank.as_ref().map_or((Vec2::zeros(), 0.02), |c| (c.center_m, c.radius_m));
        let out = (handle - center) / radius.max(1e-9);
        // Counter-clockwise is positive.
        let along = Vec2::new(-out.y, out.x);
        let reach = radius + 0.024;
        let floor_m = world.floor.as_ref().map_or(center.y - reach, |floor| floor.height_m);
        let low = [center.x - 1.4 * reach, floor_m.max(center.y - 1.3 * reach)];
        Self {
            options: options(torque, handle, along),
            camera: framing(low, [center.x + 1.4 * reach, center.y + reach]),
            force: torque.map(|(now, _)| format!("{} N·m", format::number(now, 3))),
            numbers: Vec::new(),
            world: Arc::new(world),
            state,
        }
    }

    /// Draws the numbers along the rail and the force over the picture, which `camera` shows at `size` pixels.
    pub fn write_over(&self, ui: &Ui, rect: Rect, camera: &Camera, size: [u32; 2]) {
        let p = palette(ui);
        let painter = ui.painter().with_clip_rect(rect);
        let mut last = f32::MIN;
        for (at, text) in &self.numbers {
            let pixel = camera.pixel_of(*at, size) / ui.pixels_per_point();
            let galley = painter.layout_no_wrap(text.clone(), FontId::proportional(11.5), p.secondary);
            let at = rect.min + egui::vec2(pixel.x - 0.5 * galley.size().x, pixel.y);
            // Numbers close together are thinned: every second or third is enough.
            if at.x > last + space::S && rect.contains_rect(Rect::from_min_size(at, galley.size())) {
                last = at.x + galley.size().x;
                painter.galley(at, galley, p.secondary);
            }
        }
        if let Some(force) = &self.force {
            let at: Pos2 = rect.center_top() + egui::vec2(0.0, space::M);
            painter.text(at, Align2::CENTER_TOP, force, FontId::new(18.0, theme::semibold()), p.text);
        }
    }
}

fn most(values: &[f64]) -> f64 {
    values.iter().filter(|v| v.is_finite()).fold(0.0_f64, |most, v| most.max(v.abs()))
}

/// View options without a hand; the force is an arrow `along` from a point.
fn options(force: Option<(f64, f64)>, at_m: Vec2, along: Vec2) -> ViewOptions {
    let arrow = force.filter(|(now, most)| now.is_finite() && *most > 0.0).map(|(now, most)| ForceVector {
        at_m,
        force_n: now / most * along,
        role: ColorRole::Measured,
    });
    ViewOptions {
        fingers: FingerStyle::Hidden,
        show_workspace: false,
        show_forces: false,
        force_vectors: arrow.into_iter().collect(),
        vector_scale_m_per_n: ARROW_M as f32,
        ..ViewOptions::default()
    }
}

fn framing(low: [f64; 2], high: [f64; 2]) -> Camera {
    let [low, high] = [low, high].map(|corner| corner.map(|v| v as f32));
    Camera { pitch_rad: 0.3, yaw_rad: 0.35, ..Camera::hand() }.framing(low.into(), high.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::recording::{Channel, Recording};

    fn recorded(channels: &[(&str, &str, [f64; 3])]) -> Prepared {
        let channel = |(name, unit, values): &(&str, &str, [f64; 3])| Channel {
            name: (*name).to_owned(),
            unit: (*unit).to_owned(),
            values: values.to_vec(),
        };
        let channels = channels.iter().map(channel).collect();
        Prepared::new(Recording { time_s: Some(vec![0.0, 1.0, 2.0]), channels, ..Recording::default() })
    }

    #[test]
    fn the_carriage_goes_from_end_to_end_of_its_rail_with_its_force() {
        let prepared = recorded(&[("q_m", "m", [-0.2, 0.1, 0.4]), ("f_N", "N", [-4.0, 0.0, 2.0])]);
        let at = |t: f64| Mechanism::of(&prepared, t).expect("a coordinate");
        let x = |t: f64| at(t).state.bodies[0].center_m.x;
        assert!((x(0.0) + HALF_RAIL_M).abs() < 1e-12 && x(1.0).abs() < 1e-12 && (x(2.0) - HALF_RAIL_M).abs() < 1e-12);
        let arrow = |t: f64| at(t).options.force_vectors[0].force_n;
        assert_eq!((arrow(0.0), arrow(2.0)), (Vec2::new(-1.0, 0.0), Vec2::new(0.5, 0.0)));
        let numbers = at(0.0).numbers;
        let said: Vec<&str> = numbers.iter().map(|(_, text)| text.as_str()).collect();
        assert_eq!(said, ["−200 mm", "0 mm", "200 mm", "400 mm"]);
        assert!((numbers[1].0.x + HALF_RAIL_M / 3.0).abs() < 1e-9, "zero is a third along");
    }

    #[test]
    fn the_shaft_turns_counter_clockwise_and_its_arrow_goes_along() {
        let quarter = std::f64::consts::FRAC_PI_2;
        let prepared = recorded(&[("q_rad", "rad", [0.0, quarter, 0.0]), ("tau_Nm", "Nm", [0.2, 0.1, 0.0])]);
        let start = Mechanism::of(&prepared, 0.0).expect("a coordinate");
        let turned = Mechanism::of(&prepared, 1.0).expect("a coordinate");
        let center = start.world.crank.as_ref().expect("a crank").center_m;
        let out = |m: &Mechanism| m.state.handle_in_world(&m.world).expect("a handle") - center;
        assert!(out(&start).x > 0.0 && out(&start).y.abs() < 1e-9);
        assert!(out(&turned).y > 0.0 && out(&turned).x.abs() < 1e-9);
        assert!((start.options.force_vectors[0].force_n - Vec2::new(0.0, 1.0)).norm() < 1e-9);
        assert!((turned.options.force_vectors[0].force_n - Vec2::new(-0.5, 0.0)).norm() < 1e-9);
    }

    #[test]
    fn recordings_that_say_little_are_harmless() {
        assert!(Mechanism::of(&recorded(&[("a", "A", [0.0; 3])]), 0.0).is_none());
        let still = Mechanism::of(&recorded(&[("q_m", "m", [0.5; 3])]), 0.0).expect("a coordinate");
        assert!(still.numbers.is_empty() && still.options.force_vectors.is_empty());
        let gaps = recorded(&[("q_m", "m", [f64::NAN, 0.0, 1.0]), ("f_N", "N", [f64::NAN; 3])]);
        let gap = Mechanism::of(&gaps, 0.0).expect("a coordinate");
        assert!(gap.state.bodies[0].center_m.x == 0.0 && gap.options.force_vectors.is_empty());
    }
}
