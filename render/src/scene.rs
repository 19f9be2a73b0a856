//! Description of a picture by the caller: borrowed world and state, and options in plain data.

use crate::camera::Camera;
use crate::theme::{ColorRole, Theme};
use haptics::Vec2;
use haptics::world::{State, World};

/// Everything that a picture shows.
#[derive(Clone, Copy, Debug)]
pub struct SceneView<'a> {
    /// The world.
    pub world: &'a World,
    /// Present state of the world.
    pub state: &'a State,
    /// Options of the view.
    pub options: &'a ViewOptions,
}

/// Options of a scene's view and of the overlays.
#[derive(Clone, Debug)]
pub struct ViewOptions {
    /// Light or dark.
    pub theme: Theme,
    /// Position of the viewer.
    pub camera: Camera,
    /// Style of the fingers.
    pub fingers: FingerStyle,
    /// Arrows of the forces that the tips exert on the environment.
    pub show_forces: bool,
    /// Length of a force arrow, m per N, positive.
    pub force_scale_m_per_n: f32,
    /// End of a force arrow that touches the tip.
    pub arrow_anchor: ArrowAnchor,
    /// Small marks at active contacts.
    pub show_contacts: bool,
    /// The outline of the reachable disc.
    pub show_workspace: bool,
    /// True for a finger whose force is clamped just now: its pad and arrow turn to the warning colour.
    pub saturated: [bool; 2],
    /// The object that is being talked about.
    pub highlight: Option<SolidRef>,
    /// Curves in the plane.
    pub trajectories: Vec<Trajectory>,
    /// Forces of the tips by a model, N: slender arrows beside those of the measured forces.
    pub predicted_force_n: Option<[Vec2; 2]>,
    /// Force vectors along a path (thesis, figure 5.10).
    pub force_vectors: Vec<ForceVector>,
    /// Their length, m per N, positive: many small arrows have another scale than one large one.
    pub vector_scale_m_per_n: f32,
    /// Found centres of rotation and directions of motion.
    pub constraints: Vec<ConstraintMarker>,
    /// A second state, drawn translucent: a replay, a prediction, a target. Made for the same world.
    pub ghost: Option<State>,
}

impl Default for ViewOptions {
    fn default() -> Self {
        Self {
            theme: Theme::default(),
            camera: Camera::default(),
            fingers: FingerStyle::Linkage,
            show_forces: true,
            force_scale_m_per_n: 0.012,
            arrow_anchor: ArrowAnchor::HeadAtTip,
            show_contacts: false,
            show_workspace: true,
            saturated: [false; 2],
            highlight: None,
            trajectories: Vec::new(),
            predicted_force_n: None,
            force_vectors: Vec::new(),
            vector_scale_m_per_n: 0.012,
            constraints: Vec::new(),
            ghost: None,
        }
    }
}

/// Style of the fingers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FingerStyle {
    /// Links, joints and fingertips.
    #[default]
    Linkage,
    /// Fingertips only.
    Tips,
    /// One tool instead of two fingers, at the tip of finger 1 (index 0): a log of a single tool.
    Tool,
    /// Nothing.
    Hidden,
}

/// End of a force arrow that touches the fingertip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ArrowAnchor {
    /// The arrow pushes: its head is at the tip, so that opposing grip forces do not cross inside the block.
    #[default]
    HeadAtTip,
    /// The arrow starts at the tip.
    TailAtTip,
}

/// An object of the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolidRef {
    /// A block, barrel or needle, by index.
    Block(usize),
    /// The crank's handle.
    Handle,
    /// The knob of the toggle switch.
    Knob,
}

/// A curve in the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// Its points, world, m; a point that is not finite interrupts the curve.
    pub points_m: Vec<Vec2>,
    /// Its colour.
    pub role: ColorRole,
    /// Its width, pixels.
    pub width_px: f32,
    /// Dashes tell a simulated curve from a measured one without colour.
    pub dashed: bool,
}

/// A force at a point of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceVector {
    /// Position, world, m.
    pub at_m: Vec2,
    /// The force, N; drawn from the point outwards with [`ViewOptions::vector_scale_m_per_n`].
    pub force_n: Vec2,
    /// Its colour.
    pub role: ColorRole,
}

/// A constraint that was found in a recording.
#[derive(Clone, Debug, PartialEq)]
pub enum ConstraintMarker {
    /// Motion about a centre.
    Revolute {
        /// Centre, world, m.
        center_m: Vec2,
        /// Radius, m.
        radius_m: f64,
        /// Half axes of the region that the centre lies in, m, at right angles to each other; drawn as an ellipse.
        center_axes_m: [Vec2; 2],
    },
    /// Motion along a line.
    Prismatic {
        /// A point of the line, world, m.
        origin_m: Vec2,
        /// Direction of motion, need not be unit.
        direction: Vec2,
        /// Length drawn, m, half to each side.
        length_m: f64,
        /// Standard error across the line, m; drawn as a band of two of them to each side.
        std_m: f64,
    },
    /// Motion along a curve.
    Path {
        /// Its points, world, m.
        points_m: Vec<Vec2>,
    },
    /// A surface that pushes one way.
    Surface {
        /// Both ends of the touched line, world, m.
        ends_m: [Vec2; 2],
        /// Out of the surface, need not be unit.
        normal: Vec2,
        /// Standard error along the normal, m; drawn as a band of two of them to each side.
        std_m: f64,
    },
}
