//! A cantilever plate of structured bricks, clamped at x = 0, as a model of any size.
#![allow(dead_code, reason = "each program uses a part of this module")]

use crate::brick::{self, Material};
use hbvib::{Contact, MatrixKind, MatrixView, Model, Part, Result, Storage, Values};
use num_complex::Complex64;

const STEEL: Material = Material {
    young: 2.1e11,
    poisson: 0.3,
    density: 7850.0,
};

/// A plate with edges along x, y, z.
#[derive(Clone, Copy, Debug)]
pub struct Plate {
    /// Elements along each edge.
    pub elements: [usize; 3],
    /// Length of each edge in m.
    pub size: [f64; 3],
}

impl Plate {
    /// A plate 1 m × 0.7 m × 0.02 m.
    pub fn new(elements: [usize; 3]) -> Self {
        Self {
            elements,
            size: [1.0, 0.7, 0.02],
        }
    }

    /// Degrees of freedom, three per node that is not clamped.
    pub fn ndof(&self) -> usize {
        let [x, y, z] = self.elements;
        3 * x * (y + 1) * (z + 1)
    }

    /// Degree of freedom of a node in a direction; the first index of the node is at least 1.
    pub fn dof(&self, [x, y, z]: [usize; 3], direction: usize) -> usize {
        let [_, ny, nz] = self.elements;
        3 * (((x - 1) * (ny + 1) + y) * (nz + 1) + z) + direction
    }

    /// Lower triangles of stiffness and mass as compressed columns: offsets, rows, values of both.
    pub fn matrices(&self) -> (Vec<i64>, Vec<i64>, [Vec<f64>; 2]) {
        let edges = [0, 1, 2].map(|k| self.size[k] / self.elements[k] as f64);
        let (k, m) = (brick::stiffness(edges, &STEEL), brick::mass(edges, &STEEL));
        let [nx, ny, nz] = self.elements;
        let n = self.ndof();
        let (mut offsets, mut rows) = (vec![0], Vec::new());
        let mut values = [Vec::new(), Vec::new()];
        let mut column = vec![[0.0; 2]; n];
        // One node after the other: the elements around it give its columns.
        for x in 1..=nx {
            for y in 0..=ny {
                for z in 0..=nz {
                    for direction in 0..3 {
                        let j = self.dof([x, y, z], direction);
                        let mut touched = Vec::new();
                        for corner in 0..8 {
                            let at = [x, y, z].map(|p| p as i64);
                            let origin = [0, 1, 2].map(|e| at[e] - ((corner >> e) & 1) as i64);
                            if (0..3).any(|e| origin[e] < 0 || origin[e] >= self.elements[e] as i64) {
                                continue;
                            }
                            for other in 0..8 {
                                let node = [0, 1, 2].map(|e| (origin[e] + ((other >> e) & 1) as i64) as usize);
                                if node[0] == 0 {
                                    continue;
                                }
                                for of in 0..3 {
                                    let i = self.dof(node, of);
                                    if i >= j {
                                        let (p, q) = (3 * other + of, 3 * corner + direction);
                                        column[i][0] += k[p][q];
                                        column[i][1] += m[p][q];
                                        touched.push(i);
                                    }
                                }
                            }
                        }
                        touched.sort_unstable();
                        touched.dedup();
                        for i in touched {
                            rows.push(i as i64);
                            for (values, entry) in values.iter_mut().zip(column[i]) {
                                values.push(entry);
                            }
                            column[i] = [0.0; 2];
                        }
                        offsets.push(rows.len() as i64);
                    }
                }
            }
        }
        (offsets, rows, values)
    }

    /// The plate as a model with stiffness-proportional damping, without contacts and forces.
    ///
    /// # Errors
    /// Those of the model.
    pub fn model(&self, beta: f64) -> Result<Model> {
        let mut model = Model::new(self.ndof())?;
        self.give_matrices(&mut model)?;
        model.set_rayleigh(0.0, beta)?;
        Ok(model)
    }

    /// Gives stiffness and mass to a model of as many degrees of freedom.
    ///
    /// # Errors
    /// Those of the model.
    pub fn give_matrices(&self, model: &mut Model) -> Result<()> {
        let n = self.ndof();
        let (offsets, rows, [k, m]) = self.matrices();
        for (kind, values) in [(MatrixKind::Stiffness, &k), (MatrixKind::Mass, &m)] {
            let view = MatrixView {
                rows: n,
                cols: n,
                storage: Storage::Csc {
                    col_ptr: &offsets,
                    row_idx: &rows,
                },
                values: Values::Real(values),
                part: Part::Lower,
                index_base: 0,
            };
            model.set_matrix(kind, &view)?;
        }
        Ok(())
    }

    /// `count` sliders to the ground, transverse, at the end x = 1 and the middle in turn.
    pub fn sliders(&self, count: usize, stiffness: f64, limit: f64) -> Vec<Contact> {
        let slider = |dof| Contact::jenkins(dof, None, stiffness, limit, 1.0);
        self.places_of_sliders(count).into_iter().map(slider).collect()
    }

    /// Their degrees of freedom.
    pub fn places_of_sliders(&self, count: usize) -> Vec<usize> {
        let [nx, ny, _] = self.elements;
        let place = |i: usize| {
            let x = if i.is_multiple_of(2) { nx } else { (3 * nx).div_ceil(5) };
            [x, (i / 2 * ny * 2 / count.max(1)).min(ny), 0]
        };
        (0..count).map(|i| self.dof(place(i), 2)).collect()
    }

    /// The degree of freedom at a free corner that is excited and observed.
    pub fn corner(&self) -> usize {
        let [nx, ny, nz] = self.elements;
        self.dof([nx, ny, nz], 2)
    }

    /// The plate with sliders and a transverse force of 1 N at the corner.
    ///
    /// # Errors
    /// Those of the model.
    pub fn with_sliders(&self, count: usize, stiffness: f64, limit: f64) -> Result<Model> {
        let mut model = self.model(2e-6)?;
        model.add_contacts(&self.sliders(count, stiffness, limit))?;
        model.add_force(self.corner(), 1, Complex64::ONE)?;
        Ok(model)
    }
}
