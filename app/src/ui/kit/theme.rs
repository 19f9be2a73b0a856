//! One look for the whole program: palette, type scale, spacing, and the egui styles made from them.
//!
//! Colours that carry a meaning (fingers, blocks, measured, simulated …) are those of the pictures, [`render::Theme`], so that
//! a curve has the colour of the finger it belongs to.

use egui::style::{Selection, WidgetVisuals};
use egui::{
    Color32, CornerRadius, FontData, FontDefinitions, FontFamily, FontId, RichText, Stroke, TextStyle, Visuals,
};
use estimator::segment::SystemState;
use render::ColorRole;
use std::sync::Arc;

/// Distances between things, points.
pub mod space {
    /// Inside a group of words.
    pub const XS: f32 = 4.0;
    /// Between neighbours.
    pub const S: f32 = 8.0;
    /// Between groups; padding of cards.
    pub const M: f32 = 12.0;
    /// Between sections.
    pub const L: f32 = 16.0;
    /// Around empty states.
    pub const XL: f32 = 28.0;
}

/// Rounding of cards.
pub const CARD_RADIUS: u8 = 8;
/// Rounding of buttons and fields.
pub const CONTROL_RADIUS: u8 = 6;

/// Colours of surfaces and text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Palette {
    /// Behind everything.
    pub window: Color32,
    /// Side columns and cards.
    pub card: Color32,
    /// Fields, tracks, plot areas: a step into the depth.
    pub sunken: Color32,
    /// Buttons.
    pub raised: Color32,
    /// Buttons under the pointer.
    pub hovered: Color32,
    /// Hairlines.
    pub border: Color32,
    /// Words.
    pub text: Color32,
    /// Words that explain.
    pub secondary: Color32,
    /// Words that may be overlooked.
    pub faint: Color32,
    /// The one thing to do, the cursor, the selection.
    pub accent: Color32,
    /// Words on the accent.
    pub on_accent: Color32,
    /// Errors, clamped forces.
    pub danger: Color32,
    /// Warnings.
    pub caution: Color32,
    /// Running, identified, fine.
    pub good: Color32,
}

const LIGHT: Palette = Palette {
    window: Color32::from_rgb(0xEE, 0xF1, 0xF5),
    card: Color32::from_rgb(0xFF, 0xFF, 0xFF),
    sunken: Color32::from_rgb(0xF4, 0xF6, 0xF9),
    raised: Color32::from_rgb(0xE9, 0xED, 0xF2),
    hovered: Color32::from_rgb(0xDD, 0xE3, 0xEB),
    border: Color32::from_rgb(0xD9, 0xDF, 0xE7),
    text: Color32::from_rgb(0x1B, 0x22, 0x2C),
    secondary: Color32::from_rgb(0x52, 0x5E, 0x6E),
    faint: Color32::from_rgb(0x75, 0x81, 0x91),
    accent: Color32::from_rgb(0x4C, 0x50, 0xC4),
    on_accent: Color32::WHITE,
    danger: Color32::from_rgb(0xC9, 0x2B, 0x00),
    caution: Color32::from_rgb(0x82, 0x58, 0x00),
    good: Color32::from_rgb(0x00, 0x7A, 0x5C),
};

const DARK: Palette = Palette {
    window: Color32::from_rgb(0x0E, 0x12, 0x17),
    card: Color32::from_rgb(0x18, 0x1D, 0x25),
    sunken: Color32::from_rgb(0x11, 0x16, 0x1C),
    raised: Color32::from_rgb(0x27, 0x2F, 0x3A),
    hovered: Color32::from_rgb(0x33, 0x3D, 0x4A),
    border: Color32::from_rgb(0x2A, 0x32, 0x3D),
    text: Color32::from_rgb(0xE6, 0xEA, 0xF0),
    secondary: Color32::from_rgb(0xA3, 0xAE, 0xBC),
    faint: Color32::from_rgb(0x7B, 0x88, 0x98),
    accent: Color32::from_rgb(0x8A, 0x8E, 0xF5),
    on_accent: Color32::from_rgb(0x0E, 0x10, 0x24),
    danger: Color32::from_rgb(0xFF, 0x6B, 0x3F),
    caution: Color32::from_rgb(0xE8, 0xB9, 0x4A),
    good: Color32::from_rgb(0x3C, 0xD6, 0xAC),
};

impl Palette {
    /// The palette of a theme.
    pub fn of(dark: bool) -> &'static Self {
        if dark { &DARK } else { &LIGHT }
    }
}

/// The palette that `ui` is drawn with.
pub fn palette(ui: &egui::Ui) -> &'static Palette {
    Palette::of(ui.visuals().dark_mode)
}

/// The pictures' theme that goes with it.
pub fn scene_theme(dark: bool) -> render::Theme {
    if dark { render::Theme::Dark } else { render::Theme::Light }
}

/// The colour of a role, as in the pictures.
pub fn role(dark: bool, role: ColorRole) -> Color32 {
    let [r, g, b] = scene_theme(dark).color(role).bytes();
    Color32::from_rgb(r, g, b)
}

/// The role's colour for a curve; the second curve of a finger is a lighter or darker shade of it.
pub fn curve(dark: bool, of: ColorRole, second: bool) -> Color32 {
    let color = role(dark, of);
    if !second {
        color
    } else if dark {
        mix(color, Color32::WHITE, 0.45)
    } else {
        mix(color, Color32::BLACK, 0.38)
    }
}

/// The colour of another recording that lies over the shown one, by its place among them: none of those is a finger's.
pub fn recording(dark: bool, place: usize) -> Color32 {
    role(dark, ColorRole::Block([4, 1, 2, 5, 3][place % 5]))
}

/// Color of a time as a share of the whole, 0 … 1: from dark to bright without red beside green (after viridis, van der
/// Walt and Smith 2015). It leaves out the end that would be lost on the background.
pub fn time_color(dark: bool, share: f32) -> Color32 {
    const STOPS: [[u8; 3]; 6] = [
        [0x44, 0x01, 0x54],
        [0x41, 0x44, 0x87],
        [0x2A, 0x78, 0x8E],
        [0x22, 0xA8, 0x84],
        [0x7A, 0xD1, 0x51],
        [0xFD, 0xE7, 0x25],
    ];
    let (from, to) = if dark { (0.24, 1.0) } else { (0.0, 0.80) };
    let at = (from + (to - from) * share.clamp(0.0, 1.0)) * (STOPS.len() - 1) as f32;
    let low = (at as usize).min(STOPS.len() - 2);
    let stop = |k: usize| Color32::from_rgb(STOPS[k][0], STOPS[k][1], STOPS[k][2]);
    mix(stop(low), stop(low + 1), at - low as f32)
}

/// The colour of a contact state, in band, legend and plots.
pub fn state_color(dark: bool, state: SystemState) -> Color32 {
    match state {
        SystemState::FreeMotion if dark => Color32::from_rgb(0x4A, 0x56, 0x66),
        SystemState::FreeMotion => Color32::from_rgb(0xC3, 0xCC, 0xD8),
        SystemState::HoldOnGround | SystemState::Insertion => role(dark, ColorRole::Block(2)),
        SystemState::HoldAboveGround | SystemState::Penetration => role(dark, ColorRole::Block(0)),
        SystemState::SlidingOnGround | SystemState::Extraction => role(dark, ColorRole::Block(1)),
        SystemState::Turning => role(dark, ColorRole::Block(3)),
        SystemState::Holding => role(dark, ColorRole::Block(4)),
        SystemState::NoState if dark => Color32::from_rgb(0x22, 0x29, 0x33),
        SystemState::NoState => Color32::from_rgb(0xE6, 0xEA, 0xEF),
    }
}

/// The colour of a state for lines: free motion is seen against the background, too.
pub fn state_ink(dark: bool, state: SystemState) -> Color32 {
    match state {
        SystemState::FreeMotion | SystemState::NoState => role(dark, ColorRole::Neutral),
        other => state_color(dark, other),
    }
}

/// Black or white, whichever reads better on `background`.
pub fn ink_on(background: Color32) -> Color32 {
    let [r, g, b, _] = background.to_array().map(f32::from);
    if 0.299 * r + 0.587 * g + 0.114 * b > 105.0 { Color32::from_rgb(0x14, 0x18, 0x1E) } else { Color32::WHITE }
}

/// `a` and `b` mixed, 0 … 1.
pub fn mix(a: Color32, b: Color32, share: f32) -> Color32 {
    a.lerp_to_gamma(b, share)
}

/// The semibold family.
pub fn semibold() -> FontFamily {
    FontFamily::Name("semibold".into())
}

/// Name of the program, titles of empty states.
pub fn title(text: impl Into<String>) -> RichText {
    RichText::new(text).font(FontId::new(18.0, semibold()))
}

/// Headings of cards.
pub fn heading(text: impl Into<String>) -> RichText {
    RichText::new(text).font(FontId::new(13.5, semibold()))
}

/// Body text with weight.
pub fn strong(text: impl Into<String>) -> RichText {
    RichText::new(text).font(FontId::new(13.0, semibold()))
}

/// Small explanations.
pub fn caption(ui: &egui::Ui, text: impl Into<String>) -> RichText {
    RichText::new(text).size(11.5).color(palette(ui).secondary)
}

/// Loads the fonts and sets both styles; call once for a context.
pub fn install(ctx: &egui::Context) {
    ctx.set_fonts(fonts());
    for dark in [false, true] {
        let theme = if dark { egui::Theme::Dark } else { egui::Theme::Light };
        ctx.style_mut_of(theme, |style| {
            style.visuals = visuals(dark);
            sizes(style);
        });
    }
}

fn fonts() -> FontDefinitions {
    let mut fonts = FontDefinitions::default();
    let regular = FontData::from_static(include_bytes!("fonts/Inter-Regular.otf"));
    let bold = FontData::from_static(include_bytes!("fonts/Inter-SemiBold.otf"));
    fonts.font_data.insert("inter".to_owned(), Arc::new(regular));
    fonts.font_data.insert("inter-semibold".to_owned(), Arc::new(bold));
    let mut proportional = fonts.families.get(&FontFamily::Proportional).cloned().unwrap_or_default();
    let mut heavy = proportional.clone();
    proportional.insert(0, "inter".to_owned());
    heavy.insert(0, "inter-semibold".to_owned());
    let mut icons = proportional.clone();
    icons.insert(0, "icons".to_owned());
    fonts.font_data.insert("icons".to_owned(), Arc::new(crate::ui::kit::icons::font()));
    fonts.families.insert(crate::ui::kit::icons::family(), icons);
    fonts.families.insert(FontFamily::Proportional, proportional);
    fonts.families.insert(semibold(), heavy);
    fonts
}

fn sizes(style: &mut egui::Style) {
    style.text_styles = [
        (TextStyle::Small, FontId::proportional(11.5)),
        (TextStyle::Body, FontId::proportional(13.0)),
        (TextStyle::Button, FontId::proportional(13.0)),
        (TextStyle::Heading, FontId::new(15.0, semibold())),
        (TextStyle::Monospace, FontId::monospace(12.0)),
    ]
    .into();
    let spacing = &mut style.spacing;
    spacing.item_spacing = egui::vec2(space::S, 6.0);
    spacing.button_padding = egui::vec2(10.0, 5.0);
    spacing.interact_size.y = 26.0;
    spacing.combo_width = 60.0;
    spacing.icon_width = 15.0;
    spacing.menu_margin = egui::Margin::same(6);
    spacing.scroll = egui::style::ScrollStyle { floating: true, ..egui::style::ScrollStyle::thin() };
    style.interaction.tooltip_delay = 0.25;
    style.interaction.selectable_labels = false;
    style.animation_time = 0.08;
}

fn visuals(dark: bool) -> Visuals {
    let p = Palette::of(dark);
    let mut v = if dark { Visuals::dark() } else { Visuals::light() };
    let radius = CornerRadius::same(CONTROL_RADIUS);
    let widget = |fill: Color32, stroke: Color32, text: Color32| WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: Stroke::new(1.0, stroke),
        fg_stroke: Stroke::new(1.2, text),
        corner_radius: radius,
        expansion: 0.0,
    };
    v.widgets.noninteractive = widget(p.card, p.border, p.text);
    v.widgets.inactive = widget(p.raised, mix(p.border, p.faint, 0.25), p.text);
    v.widgets.hovered = widget(p.hovered, p.border, p.text);
    v.widgets.active = widget(mix(p.hovered, p.accent, 0.25), p.accent, p.text);
    v.widgets.open = widget(p.hovered, p.border, p.text);
    v.selection = Selection { bg_fill: mix(p.card, p.accent, 0.28), stroke: Stroke::new(1.0, p.text) };
    v.hyperlink_color = p.accent;
    v.panel_fill = p.window;
    v.window_fill = p.card;
    v.window_stroke = Stroke::new(1.0, p.border);
    v.window_corner_radius = CornerRadius::same(CARD_RADIUS);
    v.menu_corner_radius = CornerRadius::same(CARD_RADIUS);
    v.extreme_bg_color = p.sunken;
    v.text_edit_bg_color = Some(p.sunken);
    v.faint_bg_color = mix(p.card, p.sunken, 0.6);
    v.code_bg_color = p.sunken;
    v.warn_fg_color = p.caution;
    v.error_fg_color = p.danger;
    v.weak_text_color = Some(p.secondary);
    v.slider_trailing_fill = true;
    v.striped = false;
    v
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance and contrast of WCAG 2.
    fn contrast(a: Color32, b: Color32) -> f32 {
        let luminance = |c: Color32| {
            let [r, g, b, _] = egui::Rgba::from(c).to_array();
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
        a.max(b) / a.min(b)
    }

    #[test]
    fn words_can_be_read_in_both_themes() {
        for dark in [false, true] {
            let p = Palette::of(dark);
            for background in [p.window, p.card, p.sunken] {
                assert!(contrast(p.text, background) > 7.0);
                assert!(contrast(p.secondary, background) > 4.5);
                assert!(contrast(p.danger, background) > 4.5, "danger, dark {dark}");
                assert!(contrast(p.caution, background) > 4.5, "caution, dark {dark}");
            }
            assert!(contrast(p.on_accent, p.accent) > 4.5);
        }
    }

    #[test]
    fn every_state_has_its_own_colour() {
        use SystemState::{FreeMotion, HoldAboveGround, HoldOnGround, Holding, NoState, SlidingOnGround, Turning};
        let states = [FreeMotion, HoldAboveGround, HoldOnGround, Holding, NoState, SlidingOnGround, Turning];
        for dark in [false, true] {
            let mut colors: Vec<[u8; 4]> = states.iter().map(|s| state_color(dark, *s).to_array()).collect();
            colors.sort_unstable();
            colors.dedup();
            assert_eq!(colors.len(), states.len());
        }
    }
}
