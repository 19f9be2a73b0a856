//! Named layouts, several per workspace.

use crate::ui::shell::dock::arrangement::{Arrangement, Dock};
use crate::ui::shell::workspace::Workspace;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Maximum length of a name, characters: it must fit in a menu.
pub const LONGEST: usize = 40;

/// Named layouts of one workspace.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Named {
    all: BTreeMap<String, Arrangement>,
    /// Name of the layout chosen last.
    chosen: Option<String>,
}

impl Dock {
    /// Names of a workspace's layouts, in alphabetical order.
    pub fn names(&self, workspace: Workspace) -> impl Iterator<Item = &str> {
        self.named.get(&workspace).into_iter().flat_map(|named| named.all.keys().map(String::as_str))
    }

    /// Name of the open layout, modified or not since.
    pub fn chosen(&self, workspace: Workspace) -> Option<&str> {
        self.named.get(&workspace)?.chosen.as_deref()
    }

    /// Reason against a name, as a sentence; `renamed` is the layout that would get it.
    pub fn why_not_name(&self, workspace: Workspace, name: &str, renamed: Option<&str>) -> Option<&'static str> {
        let name = name.trim();
        if name.is_empty() {
            Some("Give it a name.")
        } else if name.chars().count() > LONGEST {
            Some("This name is too long for a menu.")
        } else if renamed.is_some_and(|old| old != name) && self.names(workspace).any(|n| n == name) {
            Some("Another arrangement has this name.")
        } else {
            None
        }
    }

    /// Saves the current layout under a name and replaces one of the same name. False if the name is invalid.
    pub fn save_as(&mut self, workspace: Workspace, name: &str) -> bool {
        if self.why_not_name(workspace, name, None).is_some() {
            return false;
        }
        let as_it_is = self.of(workspace).clone();
        let named = self.named.entry(workspace).or_default();
        named.all.insert(name.trim().to_owned(), as_it_is);
        named.chosen = Some(name.trim().to_owned());
        true
    }

    /// Restores a named layout; false if there is none of this name.
    pub fn choose(&mut self, workspace: Workspace, name: &str) -> bool {
        let Some(named) = self.named.get_mut(&workspace) else { return false };
        let Some(kept) = named.all.get(name).cloned() else { return false };
        named.chosen = Some(name.to_owned());
        self.all.insert(workspace, kept);
        true
    }

    /// Renames a layout; false if the new name is invalid.
    pub fn rename(&mut self, workspace: Workspace, old: &str, new: &str) -> bool {
        if self.why_not_name(workspace, new, Some(old)).is_some() {
            return false;
        }
        let Some(named) = self.named.get_mut(&workspace) else { return false };
        let Some(kept) = named.all.remove(old) else { return false };
        named.all.insert(new.trim().to_owned(), kept);
        if named.chosen.as_deref() == Some(old) {
            named.chosen = Some(new.trim().to_owned());
        }
        true
    }

    /// Deletes a named layout; panels stay where they are.
    pub fn delete(&mut self, workspace: Workspace, name: &str) -> bool {
        let Some(named) = self.named.get_mut(&workspace) else { return false };
        named.chosen.take_if(|chosen| chosen == name);
        named.all.remove(name).is_some()
    }

    /// Clears the choice: the standard layout is open.
    pub(super) fn choose_none(&mut self, workspace: Workspace) {
        if let Some(named) = self.named.get_mut(&workspace) {
            named.chosen = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::shell::panel_id::PanelId;

    const AT: Workspace = Workspace::Calibrate;

    fn with_segments() -> Dock {
        let mut dock = Dock::default();
        dock.toggle(AT, PanelId::SEGMENTS);
        assert!(dock.save_as(AT, " with states "));
        dock
    }

    #[test]
    fn a_named_arrangement_comes_back_after_the_standard_one() {
        let mut dock = with_segments();
        dock.reset(AT);
        assert!(!dock.has(AT, PanelId::SEGMENTS) && dock.chosen(AT).is_none());
        assert!(dock.choose(AT, "with states"));
        assert!(dock.has(AT, PanelId::SEGMENTS) && dock.is_moved(AT) && dock.chosen(AT) == Some("with states"));
        // Later changes do not affect the saved layout.
        dock.toggle(AT, PanelId::SEGMENTS);
        assert!(dock.choose(AT, "with states") && dock.has(AT, PanelId::SEGMENTS));
        assert!(!dock.choose(AT, "nothing of the kind"));
        assert_eq!(dock.names(Workspace::Train).count(), 0, "every workspace has its own");
    }

    #[test]
    fn several_are_renamed_replaced_and_deleted() {
        let mut dock = with_segments();
        dock.toggle(AT, PanelId::SCENE);
        assert!(dock.save_as(AT, "no picture"));
        assert_eq!(dock.names(AT).collect::<Vec<_>>(), ["no picture", "with states"]);
        assert!(!dock.rename(AT, "no picture", "with states"), "that one is another's");
        assert!(dock.rename(AT, "no picture", "curves only") && dock.chosen(AT) == Some("curves only"));
        assert!(dock.choose(AT, "with states") && dock.has(AT, PanelId::SCENE));
        assert!(dock.save_as(AT, "curves only"), "replaced");
        assert!(dock.choose(AT, "curves only") && dock.has(AT, PanelId::SCENE));
        assert!(dock.delete(AT, "curves only") && !dock.delete(AT, "curves only"));
        assert_eq!((dock.names(AT).collect::<Vec<_>>(), dock.chosen(AT)), (vec!["with states"], None));
        assert!(dock.has(AT, PanelId::SCENE), "panels stay where they are");
    }

    #[test]
    fn names_that_will_not_do_say_why() {
        let mut dock = with_segments();
        assert!(!dock.save_as(AT, "  ") && !dock.save_as(AT, &"x".repeat(LONGEST + 1)));
        assert!(dock.why_not_name(AT, "with states", Some("with states")).is_none(), "its own name stays free");
        assert!(dock.why_not_name(AT, "with states", Some("other")).is_some_and(|why| why.ends_with('.')));
        assert!(!dock.rename(AT, "nothing of the kind", "new"));
    }

    #[test]
    fn they_survive_a_file_and_files_without_any_are_read() {
        let dock = with_segments();
        let text = serde_json::to_string(&dock).expect("written");
        let mut again: Dock = serde_json::from_str(&text).expect("read");
        again.reset(AT);
        assert!(again.choose(AT, "with states") && again.has(AT, PanelId::SEGMENTS));
        let old: Dock = serde_json::from_str(r#"{"all": {}}"#).expect("of an older version");
        assert_eq!(old.names(AT).count(), 0);
    }
}
