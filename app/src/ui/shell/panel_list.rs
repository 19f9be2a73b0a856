//! All panels, from the lists of the features.

use crate::ui::shell::panel::Registration;
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use crate::ui::{calibrate, devices, diagnose, train};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

/// All panels. The list of a feature is in the root of its folder `panels`.
pub fn panels() -> impl Iterator<Item = &'static Registration> {
    let lists = [calibrate::panels::PANELS, train::panels::PANELS, diagnose::panels::PANELS, devices::panels::PANELS];
    lists.into_iter().flatten().copied()
}

/// The names of all panels.
pub fn ids() -> impl Iterator<Item = PanelId> {
    panels().map(|panel| panel.id)
}

/// The registration of a panel; none where no panel has this name.
pub fn registration(id: PanelId) -> Option<&'static Registration> {
    panels().find(|panel| panel.id == id)
}

/// The panels that make sense in a workspace, in the order of its menu.
pub fn of(workspace: Workspace) -> Vec<PanelId> {
    let place = |panel: &Registration| panel.workspaces.iter().find(|(w, _)| *w == workspace).map(|(_, place)| *place);
    let mut found: Vec<_> = panels().filter_map(|panel| Some((place(panel)?, panel.id))).collect();
    found.sort_unstable();
    found.into_iter().map(|(_, id)| id).collect()
}

impl Serialize for PanelId {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.0)
    }
}

impl<'de> Deserialize<'de> for PanelId {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        ids().find(|id| id.0 == name).ok_or_else(|| de::Error::custom(format!("there is no panel `{name}`")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::headless::screenshot::pictures;
    use std::collections::BTreeSet;

    #[test]
    fn names_are_unique_and_neighbours_exist() {
        assert_eq!(ids().collect::<BTreeSet<_>>().len(), panels().count());
        for panel in panels() {
            assert!(panel.neighbours.iter().all(|(id, ..)| registration(*id).is_some()), "{}", panel.title);
            assert!(!panel.workspaces.is_empty(), "{}", panel.title);
        }
        let names: BTreeSet<&str> = pictures().map(|picture| picture.name).collect();
        assert_eq!(names.len(), pictures().count());
    }

    #[test]
    fn a_panel_survives_a_file_and_an_unknown_one_is_refused() {
        let text = serde_json::to_string(&PanelId::TRAINER_SIDE).expect("written");
        assert_eq!(text, "\"trainer-side\"");
        assert_eq!(serde_json::from_str::<PanelId>(&text).expect("read"), PanelId::TRAINER_SIDE);
        assert!(serde_json::from_str::<PanelId>("\"none\"").is_err());
    }
}
