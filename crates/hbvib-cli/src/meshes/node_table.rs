//! Positions and degrees of freedom of nodes, which a job names by numbers, by sets or by degrees of freedom.

use crate::job_file::job_words::AbsentName;
use crate::job_file::job_words::DofName;
use crate::job_file::job_words::Node;
use crate::job_file::job_words::NodeList;
use crate::meshes::mesh::Mesh;
use crate::texts::outcome::Outcome;
use hbvib_io::{Dof, RelativeCoordinates};
use std::collections::HashMap;

/// Position of each node of a list, from the job itself or from the mesh.
///
/// # Errors
/// A sentence that names the list and the node.
pub fn positions(name: &str, nodes: &[Node], own: &[[f64; 3]], mesh: Option<&Mesh>) -> Outcome<Vec<[f64; 3]>> {
    if own.is_empty()
        && let Some(mesh) = mesh
    {
        let of = |(i, node): (usize, &Node)| match node {
            Node::Number(number) => mesh.position(*number).map_err(|e| format!("{name}[{i}]: {e}")),
            Node::Dofs(dofs) => Err(format!(
                "{name}[{i}] names degrees of freedom {dofs:?}, needs a node number to be found in {}",
                mesh.path().display()
            )),
        };
        return nodes.iter().enumerate().map(of).collect();
    }
    if own.len() != nodes.len() {
        return Err(format!(
            "{name}_coordinates has {} entries, needs {} as {name} has",
            own.len(),
            nodes.len()
        ));
    }
    match own.iter().position(|x| !x.iter().all(|v| v.is_finite())) {
        Some(i) => Err(format!("{name}_coordinates[{i}] is not finite")),
        None => Ok(own.to_vec()),
    }
}

/// The nodes of a list; those of a set of the mesh by their numbers.
///
/// # Errors
/// A sentence: an unknown set.
pub fn node_list(name: &str, list: &NodeList, mesh: Option<&Mesh>) -> Outcome<Vec<Node>> {
    match list {
        NodeList::Nodes(nodes) => Ok(nodes.clone()),
        NodeList::Set(set) => {
            let numbers = set_of(set, mesh).map_err(|e| format!("{name}: {e}"))?;
            Ok(numbers.iter().map(|&number| Node::Number(number)).collect())
        }
        NodeList::Sets(sets) => {
            let mut all = Vec::new();
            for set in sets {
                let numbers = set_of(set, mesh).map_err(|e| format!("{name}: {e}"))?;
                all.extend(numbers.iter().map(|&number| Node::Number(number)));
            }
            Ok(all)
        }
    }
}

/// The nodes of the model.
pub struct Nodes {
    /// Rows of each node along x, y and z; -1 for those that the files do not have.
    rows: HashMap<i64, [i64; 3]>,
    /// Node of each row.
    node_of: Vec<i64>,
    /// Further rows of a node and direction that has several, as of beams that are expanded to solids.
    further: HashMap<Dof, Vec<i64>>,
    /// Nodes and directions without rows: fixed, or refused.
    absent: AbsentName,
    /// The mesh of the job.
    pub mesh: Option<Mesh>,
    /// Rows that are motions relative to others, of contacts between surfaces.
    pub relative: Option<RelativeCoordinates>,
}

impl Nodes {
    /// The table of nodes from node and direction, 1 to 3, of each degree of freedom.
    pub fn new(dofs: &[Dof], mesh: Option<Mesh>, absent: AbsentName) -> Self {
        let mut rows: HashMap<i64, [i64; 3]> = HashMap::new();
        let mut further: HashMap<Dof, Vec<i64>> = HashMap::new();
        for (i, &(node, direction)) in dofs.iter().enumerate() {
            if let 1..=3 = direction {
                let place = &mut rows.entry(node).or_insert([-1; 3])[direction as usize - 1];
                if *place == -1 {
                    *place = i as i64;
                } else {
                    further
                        .entry((node, direction))
                        .or_insert_with(|| vec![*place])
                        .push(i as i64);
                }
            }
        }
        Self {
            rows,
            node_of: dofs.iter().map(|(node, _)| *node).collect(),
            further,
            absent,
            mesh,
            relative: None,
        }
    }

    /// Adds nodes whose rows follow all others.
    pub fn add(&mut self, dofs: &[Dof]) {
        for &(node, direction) in dofs {
            if let 1..=3 = direction {
                let rows = self.rows.entry(node).or_insert([-1; 3]);
                rows[direction as usize - 1] = self.node_of.len() as i64;
            }
            self.node_of.push(node);
        }
    }

    /// Degrees of freedom of a node along x, y and z, -1 for a direction that is fixed; `None` for a node that is fixed.
    ///
    /// # Errors
    /// A sentence: a node that neither the matrices nor the mesh have; one without rows, or with several of one direction.
    pub fn of_number(&self, number: i64) -> Outcome<Option<[i64; 3]>> {
        let known = || self.mesh.as_ref().is_some_and(|mesh| mesh.position(number).is_ok());
        let dofs = match self.rows.get(&number) {
            Some(dofs) => *dofs,
            None if self.rows.is_empty() => return Err(format!("names node {number}, but the matrices name no nodes")),
            None if !known() => return Err(format!("node {number} is not in the matrices")),
            None if self.absent == AbsentName::Fixed => return Ok(None),
            None => return Err(format!("node {number} has no rows in the matrices: {ABSENT}")),
        };
        for direction in 1..=3 {
            self.single((number, direction))?;
            if dofs[direction as usize - 1] == -1 && self.absent == AbsentName::Refused {
                return Err(format!("node {number} has no row along {}: {ABSENT}", axis(direction)));
            }
        }
        Ok(Some(dofs))
    }

    /// Numbers of the nodes that the matrices name, ascending.
    pub fn numbers(&self) -> Vec<i64> {
        let mut numbers: Vec<i64> = self.rows.keys().copied().collect();
        numbers.sort_unstable();
        numbers
    }

    /// Rows of a node along x, y and z, the first where there are several; -1 for none.
    pub fn rows_of(&self, number: i64) -> [i64; 3] {
        self.rows.get(&number).copied().unwrap_or([-1; 3])
    }

    /// Node of a degree of freedom, where the files name it.
    pub fn node_of(&self, dof: usize) -> Option<i64> {
        self.node_of.get(dof).copied()
    }

    /// A degree of freedom in words: node and direction, or its number.
    pub fn name_of(&self, dof: usize) -> String {
        let node = self.node_of(dof).filter(|node| self.rows.contains_key(node));
        let place = node.and_then(|node| {
            let rows = self.rows_of(node);
            let direction = rows.iter().position(|row| *row == dof as i64)?;
            Some(format!("{node}.{}", direction + 1))
        });
        place.unwrap_or_else(|| dof.to_string())
    }

    /// Node and direction of each of `order` rows, 0 for a direction that is none of x, y and z; empty where there are no names.
    pub fn directions(&self, order: usize) -> Vec<[f64; 2]> {
        if self.rows.is_empty() || self.node_of.len() != order {
            return Vec::new();
        }
        let mut all: Vec<[f64; 2]> = self.node_of.iter().map(|node| [*node as f64, 0.0]).collect();
        for rows in self.rows.values() {
            for (direction, row) in rows.iter().enumerate() {
                if let Some(place) = usize::try_from(*row).ok().and_then(|row| all.get_mut(row)) {
                    place[1] = direction as f64 + 1.0;
                }
            }
        }
        for ((_, direction), rows) in &self.further {
            for row in rows {
                if let Some(place) = usize::try_from(*row).ok().and_then(|row| all.get_mut(row)) {
                    place[1] = *direction as f64;
                }
            }
        }
        all
    }

    /// Position of the node of a degree of freedom, where the mesh has it.
    pub fn position_of(&self, dof: i64) -> Option<[f64; 3]> {
        let node = self.node_of.get(usize::try_from(dof).ok()?)?;
        self.mesh.as_ref()?.position(*node).ok()
    }

    /// Refuses a node and direction with several rows.
    fn single(&self, dof: Dof) -> Outcome<()> {
        match self.further.get(&dof) {
            None => Ok(()),
            Some(rows) => Err(format!(
                "node {} has {} rows along {}: {rows:?}; name the degree of freedom by its row",
                dof.0,
                rows.len(),
                axis(dof.1)
            )),
        }
    }

    /// Degrees of freedom of a node in the directions of a law; -1 for one that is fixed.
    ///
    /// # Errors
    /// A sentence: a wrong number of them, a node that the files do not name.
    pub fn dofs_of(&self, node: &Node, places: &[usize]) -> Outcome<Vec<i64>> {
        match node {
            Node::Dofs(dofs) if dofs.len() == places.len() => Ok(dofs.clone()),
            Node::Dofs(dofs) => Err(format!("has {} degrees of freedom, needs {}", dofs.len(), places.len())),
            Node::Number(number) if places.len() != 3 => {
                Err(format!("names node {number}, whose three directions need a normal"))
            }
            Node::Number(number) => Ok(self.of_number(*number)?.unwrap_or([-1; 3]).to_vec()),
        }
    }

    /// The number of a degree of freedom whose motion is wanted.
    ///
    /// # Errors
    /// A sentence: a name that is not understood, a node or direction that the files do not have, or have several times; one whose
    /// motion is relative.
    pub fn dof(&self, name: &DofName) -> Outcome<usize> {
        let dof = self.row(name)?;
        self.refuse_relative([dof])?;
        Ok(dof)
    }

    /// Degrees of freedom on which a force on one acts, each with its share.
    ///
    /// # Errors
    /// As [`Self::dof`], but for relative motions.
    pub fn forced(&self, name: &DofName) -> Outcome<Vec<(usize, f64)>> {
        let dof = self.row(name)?;
        let weights = self.relative.as_ref().map_or(&[][..], |relative| relative.weights(dof));
        let others = weights.iter().map(|(other, weight)| (*other as usize, *weight));
        Ok(core::iter::once((dof, 1.0)).chain(others).collect())
    }

    /// Refuses degrees of freedom whose motions are relative.
    ///
    /// # Errors
    /// A sentence.
    pub fn refuse_relative(&self, dofs: impl IntoIterator<Item = usize>) -> Outcome<()> {
        let relative = |dof: &usize| {
            self.relative
                .as_ref()
                .is_some_and(|relative| relative.is_relative(*dof))
        };
        match dofs.into_iter().find(relative) {
            None => Ok(()),
            Some(dof) => Err(format!(
                "{} is on side a of a contact between surfaces, and moves relative to side b, or on a face that follows the other one: \
                 name another node",
                self.name_of(dof)
            )),
        }
    }

    fn row(&self, name: &DofName) -> Outcome<usize> {
        let name = match name {
            DofName::Number(number) => return Ok(*number),
            DofName::Node(name) => name,
        };
        let split = name.rsplit_once('.');
        let (node, direction) = split
            .and_then(|(node, direction)| Some((node, direction.parse::<i64>().ok()?)))
            .filter(|(_, direction)| (1..=3).contains(direction))
            .ok_or_else(|| format!("dof = \"{name}\", needs a node and a direction from 1 to 3 as in \"12.3\""))?;
        let number = match node.parse() {
            Ok(number) => number,
            Err(_) => match set_of(node, self.mesh.as_ref())? {
                [number] => *number,
                set => return Err(format!("dof = \"{name}\": the set has {} nodes, needs one", set.len())),
            },
        };
        let said = |e: String| format!("dof = \"{name}\": {e}");
        self.single((number, direction)).map_err(said)?;
        let dof = match self.rows.get(&number) {
            Some(dofs) => dofs[direction as usize - 1],
            None => self
                .of_number(number)
                .map_err(said)?
                .map_or(-1, |dofs| dofs[direction as usize - 1]),
        };
        usize::try_from(dof).map_err(|_| {
            said(format!(
                "node {number} has no row along {} in the matrices: it is fixed, or follows others by a constraint",
                axis(direction)
            ))
        })
    }
}

/// Remedy for a node or direction without rows.
const ABSENT: &str = "it may be fixed, or follow others by a constraint (MPC, TIE, rigid body); absent = \"fixed\" in [model] \
                      takes all such nodes and directions as fixed";

fn axis(direction: i64) -> &'static str {
    match direction {
        1 => "x",
        2 => "y",
        _ => "z",
    }
}

fn set_of<'a>(name: &str, mesh: Option<&'a Mesh>) -> Outcome<&'a [i64]> {
    let Some(mesh) = mesh else {
        return Err(format!("names the set \"{name}\", needs a mesh in [model]"));
    };
    mesh.set(name)
        .ok_or_else(|| format!("there is no set \"{name}\" in {}", mesh.path().display()))
}

#[cfg(test)]
mod tests {
    use super::Nodes;
    use crate::job_file::job_words::AbsentName;
    use crate::job_file::job_words::DofName;
    use crate::job_file::job_words::Node;

    #[test]
    fn degrees_of_freedom_follow_the_directions_of_the_file() {
        let dofs = [(4, 3), (4, 1), (9, 2)];
        let table = Nodes::new(&dofs, None, AbsentName::Fixed);
        assert_eq!(table.dofs_of(&Node::Number(4), &[0, 1, 2]), Ok(vec![1, -1, 0]));
        assert_eq!(table.dofs_of(&Node::Number(9), &[0, 1, 2]), Ok(vec![-1, 2, -1]));
        assert!(table.dofs_of(&Node::Number(5), &[0, 1, 2]).is_err());
        assert!(table.dofs_of(&Node::Number(4), &[0]).is_err());
        assert_eq!(table.dofs_of(&Node::Dofs(vec![8]), &[0]), Ok(vec![8]));
        assert!(table.dofs_of(&Node::Dofs(vec![8, 1]), &[0]).is_err());
        let strict = Nodes::new(&dofs, None, AbsentName::Refused);
        let error = strict.dofs_of(&Node::Number(4), &[0, 1, 2]).unwrap_err();
        assert!(
            error.contains("no row along y") && error.contains("absent = \"fixed\""),
            "{error}"
        );
    }

    #[test]
    fn a_node_and_a_direction_name_a_degree_of_freedom() {
        let table = Nodes::new(
            &[(4, 3), (4, 1), (9, 2), (8, 2), (8, 1), (8, 2)],
            None,
            AbsentName::Refused,
        );
        let dof = |name: &str| table.dof(&DofName::Node(name.into()));
        assert_eq!(
            (dof("4.1"), dof("9.2"), dof("8.1"), table.dof(&DofName::Number(7))),
            (Ok(1), Ok(2), Ok(4), Ok(7))
        );
        for (name, words) in [
            ("4.2", "no row along y"),
            ("5.1", "node 5"),
            ("4.0", "needs a node and a direction"),
            ("4", "needs a node and a direction"),
            ("TIP.1", "needs a mesh"),
            ("8.2", "2 rows along y: [3, 5]"),
        ] {
            let error = dof(name).unwrap_err();
            assert!(error.contains(words), "{error}");
        }
        assert!(table.of_number(8).unwrap_err().contains("[3, 5]"));
    }
}
