//! Contacts in time: what each law does within a piece, when it leaves the piece, and what follows.
//!
//! Within a piece the force is linear in the relative motion y = side a − side b: a Jenkins contact
//! sticks, f = kt·(y − u) with its slider at u, or slips, f = ±μN₀; a unilateral spring is open, f = 0, or
//! closed, f = kn·(y + clearance). What a Jenkins contact remembers is the stretch e = y − u of its spring:
//! of y and u themselves a stiff spring would see the rounding.
//!
//! A piece ends where one of its *margins*, polynomials in time like the motion, falls through zero. The force is continuous there, and so is the whole
//! right-hand side: sensitivities pass events unchanged (the saltation matrix is the identity; see
//! Leine & Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems, 2004).
//!
//! Smooth laws have one piece without end and are evaluated pointwise.

use crate::contact::sides::Direction;
use crate::contact::{Contact, ContactKind, Role};
use crate::error::{Result, fail, try_push};

/// Law of one relative motion, its constants in the caller's units.
#[derive(Clone, Copy, Debug)]
enum Law {
    /// Stiffness and slip limit.
    Jenkins { kt: f64, limit: f64 },
    /// Stiffness and the closing at which it presses.
    Unilateral { kn: f64, clearance: f64 },
    /// Force per length cubed; the linear part is the structure's.
    Cubic { cubic: f64 },
}

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
    /// A law without events.
    Smooth,
}

/// One contact of one sector.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element {
    pub row: Row,
    law: Law,
    /// Contacts of equal family are one contact in all sectors.
    pub family: usize,
}

/// Force within a step: f = force + slope·(y − origin).
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// Tangent stiffness.
    pub slope: f64,
    /// Force at the begin of the step.
    pub force: f64,
    /// Relative motion at the begin of the step.
    pub origin: f64,
    /// Derivative of −f by the position of the slider.
    pub memory: f64,
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
    const WHAT: &str = "the contacts";
    for (family, c) in contacts.iter().enumerate() {
        for s in 0..sectors {
            if c.role() == Role::Inert {
                break;
            }
            let other = (s as i64 + c.sector_offset).rem_euclid(sectors as i64) as usize;
            let row = row(&c.direction(0), (s, other), &place);
            let (law, linear) = match (c.role(), &c.kind) {
                (Role::Inert, _) => (None, 0.0),
                (Role::Spring, _) => (None, c.kt),
                (Role::Active, ContactKind::Jenkins) => (
                    Some(Law::Jenkins {
                        kt: c.kt,
                        limit: c.slip_limit(),
                    }),
                    0.0,
                ),
                (Role::Active, ContactKind::Unilateral) => (
                    Some(Law::Unilateral {
                        kn: c.kn,
                        clearance: c.clearance(),
                    }),
                    0.0,
                ),
                (Role::Active, ContactKind::Cubic) => (Some(Law::Cubic { cubic: c.cubic }), c.kt),
                (Role::Active, _) => {
                    return fail!(
                        Unsupported,
                        "contact {family}: only Jenkins contacts, unilateral and cubic springs are integrated in time"
                    );
                }
            };
            if linear != 0.0 {
                let stiffness = linear;
                try_push(ties, Tie { row, stiffness }, WHAT)?;
            }
            if let Some(law) = law {
                try_push(elements, Element { row, law, family }, WHAT)?;
            }
        }
    }
    Ok(())
}

impl Element {
    /// Whether the law has no pieces and is integrated numerically.
    pub fn is_smooth(&self) -> bool {
        matches!(self.law, Law::Cubic { .. })
    }

    /// Whether the contact remembers: its slider is part of the state.
    pub fn has_memory(&self) -> bool {
        matches!(self.law, Law::Jenkins { .. })
    }

    /// Force and tangent of a smooth law at y; zero for a law with pieces.
    pub fn smooth(&self, y: f64) -> (f64, f64) {
        match self.law {
            Law::Cubic { cubic } => (cubic * y * y * y, 3.0 * cubic * y * y),
            Law::Jenkins { .. } | Law::Unilateral { .. } => (0.0, 0.0),
        }
    }

    /// The force in a mode from y on, the spring of the slider stretched by e.
    pub fn piece(&self, mode: Mode, y: f64, e: f64) -> Piece {
        let (slope, force, memory) = match (self.law, mode) {
            (Law::Jenkins { kt, .. }, Mode::Stick) => (kt, kt * e, kt),
            (Law::Jenkins { limit, .. }, Mode::Slip(sign)) => (0.0, sign * limit, 0.0),
            (Law::Unilateral { kn, clearance }, Mode::Closed) => (kn, kn * (y + clearance), 0.0),
            _ => (0.0, 0.0, 0.0),
        };
        Piece {
            slope,
            force,
            origin: y,
            memory,
        }
    }

    /// The slider after any motion that ends at y, from u: the play operator.
    pub fn drag(&self, y: f64, u: f64) -> f64 {
        match self.law {
            Law::Jenkins { kt, limit } => u.max(y - limit / kt).min(y + limit / kt),
            _ => u,
        }
    }

    /// The mode at a state, whose stretch comes within its range; `true`: it had to be cut, or the contact
    /// slips, so that y alone tells where the slider is.
    pub fn begin(&self, y: f64, rate: f64, e: &mut f64) -> (Mode, bool) {
        match self.law {
            Law::Jenkins { kt, limit } => {
                let range = limit / kt;
                let sign = e.signum();
                let (at_limit, beyond) = (e.abs() >= range, e.abs() > range);
                if at_limit {
                    *e = sign * range;
                }
                if at_limit && sign * rate > 0.0 {
                    (Mode::Slip(sign), true)
                } else {
                    (Mode::Stick, beyond)
                }
            }
            Law::Unilateral { clearance, .. } if y < -clearance => (Mode::Closed, false),
            Law::Unilateral { .. } => (Mode::Open, false),
            Law::Cubic { .. } => (Mode::Smooth, false),
        }
    }

    /// Number of margins in a mode.
    pub fn margins(mode: Mode) -> usize {
        match mode {
            Mode::Stick => 2,
            Mode::Slip(_) | Mode::Open | Mode::Closed => 1,
            Mode::Smooth => 0,
        }
    }

    /// Turns the polynomial of the relative motion into that of a margin, which is positive as long as
    /// the piece lasts: to the slip limit in the positive and the negative direction while it sticks, the
    /// speed of the slider while it slips, the distance while it is open, the compression while closed.
    pub fn margin(&self, mode: Mode, e: f64, which: usize, y: &mut [f64]) {
        match (self.law, mode) {
            (Law::Jenkins { kt, limit }, Mode::Stick) => {
                let sign = if which == 0 { 1.0 } else { -1.0 };
                y[0] = e;
                for c in y.iter_mut() {
                    *c *= -sign;
                }
                y[0] += limit / kt;
            }
            (Law::Jenkins { .. }, Mode::Slip(sign)) => {
                for k in 1..y.len() {
                    y[k - 1] = sign * k as f64 * y[k];
                }
                if let Some(last) = y.last_mut() {
                    *last = 0.0;
                }
            }
            (Law::Unilateral { clearance, .. }, Mode::Open) => y[0] += clearance,
            (Law::Unilateral { clearance, .. }, Mode::Closed) => {
                y[0] += clearance;
                for c in y.iter_mut() {
                    *c = -*c;
                }
            }
            _ => y.fill(0.0),
        }
    }

    /// The mode after margin `which` has fallen to zero, and how many zeros the new margins have at their
    /// begin by construction: (margin, number).
    ///
    /// Slip ends where the slider's speed does, so that the stretch stands at the limit with slope zero.
    pub fn leave(&self, mode: Mode, which: usize, e: &mut f64) -> (Mode, (usize, usize)) {
        match (self.law, mode) {
            (Law::Jenkins { kt, limit }, Mode::Stick) => {
                let sign = if which == 0 { 1.0 } else { -1.0 };
                *e = sign * limit / kt;
                (Mode::Slip(sign), (0, 0))
            }
            (Law::Jenkins { .. }, Mode::Slip(sign)) => (Mode::Stick, (usize::from(sign < 0.0), 2)),
            (Law::Unilateral { .. }, Mode::Open) => (Mode::Closed, (0, 1)),
            (Law::Unilateral { .. }, Mode::Closed) => (Mode::Open, (0, 1)),
            _ => (mode, (0, 0)),
        }
    }

    /// The stretch after y has grown by `growth` within a piece.
    pub fn stretch(&self, mode: Mode, growth: f64, e: &mut f64) {
        if self.has_memory() && mode == Mode::Stick {
            *e += growth;
        }
    }
}
