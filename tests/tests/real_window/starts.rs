//! Starts of the window on screens that lack something: it opens, or says in one sentence what is in the way.

use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Child, Command, Output, Stdio};
use tests::touchstone;

/// Said on standard output by a window that has drawn its first picture.
const OPENED: &str = "the first picture stands";
/// A compositor that nobody runs.
const DEAD: &str = "wayland-none";

/// An X server without a file behind it.
struct Server {
    process: Child,
    display: String,
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

impl Server {
    /// `None`, with a word about it, on a machine without Xvfb or a graphics driver.
    fn or_skip(screen: &str, more: &[&str]) -> Option<Self> {
        let found = render::Headless::new().is_ok().then(|| Self::new(screen, more)).flatten();
        if found.is_none() {
            let _ = writeln!(std::io::stderr(), "skipped: Xvfb and a graphics driver are needed for a real window");
        }
        found
    }

    fn new(screen: &str, more: &[&str]) -> Option<Self> {
        let mut server = Command::new("Xvfb");
        server.args(["-displayfd", "1", "-screen", "0", screen]).args(more);
        let mut process = server.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().ok()?;
        let mut number = String::new();
        BufReader::new(process.stdout.take()?).read_line(&mut number).ok()?;
        Some(Self { process, display: format!(":{}", number.trim()) })
    }
}

/// A start on a screen with these variables, until the first picture.
fn start(display: Option<&str>, variables: &[(&str, &str)]) -> Output {
    let home = tempfile::tempdir().expect("a temporary folder");
    let mut program = Command::new("timeout");
    program.arg("120").arg(touchstone()).args(["app", "--until-first-picture"]);
    for unset in ["WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY", "WGPU_BACKEND", "WINIT_X11_SCALE_FACTOR"] {
        program.env_remove(unset);
    }
    program.env("HOME", home.path()).env("XDG_RUNTIME_DIR", home.path());
    program.env("XDG_DATA_HOME", home.path().join("data")).env("XDG_CONFIG_HOME", home.path().join("config"));
    if let Some(display) = display {
        program.env("DISPLAY", display);
    }
    program.envs(variables.iter().copied()).output().expect("the program starts")
}

/// The lines on standard error of a start that opened.
fn opened(output: &Output) -> Vec<String> {
    let said = lines(&output.stderr);
    assert!(
        output.status.success() && lines(&output.stdout).first().is_some_and(|line| line == OPENED),
        "{:?} {said:?}",
        output.status
    );
    said
}

/// The sentence of a start that did not.
fn refused(output: &Output) -> String {
    let said = lines(&output.stderr);
    assert!(output.status.code() == Some(1) && said.len() == 1, "{:?} {said:?}", output.status);
    for inside in [".rs", "panicked", "registry", "EventLoop", "{", "WGPU error"] {
        assert!(!said[0].contains(inside), "{}", said[0]);
    }
    said.concat()
}

fn lines(bytes: &[u8]) -> Vec<String> {
    String::from_utf8_lossy(bytes).lines().map(str::to_owned).collect()
}

#[test]
fn a_window_opens_on_x_beside_a_dead_compositor_and_with_settings_that_say_nothing() {
    let Some(server) = Server::or_skip("1280x800x24", &[]) else { return };
    let on = |variables: &[(&str, &str)]| start(Some(&server.display), variables);
    assert_eq!(opened(&on(&[("WAYLAND_DISPLAY", DEAD)])), [""; 0]);
    // The graphics driver has its own words about the missing folder.
    opened(&on(&[("WAYLAND_DISPLAY", DEAD), ("XDG_RUNTIME_DIR", "")]));
    assert_eq!(opened(&on(&[("WAYLAND_SOCKET", "777")])), [""; 0]);
    assert_eq!(opened(&on(&[("WGPU_BACKEND", "")])), [""; 0]);
    for wrong in ["abc", "0", "nan", "inf", "-1", "1e9"] {
        let said = opened(&on(&[("WINIT_X11_SCALE_FACTOR", wrong)]));
        assert!(said.len() == 1 && said[0].contains("WINIT_X11_SCALE_FACTOR is ignored"), "{said:?}");
    }
    let misspelt = refused(&on(&[("WGPU_BACKEND", "vulcan")]));
    assert!(misspelt.contains("WGPU_BACKEND") && misspelt.contains("vulkan or gl"), "{misspelt}");
}

#[test]
fn a_server_without_an_extension_that_a_window_needs_is_named() {
    let Some(server) = Server::or_skip("1280x800x24", &["-extension", "RANDR"]) else { return };
    let said = refused(&start(Some(&server.display), &[]));
    assert!(said.contains("RANDR") && said.contains(&server.display), "{said}");
}

#[test]
fn a_depth_that_no_driver_draws_is_named() {
    for depth in ["8", "16", "30"] {
        let Some(server) = Server::or_skip(&format!("1280x800x{depth}"), &[]) else { return };
        let started = start(Some(&server.display), &[]);
        if depth == "30" && started.status.success() {
            // Some drivers draw it.
            continue;
        }
        let said = refused(&started);
        assert!(said.contains(&format!("{depth} bits per pixel")), "{said}");
    }
}

#[test]
fn without_a_screen_the_variables_that_would_name_one_are_said() {
    assert!(refused(&start(None, &[])).contains("neither WAYLAND_DISPLAY nor DISPLAY is set"));
    assert!(refused(&start(Some(":4242"), &[])).contains("no X server answers at :4242"));
    assert!(refused(&start(None, &[("WAYLAND_DISPLAY", DEAD)])).contains(DEAD));
}
