//! Contacts between surfaces of the mesh, and the coordinates in which each of them is one of a node with the ground.

use crate::job_file::job::Job;
use crate::job_file::job_surfaces::{AreasName, SetNames, SurfaceMethod, SurfacesPart};
use crate::meshes::face_images::FaceImages;
use crate::meshes::mesh::Mesh;
use crate::texts::outcome::Outcome;
use hbvib_io::{
    Dof, NodalAreas, RelativeCoordinates, Surface, SurfaceContact, faces_of_set, node_contacts, outer_faces,
    surface_contacts,
};
use std::collections::{BTreeMap, HashMap, HashSet};

/// Relative difference of weights on both faces of a sector that is rounding of the mesh.
const ROUNDING: f64 = 1e-6;

/// Least sum of weights of nodes that take the area of another one.
const HALF: f64 = 0.5;

/// Contacts between surfaces, by the number of their entry in the job.
#[derive(Default)]
pub struct SurfacePairs {
    of_entry: HashMap<usize, Vec<SurfaceContact>>,
    /// Relative coordinates, where there are such contacts, or nodes that follow images.
    pub relative: Option<RelativeCoordinates>,
    /// Rows that follow images.
    follows: HashSet<usize>,
}

impl SurfacePairs {
    /// The contacts of all entries that name surfaces.
    ///
    /// # Errors
    /// A sentence that names the entry.
    pub fn of(job: &Job, (mesh, images): (Option<&Mesh>, &FaceImages), dofs: &[Dof]) -> Outcome<Self> {
        let mut pairs = Self::default();
        for (i, part) in job.contact.iter().enumerate() {
            let Some(surfaces) = &part.surfaces else { continue };
            let said = |e: String| format!("[[contact]] {}: surfaces: {e}", i + 1);
            let Some(mesh) = mesh else {
                return Err(said("needs a mesh in [model]".into()));
            };
            pairs.of_entry.insert(i, found(surfaces, mesh).map_err(said)?);
        }
        let said = |e: String| format!("[[contact]], surfaces: {e}");
        pairs.share_out(dofs, images).map_err(said)?;
        if !pairs.of_entry.is_empty() {
            let all: Vec<SurfaceContact> = pairs.of_entry.values().flatten().cloned().collect();
            pairs.relative = Some(RelativeCoordinates::new(dofs, &all).map_err(said)?);
        }
        if !images.follows.is_empty() {
            let own = pairs
                .relative
                .take()
                .map_or_else(HashMap::new, |relative| relative.rows().clone());
            pairs.relative = Some(with_images(own, images, dofs.len())?);
            pairs.follows = images.follows.keys().map(|row| *row as usize).collect();
        }
        Ok(pairs)
    }

    /// Contacts of nodes that follow images are those of the nodes whose images they follow, which take their areas.
    fn share_out(&mut self, dofs: &[Dof], images: &FaceImages) -> Outcome<()> {
        if images.follows.is_empty() {
            return Ok(());
        }
        let follows: HashMap<i64, &Vec<(u32, f64)>> = images
            .follows
            .iter()
            .map(|(row, weights)| (dofs[*row as usize].0, weights))
            .collect();
        for contacts in self.of_entry.values_mut() {
            let (follow, mut kept): (Vec<_>, Vec<_>) = contacts
                .drain(..)
                .partition(|contact| follows.contains_key(&contact.node));
            let place: HashMap<i64, usize> = kept.iter().enumerate().map(|(k, contact)| (contact.node, k)).collect();
            for contact in follow {
                let origin = |image: &u32| images.image_of.get(image).map(|row| dofs[*row as usize].0);
                let weights = follows[&contact.node].iter();
                let shares: Vec<(usize, f64)> = weights
                    .filter_map(|(image, w)| Some((*place.get(&origin(image)?)?, *w)))
                    .collect();
                let sum: f64 = shares.iter().map(|(_, w)| w).sum();
                if sum.abs() < HALF {
                    return Err(format!(
                        "node {} is on a face that follows the other one, where no node opposite has a contact",
                        contact.node
                    ));
                }
                for (k, w) in shares {
                    kept[k].area += contact.area * w / sum;
                }
            }
            *contacts = kept;
        }
        Ok(())
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
        for &row in fixed.iter().filter(|row| !self.follows.contains(row)) {
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

/// Relative motions of contacts, and motions that follow images: an image of a relative motion is one of images, and weights of rows that
/// follow images are those of the images.
fn with_images(
    mut relative: HashMap<u32, Vec<(u32, f64)>>,
    images: &FaceImages,
    order: usize,
) -> Outcome<RelativeCoordinates> {
    let said = |e: String| format!("[model.faces]: {e}");
    let image: HashMap<u32, u32> = images.image_of.iter().map(|(image, row)| (*row, *image)).collect();
    for (row, own) in &image {
        let Some(weights) = relative.get(row) else { continue };
        let turned: Option<Vec<(u32, f64)>> = weights
            .iter()
            .map(|(other, w)| Some((*image.get(other)?, *w)))
            .collect();
        let turned = turned.ok_or_else(|| {
            said("a contact between surfaces at the face has partners beside it: method = \"nearest\" takes those on the same edge".into())
        })?;
        relative.insert(*own, turned);
    }
    let spread = |weights: &[(u32, f64)], of: &HashMap<u32, Vec<(u32, f64)>>| -> Vec<(u32, f64)> {
        let mut sums: BTreeMap<u32, f64> = BTreeMap::new();
        for (row, w) in weights {
            match of.get(row) {
                Some(others) if images.follows.contains_key(row) => {
                    for (other, v) in others {
                        *sums.entry(*other).or_default() += w * v;
                    }
                }
                Some(others) => {
                    *sums.entry(*row).or_default() += w;
                    for (other, v) in others {
                        *sums.entry(*other).or_default() += w * v;
                    }
                }
                None => *sums.entry(*row).or_default() += w,
            }
        }
        sums.into_iter().collect()
    };
    // A row that follows relative motions follows what these are relative to as well.
    let follows: HashMap<u32, Vec<(u32, f64)>> = images
        .follows
        .iter()
        .map(|(row, weights)| (*row, spread(weights, &relative)))
        .collect();
    let mut all: HashMap<u32, Vec<(u32, f64)>> = relative
        .iter()
        .map(|(row, weights)| (*row, spread(weights, &follows)))
        .collect();
    all.extend(follows);
    RelativeCoordinates::composed(order, all).map_err(said)
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
