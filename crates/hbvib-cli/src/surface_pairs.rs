//! Contacts between surfaces of the mesh, and the coordinates in which each of them is one of a node with the ground.

use crate::build::Outcome;
use crate::job::Job;
use crate::job_surfaces::{AreasName, SetNames, SurfaceMethod, SurfacesPart};
use crate::mesh::Mesh;
use hbvib_io::{
    Dof, NodalAreas, RelativeCoordinates, Surface, SurfaceContact, faces_of_set, node_contacts, outer_faces,
    surface_contacts,
};
use std::collections::HashMap;

/// Relative difference of weights on both faces of a sector that is rounding of the mesh.
const ROUNDING: f64 = 1e-6;

/// Contacts between surfaces, by the number of their entry in the job.
#[derive(Default)]
pub struct SurfacePairs {
    of_entry: HashMap<usize, Vec<SurfaceContact>>,
    /// Relative coordinates, where there are such contacts.
    pub relative: Option<RelativeCoordinates>,
}

impl SurfacePairs {
    /// The contacts of all entries that name surfaces.
    ///
    /// # Errors
    /// A sentence that names the entry.
    pub fn of(job: &Job, mesh: Option<&Mesh>, dofs: &[Dof]) -> Outcome<Self> {
        let mut pairs = Self::default();
        for (i, part) in job.contact.iter().enumerate() {
            let Some(surfaces) = &part.surfaces else { continue };
            let said = |e: String| format!("[[contact]] {}: surfaces: {e}", i + 1);
            let Some(mesh) = mesh else {
                return Err(said("needs a mesh in [model]".into()));
            };
            pairs.of_entry.insert(i, found(surfaces, mesh).map_err(said)?);
        }
        if !pairs.of_entry.is_empty() {
            let all: Vec<SurfaceContact> = pairs.of_entry.values().flatten().cloned().collect();
            let relative = RelativeCoordinates::new(dofs, &all).map_err(|e| format!("[[contact]], surfaces: {e}"))?;
            pairs.relative = Some(relative);
        }
        Ok(pairs)
    }

    /// Contacts of an entry.
    pub fn of_entry(&self, entry: usize) -> &[SurfaceContact] {
        self.of_entry.get(&entry).map_or(&[], Vec::as_slice)
    }

    /// Refuses rows that are fixed, or on faces of a sector, and whose partners are not: the relative motion is neither then.
    ///
    /// # Errors
    /// A sentence.
    pub fn check(&self, fixed: &[usize], images: &HashMap<i64, i64>, name: &dyn Fn(usize) -> String) -> Outcome<()> {
        let Some(relative) = &self.relative else { return Ok(()) };
        for &row in fixed {
            let free = relative
                .weights(row)
                .iter()
                .find(|(other, _)| !fixed.contains(&(*other as usize)));
            if let Some((other, _)) = free {
                return Err(format!(
                    "[[contact]], surfaces: {} is fixed, and {} opposite is not: method = \"nearest\" takes partners on the same edge",
                    name(row),
                    name(*other as usize)
                ));
            }
        }
        for (&right, &left) in images {
            let (right, left) = (right as usize, left as usize);
            let image = |(other, weight): &(u32, f64)| Some((*images.get(&i64::from(*other))?, *weight));
            let turned: Option<HashMap<i64, f64>> = relative.weights(right).iter().map(image).collect();
            let own: HashMap<i64, f64> = relative
                .weights(left)
                .iter()
                .map(|(other, w)| (i64::from(*other), *w))
                .collect();
            let same = turned.is_some_and(|turned| {
                let near = |(other, w): (&i64, &f64)| own.get(other).is_some_and(|v| (v - w).abs() <= ROUNDING);
                turned.len() == own.len() && turned.iter().all(near)
            });
            if !same {
                return Err(format!(
                    "[[contact]], surfaces: {} and its image {} have partners that are no images: method = \"nearest\" takes those on the \
                     same edge, where both faces have equal meshes",
                    name(right),
                    name(left)
                ));
            }
        }
        Ok(())
    }
}

fn found(part: &SurfacesPart, mesh: &Mesh) -> Outcome<Vec<SurfaceContact>> {
    let elements: Vec<Vec<i64>> = mesh.drawn().into_iter().map(|element| element.nodes.clone()).collect();
    let solid = mesh.drawn().iter().any(|element| element.shape.is_solid());
    if !solid {
        return Err(format!("{} has no solid elements", mesh.path().display()));
    }
    let faces = outer_faces(&elements);
    let side = |name: &str, sets: &SetNames| -> Outcome<Surface> {
        let mut nodes = Vec::new();
        for set in sets.all() {
            let found = mesh.set(set);
            nodes.extend(
                found.ok_or_else(|| format!("{name}: there is no set \"{set}\" in {}", mesh.path().display()))?,
            );
        }
        let own = faces_of_set(&faces, &nodes);
        Surface::new(&own, &|node| mesh.position(node).ok()).map_err(|e| format!("{name}: {e}"))
    };
    let (a, b) = (side("a", &part.a)?, side("b", &part.b)?);
    let areas = match part.areas {
        AreasName::Consistent => NodalAreas::Consistent,
        AreasName::Positive => NodalAreas::Positive,
    };
    match part.method {
        SurfaceMethod::Nearest => node_contacts(&a, &b, part.largest_distance, areas),
        SurfaceMethod::Mortar => surface_contacts(&a, &b, part.largest_distance, areas),
    }
}
