//! Camera that eases to its goal within a moment, without a jerk.

use render::Camera;

/// Time constant of the motion, s: a third of the distance remains after it. Short enough to feel direct, long enough
/// for the eye to follow.
const LAG_S: f32 = 0.07;
/// Share of a movement below which no further frame is drawn.
const ARRIVED: f32 = 2e-3;

/// A camera that eases to its goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rig {
    shown: Camera,
    goal: Camera,
    home: Camera,
    /// Mouse button that rotates it.
    pub turned_by: egui::PointerButton,
}

impl Rig {
    /// Camera at rest at `home`.
    pub fn new(home: Camera) -> Self {
        Self { shown: home, goal: home, home, turned_by: egui::PointerButton::Secondary }
    }

    /// Camera of the current frame.
    pub fn shown(&self) -> Camera {
        self.shown
    }

    /// Goal of the motion.
    pub fn goal(&mut self) -> &mut Camera {
        &mut self.goal
    }

    /// True if the goal is the home position.
    pub fn is_home(&self) -> bool {
        self.goal == self.home
    }

    /// Starts the return to the home position.
    pub fn go_home(&mut self) {
        self.goal = self.home;
    }

    /// Jumps to the home position of another subject.
    pub fn cut_to(&mut self, home: Camera) {
        *self = Self::new(home);
    }

    /// Moves the home position; a camera at home follows, one that was moved stays.
    pub fn move_home(&mut self, home: Camera) {
        if self.is_home() {
            self.goal = home;
        }
        self.home = home;
    }

    /// Advances by `seconds`; true while it moves.
    pub fn advance(&mut self, seconds: f32) -> bool {
        if self.shown == self.goal {
            return false;
        }
        self.shown = self.shown.toward(&self.goal, 1.0 - (-seconds.clamp(0.0, 0.25) / LAG_S).exp());
        if self.shown.apart(&self.goal) < ARRIVED {
            self.shown = self.goal;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned() -> Rig {
        let mut rig = Rig::new(Camera::workspace());
        rig.goal().orbit(0.5, 0.3);
        rig.goal().zoom(1.8);
        rig
    }

    #[test]
    fn it_arrives_without_overshoot_and_then_rests() {
        let mut rig = turned();
        let mut yaws = vec![rig.shown().yaw_rad];
        while rig.advance(1.0 / 60.0) {
            yaws.push(rig.shown().yaw_rad);
        }
        assert!(yaws.is_sorted() && (10..60).contains(&yaws.len()), "{} pictures", yaws.len());
        assert_eq!(rig.shown(), *rig.goal());
        assert!(!rig.advance(1.0));
    }

    #[test]
    fn the_way_does_not_depend_on_the_rate_of_pictures() {
        let (mut smooth, mut slow) = (turned(), turned());
        for _ in 0..12 {
            smooth.advance(1.0 / 120.0);
        }
        slow.advance(0.1);
        assert!((smooth.shown().yaw_rad - slow.shown().yaw_rad).abs() < 1e-3);
        assert!((smooth.shown().extent_m - slow.shown().extent_m).length() < 1e-4);
    }

    #[test]
    fn a_moved_camera_stays_where_home_moves_and_finds_it_again() {
        let mut rig = turned();
        rig.move_home(Camera::hand());
        assert!(!rig.is_home());
        rig.go_home();
        while rig.advance(0.1) {}
        assert_eq!(rig.shown(), Camera::hand());
        rig.move_home(Camera::front());
        assert!(rig.is_home(), "one that is at home goes along");
    }
}
