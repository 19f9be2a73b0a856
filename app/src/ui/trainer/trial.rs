//! The force test: a small push in one direction, soft, short, and ended by any doubt.

use haptics::Vec2;

/// How long a test lasts, s: two to come up, three to feel it.
const LENGTH_S: f64 = 5.0;

/// Where to push.
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

/// A force test as it is set up and as it runs.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// Where to push.
    pub direction: Direction,
    /// How hard, N a finger.
    pub newtons: f64,
    left_s: f64,
}

impl Default for Trial {
    fn default() -> Self {
        Self { direction: Direction::Up, newtons: 0.5, left_s: 0.0 }
    }
}

impl Trial {
    /// Begins.
    pub fn start(&mut self) {
        self.left_s = LENGTH_S;
    }

    /// Ends at once.
    pub fn abort(&mut self) {
        self.left_s = 0.0;
    }

    /// True while it pushes.
    pub fn is_running(&self) -> bool {
        self.left_s > 0.0
    }

    /// What is left of it, s.
    pub fn left_s(&self) -> f64 {
        self.left_s
    }

    /// A picture later: the force to ask for, N on both of the operator's fingers.
    pub fn advance(&mut self, frame_s: f64) -> Option<[Vec2; 2]> {
        self.left_s = (self.left_s - frame_s).max(0.0);
        self.is_running().then(|| [self.direction.unit() * self.newtons; 2])
    }
}
