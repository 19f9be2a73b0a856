//! A cable as the hand feels it: beyond some place a pull sets in and grows. It pulls from one side only, so all
//! directions and places are searched. A pull that turns as the barrel moves points at the anchor of the cable.
//!
//! The pull at p, towards the anchor A, is k max(0, |p − A| − L). Written about a place p₀ in the direction u away from the
//! anchor, with one over the distance κ = 1/|p₀ − A|, it stays regular for a cable so long that its pull does not turn.

use haptics::Vec2;

/// Geometry of a cable about a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cable {
    /// The place, m.
    pub about_m: Vec2,
    /// Direction away from the anchor there, rad from the horizontal.
    pub angle_rad: f64,
    /// Place at which it becomes taut, along that direction from the reference place, m.
    pub taut_m: f64,
    /// One over the distance of the anchor from the place, 1/m; 0: too far to tell.
    pub bend_1_m: f64,
}

impl Cable {
    /// Unit vector away from the anchor at the place.
    pub fn away(&self) -> Vec2 {
        Vec2::new(self.angle_rad.cos(), self.angle_rad.sin())
    }

    /// Stretch at `p`, m (below 0: slack), and the unit vector away from the anchor there.
    pub fn stretch(&self, p: Vec2) -> (f64, Vec2) {
        let u = self.away();
        let way = p - self.about_m;
        let (along, across) = (way.dot(&u), u.perp(&way));
        let kappa = self.bend_1_m;
        let far = (1.0 + kappa * along).hypot(kappa * across);
        // |p − A| − 1/κ without the difference of two large numbers.
        let gone = (2.0 * along + kappa * way.norm_squared()) / (far + 1.0);
        let direction = (u * (1.0 + kappa * along) + Vec2::new(-u.y, u.x) * (kappa * across)) / far.max(1e-9);
        (gone - self.taut_m, direction)
    }

    /// Anchor of the cable, m; `None` without a bend.
    pub fn anchor_m(&self) -> Option<Vec2> {
        (self.bend_1_m > 0.0).then(|| self.about_m - self.away() / self.bend_1_m)
    }

    /// Its length, m.
    pub fn length_m(&self) -> Option<f64> {
        (self.bend_1_m > 0.0).then(|| self.bend_1_m.recip() + self.taut_m)
    }

    /// The same with one of angle, taut place and bend shifted.
    pub fn shifted(&self, which: usize, by: f64) -> Self {
        let mut other = *self;
        match which {
            0 => other.angle_rad += by,
            1 => other.taut_m += by,
            _ => other.bend_1_m += by,
        }
        other
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretch_and_direction_are_those_of_a_point_and_a_length() {
        let (anchor, about) = (Vec2::new(-0.03, -0.12), Vec2::new(0.01, -0.09));
        let way = about - anchor;
        let cable =
            Cable { about_m: about, angle_rad: way.y.atan2(way.x), taut_m: -0.002, bend_1_m: way.norm().recip() };
        assert!((cable.anchor_m().expect("bent") - anchor).norm() < 1e-15);
        let length = cable.length_m().expect("bent");
        assert!((length - (way.norm() - 0.002)).abs() < 1e-15);
        for p in [Vec2::new(0.02, -0.09), Vec2::new(0.0, -0.07), Vec2::new(-0.02, -0.1)] {
            let (stretch, direction) = cable.stretch(p);
            assert!((stretch - ((p - anchor).norm() - length)).abs() < 1e-12);
            assert!((direction - (p - anchor).normalize()).norm() < 1e-12);
        }
        let straight = Cable { bend_1_m: 0.0, ..cable };
        assert!((straight.stretch(about + straight.away() * 0.005).0 - 0.007).abs() < 1e-15);
        assert!(straight.anchor_m().is_none());
    }
}
