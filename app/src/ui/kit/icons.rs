//! The icons of the window, named once by what they mean. They come from Lucide's font, in which all have strokes of one width; words stay beside
//! them where there is room, and screen readers hear words only.

use egui::{Align2, Atom, Color32, FontFamily, FontId, Painter, Pos2, Rect, Response, Sense, Ui, vec2};
use lucide_icons::Icon as Glyph;

/// Side of the square that an icon takes beside words, points. Even sizes stand in the middle of a line to the pixel.
pub const SIZE: f32 = 16.0;
/// Beside small words.
pub const SMALL: f32 = 14.0;

/// Meaning of an icon.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, strum::EnumIter)]
#[expect(missing_docs, reason = "each name says what it stands for")]
pub enum Icon {
    // Files.
    Open,
    Save,
    SaveAs,
    Add,
    Video,
    World,
    Export,
    Report,
    Reload,
    Columns,
    Quit,
    // Changes.
    Undo,
    Redo,
    Forget,
    Remove,
    Reset,
    Lock,
    Adjust,
    // From a recording to numbers.
    Fit,
    Rules,
    FindStates,
    Shown,
    Whole,
    Check,
    Extend,
    Feel,
    Rehearse,
    Align,
    Layers,
    Atlas,
    Curves,
    // The hand and what it does.
    Touch,
    Device,
    Lesson,
    Help,
    Assistant,
    Record,
    Stop,
    Answer,
    // Time.
    Play,
    Pause,
    ToStart,
    ToEnd,
    // Workspaces and panels.
    Calibrate,
    Diagnose,
    Panel,
    Arrange,
    States,
    Scene,
    Sensitivity,
    Progress,
    // The window.
    Menu,
    Find,
    Light,
    Dark,
    Theme,
    Larger,
    Smaller,
    FullScreen,
    Close,
    Back,
    Next,
    Up,
    GoTo,
    More,
    // Severities.
    Doubt,
    Wrong,
    Good,
    Pending,
    Told,
}

impl Icon {
    fn glyph(self) -> Glyph {
        match self {
            Self::Open => Glyph::FolderOpen,
            Self::Save => Glyph::Save,
            Self::SaveAs => Glyph::SaveAll,
            Self::Add => Glyph::Plus,
            Self::Video => Glyph::Clapperboard,
            Self::World => Glyph::Box,
            Self::Export => Glyph::FileOutput,
            Self::Report => Glyph::FileText,
            Self::Reload => Glyph::RefreshCw,
            Self::Columns => Glyph::TableProperties,
            Self::Quit => Glyph::LogOut,
            Self::Undo => Glyph::Undo2,
            Self::Redo => Glyph::Redo2,
            Self::Forget => Glyph::Eraser,
            Self::Remove => Glyph::Trash2,
            Self::Reset => Glyph::RotateCcw,
            Self::Lock => Glyph::Lock,
            Self::Adjust => Glyph::SlidersHorizontal,
            Self::Fit => Glyph::ChartSpline,
            Self::Rules => Glyph::ListChecks,
            Self::FindStates => Glyph::ScanSearch,
            Self::Shown => Glyph::Crop,
            Self::Whole => Glyph::UnfoldHorizontal,
            Self::Check => Glyph::ClipboardCheck,
            Self::Extend => Glyph::Puzzle,
            Self::Feel => Glyph::Fingerprint,
            Self::Rehearse => Glyph::FlaskConical,
            Self::Align => Glyph::Magnet,
            Self::Layers => Glyph::Layers,
            Self::Atlas => Glyph::LayoutGrid,
            Self::Curves => Glyph::ChartLine,
            Self::Touch => Glyph::Hand,
            Self::Device => Glyph::Joystick,
            Self::Lesson => Glyph::GraduationCap,
            Self::Help => Glyph::CircleQuestionMark,
            Self::Assistant => Glyph::Lightbulb,
            Self::Record => Glyph::CircleDot,
            Self::Stop => Glyph::Square,
            Self::Answer => Glyph::MessageCircle,
            Self::Play => Glyph::Play,
            Self::Pause => Glyph::Pause,
            Self::ToStart => Glyph::SkipBack,
            Self::ToEnd => Glyph::SkipForward,
            Self::Calibrate => Glyph::Ruler,
            Self::Diagnose => Glyph::Stethoscope,
            Self::Arrange => Glyph::LayoutDashboard,
            Self::States => Glyph::ChartGantt,
            Self::Scene => Glyph::Rotate3d,
            Self::Sensitivity => Glyph::Scale,
            Self::Progress => Glyph::TrendingUp,
            Self::Menu => Glyph::Menu,
            Self::Find => Glyph::Search,
            Self::Light => Glyph::Sun,
            Self::Dark => Glyph::Moon,
            Self::Theme => Glyph::SunMoon,
            Self::Larger => Glyph::ZoomIn,
            Self::Smaller => Glyph::ZoomOut,
            Self::FullScreen => Glyph::Maximize,
            Self::Close => Glyph::X,
            Self::Back => Glyph::ArrowLeft,
            Self::Next => Glyph::ArrowRight,
            Self::Up => Glyph::ArrowUp,
            Self::GoTo => Glyph::Locate,
            Self::More => Glyph::Ellipsis,
            Self::Doubt => Glyph::TriangleAlert,
            Self::Wrong => Glyph::CircleX,
            Self::Good => Glyph::CircleCheck,
            Self::Pending => Glyph::Circle,
            Self::Told => Glyph::Info,
            Self::Panel => Glyph::PanelTop,
        }
    }

    /// On a button, in a colour of its own; `Icon` itself becomes one in the colour of the button's words.
    pub fn atom(self, size: f32, color: Option<Color32>) -> Atom<'static> {
        // Painted and not written: what is written would be spoken, too.
        Atom::paint(vec2(size, size), move |ui, args| {
            self.paint(ui.painter(), args.rect.center(), size, color.unwrap_or(args.fallback_text_color));
        })
    }

    /// About a point.
    pub fn paint(self, painter: &Painter, center: Pos2, size: f32, color: Color32) {
        painter.text(center, Align2::CENTER_CENTER, char::from(self.glyph()), FontId::new(size, family()), color);
    }

    /// In a line, as high as the words beside it.
    pub fn show(self, ui: &mut Ui, size: f32, color: Color32) -> Response {
        let (rect, response) = ui.allocate_exact_size(vec2(size, line_height(ui).max(size)), Sense::hover());
        let middle = Rect::from_center_size(rect.center(), vec2(size, size)).center();
        self.paint(ui.painter(), middle, size, color);
        response
    }
}

impl From<Icon> for Atom<'static> {
    fn from(icon: Icon) -> Self {
        icon.atom(SIZE, None)
    }
}

/// Height of a line of small words.
fn line_height(ui: &Ui) -> f32 {
    ui.text_style_height(&egui::TextStyle::Small)
}

/// The font's family; [`super::theme::install`] fills it.
pub fn family() -> FontFamily {
    FontFamily::Name("icons".into())
}

/// The font.
pub fn font() -> egui::FontData {
    egui::FontData::from_static(lucide_icons::LUCIDE_FONT_BYTES)
}

/// Face of a button: words, with an icon before them or without.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face<'a> {
    /// Before the words.
    pub icon: Option<Icon>,
    /// Text on the button, and for the screen reader.
    pub words: &'a str,
}

impl<'a> From<&'a str> for Face<'a> {
    fn from(words: &'a str) -> Self {
        Self { icon: None, words }
    }
}

impl<'a> From<&'a String> for Face<'a> {
    fn from(words: &'a String) -> Self {
        Self { icon: None, words }
    }
}

impl<'a> From<(Icon, &'a str)> for Face<'a> {
    fn from((icon, words): (Icon, &'a str)) -> Self {
        Self { icon: Some(icon), words }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;
    use strum::IntoEnumIterator as _;

    #[test]
    fn every_meaning_has_a_picture_of_its_own() {
        let mut seen: HashMap<char, Icon> = HashMap::new();
        for icon in Icon::iter() {
            if let Some(other) = seen.insert(char::from(icon.glyph()), icon) {
                panic!("{icon:?} and {other:?} look the same");
            }
        }
    }

    #[test]
    fn the_font_has_every_icon_in_its_square() {
        crate::ui::tests::harness((), [300.0, 200.0], |ui, ()| {
            for icon in Icon::iter() {
                let glyph = char::from(icon.glyph());
                let font = FontId::new(SIZE, family());
                assert!(ui.fonts_mut(|fonts| fonts.has_glyph(&font, glyph)), "{icon:?}");
                let galley = ui.painter().layout_no_wrap(glyph.to_string(), font, Color32::WHITE);
                let ink = galley.mesh_bounds;
                assert!(ink.width() > 0.3 * SIZE && ink.width() <= SIZE + 1.0, "{icon:?}: {ink:?}");
                // The middle of its line is the middle of its square: what is centred looks centred.
                assert!(
                    (ink.center() - galley.rect.center()).length() < 0.2 * SIZE,
                    "{icon:?}: {ink:?} in {:?}",
                    galley.rect
                );
            }
        });
    }
}
