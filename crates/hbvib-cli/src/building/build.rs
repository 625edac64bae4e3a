//! The model of a job.

use crate::building::at_speeds::at_speeds;
use crate::building::built::Built;
use crate::building::built::Names;
use crate::building::contacts::{Entry, contacts};
use crate::building::dampers::add_dampers;
use crate::building::expected::near;
use crate::building::passed_matrices::with_view;
use crate::job_file::job::Job;
use crate::job_file::job_words::Amplitude;
use crate::meshes::face_images::FaceImages;
use crate::meshes::faces::{self, Sector};
use crate::meshes::mesh::Mesh;
use crate::meshes::node_table::Nodes;
use crate::meshes::surface_pairs::SurfacePairs;
use crate::texts::counted::counted;
use crate::texts::outcome::Outcome;
use hbvib::{Constant, MatrixKind, Model, Speed};
use hbvib_io::{Dof, Files, Matrices, Matrix, Report, Symmetry};
use num_complex::Complex64;
use std::collections::HashMap;
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// Matrices of a job by their kind.
struct Given {
    own: Vec<(MatrixKind, Matrix)>,
    next: Vec<(MatrixKind, Matrix)>,
    /// Node and direction of each degree of freedom, where a file names them.
    dofs: Vec<Dof>,
    report: Report,
}

impl Given {
    /// Adds rows of images, and ties nodes on the axis to theirs.
    fn add(&mut self, images: &FaceImages) {
        for (kind, a) in self.own.iter_mut().chain(&mut self.next) {
            images.extend(a);
            if *kind == MatrixKind::Stiffness {
                images.tie(a);
            }
        }
        self.dofs.extend(&images.dofs);
    }
}

/// The model with its contacts and forces. A contact without a name has its number, from 1.
///
/// # Errors
/// A sentence that names the file, contact or force.
pub fn built(job: &Job) -> Outcome<Built> {
    let part = &job.model;
    let mesh = match &part.mesh {
        Some(path) => Some(Mesh::read(&job.path(path))?),
        None => None,
    };
    let mut given = matrices(job, mesh.as_ref())?;
    let mut nodes = Nodes::new(&given.dofs, mesh, part.absent);
    let images = FaceImages::of(job, &nodes, given.own.first().map_or(0, |(_, a)| a.rows))?;
    if !images.is_empty() {
        given.add(&images);
        nodes.add(&images.dofs);
    }
    let surfaces = SurfacePairs::of(job, (nodes.mesh.as_ref(), &images), &given.dofs)?;
    if let Some(relative) = &surfaces.relative {
        for (_, a) in given.own.iter_mut().chain(&mut given.next) {
            *a = relative.matrix(a).map_err(|e| format!("[[contact]], surfaces: {e}"))?;
        }
    }
    let ndof = given.own.first().map_or(0, |(_, a)| a.rows);
    nodes.relative.clone_from(&surfaces.relative);
    let mut report = given.report.clone();
    expected(job, &mut report);
    let Sector {
        mut model,
        images: image_rows,
        facts,
        fixed,
        pairs: face_pairs,
        dofs: face_dofs,
    } = match &part.faces {
        Some(faces) => faces::sector(job, faces, (ndof, &images), &nodes)?,
        None => Sector::without_faces(Model::cyclic(ndof, part.sectors).map_err(|e| format!("[model]: {e}"))?),
    };
    report.facts.extend(facts);
    let fixed = [&part.fixed[..], &fixed].concat();
    surfaces.check(&fixed, &image_rows, &|row| nodes.name_of(row))?;
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
    let (mut names, mut areas) = add_contacts(job, (&nodes, &image_rows, &surfaces), &mut model, &mut report)?;
    add_dampers(job, &nodes, &mut model, (&mut names, &mut areas))?;
    for one in &job.output.hysteresis {
        one.contact(&names)?;
    }
    add_forces(job, &nodes, &mut model)?;
    let speed = match (part.speed, part.speed_per_omega) {
        (None, None) => None,
        (Some(speed), None) => Some(Speed::Fixed(speed)),
        (None, Some(per_omega)) => Some(Speed::PerOmega(per_omega)),
        (Some(_), Some(_)) => return Err("[model]: names speed and speed_per_omega; needs one of them".into()),
    };
    if let Some(speed) = speed {
        model.set_speed(speed).map_err(|e| format!("[model]: {e}"))?;
    }
    Ok(Built {
        model,
        names,
        nodes,
        areas,
        face_pairs,
        face_dofs,
        fixed,
        stiffness_diagonal: diagonal(&given),
        moved_mass: moved_mass(&given),
        report,
    })
}

/// Real part of the diagonal of the stiffness.
fn diagonal(given: &Given) -> Vec<f64> {
    let stiffness = given.own.iter().find(|(kind, _)| *kind == MatrixKind::Stiffness);
    let Some((_, a)) = stiffness else { return Vec::new() };
    let mut diagonal = vec![0.0; a.rows];
    let parts = if a.is_complex { 2 } else { 1 };
    for (k, v) in a.values.chunks_exact(parts).enumerate() {
        if a.row[k] == a.column[k] {
            diagonal[a.row[k] as usize] += v[0];
        }
    }
    diagonal
}

/// Sum of each row of the mass over the rows of its own direction.
fn moved_mass(given: &Given) -> Vec<f64> {
    let mass = given.own.iter().find(|(kind, _)| *kind == MatrixKind::Mass);
    let Some((_, a)) = mass.filter(|(_, a)| a.rows == given.dofs.len()) else {
        return Vec::new();
    };
    let direction = |row: u32| given.dofs[row as usize].1;
    let mut moved = vec![0.0; a.rows];
    let parts = if a.is_complex { 2 } else { 1 };
    for (k, v) in a.values.chunks_exact(parts).enumerate() {
        let (i, j) = (a.row[k], a.column[k]);
        if direction(i) == direction(j) {
            moved[i as usize] += v[0];
            if i != j && matches!(a.symmetry, Symmetry::Symmetric | Symmetry::Hermitian) {
                moved[j as usize] += v[0];
            }
        }
    }
    moved
}

/// Adds the contacts of a job, and returns their names.
fn add_contacts(
    job: &Job,
    (nodes, images, surfaces): (&Nodes, &HashMap<i64, i64>, &SurfacePairs),
    model: &mut Model,
    report: &mut Report,
) -> Outcome<(Names, Vec<Option<f64>>)> {
    let (mut names, mut areas) = (Names::new(), Vec::new());
    for (i, part) in job.contact.iter().enumerate() {
        let said = |e: &dyn Display| format!("[[contact]] {}: {e}", i + 1);
        let first = model.contacts().len();
        let between = surfaces.of_entry(i);
        let Entry {
            contacts,
            areas: of_entry,
            repeated,
            balance,
        } = contacts((job, part), nodes, images, between).map_err(|e| said(&e))?;
        areas.extend(of_entry);
        if repeated > 0 {
            report.facts.push(said(&format!(
                "left out, as images of pairs of the left face: {}",
                counted(repeated, "pair")
            )));
        }
        for (dof, force) in balance {
            model.add_force(dof, 0, force.into()).map_err(|e| said(&e))?;
        }
        for contact in contacts {
            let id = model.add_contact(&contact).map_err(|e| said(&e))?;
            if part.per_speed2 != 0.0 {
                let preload = contact.constant(Constant::Preload);
                // An area multiplies all of them alike.
                let pairs = [
                    (contact.constant(Constant::Kt), part.kt),
                    (contact.constant(Constant::Kn), part.kn),
                    (preload, part.preload),
                ];
                let given = pairs.into_iter().find(|(_, given)| *given != 0.0);
                let share = given.map_or(1.0, |(of_pair, given)| of_pair / given);
                model
                    .set_preload_at_speed(id, preload, part.per_speed2 * share)
                    .map_err(|e| said(&e))?;
            }
        }
        let name = part.name.clone().unwrap_or_else(|| (i + 1).to_string());
        if names.iter().any(|(other, _)| *other == name) {
            return Err(said(&format!("name = \"{name}\" is that of another one")));
        }
        names.push((name, first..model.contacts().len()));
    }
    Ok((names, areas))
}

/// Adds the forces of a job.
fn add_forces(job: &Job, nodes: &Nodes, model: &mut Model) -> Outcome<()> {
    for (i, force) in job.force.iter().enumerate() {
        let value = match force.value {
            Amplitude::Real(re) => re.into(),
            Amplitude::Complex([re, im]) => Complex64::new(re, im),
        };
        let said = |e: &dyn Display| format!("[[force]] {}: {e}", i + 1);
        // A force on a relative motion acts on those that it is relative to as well.
        for (dof, weight) in nodes.forced(&force.dof).map_err(|e| said(&e))? {
            model
                .add_force(dof, force.harmonic, weight * value)
                .map_err(|e| said(&e))?;
        }
    }
    for (i, one) in job.unbalance.iter().enumerate() {
        nodes
            .refuse_relative([one.dof_x, one.dof_y])
            .map_err(|e| format!("[[unbalance]] {}: {e}", i + 1))?;
        model
            .add_unbalance(one.dof_x, one.dof_y, one.m_e, one.phase)
            .map_err(|e| format!("[[unbalance]] {}: {e}", i + 1))?;
    }
    Ok(())
}

/// Compares the mass with that which the job expects.
fn expected(job: &Job, report: &mut Report) {
    let total = job.model.expected.as_ref().and_then(|part| part.total_mass);
    let Some(total) = total else { return };
    if report.total_mass.is_empty() {
        let reason = "the directions of rows are not known, so that the expected total mass is not compared";
        report.warnings.push(reason.into());
    } else if !report.total_mass.iter().all(|mass| near(*mass, total)) {
        report.warnings.push(format!(
            "the total mass along x, y, z is {:?}, and {total} is expected",
            report.total_mass
        ));
    }
}

/// The matrices of a job as its files have them.
///
/// # Errors
/// A sentence.
pub fn read_matrices(job: &Job) -> Outcome<Matrices> {
    let part = &job.model;
    let files = [
        &part.matrices,
        &part.stiffness,
        &part.mass,
        &part.damping,
        &part.structural,
    ];
    let paths = files.map(|path: &Option<PathBuf>| path.as_ref().map(|path| job.path(path)));
    let [matrices, stiffness, mass, damping, structural] = paths.each_ref().map(Option::as_deref);
    let files = Files {
        matrices,
        stiffness,
        mass,
        damping,
        structural,
    };
    hbvib_io::read_files(&files).map_err(|e| e.to_string())
}

fn matrices(job: &Job, mesh: Option<&Mesh>) -> Outcome<Given> {
    let part = &job.model;
    let mut doubts = Vec::new();
    let mut one = |path: &Path| -> Outcome<(Matrix, Vec<Dof>)> {
        let found = hbvib_io::read(&job.path(path)).map_err(|e| e.to_string())?;
        doubts.extend(found.doubts);
        let held = [found.stiffness, found.mass, found.damping, found.structural];
        let mut held = held.into_iter().flatten();
        match (held.next(), held.next()) {
            (Some(matrix), None) => Ok((matrix, found.dofs)),
            _ => Err(format!(
                "{}: holds several matrices; name it as `matrices`",
                path.display()
            )),
        }
    };
    let (found, of_speed) = if part.at_speed.is_empty() {
        (read_matrices(job)?, None)
    } else {
        let (found, of_speed) = at_speeds(job).map_err(|e| format!("[[model.at_speed]]: {e}"))?;
        (found, Some((MatrixKind::StiffnessSpeed2, of_speed)))
    };
    let position = mesh.map(|mesh| |node: i64| mesh.position(node).ok());
    let positions = position.as_ref().map(|p| p as &dyn Fn(i64) -> Option<[f64; 3]>);
    let report = if part.prestressed || of_speed.is_some() {
        hbvib_io::report_stressed(&found)
    } else {
        hbvib_io::report_with(&found, positions)
    };
    let mut given = Given {
        own: Vec::new(),
        next: Vec::new(),
        report,
        dofs: found.dofs,
    };
    for (kind, matrix) in [
        (MatrixKind::Stiffness, found.stiffness),
        (MatrixKind::Mass, found.mass),
        (MatrixKind::Damping, found.damping),
        (MatrixKind::Structural, found.structural),
    ] {
        given.own.extend(matrix.map(|matrix| (kind, matrix)));
    }
    let order = given.own.first().map(|(_, matrix)| matrix.rows);
    let checked = |path: &Path, (matrix, dofs): (Matrix, Vec<Dof>)| -> Outcome<Matrix> {
        if !dofs.is_empty() && !given.dofs.is_empty() && dofs != given.dofs {
            return Err(format!(
                "{}: names other nodes and directions than the matrices before it",
                path.display()
            ));
        }
        match order {
            Some(n) if (matrix.rows, matrix.columns) != (n, n) => Err(format!(
                "{}: is {} x {}, but stiffness and mass are {n} x {n}: needs matrices of one size",
                path.display(),
                matrix.rows,
                matrix.columns
            )),
            _ => Ok(matrix),
        }
    };
    let mut rotating: Vec<(MatrixKind, Matrix)> = of_speed.into_iter().collect();
    for (kind, path) in [
        (MatrixKind::Gyroscopic, &part.gyroscopic),
        (MatrixKind::StiffnessSpeed2, &part.stiffness_speed2),
    ] {
        if let Some(path) = path {
            rotating.push((kind, checked(path, one(path)?)?));
        }
    }
    let mut next = Vec::new();
    for (kind, path) in [
        (MatrixKind::Stiffness, &part.coupling_stiffness),
        (MatrixKind::Mass, &part.coupling_mass),
        (MatrixKind::Gyroscopic, &part.coupling_gyroscopic),
        (MatrixKind::StiffnessSpeed2, &part.coupling_stiffness_speed2),
    ] {
        if let Some(path) = path {
            next.push((kind, checked(path, one(path)?)?));
        }
    }
    given.own.extend(rotating);
    given.next = next;
    given.report.warnings.extend(doubts);
    if given.own.is_empty() {
        return Err("[model]: names no matrix: needs stiffness and mass, or matrices".into());
    }
    Ok(given)
}
