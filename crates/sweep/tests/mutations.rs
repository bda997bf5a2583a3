//! Studies and their tables with faults put in by machine: runs or an error, never a panic.

#[path = "../../../fuzz/src/mutator.rs"]
mod mutator;

use std::path::Path;

use mutator::{Mutator, guard, repeat};
use souple_sweep::Study;

fn bytes<const N: usize>(texts: [&str; N]) -> Vec<Vec<u8>> {
    texts.map(|text| text.as_bytes().to_vec()).into()
}

/// Each run of a study has a value for each of its paths, which are all different.
#[test]
fn mutated_studies_are_read_or_refused() {
    let studies = bytes([
        "title = \"a\"\nscene = \"x.toml\"\nsteps = 20\nsettings = [\"a.b=0\"]\n[vary]\n\"w.g\" = [[0, -9.81, 0], [0, 1, 0]]\n\
         \"w.p\" = [\"10 ms\", 5]\n[graphs.fall]\nx = \"w.p\"\ny = \"place.y\"\nlines = \"w.g\"\nlogarithmic = \"xy\"\n",
        "scene = \"x.toml\"\ntable = \"runs.csv\"\n",
        "scene = \"x.toml\"\n[plan]\nkind = \"spacetime\"\nstarts = 3\nseed = 4\nstart = \"a.csv\"\n\
         windows = [{ from = 0, until = 1 }]\n[[plan.keys]]\ntime = 2\nprobe = \"a.x\"\nvalue = 1\n\
         [[plan.keys]]\nfrom = 0\nuntil = \"2 s\"\nprobe = \"b\"\nleast = 0\nmost = 3\n",
    ]);
    let tables = bytes([
        "a.b,c.d[0],e\n1,\"[1, 2]\",x\n\n5 kPa,tet4,\"a \"\"b\"\"\"\n",
        "\"a.b\",\"c,d\"\n1e3,true\n2,1979-05-27\n",
    ]);
    let words = bytes([
        "scene", "table", "vary", "plan", "windows", "least", "graphs", "steps", "settings", "x", "y",
        "lines", "\"", ",", "[", "]",
    ]);
    let mut read = 0;
    let cases = repeat(4000, |seed| {
        let mut mutator = Mutator::new(seed, words.clone());
        // one of both is as it should be
        let (study, table) = match seed % 2 {
            0 => (mutator.mutated(&studies), tables[0].clone()),
            _ => (studies[1].clone(), mutator.mutated(&tables)),
        };
        let [text, table] = [study, table].map(|content| String::from_utf8_lossy(&content).into_owned());
        guard(seed, format!("{text}\n{table}").as_bytes(), 5.0, || {
            let Ok(study) = Study::parse(Path::new("study.toml"), &text, |_| Ok(table.clone())) else {
                return;
            };
            let mut paths: Vec<&str> = study.paths().collect();
            assert!(study.runs.iter().all(|run| run.values.len() == paths.len()));
            let count = paths.len();
            paths.sort_unstable();
            paths.dedup();
            assert_eq!(paths.len(), count);
            read += 1;
        });
    });
    println!("{read} of {cases} mutated studies are read");
    assert!(read > cases / 50, "{read} of {cases}");
}
