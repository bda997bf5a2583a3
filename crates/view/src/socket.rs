//! A page's two ends: one thread reads what it asks for, another writes what it is told.

use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::sync::Arc;
use std::time::{Duration, Instant};

use tungstenite::handshake::derive_accept_key;
use tungstenite::protocol::{Role, WebSocket, WebSocketConfig};
use tungstenite::{Bytes, Error, Message, Utf8Bytes};

use crate::http::{Rejection, Request};
use crate::hub::{Hub, Next, Outbox, Outgoing, PageId};
use crate::protocol::{SUBPROTOCOL, refusal};
use crate::session::{Input, Inputs};

/// Longest message of a page [bytes]: a scene as text fits.
const MESSAGE_MAX: usize = 1 << 20;
/// Silence after which a page is asked whether it is there.
const PING_AFTER: Duration = Duration::from_secs(10);
/// Silence after which it is not.
const GONE_AFTER: Duration = Duration::from_secs(30);
/// How long a page may take nothing that is sent to it.
const WRITE_PATIENCE: Duration = Duration::from_secs(10);
/// Messages that make no sense, after which a client is shown out.
const NONSENSE_MAX: u32 = 32;

/// The answer that makes a connection a page's.
///
/// # Errors
/// The request is none for it.
pub fn accept(request: &Request) -> Result<String, Rejection> {
    let upgrade = |message: String| Rejection::new(426, message);
    if !request.header_has("upgrade", "websocket") || !request.header_has("connection", "upgrade") {
        return Err(upgrade("this is the address of a WebSocket".to_owned()));
    }
    if request.header("sec-websocket-version") != Some("13") {
        return Err(upgrade("the version of the WebSocket must be 13".to_owned()));
    }
    if !request.header_has("sec-websocket-protocol", SUBPROTOCOL) {
        return Err(upgrade(format!(
            "the subprotocol must be `{SUBPROTOCOL}`: this page is of another version, load it again"
        )));
    }
    let key = request
        .header("sec-websocket-key")
        .ok_or_else(|| upgrade("there is no Sec-WebSocket-Key".to_owned()))?;
    Ok(format!(
        "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\
         Sec-WebSocket-Accept: {}\r\nSec-WebSocket-Protocol: {SUBPROTOCOL}\r\n\r\n",
        derive_accept_key(key.as_bytes())
    ))
}

/// Serves a page until it goes away. The first bytes may have come with the request.
///
/// # Errors
/// The connection breaks before it is set up.
pub fn serve(stream: TcpStream, first_bytes: Vec<u8>, hub: &Arc<Hub>, inputs: &Inputs) -> io::Result<()> {
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(GONE_AFTER))?;
    stream.set_write_timeout(Some(WRITE_PATIENCE))?;
    let writing = stream.try_clone()?;
    let (page, outbox) = hub.join();
    let writer = {
        let (hub, outbox) = (Arc::clone(hub), Arc::clone(&outbox));
        std::thread::Builder::new().name(format!("page {page} out")).spawn(move || {
            write(&writing, &outbox, &hub);
            // wakes the reader
            let _ = writing.shutdown(Shutdown::Both);
        })
    };
    if writer.is_ok() && inputs.send(Input::Joined(page)).is_ok() {
        read(stream, first_bytes, page, &outbox, inputs);
    }
    hub.leave(page);
    // the world may have ended before the page
    let _ = inputs.send(Input::Left(page));
    if let Ok(writer) = writer {
        let _ = writer.join();
    }
    Ok(())
}

/// The reader's view of the connection: what it would write goes to the writer.
struct ReadingEnd<'a> {
    stream: TcpStream,
    outbox: &'a Outbox,
}

impl Read for ReadingEnd<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.stream.read(buffer)
    }
}

impl Write for ReadingEnd<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.outbox.push(Outgoing::Raw(bytes.to_vec()));
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn config() -> WebSocketConfig {
    WebSocketConfig::default()
        .read_buffer_size(16 * 1024)
        .write_buffer_size(0)
        .max_message_size(Some(MESSAGE_MAX))
        .max_frame_size(Some(MESSAGE_MAX))
}

fn read(stream: TcpStream, first_bytes: Vec<u8>, page: PageId, outbox: &Outbox, inputs: &Inputs) {
    let end = ReadingEnd { stream, outbox };
    let mut socket = WebSocket::from_partially_read(end, first_bytes, Role::Server, Some(config()));
    let mut nonsense = 0;
    loop {
        let text = match socket.read() {
            Ok(Message::Text(text)) => text,
            Ok(Message::Ping(_) | Message::Pong(_)) => continue,
            Ok(Message::Close(_)) => return,
            Ok(_) => Utf8Bytes::from_static(""),
            // closed, silent, or against the rules: all the same end
            Err(Error::Io(error)) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(_) => return,
        };
        match crate::protocol::Wish::parse(&text) {
            Ok(crate::protocol::Wish::Seen) => outbox.seen(),
            Ok(wish) => {
                // waits while the world is busy: nothing that a person did is lost
                if inputs.send(Input::Said(page, wish)).is_err() {
                    return;
                }
            }
            Err(message) => {
                outbox.push(refusal("message", &message));
                nonsense += 1;
                if nonsense > NONSENSE_MAX {
                    return;
                }
            }
        }
    }
}

fn write(stream: &TcpStream, outbox: &Outbox, hub: &Hub) {
    let mut socket = WebSocket::from_raw_socket(stream, Role::Server, Some(config()));
    loop {
        let sent = match outbox.next(hub, PING_AFTER) {
            Next::Send(Outgoing::Text(text)) => socket.send(Message::text(&*text)),
            Next::Send(Outgoing::Binary(bytes)) => {
                let began = Instant::now();
                let sent = socket.send(Message::Binary(Bytes::from_owner(bytes)));
                hub.timeline().note("send", began);
                sent
            }
            Next::Send(Outgoing::Raw(bytes)) => {
                let mut stream = stream;
                stream.write_all(&bytes).map_err(Error::Io)
            }
            Next::Ping => socket.send(Message::Ping(Bytes::new())),
            Next::Close => return,
        };
        if sent.is_err() {
            return;
        }
    }
}
