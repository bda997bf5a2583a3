//! A world to talk to, and a page without a screen.

use std::io::{Read, Write};
use std::net::{Ipv4Addr, TcpStream};
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use serde_json::Value;
use souple_engine::Timeline;
use souple_run::Recording;
use souple_view::{Catalogue, Options, SUBPROTOCOL, Viewer};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Error, Message, WebSocket};

pub const SCENE: &str = r#"
    format = 1
    title = "A bar"
    [world]
    period = "10 ms"
    gravity = [0, -9.81, 0]
    [bodies.bar]
    mesh = { generate = "bar", size = [0.5, 0.1, 0.1], cells = [5, 1, 1], element = "hex8" }
    material = { name = "stable_neo_hookean", youngs_modulus = "100 kPa", poissons_ratio = 0.3, density = 1000 }
    [[bodies.bar.pins]]
    region = { box = [[-1e-9, -1, -1], [1e-9, 1, 1]] }
    [probes.tip]
    body = "bar"
    region = { nearest = [0.5, 0, 0] }
    quantity = "displacement"
"#;

/// How long a test waits for what must come.
const PATIENCE: Duration = Duration::from_secs(60);

/// A viewer of a small world.
pub struct World {
    viewer: Option<Viewer>,
    host: String,
}

/// What a server answered.
pub struct Reply {
    pub status: u16,
    pub body: String,
}

impl Reply {
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.body).unwrap_or_else(|error| panic!("{error}: {}", self.body))
    }
}

impl World {
    pub fn open() -> Self {
        Self::open_with(&[])
    }

    /// A world of a scene's text.
    pub fn of(text: &str) -> Self {
        Self::read(text, &[])
    }

    pub fn open_with(settings: &[&str]) -> Self {
        Self::read(SCENE, settings)
    }

    /// The same, with the stages of its threads on a timeline.
    pub fn noted_on(text: &str, timeline: &Timeline) -> Self {
        Self::start(text, &[], timeline.clone())
    }

    fn read(text: &str, settings: &[&str]) -> Self {
        Self::start(text, settings, Timeline::default())
    }

    fn start(text: &str, settings: &[&str], timeline: Timeline) -> Self {
        let settings: Vec<String> = settings.iter().map(|setting| (*setting).to_owned()).collect();
        let scene = souple_scene::read_text("bar", text, Path::new("."), &settings)
            .unwrap_or_else(|error| panic!("{error}"));
        let options = Options {
            host: Ipv4Addr::LOCALHOST.into(),
            port: 0,
            scene_name: "bar".to_owned(),
            catalogue: Catalogue::default(),
            timeline,
        };
        let viewer = Viewer::open(scene, options).unwrap();
        let host = viewer.address().trim_start_matches("http://").trim_end_matches('/').to_owned();
        Self { viewer: Some(viewer), host }
    }

    pub fn host(&self) -> &str {
        &self.host
    }

    pub fn get(&self, path: &str) -> Reply {
        self.ask(&format!("GET {path} HTTP/1.1\r\nHost: {}\r\n\r\n", self.host))
    }

    /// Sends a request as it is.
    pub fn ask(&self, request: &str) -> Reply {
        let mut stream = TcpStream::connect(&self.host).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        let mut text = String::new();
        stream.read_to_string(&mut text).unwrap();
        let (head, body) = text.split_once("\r\n\r\n").unwrap_or_else(|| panic!("no head: {text}"));
        let status = head.split(' ').nth(1).and_then(|status| status.parse().ok()).unwrap();
        Reply { status, body: body.to_owned() }
    }

    /// What was done in this world is repeated bit for bit from its recording, which is given.
    pub fn assert_replayed(&self) -> Recording {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let name = format!("souple_live_{}_{number}.recording", std::process::id());
        let path = std::env::temp_dir().join(name);
        std::fs::write(&path, self.get("/recording").body).unwrap();
        let recording = Recording::read(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        let scene = souple_scene::read_again(&recording.inputs, Default::default()).unwrap();
        let options = souple_run::Options {
            steps: Some(recording.steps),
            commands: recording.commands.clone(),
            changes: recording.changes.clone(),
            scene_name: recording.scene.clone(),
            ..Default::default()
        };
        let outcome = souple_run::run(scene, &options, &mut |_| souple_run::Control::Continue).unwrap();
        assert_eq!(recording.first_divergence(&outcome.recording), None);
        recording
    }

    /// The simulated time [s].
    pub fn time(&self) -> f64 {
        self.get("/health").json()["time"].as_f64().unwrap()
    }
}

impl Drop for World {
    fn drop(&mut self) {
        if let Some(viewer) = self.viewer.take() {
            viewer.close();
        }
    }
}

/// A page without a screen.
pub struct Page {
    socket: WebSocket<TcpStream>,
    /// Documents not asked for yet.
    documents: Vec<Value>,
    /// Whether it says what it has seen.
    pub answers: bool,
    /// Points, triangles and edges of each message of a surface.
    pub surfaces: Vec<[u32; 3]>,
    /// When the triangles of each are there, and its edges [s].
    pub spans: Vec<[Vec<[f64; 2]>; 2]>,
    /// Tetrahedra and triangles of each message of the inside of a body.
    pub insides: Vec<[u32; 2]>,
    /// When the cells of each go [s].
    pub dates: Vec<Vec<f64>>,
    /// Body, figure, width and height of each message of a texture.
    pub textures: Vec<[u32; 4]>,
    /// Messages of tools' shapes.
    pub tool_count: u32,
    /// Bytes of the last frame.
    pub frame_bytes: usize,
}

/// Dates behind their count at a place in a message, so many of each thing that is counted; goes on behind them.
fn dates(bytes: &[u8], at: &mut usize, each: usize) -> Vec<f64> {
    let count = each * u32::from_le_bytes(bytes[*at..*at + 4].try_into().unwrap()) as usize;
    let date = |k: usize| f64::from_le_bytes(bytes[*at + 4 + 8 * k..][..8].try_into().unwrap());
    let dates = (0..count).map(date).collect();
    *at += 4 + 8 * count;
    dates
}

/// What a test looks at in a frame.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    pub number: u32,
    pub time: f64,
    pub hands: u32,
    /// Of the hands, those with a tool.
    pub tools: u32,
    /// Where the first hand's tool or points are, where these are led to [m], and what it does to bodies [N].
    pub first_hand: [[f32; 3]; 3],
    /// Of each body.
    pub point_counts: Vec<u32>,
    /// Mean height of the points of each body [m].
    pub height: Vec<f32>,
    /// Fields and kinds of arrows of the first body.
    pub field_count: u32,
    pub arrow_count: u32,
    /// Values of the fields of the first body.
    pub values: Vec<Vec<f32>>,
    /// Frames that carry each body.
    pub frame_counts: Vec<u32>,
    /// Links that do not hold.
    pub torn: usize,
    pub skin_triangles: Vec<u32>,
    /// How long the pieces of all contours are together [m].
    pub contour_length: f32,
    /// Euler characteristic of each skin as it came.
    pub skin_euler: Vec<i64>,
}

impl Frame {
    fn parse(bytes: &[u8]) -> Option<Self> {
        let u32_at = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        if bytes[0] != 2 {
            return None;
        }
        let (hands, poses, skins) = (u32_at(60), u32_at(64), u32_at(68));
        let mut at = 72 + 48 * hands as usize + 48 * poses as usize;
        let mut frame = Self { number: u32_at(24), hands, ..Self::default() };
        frame.time = f64::from_le_bytes(bytes[16..24].try_into().unwrap());
        frame.tools = (0..hands).filter(|hand| u32_at(72 + 48 * *hand as usize + 8) == 1).count() as u32;
        if hands > 0 {
            let number = |k: usize| f32::from_le_bytes(bytes[84 + 4 * k..88 + 4 * k].try_into().unwrap());
            frame.first_hand = [0, 3, 6].map(|first| [0, 1, 2].map(|k| number(first + k)));
        }
        for _ in 0..u16::from_le_bytes([bytes[2], bytes[3]]) {
            let [points, fields, arrows, links, frames] = [0, 4, 8, 12, 16].map(|offset| u32_at(at + offset));
            at += 20;
            let float = |place: usize| f32::from_le_bytes(bytes[place..place + 4].try_into().unwrap());
            let height = |k: usize| float(at + 12 * k + 4);
            frame.height.push((0..points as usize).map(height).sum::<f32>() / points as f32);
            let is_first = frame.point_counts.is_empty();
            if is_first {
                (frame.field_count, frame.arrow_count) = (fields, arrows);
            }
            at += 12 * points as usize;
            for _ in 0..fields {
                let count = u32_at(at + 4) as usize;
                if is_first {
                    frame.values.push((0..count).map(|k| float(at + 8 + 4 * k)).collect());
                }
                at += 8 + 4 * count;
            }
            at += arrows as usize * (4 + 12 * points as usize);
            frame.torn += bytes[at..at + links as usize].iter().filter(|state| **state == 0).count();
            at += (links as usize).next_multiple_of(4) + 48 * frames as usize;
            frame.point_counts.push(points);
            frame.frame_counts.push(frames);
        }
        for _ in 0..skins {
            let (points, triangles) = (u32_at(at), u32_at(at + 4));
            let first = at + 8 + 24 * points as usize;
            at = first + 12 * triangles as usize;
            assert!((first..at).step_by(4).all(|corner| u32_at(corner) < points), "corners are points");
            frame.skin_triangles.push(triangles);
            // each edge has two triangles
            frame.skin_euler.push(i64::from(points) - i64::from(triangles / 2));
        }
        let pieces = u32_at(at) as usize;
        at += 4;
        for _ in 0..pieces {
            let number = |k: usize| f32::from_le_bytes(bytes[at + 4 * k..at + 4 * k + 4].try_into().unwrap());
            frame.contour_length += (0..3).map(|k| (number(k + 3) - number(k)).powi(2)).sum::<f32>().sqrt();
            at += 24;
        }
        assert_eq!(at, bytes.len(), "the frame has its length");
        Some(frame)
    }
}

impl Page {
    pub fn open(world: &World) -> Self {
        Self::try_open(world, None, SUBPROTOCOL).unwrap_or_else(|error| panic!("{error}"))
    }

    pub fn try_open(world: &World, origin: Option<&str>, protocol: &str) -> Result<Self, String> {
        let mut request = format!("ws://{}/socket", world.host()).into_client_request().unwrap();
        let headers = request.headers_mut();
        headers.insert("Sec-WebSocket-Protocol", protocol.parse().unwrap());
        if let Some(origin) = origin {
            headers.insert("Origin", origin.parse().unwrap());
        }
        let stream = TcpStream::connect(world.host()).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let (socket, _) = tungstenite::client::client(request, stream).map_err(|error| error.to_string())?;
        Ok(Self {
            socket,
            documents: Vec::new(),
            answers: true,
            surfaces: Vec::new(),
            spans: Vec::new(),
            insides: Vec::new(),
            dates: Vec::new(),
            textures: Vec::new(),
            tool_count: 0,
            frame_bytes: 0,
        })
    }

    pub fn wish(&mut self, wish: Value) {
        self.text(&wish.to_string());
    }

    /// Sends a text; a server that has hung up is no fault of the test.
    pub fn text(&mut self, text: &str) {
        let _ = self.socket.send(Message::text(text));
    }

    pub fn binary(&mut self, bytes: &[u8]) {
        let _ = self.socket.send(Message::binary(bytes.to_vec()));
    }

    /// Bytes under the protocol.
    pub fn raw(&mut self, bytes: &[u8]) {
        let _ = self.socket.get_mut().write_all(bytes);
    }

    pub fn is_closed(&mut self) -> bool {
        loop {
            match self.socket.read() {
                Ok(_) => {}
                Err(Error::Io(error)) => return error.kind() != std::io::ErrorKind::WouldBlock,
                Err(_) => return true,
            }
        }
    }

    /// The next message: a document is kept, a frame is given.
    fn read(&mut self) -> Option<Frame> {
        match self.socket.read().unwrap_or_else(|error| panic!("the connection is lost: {error}")) {
            Message::Text(text) => self.documents.push(serde_json::from_str(&text).unwrap()),
            Message::Binary(bytes) => {
                let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
                match bytes[0] {
                    1 => {
                        let [points, triangles] = [number(8), number(12)];
                        let edges = number(16 + 12 * (points + triangles) as usize);
                        self.surfaces.push([points, triangles, edges]);
                        let mut at = 20 + 12 * (points + triangles) as usize + 8 * edges as usize;
                        self.spans.push([(); 2].map(|()| {
                            let spans = dates(&bytes, &mut at, 2);
                            spans.chunks_exact(2).map(|span| [span[0], span[1]]).collect()
                        }));
                    }
                    5 => {
                        let [tetrahedra, triangles] = [number(8), number(12)];
                        self.insides.push([tetrahedra, triangles]);
                        let mut at = 16 + 20 * tetrahedra as usize + 16 * triangles as usize;
                        self.dates.push(dates(&bytes, &mut at, 1));
                    }
                    6 => self.tool_count += 1,
                    7 => {
                        let body = u16::from_le_bytes([bytes[2], bytes[3]]);
                        self.textures.push([body.into(), number(8), number(16), number(20)]);
                        assert_eq!(bytes.len() as u32, 48 + 4 * number(16) * number(20));
                    }
                    _ => {}
                }
                let frame = Frame::parse(&bytes)?;
                self.frame_bytes = bytes.len();
                if self.answers {
                    self.wish(serde_json::json!({"do": "seen"}));
                }
                return Some(frame);
            }
            _ => {}
        }
        None
    }

    /// Reads up to the description of the world, and says whether a picture or samples came before it.
    pub fn is_shown_before_described(&mut self) -> bool {
        const PICTURES: [u8; 2] = [2, 3];
        let mut is_shown = false;
        loop {
            match self.socket.read().unwrap_or_else(|error| panic!("the connection is lost: {error}")) {
                Message::Text(text) => {
                    let document: Value = serde_json::from_str(&text).unwrap();
                    if document["kind"] == "scene" {
                        return is_shown;
                    }
                }
                Message::Binary(bytes) => is_shown |= PICTURES.contains(&bytes[0]),
                _ => {}
            }
        }
    }

    /// The kind of the next message.
    pub fn first_message(&mut self) -> String {
        match self.socket.read().unwrap_or_else(|error| panic!("the connection is lost: {error}")) {
            Message::Text(text) => {
                let document: Value = serde_json::from_str(&text).unwrap();
                document["kind"].as_str().unwrap_or_default().to_owned()
            }
            other => format!("{other:?}"),
        }
    }

    pub fn frame(&mut self) -> Frame {
        self.frame_where(|_| true)
    }

    pub fn frame_where(&mut self, is_wanted: impl Fn(&Frame) -> bool) -> Frame {
        let deadline = Instant::now() + PATIENCE;
        loop {
            if let Some(frame) = self.read().filter(&is_wanted) {
                return frame;
            }
            assert!(Instant::now() < deadline, "no such frame came");
        }
    }

    /// Whether no frame comes for a while.
    pub fn no_frame_for(&mut self, while_: Duration) -> bool {
        self.socket.get_mut().set_read_timeout(Some(while_)).unwrap();
        let silent = loop {
            match self.socket.read() {
                Ok(Message::Binary(bytes)) if bytes[0] == 2 => break false,
                Ok(_) => {}
                Err(Error::Io(_)) => break true,
                Err(error) => panic!("{error}"),
            }
        };
        self.socket.get_mut().set_read_timeout(Some(PATIENCE)).unwrap();
        silent
    }

    /// The next document of a kind.
    pub fn document(&mut self, kind: &str) -> Value {
        self.document_where(kind, |_| true)
    }

    pub fn document_where(&mut self, kind: &str, is_wanted: impl Fn(&Value) -> bool) -> Value {
        let deadline = Instant::now() + PATIENCE;
        loop {
            let found =
                self.documents.iter().position(|document| document["kind"] == kind && is_wanted(document));
            if let Some(at) = found {
                return self.documents.drain(..=at).next_back().unwrap();
            }
            assert!(Instant::now() < deadline, "no `{kind}` came: {:?}", self.documents);
            self.read();
        }
    }
}
