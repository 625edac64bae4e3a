//! The motion in coordinates of modes of the finite-element program, from which it recovers stresses: x ≈ Σ q_k φ_k in each harmonic.
//!
//! The coordinates minimise (x − Φq)ᴴ M (x − Φq). The modes are made orthonormal in the mass first, by Gram and Schmidt, twice.

use crate::building::build::read_matrices;
use crate::building::built::Built;
use crate::job_file::job::Job;
use crate::job_file::job_motion::ModalPart;
use crate::meshes::node_table::Nodes;
use crate::reduction::entries::Entries;
use crate::texts::outcome::Outcome;
use hbvib::{Branch, Special};
use hbvib_io::{NumberArray, Universal};
use num_complex::Complex64;
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

/// Part of a mode that those before it leave, below which it is one of them.
const DEPENDENT: f64 = 1e-7;

/// Modes of another program over the rows of the matrices.
pub struct Modes {
    mass: Entries,
    stiffness: Entries,
    /// Orthonormal in the mass, n each.
    orthonormal: Vec<Vec<Complex64>>,
    /// Upper triangle of Φ = QR, a column for each mode.
    upper: Vec<Vec<Complex64>>,
}

/// One harmonic in modal coordinates.
struct Coordinates {
    q: Vec<Complex64>,
    /// Share of the motion that the modes lack: √(rᴴMr / xᴴMx), and likewise with K.
    lacking: [f64; 2],
}

impl Modes {
    /// Reads the modes that a job names.
    ///
    /// # Errors
    /// A sentence: a file without modes, modes of other nodes, modes that depend on each other.
    pub fn of(job: &Job, part: &ModalPart, nodes: &Nodes) -> Outcome<Self> {
        let found = read_matrices(job)?;
        let (Some(k), Some(m)) = (&found.stiffness, &found.mass) else {
            return Err("needs stiffness and mass".into());
        };
        let path = job.path(&part.modes);
        let is_archive = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("npz"));
        let said = |e: String| format!("{}: {e}", path.display());
        // Sentences of the readers have the file.
        let shapes = if is_archive {
            let all = hbvib_io::read_number_arrays(&path).map_err(|e| e.to_string())?;
            of_archive(&all, k.rows).map_err(said)?
        } else {
            let all = hbvib_io::read_universal(&path).map_err(|e| e.to_string())?;
            of_universal(&all, k.rows, nodes).map_err(said)?
        };
        let mut modes = Self {
            mass: Entries::of("mass", m)?,
            stiffness: Entries::of("stiffness", k)?,
            orthonormal: Vec::new(),
            upper: Vec::new(),
        };
        for (number, shape) in shapes.into_iter().enumerate() {
            modes
                .add(shape)
                .map_err(|e| format!("{}: mode {} {e}", path.display(), number + 1))?;
        }
        Ok(modes)
    }

    /// Adds a mode.
    fn add(&mut self, mut shape: Vec<Complex64>) -> Outcome<()> {
        let mut column = vec![Complex64::ZERO; self.upper.len()];
        let whole = self.mass.energy(&shape).sqrt();
        for _ in 0..2 {
            let (along, rest) = self.projected(&shape);
            for (sum, part) in column.iter_mut().zip(along) {
                *sum += part;
            }
            shape = rest;
        }
        let left = self.mass.energy(&shape).sqrt();
        if !(whole.is_finite() && whole > 0.0) {
            return Err("does not move a mass".into());
        }
        if left <= DEPENDENT * whole {
            return Err("is a sum of those before it".into());
        }
        for z in &mut shape {
            *z /= left;
        }
        column.push(left.into());
        self.orthonormal.push(shape);
        self.upper.push(column);
        Ok(())
    }

    /// Coordinates along the orthonormal modes, and what is left of a motion.
    fn projected(&self, x: &[Complex64]) -> (Vec<Complex64>, Vec<Complex64>) {
        let force = self.mass.times_complex(x);
        let along: Vec<Complex64> = self
            .orthonormal
            .iter()
            .map(|mode| mode.iter().zip(&force).map(|(a, b)| a.conj() * b).sum())
            .collect();
        let mut rest = x.to_vec();
        for (mode, z) in self.orthonormal.iter().zip(&along) {
            for (x, a) in rest.iter_mut().zip(mode) {
                *x -= z * a;
            }
        }
        (along, rest)
    }

    /// Coordinates of a motion of all rows.
    fn coordinates(&self, x: &[Complex64]) -> Coordinates {
        let (mut q, rest) = self.projected(x);
        for k in (0..q.len()).rev() {
            q[k] /= self.upper[k][k];
            for i in 0..k {
                let part = self.upper[k][i] * q[k];
                q[i] -= part;
            }
        }
        let share = |a: &Entries| (a.energy(&rest) / a.energy(x)).sqrt();
        Coordinates {
            q,
            lacking: [share(&self.mass), share(&self.stiffness)],
        }
    }
}

/// Modes of the array `shapes`, a row for each, in the order of the rows of the matrices.
fn of_archive(all: &[NumberArray], n: usize) -> Outcome<Vec<Vec<Complex64>>> {
    let Some(shapes) = all.iter().find(|array| array.name == "shapes") else {
        return Err("has no array shapes: needs one with a row for each mode".into());
    };
    if shapes.shape.len() != 2 || shapes.shape[1] != n || shapes.shape[0] == 0 {
        return Err(format!("shapes is {:?}, needs (modes, {n})", shapes.shape));
    }
    let numbers = (0..shapes.real.len()).map(|i| {
        let imaginary = shapes.imaginary.get(i).copied().unwrap_or(0.0);
        Complex64::new(shapes.real[i], imaginary)
    });
    let numbers: Vec<Complex64> = numbers.collect();
    if !numbers.iter().all(|z| z.is_finite()) {
        return Err("shapes has numbers that are not finite".into());
    }
    Ok(numbers.chunks_exact(n).map(<[_]>::to_vec).collect())
}

/// Shapes (55) of a universal file by node.
fn of_universal(all: &Universal, n: usize, nodes: &Nodes) -> Outcome<Vec<Vec<Complex64>>> {
    if all.shapes.is_empty() {
        return Err("has no shapes (data set 55)".into());
    }
    if nodes.numbers().is_empty() {
        return Err("names nodes, which the matrices do not: needs an .npz with shapes".into());
    }
    let mut modes = Vec::new();
    for (number, shape) in all.shapes.iter().enumerate() {
        let values = shape.values.chunks_exact(shape.per_node.max(1));
        let at: HashMap<i64, &[(f64, f64)]> = shape.nodes.iter().copied().zip(values).collect();
        let mut mode = vec![Complex64::ZERO; n];
        for node in nodes.numbers() {
            let rows = nodes
                .rows_of(node)
                .map(|row| usize::try_from(row).ok().filter(|row| *row < n));
            if rows == [None; 3] {
                continue;
            }
            let Some(values) = at.get(&node) else {
                return Err(format!("mode {} lacks node {node}, which moves", number + 1));
            };
            for (row, value) in rows.into_iter().zip(*values) {
                if let Some(row) = row {
                    mode[row] = Complex64::new(value.0, value.1);
                }
            }
        }
        modes.push(mode);
    }
    Ok(modes)
}

/// Writes the coordinates of each harmonic at points of a branch.
///
/// # Errors
/// Those of the modes, the system and the library.
pub fn write(
    path: &Path,
    (job, part, built): (&Job, &ModalPart, &Built),
    (branch, points): (&Branch, &[Special]),
) -> Outcome<()> {
    let modes = Modes::of(job, part, &built.nodes)?;
    let (count, ndof) = (branch.harmonics() + 1, branch.ndof());
    let n = modes.orthonormal[0].len();
    let mut text = String::from("frequency_hz,amplitude,harmonic,mass_lacking,stiffness_lacking");
    for k in 1..=modes.orthonormal.len() {
        let _ = write!(text, ",re_{k},im_{k}");
    }
    text += "\n";
    let mut x = vec![Complex64::ZERO; count * ndof];
    for special in points {
        branch.harmonics_at(special.point, &mut x).map_err(|e| e.to_string())?;
        for (h, x) in x.chunks_exact_mut(ndof).enumerate() {
            if x.iter().all(|z| *z == Complex64::ZERO) {
                continue;
            }
            if let Some(relative) = &built.nodes.relative {
                relative.recover(x);
            }
            let found = modes.coordinates(&x[..n]);
            let [mass, stiffness] = found.lacking;
            let (hertz, amplitude) = (special.omega / TAU, special.amplitude);
            let _ = write!(text, "{hertz:.16e},{amplitude:.16e},{h},{mass:.6e},{stiffness:.6e}");
            for q in found.q {
                let _ = write!(text, ",{:.16e},{:.16e}", q.re, q.im);
            }
            text += "\n";
        }
    }
    std::fs::write(path, text).map_err(|e| e.to_string())
}
