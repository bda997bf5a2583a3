//! The listener: who comes in, and what is at which path.

use std::net::{IpAddr, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::sync_channel;
use std::time::Duration;

use souple_engine::Timeline;
use souple_scene::Scene;

use crate::catalogue::Catalogue;
use crate::dropped::{DropFolder, FILE_MAX, scene_of};
use crate::guard::Guard;
use crate::http::{Rejection, Request, Response};
use crate::hub::{Hub, PageId};
use crate::protocol::Wish;
use crate::session::{Answer, Input, Inputs, Live, Question};
use crate::{page, socket};

/// Connections at a time; more are turned away, so that threads and memory stay bounded.
const CONNECTIONS_MAX: usize = 96;
/// Requests that may wait for the world.
const INPUTS_MAX: usize = 1024;
/// How long the world may take to answer a download.
const ANSWER_PATIENCE: Duration = Duration::from_secs(20);

/// Time after a connection that could not be taken until the next is.
const ACCEPT_AGAIN: Duration = Duration::from_millis(20);

/// What a viewer is asked for.
pub struct Options {
    pub host: IpAddr,
    /// 0 picks one.
    pub port: u16,
    /// How the scene is called in reports and in the command that reproduces the run.
    pub scene_name: String,
    /// Other scenes to choose from.
    pub catalogue: Catalogue,
    /// What has the stages of all threads.
    pub timeline: Timeline,
}

/// Why there is no viewer.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    #[error("{address} cannot be listened on: {error}; take another --port, or --port 0 for any free one")]
    Bind { address: SocketAddr, error: std::io::Error },
    #[error("the system gives no random numbers for a token: {0}")]
    Token(getrandom::Error),
    #[error("the system gives no thread: {0}")]
    Thread(std::io::Error),
    #[error("the world cannot start: {0}")]
    World(String),
}

/// A world that pages look at.
pub struct Viewer {
    address: String,
    inputs: Inputs,
    dropped: Arc<DropFolder>,
}

struct Server {
    guard: Guard,
    hub: Arc<Hub>,
    inputs: Inputs,
    connections: AtomicUsize,
    dropped: Arc<DropFolder>,
}

impl Viewer {
    /// Listens, and starts the world; it waits for its first page.
    ///
    /// # Errors
    /// See [`ViewError`].
    pub fn open(scene: Scene, options: Options) -> Result<Self, ViewError> {
        let wanted = SocketAddr::new(options.host, options.port);
        let bind = |error| ViewError::Bind { address: wanted, error };
        let listener = TcpListener::bind(wanted).map_err(bind)?;
        let local = listener.local_addr().map_err(bind)?;
        let guard = Guard::new(local).map_err(ViewError::Token)?;
        let address = guard.address();
        let (hub, (inputs, inbox)) = (Arc::new(Hub::noted_on(options.timeline)), Inputs::new(INPUTS_MAX));
        let catalogue = options.catalogue;
        let live = Live::new(scene, options.scene_name, catalogue, Arc::clone(&hub), inputs.clone())
            .map_err(ViewError::World)?;
        let thread = |name: &str| std::thread::Builder::new().name(name.to_owned());
        thread("world").spawn(move || live.run(&inbox)).map_err(ViewError::Thread)?;
        let dropped = Arc::new(DropFolder::default());
        let server = Server {
            guard,
            hub,
            inputs: inputs.clone(),
            connections: AtomicUsize::new(0),
            dropped: Arc::clone(&dropped),
        };
        let server = Arc::new(server);
        thread("listener").spawn(move || server.listen(&listener)).map_err(ViewError::Thread)?;
        Ok(Self { address, inputs, dropped })
    }

    /// Where a person finds the page.
    pub fn address(&self) -> &str {
        &self.address
    }

    /// Ends the world.
    pub fn close(self) {
        let _ = self.inputs.send(Input::Stop);
        self.dropped.clear();
    }
}

impl Server {
    fn listen(self: &Arc<Self>, listener: &TcpListener) {
        for stream in listener.incoming() {
            let Ok(mut stream) = stream else {
                // a connection that broke before it was taken, or no room for one: that may last
                std::thread::sleep(ACCEPT_AGAIN);
                continue;
            };
            if self.connections.fetch_add(1, Ordering::Relaxed) >= CONNECTIONS_MAX {
                self.connections.fetch_sub(1, Ordering::Relaxed);
                let _ = Rejection::new(503, "too many connections; close some pages").send(&mut stream);
                continue;
            }
            let server = Arc::clone(self);
            let spawned = std::thread::Builder::new().name("client".to_owned()).spawn(move || {
                let _counted = Counted(&server.connections);
                server.serve(stream);
            });
            if spawned.is_err() {
                self.connections.fetch_sub(1, Ordering::Relaxed);
            }
        }
    }

    /// Whatever goes wrong on a connection ends that connection, and nothing else.
    fn serve(&self, mut stream: TcpStream) {
        let mut request = match Request::read(&mut stream) {
            Ok(Some(request)) => request,
            Ok(None) => return,
            Err(rejection) => {
                let _ = rejection.send(&mut stream);
                return;
            }
        };
        if request.path == "/socket" {
            let checked = self.guard.check_site(&request).and_then(|()| self.guard.check_token(&request));
            match checked.and_then(|()| socket::accept(&request)) {
                Ok(answer) => {
                    use std::io::Write;
                    if stream.write_all(answer.as_bytes()).is_ok() {
                        let _ = socket::serve(stream, request.rest, &self.hub, &self.inputs);
                    }
                }
                Err(rejection) => {
                    let _ = rejection.send(&mut stream);
                }
            }
            return;
        }
        let answer = if request.path == "/mesh" && request.method == "POST" {
            self.take_mesh(&mut request, &mut stream)
        } else {
            self.answer(&request)
        };
        match answer {
            Ok(answer) => {
                let response = Response {
                    status: 200,
                    kind: &answer.kind,
                    content: &answer.content,
                    save_as: answer.save_as.as_deref(),
                };
                let _ = response.send(&mut stream, &request.method);
            }
            Err(rejection) => {
                let _ = rejection.send(&mut stream);
            }
        }
    }

    /// Takes a mesh, and lets the world go on with a scene of it.
    fn take_mesh(&self, request: &mut Request, stream: &mut TcpStream) -> Result<Answer, Rejection> {
        self.guard.check_site(request)?;
        self.guard.check_token(request)?;
        let wrong = |message: String| Rejection::new(400, message);
        let name = request.query_value("name").unwrap_or_else(|| "mesh".to_owned());
        let page = request.query_value("page").and_then(|page| page.parse().ok());
        let content = request.body(stream, FILE_MAX)?;
        let file = self.dropped.keep(&name, &content).map_err(wrong)?;
        let text = scene_of(&file).map_err(wrong)?;
        let wish = Wish::LoadText { name, text, mesh: Some(file) };
        let gone = || Rejection::new(503, "the world does not answer");
        // a client that is no page is told nothing of what becomes of it
        let page = page.unwrap_or(PageId::MAX);
        self.inputs.send(Input::Said(page, wish)).map_err(|_| gone())?;
        Ok(Answer::json(&serde_json::json!({"taken": content.len()})))
    }

    fn answer(&self, request: &Request) -> Result<Answer, Rejection> {
        if !matches!(request.method.as_str(), "GET" | "HEAD") {
            return Err(Rejection::new(
                405,
                format!("`{}` is not understood here; GET and HEAD are", request.method),
            ));
        }
        self.guard.check_site(request)?;
        if let Some(file) = page::file(&request.path) {
            // the page itself is no secret
            return Ok(Answer::new(file.kind, file.content.to_vec()));
        }
        self.guard.check_token(request)?;
        if request.path == "/health" {
            let mut health = self.hub.health();
            health["pages"] = self.hub.page_count().into();
            return Ok(Answer::json(&health));
        }
        let Some(question) = Question::of_path(&request.path) else {
            let known = "/, /health, /report, /recording, /snapshot, /socket, /mesh for POST";
            return Err(Rejection::new(404, format!("there is no `{}`; there are {known}", request.path)));
        };
        let (answer, answered) = sync_channel(1);
        let gone = || Rejection::new(503, "the world does not answer");
        self.inputs.send(Input::Asked(question, answer)).map_err(|_| gone())?;
        Ok(answered.recv_timeout(ANSWER_PATIENCE).map_err(|_| gone())?.write())
    }
}

/// A connection while it lasts.
struct Counted<'a>(&'a AtomicUsize);

impl Drop for Counted<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}
