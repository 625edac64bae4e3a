//! A beam of bricks, clamped at x = 0, with friction between its underside and the ground near the free end.
//!
//! x runs along the beam, y upwards, z across. Between beam and ground lies a soft friction lining: per unit of
//! area it has the stiffnesses kt and kn, and it has a static load by the approach of the ground and by a constant
//! force from above.

#![allow(dead_code, reason = "the tests and another example use a part of this module")]

use std::collections::BTreeMap;

use hbvib::contact::Contact;
use hbvib::contact::patch::Patch;
use hbvib::error::Result;
use hbvib::linalg::matrix_view::{MatrixView, Part, Storage, Values};
use hbvib::model::Model;
use hbvib::model::spring::Spring;
use hbvib::model::structure::MatrixKind;
use num_complex::Complex64;

use crate::brick::{self, Material};

/// Upward direction of the degrees of freedom of a node.
pub const Y: usize = 1;
/// Direction across the beam.
pub const Z: usize = 2;

/// Steel.
pub const STEEL: Material = Material {
    young: 2.1e11,
    poisson: 0.3,
    density: 7850.0,
};

/// The beam with its lining; all units SI.
#[derive(Clone, Copy, Debug)]
pub struct Beam {
    /// Length, height and width.
    pub size: [f64; 3],
    /// Number of elements along them.
    pub elements: [usize; 3],
    /// First and last row of nodes along x whose undersides touch the ground.
    pub rows: [usize; 2],
    /// Tangential and normal stiffness of the lining, N/m per m².
    pub stiffness: (f64, f64),
    /// Friction coefficient.
    pub friction: f64,
    /// Pressure of the lining under the undeformed beam, Pa.
    pub pressure: f64,
    /// Constant load from above, spread over the patch, N.
    pub load: f64,
    /// Damping C = `damping`·K of the beam, s.
    pub damping: f64,
}

impl Default for Beam {
    fn default() -> Self {
        Self {
            size: [0.2, 0.01, 0.02],
            elements: [12, 1, 2],
            rows: [8, 12],
            stiffness: (5e8, 1.5e9),
            friction: 0.4,
            pressure: 4e4,
            load: 6.0,
            damping: 5e-6,
        }
    }
}

/// A node of the patch.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    /// Position along the beam, m.
    pub x: f64,
    /// Position across, m.
    pub z: f64,
    /// Area of the patch that belongs to the node, m².
    pub area: f64,
    /// First degree of freedom of the node.
    pub dof: usize,
}

impl Beam {
    /// First degree of freedom of the node with numbers (x, y, z); `None` at the clamp.
    pub fn dof(&self, [x, y, z]: [usize; 3]) -> Option<usize> {
        let [_, ny, nz] = self.elements;
        let row = x.checked_sub(1)?;
        Some(3 * ((row * (ny + 1) + y) * (nz + 1) + z))
    }

    /// Degrees of freedom.
    pub fn ndof(&self) -> usize {
        let [nx, ny, nz] = self.elements;
        3 * nx * (ny + 1) * (nz + 1)
    }

    /// Lengths of the edges of an element.
    fn edges(&self) -> [f64; 3] {
        std::array::from_fn(|k| self.size[k] / self.elements[k] as f64)
    }

    /// The nodes of the patch, the index across the beam running fastest.
    pub fn spots(&self) -> Vec<Spot> {
        let [dx, _, dz] = self.edges();
        let ([first, last], nz) = (self.rows, self.elements[2]);
        // Nodes at a border of the patch represent half an element.
        let share = |i: usize, ends: [usize; 2]| if ends.contains(&i) { 0.5 } else { 1.0 };
        let all = (first..=last).flat_map(|i| (0..=nz).map(move |k| (i, k)));
        let spot = |(i, k): (usize, usize)| {
            Some(Spot {
                x: i as f64 * dx,
                z: (k as f64 - 0.5 * nz as f64) * dz,
                area: share(i, self.rows) * share(k, [0, nz]) * dx * dz,
                dof: self.dof([i, 0, k])?,
            })
        };
        all.filter_map(spot).collect()
    }

    /// The two nodes in the middle of the upper edge at the free end (one where they coincide), at which the
    /// harmonic force acts.
    pub fn tips(&self) -> Vec<usize> {
        let [nx, ny, nz] = self.elements;
        let mut tips: Vec<usize> = [nz / 2, nz.div_ceil(2)]
            .into_iter()
            .filter_map(|z| self.dof([nx, ny, z]))
            .collect();
        tips.dedup();
        tips
    }

    /// The beam alone.
    pub fn structure(&self) -> Result<Model> {
        let size = self.edges();
        let mut model = Model::new(self.ndof())?;
        for (kind, of_element) in [
            (MatrixKind::Stiffness, brick::stiffness(size, &STEEL)),
            (MatrixKind::Mass, brick::mass(size, &STEEL)),
        ] {
            self.assemble(&of_element).give(&mut model, kind)?;
        }
        model.set_rayleigh(0.0, self.damping)?;
        Ok(model)
    }

    fn assemble(&self, of_element: &brick::Matrix) -> Sparse {
        let [nx, ny, nz] = self.elements;
        let mut entries = BTreeMap::new();
        for element in 0..nx * ny * nz {
            let (x, y, z) = (element / (ny * nz), element / nz % ny, element % nz);
            let corner = |c: usize| self.dof([x + (c & 1), y + (c >> 1 & 1), z + (c >> 2 & 1)]);
            for (j, column) in of_element.iter().enumerate() {
                let Some(to) = corner(j / 3) else { continue };
                for (i, value) in column.iter().enumerate() {
                    if let Some(from) = corner(i / 3) {
                        *entries.entry((to + j % 3, from + i % 3)).or_insert(0.0) += value;
                    }
                }
            }
        }
        Sparse {
            order: self.ndof(),
            entries,
        }
    }

    /// The contacts of the patch: t1 across the beam, t2 along it, n upwards, from the ground to the beam.
    pub fn contacts(&self) -> Result<Vec<Contact>> {
        let (kt, kn) = self.stiffness;
        let law = Contact::friction_3d([None; 3], [None; 3], (kt, kn), self.friction, self.pressure);
        let spots = self.spots();
        let dofs: Vec<_> = spots.iter().map(|s| [0, 1, 2].map(|k| Some(s.dof + k))).collect();
        let area: Vec<f64> = spots.iter().map(|s| s.area).collect();
        Patch {
            law: &law,
            dof_a: &dofs,
            dof_b: None,
            normal: &vec![[0.0, 1.0, 0.0]; spots.len()],
            tangent: Some(&vec![[0.0, 0.0, 1.0]; spots.len()]),
            area: &area,
            pressure: None,
            gap: None,
        }
        .contacts()
    }

    /// The beam on its lining, without loads.
    pub fn on_lining(&self) -> Result<Model> {
        let mut model = self.structure()?;
        model.add_contacts(&self.contacts()?)?;
        Ok(model)
    }

    /// The beam on its lining under the constant load and a harmonic force: `force` across the beam and
    /// `upward_share` times that upwards.
    pub fn forced(&self, force: f64, upward_share: f64) -> Result<Model> {
        let mut model = self.on_lining()?;
        self.excite(&mut model, force, upward_share)?;
        let above = self.elements[1];
        let spots = self.spots();
        let whole: f64 = spots.iter().map(|s| s.area).sum();
        // The node above one of the underside has the same numbers along x and z.
        let up = 3 * above * (self.elements[2] + 1);
        for spot in &spots {
            model.add_force(spot.dof + up + Y, 0, Complex64::from(-self.load * spot.area / whole))?;
        }
        Ok(model)
    }

    /// The linear limit under the harmonic force, with springs in place of the lining: for vanishing motion
    /// (`sticks`), or for motion so large that friction is negligible.
    pub fn linear(&self, sticks: bool, force: f64, upward_share: f64) -> Result<Model> {
        let mut model = self.sprung(sticks)?;
        self.excite(&mut model, force, upward_share)?;
        Ok(model)
    }

    /// The beam on springs along its normal and, if it `sticks`, along the ground.
    pub fn sprung(&self, sticks: bool) -> Result<Model> {
        let mut model = self.structure()?;
        let (kt, kn) = self.stiffness;
        for spot in self.spots() {
            for (k, stiffness) in [kt, kn, kt].into_iter().enumerate() {
                if sticks || k == Y {
                    model.add_spring(&Spring {
                        dof_a: Some(spot.dof + k),
                        dof_b: None,
                        sector_offset: 0,
                        stiffness: stiffness * spot.area,
                    })?;
                }
            }
        }
        Ok(model)
    }

    fn excite(&self, model: &mut Model, force: f64, upward_share: f64) -> Result<()> {
        let tips = self.tips();
        for &tip in &tips {
            let part = force / tips.len() as f64;
            model.add_force(tip + Z, 1, part.into())?;
            model.add_force(tip + Y, 1, (upward_share * part).into())?;
        }
        Ok(())
    }

    /// Work per cycle of the harmonic force, −π Re(F) Im(X) summed over its degrees of freedom, for the fundamental
    /// of all degrees of freedom.
    pub fn work_of_force(&self, fundamental: &[Complex64], force: f64, upward_share: f64) -> f64 {
        let tips = self.tips();
        let part = force / tips.len() as f64;
        let one = |tip: &usize| part * (fundamental[tip + Z].im + upward_share * fundamental[tip + Y].im);
        -std::f64::consts::PI * tips.iter().map(one).sum::<f64>()
    }
}

/// A sparse matrix by column and row.
struct Sparse {
    order: usize,
    entries: BTreeMap<(usize, usize), f64>,
}

impl Sparse {
    fn give(&self, model: &mut Model, kind: MatrixKind) -> Result<()> {
        let mut col_ptr = vec![0_i64; self.order + 1];
        for (column, _) in self.entries.keys() {
            col_ptr[column + 1] += 1;
        }
        for j in 0..self.order {
            col_ptr[j + 1] += col_ptr[j];
        }
        let row_idx: Vec<i64> = self.entries.keys().map(|e| e.1 as i64).collect();
        let values: Vec<f64> = self.entries.values().copied().collect();
        let view = MatrixView {
            rows: self.order,
            cols: self.order,
            storage: Storage::Csc {
                col_ptr: &col_ptr,
                row_idx: &row_idx,
            },
            values: Values::Real(&values),
            part: Part::Full,
            index_base: 0,
        };
        model.set_matrix(kind, &view)
    }
}
