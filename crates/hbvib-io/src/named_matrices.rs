//! Matrices of one model by the names that users give to variables: K, M, C, D, stiffness, mass, damping, ...

use crate::matrix::{Matrices, Matrix};

/// Names of a kind, in small letters.
const NAMES: [(&str, &[&str]); 4] = [
    (
        "stiffness",
        &[
            "k",
            "kaa",
            "kxx",
            "kgg",
            "kff",
            "kll",
            "kred",
            "k_red",
            "stiffness",
            "stiffness_matrix",
            "stiff",
        ],
    ),
    (
        "mass",
        &[
            "m",
            "maa",
            "mxx",
            "mgg",
            "mff",
            "mll",
            "mred",
            "m_red",
            "mass",
            "mass_matrix",
        ],
    ),
    (
        "damping",
        &[
            "c",
            "b",
            "baa",
            "bxx",
            "cred",
            "c_red",
            "damping",
            "damping_matrix",
            "damp",
            "viscous",
        ],
    ),
    (
        "structural",
        &["d", "k4", "k4aa", "k4xx", "structural", "structural_damping"],
    ),
];

/// Kind of a matrix by its name.
fn kind(name: &str) -> Option<usize> {
    let name = name.to_ascii_lowercase();
    NAMES.iter().position(|(_, names)| names.contains(&&name[..]))
}

/// Puts matrices where their names say. One matrix of an unknown name is returned as stiffness.
///
/// # Errors
/// A sentence: no matrix, none of a known name, two of one kind.
pub(crate) fn sorted(mut found: Vec<(String, Matrix)>, mut others: Vec<String>) -> Result<Matrices, String> {
    let mut all = Matrices::default();
    if found.is_empty() {
        let held = if others.is_empty() {
            "nothing".into()
        } else {
            others.join(", ")
        };
        return Err(format!("holds no matrix of numbers, but {held}"));
    }
    if found.len() == 1 && kind(&found[0].0).is_none() {
        all.stiffness = found.pop().map(|(_, matrix)| matrix);
        all.others = others;
        return Ok(all);
    }
    let names: Vec<String> = found.iter().map(|(name, _)| name.clone()).collect();
    for (name, matrix) in found {
        let Some(kind) = kind(&name) else {
            others.push(name);
            continue;
        };
        let places = [&mut all.stiffness, &mut all.mass, &mut all.damping, &mut all.structural];
        let Some(place) = places.into_iter().nth(kind) else {
            continue;
        };
        if place.replace(matrix).is_some() {
            return Err(format!(
                "holds two matrices of {}, of which {name} is the second: needs one",
                NAMES[kind].0
            ));
        }
    }
    all.others = others;
    if all.named().next().is_none() {
        return Err(format!(
            "holds several matrices, {}, and none has a name that is known: K or stiffness, M or mass, C or damping, D or structural",
            names.join(", ")
        ));
    }
    Ok(all)
}
