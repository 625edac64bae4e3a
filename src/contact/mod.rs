//! Contact laws: what a host says of a contact.
//!
//! A [`Contact`] names the degrees of freedom of its sides and the constants of its law in the host's
//! units; [`Contact::law`] makes of it what a solver evaluates, a [`Law`] in the solver's units. One
//! file each: the laws, the [`sides`], and the [`law`] vocabulary that they share.

pub mod cubic;
pub mod iwan;
pub mod jenkins;
pub mod law;
pub mod sides;
pub mod state;
pub mod unilateral;

use crate::error::{Result, fail};
use cubic::Cubic;
use jenkins::Jenkins;
pub use law::{Form, Law, Piece};
use sides::{Direction, Frame};
use std::sync::Arc;
use unilateral::Unilateral;

/// Which law a contact obeys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactKind {
    /// Elastic Coulomb friction with constant normal load in one direction.
    Jenkins,
    /// Spring with a cubic term: f = kt·y + cubic·y³.
    Cubic,
    /// Spring that is pressed once a gap has closed, and open otherwise.
    Unilateral,
}

/// What a contact is for a solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Without force at any motion.
    Inert,
    /// A linear spring of stiffness kt at any motion.
    Spring,
    /// Nonlinear; at small motion of the stiffness that [`Contact::stiffness_at_rest`] tells.
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
}

impl Contact {
    /// A Jenkins contact between degree of freedom `a` and `b` (or the ground).
    #[must_use]
    pub fn jenkins(a: usize, b: Option<usize>, kt: f64, mu: f64, preload: f64) -> Self {
        Self {
            kind: ContactKind::Jenkins,
            dof_a: [Some(a), None, None],
            dof_b: [b, None, None],
            frame: None,
            sector_offset: 0,
            kt,
            kn: 0.0,
            mu,
            preload,
            gap: 0.0,
            cubic: 0.0,
        }
    }

    /// A spring f = kt·y + k3·y³ between degree of freedom `a` and `b` (or the ground), hardening for
    /// k3 > 0, softening for k3 < 0.
    #[must_use]
    pub fn cubic(a: usize, b: Option<usize>, kt: f64, k3: f64) -> Self {
        Self {
            kind: ContactKind::Cubic,
            cubic: k3,
            ..Self::jenkins(a, b, kt, 0.0, 0.0)
        }
    }

    /// A unilateral spring of stiffness `kn` between side `a` and side `b` (`None` is the ground), which
    /// presses when b has moved over a by more than `gap`.
    #[must_use]
    pub fn unilateral(a: Option<usize>, b: Option<usize>, kn: f64, gap: f64) -> Self {
        Self {
            kind: ContactKind::Unilateral,
            dof_a: [None, None, a],
            dof_b: [None, None, b],
            kn,
            gap,
            ..Self::jenkins(0, None, 0.0, 0.0, 0.0)
        }
    }

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

    /// Whether the contact presses at rest: then it loads the structure without vibration.
    #[must_use]
    pub fn is_preloaded(&self) -> bool {
        self.kind == ContactKind::Unilateral && self.role() == Role::Active && self.clearance() <= 0.0
    }

    /// The places (t1, t2, n as 0, 1, 2) in which the law acts, in the order of its motions.
    #[must_use]
    pub fn places(&self) -> &'static [usize] {
        match self.kind {
            ContactKind::Jenkins | ContactKind::Cubic => &[0],
            ContactKind::Unilateral => &[2],
        }
    }

    /// Number of relative motions that the law knows.
    #[must_use]
    pub fn directions(&self) -> usize {
        self.places().len()
    }

    /// The k-th of them.
    #[must_use]
    pub fn direction(&self, k: usize) -> Direction {
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
    #[must_use]
    pub fn law(&self, length: f64) -> Arc<dyn Law> {
        match self.kind {
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
        }
    }

    /// Stiffness of the k-th motion by the l-th at small motion.
    #[must_use]
    pub fn stiffness_at_rest(&self, k: usize, l: usize) -> f64 {
        debug_assert!(k == 0 && l == 0);
        match self.kind {
            ContactKind::Jenkins if self.role() == Role::Inert => 0.0,
            ContactKind::Jenkins | ContactKind::Cubic => self.kt,
            ContactKind::Unilateral if self.clearance() < 0.0 => self.kn,
            ContactKind::Unilateral => 0.0,
        }
    }

    /// Largest stiffness that the k-th motion can meet, but for terms that grow with the motion.
    #[must_use]
    pub fn stiffness(&self, k: usize) -> f64 {
        if self.places()[k] == 2 { self.kn } else { self.kt }
    }

    /// Whether the k-th motion, while the contact sticks, meets exactly [`Self::stiffness`], as friction
    /// does.
    #[must_use]
    pub fn may_stick(&self, k: usize) -> bool {
        k == 0 && matches!(self.kind, ContactKind::Jenkins)
    }

    /// Whether the stiffness may grow beyond [`Self::stiffness`], or that be zero.
    #[must_use]
    pub fn is_spring(&self) -> bool {
        matches!(self.kind, ContactKind::Cubic)
    }

    /// What the constants of the law make of the contact.
    #[must_use]
    pub fn role(&self) -> Role {
        match self.kind {
            ContactKind::Jenkins if self.kt == 0.0 || self.slip_limit() == 0.0 => Role::Inert,
            ContactKind::Jenkins if self.slip_limit().is_infinite() => Role::Spring,
            ContactKind::Cubic if self.cubic == 0.0 && self.kt == 0.0 => Role::Inert,
            ContactKind::Cubic if self.cubic == 0.0 => Role::Spring,
            ContactKind::Unilateral if self.kn == 0.0 => Role::Inert,
            ContactKind::Jenkins | ContactKind::Cubic | ContactKind::Unilateral => Role::Active,
        }
    }

    /// Slip limit μN₀; zero without friction, whatever the load.
    #[must_use]
    pub fn slip_limit(&self) -> f64 {
        if self.mu == 0.0 { 0.0 } else { self.mu * self.preload }
    }

    /// Checks the constants of the law.
    ///
    /// # Errors
    /// `NotFinite` or `Argument`, naming the constant, its value and its range.
    pub fn check_constants(&self) -> Result<()> {
        for (name, value, may_be_infinite) in [
            ("kt", self.kt, false),
            ("kn", self.kn, false),
            ("mu", self.mu, false),
            ("preload", self.preload, self.kind != ContactKind::Unilateral),
        ] {
            if value.is_nan() || (value.is_infinite() && !may_be_infinite) {
                return fail!(NotFinite, "contact: {name} = {value}, needs a finite number >= 0");
            }
            if value < 0.0 {
                return fail!(Argument, "contact: {name} = {value}, needs a number >= 0");
            }
        }
        for (name, value) in [("cubic", self.cubic), ("gap", self.gap)] {
            if !value.is_finite() {
                return fail!(NotFinite, "contact: {name} = {value}, needs a finite number");
            }
        }
        let (kt, kn, mu) = (("kt", self.kt), ("kn", self.kn), ("mu", self.mu));
        let (preload, gap, cubic) = (("preload", self.preload), ("gap", self.gap), ("cubic", self.cubic));
        let (unused, kind): (&[(&str, f64)], _) = match self.kind {
            ContactKind::Jenkins => (&[kn, gap, cubic], "Jenkins contact"),
            ContactKind::Cubic => (&[kn, mu, preload, gap], "cubic spring"),
            ContactKind::Unilateral => (&[kt, mu, cubic], "unilateral spring"),
        };
        for &(name, value) in unused {
            if value != 0.0 {
                return fail!(Argument, "contact: {name} = {value}, needs 0 for a {kind}");
            }
        }
        self.check_places(kind)
    }

    /// Degrees of freedom along directions in which the law does not act are a mistake.
    fn check_places(&self, kind: &str) -> Result<()> {
        if self.frame.is_some() {
            return Ok(());
        }
        for (name, dofs) in [("dof_a", self.dof_a), ("dof_b", self.dof_b)] {
            for (i, dof) in dofs.iter().enumerate() {
                if let Some(dof) = dof.filter(|_| !self.places().contains(&i)) {
                    return fail!(
                        Argument,
                        "contact: {name}[{i}] = {dof}, needs to be empty; a {kind} does not act along {}",
                        ["t1", "t2", "n"][i]
                    );
                }
            }
        }
        Ok(())
    }
}
