//! Keys of actions, and the search by a few letters.

use crate::ui::shell::actions::list::Action;
use crate::ui::shell::app::App;
use egui::{KeyboardShortcut, Ui};

/// Runs the actions of the pressed keys; called once per frame, while no dialog is open.
pub fn keys(ui: &Ui, app: &mut App) {
    let ctx = ui.ctx().clone();
    let typing = ctx.egui_wants_keyboard_input();
    // Additional Shift or Alt makes another shortcut: those with the most modifiers come first.
    let mut all: Vec<(Action, KeyboardShortcut)> =
        Action::all(app).filter_map(|a| a.keys().map(|keys| (a, keys))).collect();
    all.sort_by_key(|(_, k)| std::cmp::Reverse(usize::from(k.modifiers.shift) + usize::from(k.modifiers.alt)));
    for (action, keys) in all {
        // While a text field has the focus, letters are text.
        let plain = keys.modifiers.is_none() && !action.works_while_typing();
        if plain && typing {
            continue;
        }
        // A key without an available action is left to the panels: in Train the space bar pinches.
        if action.why_not(app).is_none() && ctx.input_mut(|i| i.consume_shortcut(&keys)) {
            action.run(&ctx, app);
        }
    }
}

/// Display text of a shortcut, e.g. `Ctrl+Z`.
pub fn key_text(ui: &Ui, action: &Action) -> String {
    action.keys().map(|keys| ui.ctx().format_shortcut(&keys)).unwrap_or_default()
}

/// Actions that the window currently offers, best match of `query` first; all of them for an empty one.
pub fn matching(app: &App, query: &str) -> Vec<Action> {
    if query.trim().is_empty() {
        return Action::all(app).collect();
    }
    let mut scored: Vec<(i64, usize, Action)> = Action::all(app)
        .enumerate()
        .filter_map(|(place, action)| Some((score(&action.search_text(), query)?, place, action)))
        .collect();
    scored.sort_by_key(|(score, place, _)| (std::cmp::Reverse(*score), *place));
    scored.into_iter().map(|(_, _, action)| action).collect()
}

/// Match of `text` with `query`: its letters in order, better at the starts of words and side by side. `None` without a
/// match.
fn score(text: &str, query: &str) -> Option<i64> {
    let text: Vec<char> = text.to_lowercase().chars().collect();
    let query: Vec<char> = query.to_lowercase().chars().filter(|c| !c.is_whitespace()).collect();
    // Best score up to every letter, given the best scores before it.
    let mut best: Vec<Option<i64>> = vec![Some(0); text.len() + 1];
    for (k, wanted) in query.iter().enumerate() {
        let mut next = vec![None; text.len() + 1];
        let mut before: Option<i64> = None;
        for (i, letter) in text.iter().enumerate() {
            // Any position so far, or the one just before.
            before = before.max(best[i]);
            if letter == wanted {
                let starts = i == 0 || !text[i - 1].is_alphanumeric();
                let apart = before.map(|b| {
                    b + if i == 0 {
                        8
                    } else if starts {
                        6
                    } else {
                        1
                    }
                });
                let beside = if k > 0 { best[i].map(|b| b + 8) } else { None };
                next[i + 1] = apart.max(beside);
            }
        }
        best = next;
    }
    let reached = best.iter().flatten().max().copied()?;
    // Among equal matches the shorter text wins.
    Some(reached * 100 - i64::try_from(text.len()).ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::tests::{STACK, empty, session};

    fn first(app: &App, query: &str) -> String {
        matching(app, query).first().map(Action::title).unwrap_or_default()
    }

    #[test]
    fn a_few_letters_find_what_is_meant() {
        let app = App::new(session(STACK.clone()));
        assert_eq!(first(&app, "undo"), "Undo");
        assert_eq!(first(&app, "opl"), "Open log …");
        assert_eq!(first(&app, "refit"), "Fit again");
        assert_eq!(first(&app, "carry block 2"), "Go to: carry block 2");
        assert_eq!(first(&app, "dark"), "Light or dark");
        assert!(matching(&app, "zzzqqq").is_empty());
    }

    #[test]
    fn no_two_actions_share_their_keys() {
        let app = App::new(session(STACK.clone()));
        let mut keys: Vec<_> = Action::all(&app).filter_map(|a| a.keys()).collect();
        let count = keys.len();
        keys.dedup_by(|a, b| a == b);
        let mut unique = Vec::new();
        for key in keys {
            assert!(!unique.contains(&key), "{key:?}");
            unique.push(key);
        }
        assert!(unique.len() == count && count > 12);
    }

    #[test]
    fn what_cannot_be_done_says_why() {
        let app = App::new(empty());
        for action in [Action::Fit, Action::SaveWorld, Action::Undo, Action::Report] {
            assert!(action.why_not(&app).is_some_and(|why| why.ends_with('.')), "{action:?}");
        }
        assert!(Action::OpenLog.why_not(&app).is_none());
    }
}
