//! Appearance of tiles, and operations allowed on them.

use crate::ui::kit::theme;
use crate::ui::kit::theme::Palette;
use crate::ui::session::Session;
use crate::ui::shell::dock::layout::GAP;
use crate::ui::shell::dock::panes::Panels;
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::panel_list;
use egui::{Color32, RichText, Stroke, Ui, Visuals, WidgetText};
use egui_tiles::{Behavior, EditAction, ResizeState, SimplificationOptions, TabState, TileId, Tiles, UiResponse};

/// Height of titles, points.
const TITLES: f32 = 28.0;
/// Minimum size of a panel, points.
const LEAST: f32 = 120.0;

/// Draws the panels of a session.
pub struct Tiling<'a> {
    /// The panels.
    pub panels: &'a mut Panels,
    /// The session that they show.
    pub session: &'a mut Session,
    /// True if every panel shows its title.
    pub arranging: bool,
    /// True once the user has moved something.
    pub edited: bool,
}

fn of(visuals: &Visuals) -> &'static Palette {
    Palette::of(visuals.dark_mode)
}

impl Behavior<PanelId> for Tiling<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _tile: TileId, pane: &mut PanelId) -> UiResponse {
        self.panels.ui(*pane, ui, self.session);
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &PanelId) -> WidgetText {
        let title = panel_list::registration(*pane).map_or("", |panel| panel.title);
        RichText::new(title).font(egui::FontId::new(12.0, theme::semibold())).into()
    }

    fn is_tab_closable(&self, _tiles: &Tiles<PanelId>, _tile: TileId) -> bool {
        self.arranging
    }

    fn is_tab_bar_visible(&self, _tile: TileId, tabs: &egui_tiles::Tabs) -> bool {
        self.arranging || tabs.children.len() > 1
    }

    fn tab_bar_height(&self, _style: &egui::Style) -> f32 {
        TITLES
    }

    fn gap_width(&self, _style: &egui::Style) -> f32 {
        GAP
    }

    fn min_size(&self) -> f32 {
        LEAST
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SimplificationOptions { all_panes_must_have_tabs: true, ..SimplificationOptions::default() }
    }

    fn resize_stroke(&self, style: &egui::Style, state: ResizeState) -> Stroke {
        let p = of(&style.visuals);
        match state {
            ResizeState::Idle => Stroke::NONE,
            ResizeState::Hovering => Stroke::new(2.0, p.border),
            ResizeState::Dragging => Stroke::new(2.0, p.accent),
        }
    }

    fn tab_title_spacing(&self, _visuals: &Visuals) -> f32 {
        10.0
    }

    fn tab_bar_color(&self, visuals: &Visuals) -> Color32 {
        of(visuals).window
    }

    fn tab_bg_color(&self, visuals: &Visuals, _tiles: &Tiles<PanelId>, _tile: TileId, state: &TabState) -> Color32 {
        if state.active { of(visuals).card } else { Color32::TRANSPARENT }
    }

    fn tab_outline_stroke(
        &self,
        visuals: &Visuals,
        _tiles: &Tiles<PanelId>,
        _tile: TileId,
        state: &TabState,
    ) -> Stroke {
        if state.active { Stroke::new(1.0, of(visuals).border) } else { Stroke::NONE }
    }

    fn tab_bar_hline_stroke(&self, _visuals: &Visuals) -> Stroke {
        Stroke::NONE
    }

    fn tab_text_color(&self, visuals: &Visuals, _tiles: &Tiles<PanelId>, _tile: TileId, state: &TabState) -> Color32 {
        if state.active { of(visuals).text } else { of(visuals).secondary }
    }

    fn drag_preview_stroke(&self, visuals: &Visuals) -> Stroke {
        Stroke::new(1.5, of(visuals).accent)
    }

    fn drag_preview_color(&self, visuals: &Visuals) -> Color32 {
        of(visuals).accent.gamma_multiply(0.18)
    }

    fn dragged_overlay_color(&self, visuals: &Visuals) -> Color32 {
        of(visuals).window.gamma_multiply(0.5)
    }

    fn on_edit(&mut self, action: EditAction) {
        self.edited |= !matches!(action, EditAction::TabSelected);
    }
}
