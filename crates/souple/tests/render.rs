//! `souple render`: every kind of file, from scenes and from runs, and requests that cannot be met.

use std::path::Path;

use crate::common::{self, Answer, CUBE, Folder, assert_errors, souple_in};

fn render(folder: &Folder, source: &str, out: &str, more: &[&str]) -> Answer {
    // surfaces have no pixels
    let small: &[&str] = match () {
        () if out.ends_with(".glb") => &[],
        () if more.contains(&"--size") => &["--samples", "1"],
        () => &["--size", "240,160", "--samples", "1"],
    };
    let call = ["render", source, "--out", out, "--json"];
    souple_in(folder.path(), call.iter().chain(small).chain(more))
}

/// Width and height of a PNG.
fn size_of(folder: &Folder, file: &str) -> [u32; 2] {
    let bytes = std::fs::read(folder.path().join(file)).expect("a picture");
    assert_eq!(&bytes[1..4], b"PNG");
    [16, 20].map(|at| u32::from_be_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]))
}

/// The cube with everything around it that a body may touch: each shape, and a container.
fn with_shapes() -> String {
    let mut scene = CUBE.to_owned();
    for (index, shape) in [
        "name = \"plane\", point = [0, -1, 0]",
        "name = \"plane\", point = [-3, 0, 0], normal = [1, 0, 0]",
        "name = \"sphere\", radius = 0.3, centre = [2, 0, 0]",
        "name = \"capsule\", radius = 0.2, from = [0, 0, 2], to = [1, 0, 2]",
        "name = \"box\", size = [0.5, 0.5, 0.5], centre = [0, 0, -2]",
        "name = \"box\", size = [9, 9, 9], hollow = true",
    ]
    .iter()
    .enumerate()
    {
        scene += &format!(
            "[shapes.s{index}]\nshape = {{ {shape} }}\n[[contacts]]\nbody = \"cube\"\nshape = \"s{index}\"\n"
        );
    }
    scene
}

/// The same pixels from the scene as from the folder of its run; each option changes the picture.
#[test]
fn pictures_of_scenes_and_runs() {
    let folder = Folder::new("render");
    folder.write("scene.toml", with_shapes());
    souple_in(folder.path(), ["run", "scene.toml", "--out", "run", "--quiet"]).ends(0);
    render(&folder, "scene.toml", "scene.png", &[]).ends(0);
    let answer = render(&folder, "run", "run.png", &[]).ends(0).json();
    assert_eq!((&answer["moments"], &answer["notes"]), (&1.into(), &serde_json::json!([])));
    let read = |file: &str| std::fs::read(folder.path().join(file)).expect("a picture");
    assert_eq!(read("scene.png"), read("run.png"));
    assert_eq!(size_of(&folder, "run.png"), [240, 160]);
    let mut seen = vec![read("run.png")];
    for (index, more) in [
        &["--time", "0"][..],
        &["--colour", "displacement.y", "--map", "diverging"],
        &["--colour", "none"],
        &["--colour-scale", "log"],
        &["--colour", "velocity", "--map", "grey", "--range", "0,2"],
        &["--cut", "0,0,1,0.4"],
        &["--explode", "0.5"],
        &["--arrows", "velocity"],
        &["--arrows", "velocity", "--arrow-scale", "0.1"],
        &["--edges", "wireframe"],
        &["--edges", "hidden"],
        &["--direction", "1,-1,0"],
        &["--direction", "-1,-1,0"],
        &["--position", "3,3,3", "--look-at", "0,0,0"],
        &["--up", "0,0,1"],
        &["--field-of-view", "60"],
        &["--dark"],
        &["--compact"],
        &["--title", "Längs der Achse: σ ≈ 10⁻³, a title that is much longer than the picture is wide"],
    ]
    .iter()
    .enumerate()
    {
        let file = format!("option{index}.png");
        render(&folder, "run", &file, more).ends(0);
        let picture = read(&file);
        assert!(!seen.contains(&picture), "{more:?} changes nothing");
        seen.push(picture);
    }
}

#[test]
fn sheets_films_and_surfaces() {
    let folder = Folder::new("films");
    folder.write("scene.toml", CUBE);
    souple_in(folder.path(), ["run", "scene.toml", "--out", "run", "--quiet"]).ends(0);
    let answer = render(&folder, "run", "sheet.png", &["--sheet", "4", "--size", "321,222"]).ends(0).json();
    assert_eq!(answer["moments"], 4);
    // two by two, under one title, beside one legend: as large as asked for
    assert_eq!(size_of(&folder, "sheet.png"), [321, 222]);
    let bare =
        render(&folder, "run", "bare.png", &["--sheet", "4", "--title", "", "--colour", "none"]).ends(0);
    assert_eq!((bare.json()["moments"].as_u64(), size_of(&folder, "bare.png")), (Some(4), [240, 160]));
    let beyond = render(&folder, "run", "late.png", &["--time", "77"]).ends(0);
    assert!(beyond.stderr.contains("there is nothing at 77 s: the last frame, of 0.1"), "{beyond:#?}");
    for (file, start) in [("a.gif", &b"GIF89a"[..]), ("a.apng", b"\x89PNG"), ("a.glb", b"glTF")] {
        let answer = render(&folder, "run", file, &["--frames", "3"]).ends(0).json();
        assert_eq!(answer["moments"], 3, "{file}");
        assert!(std::fs::read(folder.path().join(file)).expect("a file").starts_with(start), "{file}");
    }
    // the machine may have no ffmpeg: then that is said, and what is made without it
    let film = render(&folder, "run", "a.mp4", &[]);
    match film.status {
        Some(0) => assert!(folder.path().join("a.mp4").is_file()),
        _ => assert!(film.status == Some(1) && film.stderr.contains("ffmpeg"), "{film:#?}"),
    }
    assert!(folder.files().iter().all(|file| !file.contains(".part")));
}

/// A film of surfaces shows a skin, whose triangles change, moment after moment; a mesh is drawn from its file.
#[test]
fn skins_and_meshes() {
    let folder = Folder::new("skins");
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let scene = scenes.join("skin_metamorphosis").display().to_string();
    render(&folder, &scene, "skin.glb", &["--frames", "3", "--quiet"]).ends(0);
    let bytes = std::fs::read(folder.path().join("skin.glb")).expect("a file");
    let length = u32::from_le_bytes([bytes[12], bytes[13], bytes[14], bytes[15]]) as usize;
    let document: serde_json::Value = serde_json::from_slice(&bytes[20..20 + length]).expect("a document");
    let meshes = document["meshes"].as_array().expect("meshes").len();
    let turns = document["animations"][0]["channels"].as_array().expect("channels");
    assert!(meshes >= 3 && turns.iter().all(|channel| channel["target"]["path"] == "scale"), "{document:#}");

    let make = ["mesh", "generate", "box", "box.msh", "size=1,1,1", "cells=2,2,2", "element=hex8"];
    souple_in(folder.path(), make).ends(0);
    let answer = render(&folder, "box.msh", "box.png", &["--white", "--no-time"]).ends(0).json();
    assert_eq!(answer["moments"], 1);
    // which has no time
    render(&folder, "box.msh", "same.png", &["--white"]).ends(0);
    let [timeless, same] =
        ["box.png", "same.png"].map(|file| std::fs::read(folder.path().join(file)).expect("a picture"));
    assert!(timeless == same);
    assert_eq!(size_of(&folder, "box.png"), [240, 160]);
}

/// Runs that went astray are drawn as they were when they could be.
#[test]
fn blown_up_runs_are_drawn_as_they_were() {
    let folder = Folder::new("blown");
    // fifty times the longest stable step: grows without bound
    let text = CUBE.replace("[bodies.cube]", "[systems.main]\nstepper = \"symplectic_euler\"\n[bodies.cube]");
    let text = text.replace("20 kPa", "20 GPa").replace("\"100 ms\"", "\"10 s\"");
    let text = text.replace("material =", "angular_velocity = [0, 3, 1]\nmaterial =");
    folder.write("fast.toml", text);
    let run = ["run", "fast.toml", "--json", "--quiet", "--frames", "1000", "--out", "run"];
    let report = souple_in(folder.path(), run).ends(1).json();
    assert!(folder.path().join("run/last.png").is_file());
    let last = report["simulated_seconds"].as_f64().expect("a time");
    let drawn = render(&folder, "run", "a.png", &[]).ends(0);
    assert!(drawn.stderr.contains("the bodies have run away"), "{last} s: {drawn:#?}");
    assert!(report["warnings"].to_string().contains("the bodies have run away"), "{report:#}");
    // of two pictures, one with the body and one of nothing but its background, this is the first
    let empty = render(&folder, "run", "b.png", &["--position", "0,0,900", "--look-at", "0,0,901"]).ends(0);
    assert_eq!(empty.status, Some(0));
    let read = |file: &str| std::fs::read(folder.path().join(file)).expect("a picture");
    assert_ne!(read("a.png"), read("b.png"));
}

/// A run of a body that frames carry keeps them: pictures of its files are those of the run.
#[test]
fn frames_that_carry_a_body_are_drawn_from_files() {
    let folder = Folder::new("carriers");
    let frames = "[bodies.cube.frames]\nplacement = { name = \"grid\", counts = [2, 2, 2] }\n[bodies.cube]";
    folder.write("scene.toml", CUBE.replace("[bodies.cube]", frames));
    souple_in(folder.path(), ["run", "scene.toml", "--out", "run", "--quiet", "--frames", "2"]).ends(0);
    render(&folder, "run", "files.png", &[]).ends(0);
    let read = |file: &str| std::fs::read(folder.path().join(file)).expect("a picture");
    let with = read("files.png");
    for file in std::fs::read_dir(folder.path().join("run/frames")).expect("frames") {
        let path = file.expect("an entry").path();
        if path.to_string_lossy().contains("cube.frames") {
            std::fs::remove_file(path).expect("a series of frames");
        }
    }
    render(&folder, "run", "without.png", &[]).ends(0);
    assert_ne!(with, read("without.png"));
    // as a picture that leaves them out
    folder.write("again.toml", CUBE.replace("[bodies.cube]", frames));
    souple_in(folder.path(), ["run", "again.toml", "--out", "again", "--quiet", "--frames", "2"]).ends(0);
    render(&folder, "again", "hidden.png", &["--frame-axes", "hidden"]).ends(0);
    assert_eq!(read("hidden.png"), read("without.png"));
    render(&folder, "again", "numbered.png", &["--frame-axes", "numbered"]).ends(0);
    assert_ne!(read("numbered.png"), with);
    let refused = render(&folder, "again", "other.png", &["--frame-axes", "dotted"]).ends(2);
    assert!(refused.stdout.contains("drawn, numbered or hidden"), "{refused:#?}");
}

/// Frames that are not shown are not read: a run of which most are gone is drawn where it is whole.
#[test]
fn frames_that_are_not_shown_are_not_read() {
    let folder = Folder::new("frames_shown");
    folder.write("scene.toml", CUBE);
    souple_in(folder.path(), ["run", "scene.toml", "--out", "run", "--quiet", "--frames", "10"]).ends(0);
    let frames = folder.path().join("run/frames");
    let mut files: Vec<_> = std::fs::read_dir(&frames)
        .expect("frames")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "vtu"))
        .collect();
    files.sort();
    assert!(files.len() > 4, "{files:?}");
    files[1..files.len() - 1].iter().for_each(|file| std::fs::write(file, "gone").expect("a file"));
    for (file, more) in [
        ("first.png", &["--time", "0"][..]),
        ("last.png", &[]),
        ("sheet.png", &["--sheet", "2"]),
        ("film.gif", &["--frames", "2"]),
    ] {
        render(&folder, "run", file, more).ends(0);
    }
    assert!(render(&folder, "run", "whole.gif", &[]).ends(2).stderr.contains(".vtu"));
    assert!(!folder.path().join("whole.gif").exists());
}

/// On a scale of powers of ten what is below zero is grey, and that is said of every kind of file; where nothing is above zero the
/// scale is refused.
#[test]
fn colours_by_powers_of_ten() {
    let folder = Folder::new("powers");
    // the upper half turns up, the lower one down
    let stretched = CUBE.replace("gravity = [0, -9.81, 0]", "gravity = [0, 0, 0]").replace(
        "[probes.place]",
        "[[bodies.cube.loads]]\nregion = \"y_max\"\nforce = [0, \"1 N\", 0]\n\
         [[bodies.cube.loads]]\nregion = \"y_min\"\nforce = [0, \"-1 N\", 0]\n[probes.place]",
    );
    folder.write("scene.toml", stretched);
    souple_in(folder.path(), ["run", "scene.toml", "--out", "run", "--quiet"]).ends(0);
    let notes = |file: &str, field: &str| {
        let options = ["--colour-scale", "log", "--colour", field];
        render(&folder, "run", file, &options).ends(0).json()["notes"].to_string()
    };
    // of three rows of nine points the lowest goes down, and that in the middle by what rounding leaves; at the first of six moments
    // nothing has moved
    for (file, moments) in [("a.png", 1), ("a.glb", 5), ("a.gif", 5)] {
        let told = notes(file, "displacement.y");
        let (count, _) = told.split_once(" values are below 0").unwrap_or_else(|| panic!("{file}: {told}"));
        let count =
            count.trim_start_matches(['[', '"']).split(' ').next().and_then(|count| count.parse().ok());
        assert!(
            count.is_some_and(|count: usize| (9 * moments..=18 * moments).contains(&count)),
            "{file}: {told}"
        );
    }
    assert!(!notes("a.png", "displacement").contains("below 0"));
    let at_rest = ["--colour-scale", "log", "--time", "0", "--colour", "displacement"];
    let refused = render(&folder, "run", "b.png", &at_rest).ends(2).stderr;
    assert!(refused.contains("no value is above 0; expected linear"), "{refused}");
    assert!(!folder.path().join("b.png").exists());
}

/// What is asked for and changes nothing, or is less than asked for, is told; ends of a range may have units.
#[test]
fn what_has_no_effect_is_told() {
    let folder = Folder::new("no_effect");
    folder.write("scene.toml", CUBE);
    souple_in(folder.path(), ["run", "scene.toml", "--out", "run", "--quiet"]).ends(0);
    let notes = |more: &[&str]| render(&folder, "run", "a.png", more).ends(0).json()["notes"].to_string();
    assert!(notes(&["--cut", "1,0,0,99"]).contains("the cut takes nothing away"));
    assert!(!notes(&["--cut", "0,0,1,0.4"]).contains("nothing"));
    assert!(notes(&["--sheet", "99", "--size", "900x700"]).contains("moments, not 99: each is shown once"));
    assert!(
        notes(&["--colour", "velocity", "--range", "1 km/s,2 km/s"])
            .contains("below the range 1000 to 2000 m/s")
    );
    assert!(notes(&["--size", "48,32"]).contains("the picture has no room for: "));
    folder.write("shapes.toml", with_shapes());
    let on_ground = render(&folder, "shapes.toml", "b.png", &["--floor"]).ends(0).json()["notes"].to_string();
    assert!(on_ground.contains("the scene has a ground of its own"), "{on_ground}");
    let generate = ["mesh", "generate", "box", "box.msh", "size=1,1,1", "cells=2,2,2", "element=hex8"];
    souple_in(folder.path(), generate).ends(0);
    let bare = render(&folder, "box.msh", "b.png", &["--range", "0,1"]).ends(0).json()["notes"].to_string();
    assert!(bare.contains("no body has stress") && bare.contains("--range changes nothing"), "{bare}");
    let read = || std::fs::read(folder.path().join("a.png")).expect("a picture");
    let pictures = [
        &["--range", "0,2000"][..],
        &["--range", "0,2kPa"],
        &["--explode", "0.5"],
        &["--explode", "0.5", "--floor"],
    ]
    .map(|more| {
        render(&folder, "run", "a.png", more).ends(0);
        read()
    });
    assert!(pictures[0] == pictures[1] && pictures[2] != pictures[3]);
}

/// A frame of a run is drawn with its fields, from its own file and from the list of frames.
#[test]
fn files_of_frames_have_fields() {
    let folder = Folder::new("frame_files");
    folder.write("scene.toml", CUBE);
    souple_in(folder.path(), ["run", "scene.toml", "--out", "run", "--quiet"]).ends(0);
    let frames = folder.files().into_iter().filter(|file| file.ends_with(".vtu"));
    let last = frames.max().expect("a frame");
    for source in [last.as_str(), "run/frames/cube.pvd"] {
        for more in
            [&["--colour", "von_mises"][..], &["--arrows", "displacement"], &["--colour", "velocity.y"]]
        {
            let notes = render(&folder, source, "a.png", more).ends(0).json()["notes"].clone();
            assert_eq!(notes, serde_json::json!([]), "{source} {more:?}");
        }
    }
    assert_eq!(
        render(&folder, "run/frames/cube.pvd", "a.gif", &["--frames", "3"]).ends(0).json()["moments"],
        3
    );
    souple_in(
        folder.path(),
        ["mesh", "generate", "box", "box.msh", "size=1,1,1", "cells=2,2,2", "element=hex8"],
    )
    .ends(0);
    let bare = render(&folder, "box.msh", "b.png", &["--colour", "velocity"]).ends(2).stderr;
    assert!(bare.contains("element or none: no body has fields"), "{bare}");
}

/// A list of several parts shows all of them, one beside the other, in the order of time.
#[test]
fn lists_of_parts_show_all_bodies() {
    use souple::run::show::Reel;

    let folder = Folder::new("parts");
    folder.write("scene.toml", CUBE);
    souple_in(folder.path(), ["run", "scene.toml", "--out", "run", "--frames", "2", "--quiet"]).ends(0);
    let entry = |time: u32, part: u32, frame: u32| {
        format!("<DataSet timestep=\"{time}\" part=\"{part}\" file=\"run/frames/cube_000{frame}.vtu\"/>")
    };
    let list =
        |entries: &[String]| format!("<VTKFile><Collection>{}</Collection></VTKFile>", entries.concat());
    folder.write("two.pvd", list(&[entry(1, 0, 1), entry(1, 1, 2), entry(0, 0, 0), entry(0, 1, 0)]));
    let reel = Reel::of_series(&folder.path().join("two.pvd")).expect("a series");
    assert_eq!(reel.times(), [0.0, 1.0]);
    let last = reel.moment(1, None).expect("frames");
    let names: Vec<&str> = last.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["two 0", "two 1"]);
    assert_ne!(last.bodies[0].positions, last.bodies[1].positions);
    render(&folder, "two.pvd", "a.png", &[]).ends(0);
    folder.write("uneven.pvd", list(&[entry(0, 0, 0), entry(1, 1, 1)]));
    let refused = render(&folder, "uneven.pvd", "b.png", &[]).ends(2).stderr;
    assert!(refused.contains("the times of `uneven 1` are not those of the body before it"), "{refused}");
}

/// Arrows begin at the surface that a cut leaves, its section with it, and nowhere in what it takes away.
#[test]
fn arrows_are_cut_with_their_bodies() {
    use souple::io::picture::{Cut, Stroke, StrokeShape};
    use souple::math::Vec3;
    use souple::run::show::{Arrows, Figure, Show, Stage};

    let folder = Folder::new("cut_arrows");
    folder.write("scene.toml", CUBE);
    souple_in(folder.path(), ["run", "scene.toml", "--out", "run", "--quiet"]).ends(0);
    let mut show = Show::of_run(&folder.path().join("run"), Stage::default()).expect("frames");
    show.moments.drain(..show.moments.len() - 1);
    let middle = show.bounds().centre();
    let feet = |cut: Option<Cut>| -> Vec<Vec3> {
        let arrows = Some(Arrows { field: "displacement".to_owned(), scale: None });
        let (pictures, _) = Figure { arrows, cut, ..Figure::default() }.pictures(&show).expect("pictures");
        let foot = |stroke: Stroke| match stroke.shape {
            StrokeShape::Arrow(from, _) => Some(from),
            _ => None,
        };
        pictures.into_iter().flat_map(|picture| picture.strokes).filter_map(foot).collect()
    };
    let (all, left) = (feet(None), feet(Some(Cut { point: middle, normal: Vec3::X })));
    // places on a section are between two points, each rounded
    let rounding = 8.0 * f64::EPSILON * show.bounds().diagonal();
    let is_left = |foot: &&Vec3| foot.x <= middle.x + rounding;
    assert!(all.iter().filter(is_left).count() < all.len());
    assert!(!left.is_empty() && left.iter().all(|foot| is_left(&foot)), "{left:?}");
    assert!(left.iter().any(|foot| (foot.x - middle.x).abs() < rounding), "{left:?}");
}

/// A skin has one colour, with arrows or without: what differs are the arrows.
#[test]
fn skins_keep_their_colour() {
    use souple::io::picture::Surface;
    use souple::run::show::{Arrows, Figure, Show, Stage, Worn};

    let folder = Folder::new("skin_colour");
    let scene = common::scenes().join("skin_thread");
    let run = [
        "run",
        scene.to_str().expect("a path"),
        "--quiet",
        "--expect",
        "warn",
        "--steps",
        "2",
        "--out",
        "run",
    ];
    souple_in(folder.path(), run).ends(0);
    let show = Show::of_run(&folder.path().join("run"), Stage::default()).expect("frames");
    let seen = |figure: Figure, moment: usize| -> Vec<Surface> {
        let moment = show.moments[moment].clone();
        let moment = if figure.arrows.is_none() { moment.without_worn() } else { moment };
        let show = Show { stage: Stage::default(), moments: vec![moment] };
        let (pictures, _) = figure.pictures(&show).expect("pictures");
        pictures.into_iter().flat_map(|picture| picture.surfaces).collect()
    };
    let last = show.moments.len() - 1;
    let arrows = Some(Arrows { field: "velocity".to_owned(), scale: None });
    let bare = Figure { colour_by: None, worn: Worn::Arrows, ..Figure::default() };
    assert_eq!(seen(bare.clone(), last), seen(Figure { arrows, ..bare }, last));
}

/// Bodies of every dimension have values to be coloured by, from the frames of their run as from the run itself.
#[test]
fn sheets_and_cables_are_coloured() {
    use souple::io::picture::Paint;
    use souple::run::show::{Figure, Show, Stage};

    let folder = Folder::new("coloured");
    for name in ["plate", "blown_strip", "hanging_cable"] {
        let scene = common::scenes().join(name);
        let scene = scene.to_str().expect("a path");
        let run = ["run", scene, "--quiet", "--expect", "warn", "--steps", "2", "--out", name];
        souple_in(folder.path(), run).ends(0);
        let show = Show::of_run(&folder.path().join(name), Stage::default()).expect("frames");
        let (pictures, _) = Figure::default().pictures(&show).expect("pictures");
        let last = pictures.last().expect("a picture");
        for surface in &last.surfaces {
            let Paint::PointScalar(values) = &surface.paint else { panic!("{name} is not coloured") };
            assert!(!values.is_empty() && values.iter().all(|value| value.is_finite()), "{name}: {values:?}");
        }
        assert!(!last.surfaces.is_empty(), "{name}");
    }
}

/// A cable is drawn, and coloured by its tension.
#[test]
fn cables_are_drawn() {
    let folder = Folder::new("cables");
    let scene = common::scenes().join("hanging_cable");
    let scene = scene.to_str().expect("a path");
    let run = ["run", scene, "--quiet", "--expect", "warn", "--steps", "5", "--out", "run"];
    souple_in(folder.path(), run).ends(0);
    let read = |file: &str| std::fs::read(folder.path().join(file)).expect("a picture");
    for (file, more) in [
        ("by_stress.png", &[][..]),
        ("plain.png", &["--colour", "none"]),
        ("nothing.png", &["--cut", "0,1,0,-9"]),
        ("half.png", &["--cut", "1,0,0,0.5"]),
    ] {
        render(&folder, "run", file, more).ends(0);
    }
    let files = ["by_stress.png", "plain.png", "nothing.png", "half.png"];
    for (index, a) in files.iter().enumerate() {
        for b in &files[index + 1..] {
            assert!(read(a) != read(b), "{a} and {b}");
        }
    }
    assert!(render(&folder, "run", "a.glb", &["--frames", "2"]).ends(0).json()["moments"] == 2);
}

/// A run whose scene has been moved is drawn without its shapes, and that is said.
#[test]
fn a_run_without_its_scene() {
    let folder = Folder::new("orphan");
    folder.write("scene.toml", with_shapes());
    souple_in(folder.path(), ["run", "scene.toml", "--out", "run", "--quiet"]).ends(0);
    folder.write("scene.toml", CUBE);
    let answer = render(&folder, "run", "a.png", &[]).ends(0).json();
    assert!(answer["notes"].to_string().contains("not as it was run"), "{answer:#}");
    std::fs::remove_file(folder.path().join("scene.toml")).expect("the scene");
    let answer = render(&folder, "run", "a.png", &[]).ends(0).json();
    assert!(answer["notes"].to_string().contains("cannot be read"), "{answer:#}");
}

/// A run is drawn with its shapes from anywhere, also from beside another scene of the same name.
#[test]
fn a_run_is_drawn_from_elsewhere() {
    let folder = Folder::new("elsewhere");
    for name in ["a", "b"] {
        std::fs::create_dir(folder.path().join(name)).expect("a folder");
    }
    folder.write("a/scene.toml", with_shapes());
    folder.write("b/scene.toml", CUBE);
    let [here, there] = ["a", "b"].map(|name| folder.path().join(name));
    souple_in(&here, ["run", "scene.toml", "--out", "run", "--quiet"]).ends(0);
    let small = ["--size", "240,160", "--samples", "1", "--json"];
    let from = |place: &Path, run: &str| {
        let call = ["render", run, "--out", "picture.png"];
        let answer = souple_in(place, call.iter().chain(&small)).ends(0).json();
        assert_eq!(answer["notes"], serde_json::json!([]), "{answer:#}");
        std::fs::read(place.join("picture.png")).expect("a picture")
    };
    assert!(from(&here, "run") == from(&there, "../a/run"));
}

#[test]
fn faulty_requests() {
    let folder = Folder::new("render_faults");
    folder.write("scene.toml", CUBE);
    souple_in(folder.path(), ["run", "scene.toml", "--out", "run", "--quiet"]).ends(0);
    std::fs::create_dir_all(folder.path().join("empty/frames")).expect("a folder");
    std::fs::create_dir_all(folder.path().join("bad/frames")).expect("a folder");
    folder.write(
        "bad/frames/cube.pvd",
        "<VTKFile><Collection><DataSet timestep=\"nan\" file=\"x.vtu\"/></Collection></VTKFile>",
    );
    std::fs::create_dir_all(folder.path().join("lost/frames")).expect("a folder");
    folder.write(
        "lost/frames/cube.pvd",
        "<VTKFile><Collection><DataSet timestep=\"0\" file=\"x.vtu\"/></Collection></VTKFile>",
    );
    let before = folder.files();
    for (source, out, more, words) in [
        ("run", "a.bmp", &[][..], ".png, .gif, .apng, .mp4 or .glb"),
        ("run", "a", &[], "extension, which says what is drawn, is missing"),
        ("nowhere", "a.png", &[], "nowhere"),
        ("empty", "a.png", &[], "there is no series"),
        ("bad", "a.png", &[], "the time of a frame is \"nan\""),
        ("lost", "a.png", &[], "x.vtu"),
        ("run", "a.png", &["--colour", "temperature"], "no body has the field `temperature`"),
        ("run", "a.png", &["--colour", "gap"], "--against RUN"),
        ("run", "a.png", &["--sheet", "4", "--size", "90,60"], "to each of 4 pictures"),
        ("run", "a.png", &["--colour", "velocity.w"], "velocity (.x, .y, .z)"),
        ("run", "a.png", &["--arrows", "von_mises"], "a vector of each point: displacement, velocity"),
        ("run", "a.png", &["--map", "sequental"], "did you mean `sequential`"),
        ("run", "a.png", &["--colour-scale", "logg"], "did you mean `log`"),
        ("run", "a.png", &["--colour-scale", "log", "--map", "diverging"], "the map sequential or grey"),
        ("run", "a.png", &["--colour-scale", "log", "--range", "0,1"], "cannot begin at 0"),
        ("run", "a.png", &["--edges", "dotted"], "drawn, hidden or wireframe"),
        ("run", "a.png", &["--range", "2,1"], "the lower one first"),
        ("run", "a.png", &["--range", "2"], "expected 2 numbers with commas"),
        ("run", "a.png", &["--range", "1 kg,2 kg"], "in Pa, or each with a unit of its kind"),
        ("run", "a.png", &["--against", "run"], "--against says nothing without the quantity `gap`"),
        ("run", "a.png", &["--colour", "none", "--map", "grey"], "--map says nothing"),
        ("run", "a.png", &["--colour", "none", "--range", "0,1"], "--range says nothing"),
        ("run", "a.png", &["--sheet", "-1"], "expected a whole number, 1 to 100"),
        ("run", "a.png", &["--sheet", "2.5"], "expected a whole number, 1 to 100"),
        ("run", "a.png", &["--threads", "-1"], "expected a whole number, 1 to 1024"),
        ("run", "a.png", &["--field-of-view", "abc"], "expected a number of degrees"),
        ("run", "a.png", &["--time", "abc"], "expected a time, as 0.5 or 500 ms"),
        ("run", "a.png", &["--cut", "0,0,0,1"], "a normal that is not zero"),
        ("run", "a.png", &["--cut", "0,0,nan,1"], "expected 4 numbers"),
        ("run", "a.png", &["--explode", "-1"], "0 to 100"),
        ("run", "a.png", &["--direction", "0,0,0"], "a vector that is not zero"),
        ("run", "a.png", &["--position", "1,1,1"], "--look-at"),
        ("run", "a.png", &["--position", "1,1,1", "--look-at", "1,1,1"], "the direction of the view is zero"),
        ("run", "a.png", &["--up", "0,0,0"], "the up of the view is zero"),
        ("run", "a.png", &["--field-of-view", "180"], "1 to 140"),
        ("run", "a.png", &["--samples", "0"], "--samples"),
        ("run", "a.png", &["--sheet", "0"], "--sheet"),
        ("run", "a.gif", &["--time", "0.1"], "--time says nothing about a.gif"),
        ("run", "a.gif", &["--sheet", "4"], ".png"),
        ("run", "a.png", &["--frames", "4"], ".gif, .apng, .mp4, .glb"),
        ("run", "a.glb", &["--dark"], ".png, .gif, .apng, .mp4"),
        (
            "run",
            "a.png",
            &["--set", "world.period=1"],
            "--set changes a scene before it is run, and run is none",
        ),
        ("run", "a.png", &["--arrows", "velocity", "--arrow-scale", "nan"], "a number above 0"),
        ("run", "none/a.png", &[], "there is no folder none"),
        ("run", "a.gif", &["--per-second", "0"], "0.1 to 100"),
        ("scene.toml", "a.png", &["--set", "bodies.cube.material.density=0"], "density"),
    ] {
        let answer = render(&folder, source, out, more);
        assert_eq!(answer.status, Some(2), "{source} {out} {more:?}: {answer:#?}");
        assert!(answer.stderr.contains(words), "`{words}`: {answer:#?}");
        assert_errors(&answer.json());
    }
    for size in ["0,0", "99999,10", "-5,10", "300.5,200", "800", "800,600,3"] {
        let call = ["render", "run", "--out", "a.png", "--size", size, "--json"];
        let answer = souple_in(folder.path(), call);
        assert_eq!(answer.status, Some(2), "{answer:#?}");
        assert!(answer.stderr.contains("1 to 16384 pixels"), "{answer:#?}");
    }
    assert_eq!(folder.files(), before);
}
