//! A sector from its faces.

use crate::build::Outcome;
use crate::job::{FacesPart, FrameName, Job, Node};
use crate::node_match::{Positioned, pairs};
use crate::node_table::{Nodes, node_list, positions};
use hbvib::{Model, SectorDescription, SectorFrame};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// Largest distance between a node of the right face and the image of a left one, over the largest distance from the
/// origin.
const NEAR: f64 = 1e-4;

type Points = Vec<[f64; 3]>;

/// Degrees of freedom of both faces, those of one node after another, and the positions of the nodes.
struct Faces {
    left: Vec<Option<usize>>,
    right: Vec<Option<usize>>,
    components: usize,
    coordinates: Option<(Points, Points)>,
    /// Degrees of freedom of nodes whose image is fixed.
    fixed: Vec<usize>,
    facts: Vec<String>,
}

/// The model of a sector.
pub struct Sector {
    pub model: Model,
    /// Degree of freedom of the left face of each one of the right face.
    pub images: HashMap<i64, i64>,
    /// Nodes that were fixed as their image is.
    pub facts: Vec<String>,
}

impl Sector {
    /// A model that has no faces.
    pub fn without_faces(model: Model) -> Self {
        Self {
            model,
            images: HashMap::new(),
            facts: Vec::new(),
        }
    }
}

/// The model of a sector, without its matrices.
///
/// # Errors
/// A sentence that names the face and its node or degree of freedom.
pub fn sector(job: &Job, part: &FacesPart, ndof: usize, nodes: &Nodes) -> Outcome<Sector> {
    let said = |e: String| format!("[model.faces]: {e}");
    if part.direction.abs() != 1 {
        return Err(said(format!("direction = {}, needs 1 or -1", part.direction)));
    }
    let left = node_list("left", &part.left, nodes.mesh.as_ref()).map_err(said)?;
    let right = node_list("right", &part.right, nodes.mesh.as_ref()).map_err(said)?;
    let numbers = left.iter().chain(&right).any(|node| matches!(node, Node::Number(_)));
    let faces = if numbers {
        by_position(job, part, (&left, &right), nodes)
    } else {
        in_order(part, &left, &right)
    };
    let faces = faces.map_err(said)?;
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
    let angle = part.direction as f64 * TAU / job.model.sectors as f64;
    let images: Points = at_left.iter().map(|x| turned(*x, part.axis, angle)).collect();
    let size = images.iter().map(norm).fold(0.0, f64::max);
    let list = |name, nodes, at| Positioned { name, nodes, at };
    let partner = pairs(
        &list("left", left, &images),
        &list("right", right, &at_right),
        NEAR * size,
    )?;
    let mut faces = Faces {
        left: Vec::new(),
        right: Vec::new(),
        components: 3,
        coordinates: None,
        fixed: Vec::new(),
        facts: Vec::new(),
    };
    let mut coordinates = (Points::new(), Points::new());
    for (i, &j) in partner.iter().enumerate() {
        let dofs_of = |name: &str, i: usize, node: &Node| match node {
            Node::Number(number) => nodes.of_number(*number).map_err(|e| format!("{name}[{i}]: {e}")),
            Node::Dofs(_) => Err(format!("{name}[{i}] names degrees of freedom, others name nodes")),
        };
        let sides = (dofs_of("left", i, &left[i])?, dofs_of("right", j, &right[j])?);
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

/// A degree of freedom; `None` for -1.
fn given(dof: i64) -> Outcome<Option<usize>> {
    match dof {
        -1 => Ok(None),
        dof => usize::try_from(dof).map(Some).map_err(|_| format!("names {dof}")),
    }
}

fn norm(x: &[f64; 3]) -> f64 {
    x[0].hypot(x[1]).hypot(x[2])
}

/// A point turned about an axis through the origin (Rodrigues' formula).
pub fn turned(x: [f64; 3], axis: [f64; 3], angle: f64) -> [f64; 3] {
    let n = axis.map(|a| a / norm(&axis));
    let (sin, cos) = angle.sin_cos();
    let along = n[0] * x[0] + n[1] * x[1] + n[2] * x[2];
    let across = [
        n[1] * x[2] - n[2] * x[1],
        n[2] * x[0] - n[0] * x[2],
        n[0] * x[1] - n[1] * x[0],
    ];
    [0, 1, 2].map(|k| cos * x[k] + sin * across[k] + (1.0 - cos) * along * n[k])
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
