//! One drawable thing a file. Each looks at the scene and adds its shapes to a [`Canvas`].

mod arrow;
mod barrel;
mod block;
mod body;
mod cable;
mod canvas;
mod contact;
mod crank;
mod cup;
mod force_field;
mod guide;
mod leak;
mod link;
mod marker;
mod mechanism;
mod membrane;
mod needle;
mod pad;
mod plane;
mod switch;
pub(crate) mod table;
mod tool;
mod trajectory;
mod workspace;

use crate::draw_data::DrawData;
use crate::scene::{FingerStyle, SceneView};
use canvas::{Canvas, Mode};

/// Lists all shapes of a scene.
pub(crate) fn draw_scene(data: &mut DrawData, view: &SceneView<'_>) {
    let mut canvas = Canvas::new(data, view, Mode::Real);
    table::draw(&mut canvas, view);
    plane::draw(&mut canvas, view);
    if view.options.show_workspace {
        workspace::draw(&mut canvas, view);
    }
    draw_state(&mut canvas, view);
    if view.options.show_contacts {
        contact::draw(&mut canvas, view);
    }
    mechanism::draw(&mut canvas, view);
    trajectory::draw(&mut canvas, view);
    force_field::draw(&mut canvas, view);
    marker::draw(&mut canvas, view);
    if view.options.show_forces && view.options.fingers != FingerStyle::Hidden {
        arrow::draw(&mut canvas, view);
    }
    if let Some(ghost) = &view.options.ghost {
        let mut canvas = Canvas::new(data, view, Mode::Ghost);
        draw_state(&mut canvas, &SceneView { state: ghost, ..*view });
    }
}

/// The moving things: objects and fingers.
fn draw_state(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    block::draw(canvas, view);
    leak::draw(canvas, view);
    guide::draw(canvas, view);
    cable::draw(canvas, view);
    membrane::draw(canvas, view);
    switch::draw(canvas, view);
    crank::draw(canvas, view);
    match view.options.fingers {
        FingerStyle::Linkage => {
            link::draw(canvas, view);
            pad::draw(canvas, view);
        }
        FingerStyle::Tips => pad::draw(canvas, view),
        FingerStyle::Tool => tool::draw(canvas, view),
        FingerStyle::Hidden => {}
    }
}
