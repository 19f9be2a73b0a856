//! Candidates that pull to a place or push away from it: springs, walls and cables.

use super::candidate::{Candidate, Searched, Shape};
use super::library::{Dictionary, position};
use haptics::law::{AddedConstraint, Cable, Kind, ReturnSpring};

impl Dictionary<'_> {
    /// Springs, linear and hardening: a cubic about any place is the sum of one about the middle and one beside it.
    pub(crate) fn springs(&self, all: &mut Vec<Candidate>) {
        let (low, high) = (self.track.quantile(0.0, position), self.track.quantile(1.0, position));
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low).max(1e-12));
        let column = |values: &[f64]| self.law_of_place(&ReturnSpring, values);
        let line = || vec![column(&[1.0, 0.0, 0.0, middle]), column(&[0.0, 1.0])];
        let names = || vec![("k", self.unit(&ReturnSpring, 0)), ("f0", self.units().force)];
        let spring = Candidate::of("return-spring", Kind::Plant, line(), names());
        all.push(spring.shaped(Shape::Spring { half }));
        if !self.track.planar {
            // Beside a constant force (a sensor's zero, a slope) the rest position is not identifiable.
            let anywhere = column(&[1.0, 0.0, 0.0, middle]);
            all.push(
                Candidate::of("return-spring", Kind::Plant, vec![anywhere], vec![("k", self.unit(&ReturnSpring, 0))])
                    .positive(),
            );
        }
        let (mut columns, mut linear) = (line(), names());
        columns.push(column(&[0.0, 0.0, 1.0, middle]));
        columns.push(column(&[0.0, 0.0, 1.0, middle + half]));
        linear.extend([("k3", self.unit(&ReturnSpring, 2)), ("k3 aside", self.unit(&ReturnSpring, 2))]);
        let hardening = Candidate::of("return-spring", Kind::Plant, columns, linear);
        all.push(hardening.shaped(Shape::Hardening { half }));
        // Far from its rest position, only the cubic shows.
        for rest in self.grid.rests.iter().copied() {
            let cubic = self.plain(&ReturnSpring, &[0.0, 0.0, 1.0, rest], 2).positive();
            all.push(cubic.at("q0", rest, self.unit(&ReturnSpring, 3)));
        }
        // Near its rest position the force is zero there: one parameter less than two cubics have.
        for rest in self.grid.hardening.iter().copied() {
            let columns = vec![column(&[1.0, 0.0, 0.0, rest]), column(&[0.0, 0.0, 1.0, rest])];
            let linear = vec![("k", self.unit(&ReturnSpring, 0)), ("k3", self.unit(&ReturnSpring, 2))];
            let stiff = Candidate::of("return-spring", Kind::Plant, columns, linear).shaped(Shape::Stiffening);
            all.push(stiff.at("q0", rest, self.unit(&ReturnSpring, 3)));
        }
    }

    /// Walls that leave a good part of the motion alone (else a spring explains as much), and cables to a place beside
    /// the arm.
    pub(crate) fn walls(&self, all: &mut Vec<Candidate>) {
        let units = self.units();
        for (place, side) in self.grid.walls.iter().copied() {
            let wall = self.plain(&AddedConstraint, &[1.0, place, side], 0).positive();
            all.push(Candidate { side, ..wall.at("place", place, units.length) });
        }
        let (Some(radius), true) = (self.track.radius_m, self.track.planar) else { return };
        for (direction, rest, reach) in self.grid.cables.iter().copied() {
            let pull = self.law_of_place(&Cable, &[1.0, rest, direction, reach * radius, radius]);
            let cable = Candidate::of("added-constraint", Kind::Plant, vec![pull], vec![("k", "N/m")]).positive();
            let mut cable = cable.at("anchor direction", direction, "rad").at("rest length", rest, "m");
            // The distance of the anchor hardly affects the force.
            cable.searched.push(Searched { name: "anchor distance", value: reach * radius, unit: "m" });
            all.push(cable);
        }
    }
}
