//! Contacts in time: the laws of a structure, sorted into springs and elements, and what an element with
//! events tells of the pieces between them.
//!
//! Within a piece the forces are linear in the relative motions, x and for friction under a load that
//! varies also y, side a minus side b of each. A friction contact sticks, slips or is open (`slider`); a
//! unilateral spring is open or closed, a table is on one of its lines (`springs`). What friction
//! remembers is the stretch e = x − w of its spring from the slider at w: of x and w themselves a stiff
//! spring would see the rounding.
//!
//! A piece ends where one of its *margins*, polynomials in time like the motion, falls through zero. The
//! force is continuous there, and so is the whole right-hand side: sensitivities of displacements and
//! velocities pass events unchanged (the saltation matrix is the identity; see Leine & Nijmeijer,
//! Dynamics and Bifurcations of Non-Smooth Mechanical Systems, 2004).
//!
//! Smooth laws have one piece without end and are evaluated pointwise (`smooth`).

use crate::contact::law::{Form, Law};
use crate::contact::laws::polynomial::Polynomial;
use crate::contact::laws::table::Table;
use crate::contact::memoryless_law::Memoryless;
use crate::contact::relative_motion::Direction;
use crate::contact::{Contact, ContactKind, Role};
use crate::error::{Result, fail, try_push};
use crate::time_integration::slider_events::Slider;
use crate::time_integration::spring_events::Stop;
use std::sync::Arc;

const CONTEXT: &str = "the contacts";

/// What a contact does at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Mode {
    /// The slider rests.
    Stick,
    /// The slider moves in the direction of this sign.
    Slip(f64),
    /// Without force.
    Open,
    /// Pressed.
    Closed,
    /// On the line of this number of a table.
    Line(usize),
    /// A law without events.
    Smooth,
}

/// Relative motions and velocities at a time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instant {
    /// x and y
    pub motion: [f64; 2],
    /// x′ and y′
    pub rate: [f64; 2],
}

/// Forces within a step: force + slope·(motion − origin).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Piece {
    /// Tangent stiffness, rows first.
    pub slope: [[f64; 2]; 2],
    /// Forces at the begin of the step.
    pub force: [f64; 2],
    /// Relative motions at the begin of the step.
    pub origin: [f64; 2],
    /// Derivative of minus the force along x by the position of the slider.
    pub memory: f64,
}

impl Piece {
    /// Forces at a motion.
    pub fn at(&self, motion: [f64; 2]) -> [f64; 2] {
        let change = self.along([motion[0] - self.origin[0], motion[1] - self.origin[1]]);
        [self.force[0] + change[0], self.force[1] + change[1]]
    }

    /// What a change of the motion adds to the forces.
    pub fn along(&self, change: [f64; 2]) -> [f64; 2] {
        self.slope.map(|s| s[0] * change[0] + s[1] * change[1])
    }
}

/// Most margins of a piece.
pub(super) const MARGINS: usize = 3;

/// How many zeros each margin of a piece has at its begin by construction.
pub(super) type Zeros = [usize; MARGINS];

/// A law that is linear between events.
pub(super) trait Events {
    /// The mode at a state, whose stretch comes within its range; then the mode, if any, that tells where
    /// the slider is from the motion alone.
    fn begin(&self, at: &Instant, e: &mut f64) -> (Mode, Option<Mode>);

    /// The forces in a mode from a motion on, the spring of the slider stretched by e.
    fn piece(&self, mode: Mode, motion: [f64; 2], e: f64) -> Piece;

    /// Number of margins in a mode.
    fn margins(&self, mode: Mode) -> usize;

    /// Writes the polynomial of a margin, which is positive as long as the piece lasts, from those of the
    /// relative motions, all of one length.
    fn margin(&self, mode: Mode, which: usize, e: f64, x: &[f64], y: &[f64], margin: &mut [f64]);

    /// The mode after margin `which` has fallen to zero, and the zeros of the new margins.
    fn leave(&self, mode: Mode, which: usize, at: &Instant, e: &mut f64) -> (Mode, Zeros);
}

/// Law of an element, its constants in the caller's units.
#[derive(Clone, Debug)]
enum Kind {
    Slider(Slider),
    Stop(Stop),
    Table(Table),
    Smooth(Arc<dyn Law>),
}

/// One contact of one sector.
#[derive(Clone, Debug)]
pub(super) struct Element {
    /// One row for each relative motion.
    pub rows: Vec<Row>,
    kind: Kind,
    /// Contacts of equal family are one contact in all sectors.
    pub family: usize,
}

/// A linear spring between two degrees of freedom.
pub(super) struct Tie {
    pub row: Row,
    pub stiffness: f64,
}

/// Row of a relative motion r·x: entries (degree of freedom of the unrolled structure, coefficient).
pub(super) type Row = [Option<(usize, f64)>; 6];

/// Row of a direction whose sides lie in two sectors, side a minus side b; `place` tells the number of a
/// degree of freedom in a sector.
pub(super) fn row(direction: &Direction, sectors: (usize, usize), place: impl Fn(usize, usize) -> usize) -> Row {
    let mut row = [None; 6];
    let (a, b) = row.split_at_mut(3);
    for (entry, side) in a.iter_mut().zip(&direction.a) {
        *entry = side.map(|(dof, c)| (place(dof, sectors.0), c));
    }
    for (entry, side) in b.iter_mut().zip(&direction.b) {
        *entry = side.map(|(dof, c)| (place(dof, sectors.1), -c));
    }
    row
}

/// r·x
pub(super) fn along(row: &Row, x: &[f64]) -> f64 {
    row.iter().flatten().map(|&(dof, a)| a * x[dof]).sum()
}

/// What a contact is in time: its linear part, a stiffness along the first motion, and the law of an
/// element with the first of the contact's motions that it knows.
fn kind(family: usize, c: &Contact) -> Result<(f64, Option<(usize, Kind)>)> {
    let smooth = |law: Arc<dyn Law>| Some((0, Kind::Smooth(law)));
    Ok(match (c.role(), &c.kind) {
        (Role::Inert, _) => (0.0, None),
        (Role::Spring, _) => (c.kt, None),
        (Role::Active, ContactKind::Jenkins) => (0.0, Some((0, Kind::Slider(Slider::jenkins(c))))),
        // Without friction a spring along the normal is left.
        (Role::Active, ContactKind::Friction2d) if c.kt == 0.0 || c.mu == 0.0 => {
            (0.0, Some((1, Kind::Stop(Stop::of(c)))))
        }
        (Role::Active, ContactKind::Friction2d) => (0.0, Some((0, Kind::Slider(Slider::friction(c))))),
        (Role::Active, ContactKind::Unilateral) => (0.0, Some((0, Kind::Stop(Stop::of(c))))),
        (Role::Active, ContactKind::Table(table)) => (0.0, Some((0, Kind::Table(table.clone())))),
        (Role::Active, ContactKind::Cubic) => {
            let law = Polynomial::scalar(&[0.0, 0.0, c.cubic], &[])?;
            (c.kt, smooth(Arc::new(law)))
        }
        (Role::Active, ContactKind::User(user)) if user.states > 0 => {
            return fail!(
                Unsupported,
                "contact {family}: a law of the host with states is not integrated in time"
            );
        }
        (Role::Active, ContactKind::Polynomial(_) | ContactKind::Regularised | ContactKind::User(_)) => {
            (0.0, smooth(c.law(1.0)?))
        }
        (Role::Active, ContactKind::Friction3d) => {
            return fail!(
                Unsupported,
                "contact {family}: friction in a plane is not integrated in time, friction in one direction is"
            );
        }
    })
}

/// Sorts the contacts of a sector, all sectors around, into springs and elements.
///
/// `place` tells the number of a degree of freedom in a sector (of any number) of the ring.
pub(super) fn unroll(
    contacts: &[Contact],
    sectors: usize,
    place: impl Fn(usize, usize) -> usize,
    ties: &mut Vec<Tie>,
    elements: &mut Vec<Element>,
) -> Result<()> {
    for (family, c) in contacts.iter().enumerate() {
        let (stiffness, law) = kind(family, c)?;
        for s in 0..sectors {
            let other = (s as i64 + c.sector_offset).rem_euclid(sectors as i64) as usize;
            if stiffness != 0.0 {
                let row = row(&c.direction(0), (s, other), &place);
                try_push(ties, Tie { row, stiffness }, CONTEXT)?;
            }
            if let Some((first, kind)) = &law {
                let mut rows = Vec::new();
                for k in *first..c.directions() {
                    try_push(&mut rows, row(&c.direction(k), (s, other), &place), CONTEXT)?;
                }
                let kind = kind.clone();
                try_push(elements, Element { rows, kind, family }, CONTEXT)?;
            }
        }
    }
    Ok(())
}

impl Element {
    /// The law of an element that is integrated numerically.
    pub fn smooth(&self) -> Option<&dyn Memoryless> {
        match &self.kind {
            Kind::Smooth(law) => match law.form() {
                Form::Memoryless(law) => Some(law),
                _ => None,
            },
            _ => None,
        }
    }

    /// The law of an element that is linear between events.
    pub fn events(&self) -> Option<&dyn Events> {
        match &self.kind {
            Kind::Slider(law) => Some(law),
            Kind::Stop(law) => Some(law),
            Kind::Table(law) => Some(law),
            Kind::Smooth(_) => None,
        }
    }

    /// The slider of an element that remembers, part of the state.
    pub fn slider(&self) -> Option<&Slider> {
        match &self.kind {
            Kind::Slider(slider) => Some(slider),
            _ => None,
        }
    }

    /// The first two relative motions of displacements, or velocities.
    pub fn relative(&self, x: &[f64]) -> [f64; 2] {
        let mut motion = [0.0; 2];
        for (motion, row) in motion.iter_mut().zip(&self.rows) {
            *motion = along(row, x);
        }
        motion
    }

    /// The relative motions and velocities.
    pub fn instant(&self, x: &[f64], v: &[f64]) -> Instant {
        Instant {
            motion: self.relative(x),
            rate: self.relative(v),
        }
    }

    /// f += s·Rᵀ g of forces g along the first two relative motions
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
