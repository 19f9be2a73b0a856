//! The program's column names (`spec/logs.md`) with labels, and the tasks that can use them.

use estimator::log::units::{self, Dimension};
use haptics::recording::Task;

/// One column name of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Name {
    /// Name in a sidecar, in SI units.
    pub si: &'static str,
    /// Label for the user.
    pub words: &'static str,
    /// Form of recording that it belongs to.
    pub form: Form,
}

/// Form of recording. Columns of one form belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Any form.
    Any,
    /// Two fingertips.
    Tips,
    /// The joints of two fingers.
    Joints,
    /// One tool, or one finger.
    Tool,
    /// A mechanism with one degree of freedom.
    Coordinate,
}

const fn name(si: &'static str, words: &'static str, form: Form) -> Name {
    Name { si, words, form }
}

/// All offered names, in the order of the list.
pub const NAMES: [Name; 42] = [
    name("t_s", "time", Form::Any),
    name("x1_m", "left tip, x", Form::Tips),
    name("y1_m", "left tip, y", Form::Tips),
    name("x2_m", "right tip, x", Form::Tips),
    name("y2_m", "right tip, y", Form::Tips),
    name("fx1_N", "left force, x", Form::Tips),
    name("fy1_N", "left force, y", Form::Tips),
    name("fx2_N", "right force, x", Form::Tips),
    name("fy2_N", "right force, y", Form::Tips),
    name("vx1_m_s", "left velocity, x", Form::Tips),
    name("vy1_m_s", "left velocity, y", Form::Tips),
    name("vx2_m_s", "right velocity, x", Form::Tips),
    name("vy2_m_s", "right velocity, y", Form::Tips),
    name("qb1_rad", "left bottom joint", Form::Joints),
    name("qt1_rad", "left top joint", Form::Joints),
    name("qb2_rad", "right bottom joint", Form::Joints),
    name("qt2_rad", "right top joint", Form::Joints),
    name("dqb1_rad_s", "left bottom joint rate", Form::Joints),
    name("dqt1_rad_s", "left top joint rate", Form::Joints),
    name("dqb2_rad_s", "right bottom joint rate", Form::Joints),
    name("dqt2_rad_s", "right top joint rate", Form::Joints),
    name("x_m", "tool, x", Form::Tool),
    name("y_m", "tool, y", Form::Tool),
    name("z_m", "tool, z", Form::Tool),
    name("fx_N", "tool force, x", Form::Tool),
    name("fy_N", "tool force, y", Form::Tool),
    name("fz_N", "tool force, z", Form::Tool),
    name("vx_m_s", "tool velocity, x", Form::Tool),
    name("vy_m_s", "tool velocity, y", Form::Tool),
    name("vz_m_s", "tool velocity, z", Form::Tool),
    name("qb_rad", "bottom joint", Form::Tool),
    name("qt_rad", "top joint", Form::Tool),
    name("dqb_rad_s", "bottom joint rate", Form::Tool),
    name("dqt_rad_s", "top joint rate", Form::Tool),
    name("q_m", "coordinate, length", Form::Coordinate),
    name("q_rad", "coordinate, angle", Form::Coordinate),
    name("dq_m_s", "rate of the length", Form::Coordinate),
    name("dq_rad_s", "rate of the angle", Form::Coordinate),
    name("f_N", "applied force", Form::Coordinate),
    name("tau_Nm", "applied torque", Form::Coordinate),
    name("trial", "number of the trial", Form::Any),
    name("label", "label of the state", Form::Any),
];

/// Name with this SI form.
pub fn find(si: &str) -> Option<&'static Name> {
    NAMES.iter().find(|n| n.si == si)
}

/// Names that a task can use; all of them if the task is unknown. Forces of fingers can accompany joints, too.
pub fn offered(task: Option<Task>) -> Vec<&'static Name> {
    let fits = |form: Form| match task {
        None => true,
        Some(Task::BlockStack | Task::Barrel) => matches!(form, Form::Any | Form::Tips | Form::Joints),
        Some(Task::Crank | Task::Needle | Task::Switch) => form != Form::Coordinate,
        Some(Task::Payload) => matches!(form, Form::Any | Form::Tool),
        Some(Task::Mechanism) => matches!(form, Form::Any | Form::Tool | Form::Coordinate),
    };
    NAMES.iter().filter(|n| fits(n.form)).collect()
}

/// Dimension of a name; `None` for `trial`, `label` and names that are not the program's.
pub fn dimension(si: &str) -> Option<Dimension> {
    units::split(si).map(|(_, unit)| unit.dimension)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_one_that_the_reader_knows() {
        for name in NAMES.iter().filter(|n| !matches!(n.si, "trial" | "label")) {
            assert!(units::is_program_name(name.si), "{}", name.si);
        }
        for (a, b) in estimator::log::PAIRS {
            assert!(find(a).is_some() && find(b).is_some(), "{a} {b}");
        }
    }

    #[test]
    fn a_task_offers_what_it_can_use() {
        let has = |task, si: &str| offered(task).iter().any(|n| n.si == si);
        assert!(has(Some(Task::BlockStack), "fx1_N") && !has(Some(Task::BlockStack), "q_m"));
        assert!(has(Some(Task::Mechanism), "tau_Nm") && !has(Some(Task::Mechanism), "x1_m"));
        assert!(has(None, "qb2_rad") && has(Some(Task::Crank), "qb_rad"));
    }
}
