//! Relative motions of contacts and springs over the independent degrees of freedom of this sector and its neighbours.
//!
//! A degree of freedom on the right face is moved by the next sector. In a Cartesian frame the axes of another sector
//! are turned, and its motion is turned into the axes of this one.

use crate::contact::Contact;
use crate::contact::described::relative_motion::{Direction, Side, TERMS_A, TERMS_B};
use crate::error::{Result, fail};
use crate::model::matrices::sector_faces::Faces;
use crate::model::matrices::spring::{Row, Spring};
use crate::model::matrices::structure::Structure;
use crate::model::matrices::wave::Wave;
use num_complex::Complex64;
use std::ops::Range;

/// A term of a relative motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// Independent degree of freedom.
    pub dof: usize,
    /// Sector of the degree of freedom, counted from that of side a.
    pub sector: i64,
    /// Coefficient, with negative sign for side b.
    pub coefficient: f64,
}

/// Most terms of a relative motion.
/// Kind: fixed.
pub const MOTION_TERMS: usize = TERMS_A + TERMS_B;

/// Relative motion side a minus side b: at most six terms of side a and three of side b.
#[derive(Clone, Copy, Debug, Default)]
pub struct SectorMotion {
    terms: [Option<Term>; MOTION_TERMS],
}

/// Key of a relative motion: for each term its degree of freedom, its sector in 0 .. N, and the bits of its
/// coefficient.
pub type Key = [Option<(usize, i64, u64)>; MOTION_TERMS];

/// Coefficients below this share of 1 are rounding.
/// Kind: rounding.
const SECTOR_MOTION_ROUNDING: f64 = 1e-12;

impl SectorMotion {
    /// The terms, side a first.
    pub fn terms(&self) -> impl Iterator<Item = &Term> {
        self.terms.iter().flatten()
    }

    /// Row over the independent degrees of freedom; `phase` gives the motion of the sector at an offset over that of
    /// this sector.
    pub fn row(&self, phase: impl Fn(i64) -> Complex64) -> Row {
        self.terms
            .map(|term| term.map(|t| (t.dof, phase(t.sector) * t.coefficient)))
    }

    /// Row over the degrees of freedom of all sectors of a ring; `place` returns the index of one from its index in
    /// its sector and the offset of this sector.
    pub fn ring_row(&self, place: impl Fn(usize, i64) -> usize) -> [Option<(usize, f64)>; MOTION_TERMS] {
        self.terms
            .map(|term| term.map(|t| (place(t.dof, t.sector), t.coefficient)))
    }

    /// Adds a term to side `side`; returns whether there was room for it.
    fn add(&mut self, side: usize, term: Term, sectors: usize) -> bool {
        let places = &mut self.terms[places_of(side)];
        let alike = |t: &Term| t.dof == term.dof && (t.sector - term.sector).rem_euclid(sectors as i64) == 0;
        for place in places {
            match place {
                Some(t) if alike(t) => {
                    t.coefficient += term.coefficient;
                    return true;
                }
                None => {
                    *place = Some(term);
                    return true;
                }
                Some(_) => {}
            }
        }
        false
    }

    /// Removes terms that cancel to rounding.
    fn clean(&mut self) {
        for term in &mut self.terms {
            *term = term.filter(|t| t.coefficient.abs() > SECTOR_MOTION_ROUNDING);
        }
    }

    /// Whether a side has no motion at all.
    fn is_still(&self, side: usize) -> bool {
        self.terms[places_of(side)].iter().all(Option::is_none)
    }

    /// Whether both sides always have the same motion.
    fn cancels(&self, sectors: usize) -> bool {
        let alike = |a: &Term, b: &Term| a.dof == b.dof && (a.sector - b.sector).rem_euclid(sectors as i64) == 0;
        self.terms().all(|t| {
            let sum: f64 = self.terms().filter(|u| alike(t, u)).map(|u| u.coefficient).sum();
            sum.abs() <= SECTOR_MOTION_ROUNDING
        })
    }
}

/// Positions of the terms of a side.
fn places_of(side: usize) -> Range<usize> {
    if side == 0 { 0..TERMS_A } else { TERMS_A..MOTION_TERMS }
}

/// Reason why a relative motion cannot be expressed.
enum Unknown {
    /// The node of this degree of freedom has turned axes, and its components are not known.
    Node(usize),
    /// One side names several nodes of the right face.
    ManyNodes,
}

/// The two sides of a relative motion.
struct Sides<'a> {
    direction: &'a Direction,
    sector_offset: i64,
    /// Degrees of freedom x, y and z of the node on side b, where the contact has a frame.
    node_b: Option<[Option<usize>; 3]>,
}

/// Relative motion in the k-th direction of a contact.
pub(crate) fn contact_motion(structure: &Structure, contact: &Contact, k: usize) -> SectorMotion {
    let direction = contact.direction(k);
    written(structure, &Sides::of_contact(contact, &direction)).unwrap_or_default()
}

/// Relative motion of a spring.
pub(crate) fn spring_motion(structure: &Structure, spring: &Spring) -> SectorMotion {
    let direction = Direction::between(spring.dof_a, spring.dof_b);
    let sides = Sides {
        direction: &direction,
        sector_offset: spring.sector_offset,
        node_b: None,
    };
    written(structure, &sides).unwrap_or_default()
}

/// Row of a relative motion in a wave.
pub(crate) fn row(structure: &Structure, motion: &SectorMotion, wave: Wave) -> Row {
    motion.row(|sector| match wave {
        Wave::Harmonic(h) => structure.phase(h, sector),
        Wave::Diameter(d) => structure.wave_phase(d, sector),
    })
}

/// A key that distinguishes different relative motions, and orders them.
pub(crate) fn key(structure: &Structure, motion: &SectorMotion) -> Key {
    let sectors = structure.sectors() as i64;
    motion
        .terms
        .map(|term| term.map(|t| (t.dof, t.sector.rem_euclid(sectors), t.coefficient.to_bits())))
}

/// Refuses relative motions that have no meaning with these faces or fixed degrees of freedom.
pub(crate) fn check_motion(
    structure: &Structure,
    what: &str,
    direction: &Direction,
    sector_offset: i64,
    node_b: Option<[Option<usize>; 3]>,
) -> Result<()> {
    if structure.degrees().is_identity() {
        return Ok(());
    }
    let dofs = |side: &Side| side.iter().flatten().map(|&(dof, _)| dof).next();
    if let (Some(faces), Some(a), Some(b)) = (structure.degrees().faces(), dofs(&direction.a), dofs(&direction.b))
        && let Some(pair) = faces.is_own_image(a, b)
    {
        return fail!(
            Argument,
            "{what}: dof_a = {a} and dof_b = {b} are the left and the right node of pair {pair}, a node and its own image; between neighbouring sectors name the left one on both sides, with sector_offset = 1"
        );
    }
    let sides = Sides {
        direction,
        sector_offset,
        node_b,
    };
    match written(structure, &sides) {
        Ok(motion) if motion.is_still(0) && motion.is_still(1) => {
            fail!(Argument, "{what}: both sides are fixed; it needs a side that moves")
        }
        Ok(motion) if motion.cancels(structure.sectors()) => fail!(
            Argument,
            "{what}: dof_a and dof_b are both the same degree of freedom; it needs two different sides"
        ),
        Ok(_) => Ok(()),
        Err(Unknown::Node(dof)) => fail!(
            Argument,
            "{what}: dof_b = {dof} lies in a sector whose axes are turned by {} degrees, and the other components of its node are unknown; give a normal with x, y and z of both nodes, or use a cylindrical frame",
            structure.degrees().faces().map_or(0.0, Faces::angle) * sector_offset as f64
        ),
        Err(Unknown::ManyNodes) => fail!(
            Argument,
            "{what}: one side names several nodes of the right face; needs the components of one node"
        ),
    }
}

/// Expresses a relative motion over the independent degrees of freedom.
fn written(structure: &Structure, sides: &Sides<'_>) -> core::result::Result<SectorMotion, Unknown> {
    let mut motion = SectorMotion::default();
    let offset = sides.sector_offset.rem_euclid(structure.sectors() as i64);
    let turn = structure.degrees().faces().and_then(|faces| faces.turn_of(offset));
    for (dof, c) in sides.direction.a.iter().flatten() {
        add_image(structure, &mut motion, (0, 0), *dof, *c)?;
    }
    for (at, (dof, c)) in sides
        .direction
        .b
        .iter()
        .enumerate()
        .filter_map(|(k, t)| t.map(|t| (k, t)))
    {
        let side = (1, offset);
        let (Some(turn), Some(faces)) = (turn, structure.degrees().faces()) else {
            add_image(structure, &mut motion, side, dof, -c)?;
            continue;
        };
        let given = sides.node_b.map(|node| (node, at));
        let (node, k) = faces
            .vector_of(dof, structure.degrees().given(), given)
            .ok_or(Unknown::Node(dof))?;
        for (dof, turned) in node.iter().zip(turn[k]) {
            if let (Some(dof), true) = (*dof, turned != 0.0) {
                add_image(structure, &mut motion, side, dof, -c * turned)?;
            }
        }
    }
    if !structure.degrees().is_identity() {
        motion.clean();
    }
    Ok(motion)
}

fn add_image(
    structure: &Structure,
    motion: &mut SectorMotion,
    (side, offset): (usize, i64),
    dof: usize,
    factor: f64,
) -> core::result::Result<(), Unknown> {
    let (sector, terms) = structure.degrees().image(dof);
    for (dof, c) in terms {
        let term = Term {
            dof,
            sector: offset + sector,
            coefficient: factor * c,
        };
        if !motion.add(side, term, structure.sectors()) {
            return Err(Unknown::ManyNodes);
        }
    }
    Ok(())
}

impl<'a> Sides<'a> {
    fn of_contact(contact: &Contact, direction: &'a Direction) -> Self {
        Self {
            direction,
            sector_offset: contact.sector_offset,
            node_b: contact.frame.map(|_| contact.dof_b),
        }
    }
}
