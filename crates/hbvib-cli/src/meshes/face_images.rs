//! Images of nodes of one face of a sector on the other one, as nodes of their own: for faces whose meshes differ, where nodes of the
//! finer face follow these images, and for nodes on the axis, which are their own images.
//!
//! A node on the axis is one of the whole wheel: q(s) = R q(s + 1) with the rotation R of a sector. In a wave it moves along the axis where
//! all sectors move alike, across it where the wave has one period around the wheel, and not at all in others. A stiffness far above its own
//! between the node and its image says so in each wave.

use crate::job_file::job::Job;
use crate::job_file::job_faces::{FacesPart, FrameName, MatchingName};
use crate::job_file::job_words::Node;
use crate::meshes::mesh::Mesh;
use crate::meshes::node_table::{Nodes, node_list, positions};
use crate::meshes::positions::NEAR;
use crate::meshes::positions::norm;
use crate::meshes::positions::turned;
use crate::texts::outcome::Outcome;
use hbvib_io::{Dof, Matrix, Surface, Symmetry, outer_faces, projected_points};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::f64::consts::TAU;

/// Stiffness between a node on the axis and its image, over its own: waves that may not move it do so by a share of 1e-6. A stiffer tie costs digits of all frequencies.
const TIED: f64 = 1e6;

/// A node of one face with its image on the other one.
pub struct ImagePair {
    /// Rows of the left and of the right node; one of both is the image.
    pub rows: [[i64; 3]; 2],
    pub at: [[f64; 3]; 2],
}

/// Images, and what follows them.
#[derive(Default)]
pub struct FaceImages {
    /// Node and direction of rows that are added.
    pub dofs: Vec<Dof>,
    pub pairs: Vec<ImagePair>,
    /// Weights of images by row of a node that follows them.
    pub follows: HashMap<u32, Vec<(u32, f64)>>,
    /// Row of the node of each row of an image on the other face.
    pub image_of: HashMap<u32, u32>,
    /// Rows of nodes on the axis, and those of their images.
    axis: Vec<[[i64; 3]; 2]>,
    /// Numbers of these nodes.
    pub on_axis: BTreeSet<i64>,
    /// Rows that do not move.
    pub fixed: Vec<usize>,
    pub facts: Vec<String>,
}

/// Rows of the images of nodes by their numbers.
type RowsOf = HashMap<i64, [i64; 3]>;

/// A face in the search.
struct Face {
    name: &'static str,
    numbers: Vec<i64>,
    at: Vec<[f64; 3]>,
}

impl FaceImages {
    /// The images that the faces of a job need, beside `order` rows.
    ///
    /// # Errors
    /// A sentence that names the face and its node.
    pub fn of(job: &Job, nodes: &Nodes, order: usize) -> Outcome<Self> {
        let mut images = Self::default();
        let (Some(part), Some(mesh)) = (&job.model.faces, &nodes.mesh) else {
            return match &job.model.faces {
                Some(part) if part.matching == MatchingName::Projected => {
                    Err("[model.faces]: matching = \"projected\" needs a mesh in [model]".into())
                }
                _ => Ok(images),
            };
        };
        let found = images.find(job, part, (nodes, mesh), order);
        found.map_err(|e| format!("[model.faces]: {e}"))?;
        Ok(images)
    }

    fn find(&mut self, job: &Job, part: &FacesPart, (nodes, mesh): (&Nodes, &Mesh), order: usize) -> Outcome<()> {
        let mut faces = Vec::new();
        for (name, list) in [("left", &part.left), ("right", &part.right)] {
            let list = node_list(name, list, Some(mesh))?;
            let number = |node: &Node| match node {
                Node::Number(number) => Some(*number),
                Node::Dofs(_) => None,
            };
            let Some(numbers) = list.iter().map(number).collect::<Option<Vec<i64>>>() else {
                return match part.matching {
                    MatchingName::Projected => Err(format!("{name}: matching = \"projected\" needs numbers of nodes")),
                    MatchingName::Nodes => Ok(()),
                };
            };
            let at = positions(name, &list, &[], Some(mesh))?;
            faces.push(Face { name, numbers, at });
        }
        let size = faces.iter().flat_map(|face| &face.at).map(norm).fold(0.0, f64::max);
        let near = part.tolerance.unwrap_or(NEAR * size);
        if !(near.is_finite() && near > 0.0) {
            return Err(format!("tolerance = {near}, needs a finite distance > 0"));
        }
        let angle = part.direction as f64 * TAU / job.model.sectors as f64;
        let mut next = Images::new(nodes, mesh, order);
        self.axis_nodes(part, &faces, (nodes, near, size, angle), &mut next)?;
        if part.matching == MatchingName::Projected {
            for face in &mut faces {
                let kept: Vec<usize> = (0..face.numbers.len())
                    .filter(|i| !self.on_axis.contains(&face.numbers[*i]))
                    .collect();
                face.at = kept.iter().map(|i| face.at[*i]).collect();
                face.numbers = kept.iter().map(|i| face.numbers[*i]).collect();
            }
            self.projected((part, angle, near), faces, (nodes, mesh), &mut next)?;
        }
        self.dofs = next.dofs;
        Ok(())
    }

    /// Nodes on the axis with their images.
    fn axis_nodes(
        &mut self,
        part: &FacesPart,
        faces: &[Face],
        (nodes, near, size, angle): (&Nodes, f64, f64, f64),
        next: &mut Images,
    ) -> Outcome<()> {
        let n = part.axis.map(|a| a / norm(&part.axis));
        let radius = |x: &[f64; 3]| {
            let along = (0..3).map(|k| n[k] * x[k]).sum::<f64>();
            norm(&[0, 1, 2].map(|k| x[k] - along * n[k]))
        };
        let mut e = [0.0; 3];
        let first = (0..3).min_by(|i, j| n[*i].abs().total_cmp(&n[*j].abs())).unwrap_or(0);
        e[first] = 1.0;
        let across = [0, 1, 2].map(|k| e[k] - n[first] * n[k]);
        let mut all: BTreeMap<i64, [f64; 3]> = BTreeMap::new();
        for face in faces {
            let pairs = face.numbers.iter().copied().zip(face.at.iter().copied());
            all.extend(pairs.filter(|(_, at)| radius(at) <= near.min(NEAR * size)));
        }
        for (number, at) in all {
            self.on_axis.insert(number);
            let Some(rows) = nodes.of_number(number).map_err(|e| format!("on the axis: {e}"))? else {
                continue;
            };
            if part.frame == FrameName::Cylindrical {
                return Err(format!(
                    "node {number} is on the axis, where the cylindrical frame has no directions"
                ));
            }
            let image = next.add();
            // The sense of a sector shows beside the axis: any point with its image does.
            let beside = [0, 1, 2].map(|k| at[k] + size * across[k]);
            self.pairs.push(ImagePair {
                rows: [rows, image],
                at: [beside, turned(beside, part.axis, angle)],
            });
            self.axis.push([rows, image]);
        }
        if !self.axis.is_empty() {
            self.facts.push(format!(
                "[model.faces]: {} on the axis, which move along it in diameter 0 and across it in diameter 1 alone",
                crate::texts::counted::counted(self.axis.len(), "node")
            ));
        }
        Ok(())
    }

    /// Nodes of the finer face follow the images of those of the other one.
    fn projected(
        &mut self,
        (part, angle, near): (&FacesPart, f64, f64),
        mut faces: Vec<Face>,
        (nodes, mesh): (&Nodes, &Mesh),
        next: &mut Images,
    ) -> Outcome<()> {
        let rows_of = |face: &Face| -> Outcome<Vec<Option<[i64; 3]>>> {
            let all = face.numbers.iter().map(|number| nodes.of_number(*number));
            all.collect::<Outcome<_>>().map_err(|e| format!("{}: {e}", face.name))
        };
        let moving = |face: &Face| {
            face.numbers
                .iter()
                .filter(|number| nodes.rows_of(**number) != [-1; 3])
                .count()
        };
        let right_follows = moving(&faces[1]) >= moving(&faces[0]);
        let (Some(right), Some(left)) = (faces.pop(), faces.pop()) else {
            return Ok(());
        };
        let (kept, finer, turn) = if right_follows {
            (left, right, angle)
        } else {
            (right, left, -angle)
        };
        let there: HashMap<i64, [f64; 3]> = mesh
            .drawn()
            .iter()
            .flat_map(|element| &element.nodes)
            .map(|number| Ok((*number, turned(mesh.position(*number)?, part.axis, turn))))
            .collect::<Outcome<_>>()?;
        let finer_rows = rows_of(&finer)?;
        let mut images = RowsOf::new();
        for (i, rows) in rows_of(&kept)?.into_iter().enumerate() {
            let (number, Some(rows)) = (kept.numbers[i], rows) else {
                continue;
            };
            let at = turned(kept.at[i], part.axis, turn);
            // Where a fixed node lies at the image, both are one fixed node of the wheel.
            let fixed = (0..finer.at.len()).find(|j| {
                let apart = [0, 1, 2].map(|k| finer.at[*j][k] - at[k]);
                finer_rows[*j].is_none() && norm(&apart) <= near
            });
            if let Some(j) = fixed {
                self.fixed
                    .extend(rows.iter().filter_map(|row| usize::try_from(*row).ok()));
                self.facts.push(format!(
                    "[model.faces]: node {number} is fixed, as its image {} is",
                    finer.numbers[j]
                ));
                continue;
            }
            let image = next.add();
            images.insert(number, image);
            for (image, row) in image.iter().zip(rows).filter(|(_, row)| *row >= 0) {
                self.image_of.insert(*image as u32, row as u32);
            }
            let (rows, at) = if right_follows {
                ([rows, image], [kept.at[i], at])
            } else {
                ([image, rows], [at, kept.at[i]])
            };
            self.pairs.push(ImagePair { rows, at });
        }
        for [number, image] in self.axis_numbers(nodes) {
            images.insert(number[0], image);
        }
        let farthest = self.follow((&kept, &finer, &finer_rows), (&images, &there), (near, nodes, mesh))?;
        self.facts.push(format!(
            "[model.faces]: {} nodes of the {} face follow {} of the {} one by projection, at most {farthest:.3e} away",
            self.follows.len() / 3,
            finer.name,
            images.len(),
            kept.name
        ));
        Ok(())
    }

    /// Number, in the first place, and rows of the image of each node on the axis.
    fn axis_numbers(&self, nodes: &Nodes) -> Vec<[[i64; 3]; 2]> {
        let number = |rows: &[i64; 3]| {
            let row = rows.iter().find_map(|row| usize::try_from(*row).ok());
            row.and_then(|row| nodes.node_of(row))
        };
        let all = self.axis.iter();
        all.filter_map(|[rows, image]| Some([[number(rows)?, 0, 0], *image]))
            .collect()
    }

    /// Weights of images for each node of the finer face; returns the largest distance.
    fn follow(
        &mut self,
        (kept, finer, finer_rows): (&Face, &Face, &[Option<[i64; 3]>]),
        (images, there): (&RowsOf, &HashMap<i64, [f64; 3]>),
        (near, nodes, mesh): (f64, &Nodes, &Mesh),
    ) -> Outcome<f64> {
        let elements: Vec<Vec<i64>> = mesh.drawn().into_iter().map(|element| element.nodes.clone()).collect();
        let bodies = hbvib_io::bodies(&elements);
        let listed: BTreeSet<i64> = kept.numbers.iter().chain(&self.on_axis).copied().collect();
        // Clamped nodes at an edge may be left out of the sets of faces.
        let belongs = |node: &i64| listed.contains(node) || nodes.rows_of(*node) == [-1; 3];
        let moves = |node: &i64| listed.contains(node) && nodes.rows_of(*node) != [-1; 3];
        let mut of_body: BTreeMap<usize, Vec<Vec<i64>>> = BTreeMap::new();
        for face in outer_faces(&elements) {
            if face.iter().all(belongs) && face.iter().any(moves) {
                let body = bodies.get(&face[0]).copied().unwrap_or(usize::MAX);
                of_body.entry(body).or_default().push(face);
            }
        }
        let surfaces: BTreeMap<usize, Surface> = of_body
            .iter()
            .map(|(body, faces)| Ok((*body, Surface::new(faces, &|node| there.get(&node).copied())?)))
            .collect::<Outcome<_>>()?;
        let mut farthest = 0.0_f64;
        for (i, rows) in finer_rows.iter().enumerate() {
            let (number, Some(rows)) = (finer.numbers[i], rows) else {
                continue;
            };
            let body = bodies.get(&number).copied().unwrap_or(usize::MAX);
            let far = || {
                format!(
                    "{}: node {number} is not within {near:.3e} of the turned faces of {} with solid elements: tolerance sets another distance",
                    finer.name, kept.name
                )
            };
            let surface = surfaces.get(&body).ok_or_else(far)?;
            let found = projected_points(&finer.at[i..=i], surface, near);
            let point = found.into_iter().next().flatten().ok_or_else(far)?;
            farthest = farthest.max(point.distance);
            for (direction, row) in rows.iter().enumerate().filter(|(_, row)| **row >= 0) {
                let weights = point.weights.iter();
                // Nodes without an image are fixed.
                let all = weights.filter_map(|(node, w)| Some((u32::try_from(images.get(node)?[direction]).ok()?, *w)));
                self.follows.insert(*row as u32, all.collect());
                self.fixed.push(*row as usize);
            }
        }
        Ok(farthest)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.dofs.is_empty()
    }

    /// A matrix with rows of images.
    pub fn extend(&self, a: &mut Matrix) {
        a.rows += self.dofs.len();
        a.columns += self.dofs.len();
    }

    /// Ties nodes on the axis to their images by stiffness.
    pub fn tie(&self, a: &mut Matrix) {
        let parts = if a.is_complex { 2 } else { 1 };
        let rows: BTreeSet<u32> = self
            .axis
            .iter()
            .flat_map(|[rows, _]| rows)
            .filter_map(|row| u32::try_from(*row).ok())
            .collect();
        let own = a.row.iter().zip(&a.column).zip(a.values.chunks_exact(parts));
        let largest = own
            .filter(|((row, column), _)| row == column && rows.contains(row))
            .fold(0.0_f64, |most, (_, value)| most.max(value[0].abs()));
        let general = a.symmetry == Symmetry::General;
        let mut add = |row: i64, column: i64, value: f64| {
            a.row.push(row as u32);
            a.column.push(column as u32);
            a.values.push(value);
            if parts == 2 {
                a.values.push(0.0);
            }
        };
        for [rows, image] in &self.axis {
            for (row, image) in rows.iter().zip(image).filter(|(row, _)| **row >= 0) {
                add(*row, *row, TIED * largest);
                add(*image, *image, TIED * largest);
                // Images come behind: this is in the lower triangle.
                add(*image, *row, -TIED * largest);
                if general {
                    add(*row, *image, -TIED * largest);
                }
            }
        }
    }
}

/// Rows of images, one node after another behind all others.
struct Images {
    order: usize,
    number: i64,
    dofs: Vec<Dof>,
}

impl Images {
    fn new(nodes: &Nodes, mesh: &Mesh, order: usize) -> Self {
        let last = nodes.numbers().last().copied().unwrap_or(0);
        Self {
            order,
            number: last.max(mesh.last_number()).max(0),
            dofs: Vec::new(),
        }
    }

    /// Rows of a further node.
    fn add(&mut self) -> [i64; 3] {
        self.number += 1;
        let first = (self.order + self.dofs.len()) as i64;
        self.dofs.extend((1..=3).map(|direction| (self.number, direction)));
        [first, first + 1, first + 2]
    }
}
