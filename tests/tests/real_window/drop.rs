//! A file that is let go of over the window, as a file manager does it: the source's side of the XDND protocol, version 5
//! (<https://www.freedesktop.org/wiki/Specifications/XDND/>).

use crate::screen::Screen;
use std::error::Error;
use std::path::Path;
use std::time::{Duration, Instant};
use x11rb::connection::Connection;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    AtomEnum, ClientMessageEvent, ConnectionExt as _, CreateWindowAux, EventMask, PropMode, SelectionNotifyEvent,
    SelectionRequestEvent, WindowClass,
};
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;
use x11rb::{COPY_DEPTH_FROM_PARENT, COPY_FROM_PARENT, CURRENT_TIME};

type Failed = Box<dyn Error>;

x11rb::atom_manager! {
    Atoms: AtomsCookie {
        XdndAware,
        XdndSelection,
        XdndEnter,
        XdndPosition,
        XdndStatus,
        XdndDrop,
        XdndFinished,
        XdndActionCopy,
        UriList: b"text/uri-list",
    }
}

/// Of the protocol.
const VERSION: u32 = 5;
/// A window that draws in software answers late.
const PATIENCE: Duration = Duration::from_mins(2);

/// What drags.
struct Source {
    connection: RustConnection,
    atoms: Atoms,
    window: u32,
    target: u32,
    uri: String,
}

/// Drags a file to a place of the screen, pixels, and lets go of it there.
pub fn drop_file(screen: &Screen, file: &Path, at: [u16; 2]) {
    let source = Source::over(screen, file).expect("a screen to drag on");
    screen.xdotool(&["mousemove", &at[0].to_string(), &at[1].to_string()]);
    source.drag(at).expect("the window takes the file");
}

impl Source {
    fn over(screen: &Screen, file: &Path) -> Result<Self, Failed> {
        let (connection, number) = x11rb::connect(Some(screen.display()))?;
        let atoms = Atoms::new(&connection)?.reply()?;
        let root = connection.setup().roots[number].root;
        let window = connection.generate_id()?;
        let aux = CreateWindowAux::new();
        let depth = COPY_DEPTH_FROM_PARENT;
        connection.create_window(
            depth,
            window,
            root,
            0,
            0,
            1,
            1,
            0,
            WindowClass::INPUT_OUTPUT,
            COPY_FROM_PARENT,
            &aux,
        )?;
        connection.set_selection_owner(window, atoms.XdndSelection, CURRENT_TIME)?;
        let target = aware(&connection, atoms.XdndAware, root)?.ok_or("no window takes files")?;
        // Nothing of a temporary folder's name needs to be escaped.
        let uri = format!("file://{}\r\n", file.display());
        Ok(Self { connection, atoms, window, target, uri })
    }

    fn drag(&self, at: [u16; 2]) -> Result<(), Failed> {
        let atoms = &self.atoms;
        self.say(atoms.XdndEnter, [self.window, VERSION << 24, atoms.UriList, 0, 0])?;
        let place = (u32::from(at[0]) << 16) | u32::from(at[1]);
        self.say(atoms.XdndPosition, [self.window, 0, place, CURRENT_TIME, atoms.XdndActionCopy])?;
        let status = self.wait_for(atoms.XdndStatus)?;
        if status[1] & 1 == 0 {
            return Err("the window does not take it".into());
        }
        self.say(atoms.XdndDrop, [self.window, 0, CURRENT_TIME, 0, 0])?;
        self.wait_for(atoms.XdndFinished)?;
        Ok(())
    }

    fn say(&self, what: u32, data: [u32; 5]) -> Result<(), Failed> {
        let message = ClientMessageEvent::new(32, self.target, what, data);
        self.connection.send_event(false, self.target, EventMask::NO_EVENT, message)?;
        self.connection.flush()?;
        Ok(())
    }

    /// Waits for a word of the window, and tells it what is dragged when it asks.
    fn wait_for(&self, what: u32) -> Result<[u32; 5], Failed> {
        let begun = Instant::now();
        while begun.elapsed() < PATIENCE {
            match self.connection.poll_for_event()? {
                Some(Event::ClientMessage(message)) if message.type_ == what => return Ok(message.data.as_data32()),
                Some(Event::SelectionRequest(request)) => self.tell(&request)?,
                Some(_) => {}
                None => std::thread::sleep(Duration::from_millis(10)),
            }
        }
        Err("the window does not answer".into())
    }

    fn tell(&self, asked: &SelectionRequestEvent) -> Result<(), Failed> {
        let SelectionRequestEvent { requestor, selection, target, property, time, .. } = *asked;
        self.connection.change_property8(PropMode::REPLACE, requestor, property, target, self.uri.as_bytes())?;
        let answer = SelectionNotifyEvent { requestor, selection, target, property, time, ..Default::default() };
        let answer = SelectionNotifyEvent { response_type: x11rb::protocol::xproto::SELECTION_NOTIFY_EVENT, ..answer };
        self.connection.send_event(false, requestor, EventMask::NO_EVENT, answer)?;
        self.connection.flush()?;
        Ok(())
    }
}

/// The window below `window` that takes what is dragged.
fn aware(connection: &RustConnection, atom: u32, window: u32) -> Result<Option<u32>, Failed> {
    let property = connection.get_property(false, window, atom, AtomEnum::ANY, 0, 1)?.reply()?;
    if property.value_len > 0 {
        return Ok(Some(window));
    }
    for child in connection.query_tree(window)?.reply()?.children {
        if let Some(found) = aware(connection, atom, child)? {
            return Ok(Some(found));
        }
    }
    Ok(None)
}
