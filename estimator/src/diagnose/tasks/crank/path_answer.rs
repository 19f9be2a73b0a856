//! Path of a crank as a part of its answer.

use super::path::{Geometry, competition};
use super::path_points::Path;
use crate::diagnose::answer::part::{Part, Role, Told};
use crate::diagnose::contract::CauseParameter;
use crate::diagnose::free_run::FreeRun;
use crate::diagnose::free_run::windows::AT_ONCE;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::{joint_offset, length_scale};
use crate::diagnose::selection::comparison::ChannelFit;
use foundation::signal::noise::white_noise;
use foundation::tasks::SystemState;

/// A link of a finger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Link {
    First,
    Second,
}

/// Comparison of a path.
pub struct PathFit {
    pub study: ChannelFit,
    /// True for every point.
    pub along: Vec<bool>,
    /// Link whose angle has an error; `None` if the data do not tell.
    pub link: Option<Link>,
}

/// True if a candidate is the angle error of a finger's joint. With two fingers, the cause names the finger: the path
/// shows no more.
fn is_of_one_finger(candidate: &Candidate) -> bool {
    candidate.id == joint_offset::ID && candidate.linear[0].0 == "delta"
}

impl Told for PathFit {
    fn adds(&self, candidate: &Candidate) -> &'static str {
        match self.link {
            _ if candidate.id == length_scale::ID => {
                "; the length is that of the first link (an error of the second link's, as large and the other way round, makes the same path but for the size of \
                 the circle)"
            }
            _ if !is_of_one_finger(candidate) => "",
            Some(Link::First) => "; it is the angle of the first link",
            Some(Link::Second) => "; it is the angle of the second link",
            None => {
                "; the first link's angle being off by the opposite makes the same path, and the forces do not tell the two apart"
            }
        }
    }

    fn states(&self, _: usize, candidate: &Candidate, mut found: Vec<CauseParameter>) -> Vec<CauseParameter> {
        if is_of_one_finger(candidate) && self.link == Some(Link::First) {
            for p in &mut found {
                p.value = -p.value;
            }
        }
        found
    }
}

impl PathFit {
    /// The comparison of a path with its structured errors.
    pub fn of(path: &Path, circle: Geometry) -> Self {
        let mut study = circle.study;
        study.competition = competition(path, &circle.arm, &study);
        let along = vec![true; study.target.len()];
        Self { study, along, link: None }
    }

    /// The path beside the force along it.
    pub fn part(&self) -> Part<'_> {
        Part {
            role: Role::Path,
            study: &self.study,
            channel: "path",
            unit: "m",
            floor: 0.0,
            noise: white_noise(&self.study.target),
            along: &self.along,
            state: vec![Some(("distance from the circle", SystemState::Turning)); self.study.target.len()],
            view: None,
            told: self,
            free_run: FreeRun::None(AT_ONCE),
            in_world: None,
        }
    }
}
