//! Elements in time: the contacts of a structure, sorted into linear springs and elements whose laws are linear
//! between events or smooth.
//!
//! Within a piece the forces of an [`EventLaw`] are linear in the relative motions, side a minus side b of each: x,
//! and for friction under a varying normal load also y. The state of friction is the stretch e = x − w of its spring
//! from the slider at w: with x and w as the state, a stiff spring would amplify round-off.
//!
//! A piece ends where one of its *margins*, polynomials in time like the motion, falls through zero. The force is
//! continuous there, and so is the whole right-hand side: sensitivities of displacements and velocities pass events
//! unchanged (the saltation matrix is the identity; see Leine & Nijmeijer, Dynamics and Bifurcations of Non-Smooth
//! Mechanical Systems, 2004).
//!
//! Smooth laws have one piece without end and are evaluated at times; see `smooth_laws`.

use crate::contact::forms::law::{EventLaw, Form, LawInTime, Memoryless, SliderLaw, TimePart};
use crate::contact::forms::time_piece::Instant;
use crate::contact::{Contact, Role};
use crate::error::{Result, try_push};
use crate::interrupt::Interrupt;
use crate::model::matrices::sector_motion::{MOTION_TERMS, SectorMotion};
use crate::model::matrices::structure::Structure;

const CONTEXT: &str = "the contacts";

/// Operations, about, that place a spring, contact or load in one sector.
/// Kind: block.
pub(super) const OF_ONE_SECTOR: u64 = 100;

/// A contact of one sector that is not a linear spring.
#[derive(Clone, Debug)]
pub(crate) struct Element {
    /// Rows of its relative motions, one for each.
    pub rows: Vec<Row>,
    /// Relative motions over the sectors of the whole wheel.
    pub motions: Vec<SectorMotion>,
    /// The law of the contact, with its constants in the caller's units.
    law: TimePart,
    /// Index of the contact, equal for its copies in all sectors.
    pub family: usize,
    /// Sector in which side a of the contact lies.
    pub sector: usize,
}

/// A linear spring between two degrees of freedom.
pub(crate) struct Spring {
    pub row: Row,
    /// Relative motion over the sectors of the whole wheel.
    pub motion: SectorMotion,
    /// Sector in which side a of the spring lies.
    pub sector: usize,
    pub stiffness: f64,
}

/// Row of a relative motion r·x: pairs (degree of freedom of the unrolled structure, coefficient).
pub(crate) type Row = [Option<(usize, f64)>; MOTION_TERMS];

impl Spring {
    /// A spring along a relative motion whose side a lies in sector `s` of the unrolled structure.
    pub fn new(structure: &Structure, motion: &SectorMotion, s: usize, stiffness: f64) -> Self {
        Self {
            row: row(structure, motion, s),
            motion: *motion,
            sector: s,
            stiffness,
        }
    }
}

/// Row of a relative motion whose side a lies in sector `s` of the unrolled structure.
fn row(structure: &Structure, motion: &SectorMotion, s: usize) -> Row {
    let (ndof, sectors) = (structure.ndof(), structure.repeating_sectors());
    motion.ring_row(|dof, offset| {
        let sector = (s as i64 + offset).rem_euclid(sectors as i64) as usize;
        sector * ndof + dof
    })
}

/// Relative motion r·x that the row reads.
pub(super) fn along(row: &Row, x: &[f64]) -> f64 {
    row.iter().flatten().map(|&(dof, a)| a * x[dof]).sum()
}

/// Sorts the contacts of all sectors of the unrolled structure into springs and elements.
pub(super) fn unroll(
    structure: &Structure,
    contacts: &[Contact],
    springs: &mut Vec<Spring>,
    elements: &mut Vec<Element>,
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    for (family, c) in contacts.iter().enumerate() {
        let (stiffness, law) = match c.role() {
            Role::Inert => (0.0, None),
            Role::Spring => (c.stiffness_as_spring(), None),
            Role::Active => {
                let LawInTime { stiffness, first, part } =
                    c.in_time().map_err(|e| e.at(format_args!("contact {family}")))?;
                (stiffness, Some((first, part)))
            }
        };
        for s in 0..structure.repeating_sectors() {
            interrupt.check_before(OF_ONE_SECTOR)?;
            if stiffness != 0.0 {
                let motion = structure.contact_motion(c, 0);
                try_push(springs, Spring::new(structure, &motion, s, stiffness), CONTEXT)?;
            }
            if let Some((first, part)) = &law {
                let (mut rows, mut motions) = (Vec::new(), Vec::new());
                for k in *first..c.directions() {
                    let motion = structure.contact_motion(c, k);
                    try_push(&mut rows, row(structure, &motion, s), CONTEXT)?;
                    try_push(&mut motions, motion, CONTEXT)?;
                }
                let element = Element {
                    rows,
                    motions,
                    law: part.clone(),
                    family,
                    sector: s,
                };
                try_push(elements, element, CONTEXT)?;
            }
        }
    }
    Ok(())
}

impl Element {
    /// The law of the element, if it is integrated numerically.
    pub fn smooth(&self) -> Option<&dyn Memoryless> {
        match &self.law {
            TimePart::Smooth(law) => match law.form() {
                Form::Memoryless(law) => Some(law),
                _ => None,
            },
            TimePart::Events(_) => None,
        }
    }

    /// The law of the element, if it is linear between events.
    pub fn events(&self) -> Option<&dyn EventLaw> {
        match &self.law {
            TimePart::Events(law) => Some(&**law),
            TimePart::Smooth(_) => None,
        }
    }

    /// The slider law of the element, if it has one; its slider is a part of the state.
    pub fn slider(&self) -> Option<&dyn SliderLaw> {
        self.events()?.slider()
    }

    /// The first two relative motions of the element, for displacements or velocities x.
    pub fn relative(&self, x: &[f64]) -> [f64; 2] {
        let mut motion = [0.0; 2];
        for (motion, row) in motion.iter_mut().zip(&self.rows) {
            *motion = along(row, x);
        }
        motion
    }

    /// Relative motions and velocities of the element.
    pub fn instant(&self, x: &[f64], v: &[f64]) -> Instant {
        Instant {
            motion: self.relative(x),
            rate: self.relative(v),
        }
    }

    /// f ← f + s·Rᵀ g, where g are forces along the first two relative motions.
    pub fn push(&self, s: f64, g: [f64; 2], f: &mut [f64]) {
        for (row, g) in self.rows.iter().zip(g) {
            if g != 0.0 {
                for &(dof, a) in row.iter().flatten() {
                    f[dof] += s * a * g;
                }
            }
        }
    }
}
