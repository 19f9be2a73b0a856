//! The look of the page: rules in `style.css`, colours from the window's theme.

use crate::ui::kit::theme::{Palette, curve, ink_on, state_color};
use egui::Color32;
use estimator::segment::SystemState;
use render::ColorRole;
use std::fmt::Write as _;

const RULES: &str = include_str!("style.css");

/// Roles that curves can have.
const ROLES: [ColorRole; 13] = [
    ColorRole::Finger(0),
    ColorRole::Finger(1),
    ColorRole::Block(0),
    ColorRole::Block(1),
    ColorRole::Block(2),
    ColorRole::Block(3),
    ColorRole::Block(4),
    ColorRole::Block(5),
    ColorRole::Measured,
    ColorRole::Simulated,
    ColorRole::Constraint,
    ColorRole::Saturated,
    ColorRole::Neutral,
];

/// The variable of a role's colour, without its dashes; `second` is the other curve of a finger.
pub fn role_name(role: ColorRole, second: bool) -> String {
    let name = match role {
        ColorRole::Finger(k) => format!("finger-{}", k % 2),
        ColorRole::Block(k) => format!("block-{}", k % 6),
        ColorRole::Measured => "measured".to_owned(),
        ColorRole::Simulated => "simulated".to_owned(),
        ColorRole::Constraint => "constraint".to_owned(),
        ColorRole::Saturated => "saturated".to_owned(),
        ColorRole::Neutral => "neutral".to_owned(),
    };
    if second { name + "-b" } else { name }
}

/// The variable of a state's colour, without its dashes.
pub fn state_variable(state: SystemState) -> String {
    format!("state-{}", state.name())
}

/// Content of the page's `<style>` element.
pub fn css() -> String {
    format!(
        ":root{{color-scheme:light dark;{}}}\n@media screen and (prefers-color-scheme:dark){{:root{{{}}}}}\n{RULES}",
        variables(false),
        variables(true)
    )
}

/// Colour in hexadecimal notation for pages and pictures.
pub fn hex(color: Color32) -> String {
    let [r, g, b, _] = color.to_array();
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn variables(dark: bool) -> String {
    let p = Palette::of(dark);
    let mut text = String::new();
    let mut set = |name: &str, color: Color32| {
        let _ = write!(text, "--{name}:{};", hex(color));
    };
    for (name, color) in [
        ("window", p.window),
        ("card", p.card),
        ("sunken", p.sunken),
        ("border", p.border),
        ("text", p.text),
        ("secondary", p.secondary),
        ("faint", p.faint),
        ("accent", p.accent),
        ("danger", p.danger),
        ("caution", p.caution),
        ("good", p.good),
    ] {
        set(name, color);
    }
    for role in ROLES {
        for second in [false, true] {
            set(&role_name(role, second), curve(dark, role, second));
        }
    }
    for state in SystemState::ALL {
        let color = state_color(dark, state);
        set(&state_variable(state), color);
        set(&format!("{}-ink", state_variable(state)), ink_on(color));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_variable_that_is_used_is_set_in_both_themes() {
        let css = css();
        let used: Vec<&str> = RULES.split("var(--").skip(1).filter_map(|rest| rest.split(')').next()).collect();
        assert!(used.len() > 20);
        for name in used {
            assert_eq!(css.matches(&format!("--{name}:#")).count(), 2, "{name}");
        }
    }

    #[test]
    fn the_rules_fetch_nothing_and_are_whole() {
        let css = css();
        assert!(!css.contains("url(") && !css.contains("@import") && !css.contains("</"));
        assert_eq!(css.matches('{').count(), css.matches('}').count());
    }
}
