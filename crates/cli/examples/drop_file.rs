//! Drops a file on a window of an X server, as a file manager does (the XDND protocol, version 5).
//! The viewer's test drives the window with it: `drop_file WINDOW FILE`.

use std::error::Error;
use x11rb::connection::Connection;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    Atom, AtomEnum, ClientMessageEvent, ConnectionExt, CreateWindowAux, EventMask, PropMode,
    SELECTION_NOTIFY_EVENT, SelectionNotifyEvent, SelectionRequestEvent, Window, WindowClass,
};
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, window, file] = arguments.as_slice() else {
        return Err("usage: drop_file WINDOW FILE".into());
    };
    let target: Window = window.parse()?;
    let file = std::path::absolute(file)?;
    let list = format!("file://{}\r\n", file.display());
    let (x, screen) = x11rb::connect(None)?;
    let root = x.setup().roots[screen].root;
    let source = x.generate_id()?;
    let (class, aux) = (WindowClass::INPUT_OUTPUT, CreateWindowAux::new());
    x.create_window(0, source, root, 0, 0, 1, 1, 0, class, 0, &aux)?;
    let atom = |name: &str| -> Result<Atom, Box<dyn Error>> {
        Ok(x.intern_atom(false, name.as_bytes())?.reply()?.atom)
    };
    let (kind, selection) = (atom("text/uri-list")?, atom("XdndSelection")?);
    let [status, finished] = [atom("XdndStatus")?, atom("XdndFinished")?];
    x.set_selection_owner(source, selection, x11rb::CURRENT_TIME)?;
    let send = |name: &str, data: [u32; 5]| -> Result<(), Box<dyn Error>> {
        let message = ClientMessageEvent::new(32, target, atom(name)?, data);
        x.send_event(false, target, EventMask::NO_EVENT, message)?;
        Ok(x.flush()?)
    };
    let now = x11rb::CURRENT_TIME;
    let (middle, copy) = (100 << 16 | 100, atom("XdndActionCopy")?);
    send("XdndEnter", [source, 5 << 24, kind, 0, 0])?;
    send("XdndPosition", [source, 0, middle, now, copy])?;
    let mut dropped = false;
    loop {
        match x.wait_for_event()? {
            Event::SelectionRequest(asked) => hand_over(&x, &asked, kind, &list)?,
            Event::ClientMessage(told) if told.type_ == status && !dropped => {
                if told.data.as_data32()[1] & 1 == 0 {
                    return Err("the window takes no files".into());
                }
                send("XdndDrop", [source, 0, now, 0, 0])?;
                dropped = true;
            }
            Event::ClientMessage(told) if told.type_ == finished => return Ok(()),
            _ => {}
        }
    }
}

/// Gives the window the list of files that it asks for.
fn hand_over(
    x: &RustConnection,
    asked: &SelectionRequestEvent,
    kind: Atom,
    list: &str,
) -> Result<(), Box<dyn Error>> {
    let mode = PropMode::REPLACE;
    x.change_property8(mode, asked.requestor, asked.property, kind, list.as_bytes())?;
    let given = SelectionNotifyEvent {
        response_type: SELECTION_NOTIFY_EVENT,
        sequence: 0,
        time: asked.time,
        requestor: asked.requestor,
        selection: asked.selection,
        target: asked.target,
        property: if asked.target == kind {
            asked.property
        } else {
            AtomEnum::NONE.into()
        },
    };
    x.send_event(false, asked.requestor, EventMask::NO_EVENT, given)?;
    Ok(x.flush()?)
}
