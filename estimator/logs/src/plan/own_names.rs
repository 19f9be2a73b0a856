//! Columns that the sidecar does not mention, by their own names.

use super::Planner;
use crate::errors::LogError;
use crate::units::{self, Dimension, Unit};
use crate::written_units::{self, Written};
use foundation::signal::wrench::MATRIX;

/// Quantity and unit of a name that the user gives: `q_mm`, and also `q_in`, `f_lbf`, `t_min`.
pub fn parted(name: &str) -> Option<(&str, Unit)> {
    units::split(name).or_else(|| {
        let (quantity, text) = name.split_once('_')?;
        let wanted = units::quantity_dimensions(quantity)?;
        match written_units::parse(text, wanted) {
            Written::Known(dimension, factor) if wanted.contains(&dimension) => {
                let si = units::si(dimension);
                Some((quantity, Unit { symbol: si, dimension, si, factor }))
            }
            _ => None,
        }
    })
}

/// The SI form of a name of the program: `q_mm` → `q_m`.
pub fn canonical(name: &str) -> String {
    parted(name).map_or_else(|| name.to_owned(), |(quantity, unit)| format!("{quantity}_{}", unit.si))
}

impl Planner<'_> {
    /// A column that the sidecar does not mention.
    pub(super) fn take_own_name(&mut self, column: usize) -> Result<(), LogError> {
        let header = self.headers[column].clone();
        match header.as_str() {
            "trial" if self.plan.trial.is_none() => {
                self.plan.trial = Some(column);
                return Ok(());
            }
            "label" if self.plan.label.is_none() => {
                self.plan.label = Some(column);
                return Ok(());
            }
            _ => {}
        }
        if let Some(name) = self.orientation(column) {
            return self.add(name, String::new(), column, 1.0, false);
        }
        if let Some((name, si, factor)) = self.program_name(column)? {
            if let Some(why) = self.is_unwanted(&name) {
                self.plan.notes.push(format!("the column `{header}` is not used: {why}"));
                return Ok(());
            }
            return self.add(name, si, column, factor, true);
        }
        let (name, unit, factor) = match units::split(&header) {
            // The same quantity in another unit, as `time_ms` beside `time_s`, keeps its own name.
            Some((quantity, unit)) if !self.taken.contains_key(&format!("{quantity}_{}", unit.si)) => {
                (format!("{quantity}_{}", unit.si), unit.si.to_owned(), unit.factor)
            }
            _ => (header.clone(), self.shown_unit(column), 1.0),
        };
        self.add(name, unit, column, factor, false)
    }

    /// Name of the program for a part of an orientation: `quat_x`, `ori_x`, `/tool.pose.orientation.x`. A scalar that comes
    /// first is told by its name alone. None if several columns are called so.
    fn orientation(&self, column: usize) -> Option<String> {
        let name = part_of_orientation(&self.headers[column])?;
        let alike = self.headers.iter().filter(|header| part_of_orientation(header).as_ref() == Some(&name));
        (alike.count() == 1 && !self.mapped(&name)).then_some(name)
    }

    /// Unit of an extra channel, as the file has it.
    pub(super) fn shown_unit(&self, column: usize) -> String {
        let text = self.unit_text(column, &[]);
        let suffix = self.headers[column].rsplit_once('_').map_or("", |(_, suffix)| suffix);
        let is_word = suffix.chars().all(|c| c.is_alphanumeric() || c == '%') && !is_place(suffix);
        if text.is_empty() && is_word { suffix.to_owned() } else { text.trim_matches(['(', ')', '[', ']']).to_owned() }
    }

    /// Name of the program, SI unit, and factor of a column that is named after one of its quantities: `q_mm`, `fx1_lbf`,
    /// `x [mm]`. An error for a unit that is not known.
    pub(super) fn program_name(&self, column: usize) -> Result<Option<(String, String, f64)>, LogError> {
        let header = self.headers[column].as_str();
        if let Some((quantity, unit)) = units::split(header).filter(|_| self.stated(column).is_empty())
            && units::quantity_dimensions(quantity).is_some_and(|dimensions| dimensions.contains(&unit.dimension))
        {
            return Ok(Some((format!("{quantity}_{}", unit.si), unit.si.to_owned(), unit.factor)));
        }
        // A name of somebody's own with a unit: `fx_wrist_sensor_N`.
        if self.stated(column).is_empty() && units::split(header).is_some() {
            return Ok(None);
        }
        // A number behind the name is the place in a list, no unit: `q_1`. A word for its part in a control loop is none either.
        let parts = header.match_indices('_').map(|(at, _)| (&header[..at], &header[at + 1..]));
        let parts = parts.filter(|(_, text)| !is_place(text) && !is_role(text));
        let alone = std::iter::once(match self.stated(column) {
            "" => written_units::in_header(header, &[]),
            stated => (header, stated),
        });
        let mut found = parts.chain(alone).filter_map(|(q, text)| Some((q, text, units::quantity_dimensions(q)?)));
        let word = header.split_once('_').filter(|(q, _)| ["force", "torque", "angle", "position"].contains(q));
        let Some((quantity, text, dimensions)) = found.next() else {
            let is_counts = word.filter(|(_, text)| written_units::parse(text, &[]) == Written::Counts);
            return is_counts.map_or(Ok(None), |(quantity, unit)| Err(self.unknown_unit(header, unit, quantity)));
        };
        match written_units::parse(text, dimensions) {
            Written::Known(dimension, factor) if dimensions.contains(&dimension) => {
                let si = units::si(dimension);
                Ok(Some((format!("{quantity}_{si}"), si.to_owned(), factor)))
            }
            // A mapped column measures the quantity.
            _ if self.meta.columns.keys().any(|k| units::split(k).is_some_and(|(q, _)| q == quantity)) => Ok(None),
            _ => Err(self.unknown_unit(header, text, quantity)),
        }
    }

    /// An error for a column whose name states another unit of the same dimension than the file does elsewhere. The sidecar
    /// decides by a scale or by a unit of its own (`q_mm`).
    pub(super) fn name_and_unit_agree(&self, name: &str, column: usize) -> Result<(), LogError> {
        let (header, stated) = (&self.headers[column], self.stated(column));
        let is_text = stated.contains(char::is_alphanumeric);
        let by_user = |(key, source): (&String, &String)| {
            source == header && units::split(key).is_some_and(|(_, unit)| unit.factor != 1.0)
        };
        let is_decided = self.meta.scale.contains_key(name)
            || self.meta.scale.contains_key(header)
            || self.meta.columns.iter().any(by_user);
        let Some((quantity, named)) = units::split(header).filter(|_| is_text && !is_decided) else {
            return Ok(());
        };
        match written_units::parse(stated, &[named.dimension]) {
            _ if named.dimension == Dimension::Other => Ok(()),
            Written::Known(dimension, factor)
                if dimension == named.dimension && (factor / named.factor - 1.0).abs() <= 1e-9 =>
            {
                Ok(())
            }
            Written::Known(dimension, factor) => Err(LogError::TwoUnits {
                column: header.clone(),
                named: named.symbol,
                stated: stated.to_owned(),
                factor: (dimension == named.dimension).then(|| factor / named.factor),
                path: self.path.to_path_buf(),
            }),
            Written::Counts | Written::Unknown => Err(self.unknown_unit(header, stated, quantity)),
        }
    }

    /// Reason why a column with a name of the program's is not used: what the sidecar maps comes first.
    fn is_unwanted(&self, name: &str) -> Option<String> {
        if self.mapped(name) {
            return Some(format!("\"columns\" in the sidecar maps another one to `{name}`"));
        }
        if self.meta.columns.iter().any(|(key, source)| source.is_empty() && canonical(key) == name) {
            return Some(format!("\"columns\" in the sidecar says that the file has no `{name}`"));
        }
        let mut motions =
            self.meta.columns.iter().filter(|(_, source)| !source.is_empty()).map(|(key, _)| canonical(key));
        let motions: Vec<String> = motions.by_ref().filter(|key| is_motion(key)).collect();
        let first = motions.first()?;
        let is_mentioned = self.meta.scale.contains_key(name) || self.meta.sign.contains_key(name);
        let is_apart =
            !is_mentioned && !motions.iter().any(|motion| forms(motion).iter().any(|form| forms(name).contains(form)));
        (is_apart && !forms(name).is_empty())
            .then(|| format!("\"columns\" in the sidecar asks for another motion, `{first}`"))
    }
}

/// True for a word that says which of several signals a column holds: `q_des`, `f_cmd`, `x_ref`, `tau_J[0]`.
fn is_role(text: &str) -> bool {
    const ROLES: [&str; 24] = [
        "ref",
        "reference",
        "des",
        "desired",
        "d",
        "cmd",
        "command",
        "commanded",
        "set",
        "setpoint",
        "target",
        "goal",
        "act",
        "actual",
        "meas",
        "measured",
        "est",
        "estimated",
        "ext",
        "start",
        "end",
        "current",
        "j",
        "hat",
    ];
    let word = text.split(['[', '(', ' ', '_', '.']).next().unwrap_or_default().to_ascii_lowercase();
    ROLES.contains(&word.as_str())
}

fn is_place(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit())
}

/// `qx` to `qw`, or `r11` to `r33`, for a name of such a part.
fn part_of_orientation(header: &str) -> Option<String> {
    let name = header.to_ascii_lowercase();
    if MATRIX.contains(&name.as_str()) {
        return Some(name);
    }
    let part = name.chars().last().filter(|part| "xyzw".contains(*part))?;
    let stem = &name[..name.len() - 1];
    let is_quaternion = ["q", "quat_", "quaternion_", "ori_", "orientation_", "orientation."].contains(&stem)
        || stem.ends_with(".orientation.");
    is_quaternion.then(|| format!("q{part}"))
}

/// Kinds of motion that a name of the program belongs to: a coordinate along a line or about an axis, a tool, two tips, and
/// the joints of one finger or two. None for others.
pub(super) fn forms(name: &str) -> &'static [u8] {
    let Some((quantity, unit)) = units::split(name) else { return &[] };
    let stem = quantity.trim_end_matches(['1', '2']);
    let fingered = stem.len() < quantity.len();
    match (stem, fingered) {
        ("q", false) if unit.dimension == Dimension::Length => &[0],
        ("dq", false) if unit.dimension == Dimension::Velocity => &[0],
        ("ddq", false) if unit.dimension == Dimension::Acceleration => &[0],
        ("q" | "dq" | "ddq" | "tau", false) => &[1],
        ("f", false) => &[0],
        ("x" | "y" | "z" | "vx" | "vy" | "vz", false) => &[2],
        ("x" | "y" | "vx" | "vy", true) => &[3],
        ("qb" | "qt" | "dqb" | "dqt", false) => &[4],
        ("qb" | "qt" | "dqb" | "dqt", true) => &[5],
        ("fx" | "fy" | "fz", false) => &[2, 4],
        ("fx" | "fy", true) => &[3, 5],
        _ => &[],
    }
}

/// True for positions and angles.
fn is_motion(name: &str) -> bool {
    let unit = units::split(name).map(|(_, unit)| unit.dimension);
    !forms(name).is_empty() && matches!(unit, Some(Dimension::Length | Dimension::Angle))
}
