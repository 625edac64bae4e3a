//! The contacts of a job.

use crate::build::Outcome;
use crate::job::{ContactPart, Job, KindName, Node, NodesPart};
use crate::node_match::pairs;
use crate::node_table::{NodeDofs, coordinates, dofs_of};
use hbvib::{Contact, ContactKind, Frame};

/// Degrees of freedom of all pairs of an entry, those of one pair after another, and their areas.
struct Pairs {
    a: Vec<i64>,
    b: Vec<i64>,
    areas: Vec<f64>,
}

/// The contacts of an entry, one for each pair.
///
/// # Errors
/// A sentence that names the list and its node or degree of freedom.
pub fn contacts(job: &Job, part: &ContactPart, table: &NodeDofs) -> Outcome<Vec<Contact>> {
    let places = places(part);
    let width = places.len();
    let pairs = match &part.nodes {
        Some(nodes) if part.a.is_empty() && part.b.is_empty() => matched(job, nodes, places, table)?,
        Some(_) => return Err("names degrees of freedom and nodes: needs one of a and nodes".into()),
        None => listed(part, width)?,
    };
    let frame = match part.normal {
        Some(normal) => Some(Frame::new(normal, part.tangent).map_err(|e| e.to_string())?),
        None if part.tangent.is_some() => return Err("tangent without normal".into()),
        None => None,
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
        KindName::Jenkins => ContactKind::Jenkins,
        KindName::Friction2d => ContactKind::Friction2d,
        KindName::Friction3d => ContactKind::Friction3d,
        KindName::Unilateral => ContactKind::Unilateral,
        KindName::Cubic => ContactKind::Cubic,
        KindName::Regularised => ContactKind::Regularised,
    };
    let sides = pairs.a.chunks_exact(width).zip(pairs.b.chunks_exact(width));
    sides
        .zip(&pairs.areas)
        .map(|((a, b), &area)| {
            Ok(Contact {
                kind: kind.clone(),
                dof_a: side(a)?,
                dof_b: side(b)?,
                frame,
                sector_offset: part.sector_offset,
                kt: part.kt * area,
                kn: part.kn * area,
                mu: part.mu,
                // An infinite pressure on no area is no load.
                preload: if area == 0.0 { 0.0 } else { part.preload * area },
                gap: part.gap,
                cubic: part.cubic * area,
                velocity: part.velocity,
                dofs: Vec::new(),
            })
        })
        .collect()
}

/// Places of the law's degrees of freedom in those of a contact.
fn places(part: &ContactPart) -> &'static [usize] {
    let two = match &part.nodes {
        Some(nodes) => matches!(nodes.a.first(), Some(Node::Dofs(dofs)) if dofs.len() == 2),
        None => part.a.len() == 2,
    };
    match (part.kind, part.normal) {
        (KindName::Unilateral, None) => &[2],
        (KindName::Friction2d, None) => &[0, 2],
        (KindName::Friction3d, None) if two => &[0, 1],
        (_, Some(_)) | (KindName::Friction3d, None) => &[0, 1, 2],
        _ => &[0],
    }
}

fn listed(part: &ContactPart, width: usize) -> Outcome<Pairs> {
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
    let ground = || vec![-1; numbers];
    Ok(Pairs {
        a: part.a.clone(),
        b: if part.b.is_empty() { ground() } else { part.b.clone() },
        areas: vec![1.0; numbers / width],
    })
}

fn matched(job: &Job, nodes: &NodesPart, places: &[usize], table: &NodeDofs) -> Outcome<Pairs> {
    let areas = match nodes.areas[..] {
        [] => vec![1.0; nodes.a.len()],
        [area] => vec![area; nodes.a.len()],
        _ if nodes.areas.len() == nodes.a.len() => nodes.areas.clone(),
        _ => {
            return Err(format!(
                "nodes: areas has {} entries, needs {} as a has, or one",
                nodes.areas.len(),
                nodes.a.len()
            ));
        }
    };
    if let Some(i) = areas.iter().position(|area| !(area.is_finite() && *area >= 0.0)) {
        return Err(format!("nodes: areas[{i}] = {}, needs a finite number >= 0", areas[i]));
    }
    let (at_a, at_b) = coordinates(job, nodes)?;
    let partner = pairs(nodes, &at_a, &at_b)?;
    let (mut a, mut b) = (Vec::new(), Vec::new());
    for (i, &j) in partner.iter().enumerate() {
        let of = |name: &str, node| dofs_of(node, places, table).map_err(|e| format!("nodes: {name}: {e}"));
        a.extend(of(&format!("a[{i}]"), &nodes.a[i])?);
        b.extend(of(&format!("b[{j}]"), &nodes.b[j])?);
    }
    Ok(Pairs { a, b, areas })
}
