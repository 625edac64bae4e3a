//! The contacts of a job.

use crate::job_file::job::{ContactPart, Job, NodesPart};
use crate::job_file::job_static::{MissingName, StaticPart};
use crate::job_file::job_words::DofName;
use crate::job_file::job_words::KindName;
use crate::job_file::job_words::Node;
use crate::job_file::job_words::NodeList;
use crate::job_file::job_words::SideDof;
use crate::meshes::mesh::Mesh;
use crate::meshes::node_match::{Positioned, pairs};
use crate::meshes::node_table::{Nodes, node_list, positions};
use crate::meshes::normals;
use crate::static_steps::static_states::static_states;
use crate::texts::outcome::Outcome;
use hbvib::{Constant, Contact, ContactKind, Cubic, Frame, Friction2d, Friction3d, Jenkins, Regularised, Unilateral};
use hbvib_io::SurfaceContact;
use std::collections::{HashMap, HashSet};

/// Degrees of freedom of all pairs of an entry, those of one pair after another, and their areas.
struct Pairs {
    a: Vec<i64>,
    b: Vec<i64>,
    areas: Vec<f64>,
    /// Normal of each pair, from side b to side a, where surfaces tell it.
    normals: Vec<[f64; 3]>,
    /// Gap of each pair beside that of the entry, likewise.
    gaps: Vec<f64>,
}

/// The contacts of an entry.
pub struct Entry {
    /// One for each pair.
    pub contacts: Vec<Contact>,
    /// Area of each pair, where areas are given.
    pub areas: Vec<Option<f64>>,
    /// Pairs that were left out, because they repeat others.
    pub repeated: usize,
    /// Constant forces that balance contacts whose stresses at rest the matrices do not tell.
    pub balance: Vec<(usize, f64)>,
}

/// The contacts of an entry. `images` has the degree of freedom of the left face for each one of the right face.
///
/// # Errors
/// A sentence that names the list and its node or degree of freedom.
pub fn contacts(
    (job, part): (&Job, &ContactPart),
    table: &Nodes,
    images: &HashMap<i64, i64>,
    between: &[SurfaceContact],
) -> Outcome<Entry> {
    let places = places(part);
    let width = places.len();
    let mut pairs = match &part.nodes {
        _ if part.surfaces.is_some() => between_surfaces(part, table, images, between)?,
        Some(nodes) if part.a.is_empty() && part.b.is_empty() => matched(job, (part, nodes), places, table)?,
        Some(_) => return Err("names degrees of freedom and nodes: needs one of a and nodes".into()),
        None => {
            let pairs = listed(part, width, table)?;
            check_normal(part, &pairs, width, table)?;
            pairs
        }
    };
    if part.surfaces.is_none() {
        let rows = pairs
            .a
            .iter()
            .chain(&pairs.b)
            .filter_map(|dof| usize::try_from(*dof).ok());
        table.refuse_relative(rows)?;
    }
    let repeated = pairs.leave_out_repeated(width, images);
    let given = part.nodes.as_ref().is_some_and(|nodes| !nodes.areas.is_empty());
    let has_areas = given || part.surfaces.is_some();
    let at_rest = match &part.at_rest {
        Some(file) => Some(loads(job, (part, file), (&mut pairs, width), (table, has_areas))?),
        None => None,
    };
    if part.balanced && part.per_speed2 != 0.0 {
        return Err(
            "balanced leaves no room for per_speed2: the forces that hold a preload do not follow the speed".into(),
        );
    }
    if part.tangent.is_some() && part.normal.is_none() && part.surfaces.is_none() {
        return Err("tangent without normal".into());
    }
    let frame = |k: usize| -> Outcome<Option<Frame>> {
        let normal = part.normal.or_else(|| pairs.normals.get(k).copied());
        let frame = normal.map(|normal| Frame::new(normal, part.tangent));
        frame.transpose().map_err(|e| e.to_string())
    };
    let side = |dofs: &[i64]| -> Outcome<[Option<usize>; 3]> {
        let mut side = [None; 3];
        for (&place, &dof) in places.iter().zip(dofs) {
            side[place] = match dof {
                -1 => None,
                dof => Some(usize::try_from(dof).map_err(|_| format!("names degree of freedom {dof}"))?),
            };
        }
        Ok(side)
    };
    let kind = match part.kind {
        KindName::Jenkins => ContactKind::Jenkins(Jenkins::default()),
        KindName::Friction2d => ContactKind::Friction2d(Friction2d::default()),
        KindName::Friction3d => ContactKind::Friction3d(Friction3d::default()),
        KindName::Unilateral => ContactKind::Unilateral(Unilateral::default()),
        KindName::Cubic => ContactKind::Cubic(Cubic::default()),
        KindName::Regularised => ContactKind::Regularised(Regularised::default()),
    };
    let sides = pairs.a.chunks_exact(width).zip(pairs.b.chunks_exact(width));
    let all: Outcome<Vec<Contact>> = sides
        .zip(&pairs.areas)
        .enumerate()
        .map(|(k, ((a, b), &area))| {
            // An infinite pressure on no area is no load.
            let preload = if area == 0.0 { 0.0 } else { part.preload * area };
            let gap = part.gap + pairs.gaps.get(k).copied().unwrap_or(0.0);
            let (preload, gap) = at_rest.as_ref().map_or((preload, gap), |all| all[k]);
            let mut contact = Contact {
                frame: frame(k)?,
                sector_offset: part.sector_offset,
                ..Contact::of_sides(kind.clone(), side(a)?, side(b)?)
            };
            for (constant, value) in [
                (Constant::Kt, part.kt * area),
                (Constant::Kn, part.kn * area),
                (Constant::Mu, part.mu),
                (Constant::Preload, preload),
                (Constant::Gap, gap),
                (Constant::Cubic, part.cubic * area),
                (Constant::Velocity, part.velocity),
            ] {
                contact.set(constant, value).map_err(|e| e.to_string())?;
            }
            Ok(contact)
        })
        .collect();
    let contacts = all?;
    let mut balance = Vec::new();
    if at_rest.is_some() || part.balanced {
        for (k, contact) in contacts.iter().enumerate() {
            balance.extend(balanced(contact, part.normal.or_else(|| pairs.normals.get(k).copied())));
        }
    }
    Ok(Entry {
        balance,
        contacts,
        areas: pairs.areas.iter().map(|area| has_areas.then_some(*area)).collect(),
        repeated,
    })
}

/// Preload and gap of each pair in a static step; pairs without contact in it are refused, or left out.
fn loads(
    job: &Job,
    (part, file): (&ContactPart, &StaticPart),
    (pairs, width): (&mut Pairs, usize),
    (table, has_areas): (&Nodes, bool),
) -> Outcome<Vec<(f64, f64)>> {
    let mesh_gaps = part.surfaces.as_ref().is_some_and(|surfaces| surfaces.mesh_gaps);
    if part.preload != 0.0 || part.per_speed2 != 0.0 || part.gap != 0.0 || mesh_gaps {
        return Err("static takes the place of preload, per_speed2, gap and mesh_gaps".into());
    }
    if part.sector_offset != 0 {
        return Err("static needs pairs of one sector".into());
    }
    let path = job.path(&file.file);
    let states = static_states(&path).map_err(|e| format!("static: {e}"))?;
    let node = |dofs: &[i64]| {
        let mut all = dofs.iter().filter_map(|dof| usize::try_from(*dof).ok());
        all.find_map(|dof| table.node_of(dof))
    };
    let (mut kept, mut loads) = (Vec::new(), Vec::new());
    for (k, (a, b)) in pairs.a.chunks_exact(width).zip(pairs.b.chunks_exact(width)).enumerate() {
        let nodes = [node(a), node(b)];
        let known: Vec<i64> = nodes.into_iter().flatten().collect();
        let Some(state) = known.iter().find_map(|node| states.get(node)) else {
            if file.missing == MissingName::LeftOut {
                continue;
            }
            return Err(format!(
                "static: {} has no contact at {}: missing = \"left_out\" leaves such pairs out{}",
                path.display(),
                known
                    .first()
                    .map_or("a pair without names of nodes".into(), |node| format!("node {node}")),
                side_looked_up(part)
            ));
        };
        let of_area = |pressure: f64| {
            if has_areas {
                Ok(pressure * pairs.areas[k])
            } else {
                Err("static: pressures need areas: those of [contact.nodes], or [contact.surfaces]")
            }
        };
        let preload = match (state.force, state.pressure) {
            (Some(force), _) => force,
            (None, Some(pressure)) => of_area(pressure)?,
            (None, None) => 0.0,
        };
        kept.push(k);
        loads.push((preload, state.gap));
    }
    if kept.is_empty() {
        return Err(format!(
            "static: {} has no contact at any of the {} pairs{}",
            path.display(),
            pairs.areas.len(),
            side_looked_up(part)
        ));
    }
    pairs.keep(&kept, width);
    Ok(loads)
}

/// Remedy of the error where only one side of the pairs has nodes: the other side of a projected pair is a mean over several.
fn side_looked_up(part: &ContactPart) -> &'static str {
    if part.surfaces.is_some() {
        "; [contact.surfaces] looks up the nodes of side a alone: a is the side that the static step has values of"
    } else {
        ""
    }
}

/// Forces on the degrees of freedom of a contact that hold it at rest against its preload. The normal points from side b to side a, as
/// the normal degree of freedom does.
fn balanced(contact: &Contact, normal: Option<[f64; 3]>) -> Vec<(usize, f64)> {
    if contact.normal_direction().is_none() || contact.constant(Constant::Preload) == 0.0 {
        return Vec::new();
    }
    let on_a = match normal {
        Some(n) => {
            let length = n[0].hypot(n[1]).hypot(n[2]);
            n.map(|x| -contact.constant(Constant::Preload) * x / length)
        }
        None => [0.0, 0.0, -contact.constant(Constant::Preload)],
    };
    let sides = [(&contact.dof_a, 1.0), (&contact.dof_b, -1.0)];
    let of_side = |(dofs, sign): (&[Option<usize>; 3], f64)| -> Vec<(usize, f64)> {
        let all = dofs.iter().zip(on_a);
        all.filter_map(|(dof, force)| Some(((*dof)?, sign * force))).collect()
    };
    sides
        .into_iter()
        .flat_map(of_side)
        .filter(|(_, force)| *force != 0.0)
        .collect()
}

impl Pairs {
    /// Keeps some of the pairs.
    fn keep(&mut self, kept: &[usize], width: usize) {
        let of = |all: &[i64]| -> Vec<i64> {
            let dofs = kept.iter().flat_map(|k| &all[k * width..(k + 1) * width]);
            dofs.copied().collect()
        };
        (self.a, self.b) = (of(&self.a), of(&self.b));
        self.areas = kept.iter().map(|k| self.areas[*k]).collect();
        self.normals = kept.iter().filter_map(|k| self.normals.get(*k).copied()).collect();
        self.gaps = kept.iter().filter_map(|k| self.gaps.get(*k).copied()).collect();
    }

    /// Leaves out pairs on the right face whose images on the left face are pairs of the entry, too: both are one pair of the
    /// wheel. Returns their number.
    fn leave_out_repeated(&mut self, width: usize, images: &HashMap<i64, i64>) -> usize {
        let count = self.areas.len();
        let pair = |k: usize| (&self.a[k * width..(k + 1) * width], &self.b[k * width..(k + 1) * width]);
        let known: HashSet<_> = (0..count).map(pair).collect();
        let image = |dofs: &[i64]| -> Option<Vec<i64>> {
            dofs.iter()
                .map(|dof| if *dof == -1 { Some(-1) } else { images.get(dof).copied() })
                .collect()
        };
        let is_repeated = |k: usize| {
            let (a, b) = pair(k);
            let moves = a.iter().chain(b).any(|dof| *dof != -1);
            let both = image(a).zip(image(b));
            moves && both.is_some_and(|(a, b)| known.contains(&(&a[..], &b[..])))
        };
        let kept: Vec<usize> = (0..count).filter(|k| !is_repeated(*k)).collect();
        self.keep(&kept, width);
        count - kept.len()
    }
}

/// Places of the law's degrees of freedom in those of a contact.
fn places(part: &ContactPart) -> &'static [usize] {
    let two = match &part.nodes {
        Some(nodes) => {
            matches!(&nodes.a, NodeList::Nodes(a) if matches!(a.first(), Some(Node::Dofs(dofs)) if dofs.len() == 2))
        }
        None => part.a.len() == 2,
    };
    match (part.kind, part.normal) {
        _ if part.surfaces.is_some() => &[0, 1, 2],
        (KindName::Unilateral, None) => &[2],
        (KindName::Friction2d, None) => &[0, 2],
        (KindName::Friction3d, None) if two => &[0, 1],
        (_, Some(_)) | (KindName::Friction3d, None) => &[0, 1, 2],
        _ => &[0],
    }
}

fn listed(part: &ContactPart, width: usize, table: &Nodes) -> Outcome<Pairs> {
    let numbers = part.a.len();
    if numbers == 0 || !numbers.is_multiple_of(width) {
        return Err(format!("a has {numbers} numbers, needs a multiple of {width}"));
    }
    if !part.b.is_empty() && part.b.len() != numbers {
        return Err(format!(
            "b has {} numbers, needs as many as a has, {numbers}, or none for the ground",
            part.b.len()
        ));
    }
    let rows = |name: &str, side: &[SideDof]| -> Outcome<Vec<i64>> {
        let row = |(i, dof): (usize, &SideDof)| match dof {
            SideDof::Number(number) => Ok(*number),
            SideDof::Node(node) => {
                let row = table.dof(&DofName::Node(node.clone()));
                row.map(|row| row as i64).map_err(|e| format!("{name}[{i}]: {e}"))
            }
        };
        side.iter().enumerate().map(row).collect()
    };
    Ok(Pairs {
        a: rows("a", &part.a)?,
        b: if part.b.is_empty() {
            vec![-1; numbers]
        } else {
            rows("b", &part.b)?
        },
        areas: vec![1.0; numbers / width],
        normals: Vec::new(),
        gaps: Vec::new(),
    })
}

/// Refuses a normal that the positions of degrees of freedom contradict, where a mesh has all of them.
fn check_normal(part: &ContactPart, pairs: &Pairs, width: usize, table: &Nodes) -> Outcome<()> {
    let Some(normal) = part.normal.filter(|_| !part.any_normal && part.sector_offset == 0) else {
        return Ok(());
    };
    let at = |dofs: &[i64]| -> Option<Vec<[f64; 3]>> {
        dofs.chunks_exact(width)
            .map(|dofs| dofs.iter().find_map(|dof| table.position_of(*dof)))
            .collect()
    };
    match (at(&pairs.a), at(&pairs.b)) {
        (Some(a), Some(b)) => normals::check(normal, &a, &b),
        _ => Ok(()),
    }
}

fn matched(job: &Job, (part, nodes): (&ContactPart, &NodesPart), places: &[usize], table: &Nodes) -> Outcome<Pairs> {
    let own = match &nodes.coordinates {
        Some(path) => Some(Mesh::read(&job.path(path))?),
        None => None,
    };
    let mesh = own.as_ref().or(table.mesh.as_ref());
    let said = |e: String| format!("nodes: {e}");
    let [a, b] = [("a", &nodes.a), ("b", &nodes.b)].map(|(name, list)| node_list(name, list, mesh).map_err(said));
    let (a, b) = (a?, b?);
    let areas = match nodes.areas[..] {
        [] => vec![1.0; a.len()],
        [area] => vec![area; a.len()],
        _ if nodes.areas.len() == a.len() => nodes.areas.clone(),
        _ => {
            return Err(format!(
                "nodes: areas has {} entries, needs {} as a has, or one",
                nodes.areas.len(),
                a.len()
            ));
        }
    };
    if let Some(i) = areas.iter().position(|area| !(area.is_finite() && *area >= 0.0)) {
        return Err(format!("nodes: areas[{i}] = {}, needs a finite number >= 0", areas[i]));
    }
    let at_a = positions("a", &a, &nodes.a_coordinates, mesh).map_err(said)?;
    let at_b = positions("b", &b, &nodes.b_coordinates, mesh).map_err(said)?;
    let list = |name, nodes, at| Positioned { name, nodes, at };
    let partner = pairs(&list("a", &a, &at_a), &list("b", &b, &at_b), nodes.largest_distance).map_err(said)?;
    if let Some(normal) = part.normal.filter(|_| !part.any_normal) {
        let partners: Vec<[f64; 3]> = partner.iter().map(|&j| at_b[j]).collect();
        normals::check(normal, &at_a, &partners)?;
    }
    let (mut dofs_a, mut dofs_b) = (Vec::new(), Vec::new());
    for (i, &j) in partner.iter().enumerate() {
        let of = |name: &str, node| table.dofs_of(node, places).map_err(|e| format!("nodes: {name}: {e}"));
        dofs_a.extend(of(&format!("a[{i}]"), &a[i])?);
        dofs_b.extend(of(&format!("b[{j}]"), &b[j])?);
    }
    Ok(Pairs {
        a: dofs_a,
        b: dofs_b,
        areas,
        normals: Vec::new(),
        gaps: Vec::new(),
    })
}

/// Contacts of nodes of a surface, whose motions are relative, with the ground. Those on the right face of a sector are their
/// images on the left one, which take their areas.
fn between_surfaces(
    part: &ContactPart,
    table: &Nodes,
    images: &HashMap<i64, i64>,
    between: &[SurfaceContact],
) -> Outcome<Pairs> {
    if part.nodes.is_some() || !part.a.is_empty() || !part.b.is_empty() || part.sector_offset != 0 {
        return Err("names surfaces, which leave no room for a, b, nodes or sector_offset".into());
    }
    let mut all = Vec::new();
    for contact in between {
        let dofs = table.of_number(contact.node).map_err(|e| format!("surfaces: {e}"))?;
        all.extend(dofs.map(|dofs| (dofs, contact)));
    }
    let known: HashMap<[i64; 3], usize> = all.iter().enumerate().map(|(k, (dofs, _))| (*dofs, k)).collect();
    let image = |dofs: &[i64; 3]| -> Option<usize> {
        let mut left = [-1; 3];
        for (left, dof) in left.iter_mut().zip(dofs).filter(|(_, dof)| **dof != -1) {
            *left = *images.get(dof)?;
        }
        known.get(&left).copied()
    };
    let mut areas: Vec<f64> = all.iter().map(|(_, contact)| contact.area).collect();
    let lefts: Vec<Option<usize>> = all.iter().map(|(dofs, _)| image(dofs)).collect();
    for (k, left) in lefts.iter().enumerate() {
        if let Some(left) = left.filter(|left| *left != k) {
            areas[left] += areas[k];
        }
    }
    let kept: Vec<usize> = (0..all.len())
        .filter(|k| lefts[*k].is_none_or(|left| left == *k))
        .collect();
    Ok(Pairs {
        a: kept.iter().flat_map(|k| all[*k].0).collect(),
        b: vec![-1; 3 * kept.len()],
        areas: kept.iter().map(|k| areas[*k]).collect(),
        normals: kept.iter().map(|k| all[*k].1.normal.map(|x| -x)).collect(),
        gaps: if part.surfaces.as_ref().is_some_and(|surfaces| surfaces.mesh_gaps) {
            kept.iter().map(|k| all[*k].1.gap).collect()
        } else {
            Vec::new()
        },
    })
}
