//! Contact laws: what a caller says of a contact.
//!
//! A [`Contact`] names the degrees of freedom of its sides and the constants of its law in the caller's
//! units; [`Contact::law`] makes of it what a solver evaluates, a [`Law`] in the solver's units. One
//! file each: the laws, the [`sides`], and the [`law`] vocabulary that they share.

use crate::contact::law::Law;
use crate::contact::laws::cubic::Cubic;
use crate::contact::laws::friction_2d::Friction2d;
use crate::contact::laws::friction_3d::Friction3d;
use crate::contact::laws::jenkins::Jenkins;
use crate::contact::laws::polynomial::Polynomial;
use crate::contact::laws::regularised::TanhFriction;
use crate::contact::laws::table::Table;
use crate::contact::laws::unilateral::Unilateral;
use crate::contact::laws::user_law::User;
use crate::contact::relative_motion::{Direction, Frame};
use crate::error::Result;
use std::sync::Arc;

/// Which law a contact obeys.
#[derive(Clone, Debug)]
pub enum ContactKind {
    /// Elastic Coulomb friction with constant normal load in one direction.
    Jenkins,
    /// Spring with a cubic term: f = kt·y + cubic·y³.
    Cubic,
    /// Spring that is pressed once a gap has closed, and open otherwise.
    Unilateral,
    /// Elastic Coulomb friction in one tangential direction, t1, under a normal load along n that varies
    /// and may vanish.
    Friction2d,
    /// Elastic Coulomb friction in the plane of t1 and t2, whose force turns with the slip, under a
    /// normal load along n that varies and may vanish; without a degree of freedom along n the load is
    /// constant.
    Friction3d,
    /// Friction with Coulomb's jump smoothed: f = μN₀·tanh(v/velocity).
    Regularised,
    /// Spring whose force is straight between the points of a table.
    Table(Table),
    /// Springs and dampers of polynomial form over one or several motions.
    Polynomial(Polynomial),
    /// A law of the caller.
    User(User),
}

/// What a contact is for a solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Without force at any motion.
    Inert,
    /// A linear spring of stiffness kt at any motion.
    Spring,
    /// Nonlinear; at small motion of the stiffness that [`Contact::stiffness_at_small_motion`] tells.
    Active,
}

/// A contact between two sides, one of which may be the ground.
#[derive(Clone, Debug)]
pub struct Contact {
    /// The law.
    pub kind: ContactKind,
    /// Degrees of freedom of side a along t1, t2 and n; `None` is the ground. A unilateral spring acts
    /// along n, laws of one direction along t1; places that are not used are `None`.
    pub dof_a: [Option<usize>; 3],
    /// Degrees of freedom of side b, likewise.
    pub dof_b: [Option<usize>; 3],
    /// Directions t1, t2 and n in the axes of the three degrees of freedom of each side, all of which
    /// may then be used; `None`: the degrees of freedom lie along t1, t2 and n themselves.
    pub frame: Option<Frame>,
    /// Side b lies in sector s + offset (cyclic models).
    pub sector_offset: i64,
    /// Stiffness at small motion, force per length, at least 0; 0 for a unilateral spring.
    pub kt: f64,
    /// Stiffness of a unilateral spring, force per length, at least 0; 0 for the others.
    pub kn: f64,
    /// Friction coefficient, at least 0; 0 for springs.
    pub mu: f64,
    /// Normal load at rest, force, at least 0; infinite sticks for ever; 0 for a cubic spring. A
    /// unilateral spring has N = max(preload + kn·(closing − gap), 0), where closing is the motion of
    /// side b over that of side a.
    pub preload: f64,
    /// Closing at which a unilateral spring without preload begins to press, of any sign; 0 for the
    /// others.
    pub gap: f64,
    /// Force per length cubed of a cubic spring, of any sign; 0 for the others.
    pub cubic: f64,
    /// Velocity at which regularised friction reaches 76 % (tanh 1) of its limit, above 0; 0 for the
    /// others.
    pub velocity: f64,
    /// Degrees of freedom whose motions over the ground a law of the caller or a polynomial knows, in its
    /// order. Empty: the law knows one motion, that between `dof_a` and `dof_b` along t1.
    pub dofs: Vec<usize>,
}

impl Contact {
    /// Closing at which a unilateral spring begins to press, the preload counted in; negative for one
    /// that presses at rest.
    #[must_use]
    pub fn clearance(&self) -> f64 {
        if self.preload == 0.0 {
            self.gap
        } else {
            self.gap - self.preload / self.kn
        }
    }

    /// Whether a side can move along n.
    pub(super) fn has_normal(&self) -> bool {
        let place = |dofs: [Option<usize>; 3]| match &self.frame {
            None => dofs[2].is_some(),
            Some(frame) => frame.side(dofs, 2).iter().any(Option::is_some),
        };
        place(self.dof_a) || place(self.dof_b)
    }

    /// n₀ of a load N = max(n₀ − kn·y, 0) that varies; negative where a gap is open at rest.
    #[must_use]
    pub fn load(&self) -> f64 {
        self.preload - self.kn * self.gap
    }

    /// Whether the contact presses at rest: then it loads the structure without vibration.
    #[must_use]
    pub fn is_preloaded(&self) -> bool {
        match &self.kind {
            ContactKind::Unilateral | ContactKind::Friction2d | ContactKind::Friction3d => {
                self.role() == Role::Active && self.kn > 0.0 && self.load() >= 0.0
            }
            ContactKind::Table(table) => table.force(0.0) != 0.0,
            _ => false,
        }
    }

    /// The places (t1, t2, n as 0, 1, 2) in which the law acts, in the order of its motions.
    #[must_use]
    pub fn places(&self) -> &'static [usize] {
        match self.kind {
            ContactKind::Unilateral => &[2],
            ContactKind::Friction2d => &[0, 2],
            ContactKind::Friction3d if self.has_normal() => &[0, 1, 2],
            ContactKind::Friction3d => &[0, 1],
            _ if self.dofs.is_empty() => &[0],
            _ => &[],
        }
    }

    /// Number of relative motions that the law knows.
    #[must_use]
    pub fn directions(&self) -> usize {
        self.places().len().max(self.dofs.len())
    }

    /// The k-th of them.
    #[must_use]
    pub fn direction(&self, k: usize) -> Direction {
        if let Some(&dof) = self.dofs.get(k) {
            return Direction::between(Some(dof), None);
        }
        let place = self.places()[k];
        match &self.frame {
            None => Direction::between(self.dof_a[place], self.dof_b[place]),
            Some(frame) => Direction {
                a: frame.side(self.dof_a, place),
                b: frame.side(self.dof_b, place),
            },
        }
    }

    /// The law, with lengths in units of `length` and forces in units of `length` times the caller's
    /// stiffness.
    ///
    /// # Errors
    /// Those of [`Self::check_constants`].
    pub fn law(&self, length: f64) -> Result<Arc<dyn Law>> {
        Ok(match &self.kind {
            ContactKind::Jenkins => Arc::new(Jenkins {
                stiffness: self.kt,
                limit: self.slip_limit() / length,
            }),
            ContactKind::Cubic => Arc::new(Cubic {
                linear: self.kt,
                cubic: self.cubic * length * length,
            }),
            ContactKind::Unilateral => Arc::new(Unilateral {
                stiffness: self.kn,
                gap: self.clearance() / length,
            }),
            ContactKind::Friction2d => Arc::new(Friction2d {
                kt: self.kt,
                kn: self.kn,
                mu: self.mu,
                load: self.load() / length,
            }),
            ContactKind::Friction3d => Arc::new(Friction3d {
                kt: self.kt,
                kn: self.kn,
                mu: self.mu,
                load: self.load() / length,
                has_normal: self.has_normal(),
            }),
            ContactKind::Regularised => {
                let law = TanhFriction::new(self.slip_limit(), self.velocity)?;
                Arc::new(law.in_units(length))
            }
            ContactKind::Table(table) => Arc::new(table.in_units(length)),
            ContactKind::Polynomial(polynomial) => Arc::new(polynomial.in_units(length)),
            ContactKind::User(user) => Arc::new(user.in_units(length)),
        })
    }

    /// Stiffness of the force in the k-th direction by the l-th motion at small motion. A law of the
    /// caller is not asked, and counts as 0.
    #[must_use]
    pub fn stiffness_at_small_motion(&self, k: usize, l: usize) -> f64 {
        match &self.kind {
            ContactKind::Jenkins if self.role() == Role::Inert => 0.0,
            ContactKind::Jenkins | ContactKind::Cubic => self.kt,
            ContactKind::Unilateral if self.clearance() < 0.0 => self.kn,
            ContactKind::Friction2d | ContactKind::Friction3d if self.mu == 0.0 && self.places()[k] != 2 => 0.0,
            ContactKind::Friction2d | ContactKind::Friction3d if k == l && self.load() > 0.0 => self.stiffness(k),
            ContactKind::Table(table) => table.stiffness_at_small_motion(),
            ContactKind::Polynomial(polynomial) => polynomial.stiffness_at_small_motion(k, l),
            // Open at rest, or not known.
            _ => 0.0,
        }
    }

    /// Largest stiffness that the k-th motion can meet, but for terms that grow with the motion.
    #[must_use]
    pub fn stiffness(&self, k: usize) -> f64 {
        match &self.kind {
            ContactKind::Table(table) => table.largest_stiffness(),
            _ if self.places().get(k) == Some(&2) => self.kn,
            _ => self.kt,
        }
    }

    /// Whether the law needs the direction t1, not just the plane of it.
    #[must_use]
    pub fn needs_tangent(&self) -> bool {
        self.places().contains(&0) && !self.places().contains(&1)
    }

    /// Whether every motion meets exactly [`Self::stiffness`] while the contact sticks (along the normal:
    /// while it is closed), as with friction.
    #[must_use]
    pub fn may_stick(&self) -> bool {
        matches!(
            self.kind,
            ContactKind::Jenkins | ContactKind::Friction2d | ContactKind::Friction3d
        )
    }

    /// Whether the stiffness may grow beyond [`Self::stiffness`], or that be zero.
    #[must_use]
    pub fn is_spring(&self) -> bool {
        !matches!(
            self.kind,
            ContactKind::Jenkins | ContactKind::Unilateral | ContactKind::Friction2d | ContactKind::Friction3d
        )
    }

    /// What the constants of the law make of the contact.
    #[must_use]
    pub fn role(&self) -> Role {
        match self.kind {
            ContactKind::Jenkins if self.kt == 0.0 || self.slip_limit() == 0.0 => Role::Inert,
            ContactKind::Jenkins if self.slip_limit().is_infinite() => Role::Spring,
            ContactKind::Cubic if self.cubic == 0.0 && self.kt == 0.0 => Role::Inert,
            ContactKind::Cubic if self.cubic == 0.0 => Role::Spring,
            ContactKind::Unilateral | ContactKind::Friction2d if self.kn == 0.0 => Role::Inert,
            ContactKind::Friction3d if self.kn == 0.0 && (self.kt == 0.0 || self.slip_limit() == 0.0) => Role::Inert,
            ContactKind::Regularised if self.slip_limit() == 0.0 => Role::Inert,
            _ => Role::Active,
        }
    }

    /// What the contact is called if it has no normal load.
    #[must_use]
    pub fn without_load(&self) -> Option<&'static str> {
        match self.kind {
            ContactKind::Cubic => Some("cubic spring"),
            ContactKind::Table(_) => Some("table"),
            ContactKind::Polynomial(_) => Some("polynomial"),
            ContactKind::User(_) => Some("law of the host"),
            _ => None,
        }
    }

    /// Slip limit μN₀; zero without friction, whatever the load.
    #[must_use]
    pub fn slip_limit(&self) -> f64 {
        if self.mu == 0.0 { 0.0 } else { self.mu * self.preload }
    }

    /// A bound of the force in each direction, whatever the motion; infinite where there is none.
    #[must_use]
    pub fn largest_force(&self) -> f64 {
        match self.kind {
            _ if self.role() == Role::Inert => 0.0,
            ContactKind::Jenkins | ContactKind::Regularised => self.slip_limit(),
            ContactKind::Friction3d if self.kn == 0.0 => self.slip_limit(),
            _ => f64::INFINITY,
        }
    }
}
