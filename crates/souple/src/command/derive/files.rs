//! The derived expressions as files: grouped constants of each fragment, and what is left for every step, named as in
//! Faure 2014.

use std::path::Path;

use souple_formal::element::{Derivative, Derived, ElementExpressions};
use souple_formal::emit::{Text, symbol, write as written};
use souple_formal::graph::Expr;
use souple_io::{IoError, write_file};

/// Writes `ECR_F….txt` and `F…_0x.txt` for every fragment of forces, the same with `dF` for differentials.
pub fn write(folder: &Path, derived: &Derived, association: &str) -> Result<(), IoError> {
    for (derivative, fragments) in
        [(Derivative::Force, &derived.forces), (Derivative::Differential, &derived.differentials)]
    {
        for (number, fragment) in fragments.iter().enumerate() {
            let name = derivative.constants_name(association, number);
            put(folder, &name, &constants(derived, fragment))?;
            let axes = derived.symbols.displacements[0].len();
            for (index, expr) in fragment.grouped.varying.iter().enumerate() {
                let name = derivative.expression_name(association, number, index / axes, index % axes);
                put(folder, &name, &expression(derived, *expr))?;
            }
        }
    }
    Ok(())
}

fn put(folder: &Path, name: &str, text: &str) -> Result<(), IoError> {
    write_file(&folder.join(format!("{name}.txt")), |out| out.write_all(text.as_bytes()))
}

/// `D_0 = …` of rest positions and material, one to a line; later ones may hold earlier ones.
fn constants(derived: &Derived, fragment: &ElementExpressions) -> String {
    let (symbols, definitions): (Vec<Expr>, Vec<Expr>) = fragment.grouped.constants.iter().copied().unzip();
    let (parts, roots) = written(&derived.graph, &definitions, &Text);
    let names = symbols.iter().map(|constant| symbol(&derived.graph, *constant, &Text));
    let lines = names.zip(&roots).map(|(name, root)| format!("{name} = {root}"));
    parts.into_iter().chain(lines).map(|line| line + "\n").collect()
}

/// Its parts, then the expression itself.
fn expression(derived: &Derived, expr: Expr) -> String {
    let (parts, roots) = written(&derived.graph, &[expr], &Text);
    parts.into_iter().chain(roots).map(|line| line + "\n").collect()
}
