//! No window opened: another try, or one sentence about the reason.

use super::graphics;
use super::scale;
use super::wayland_socket;
use super::x_server::XServer;

/// Set in a second start with OpenGL, after the system's own interface drew nothing.
const SECOND_START: &str = "TOUCHSTONE_SECOND_START";
/// Environment of a start with OpenGL; its driver's own words would stand beside the sentence.
pub const OPEN_GL: [(&str, &str); 3] = [(graphics::VARIABLE, "gl"), (SECOND_START, "1"), ("EGL_LOG_LEVEL", "fatal")];
/// Environment of a start at the usual scale.
pub const AT_USUAL_SCALE: (&str, &str) = (scale::VARIABLE, "1");
/// Environment variables that name a Wayland compositor.
pub const WAYLAND: [&str; 2] = ["WAYLAND_DISPLAY", wayland_socket::VARIABLE];
/// Environment variable that names an X server.
pub const X: &str = "DISPLAY";
/// Environment variable that names the folder of the compositor's socket.
const SOCKETS: &str = "XDG_RUNTIME_DIR";
/// Bits per pixel that every graphics driver draws; 30 are drawn by some.
/// Source: Vulkan 1.3, required formats: eight bits per colour, with or without transparency.
const DEPTHS: [u8; 2] = [24, 32];

/// Failures of the libraries below, told apart as far as something else follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The window system gave no window.
    NoWindow,
    /// The window cannot be drawn.
    NoGraphics,
}

/// Continuation after a failure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Next {
    /// Start again on X alone.
    WithoutWayland,
    /// Start again at a scale of 1: the one that the X server states may be no scale.
    AtUsualScale,
    /// Start again with OpenGL.
    WithOpenGl,
    /// Say this and end.
    Refuse(String),
}

/// Screens and graphics that the environment names. An empty variable is as unset.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Surroundings {
    /// A Wayland compositor.
    pub wayland: Option<String>,
    /// True if the folder of the compositor's socket is named.
    pub has_sockets: bool,
    /// An X server.
    pub x: Option<String>,
    /// True if the scale is stated.
    pub has_scale: bool,
    /// The graphics interface that the user chose.
    pub graphics: Option<String>,
    /// True in a second start with OpenGL.
    pub is_second_start: bool,
}

impl Surroundings {
    /// Those that these variables state.
    pub fn of(variable: impl Fn(&str) -> Option<String>) -> Self {
        let named = |name: &str| variable(name).filter(|value| !value.is_empty()).map(|value| plain(&value));
        let is_second_start = named(SECOND_START).is_some();
        Self {
            wayland: WAYLAND.into_iter().find_map(named),
            has_sockets: named(SOCKETS).is_some(),
            x: named(X),
            has_scale: named(scale::VARIABLE).is_some(),
            graphics: named(graphics::VARIABLE).filter(|_| !is_second_start),
            is_second_start,
        }
    }

    /// The next step after a failure. The X server is asked only if its answer counts.
    pub fn after(&self, failure: Failure, ask: impl FnOnce() -> XServer) -> Next {
        match failure {
            Failure::NoWindow if self.wayland.is_some() && self.x.is_some() => Next::WithoutWayland,
            Failure::NoWindow => self.no_window(ask),
            Failure::NoGraphics if self.graphics.is_none() && !self.is_second_start => Next::WithOpenGl,
            Failure::NoGraphics => Next::Refuse(self.no_graphics(ask)),
        }
    }

    fn no_window(&self, ask: impl FnOnce() -> XServer) -> Next {
        let sentence = match (&self.wayland, &self.x) {
            (Some(_), _) if !self.has_sockets => {
                format!("no Wayland compositor can be found without {SOCKETS}; start this within a desktop session")
            }
            (Some(name), _) => format!("no Wayland compositor answers at {name}; start this within a desktop session"),
            (None, None) => format!(
                "there is no screen for a window: neither {} nor {X} is set; start this within a desktop session",
                WAYLAND[0]
            ),
            (None, Some(name)) => match ask() {
                XServer::Answering { lacks, .. } if lacks.is_empty() && !self.has_scale => return Next::AtUsualScale,
                server => no_window_on_x(name, &server),
            },
        };
        Next::Refuse(sentence)
    }

    fn no_graphics(&self, ask: impl FnOnce() -> XServer) -> String {
        if let (None, Some(name)) = (&self.wayland, &self.x)
            && let XServer::Answering { depth, .. } = ask()
            && !DEPTHS.contains(&depth)
        {
            return format!(
                "no graphics driver here draws {depth} bits per pixel; start the X server {name} with a depth of 24"
            );
        }
        self.graphics.as_ref().map_or_else(
            || {
                "no graphics driver here draws in a window, by Vulkan or by OpenGL; install one (Debian: mesa-vulkan-drivers)"
                    .to_owned()
            },
            |chosen| {
                let variable = graphics::VARIABLE;
                format!("no graphics driver here draws in a window by {chosen}, which {variable} asks for; unset {variable}")
            },
        )
    }
}

fn no_window_on_x(name: &str, server: &XServer) -> String {
    match server {
        XServer::Silent => format!("no X server answers at {name}; start it, or name another one in {X}"),
        XServer::Refusing => format!("the X server {name} lets this program not in; allow it with xauth or xhost"),
        XServer::Answering { lacks, .. } if !lacks.is_empty() => format!(
            "the X server {name} lacks the extension {}, which a window needs; use a server that has it",
            lacks.join(" and ")
        ),
        XServer::Answering { .. } => format!(
            "no window opens on the X server {name}; install libX11, libXcursor, libXi, libX11-xcb, libxkbcommon-x11 and xkb-data"
        ),
    }
}

fn plain(text: &str) -> String {
    haptics::text_file::one_line(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(variables: &[(&str, &str)]) -> Surroundings {
        Surroundings::of(|name| {
            variables.iter().find(|(known, _)| *known == name).map(|(_, value)| (*value).to_owned())
        })
    }

    fn answering(lacks: &[&'static str], depth: u8) -> XServer {
        XServer::Answering { lacks: lacks.to_vec(), depth }
    }

    fn said(next: Next) -> String {
        let Next::Refuse(sentence) = next else { panic!("{next:?} is another try") };
        assert!(sentence.len() <= 130 && !sentence.contains('\n') && sentence.contains(';'), "{sentence}");
        sentence
    }

    #[test]
    fn a_dead_compositor_beside_an_x_server_leads_to_x() {
        let both = with(&[("WAYLAND_DISPLAY", "wayland-9"), ("DISPLAY", ":1")]);
        assert_eq!(both.after(Failure::NoWindow, || XServer::Silent), Next::WithoutWayland);
        let by_socket = with(&[("WAYLAND_SOCKET", "7"), ("DISPLAY", ":1")]);
        assert_eq!(by_socket.after(Failure::NoWindow, || XServer::Silent), Next::WithoutWayland);
    }

    #[test]
    fn a_screen_that_does_not_answer_is_named() {
        let none = said(with(&[("DISPLAY", "")]).after(Failure::NoWindow, || XServer::Silent));
        assert!(none.contains("neither WAYLAND_DISPLAY nor DISPLAY is set"), "{none}");
        let wayland = with(&[("WAYLAND_DISPLAY", "wayland-9"), (SOCKETS, "/run/user/7")]);
        assert!(said(wayland.after(Failure::NoWindow, || XServer::Silent)).contains("wayland-9"));
        let without_folder = with(&[("WAYLAND_DISPLAY", "wayland-9")]);
        assert!(said(without_folder.after(Failure::NoWindow, || XServer::Silent)).contains(SOCKETS));
        let x = with(&[("DISPLAY", ":7")]);
        assert!(said(x.after(Failure::NoWindow, || XServer::Silent)).contains("no X server answers at :7"));
        assert!(said(x.after(Failure::NoWindow, || XServer::Refusing)).contains("xauth"));
    }

    #[test]
    fn a_missing_extension_is_named() {
        let next = with(&[("DISPLAY", ":7")]).after(Failure::NoWindow, || answering(&["RANDR"], 24));
        assert!(said(next).contains("lacks the extension RANDR"));
    }

    #[test]
    fn a_complete_server_is_tried_again_at_the_usual_scale_before_libraries_are_named() {
        let first = with(&[("DISPLAY", ":7")]);
        assert_eq!(first.after(Failure::NoWindow, || answering(&[], 24)), Next::AtUsualScale);
        let second = with(&[("DISPLAY", ":7"), AT_USUAL_SCALE]);
        assert!(said(second.after(Failure::NoWindow, || answering(&[], 24))).contains("libxkbcommon-x11"));
    }

    #[test]
    fn open_gl_is_tried_once_and_only_if_nobody_chose() {
        let first = with(&[("DISPLAY", ":7"), (graphics::VARIABLE, "")]);
        assert_eq!(first.after(Failure::NoGraphics, || answering(&[], 16)), Next::WithOpenGl);
        let second = with(&[("DISPLAY", ":7"), (graphics::VARIABLE, "gl"), (SECOND_START, "1")]);
        assert!(said(second.after(Failure::NoGraphics, || answering(&[], 24))).contains("by Vulkan or by OpenGL"));
        let chosen = with(&[("DISPLAY", ":7"), (graphics::VARIABLE, "gl")]);
        let sentence = said(chosen.after(Failure::NoGraphics, || answering(&[], 24)));
        assert!(sentence.contains("by gl, which WGPU_BACKEND asks for"), "{sentence}");
    }

    #[test]
    fn a_depth_that_drivers_do_not_draw_is_named_and_another_one_is_not() {
        let second = with(&[("DISPLAY", ":7"), (SECOND_START, "1")]);
        for depth in [8, 15, 16, 30] {
            let sentence = said(second.after(Failure::NoGraphics, || answering(&[], depth)));
            assert!(sentence.contains(&format!("{depth} bits per pixel")), "{sentence}");
        }
        for depth in DEPTHS {
            assert!(!said(second.after(Failure::NoGraphics, || answering(&[], depth))).contains("bits per pixel"));
        }
    }
}
