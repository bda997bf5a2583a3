//! The server as pages and others meet it.

mod client;
mod clients;
mod overlap;
mod shown;
