//! Faults of legibility: text that a person could not read, or widgets that they could not reach.

use super::painted::{Painted, Window};
use egui::Rect;

/// Ink may stick out by so much, points: letters hang over their boxes.
const SLACK: f32 = 1.5;

/// Everything that is wrong with a window, a sentence each.
pub fn faults(window: &Window) -> Vec<String> {
    let mut found: Vec<String> = window.layers.iter().flat_map(|layer| over_each_other(layer)).collect();
    for layer in &window.layers {
        found.extend(layer.iter().filter(|p| !is_written(p, window)).filter_map(|p| cut_words(p, &window.bars)));
        found.extend(out_of_their_boxes(layer));
    }
    found.extend(window.controls.iter().filter(|c| !c.scrolls).filter_map(|control| {
        let inside = control.seen.expand(SLACK).contains_rect(control.rect);
        (!inside).then(|| format!("{} at {:?} is cut to {:?}", control.name, control.rect, control.seen))
    }));
    found.sort();
    found.dedup();
    found
}

/// Words in a field, which moves with what is written.
fn is_written(painted: &Painted, window: &Window) -> bool {
    let Painted::Words { clip, .. } = painted else { return false };
    window.controls.iter().any(|c| c.field && c.seen.expand(SLACK).contains_rect(*clip))
}

fn inner(a: Rect, b: Rect) -> Option<Rect> {
    let both = a.intersect(b);
    (both.width() > SLACK && both.height() > SLACK).then_some(both)
}

/// Words over words, and words of which something covers a part.
fn over_each_other(layer: &[Painted]) -> Vec<String> {
    let mut found = Vec::new();
    for (place, behind) in layer.iter().enumerate() {
        let Painted::Words { text, ink, clip } = behind else { continue };
        let seen = ink.intersect(*clip);
        if inner(seen, seen).is_none() {
            continue;
        }
        for before in &layer[place + 1..] {
            match before {
                Painted::Cover(cover) if cover.expand(SLACK).contains_rect(seen) => break,
                Painted::Cover(cover) => {
                    if inner(*cover, seen).is_some() {
                        found.push(format!("“{text}” at {seen:?} is covered in part by a box at {cover:?}"));
                    }
                }
                Painted::Words { text: other, ink, clip } => {
                    if inner(ink.intersect(*clip), seen).is_some() {
                        found.push(format!("“{other}” at {ink:?} lies over “{text}” at {seen:?}"));
                    }
                }
            }
        }
    }
    found
}

/// Words that stick out of the button, field or card that they stand in.
fn out_of_their_boxes(layer: &[Painted]) -> Vec<String> {
    let mut found = Vec::new();
    for (place, painted) in layer.iter().enumerate() {
        let Painted::Words { text, ink, clip } = painted else { continue };
        let seen = ink.intersect(*clip);
        if inner(seen, seen).is_none() {
            continue;
        }
        let boxes = layer[..place].iter().filter_map(|p| match p {
            // Rails of sliders and bars are narrower than words.
            Painted::Cover(cover) if cover.height() > ink.height() => Some(*cover),
            _ => None,
        });
        let own = boxes.filter(|b| b.contains(seen.center())).min_by(|a, b| a.area().total_cmp(&b.area()));
        if let Some(own) = own.filter(|own| !own.expand(SLACK).contains_rect(seen)) {
            found.push(format!("“{text}” at {seen:?} sticks out of its box at {own:?}"));
        }
    }
    found
}

/// Words that the edge of their place cuts off, where no bar brings them in.
fn cut_words(painted: &Painted, bars: &[Rect]) -> Option<String> {
    let Painted::Words { text, ink, clip } = painted else { return None };
    let cut = edges(*ink, *clip).into_iter().any(|edge| !bars.iter().any(|bar| edge.is_end_of(*bar)));
    cut.then(|| format!("“{text}” at {ink:?} is cut by {clip:?}"))
}

/// Edge at which something is cut off.
enum Edge {
    Left(f32),
    Right(f32),
    Top(f32),
    Bottom(f32),
}

impl Edge {
    /// True at the end of what a bar moves.
    fn is_end_of(&self, bar: Rect) -> bool {
        let vertical = bar.height() > bar.width();
        let near = |a: f32, b: f32| (a - b).abs() < 4.0;
        match *self {
            Self::Left(at) => !vertical && near(at, bar.left()),
            Self::Right(at) => !vertical && near(at, bar.right()),
            Self::Top(at) => vertical && near(at, bar.top()),
            Self::Bottom(at) => vertical && near(at, bar.bottom()),
        }
    }
}

/// The edges of its place that `ink` sticks out beyond.
fn edges(ink: Rect, clip: Rect) -> Vec<Edge> {
    let all = [
        (clip.left() - ink.left(), Edge::Left(clip.left())),
        (ink.right() - clip.right(), Edge::Right(clip.right())),
        (clip.top() - ink.top(), Edge::Top(clip.top())),
        (ink.bottom() - clip.bottom(), Edge::Bottom(clip.bottom())),
    ];
    all.into_iter().filter(|(beyond, _)| *beyond > SLACK).map(|(_, edge)| edge).collect()
}

#[cfg(test)]
mod tests {
    use super::super::painted::Paint;
    use super::*;
    use crate::ui::tests::harness;
    use egui::{Align2, FontId, Ui, pos2, vec2};

    /// The faults of a small window.
    fn of(mut show: impl FnMut(&mut Ui)) -> Vec<String> {
        let paint = Paint::default();
        let kept = paint.clone();
        let harness = harness((), [300.0, 200.0], move |ui, ()| {
            show(ui);
            kept.take(ui.ctx());
        });
        faults(&paint.window(&harness))
    }

    fn has(faults: &[String], words: &[&str]) -> bool {
        faults.iter().any(|fault| words.iter().all(|w| fault.contains(w)))
    }

    #[test]
    fn a_plain_window_has_none() {
        let found = of(|ui| {
            ui.heading("Everything");
            ui.horizontal(|ui| ui.button("is").clicked() | ui.button("fine").clicked());
            egui::ScrollArea::vertical().max_height(60.0).show(ui, |ui| {
                for line in 0..30 {
                    ui.label(format!("line {line}"));
                }
            });
            ui.add(egui::Label::new("a line that is much too long for the width of this small window").truncate());
        });
        assert!(found.is_empty(), "{found:#?}");
    }

    #[test]
    fn words_over_words_are_found() {
        let write = |ui: &Ui, x: f32, text: &str| {
            let ink = ui.visuals().text_color();
            ui.painter().text(pos2(x, 40.0), Align2::LEFT_CENTER, text, FontId::proportional(12.0), ink);
        };
        let found = of(move |ui| {
            write(ui, 20.0, "Force, vertical");
            write(ui, 60.0, "12.3 N");
        });
        assert!(has(&found, &["12.3 N", "lies over", "Force, vertical"]), "{found:#?}");
        let apart = of(move |ui| {
            write(ui, 20.0, "Force, vertical");
            write(ui, 160.0, "12.3 N");
        });
        assert!(apart.is_empty(), "{apart:#?}");
    }

    #[test]
    fn a_box_over_half_of_the_words_is_found_and_one_over_all_is_not() {
        let covered = |width: f32| {
            of(move |ui| {
                let rect = ui.label("Half of this").rect;
                let card = Rect::from_min_size(rect.min - vec2(4.0, 4.0), vec2(width, 40.0));
                ui.painter().rect_filled(card, 0, egui::Color32::GRAY);
            })
        };
        assert!(has(&covered(40.0), &["Half of this", "covered in part"]));
        assert!(covered(200.0).is_empty());
    }

    #[test]
    fn words_wider_than_their_button_are_found() {
        let button = |width: f32| {
            of(move |ui| {
                let (rect, _) = ui.allocate_exact_size(vec2(width, 24.0), egui::Sense::click());
                ui.painter().rect_filled(rect, 3, egui::Color32::DARK_BLUE);
                let font = FontId::proportional(12.0);
                ui.painter().text(rect.center(), Align2::CENTER_CENTER, "Sideways", font, egui::Color32::WHITE);
            })
        };
        assert!(has(&button(30.0), &["Sideways", "sticks out of its box"]));
        assert!(button(80.0).is_empty());
    }

    #[test]
    fn words_and_buttons_beyond_the_edge_are_found() {
        let wide = of(|ui| {
            ui.horizontal(|ui| {
                ui.add_space(250.0);
                ui.add(egui::Button::new("Too far to the right").wrap_mode(egui::TextWrapMode::Extend))
            });
        });
        assert!(has(&wide, &["“Too far to the right”", "is cut by"]), "{wide:#?}");
        assert!(has(&wide, &["Button", "is cut to"]), "{wide:#?}");
        let deep = of(|ui| {
            ui.add_space(190.0);
            ui.label("Below the floor");
        });
        assert!(has(&deep, &["Below the floor"]), "{deep:#?}");
    }

    #[test]
    fn what_scrolling_pushes_out_is_found_and_what_scrolls_is_not() {
        let found = of(|ui| {
            egui::ScrollArea::vertical().max_height(300.0).show(ui, |ui| {
                for line in 0..30 {
                    ui.label(format!("line {line}"));
                }
            });
            ui.label("Save, out of reach");
        });
        assert!(has(&found, &["Save, out of reach"]), "{found:#?}");
        assert!(!has(&found, &["line 25"]), "{found:#?}");
    }
}
