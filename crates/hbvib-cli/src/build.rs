//! The model of a job.

use crate::contacts::contacts;
use crate::faces;
use crate::job::{Amplitude, Job};
use crate::mesh::Mesh;
use crate::node_table::Nodes;
use hbvib::{MatrixKind, MatrixView, Model, Part, Speed, Storage, Values};
use hbvib_io::{Dof, Matrix, Symmetry};
use num_complex::Complex64;
use std::fmt::Display;
use std::ops::Range;
use std::path::Path;

/// A sentence.
pub type Outcome<T> = Result<T, String>;

/// Matrices of a job by their kind.
struct Given {
    own: Vec<(MatrixKind, Matrix)>,
    next: Vec<(MatrixKind, Matrix)>,
    /// Node and direction of each degree of freedom, where a file names them.
    dofs: Vec<Dof>,
}

/// Numbers of the model's contacts for each entry of the job: its name, and a range.
pub type Names = Vec<(String, Range<usize>)>;

/// The model of a job.
pub struct Built {
    pub model: Model,
    /// Names of its contacts.
    pub names: Names,
    pub nodes: Nodes,
}

/// The model with its contacts and forces. A contact without a name has its number, from 1.
///
/// # Errors
/// A sentence that names the file, contact or force.
pub fn built(job: &Job) -> Outcome<Built> {
    let given = matrices(job)?;
    let ndof = given.own.first().map_or(0, |(_, a)| a.rows);
    let part = &job.model;
    let mesh = match &part.mesh {
        Some(path) => Some(Mesh::read(&job.path(path))?),
        None => None,
    };
    let nodes = Nodes::new(&given.dofs, mesh);
    let mut model = match &part.faces {
        Some(faces) => faces::sector(job, faces, ndof, &nodes)?,
        None => Model::cyclic(ndof, part.sectors).map_err(|e| format!("[model]: {e}"))?,
    };
    model.set_wave(part.engine_order);
    if part.faces.is_none() && !part.fixed.is_empty() {
        model.fix(&part.fixed).map_err(|e| format!("[model]: {e}"))?;
    }
    for (kind, a) in &given.own {
        with_view(a, |view| model.set_matrix(*kind, view)).map_err(|e| format!("[model]: {e}"))?;
    }
    for (kind, a) in &given.next {
        with_view(a, |view| model.set_coupling(*kind, view)).map_err(|e| format!("[model], coupling: {e}"))?;
    }
    if let Some([alpha, beta]) = part.rayleigh {
        model.set_rayleigh(alpha, beta).map_err(|e| format!("[model]: {e}"))?;
    }
    if let Some(loss_factor) = part.loss_factor {
        model
            .set_loss_factor(loss_factor)
            .map_err(|e| format!("[model]: {e}"))?;
    }
    model
        .set_modal_damping(&part.modal_damping)
        .map_err(|e| format!("[model], modal_damping: {e}"))?;
    let mut names = Names::new();
    for (i, part) in job.contact.iter().enumerate() {
        let said = |e: &dyn Display| format!("[[contact]] {}: {e}", i + 1);
        let first = model.contacts().len();
        for contact in contacts(job, part, &nodes).map_err(|e| said(&e))? {
            let id = model.add_contact(&contact).map_err(|e| said(&e))?;
            if part.per_speed2 != 0.0 {
                // An area multiplies all of them alike.
                let pairs = [
                    (contact.kt, part.kt),
                    (contact.kn, part.kn),
                    (contact.preload, part.preload),
                ];
                let given = pairs.into_iter().find(|(_, given)| *given != 0.0);
                let share = given.map_or(1.0, |(of_pair, given)| of_pair / given);
                model
                    .set_preload_at_speed(id, contact.preload, part.per_speed2 * share)
                    .map_err(|e| said(&e))?;
            }
        }
        let name = part.name.clone().unwrap_or_else(|| (i + 1).to_string());
        if names.iter().any(|(other, _)| *other == name) {
            return Err(said(&format!("name = \"{name}\" is that of another one")));
        }
        names.push((name, first..model.contacts().len()));
    }
    for one in &job.output.hysteresis {
        one.contact(&names)?;
    }
    for (i, force) in job.force.iter().enumerate() {
        let value = match force.value {
            Amplitude::Real(re) => re.into(),
            Amplitude::Complex([re, im]) => Complex64::new(re, im),
        };
        let said = |e: &dyn Display| format!("[[force]] {}: {e}", i + 1);
        let dof = nodes.dof(&force.dof).map_err(|e| said(&e))?;
        model.add_force(dof, force.harmonic, value).map_err(|e| said(&e))?;
    }
    for (i, one) in job.unbalance.iter().enumerate() {
        model
            .add_unbalance(one.dof_x, one.dof_y, one.m_e, one.phase)
            .map_err(|e| format!("[[unbalance]] {}: {e}", i + 1))?;
    }
    let speed = match (part.speed, part.speed_per_omega) {
        (None, None) => None,
        (Some(speed), None) => Some(Speed::Fixed(speed)),
        (None, Some(per_omega)) => Some(Speed::PerOmega(per_omega)),
        (Some(_), Some(_)) => return Err("[model]: names speed and speed_per_omega; needs one of them".into()),
    };
    if let Some(speed) = speed {
        model.set_speed(speed).map_err(|e| format!("[model]: {e}"))?;
    }
    Ok(Built { model, names, nodes })
}

fn matrices(job: &Job) -> Outcome<Given> {
    let part = &job.model;
    let one = |path: &Path| -> Outcome<(Matrix, Vec<Dof>)> {
        let found = hbvib_io::read(&job.path(path)).map_err(|e| e.to_string())?;
        let held = [found.stiffness, found.mass, found.damping];
        let mut held = held.into_iter().flatten();
        match (held.next(), held.next()) {
            (Some(matrix), None) => Ok((matrix, found.dofs)),
            _ => Err(format!(
                "{}: holds several matrices; name it as `matrices`",
                path.display()
            )),
        }
    };
    let mut given = Given {
        own: Vec::new(),
        next: Vec::new(),
        dofs: Vec::new(),
    };
    if let Some(path) = &part.matrices {
        let found = hbvib_io::read(&job.path(path)).map_err(|e| e.to_string())?;
        let kinds = [MatrixKind::Stiffness, MatrixKind::Mass, MatrixKind::Damping];
        for (kind, matrix) in kinds.into_iter().zip([found.stiffness, found.mass, found.damping]) {
            given.own.extend(matrix.map(|matrix| (kind, matrix)));
        }
        given.dofs = found.dofs;
    }
    for (kind, path) in [
        (MatrixKind::Stiffness, &part.stiffness),
        (MatrixKind::Mass, &part.mass),
        (MatrixKind::Damping, &part.damping),
        (MatrixKind::Structural, &part.structural),
        (MatrixKind::Gyroscopic, &part.gyroscopic),
        (MatrixKind::StiffnessSpeed2, &part.stiffness_speed2),
    ] {
        if let Some(path) = path {
            given.own.retain(|(other, _)| *other != kind);
            let (matrix, dofs) = one(path)?;
            if given.dofs.is_empty() {
                given.dofs = dofs;
            } else if !dofs.is_empty() && dofs != given.dofs {
                return Err(format!(
                    "{}: names other nodes and directions than the matrices before it",
                    path.display()
                ));
            }
            given.own.push((kind, matrix));
        }
    }
    for (kind, path) in [
        (MatrixKind::Stiffness, &part.coupling_stiffness),
        (MatrixKind::Mass, &part.coupling_mass),
        (MatrixKind::Gyroscopic, &part.coupling_gyroscopic),
        (MatrixKind::StiffnessSpeed2, &part.coupling_stiffness_speed2),
    ] {
        if let Some(path) = path {
            given.next.push((kind, one(path)?.0));
        }
    }
    if given.own.is_empty() {
        return Err("[model]: names no matrix: needs stiffness and mass, or matrices".into());
    }
    Ok(given)
}

/// Passes a matrix as compressed columns, all entries of it.
fn with_view<R>(a: &Matrix, take: impl FnOnce(&MatrixView<'_>) -> R) -> R {
    let parts = if a.is_complex { 2 } else { 1 };
    let mut entries: Vec<(u32, u32, Complex64)> = Vec::with_capacity(2 * a.entries());
    for (k, v) in a.values.chunks_exact(parts).enumerate() {
        let (i, j) = (a.row[k], a.column[k]);
        let v = Complex64::new(v[0], v.get(1).copied().unwrap_or(0.0));
        entries.push((i, j, v));
        if i != j {
            match a.symmetry {
                Symmetry::General => {}
                Symmetry::Symmetric => entries.push((j, i, v)),
                Symmetry::Hermitian => entries.push((j, i, v.conj())),
                Symmetry::Skew => entries.push((j, i, -v)),
            }
        }
    }
    entries.sort_unstable_by_key(|&(i, j, _)| (j, i));
    let mut col_ptr = vec![0_i64; a.columns + 1];
    for &(_, j, _) in &entries {
        col_ptr[j as usize + 1] += 1;
    }
    for j in 0..a.columns {
        col_ptr[j + 1] += col_ptr[j];
    }
    let row_idx: Vec<i64> = entries.iter().map(|&(i, ..)| i64::from(i)).collect();
    let real: Vec<f64> = entries.iter().map(|(_, _, v)| v.re).collect();
    let complex: Vec<Complex64> = entries.iter().map(|(_, _, v)| *v).collect();
    take(&MatrixView {
        rows: a.rows,
        cols: a.columns,
        storage: Storage::Csc {
            col_ptr: &col_ptr,
            row_idx: &row_idx,
        },
        values: if a.is_complex {
            Values::Complex(&complex)
        } else {
            Values::Real(&real)
        },
        part: match a.symmetry {
            Symmetry::Skew => Part::General,
            Symmetry::Symmetric => Part::Symmetric,
            Symmetry::General | Symmetry::Hermitian => Part::Full,
        },
        index_base: 0,
    })
}
