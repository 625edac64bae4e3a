//! A deck that asks CalculiX for the matrices of a mesh.

use crate::meshes::mesh::Mesh;
use crate::meshes::mesh_elements::Shape;
use crate::texts::outcome::Outcome;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// A material.
#[derive(Clone, Copy, Debug)]
pub struct Material {
    pub young: f64,
    pub poisson: f64,
    pub density: f64,
}

/// Numbers in a line of a set.
const IN_LINE: usize = 12;

/// The deck: nodes and elements that fill space, all of one material, with some sets of nodes clamped. Surfaces, as gmsh writes
/// them for its sets, and reduced integration, whose mass is not positive definite, are left out.
///
/// # Errors
/// A sentence: a mesh without solid elements, an unknown set.
pub fn deck(mesh: &Mesh, material: Material, fixed: &[String]) -> Outcome<String> {
    let elements = mesh.drawn();
    if !elements.iter().all(|element| element.shape.is_solid()) || elements.is_empty() {
        return Err(format!(
            "{}: has no solid elements (C3D4 to C3D20)",
            mesh.path().display()
        ));
    }
    let used: BTreeSet<i64> = elements.iter().flat_map(|element| &element.nodes).copied().collect();
    let mut text = String::from("** Written by hbvib init: ccx stores the matrices of this mesh.\n*NODE, NSET=NALL\n");
    for node in &used {
        // CalculiX reads numbers of at most 20 characters.
        let [x, y, z] = mesh.position(*node)?;
        let _ = writeln!(text, "{node}, {x:.12e}, {y:.12e}, {z:.12e}");
    }
    let mut by_kind: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (i, element) in elements.iter().enumerate() {
        by_kind.entry(full_integration(element.shape)).or_default().push(i);
    }
    for (kind, of) in by_kind {
        let _ = writeln!(text, "*ELEMENT, TYPE={kind}, ELSET=SOLID");
        for i in of {
            let element = elements[i];
            let mut words: Vec<String> = vec![element.number.to_string()];
            words.extend(element.nodes.iter().map(i64::to_string));
            lines(&mut text, &words);
        }
    }
    let _ = write!(
        text,
        "*MATERIAL, NAME=MATERIAL\n*ELASTIC\n{:e}, {}\n*DENSITY\n{:e}\n*SOLID SECTION, ELSET=SOLID, MATERIAL=MATERIAL\n",
        material.young, material.poisson, material.density
    );
    let mut clamped: BTreeSet<i64> = BTreeSet::new();
    for name in fixed {
        let set = mesh
            .set(name)
            .ok_or_else(|| format!("--fixed {name}: there is no such set in {}", mesh.path().display()))?;
        clamped.extend(set.iter().copied().filter(|node| used.contains(node)));
    }
    if !clamped.is_empty() {
        text += "*BOUNDARY\n";
        for node in clamped {
            let _ = writeln!(text, "{node}, 1, 3");
        }
    }
    text += "*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n1\n*END STEP\n";
    Ok(text)
}

/// Lines of words, all but the last with a comma at the end.
fn lines(text: &mut String, words: &[String]) {
    let all: Vec<String> = words.chunks(IN_LINE).map(|line| line.join(", ")).collect();
    *text += &all.join(",\n");
    *text += "\n";
}

fn full_integration(shape: Shape) -> &'static str {
    match shape {
        Shape::Tetrahedron4 => "C3D4",
        Shape::Tetrahedron10 => "C3D10",
        Shape::Wedge6 => "C3D6",
        Shape::Wedge15 => "C3D15",
        Shape::Hexahedron8 => "C3D8",
        _ => "C3D20",
    }
}
