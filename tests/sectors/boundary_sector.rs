//! A small finite-element sector with both faces: 36 nodes, curved faces, no mirror symmetry.

use crate::common::models::sector_of_faces;
use hbvib::internals::Positions;
use hbvib::{MatrixKind, MatrixView, Model, SectorDescription, SectorFrame};
use nalgebra::DMatrix;
use serde_json::Value;
use std::f64::consts::TAU;

/// Number of sectors.
pub const N: usize = 12;

/// The sector of `tests/data/boundary_sector`.
pub struct BoundarySector {
    pub k: DMatrix<f64>,
    pub m: DMatrix<f64>,
    pub left: Vec<usize>,
    pub right: Vec<usize>,
    pub clamped: Vec<usize>,
    pub coordinates: Vec<[f64; 3]>,
    /// Natural frequencies in Hz of nodal diameters 0, 1, ...
    pub reference: Vec<Vec<f64>>,
    pub frame: SectorFrame,
}

fn text(name: &str) -> String {
    let folder = crate::common::programs::root().join("tests/data/boundary_sector");
    std::fs::read_to_string(folder.join(name)).unwrap()
}

fn matrix(name: &str) -> DMatrix<f64> {
    let text = text(name);
    let mut lines = text.lines().filter(|line| !line.starts_with('%'));
    let n = lines
        .next()
        .unwrap()
        .split_whitespace()
        .next()
        .unwrap()
        .parse()
        .unwrap();
    let mut a = DMatrix::zeros(n, n);
    for line in lines {
        let mut words = line.split_whitespace();
        let mut index = || words.next().unwrap().parse::<usize>().unwrap() - 1;
        let (i, j) = (index(), index());
        let v: f64 = words.next().unwrap().parse().unwrap();
        (a[(i, j)], a[(j, i)]) = (v, v);
    }
    a
}

/// Rotation about z.
pub fn about_z(angle: f64) -> DMatrix<f64> {
    let (s, c) = angle.sin_cos();
    DMatrix::from_row_slice(3, 3, &[c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0])
}

/// Degrees of freedom of nodes.
pub fn dofs(nodes: &[usize]) -> Vec<usize> {
    nodes
        .iter()
        .flat_map(|node| (0..3).map(move |k| 3 * node + k))
        .collect()
}

impl BoundarySector {
    /// Reads the sector; with [`SectorFrame::Cylindrical`] its degrees of freedom are turned into r, θ, z of each node.
    pub fn read(frame: SectorFrame) -> Self {
        let data: Value = serde_json::from_str(&text("sector.json")).unwrap();
        let nodes = |key: &str| -> Vec<usize> {
            let list = data[key].as_array().unwrap();
            list.iter().map(|node| node.as_u64().unwrap() as usize).collect()
        };
        let number = |value: &Value| value.as_f64().unwrap();
        let coordinates: Vec<[f64; 3]> = data["coords"]
            .as_array()
            .unwrap()
            .iter()
            .map(|x| [0, 1, 2].map(|k| number(&x[k])))
            .collect();
        let reference = (0..3).map(|d| {
            let list = data["nf_Hz"][d.to_string()].as_array().unwrap();
            list.iter().map(number).collect()
        });
        let mut sector = Self {
            k: matrix("sector_K.mtx"),
            m: matrix("sector_M.mtx"),
            left: nodes("left_nodes"),
            right: nodes("right_nodes"),
            clamped: nodes("clamped_nodes"),
            reference: reference.collect(),
            coordinates,
            frame,
        };
        if frame == SectorFrame::Cylindrical {
            let q = sector.to_cylindrical();
            sector.k = q.transpose() * &sector.k * &q;
            sector.m = q.transpose() * &sector.m * &q;
        }
        sector
    }

    pub fn ndof(&self) -> usize {
        self.k.nrows()
    }

    /// Directions r, θ, z of all nodes in x, y, z.
    pub fn to_cylindrical(&self) -> DMatrix<f64> {
        let n = self.ndof();
        let mut q = DMatrix::zeros(n, n);
        for (node, x) in self.coordinates.iter().enumerate() {
            q.view_mut((3 * node, 3 * node), (3, 3))
                .copy_from(&about_z(x[1].atan2(x[0])));
        }
        q
    }

    /// The model, from a description that `change` may alter.
    pub fn try_model(
        &self,
        engine_order: i64,
        change: impl FnOnce(&mut SectorDescription<'_>),
    ) -> hbvib::Result<Model> {
        self.try_placed(engine_order, None, change)
    }

    /// The same with the positions of the nodes of both faces.
    pub fn try_placed(
        &self,
        engine_order: i64,
        coordinates: Option<(Positions<'_>, Positions<'_>)>,
        change: impl FnOnce(&mut SectorDescription<'_>),
    ) -> hbvib::Result<Model> {
        let [left, right] = [&self.left, &self.right].map(|face| dofs(face).into_iter().map(Some).collect::<Vec<_>>());
        let fixed = dofs(&self.clamped);
        let mut description = SectorDescription {
            engine_order,
            fixed: &fixed,
            frame: self.frame,
            coordinates,
            ..sector_of_faces(self.ndof(), N, [&left, &right])
        };
        change(&mut description);
        let mut model = Model::sector(&description)?;
        for (kind, a) in [(MatrixKind::Stiffness, &self.k), (MatrixKind::Mass, &self.m)] {
            model.set_matrix(kind, &MatrixView::dense(self.ndof(), a.as_slice()))?;
        }
        Ok(model)
    }

    pub fn model(&self, engine_order: i64) -> Model {
        self.try_model(engine_order, |_| ()).unwrap()
    }

    pub fn positions(&self, nodes: &[usize]) -> Vec<[f64; 3]> {
        nodes.iter().map(|&node| self.coordinates[node]).collect()
    }

    /// Where node of sector `s` stands among the moving nodes of the merged wheel; `None` if it is clamped.
    fn merged(&self, s: usize, node: usize) -> Option<usize> {
        let (s, node) = match self.right.iter().position(|&r| r == node) {
            Some(pair) => ((s + 1) % N, self.left[pair]),
            None => (s, node),
        };
        let own: Vec<usize> = (0..self.ndof() / 3)
            .filter(|node| !self.right.contains(node) && !self.clamped.contains(node))
            .collect();
        own.iter().position(|&n| n == node).map(|at| s * own.len() + at)
    }

    /// K and M of the merged wheel in fixed axes, from the Cartesian sector turned N times; `springs` lists (node,
    /// sector offset, node, direction in the axes of the first, stiffness) in every sector.
    pub fn wheel(&self, springs: &[(usize, usize, usize, [f64; 3], f64)]) -> (DMatrix<f64>, DMatrix<f64>) {
        assert_eq!(self.frame, SectorFrame::Cartesian);
        let nodes = self.ndof() / 3;
        let moving = (0..nodes)
            .filter(|n| !self.right.contains(n) && !self.clamped.contains(n))
            .count();
        let order = 3 * moving * N;
        let (mut k, mut m) = (DMatrix::zeros(order, order), DMatrix::zeros(order, order));
        for s in 0..N {
            let turn = about_z(TAU * s as f64 / N as f64);
            let place: Vec<_> = (0..nodes).map(|node| self.merged(s, node)).collect();
            for (i, p) in place.iter().enumerate() {
                for (j, q) in place.iter().enumerate() {
                    let (Some(p), Some(q)) = (p, q) else { continue };
                    for (to, from) in [(&mut k, &self.k), (&mut m, &self.m)] {
                        let block = &turn * from.view((3 * i, 3 * j), (3, 3)) * turn.transpose();
                        let mut view = to.view_mut((3 * p, 3 * q), (3, 3));
                        view += block;
                    }
                }
            }
            for (a, offset, b, direction, stiffness) in springs {
                let direction = &turn * DMatrix::from_column_slice(3, 1, direction);
                let sides = [(place[*a], 1.0), (self.merged((s + offset) % N, *b), -1.0)];
                for (p, x) in sides {
                    for (q, y) in sides {
                        let (Some(p), Some(q)) = (p, q) else { continue };
                        let mut view = k.view_mut((3 * p, 3 * q), (3, 3));
                        view += &direction * direction.transpose() * (x * y * *stiffness);
                    }
                }
            }
        }
        (k, m)
    }
}
