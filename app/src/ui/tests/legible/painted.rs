//! Painted shapes and layout of a window, as far as they matter for reading.

use egui::epaint::ClippedShape;
use egui::{Context, LayerId, Rect, Shape};
use egui_kittest::Harness;
use egui_kittest::kittest::NodeT as _;
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

/// Fainter than this (of 255) nobody is meant to read it, and it covers nothing either.
const FAINT: u8 = 60;

/// Something that was painted, in the order of painting.
#[derive(Clone, Debug, PartialEq)]
pub enum Painted {
    /// Words: where their ink is, and where it may be.
    Words { text: String, ink: Rect, clip: Rect },
    /// Something that nothing behind is seen through.
    Cover(Rect),
}

/// A widget that says something or can be used.
#[derive(Clone, Debug, PartialEq)]
pub struct Control {
    /// Its role and its name.
    pub name: String,
    /// All of it.
    pub rect: Rect,
    /// Visible part of the widget.
    pub seen: Rect,
    /// In something that scrolls up and down, or to and fro.
    pub scrolls: bool,
    /// A field to write into: its words may be longer than it.
    pub field: bool,
}

/// A window as laid out.
#[derive(Clone, Debug, Default)]
pub struct Window {
    /// Painted shapes by layer, those behind first.
    pub layers: Vec<Vec<Painted>>,
    /// Widgets.
    pub controls: Vec<Control>,
    /// The scroll bars: along each, something scrolls.
    pub bars: Vec<Rect>,
}

/// The paint of the last picture; [`Paint::take`] is called where a picture ends.
#[derive(Clone, Default)]
pub struct Paint(Rc<RefCell<Vec<Vec<Painted>>>>);

impl Paint {
    /// Reads what was painted until now.
    pub fn take(&self, ctx: &Context) {
        let mut layers = vec![LayerId::background()];
        layers.extend(ctx.memory(|m| m.layer_ids().collect::<Vec<_>>()));
        layers.push(LayerId::new(egui::Order::Foreground, egui::Id::unique("drop hint")));
        layers.dedup();
        layers.sort_by_key(|l| l.order);
        let whole = ctx.content_rect();
        let painted = |layer: &LayerId| {
            let mut found = Vec::new();
            ctx.graphics(|graphics| {
                for ClippedShape { clip_rect, shape, .. } in graphics.get(*layer).iter().flat_map(|l| l.all_entries()) {
                    collect(shape, clip_rect.intersect(whole), &mut found);
                }
            });
            found
        };
        *self.0.borrow_mut() = layers.iter().map(painted).filter(|l| !l.is_empty()).collect();
    }

    /// The window after its last picture.
    pub fn window<S>(&self, harness: &Harness<'_, S>) -> Window {
        let (controls, bars) = controls(harness);
        Window { layers: self.0.borrow().clone(), controls, bars }
    }
}

fn collect(shape: &Shape, clip: Rect, found: &mut Vec<Painted>) {
    match shape {
        Shape::Vec(shapes) => shapes.iter().for_each(|s| collect(s, clip, found)),
        Shape::Text(text) => {
            let ink = text.override_text_color.or_else(|| text.galley.job.sections.first().map(|s| s.format.color));
            let ink = ink.filter(|c| *c != egui::Color32::PLACEHOLDER).unwrap_or(text.fallback_color);
            let opacity = f32::from(ink.a()) * text.opacity_factor;
            if !text.galley.text().trim().is_empty() && opacity >= f32::from(FAINT) {
                let ink = text.visual_bounding_rect();
                found.push(Painted::Words { text: text.galley.text().to_owned(), ink, clip });
            }
        }
        Shape::Rect(rect) if rect.fill.is_opaque() => found.push(Painted::Cover(rect.rect.intersect(clip))),
        Shape::Callback(callback) => found.push(Painted::Cover(callback.rect.intersect(clip))),
        _ => {}
    }
}

/// Widgets of the last picture, and the scroll bars among them.
fn controls<S>(harness: &Harness<'_, S>) -> (Vec<Control>, Vec<Rect>) {
    use egui::Role;
    let told = |role| {
        matches!(
            role,
            Role::Button
                | Role::CheckBox
                | Role::ComboBox
                | Role::Label
                | Role::Link
                | Role::RadioButton
                | Role::Slider
                | Role::SpinButton
                | Role::TextInput
        )
    };
    let widgets: HashMap<_, _> = harness.ctx.viewport(|viewport| {
        let all = viewport.prev_pass.widgets.layers().flat_map(|(_, widgets)| widgets);
        all.map(|w| (w.id.accesskit_id(), *w)).collect()
    });
    let nodes: Vec<_> = harness.root().children_recursive().collect();
    let widget = |node: &egui_kittest::Node<'_>| widgets.get(&node.accesskit_node().locate().0).copied();
    let bars: Vec<_> = nodes.iter().filter(|n| n.accesskit_node().role() == Role::ScrollBar).collect();
    let mut found = Vec::new();
    for node in nodes.iter().filter(|n| told(n.accesskit_node().role())) {
        let Some(w) = widget(node).filter(|w| w.visible && w.rect.is_positive()) else { continue };
        let scrolls = bars.iter().any(|bar| is_scrolled_by(node, bar, &widget));
        let label = node.accesskit_node().label().or_else(|| node.accesskit_node().value()).unwrap_or_default();
        let name = format!("{:?} “{label}”", node.accesskit_node().role());
        let field = node.accesskit_node().role() == Role::TextInput;
        found.push(Control { name, rect: w.rect, seen: w.interact_rect, scrolls, field });
    }
    (found, bars.iter().filter_map(|bar| widget(bar).map(|w| w.rect)).collect())
}

/// True for what stands in the contents that a bar moves: those hang in the same parent as the bar, and reach along all of it. What stands
/// below or above them does not.
fn is_scrolled_by(
    node: &egui_kittest::Node<'_>,
    bar: &egui_kittest::Node<'_>,
    widget: &impl Fn(&egui_kittest::Node<'_>) -> Option<egui::WidgetRect>,
) -> bool {
    let Some((parent, along)) = bar.parent().zip(widget(bar)).map(|(p, w)| (p.accesskit_node().id(), w.rect)) else {
        return false;
    };
    let mut at = *node;
    while let Some(above) = at.parent() {
        if above.accesskit_node().id() == parent {
            let Some(contents) = widget(&at).map(|w| w.rect) else { return false };
            let vertical = along.height() > along.width();
            let (c, b) =
                if vertical { (contents.y_range(), along.y_range()) } else { (contents.x_range(), along.x_range()) };
            // As long as the bar at least, wherever it is moved to.
            return c.span() >= b.span() - 2.0 && c.min <= b.max && b.min <= c.max;
        }
        at = above;
    }
    false
}
