//! A study from its file to its database, table and graphs; interrupted, and gone on with.

use std::path::{Path, PathBuf};

use souple_engine::Interruption;
use souple_sweep::{Database, Study, Summary, SweepError, Workers, fingerprints, graphs, sweep, table_of};

/// A folder of temporary files with a study of the block on springs.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str, study: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("souple-sweep-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder of temporary files");
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/block_on_springs/scene.toml");
        let study =
            format!("scene = {:?}\n{study}", scene.canonicalize().expect("the scene").display().to_string());
        std::fs::write(folder.join("study.toml"), study).expect("the study is written");
        Self(folder)
    }

    fn study(&self) -> Study {
        Study::read(&self.0.join("study.toml")).unwrap()
    }

    fn database(&self, study: &Study) -> Database {
        Database::open(&self.0.join("study.sqlite"), &study.scene.display().to_string()).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // what cannot be removed from a folder of temporary files does no harm
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

const FALL: &str = r#"
title = "Fall"
steps = 20
settings = ["bodies.block.springs[0].stiffness=0"]

[vary]
"world.gravity" = [[0, -9.81, 0], [0, -1.62, 0]]
"world.period" = ["10 ms", "5 ms"]

[graphs.fall]
x = "world.period"
y = "place.y"
lines = "world.gravity"
"#;

fn workers(again: bool) -> Workers {
    Workers { count: 2, threads: 1, again }
}

fn read(study: &Study) -> Vec<String> {
    fingerprints(study, workers(false)).unwrap()
}

fn made(study: &Study, database: &mut Database, again: bool) -> Summary {
    sweep(study, &read(study), database, workers(again), &Interruption::default(), &mut |_| {}).unwrap()
}

/// Four runs fall as far as `g t²/2` says, are in rows that SQL finds, and on a graph; runs that are held are not made again.
#[test]
fn runs_are_made_once_and_kept() {
    let folder = Folder::new("made", FALL);
    let study = folder.study();
    let mut database = folder.database(&study);
    assert_eq!(made(&study, &mut database, false), Summary { made: 4, ..Summary::default() });
    assert_eq!(made(&study, &mut database, false), Summary { held: 4, ..Summary::default() });
    assert_eq!(made(&study, &mut database, true), Summary { made: 4, ..Summary::default() });
    let table = table_of(&study, &read(&study), &database).unwrap();
    assert_eq!(table.rows.len(), 4);
    for row in &table.rows {
        let (fall, unit) = table.find(row, "place.y").unwrap();
        let gravity = if row.values[0].contains("9.81") { 9.81 } else { 1.62 };
        let period = row.numbers[1].unwrap();
        assert_eq!(table.find(row, "world.period").unwrap(), (1e3 * period, "ms".to_owned()));
        let expected = -0.5 * gravity * (20.0 * period).powi(2);
        // Verlet is exact for a constant force: rounding of twenty steps
        assert!((fall / expected - 1.0).abs() < 1e-12 && unit == "m", "{fall} {expected}");
        assert!(table.find(row, "place.y.max").unwrap().0 >= fall);
        assert!(table.find(row, "nothing").is_none());
    }
    let files = graphs::write(&study, &table, &folder.0.join("study.sqlite")).unwrap();
    assert!(files.iter().all(|file| file.is_file()) && files.len() == 2);
    table.write_csv(&folder.0.join("study.csv")).unwrap();
    let csv = std::fs::read_to_string(folder.0.join("study.csv")).unwrap();
    assert!(csv.starts_with("world.gravity,world.period,") && csv.lines().count() == 5, "{csv}");
    drop(database);
    // what another program asks of the file
    let file = rusqlite::Connection::open(folder.0.join("study.sqlite")).unwrap();
    let query = "select count(*) from parameters join results using (run) \
                 where path = 'world.period' and number = 0.005 and name = 'place' and component = 1 and last < 0";
    assert_eq!(file.query_row(query, [], |row| row.get::<_, i64>(0)).unwrap(), 2);
}

/// Stopped when its first run is told, in whatever step of the next, a study keeps what was made and goes on with the others.
#[test]
fn a_study_goes_on_where_it_stopped() {
    // so many that the one worker is not through them before the first is told
    const RUNS: usize = 100;
    let stiffnesses: Vec<String> = (1..=RUNS).map(|run| format!("{run}000")).collect();
    let vary = format!("[vary]\n\"bodies.block.springs[0].stiffness\" = [{}]\n", stiffnesses.join(", "));
    let folder = Folder::new("stopped", &format!("title = \"Stopped\"\nsteps = 20\n{vary}"));
    let study = folder.study();
    let mut database = folder.database(&study);
    let stop = Interruption::default();
    let one = Workers { count: 1, ..workers(false) };
    let mut watch = |progress: souple_sweep::Progress| {
        if progress.done == 1 {
            stop.wish();
        }
    };
    let first = sweep(&study, &read(&study), &mut database, one, &stop, &mut watch).unwrap();
    assert!(first.made >= 1 && first.made < RUNS, "{first:?}");
    let rest = made(&study, &mut database, false);
    assert_eq!((rest.held, rest.made + rest.held), (first.made, RUNS));
}

/// A graph of what the scene does not have is said before the first run, and so is a value that is there twice.
#[test]
fn graphs_of_nothing_are_refused() {
    let vary = "[vary]\n\"bodies.block.material.density\" = [1000, 2000]\n";
    for (graph, wanted) in [
        ("x = \"tip.y\"\ny = \"place.y\"", "`tip.y`"),
        ("x = \"bodies.block.material.density\"\ny = \"palce.y\"", "place"),
        ("x = \"bodies.block.material.density\"\ny = \"place.y.mim\"", "did you mean `min`"),
        ("x = \"wall_seconds\"\ny = \"place.y\"\nlines = \"world.period\"", "a path that varies"),
    ] {
        let folder = Folder::new("nothing", &format!("{vary}[graphs.sag]\n{graph}\n"));
        let error = fingerprints(&folder.study(), workers(false)).unwrap_err().to_string();
        assert!(error.contains("graphs.sag.") && error.contains(wanted), "{error}");
    }
    let twice =
        Study::parse("study.toml".as_ref(), "scene = \"s\"\n[vary]\na = [1, 2, 1]\n", |_| unreachable!());
    assert!(twice.unwrap_err().to_string().contains("1 twice"));
}

/// A value that the scene does not take is said before the first run; a file of another scene is not written into.
#[test]
fn what_cannot_be_is_refused() {
    let folder = Folder::new("refused", "[vary]\n\"bodies.block.material.density\" = [1000, -1]\n");
    let study = folder.study();
    let _made = folder.database(&study);
    let error = fingerprints(&study, workers(false)).unwrap_err();
    assert!(
        matches!(&error, SweepError::Scene { run: 2, message, .. } if message.contains("density")),
        "{error}"
    );
    let other = Database::open(&folder.0.join("study.sqlite"), "another scene");
    assert!(matches!(other.map(|_| ()).unwrap_err(), SweepError::OtherStudy { .. }));
}
