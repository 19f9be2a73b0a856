//! A law with its values: a world file stores it and the servo runs it.

use super::catalogue::law;
use super::entry::Enters;
use super::force_law::{Law, MAX_PARAMETERS, Motion, Role, tame};
use super::memory::Memory;
use serde::{Deserialize, Serialize};

/// A law with its parameter values.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(try_from = "EffectFile", into = "EffectFile")]
pub struct Effect {
    law: &'static dyn Law,
    /// The law's role, kept here because the servo asks for it several times a tick.
    role: Role,
    /// True if the law has a memory.
    remembers: bool,
    /// Values, in the order of [`Law::parameters`]; unused places are zero.
    pub values: [f64; MAX_PARAMETERS],
    /// Switched off effects stay in the file and add nothing.
    pub enabled: bool,
}

impl Effect {
    /// A law with the given parameter values (missing ones are zero).
    pub fn new(law: &'static dyn Law, values: &[f64]) -> Self {
        let mut padded = [0.0; MAX_PARAMETERS];
        for (to, from) in padded.iter_mut().zip(values) {
            *to = *from;
        }
        Self { law, role: law.role(), remembers: law.remembers(), values: padded, enabled: true }
    }

    /// The law itself.
    pub fn law(&self) -> &'static dyn Law {
        self.law
    }

    /// The law's part in the equation of motion.
    pub fn role(&self) -> Role {
        self.role
    }

    /// True if the law has a memory that must be moved along.
    pub fn remembers(&self) -> bool {
        self.remembers
    }

    /// Force of this effect, N or N m; zero when switched off. A law with memory returns its developed force.
    pub fn force(&self, motion: &Motion) -> f64 {
        if self.enabled { tame(self.law.force(motion, &self.values)) } else { 0.0 }
    }

    /// Force of this effect with its memory, N or N m; zero when switched off.
    pub fn force_with(&self, motion: &Motion, memory: &Memory) -> f64 {
        if self.enabled { tame(self.law.force_with(motion, &self.values, memory)) } else { 0.0 }
    }

    /// Columns d(force)/d(parameter) at the effect's own values: exact for linear parameters, central differences for
    /// nonlinear ones, zero for fixed ones. The memory is held: how it depends on the parameters is not in the columns.
    pub fn columns(&self, motion: &Motion, memory: &Memory) -> [f64; MAX_PARAMETERS] {
        let specs = self.law.parameters();
        let mut columns = [0.0; MAX_PARAMETERS];
        for (index, spec) in specs.iter().enumerate() {
            let at = |value: f64| {
                let mut values = self.values;
                values[index] = value;
                tame(self.law.force_with(motion, &values, memory))
            };
            columns[index] = match spec.enters {
                Enters::Linear => {
                    let mut unit = self.values;
                    for (value, other) in unit.iter_mut().zip(specs) {
                        *value = if other.enters == Enters::Linear { 0.0 } else { *value };
                    }
                    unit[index] = 1.0;
                    tame(self.law.force_with(motion, &unit, memory))
                }
                Enters::Nonlinear => {
                    let at_zero = if self.values[index] == 0.0 { 1e-3 } else { 0.0 };
                    let step = 1e-6 * self.values[index].abs().max(at_zero);
                    (at(self.values[index] + step) - at(self.values[index] - step)) / (2.0 * step)
                }
                Enters::Fixed => 0.0,
            };
        }
        columns
    }
}

impl std::fmt::Debug for Effect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}{:?}", self.law.id(), &self.values[..self.law.parameters().len()])
    }
}

impl PartialEq for Effect {
    fn eq(&self, other: &Self) -> bool {
        self.law.id() == other.law.id() && self.values == other.values && self.enabled == other.enabled
    }
}

/// An effect as it stands in a world file.
#[derive(Clone, Serialize, Deserialize)]
struct EffectFile {
    id: String,
    parameters: std::collections::BTreeMap<String, f64>,
    #[serde(default = "yes")]
    enabled: bool,
}

fn yes() -> bool {
    true
}

impl From<Effect> for EffectFile {
    fn from(effect: Effect) -> Self {
        let specs = effect.law.parameters().iter();
        Self {
            id: effect.law.id().to_owned(),
            parameters: specs.zip(effect.values).map(|(s, v)| (s.name.to_owned(), v)).collect(),
            enabled: effect.enabled,
        }
    }
}

impl TryFrom<EffectFile> for Effect {
    type Error = String;

    fn try_from(file: EffectFile) -> Result<Self, String> {
        let law = law(&file.id).ok_or_else(|| format!("there is no law called `{}`", file.id))?;
        let mut effect = Self { enabled: file.enabled, ..Self::new(law, &[]) };
        for (name, value) in file.parameters {
            let index = law
                .parameters()
                .iter()
                .position(|spec| spec.name == name)
                .ok_or_else(|| format!("the law `{}` has no parameter `{name}`", file.id))?;
            if !value.is_finite() {
                return Err(format!("parameter `{name}` of `{}` is not a finite number", file.id));
            }
            effect.values[index] = value;
        }
        Ok(effect)
    }
}

#[cfg(test)]
mod tests {
    use super::super::CoulombFriction;
    use super::*;

    #[test]
    fn an_effect_survives_its_file_and_a_wrong_one_is_named() {
        let effect = Effect::new(&CoulombFriction, &[0.25]);
        let text = serde_json::to_string(&effect).expect("an effect serialises");
        assert_eq!(text, r#"{"id":"coulomb-friction","parameters":{"Fc":0.25},"enabled":true}"#);
        assert_eq!(serde_json::from_str::<Effect>(&text).expect("reads back"), effect);
        let wrong = serde_json::from_str::<Effect>(r#"{"id":"coulomb-friction","parameters":{"mu":1}}"#);
        assert!(wrong.expect_err("unknown parameter").to_string().contains("no parameter `mu`"));
    }
}
