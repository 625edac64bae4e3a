//! Coordinates and degrees of freedom of nodes, which a job names by number or by degrees of freedom.

use crate::build::Outcome;
use crate::job::{Job, Node, NodesPart};
use hbvib_io::Dof;
use std::collections::HashMap;
use std::path::Path;

type Points = Vec<[f64; 3]>;

/// Coordinates of the nodes of both lists, from the job itself or from its file.
///
/// # Errors
/// A sentence that names the list, and the node or line of the file.
pub fn coordinates(job: &Job, nodes: &NodesPart) -> Outcome<(Points, Points)> {
    let file = match &nodes.coordinates {
        Some(path) => {
            let path = job.path(path);
            let said = |e: String| format!("{}: {e}", path.display());
            let text = std::fs::read_to_string(&path).map_err(|e| said(format!("cannot be read: {e}")))?;
            Some(node_lines(&text).map_err(said)?)
        }
        None => None,
    };
    let of = |name: &str, list: &[Node], own: &[[f64; 3]]| -> Outcome<Points> {
        let points = match &file {
            Some(file) if own.is_empty() => from_file(file, name, list, nodes.coordinates.as_deref())?,
            _ if own.len() == list.len() => own.to_vec(),
            _ => {
                return Err(format!(
                    "nodes: {name}_coordinates has {} entries, needs {} as {name} has",
                    own.len(),
                    list.len()
                ));
            }
        };
        match points.iter().position(|x| !x.iter().all(|v| v.is_finite())) {
            Some(i) => Err(format!("nodes: {name}_coordinates[{i}] is not finite")),
            None => Ok(points),
        }
    };
    Ok((
        of("a", &nodes.a, &nodes.a_coordinates)?,
        of("b", &nodes.b, &nodes.b_coordinates)?,
    ))
}

fn from_file(file: &HashMap<i64, [f64; 3]>, name: &str, list: &[Node], path: Option<&Path>) -> Outcome<Points> {
    let path = path.unwrap_or(Path::new("")).display();
    list.iter()
        .enumerate()
        .map(|(i, node)| match node {
            Node::Number(number) => file
                .get(number)
                .copied()
                .ok_or_else(|| format!("nodes: {name}[{i}]: node {number} is not in {path}")),
            Node::Dofs(dofs) => Err(format!(
                "nodes: {name}[{i}] names degrees of freedom {dofs:?}, needs a node number to be found in {path}"
            )),
        })
        .collect()
}

/// Number, x, y and z of each line, of those after *NODE in a mesh.
fn node_lines(text: &str) -> Outcome<HashMap<i64, [f64; 3]>> {
    let mut found = HashMap::new();
    let mut inside = true;
    for (k, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with("**") || line.starts_with('#') {
            continue;
        }
        if let Some(keyword) = line.strip_prefix('*') {
            let word = keyword.split(',').next().unwrap_or("").trim();
            inside = word.eq_ignore_ascii_case("node");
            continue;
        }
        if !inside {
            continue;
        }
        let words: Vec<&str> = line.split([',', ' ', '\t']).filter(|word| !word.is_empty()).collect();
        let bad = || format!("line {}: needs number, x, y, z of a node", k + 1);
        let [number, position @ ..] = &words[..] else {
            return Err(bad());
        };
        if position.len() != 3 {
            return Err(bad());
        }
        let number: i64 = number.parse().map_err(|_| bad())?;
        let mut x = [0.0; 3];
        for (x, word) in x.iter_mut().zip(position) {
            *x = word.parse().map_err(|_| bad())?;
        }
        if found.insert(number, x).is_some() {
            return Err(format!("line {}: node {number} comes twice", k + 1));
        }
    }
    Ok(found)
}

/// Degrees of freedom of each node along x, y and z; -1 for those that the files do not have.
pub type NodeDofs = HashMap<i64, [i64; 3]>;

/// The table of nodes from node and direction, 1 to 3, of each degree of freedom.
pub fn node_dofs(dofs: &[Dof]) -> NodeDofs {
    let mut table = NodeDofs::new();
    for (i, &(node, direction)) in dofs.iter().enumerate() {
        if let place @ 1..=3 = direction {
            table.entry(node).or_insert([-1; 3])[place as usize - 1] = i as i64;
        }
    }
    table
}

/// Degrees of freedom of a node in the directions of a law. A direction that the files do not have does not move.
///
/// # Errors
/// A sentence: a wrong number of them, a node that the files do not name.
pub fn dofs_of(node: &Node, places: &[usize], table: &NodeDofs) -> Outcome<Vec<i64>> {
    match node {
        Node::Dofs(dofs) if dofs.len() == places.len() => Ok(dofs.clone()),
        Node::Dofs(dofs) => Err(format!("has {} degrees of freedom, needs {}", dofs.len(), places.len())),
        Node::Number(number) if places.len() != 3 => {
            Err(format!("names node {number}, whose three directions need a normal"))
        }
        Node::Number(number) => match table.get(number) {
            Some(dofs) => Ok(dofs.to_vec()),
            None if table.is_empty() => Err(format!("names node {number}, but the matrices name no nodes")),
            None => Err(format!("node {number} is not in the matrices")),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::{dofs_of, node_dofs, node_lines};
    use crate::job::Node;

    #[test]
    fn nodes_of_lists_and_meshes_are_read() {
        let plain = node_lines("# x y z\n3 0.5 1e-3 -2\n7,1,2,3\n").unwrap();
        assert_eq!((plain[&3], plain[&7]), ([0.5, 1e-3, -2.0], [1.0, 2.0, 3.0]));
        let mesh =
            "*HEADING\nA wheel\n*Node, NSET=all\n 1, 0., 1., 2.\n*ELEMENT\n1, 1, 2\n*NODE PRINT\nU\n*node\n2,3,4,5\n";
        let mesh = node_lines(mesh).unwrap();
        assert_eq!((mesh.len(), mesh[&1], mesh[&2]), (2, [0.0, 1.0, 2.0], [3.0, 4.0, 5.0]));
        for (text, line) in [
            ("1 2 3\n", "line 1"),
            ("1 2 3 4\n1 2 3 4\n", "line 2"),
            ("1 2 x 4", "line 1"),
        ] {
            assert!(node_lines(text).unwrap_err().contains(line), "{text}");
        }
    }

    #[test]
    fn degrees_of_freedom_follow_the_directions_of_the_file() {
        let table = node_dofs(&[(4, 3), (4, 1), (9, 2)]);
        assert_eq!(dofs_of(&Node::Number(4), &[0, 1, 2], &table), Ok(vec![1, -1, 0]));
        assert_eq!(dofs_of(&Node::Number(9), &[0, 1, 2], &table), Ok(vec![-1, 2, -1]));
        assert!(dofs_of(&Node::Number(5), &[0, 1, 2], &table).is_err());
        assert!(dofs_of(&Node::Number(4), &[0], &table).is_err());
        assert_eq!(dofs_of(&Node::Dofs(vec![8]), &[0], &table), Ok(vec![8]));
        assert!(dofs_of(&Node::Dofs(vec![8, 1]), &[0], &table).is_err());
    }
}
