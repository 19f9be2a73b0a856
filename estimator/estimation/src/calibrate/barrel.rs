//! A fitted barrel as one that can be felt.

use super::Builder;
use crate::identify::barrel::report::{CABLE, OBJECT};
use crate::segment::Segmentation;
use foundation::signal::task::task_signals;
use haptics::Vec2;
use haptics::recording::Recording;
use haptics::world::{Block, Cable, Content, Floor, Shape, Source, Wall};

/// Height over width of a barrel whose height is not stated.
const USUAL_SHAPE: f64 = 1.3;
/// Share of the mass that may run out of a leaking barrel: how much is in it, nothing shows.
const CONTENT_SHARE: f64 = 0.5;
/// Damping of a cable, N s/m.
const CABLE_DAMPING_N_S_M: f64 = 2.0;
/// Length of a cable whose end was not seen, m.
const USUAL_CABLE_M: f64 = 0.05;

impl Builder<'_> {
    /// The barrel where it was picked up, with its wall, its leak and its cable, as far as they were seen.
    pub(super) fn barrel(&mut self, recording: &Recording, segmentation: Option<&Segmentation>) {
        let mass_kg = self.take(OBJECT, "mass_kg", 0.2).max(1e-3);
        let width_m = self.take(OBJECT, "width_m", 0.025).max(1e-3);
        let height_m = match recording.meta.known.get("height_m").filter(|h| h.is_finite() && **h > 0.0) {
            Some(height_m) => {
                self.note(OBJECT, "height_m", *height_m, None, Source::Assumed, "stated in the sidecar");
                *height_m
            }
            None => self.take(OBJECT, "height_m", USUAL_SHAPE * width_m),
        };
        let middle_m = picked(recording, segmentation).unwrap_or(self.world.hand.workspace.center_m);
        let base_m = middle_m.y - 0.5 * height_m;
        self.world.floor = Some(Floor { height_m: base_m, ..Floor::default() });
        self.note("floor", "height_m", base_m, None, Source::Assumed, "the barrel is taken as gripped at mid-height");
        let mut barrel = Block::upright(OBJECT, mass_kg, width_m, height_m, middle_m.x, base_m);
        barrel.shape = Shape::Barrel;
        barrel.finger_friction = self.friction(OBJECT);
        barrel.wall = self.sides(recording);
        barrel.content = self.leak(mass_kg);
        barrel.cable = self.cable(base_m);
        self.world.blocks = vec![barrel];
    }

    /// Shares the measured give of the sides out between pads and wall; together they give as measured.
    fn sides(&mut self, recording: &Recording) -> Option<Wall> {
        let series_n_m = self.fit.value(OBJECT, "grip_stiffness_N_m")?;
        let usual_n_m = self.world.pad.stiffness_n_m;
        let stated = recording.meta.known.get("pad_stiffness_N_m").copied().filter(|k| k.is_finite() && *k > 0.0);
        let left = |pad_n_m: f64| 1.0 / series_n_m - 1.0 / pad_n_m;
        let from = format!("give of pad and wall together, {}", self.from);
        let shear = self.world.pad.shear_stiffness_n_m / usual_n_m;
        let pad_n_m = stated.unwrap_or(usual_n_m).max(series_n_m);
        let error = self.fit.parameter(OBJECT, "grip_stiffness_N_m").and_then(|p| p.std_error);
        self.world.pad.stiffness_n_m = pad_n_m;
        self.world.pad.shear_stiffness_n_m = shear * pad_n_m;
        self.note("pad", "stiffness_N_m", pad_n_m, error, Source::Measured, &from);
        if let Some(wall_n_m) = self.fit.value(OBJECT, "wall_stiffness_N_m") {
            self.take(OBJECT, "wall_stiffness_N_m", wall_n_m);
            return Some(Wall { stiffness_n_m: wall_n_m, strength_n: None });
        }
        // A wall that is too stiff to be felt behind the pads is rigid.
        let wall_n_m = left(pad_n_m).recip();
        if stated.is_some() || !(0.0..20.0 * pad_n_m).contains(&wall_n_m) {
            return None;
        }
        let why = "what pads of usual stiffness leave of the measured give";
        self.note(OBJECT, "wall_stiffness_N_m", wall_n_m, None, Source::Assumed, why);
        Some(Wall { stiffness_n_m: wall_n_m, strength_n: None })
    }

    /// A leak that stands out of its error begins at the start.
    fn leak(&mut self, mass_kg: f64) -> Option<Content> {
        let leak = self.fit.parameter(OBJECT, "leak_kg_s")?;
        let (value, error) = (leak.value?, leak.std_error?);
        if value < 3.0 * error {
            return None;
        }
        let leak_kg_s = self.take(OBJECT, "leak_kg_s", value);
        let content_kg = self.fit.value(OBJECT, "content_mass_kg").filter(|c| (0.0..mass_kg).contains(c));
        let mass_kg = content_kg.unwrap_or(CONTENT_SHARE * mass_kg);
        let why =
            if content_kg.is_some() { "mass less the stated empty mass" } else { "how much can run out is not seen" };
        self.note(OBJECT, "content_mass_kg", mass_kg, None, Source::Assumed, why);
        Some(Content { mass_kg, leak_kg_s, leaks_from_s: Some(0.0) })
    }

    /// The cable; tied somewhere along its pull where the place was not seen.
    fn cable(&mut self, floor_m: f64) -> Option<Cable> {
        let stiffness_n_m = self.take_found(CABLE, "stiffness_N_m")?;
        let blank = Cable { anchor_m: Vec2::zeros(), length_m: 0.0, stiffness_n_m, damping_n_s_m: CABLE_DAMPING_N_S_M };
        let seen = ["anchor_x_m", "anchor_y_m", "length_m"].map(|name| self.take_found(CABLE, name));
        if let [Some(x), Some(y), Some(length_m)] = seen {
            return Some(Cable { anchor_m: Vec2::new(x, y), length_m, ..blank });
        }
        let taut_m = Vec2::new(self.take_found(CABLE, "taut_x_m")?, self.take_found(CABLE, "taut_y_m")?);
        let (sin, cos) = self.take_found(CABLE, "direction_rad")?.sin_cos();
        // Down to the floor, if that is where it leads.
        let down_m = if sin > 0.2 { (taut_m.y - floor_m) / sin } else { USUAL_CABLE_M };
        let length_m = down_m.clamp(0.2 * USUAL_CABLE_M, 3.0 * USUAL_CABLE_M);
        let why = "its pull hardly turned; it is taken as tied to the floor, or 5 cm away";
        self.note(CABLE, "length_m", length_m, None, Source::Assumed, why);
        Some(Cable { anchor_m: taut_m - Vec2::new(cos, sin) * length_m, length_m, ..blank })
    }

    /// A measured value, noted; `None` without one.
    fn take_found(&mut self, object: &str, name: &str) -> Option<f64> {
        let value = self.fit.value(object, name)?;
        Some(self.take(object, name, value))
    }
}

/// Middle of the fingers when it was first picked up, m.
fn picked(recording: &Recording, segmentation: Option<&Segmentation>) -> Option<Vec2> {
    let samples = segmentation?.samples_of("pick-up-barrel-1");
    let signals = task_signals(recording).ok()?;
    let n = samples.len() as f64;
    (!samples.is_empty()).then(|| samples.iter().map(|i| signals.position[*i]).sum::<Vec2>() / n)
}
