//! Clients of all kinds: good ones see and move one world, bad ones are turned away, and nothing stops it.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::json;
use souple_view::SUBPROTOCOL;
use souple_view::measure::served;

use crate::client::{Page, SCENE, World};

/// The world goes on: its time passes.
fn assert_alive(world: &World) {
    let before = world.time();
    let deadline = Instant::now() + Duration::from_secs(20);
    while world.time() <= before {
        assert!(Instant::now() < deadline, "the world stands still at {before} s");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn paths_and_sites() {
    let world = World::open();
    assert_eq!(world.get("/health").status, 200);
    let report = world.get("/report").json();
    assert_eq!(report["scene"], "bar");
    assert!(report["counts"]["points"].as_u64() > Some(0));
    let lost = world.get("/nothing");
    assert_eq!(lost.status, 404);
    assert!(lost.body.contains("/report"), "{}", lost.body);
    let own = format!("Host: {}\r\n", world.host());
    assert_eq!(world.ask(&format!("POST /health HTTP/1.1\r\n{own}\r\n")).status, 405);
    assert_eq!(world.ask("GET /health HTTP/1.1\r\nHost: evil.example\r\n\r\n").status, 403);
    let foreign = format!("GET /report HTTP/1.1\r\n{own}Origin: http://evil.example\r\n\r\n");
    assert_eq!(world.ask(&foreign).status, 403);
    assert_eq!(world.ask("\u{16}\u{3}\u{1}\r\n\r\n").status, 400);
    assert_eq!(world.ask(&format!("GET /socket HTTP/1.1\r\n{own}\r\n")).status, 426);
}

/// Masses and links in motion are sent, frame after frame; how often a second the benchmark `view_network` measures.
#[test]
fn networks_are_shown() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/network_lattice");
    let scene =
        souple_scene::read_file(&folder.join("scene.toml"), &[]).unwrap_or_else(|errors| panic!("{errors}"));
    let served = served(scene, Duration::from_secs(2), 1).expect("it is served");
    assert!(served.rate > 0.0);
}

/// Pages of other sites do not get a socket, whatever else they say.
#[test]
fn foreign_pages_stay_out() {
    let world = World::open();
    assert!(Page::try_open(&world, Some("http://evil.example"), SUBPROTOCOL).is_err());
    // pages of older programs too, whose frames would be another's
    for other in ["souple.v2", "souple.v999"] {
        let refused = Page::try_open(&world, None, other).err();
        assert!(refused.is_some(), "{other}");
    }
    assert!(Page::try_open(&world, Some(&format!("http://{}", world.host())), SUBPROTOCOL).is_ok());
}

/// All pages see the same scene, and what one of them changes.
#[test]
fn pages_share_a_world() {
    let world = World::open();
    let (mut one, mut two) = (Page::open(&world), Page::open(&world));
    let scene = one.document("scene");
    assert_eq!(scene, two.document("scene"));
    assert_eq!(scene["bodies"][0]["name"], "bar");
    let frame = one.frame();
    assert_eq!(frame.point_counts, [scene["bodies"][0]["surface_points"].as_u64().unwrap() as u32]);
    one.wish(json!({"do": "pause"}));
    assert_eq!(two.document_where("status", |status| status["mode"] == "paused")["mode"], "paused");
    let paused = world.time();
    one.wish(json!({"do": "step"}));
    let stepped = two.frame_where(|frame| frame.time > paused).time;
    assert!((stepped - paused - 0.01).abs() < 1e-9, "{paused} {stepped}");
}

/// Garbage, giant messages and half a handshake end their own connection at most.
#[test]
fn nonsense_ends_only_itself() {
    let world = World::open();
    let mut good = Page::open(&world);
    let mut page = Page::open(&world);
    page.text("{}");
    page.text("[1, 2");
    page.binary(&[7; 1000]);
    page.wish(json!({"do": "grab", "hand": 0, "body": 99, "points": [1], "strength": 1}));
    let refused = page.document_where("refused", |refused| refused["about"] == "grab");
    assert!(refused["message"].as_str().unwrap().contains("no body 99"), "{refused}");
    let mut giant = Page::open(&world);
    giant.text(&"x".repeat(3 << 20));
    assert!(giant.is_closed(), "a message of 3 MiB was taken");
    let mut raw = Page::open(&world);
    raw.raw(&[0xff; 64]);
    assert!(raw.is_closed(), "frames with reserved bits were taken");
    let mut half = TcpStream::connect(world.host()).unwrap();
    half.write_all(b"GET /socket HT").unwrap();
    let mut chatter = Page::open(&world);
    for _ in 0..100 {
        chatter.text("nonsense");
    }
    assert!(chatter.is_closed(), "a hundred messages of nonsense were taken");
    assert_alive(&world);
    good.frame();
}

/// Of two hundred connections the last are told why they are turned away; when they are gone, all is as before.
#[test]
fn a_crowd_is_turned_away() {
    let world = World::open();
    let mut page = Page::open(&world);
    let crowd: Vec<TcpStream> = (0..200).filter_map(|_| TcpStream::connect(world.host()).ok()).collect();
    let mut turned_away = 0;
    for mut stream in crowd {
        stream.set_read_timeout(Some(Duration::from_millis(20))).unwrap();
        let mut text = [0; 64];
        let count = stream.read(&mut text).unwrap_or(0);
        turned_away += usize::from(text[..count].starts_with(b"HTTP/1.1 503"));
    }
    assert!(turned_away >= 100, "{turned_away}");
    page.frame();
    assert_alive(&world);
}

/// A page that reads nothing, and one that never says what it has seen, hold up neither the world nor other pages.
#[test]
fn slow_pages_hold_up_nobody() {
    let world = World::open();
    let (_deaf, mut mute) = (Page::open(&world), Page::open(&world));
    mute.answers = false;
    let mut good = Page::open(&world);
    let first = good.frame().number;
    let time = world.time();
    good.frame_where(|frame| frame.number >= first + 30 && frame.time > time);
    // two frames under way, no third
    let seen = (0..2).map(|_| mute.frame().number).collect::<Vec<_>>();
    assert_eq!(seen.len(), 2);
    assert!(mute.no_frame_for(Duration::from_millis(300)));
    assert_alive(&world);
}

/// A wrong value is refused in words, a right one changes the world.
#[test]
fn values_are_set() {
    let world = World::open();
    let mut page = Page::open(&world);
    let path = "bodies.bar.material.youngs_modulus";
    page.wish(json!({"do": "set", "path": path, "value": "-3"}));
    let refused = page.document_where("refused", |refused| refused["about"] == "set");
    let message = refused["message"].as_str().unwrap();
    assert!(message.contains("-3 is out of range") && message.contains("above 0"), "{message}");
    page.wish(json!({"do": "set", "path": path, "value": "40 kPa"}));
    let value = |document: &serde_json::Value| {
        let all = document["adjustables"].as_array().unwrap().clone();
        all.into_iter().find(|adjustable| adjustable["path"] == path).unwrap()["value"].clone()
    };
    page.document_where("adjustables", |document| value(document) == "40000");
    // what would make another scene of what pages were told of
    for path in ["world.period", "probes.tip.component"] {
        page.wish(json!({"do": "set", "path": path, "value": "20 ms"}));
        let refused = page.document_where("refused", |refused| refused["about"] == "set");
        assert!(refused["message"].as_str().unwrap().contains(path), "{refused}");
    }
    // of values of one path the last counts
    page.wish(json!({"do": "set", "path": path, "value": "50 kPa"}));
    let set = page.document_where("adjustables", |document| value(document) == "50000");
    assert_eq!(set["settings"], json!([format!("{path}=50 kPa")]));
    assert_alive(&world);
}

/// A world that was turned over is seen as before when it begins anew; one that is loaded plays, though the one before did not.
#[test]
fn worlds_begin_as_they_should() {
    let world = World::open();
    let mut page = Page::open(&world);
    let scene = page.document("scene");
    page.wish(json!({"do": "set", "path": "world.gravity", "value": "[0, 9.81, 0]"}));
    page.document_where("adjustables", |document| document["settings"] != json!([]));
    page.wish(json!({"do": "pause"}));
    page.document_where("status", |status| status["mode"] == "paused");
    page.wish(json!({"do": "reset"}));
    let anew = page.document_where("scene", |anew| anew["scene"] != scene["scene"]);
    for way in ["up", "direction"] {
        assert_eq!(anew[way], scene[way], "{way}");
    }
    let quiet = page.document_where("status", |status| status["busy"].is_null());
    assert_eq!(quiet["mode"], "paused");
    let text = "format = 1\n[world]\nperiod = \"10 ms\"\n[skins.ball]\nvoxel = 0.1\n\
                terms = [{ term = \"tension\", strength = 0.01 }]\n\
                [[skins.ball.start]]\npart = \"point\"\nat = [0, 0, 0]\nradius = 0.5\n";
    page.wish(json!({"do": "load_text", "name": "ball.toml", "text": text}));
    page.document_where("scene", |loaded| loaded["scene"] != anew["scene"]);
    page.document_where("status", |status| status["mode"] == "playing");
}

/// A world in a step that lasts for minutes is left for another at once, begun anew, and paused.
#[test]
fn long_steps_are_broken_off() {
    let world = World::open_with(&[
        "bodies.bar.mesh.cells=[20, 8, 8]",
        "systems.main.stepper=symplectic_euler",
        "systems.main.steps_per_period=1000000",
    ]);
    let mut page = Page::open(&world);
    let scene = page.document("scene");
    page.wish(json!({"do": "pause"}));
    page.document_where("status", |status| status["mode"] == "paused");
    page.wish(json!({"do": "play"}));
    page.document_where("status", |status| status["mode"] == "playing");
    page.wish(json!({"do": "reset"}));
    let anew = page.document_where("scene", |anew| anew["scene"] != scene["scene"]);
    let text = SCENE.replace("\"A bar\"", "\"Another bar\"");
    page.wish(json!({"do": "load_text", "name": "bar.toml", "text": text}));
    page.document_where("scene", |loaded| loaded["scene"] != anew["scene"]);
    page.frame_where(|frame| frame.time > 0.05);
}

/// What was done by hand, values set among it, is repeated bit for bit from the recording.
#[test]
fn a_live_session_is_replayed() {
    let world = World::open();
    let mut page = Page::open(&world);
    page.document("scene");
    page.wish(json!({"do": "grab", "hand": 0, "body": 0, "points": [0, 1, 2, 3], "strength": 2}));
    let held = page.frame_where(|frame| frame.hands == 1);
    page.wish(json!({"do": "move", "hand": 0, "offset": [0.0, 0.1, 0.05]}));
    page.frame_where(|frame| frame.time > held.time + 0.2);
    page.wish(json!({"do": "set", "path": "bodies.bar.material.youngs_modulus", "value": "60 kPa"}));
    page.document("adjustables");
    let set =
        page.document_where("adjustables", |document| !document["settings"].as_array().unwrap().is_empty());
    assert_eq!(set["settings"][0], "bodies.bar.material.youngs_modulus=60 kPa");
    page.wish(json!({"do": "pin", "body": 0, "points": [5, 6]}));
    page.wish(json!({"do": "throw", "body": 0, "velocity": [0, 1, 0]}));
    page.document("pins");
    let now = page.frame().time;
    page.wish(json!({"do": "release", "hand": 0}));
    page.frame_where(|frame| frame.hands == 0 && frame.time > now + 0.2);
    page.wish(json!({"do": "pause"}));
    page.document_where("status", |status| status["mode"] == "paused");

    let recording = world.assert_replayed();
    assert!(recording.commands.len() >= 5, "{:?}", recording.commands);
    assert_eq!(recording.changes.len(), 1);
}

/// What was done while the world stood still is in the recording as well: before its first step, and after its last.
#[test]
fn edits_of_a_paused_world_are_replayed() {
    let world = World::open();
    let mut page = Page::open(&world);
    page.frame_where(|frame| frame.time > 0.0);
    page.wish(json!({"do": "pause"}));
    page.document_where("status", |status| status["mode"] == "paused");
    page.wish(json!({"do": "throw", "body": 0, "velocity": [0, 2, 0]}));
    page.wish(json!({"do": "pin", "body": 0, "points": [7]}));
    page.document("pins");
    page.wish(json!({"do": "set", "path": "bodies.bar.material.youngs_modulus", "value": "60 kPa"}));
    page.document_where("adjustables", |document| !document["settings"].as_array().unwrap().is_empty());
    assert_eq!(world.assert_replayed().commands.len(), 2);
    page.wish(json!({"do": "reset"}));
    page.frame_where(|frame| frame.time == 0.0);
    page.wish(json!({"do": "throw", "body": 0, "velocity": [0, 0, 1]}));
    page.wish(json!({"do": "step"}));
    page.frame_where(|frame| frame.time > 0.0);
    world.assert_replayed();
}

/// While pictures are made for another page, no picture and no samples reach one that comes before it was described the world.
#[test]
fn pages_are_described_the_world_before_it_is_shown() {
    let world = World::open();
    let mut watching = Page::open(&world);
    for _ in 0..30 {
        watching.frame();
        assert!(!Page::open(&world).is_shown_before_described());
    }
}

/// Whoever comes to a world that is busy is greeted before it is shown anything.
#[test]
fn pages_are_greeted_first() {
    let world = World::open();
    let mut first = Page::open(&world);
    first.frame();
    for _ in 0..10 {
        assert_eq!(Page::open(&world).first_message(), "hello");
    }
}

/// A client that wishes without a pause ends no other page's connection.
#[test]
fn floods_of_wishes_end_nobody() {
    let world = World::open();
    let (mut good, mut loud) = (Page::open(&world), Page::open(&world));
    for _ in 0..5000 {
        loud.wish(json!({"do": "speed", "factor": 1}));
    }
    let time = good.frame().time;
    good.frame_where(|frame| frame.time > time + 0.1);
}

/// A page that is gone lets go of what it held.
#[test]
fn hands_of_lost_pages_let_go() {
    let world = World::open();
    let mut page = Page::open(&world);
    let mut other = Page::open(&world);
    page.wish(json!({"do": "grab", "hand": 3, "body": 0, "points": [0, 1], "strength": 1}));
    other.frame_where(|frame| frame.hands == 1);
    drop(page);
    other.frame_where(|frame| frame.hands == 0);
}

/// A world that cannot be stepped says so and stops; a reset begins it anew.
#[test]
fn a_world_that_fails_is_reported() {
    let world = World::open_with(&[
        "systems.main.stepper=\"symplectic_euler\"",
        "bodies.bar.material.youngs_modulus=1e12",
    ]);
    let mut page = Page::open(&world);
    let failed = page.document_where("status", |status| status["mode"] == "failed");
    assert!(failed["message"].as_str().unwrap().contains("`bar`"), "{failed}");
    page.wish(json!({"do": "play"}));
    let refused = page.document_where("refused", |refused| refused["about"] == "play");
    assert!(refused["message"].as_str().unwrap().contains("reset"), "{refused}");
    page.wish(json!({"do": "reset"}));
    page.document_where("status", |status| status["mode"] == "playing");
}

/// A mesh that is sent becomes a scene of a soft body; what is no mesh is refused in words, and pages of other sites
/// send none.
#[test]
fn meshes_are_taken() {
    let world = World::open();
    let mut page = Page::open(&world);
    page.document("scene");
    let own = format!("Host: {0}\r\nOrigin: http://{0}\r\n", world.host());
    let post = |site: &str, name: &str, body: &str| {
        let length = body.len();
        world.ask(&format!("POST /mesh?name={name} HTTP/1.1\r\n{site}Content-Length: {length}\r\n\r\n{body}"))
    };
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
                f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    let foreign = format!("Host: {}\r\nOrigin: http://evil.example\r\n", world.host());
    assert_eq!(post(&foreign, "cube.obj", cube).status, 403);
    // it is called as whoever sent it calls it, not by where it is kept
    let refused = post(&own, "W%C3%BCrfel+1.obj", "v 0 0 zero\n");
    assert_eq!(refused.status, 400);
    assert!(refused.body.starts_with("Würfel 1.obj"), "{}", refused.body);
    assert_eq!(world.ask(&format!("POST /mesh?name=a.obj HTTP/1.1\r\n{own}\r\n")).status, 411);
    let giant = format!("POST /mesh?name=a.obj HTTP/1.1\r\n{own}Content-Length: 99999999999\r\n\r\n");
    assert_eq!(world.ask(&giant).status, 413);
    assert_eq!(post(&own, "cube.obj", cube).status, 200);
    let scene = page.document_where("scene", |scene| scene["title"] == "cube.obj");
    assert!(scene["bodies"][0]["cells"].as_u64() > Some(100), "{scene}");
    // it is no file that a command could name; and files that are refused after it do not take its mesh away
    assert_eq!((&scene["is_file"], &scene["short_name"]), (&json!(false), &json!("cube")));
    for _ in 0..6 {
        assert_eq!(post(&own, "none.obj", "v 0 0 zero\n").status, 400);
    }
    page.wish(json!({"do": "reset"}));
    let again = page.document_where("scene", |again| again["scene"] != scene["scene"]);
    assert_eq!(again["is_file"], false);
    assert_alive(&world);
}

/// A bar of two meshes that is fine wherever it bends.
const FINE_BAR: &str = r#"
    format = 1
    title = "A bar of two meshes"
    [world]
    period = "1 ms"
    gravity = [0, -9.81, 0]
    [systems.main]
    stepper = { name = "staggered", halvings = 3 }
    [bodies.bar]
    mesh = { generate = "bar", size = [0.4, 0.1, 0.1], cells = [8, 2, 2], element = "tet4" }
    material = { name = "stable_neo_hookean", youngs_modulus = "50 kPa", poissons_ratio = 0.3, density = 1000 }
    damping = { rayleigh_mass = 20 }
    [bodies.bar.levels]
    coarser = [{ mesh = { generate = "bar", size = [0.4, 0.1, 0.1], cells = [4, 1, 1], element = "tet4" } }]
    refine = 1e-6
    coarsen = 1e-7
    budget = 20000
    [[bodies.bar.pins]]
    region = "x_min"
    [probes.fine]
    body = "bar"
    quantity = "levels.active"
    level = 1
"#;

/// A world that cannot keep up may do less where its bodies have a budget: nobody steps it in ten microseconds. What the clock decides is in the
/// recording, which repeats it bit for bit.
#[test]
fn a_late_world_does_less() {
    let world = World::of(FINE_BAR);
    let mut page = Page::open(&world);
    page.frame_where(|frame| frame.time > 0.0);
    page.wish(json!({"do": "speed", "factor": 100}));
    let now = page.frame().time;
    page.frame_where(|frame| frame.time > now + 0.1);
    page.wish(json!({"do": "pause"}));
    page.document_where("status", |status| status["mode"] == "paused");
    let recording = world.assert_replayed();
    let budgets = recording.commands.iter().filter(|command| format!("{command:?}").contains("budget"));
    // ten periods of a thousandth that are late take a tenth each
    assert!(budgets.count() >= 10, "{}", recording.commands.len());
}

/// A page that looks on for long costs no more memory than one that has just come.
#[test]
fn memory_stays_flat() {
    // time flies: each period of 10 ms is due in a tenth of a millisecond
    let world = World::open();
    let mut page = Page::open(&world);
    page.wish(json!({"do": "speed", "factor": 100}));
    let bytes = |page: &mut Page, frames: u32| {
        let last = page.frame().number + frames;
        page.frame_where(|frame| frame.number >= last);
        resident_bytes()
    };
    // samples fill up, buffers find their size
    let time = world.time() + 20.0;
    page.frame_where(|frame| frame.time > time);
    let before = bytes(&mut page, 100);
    let after = bytes(&mut page, 1000);
    // what an allocator may keep of other tests' threads; a frame that was kept would be 2 MB in a thousand
    assert!(after < before + (16 << 20), "{before} bytes before, {after} after");
}

/// Of this process [bytes]; 0 where the system does not tell.
fn resident_bytes() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok()).unwrap_or(0) * 1024
}
