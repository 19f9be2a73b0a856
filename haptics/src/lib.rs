//! The two-fingered planar hand, the virtual world it touches, the servo thread that runs both, and the devices that drive it.
//!
//! No GUI here. Everything is SI and `f64`; the plane is vertical, x to the right, **y up**.
//!
//! * [`hand`]: kinematics both ways, Jacobian, gravity-compensating torque law.
//! * [`world`]: the model (immutable), its state (mutable) and `step`, deterministic to the bit.
//! * [`law`]: one physical law a file, shared by the servo, the replay, the fit and the diagnosis.
//! * [`servo`]: the kilohertz thread, its timing statistics and its safety.
//! * [`device`]: sources of finger positions and sinks of forces.
//! * [`teleop`]: the same with a slow line between operator and world.
//! * [`recording`]: one log, in memory.
//! * [`text_file`]: small files of other programs or persons, read with a bound.

pub mod device;
pub mod hand;
pub mod law;
pub mod recording;
pub mod servo;
pub mod teleop;
pub mod text_file;
pub mod world;

/// A point or vector of the plane: x to the right, y up.
pub type Vec2 = nalgebra::Vector2<f64>;
