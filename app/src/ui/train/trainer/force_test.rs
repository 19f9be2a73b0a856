//! The force test: a small push in one direction, gentle, short, and ended by any doubt.

use haptics::Vec2;

/// Duration of a test, s: two to rise, three to feel it.
const LENGTH_S: f64 = 5.0;

/// Direction of the push.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Direction {
    /// Upwards.
    #[default]
    Up,
    /// Downwards.
    Down,
    /// To the left.
    Left,
    /// To the right.
    Right,
}

impl Direction {
    /// Every direction with its label.
    pub const ALL: [(Self, &'static str, &'static str); 4] =
        [(Self::Up, "Up", ""), (Self::Down, "Down", ""), (Self::Left, "Left", ""), (Self::Right, "Right", "")];

    fn unit(self) -> Vec2 {
        match self {
            Self::Up => Vec2::new(0.0, 1.0),
            Self::Down => Vec2::new(0.0, -1.0),
            Self::Left => Vec2::new(-1.0, 0.0),
            Self::Right => Vec2::new(1.0, 0.0),
        }
    }
}

/// Settings and state of a force test.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// Direction of the push.
    pub direction: Direction,
    /// Magnitude, N per finger.
    pub newtons: f64,
    left_s: f64,
}

impl Default for Trial {
    fn default() -> Self {
        Self { direction: Direction::Up, newtons: 0.5, left_s: 0.0 }
    }
}

impl Trial {
    /// Starts the test.
    pub fn start(&mut self) {
        self.left_s = LENGTH_S;
    }

    /// Ends the test at once.
    pub fn abort(&mut self) {
        self.left_s = 0.0;
    }

    /// True while it pushes.
    pub fn is_running(&self) -> bool {
        self.left_s > 0.0
    }

    /// Remaining time, s.
    pub fn left_s(&self) -> f64 {
        self.left_s
    }

    /// Advances by a frame. Returns the force to request, N on both of the operator's fingers.
    pub fn advance(&mut self, frame_s: f64) -> Option<[Vec2; 2]> {
        self.left_s = (self.left_s - frame_s).max(0.0);
        self.is_running().then(|| [self.direction.unit() * self.newtons; 2])
    }
}
