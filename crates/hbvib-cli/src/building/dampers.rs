//! Adds the dampers of a job to its model.

use crate::building::built::Names;
use crate::job_file::job::Job;
use crate::job_file::job_damper::{DamperFacePart, DamperPart};
use crate::job_file::job_words::DofName;
use crate::job_file::job_words::SideDof;
use crate::meshes::node_table::Nodes;
use crate::texts::outcome::Outcome;
use hbvib::{Damper, DamperFace, Model};

/// Adds the dampers behind all degrees of freedom and contacts, and names their contacts.
///
/// # Errors
/// A sentence that names the damper and its face.
pub fn add_dampers(
    job: &Job,
    nodes: &Nodes,
    model: &mut Model,
    (names, areas): (&mut Names, &mut Vec<Option<f64>>),
) -> Outcome<()> {
    for (i, part) in job.damper.iter().enumerate() {
        let said = |e: &dyn std::fmt::Display| format!("[[damper]] {}: {e}", i + 1);
        let faces: Outcome<Vec<DamperFace>> = part
            .face
            .iter()
            .enumerate()
            .map(|(k, face)| damper_face(face, nodes).map_err(|e| said(&format!("face[{k}]: {e}"))))
            .collect();
        let faces = faces?;
        let place = model.add_damper(&damper(part, &faces)).map_err(|e| said(&e))?;
        let name = part.name.clone().unwrap_or_else(|| format!("damper {}", i + 1));
        if names.iter().any(|(other, _)| *other == name) {
            return Err(said(&format!("name = \"{name}\" is that of another one")));
        }
        areas.extend(place.contacts.clone().map(|_| None));
        names.push((name, place.contacts));
    }
    Ok(())
}

fn damper<'a>(part: &DamperPart, faces: &'a [DamperFace]) -> Damper<'a> {
    Damper {
        motions: part.motions,
        mass: part.mass,
        inertia: part.inertia,
        radius: part.radius,
        length: part.length,
        orbit: part.orbit,
        support: part.support,
        support_damping: part.support_damping,
        faces,
    }
}

fn damper_face(part: &DamperFacePart, nodes: &Nodes) -> Outcome<DamperFace> {
    let mut dofs = [None; 3];
    if part.dofs.len() != dofs.len() {
        return Err(format!(
            "dofs has {} entries, needs 3: along x, y and z, -1 for the ground",
            part.dofs.len()
        ));
    }
    for (k, (to, dof)) in dofs.iter_mut().zip(&part.dofs).enumerate() {
        *to = match dof {
            SideDof::Number(-1) => None,
            SideDof::Number(dof) => Some(
                usize::try_from(*dof).map_err(|_| format!("dofs[{k}] = {dof}, needs a degree of freedom, or -1"))?,
            ),
            SideDof::Node(name) => Some(
                nodes
                    .dof(&DofName::Node(name.clone()))
                    .map_err(|e| format!("dofs[{k}]: {e}"))?,
            ),
        };
    }
    nodes.refuse_relative(dofs.into_iter().flatten())?;
    Ok(DamperFace {
        dofs,
        sector_offset: part.sector_offset,
        angle: part.angle,
        turn: part.turn,
        centre: part.centre,
        width: part.width,
        points: [part.points_across, part.points_along],
        stiffness: [part.kt, part.kn],
        mu: part.mu,
        gap: part.gap,
    })
}
