//! The specification of a scene: what its text says, checked key by key, before anything is built.

pub mod adapt;
pub mod bending;
pub mod body;
pub mod bone;
pub mod boundary;
pub mod contact;
pub mod control;
pub mod expect;
pub mod frames;
pub mod hand;
pub mod incompressible;
pub mod inelasticity;
pub mod interaction;
pub mod levels;
pub mod marks;
pub mod mesh;
pub mod modes;
pub mod network;
pub mod octree;
pub mod parts;
pub mod picture;
pub mod polynomial;
pub mod probe;
pub mod quantity;
pub mod region;
mod rules;
pub mod skin;
pub mod sound;
pub mod split;
pub mod start;
pub mod texture;
pub mod units;
pub mod view;
pub mod world;

use souple_engine::Detection;
use souple_formal::Formula;
use souple_math::Vec3;
use souple_table::{Range, readable};

use crate::diagnostic::{Code, Log, Site};
use crate::document::{Content, Node, Table};
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;
use crate::source::Place;
use crate::values::{Reading, quoted};

use body::{BODY, Body};
use bone::{BONE, BoneSpec};
use contact::{Against, CONTACT, Contact, SHAPE, ShapeSpec};
use expect::{EXPECT, Expect};
use hand::{HAND, HandSpec};
use interaction::{ATTACHMENT, COUPLING, Link};
use mesh::MeshSpec;
use network::{NETWORK, Network};
use parts::MODULE;
use picture::{PICTURE, PictureSpec, PictureView};
use probe::{PROBE, Probe};
use skin::{SKIN, SkinSpec};
use sound::{SOUND, Sound};
use world::{DEFAULT_SYSTEM, PERIODS_MAX, RUN, RunSpec, SYSTEM, SystemSpec, WORLD, WorldSpec};

/// The version of the format that this crate reads.
pub const FORMAT: i64 = 1;

/// The keys of a scene.
pub(crate) static SCENE: Keys = Keys::new(
    "scene",
    "a world of soft things; numbers are in SI units or texts with a unit, such as \"10 kPa\"",
    &[
        Key::integer("format", Range::closed(1.0, 1.0), "version of the scene format").required(),
        Key::new("title", Shape::Text, "one line"),
        Key::new("description", Shape::Text, "what there is to see and to learn"),
        Key::new("shows", Shape::Texts, "ids of the capabilities it shows"),
        Key::new("include", Shape::Texts, "scene files taken in; what is written here wins"),
        Key::new("parameters", Shape::Values, "values used as \"$name\" below"),
        Key::new("world", Shape::Table(&WORLD), "what all systems share").required(),
        Key::new("systems", Shape::Named(&SYSTEM), "how bodies step; `main` where left out"),
        Key::new("bodies", Shape::Named(&BODY), "soft solids"),
        Key::new("networks", Shape::Named(&NETWORK), "masses and what acts between them"),
        Key::new(
            "modules",
            Shape::Named(&MODULE),
            "parts of networks that are written once and placed often",
        ),
        Key::new("shapes", Shape::Named(&SHAPE), "things of fixed shape that bodies touch"),
        Key::new("bones", Shape::Named(&BONE), "rigid motions that frames and pins follow"),
        Key::new("contacts", Shape::Tables(&CONTACT), "who touches whom"),
        Key::new("attachments", Shape::Tables(&ATTACHMENT), "what joins bodies of one system"),
        Key::new("couplings", Shape::Tables(&COUPLING), "what joins systems"),
        Key::new("skins", Shape::Named(&SKIN), "surfaces with behaviour of their own"),
        Key::new("hands", Shape::Named(&HAND), "people at devices that press on bodies and feel them"),
        Key::new("probes", Shape::Named(&PROBE), "what is measured"),
        Key::new("sounds", Shape::Named(&SOUND), "probes that are listened to"),
        Key::new("expect", Shape::Tables(&EXPECT), "what the probes must read"),
        Key::new("run", Shape::Table(&RUN), "what a run does unless told otherwise"),
        Key::new("picture", Shape::Table(&PICTURE), "from where pictures are seen"),
    ],
);

/// A scene as its text says it.
pub struct Spec {
    pub title: String,
    pub description: String,
    /// Ids of capabilities.
    pub shows: Vec<String>,
    pub world: WorldSpec,
    pub systems: Vec<SystemSpec>,
    pub bodies: Vec<Body>,
    pub shapes: Vec<ShapeSpec>,
    pub bones: Vec<BoneSpec>,
    pub contacts: Vec<Contact>,
    pub attachments: Vec<Link>,
    pub couplings: Vec<Link>,
    /// Those of bodies among them, by the name of the body.
    pub skins: Vec<SkinSpec>,
    pub hands: Vec<HandSpec>,
    pub probes: Vec<Probe>,
    pub sounds: Vec<Sound>,
    pub expects: Vec<Expect>,
    pub run: RunSpec,
    pub picture: PictureSpec,
}

impl Spec {
    /// Reads a document without includes and parameters; what is wrong goes to the log.
    pub(crate) fn read(document: Table, source: usize, log: &Log) -> Self {
        let root = Node::new(Place::start_of(source), Content::Table(document));
        if is_other_format(&root, log) {
            // keys of another version would only give a hail of faults
            return Self::empty(source);
        }
        let Some(reader) = Reader::open(&Reading { node: &root, path: String::new(), log }, &SCENE) else {
            return Self::empty(source);
        };
        reader.maybe_integer("format");
        let empty = Self::empty(source);
        let written = reader.named("probes");
        let probes: Vec<Probe> =
            written.iter().map(|(name, probe)| Probe::read(name.clone(), probe)).collect();
        written.iter().zip(&probes).for_each(|((_, reader), probe)| probe.check_over(reader, &probes));
        let expects =
            reader.tables("expect").iter().filter_map(|expect| Expect::read(expect, &probes)).collect();
        let mut systems: Vec<SystemSpec> = reader
            .named("systems")
            .into_iter()
            .map(|(name, system)| SystemSpec::read(name, &system))
            .collect();
        if !reader.has("systems") {
            systems.push(SystemSpec::default_system(Site { path: "systems".to_owned(), ..reader.site() }));
        }
        let world = reader.table("world").map_or(empty.world, |world| WorldSpec::read(&world));
        let sounds = reader
            .named("sounds")
            .into_iter()
            .map(|(name, sound)| Sound::read(name, &sound, &probes, world.period))
            .collect();
        let mut spec = Self {
            title: reader.text("title"),
            description: reader.text("description"),
            shows: reader.texts("shows"),
            world,
            bodies: bodies(&reader),
            shapes: reader
                .named("shapes")
                .into_iter()
                .map(|(name, shape)| ShapeSpec::read(name, &shape))
                .collect(),
            bones: reader
                .named("bones")
                .into_iter()
                .map(|(name, bone)| BoneSpec::read(name, &bone))
                .collect(),
            contacts: contacts(&reader),
            attachments: reader.tables("attachments").iter().map(Link::attachment).collect(),
            couplings: reader.tables("couplings").iter().map(Link::coupling).collect(),
            picture: reader
                .table("picture")
                .map_or_else(PictureSpec::default, |picture| PictureSpec::read(&picture)),
            run: reader.table("run").map_or(empty.run, |run| RunSpec::read(&run)),
            skins: skins(&reader),
            hands: reader
                .named("hands")
                .into_iter()
                .map(|(name, hand)| HandSpec::read(name, &hand))
                .collect(),
            systems,
            probes,
            sounds,
            expects,
        };
        spec.choose_systems();
        spec.make_physical();
        spec.check_names(log);
        spec.check_file_names(log);
        spec.check_times(log);
        spec
    }

    fn empty(source: usize) -> Self {
        let site = Site { place: Place::start_of(source), path: "world".to_owned() };
        Self {
            title: String::new(),
            description: String::new(),
            shows: Vec::new(),
            world: WorldSpec {
                period: f64::NAN,
                period_site: site.clone(),
                gravity: None,
                gravity_site: site.clone(),
                detection: Detection::default(),
                detection_site: site.clone(),
                frame: None,
                site,
            },
            systems: Vec::new(),
            bodies: Vec::new(),
            shapes: Vec::new(),
            bones: Vec::new(),
            contacts: Vec::new(),
            attachments: Vec::new(),
            couplings: Vec::new(),
            skins: Vec::new(),
            hands: Vec::new(),
            probes: Vec::new(),
            sounds: Vec::new(),
            expects: Vec::new(),
            run: RunSpec::default(),
            picture: PictureSpec::default(),
        }
    }

    /// Bodies that name no system belong to the only one there is, or to `main`.
    fn choose_systems(&mut self) {
        let default = match &self.systems[..] {
            [only] => only.name.clone(),
            _ => DEFAULT_SYSTEM.to_owned(),
        };
        for body in self.bodies.iter_mut().filter(|body| body.system.is_empty()) {
            body.system.clone_from(&default);
        }
    }

    /// Every name that refers to something finds it.
    fn check_names(&self, log: &Log) {
        let bodies: Vec<&str> = self.bodies.iter().map(|body| body.name.as_str()).collect();
        let systems: Vec<&str> = self.systems.iter().map(|system| system.name.as_str()).collect();
        let is_led = |name: &str| {
            self.bones.iter().any(|bone| bone.name == name)
                || self.shapes.iter().any(|shape| shape.name == name)
        };
        let check = |kind: &str, name: &str, known: &[&str], site: &Site| {
            if kind == "body" && is_led(name) && !known.contains(&name) {
                let message = format!("`{name}` is a bone or a shape, and no body");
                let expected = format!(
                    "a body, such as one with `bone = \"{name}\"` in `pins` of all its points, or in `frames.bones` of all its frames"
                );
                log.add(Code::UnknownName, site, message, expected);
            } else if !known.contains(&name) && !name.is_empty() {
                let hint = crate::keys::did_you_mean(name, known.iter().copied());
                let message = format!("there is no {kind} `{name}`{hint}");
                log.add(Code::UnknownName, site, message, crate::keys::one_of(known));
            }
        };
        let skins: Vec<&str> = self.skins.iter().map(|skin| skin.name.as_str()).collect();
        for probe in &self.probes {
            if let Some(skin) = &probe.skin {
                check("skin", skin, &skins, &probe.site);
            }
        }
        for body in &self.bodies {
            check("system", &body.system, &systems, &body.site);
            if let Some(tissue) = body.mesh.as_ref().and_then(MeshSpec::tissue) {
                for end in [&tissue.from, &tissue.to] {
                    check("body", &end.body, &bodies, &end.body_site);
                }
            }
        }
        for probe in &self.probes {
            if let Some(body) = &probe.body {
                check("body", body, &bodies, &probe.site);
            }
            if let Some(probe::Against::Body { name, site }) = &probe.against {
                check("body", name, &bodies, site);
            }
        }
        let shapes: Vec<&str> = self.shapes.iter().map(|shape| shape.name.as_str()).collect();
        let contacts: Vec<&str> = self.contacts.iter().map(|contact| contact.name.as_str()).collect();
        for contact in &self.contacts {
            check("body", &contact.body, &bodies, &contact.site);
            match &contact.against {
                Some(Against::Shape(shape)) => check("shape", shape, &shapes, &contact.site),
                Some(Against::Body(body)) => check("body", body, &bodies, &contact.site),
                Some(Against::Skin(skin)) => check("skin", skin, &skins, &contact.site),
                None => {}
            }
        }
        let pressing: Vec<String> =
            self.networks().flat_map(|(body, it)| it.names_of_contacts(body)).collect();
        let touching: Vec<&str> =
            contacts.iter().copied().chain(pressing.iter().map(String::as_str)).collect();
        let kept: Vec<String> =
            self.networks().flat_map(|(body, it)| it.names_of_constraints(body)).collect();
        let kept: Vec<&str> = kept.iter().map(String::as_str).collect();
        let is_of_other = |body: &str, constraint: &String| {
            let own = constraint.strip_prefix(body).is_some_and(|rest| rest.starts_with('.'));
            kept.contains(&constraint.as_str()) && !own
        };
        for probe in &self.probes {
            if let Some(name) = &probe.contact {
                if kept.contains(&name.as_str()) {
                    let message = format!("`{name}` holds from both sides, and is no contact");
                    let expected = "`constraint_force` with `constraint`";
                    log.add(Code::UnknownName, &probe.site, message, expected);
                } else {
                    check("contact", name, &touching, &probe.site);
                }
            }
            if let Some(name) = &probe.constraint {
                if pressing.contains(name) {
                    let message = format!("`{name}` pushes from one side alone, and is a contact");
                    let expected = "`contact_force` with `contact`";
                    log.add(Code::UnknownName, &probe.site, message, expected);
                } else if let Some(body) = probe.body.as_ref().filter(|body| is_of_other(body, name)) {
                    let message = format!(
                        "constraint `{name}` is of another network than `{body}`, whose masses it does nothing to"
                    );
                    log.add(
                        Code::Conflict,
                        &probe.site,
                        message,
                        "the network of the constraint, or no `body`",
                    );
                } else {
                    check("constraint", name, &kept, &probe.site);
                }
            }
        }
        let hands: Vec<&str> = self.hands.iter().map(|hand| hand.name.as_str()).collect();
        for hand in &self.hands {
            check("body", &hand.touch.body, &bodies, &hand.site);
        }
        for probe in &self.probes {
            if let Some(hand) = &probe.hand {
                check("hand", hand, &hands, &probe.site);
            }
        }
        for link in self.attachments.iter().chain(&self.couplings) {
            check("body", &link.from, &bodies, &link.from_site);
            check("body", &link.to, &bodies, &link.to_site);
        }
    }

    /// Networks with the names of their bodies.
    fn networks(&self) -> impl Iterator<Item = (&str, &Network)> {
        self.bodies.iter().filter_map(|body| Some((body.name.as_str(), body.network.as_ref()?)))
    }

    /// Bodies, probes and sounds give their names to files, which must stay in the folder of a run.
    fn check_file_names(&self, log: &Log) {
        let bodies = self.bodies.iter().map(|body| ("body", &body.name, &body.site));
        let probes = self.probes.iter().map(|probe| ("probe", &probe.name, &probe.site));
        let sounds = self.sounds.iter().map(|sound| ("sound", &sound.name, &sound.site));
        for (kind, name, site) in bodies.chain(probes).chain(sounds) {
            if let Some(why) = unfit_for_files(name) {
                let message = format!("the {kind} `{}` cannot name a file: {why}", quoted(name));
                let expected = format!(
                    "a name of 1 to {LONGEST_NAME} bytes without control characters and {}, not begun by a dot",
                    NOT_IN_FILE_NAMES.iter().collect::<String>()
                );
                log.add(Code::BadName, site, message, expected);
            }
        }
        for body in self.bodies.iter().filter(|body| body.frames.is_some()) {
            let own = format!("{}.frames", body.name);
            for other in self.bodies.iter().filter(|other| other.name == own) {
                let message =
                    format!("files of the name `{own}` are those of the frames of body `{}`", body.name);
                log.add(Code::BadName, &other.site, message, "another name");
            }
        }
    }

    /// From where pictures of the scene are seen.
    pub fn picture_view(&self) -> PictureView {
        let at_start = |gravity: &[Formula; 3]| {
            Vec3::from_array([0, 1, 2].map(|axis: usize| gravity[axis].evaluate(&[0.0])))
        };
        self.picture.view(self.world.gravity.as_ref().map_or(Vec3::ZERO, at_start))
    }

    fn check_times(&self, log: &Log) {
        let periods = self.run.duration / self.world.period;
        // half a period is rounded up to one; a duration that is left out may be told on the command line
        if self.run.has_duration && periods < 0.5 {
            let message = format!(
                "a `duration` of {} s is {periods:.3e} of the period, {} s: no step would be made",
                readable(self.run.duration),
                readable(self.world.period)
            );
            log.add(
                Code::OutOfRange,
                &self.world.period_site,
                message,
                "a period of at most twice the `duration`",
            );
        }
        if periods > PERIODS_MAX {
            let message = format!("the run has {periods:.1e} periods of {} s", readable(self.world.period));
            let expected = format!("at most {PERIODS_MAX:.0e} periods in the duration of a run");
            log.add(Code::TooLarge, &self.world.period_site, message, expected);
        }
    }

    pub fn body(&self, name: &str) -> Option<&Body> {
        self.bodies.iter().find(|body| body.name == name)
    }
}

/// Longest name of a body, probe or sound [bytes]: file systems take 255, with what is put behind it.
const LONGEST_NAME: usize = 100;
/// Characters that some file system does not take.
const NOT_IN_FILE_NAMES: [char; 9] = ['/', '\\', ':', '*', '?', '"', '<', '>', '|'];

/// Why a name cannot be that of a file.
fn unfit_for_files(name: &str) -> Option<String> {
    if name.trim().is_empty() {
        return Some("it is empty".to_owned());
    }
    if name.len() > LONGEST_NAME {
        return Some(format!("it has {} bytes", name.len()));
    }
    if name.starts_with('.') {
        return Some("it begins with a dot".to_owned());
    }
    let bad = name.chars().find(|c| c.is_control() || NOT_IN_FILE_NAMES.contains(c))?;
    Some(format!("it has a {bad:?}"))
}

/// Solids, then networks, which share their names.
fn bodies(reader: &Reader) -> Vec<Body> {
    let solids = reader.named("bodies").into_iter().map(|(name, body)| Body::read(name, &body));
    let networks = reader.named("networks").into_iter().map(|(name, network)| Network::body(name, &network));
    let all: Vec<Body> = solids.chain(networks).collect();
    for (index, body) in all.iter().enumerate() {
        if all[..index].iter().any(|other| other.name == body.name) {
            let message = format!("there are a body and a network `{}`", body.name);
            reader.log().add(Code::Conflict, &body.site, message, "names that differ");
        }
    }
    all
}

/// Skins that stand alone, then those of bodies and of networks.
fn skins(reader: &Reader) -> Vec<SkinSpec> {
    let alone = reader.named("skins").into_iter().map(|(name, skin)| SkinSpec::read(name, &skin));
    let bodies = reader.named("bodies").into_iter();
    let worn = bodies.filter_map(|(name, body)| Some(SkinSpec::of_body(&name, &body.table("skin")?)));
    let networks = reader.named("networks").into_iter();
    let masses = networks.filter_map(|(name, body)| Some(SkinSpec::of_network(&name, &body.table("skin")?)));
    let all: Vec<SkinSpec> = alone.chain(worn).chain(masses).collect();
    for (index, skin) in all.iter().enumerate() {
        if all[..index].iter().any(|other| other.name == skin.name) {
            let message = format!("there are two skins `{}`: one of a body has the body's name", skin.name);
            reader.log().add(Code::Conflict, &skin.site, message, "names that differ");
        }
    }
    all
}

fn contacts(reader: &Reader) -> Vec<Contact> {
    reader
        .tables("contacts")
        .iter()
        .enumerate()
        .map(|(index, contact)| Contact::read(index, contact))
        .collect()
}

/// Whether the scene says that it is of another version, which is then reported.
fn is_other_format(root: &Node, log: &Log) -> bool {
    let Some(node) = root.as_table().and_then(|table| table.get("format")) else { return false };
    match node.content {
        Content::Integer(version) if version != FORMAT => {
            let site = Site { place: node.place, path: "format".to_owned() };
            log.add(
                Code::Format,
                &site,
                format!("this is a scene of format {version}"),
                format!("format = {FORMAT}"),
            );
            true
        }
        _ => false,
    }
}
