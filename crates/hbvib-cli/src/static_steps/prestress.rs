//! The verb `prestress`: matrices of a sector that a static step of CalculiX has loaded.

use crate::meshes::inp_cards::{cards, expanded};
use crate::meshes::mesh::Mesh;
use crate::print;
use crate::static_steps::calculix_results::displacements;
use crate::static_steps::calculix_run::made;
use crate::static_steps::prestress_decks::{SET, StaticDeck};
use crate::texts::arguments::PrestressArguments;
use crate::texts::outcome::Outcome;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Makes the matrices.
///
/// # Errors
/// A sentence.
pub fn prestress(of: &PrestressArguments) -> Outcome<u8> {
    let said = |e: String| format!("{}: {e}", of.deck.display());
    if let Some(speed) = of.speed.filter(|speed| !speed.is_finite()) {
        return Err(format!("--speed {speed}: needs a finite number"));
    }
    let all = cards(&expanded(&of.deck)?).map_err(said)?;
    let deck = StaticDeck::of(&all, of.speed).map_err(said)?;
    let mesh = Mesh::read(&of.deck)?;
    if mesh.drawn().is_empty() || !mesh.is_solid() {
        return Err(said(
            "needs solid elements alone: CalculiX expands beams and shells to nodes that it does not name".into(),
        ));
    }
    let nodes = nodes(of, &deck, &mesh).map_err(said)?;
    let stem = of.deck.file_stem().unwrap_or_default().to_string_lossy();
    let stiffness = of
        .output
        .clone()
        .unwrap_or_else(|| of.deck.with_file_name(format!("{stem}_prestressed.sti")));
    if stiffness.extension().is_none_or(|extension| extension != "sti") {
        return Err(format!(
            "--output {}: needs a name that ends with .sti",
            stiffness.display()
        ));
    }
    let name = stiffness.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let file = |end: &str| stiffness.with_file_name(format!("{name}{end}"));
    let folder = stiffness.parent().unwrap_or(Path::new(""));
    if !folder.as_os_str().is_empty() {
        fs::create_dir_all(folder).map_err(|e| format!("{}: cannot be made: {e}", folder.display()))?;
    }
    let mut told = String::new();
    let (first, table) = (file("_static.inp"), file("_static.dat"));
    if made(&of.ccx, (&first, &deck.static_deck(&nodes)), &table)? {
        let _ = writeln!(told, "{} {name}_static made {}", of.ccx, table.display());
    }
    let found = displacements(&table, SET)?;
    let largest = found.values().map(|u| u[0].hypot(u[1]).hypot(u[2])).fold(0.0, f64::max);
    if made(&of.ccx, (&file(".inp"), &deck.prestressed_deck(&found)), &stiffness)? {
        let _ = writeln!(told, "{} {name} made {}", of.ccx, stiffness.display());
    }
    let _ = write!(
        told,
        "static displacements of {} nodes, at most {largest:.6e}\nnext: matrices = \"{}\" and mesh = \"{}\" in [model]\n",
        found.len(),
        stiffness.display(),
        of.deck.display()
    );
    print(&told)?;
    Ok(0)
}

/// Nodes whose displacements are prescribed: those of elements, or of sets.
fn nodes(of: &PrestressArguments, deck: &StaticDeck, mesh: &Mesh) -> Outcome<BTreeSet<i64>> {
    if let (Some(constraint), true) = (deck.constraint(), of.nodes.is_empty()) {
        return Err(format!(
            "has *{constraint}, and nodes that follow others cannot be prescribed: --nodes names sets of other nodes, with those of \
             both cyclic faces and of contacts"
        ));
    }
    if of.nodes.is_empty() {
        return Ok(mesh
            .drawn()
            .into_iter()
            .flat_map(|element| element.nodes.iter().copied())
            .collect());
    }
    let mut nodes = BTreeSet::new();
    for name in &of.nodes {
        let set = mesh
            .set(name)
            .ok_or_else(|| format!("--nodes {name}: there is no such set"))?;
        nodes.extend(set);
    }
    Ok(nodes)
}
