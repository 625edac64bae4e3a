//! A sector from its faces.

use crate::job_file::job::Job;
use crate::job_file::job_faces::{FacesPart, FrameName, MatchingName};
use crate::job_file::job_words::Node;
use crate::job_file::job_words::NodeList;
use crate::meshes::face_images::FaceImages;
use crate::meshes::mesh::Mesh;
use crate::meshes::node_match::{Positioned, pairs};
use crate::meshes::node_table::{Nodes, node_list, positions};
use crate::meshes::positions::NEAR;
use crate::meshes::positions::norm;
use crate::meshes::positions::turned;
use crate::texts::outcome::Outcome;
use hbvib::{Model, SectorDescription, SectorFrame};
use std::collections::HashMap;
use std::f64::consts::TAU;

type Points = Vec<[f64; 3]>;

/// Degrees of freedom of both faces, those of one node after another, and the positions of the nodes.
#[derive(Default)]
struct Faces {
    left: Vec<Option<usize>>,
    right: Vec<Option<usize>>,
    components: usize,
    coordinates: Option<(Points, Points)>,
    /// Degrees of freedom of nodes whose image is fixed.
    fixed: Vec<usize>,
    facts: Vec<String>,
    pairs: Vec<(i64, i64, f64)>,
}

impl Faces {
    /// Adds pairs of which one node is an image.
    fn add(&mut self, images: &FaceImages) -> Outcome<()> {
        self.fixed.extend(&images.fixed);
        self.facts.extend(images.facts.iter().cloned());
        if images.pairs.is_empty() {
            return Ok(());
        }
        self.components = 3;
        let coordinates = self.coordinates.get_or_insert_default();
        for pair in &images.pairs {
            let [left, right] = pair.rows;
            for (left, right) in left.into_iter().zip(right) {
                self.left.push(given(left)?);
                self.right.push(given(right)?);
            }
            coordinates.0.push(pair.at[0]);
            coordinates.1.push(pair.at[1]);
        }
        Ok(())
    }
}

/// The model of a sector.
pub struct Sector {
    pub model: Model,
    /// Degree of freedom of the left face of each one of the right face.
    pub images: HashMap<i64, i64>,
    /// Nodes that were fixed as their image is.
    pub facts: Vec<String>,
    /// Fixed degrees of freedom beside those of the job.
    pub fixed: Vec<usize>,
    /// Left and right node of each pair, and the distance of the right one from the image of the left one.
    pub pairs: Vec<(i64, i64, f64)>,
    /// Degrees of freedom of both faces.
    pub dofs: Vec<usize>,
}

impl Sector {
    /// A model that has no faces.
    pub fn without_faces(model: Model) -> Self {
        Self {
            model,
            images: HashMap::new(),
            facts: Vec::new(),
            fixed: Vec::new(),
            pairs: Vec::new(),
            dofs: Vec::new(),
        }
    }
}

/// The model of a sector, without its matrices.
///
/// # Errors
/// A sentence that names the face and its node or degree of freedom.
pub fn sector(job: &Job, part: &FacesPart, (ndof, images): (usize, &FaceImages), nodes: &Nodes) -> Outcome<Sector> {
    let said = |e: String| format!("[model.faces]: {e}");
    if part.direction.abs() != 1 {
        return Err(said(format!("direction = {}, needs 1 or -1", part.direction)));
    }
    let of_side = |name, list| -> Outcome<Vec<Node>> {
        let mut all = node_list(name, list, nodes.mesh.as_ref()).map_err(said)?;
        all.retain(|node| !matches!(node, Node::Number(number) if images.on_axis.contains(number)));
        Ok(all)
    };
    let (left, right) = (of_side("left", &part.left)?, of_side("right", &part.right)?);
    let numbers = left.iter().chain(&right).any(|node| matches!(node, Node::Number(_)));
    let mut faces = if part.matching == MatchingName::Projected || left.is_empty() && right.is_empty() {
        Faces::default()
    } else if numbers {
        by_position(job, part, (&left, &right), nodes).map_err(said)?
    } else {
        in_order(part, &left, &right).map_err(said)?
    };
    faces.add(images).map_err(said)?;
    let fixed: Vec<usize> = job.model.fixed.iter().chain(&faces.fixed).copied().collect();
    let pairs = faces.right.iter().zip(&faces.left);
    let images = pairs
        .filter_map(|(right, left)| Some(((*right)? as i64, (*left)? as i64)))
        .collect();
    let model = Model::sector(&SectorDescription {
        ndof,
        sectors: job.model.sectors,
        engine_order: job.model.engine_order,
        components: faces.components,
        left: &faces.left,
        right: &faces.right,
        fixed: &fixed,
        frame: match part.frame {
            FrameName::Cartesian => SectorFrame::Cartesian,
            FrameName::Cylindrical => SectorFrame::Cylindrical,
        },
        axis: part.axis,
        forward: part.direction == 1,
        coordinates: faces.coordinates.as_ref().map(|(left, right)| (&left[..], &right[..])),
    })
    .map_err(|e| said(e.to_string()))?;
    Ok(Sector {
        model,
        images,
        facts: faces.facts,
        fixed: faces.fixed,
        pairs: faces.pairs,
        dofs: faces.left.iter().chain(&faces.right).flatten().copied().collect(),
    })
}

/// Faces whose nodes are degrees of freedom, pair by pair.
fn in_order(part: &FacesPart, left: &[Node], right: &[Node]) -> Outcome<Faces> {
    let width = |node: Option<&Node>| match node {
        Some(Node::Dofs(dofs)) => dofs.len(),
        _ => 1,
    };
    let components = width(left.first());
    let flat = |name: &str, face: &[Node]| -> Outcome<Vec<Option<usize>>> {
        let mut all = Vec::new();
        for (pair, node) in face.iter().enumerate() {
            if width(Some(node)) != components {
                return Err(format!(
                    "{name}[{pair}] has {} components, needs {components}",
                    width(Some(node))
                ));
            }
            if let Node::Dofs(dofs) = node {
                for &dof in dofs {
                    all.push(given(dof).map_err(|e| format!("{name}[{pair}] {e}"))?);
                }
            }
        }
        Ok(all)
    };
    let coordinates = match (&part.left_coordinates, &part.right_coordinates) {
        (Some(left), Some(right)) => Some((left.clone(), right.clone())),
        (None, None) => None,
        _ => return Err("needs both left_coordinates and right_coordinates, or none".into()),
    };
    Ok(Faces {
        left: flat("left", left)?,
        right: flat("right", right)?,
        components,
        coordinates,
        fixed: Vec::new(),
        facts: Vec::new(),
        pairs: Vec::new(),
    })
}

/// Faces whose nodes are those of a mesh, in any order: the image of each left node is the nearest right one.
fn by_position(job: &Job, part: &FacesPart, (left, right): (&[Node], &[Node]), nodes: &Nodes) -> Outcome<Faces> {
    let Some(mesh) = &nodes.mesh else {
        return Err("names nodes, needs a mesh in [model]".into());
    };
    if part.left_coordinates.is_some() || part.right_coordinates.is_some() {
        return Err(
            "left_coordinates and right_coordinates are those of degrees of freedom; the mesh has the nodes".into(),
        );
    }
    let at_left = positions("left", left, &[], Some(mesh))?;
    let at_right = positions("right", right, &[], Some(mesh))?;
    if let Some(tolerance) = part
        .tolerance
        .filter(|tolerance| !(tolerance.is_finite() && *tolerance > 0.0))
    {
        return Err(format!("tolerance = {tolerance}, needs a finite distance > 0"));
    }
    let angle = part.direction as f64 * TAU / job.model.sectors as f64;
    let images: Points = at_left.iter().map(|x| turned(*x, part.axis, angle)).collect();
    let size = images.iter().map(norm).fold(0.0, f64::max);
    let groups = [
        of_sets(&part.left, left.len(), mesh),
        of_sets(&part.right, right.len(), mesh),
    ];
    let partner = partners(
        (left, &images),
        (right, &at_right),
        (part.tolerance.unwrap_or(NEAR * size), groups, mesh),
    )?;
    let mut faces = Faces {
        left: Vec::new(),
        right: Vec::new(),
        components: 3,
        coordinates: None,
        fixed: Vec::new(),
        facts: Vec::new(),
        pairs: Vec::new(),
    };
    let mut coordinates = (Points::new(), Points::new());
    for (i, &j) in partner.iter().enumerate() {
        let dofs_of = |name: &str, i: usize, node: &Node| match node {
            Node::Number(number) => nodes.of_number(*number).map_err(|e| format!("{name}[{i}]: {e}")),
            Node::Dofs(_) => Err(format!("{name}[{i}] names degrees of freedom, others name nodes")),
        };
        let sides = (dofs_of("left", i, &left[i])?, dofs_of("right", j, &right[j])?);
        if let (Node::Number(left), Node::Number(right)) = (&left[i], &right[j]) {
            let apart = [0, 1, 2].map(|k| images[i][k] - at_right[j][k]);
            faces.pairs.push((*left, *right, norm(&apart)));
        }
        if let (None, _) | (_, None) = sides {
            // Fixed on one side is fixed on both: they are one node of the wheel.
            let moving = [
                (left[i].clone(), right[j].clone(), sides.0),
                (right[j].clone(), left[i].clone(), sides.1),
            ];
            for (node, image, dofs) in moving {
                let Some(dofs) = dofs else { continue };
                faces
                    .fixed
                    .extend(dofs.into_iter().filter_map(|dof| usize::try_from(dof).ok()));
                if let (Node::Number(node), Node::Number(image)) = (node, image) {
                    faces
                        .facts
                        .push(format!("[model.faces]: node {node} is fixed, as its image {image} is"));
                }
            }
            continue;
        }
        for dof in sides.0.unwrap_or([-1; 3]) {
            faces.left.push(given(dof)?);
        }
        for dof in sides.1.unwrap_or([-1; 3]) {
            faces.right.push(given(dof)?);
        }
        coordinates.0.push(at_left[i]);
        coordinates.1.push(at_right[j]);
    }
    faces.coordinates = Some(coordinates);
    Ok(faces)
}

/// Number of the set that each node of a list comes from, where it names several.
fn of_sets(list: &NodeList, nodes: usize, mesh: &Mesh) -> Option<Vec<usize>> {
    let NodeList::Sets(sets) = list else { return None };
    let sizes = sets.iter().map(|set| mesh.set(set).map_or(0, <[i64]>::len));
    let all: Vec<usize> = sizes.enumerate().flat_map(|(i, size)| vec![i; size]).collect();
    (all.len() == nodes).then_some(all)
}

/// Place in the right list of the image of each left node. Nodes of several sets are matched set by set; others all together, or
/// where that is not one to one, as with bodies that touch, body by body.
fn partners(
    (left, images): (&[Node], &[[f64; 3]]),
    (right, at_right): (&[Node], &[[f64; 3]]),
    (near, groups, mesh): (f64, [Option<Vec<usize>>; 2], &Mesh),
) -> Outcome<Vec<usize>> {
    let within = |of_left: &[usize], of_right: &[usize]| -> Outcome<Vec<usize>> {
        let mut partner = vec![usize::MAX; left.len()];
        let count = of_left.iter().chain(of_right).max().map_or(0, |group| group + 1);
        for group in 0..count {
            let of = |groups: &[usize]| -> Vec<usize> { (0..groups.len()).filter(|i| groups[*i] == group).collect() };
            let (own, others) = (of(of_left), of(of_right));
            let part =
                |all: &[Node], places: &[usize]| -> Vec<Node> { places.iter().map(|i| all[*i].clone()).collect() };
            let at = |all: &[[f64; 3]], places: &[usize]| -> Vec<[f64; 3]> { places.iter().map(|i| all[*i]).collect() };
            let (a, b) = (part(left, &own), part(right, &others));
            let (at_a, at_b) = (at(images, &own), at(at_right, &others));
            let list = |name, nodes, at| Positioned { name, nodes, at };
            let found = pairs(&list("left", &a, &at_a), &list("right", &b, &at_b), near)?;
            for (i, j) in found.into_iter().enumerate() {
                partner[own[i]] = others[j];
            }
        }
        Ok(partner)
    };
    if let [Some(a), Some(b)] = &groups {
        return within(a, b);
    }
    let together = within(&vec![0; left.len()], &vec![0; right.len()]);
    if together.is_ok() {
        return together;
    }
    let elements: Vec<Vec<i64>> = mesh.drawn().into_iter().map(|element| element.nodes.clone()).collect();
    let bodies = hbvib_io::bodies(&elements);
    let of = |nodes: &[Node]| -> Option<Vec<usize>> {
        let body = |node: &Node| match node {
            Node::Number(number) => bodies.get(number).copied(),
            Node::Dofs(_) => None,
        };
        nodes.iter().map(body).collect()
    };
    match (of(left), of(right)) {
        (Some(a), Some(b)) => within(&a, &b).or(together),
        _ => together,
    }
}

/// A degree of freedom; `None` for -1.
fn given(dof: i64) -> Outcome<Option<usize>> {
    match dof {
        -1 => Ok(None),
        dof => usize::try_from(dof).map(Some).map_err(|_| format!("names {dof}")),
    }
}

#[cfg(test)]
mod tests {
    use super::turned;
    use std::f64::consts::PI;

    #[test]
    fn a_point_turns_about_any_axis() {
        let near = |x: [f64; 3], y: [f64; 3]| (0..3).all(|k| (x[k] - y[k]).abs() < 1e-14);
        assert!(near(
            turned([1.0, 0.0, 3.0], [0.0, 0.0, 2.0], PI / 2.0),
            [0.0, 1.0, 3.0]
        ));
        assert!(near(turned([1.0, 2.0, 3.0], [1.0, 1.0, 1.0], -TURN), [2.0, 3.0, 1.0]));
    }

    /// About (1, 1, 1) it takes x to y, y to z and z to x.
    const TURN: f64 = 2.0 * PI / 3.0;
}
