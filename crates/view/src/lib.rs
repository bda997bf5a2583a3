//! Worlds live in the browser: server, wire protocol, page.
//!
//! [`Viewer::open`] listens, steps a scene in true real time in a thread of its own, and serves the page that shows it.
//! Pages say what a person wants; the world answers with documents and pictures. Nothing that a page does or fails to
//! do holds up the world. The protocol is in `docs/protocol.md`.

mod catalogue;
mod classes;
mod dropped;
mod fields;
mod guard;
mod http;
mod hub;
pub mod measure;
mod page;
mod protocol;
mod server;
mod session;
mod socket;
mod tools;

pub use catalogue::Catalogue;
pub use protocol::SUBPROTOCOL;
pub use server::{Options, ViewError, Viewer};

/// Why this program was built without the page, and what would give it one; a server without it answers other clients
/// all the same.
pub fn missing_page() -> Option<&'static str> {
    page::PROBLEM
}
