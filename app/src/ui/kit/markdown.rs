//! Short texts in Markdown: paragraphs, emphasis, lists. Enough for lessons; nothing is fetched, nothing can be clicked.

use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use egui::text::LayoutJob;
use egui::{FontId, TextFormat, Ui};
use pulldown_cmark::{Event, Parser, Tag, TagEnd};

/// Size of the text, points.
const SIZE: f32 = 12.5;

/// Draws a text.
pub fn show(ui: &mut Ui, text: &str) {
    let p = palette(ui);
    let usual = TextFormat { font_id: FontId::proportional(SIZE), color: p.text, ..TextFormat::default() };
    let (mut job, mut strong, mut leaning) = (LayoutJob::default(), 0_u32, 0_u32);
    for event in Parser::new(text) {
        match event {
            Event::Start(Tag::Strong | Tag::Heading { .. }) => strong += 1,
            Event::End(TagEnd::Strong) => strong -= 1,
            Event::Start(Tag::Emphasis) => leaning += 1,
            Event::End(TagEnd::Emphasis) => leaning -= 1,
            Event::End(TagEnd::Heading(_)) => {
                strong -= 1;
                flush(ui, &mut job);
            }
            Event::Start(Tag::Item) => job.append("•  ", 0.0, usual.clone()),
            Event::Text(words) | Event::Code(words) => {
                let family = if strong > 0 { theme::semibold() } else { egui::FontFamily::Proportional };
                let color = if leaning > 0 { p.secondary } else { p.text };
                let format =
                    TextFormat { font_id: FontId::new(SIZE, family), italics: leaning > 0, color, ..usual.clone() };
                job.append(&words, 0.0, format);
            }
            Event::SoftBreak => job.append(" ", 0.0, usual.clone()),
            Event::HardBreak => job.append("\n", 0.0, usual.clone()),
            Event::End(TagEnd::Paragraph | TagEnd::Item) => flush(ui, &mut job),
            _ => {}
        }
    }
    flush(ui, &mut job);
}

/// The paragraph so far.
fn flush(ui: &mut Ui, job: &mut LayoutJob) {
    if !job.is_empty() {
        ui.add(egui::Label::new(std::mem::take(job)).wrap());
        ui.add_space(space::XS);
    }
}
