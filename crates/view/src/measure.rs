//! What showing a world costs: time of a frame on the threads of the world and of pictures together, frames that a client gets, and how soon it sees
//! what it did.

use std::net::{Ipv4Addr, TcpStream};
use std::time::{Duration, Instant};

use souple_engine::Interruption;
use souple_math::Vec3;
use souple_mesh::BoundingBox;
use souple_scene::Scene;
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket};

use crate::hub::Hub;
use crate::protocol::{SUBPROTOCOL, Wish};
use crate::session::Stage;
use crate::{Catalogue, Options, Viewer};

/// What frames cost the world.
pub struct FrameCost {
    pub triangles: usize,
    /// Of each frame, made, coloured by displacement and handed to the pages [s].
    pub seconds: Vec<f64>,
    /// Of a frame.
    pub bytes: usize,
    /// By how much a position is off at most, as a part of the size of all bodies: frames hold numbers of four bytes.
    pub error: f64,
}

/// Makes frames of a scene's first state.
///
/// # Errors
/// The scene cannot be shown.
pub fn frame_cost(scene: Scene, samples: usize) -> Result<FrameCost, String> {
    let hub = Hub::default();
    let mut stage = Stage::new(scene, "measured".to_owned(), 0, &Interruption::default(), &hub)?;
    stage.begin_samples(&hub);
    stage.fulfil(0, Wish::Colour(Some("displacement".to_owned())), &hub)?;
    let (page, _outbox) = hub.join();
    hub.welcome(page);
    let mut bytes = 0;
    let mut seconds = Vec::with_capacity(samples);
    for _ in 0..samples {
        let clock = Instant::now();
        let frame = stage.sketch(1.0).paint();
        bytes = frame.len();
        hub.show(&frame.into());
        seconds.push(clock.elapsed().as_secs_f64());
    }
    let bodies = &stage.session().bodies;
    let positions: Vec<Vec3> = bodies
        .iter()
        .flat_map(|body| &stage.session().world.rows(body.system).positions[body.rows.clone()])
        .copied()
        .collect();
    let off = |x: &Vec3| x.to_array().iter().map(|c| (f64::from(*c as f32) - c).abs()).fold(0.0, f64::max);
    let size = BoundingBox::of(positions.iter().copied()).diagonal();
    Ok(FrameCost {
        triangles: stage.shown().map(|shown| shown.triangles.len()).sum(),
        seconds,
        bytes,
        error: positions.iter().map(off).fold(0.0, f64::max) / size,
    })
}

/// What a client on this machine gets of a world.
pub struct Served {
    /// Frames a second.
    pub rate: f64,
    /// From leading a hand to the frame that shows it there [s].
    pub latencies: Vec<f64>,
}

/// Serves a scene to one client for some seconds, which then leads a hand about.
///
/// # Errors
/// The server cannot be had, or hangs up.
pub fn served(scene: Scene, duration: Duration, samples: usize) -> Result<Served, String> {
    let options = Options {
        host: Ipv4Addr::LOCALHOST.into(),
        port: 0,
        scene_name: "measured".to_owned(),
        catalogue: Catalogue::default(),
        timeline: souple_engine::Timeline::default(),
    };
    let viewer = Viewer::open(scene, options).map_err(|error| error.to_string())?;
    let mut client = Client::open(&viewer)?;
    client.frame()?;
    let (clock, mut frames) = (Instant::now(), 0);
    while clock.elapsed() < duration {
        client.frame()?;
        frames += 1;
    }
    let rate = f64::from(frames) / clock.elapsed().as_secs_f64();
    client.wish(r#"{"do": "grab", "hand": 0, "body": 0, "points": [0], "strength": 0.01}"#)?;
    let start = client.hand()?;
    let mut latencies = Vec::with_capacity(samples);
    for sample in 1..=samples {
        // far enough apart to be told from one another as numbers of four bytes
        let offset = 1e-3 * sample as f32;
        let clock = Instant::now();
        client.wish(&format!(r#"{{"do": "move", "hand": 0, "offset": [{offset}, 0, 0]}}"#))?;
        while (client.hand()?[0] - start[0] - offset).abs() > 2e-4 {}
        latencies.push(clock.elapsed().as_secs_f64());
    }
    viewer.close();
    Ok(Served { rate, latencies })
}

/// A page that draws nothing.
struct Client(WebSocket<TcpStream>);

/// Where the hands of a frame begin, and the place of a hand in it (see `docs/protocol.md`).
const HANDS: usize = 72;
const PLACE: usize = 24;

impl Client {
    fn open(viewer: &Viewer) -> Result<Self, String> {
        let host = viewer.address().trim_start_matches("http://").trim_end_matches('/').to_owned();
        let words = |error: &dyn std::fmt::Display| error.to_string();
        let mut request = format!("ws://{host}/socket").into_client_request().map_err(|e| words(&e))?;
        let protocol = SUBPROTOCOL.parse().map_err(|_| "the subprotocol is no header".to_owned())?;
        request.headers_mut().insert("Sec-WebSocket-Protocol", protocol);
        let stream = TcpStream::connect(&host).map_err(|e| words(&e))?;
        stream.set_nodelay(true).map_err(|e| words(&e))?;
        let (socket, _) = tungstenite::client::client(request, stream).map_err(|e| words(&e))?;
        Ok(Self(socket))
    }

    fn wish(&mut self, text: &str) -> Result<(), String> {
        self.0.send(Message::text(text)).map_err(|error| error.to_string())
    }

    /// The next frame, answered.
    fn frame(&mut self) -> Result<Vec<u8>, String> {
        loop {
            if let Message::Binary(bytes) = self.0.read().map_err(|error| error.to_string())?
                && bytes.first() == Some(&2)
            {
                self.wish(r#"{"do": "seen"}"#)?;
                return Ok(bytes.to_vec());
            }
        }
    }

    /// Where the first hand is led to, in the next frame that has one [m].
    fn hand(&mut self) -> Result<[f32; 3], String> {
        loop {
            let frame = self.frame()?;
            let number =
                |at: usize| f32::from_le_bytes([frame[at], frame[at + 1], frame[at + 2], frame[at + 3]]);
            if frame[60..64] != [0; 4] {
                return Ok([0, 4, 8].map(|axis| number(HANDS + PLACE + axis)));
            }
        }
    }
}
