//! Contact laws: what a host says of a contact, and the vocabulary that every law speaks.
//!
//! A law turns a periodic motion into [`Piece`]s, intervals on which its force is affine in the
//! motion; a [`Smooth`] law has none and gives the spectrum of its stiffness. Everything after that
//! (Fourier coefficients, Jacobian) is the same for all laws and lives in [`crate::aft`].

pub mod cubic;
pub mod friction;
pub mod iwan;
pub mod jenkins;
mod slider;
pub mod state;
pub mod unilateral;

use crate::error::{Result, fail};
use crate::fourier::Extremum;
use crate::harmonics::HarmonicSet;
use cubic::Cubic;
use jenkins::Jenkins;
use num_complex::Complex64;
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

/// A contact between two degrees of freedom, or between one and the ground.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    /// The law.
    pub kind: ContactKind,
    /// Degree of freedom on side a; `None` is the ground.
    pub dof_a: Option<usize>,
    /// Degree of freedom on side b; `None` is the ground.
    pub dof_b: Option<usize>,
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
            dof_a: Some(a),
            dof_b: b,
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
            dof_a: a,
            kn,
            gap,
            ..Self::jenkins(0, b, 0.0, 0.0, 0.0)
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

    /// Stiffness of the relative motion at small motion.
    #[must_use]
    pub fn stiffness_at_rest(&self) -> f64 {
        match self.kind {
            ContactKind::Jenkins if self.role() == Role::Inert => 0.0,
            ContactKind::Jenkins | ContactKind::Cubic => self.kt,
            ContactKind::Unilateral if self.clearance() < 0.0 => self.kn,
            ContactKind::Unilateral => 0.0,
        }
    }

    /// Largest stiffness that the relative motion can meet, but for cubic terms.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        self.kt.max(self.kn)
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
        Ok(())
    }
}

/// An interval on which the force is f(τ) = slope·(x(τ) − x(anchor)) + offset.
///
/// With exact events `start`, `end` and `anchor` are times in τ; with sampling they are sample
/// numbers, and the piece holds the samples start ≤ j < end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Begin of the interval.
    pub start: f64,
    /// End of the interval.
    pub end: f64,
    /// Tangent stiffness.
    pub slope: f64,
    /// Where the motion is measured from; `None`: from zero.
    pub anchor: Option<f64>,
    /// Force at the anchor.
    pub offset: f64,
}

/// A law whose force is linear·x plus a term that is homogeneous in x: f(s·x) = s^degree·f(x).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smooth {
    /// Stiffness of the linear term.
    pub linear: f64,
    /// Degree of the other term.
    pub degree: f64,
}

/// Law of one scalar relative motion. All quantities are in the solver's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Elastic Coulomb friction.
    Jenkins(Jenkins),
    /// Linear and cubic spring.
    Cubic(Cubic),
    /// Spring that opens.
    Unilateral(Unilateral),
}

impl Law {
    /// The law of a contact, with lengths in units of `length` and forces in units of
    /// `length` times the caller's stiffness.
    #[must_use]
    pub fn new(contact: &Contact, length: f64) -> Self {
        match contact.kind {
            ContactKind::Jenkins => Self::Jenkins(Jenkins {
                stiffness: contact.kt,
                limit: contact.slip_limit() / length,
            }),
            ContactKind::Cubic => Self::Cubic(Cubic {
                linear: contact.kt,
                cubic: contact.cubic * length * length,
            }),
            ContactKind::Unilateral => Self::Unilateral(Unilateral {
                stiffness: contact.kn,
                gap: contact.clearance() / length,
            }),
        }
    }

    /// Whether f(−x) = −f(x).
    #[must_use]
    pub fn is_odd(&self) -> bool {
        match self {
            Self::Jenkins(_) | Self::Cubic(_) => true,
            Self::Unilateral(_) => false,
        }
    }

    /// The law as seen at a motion `factor` times smaller: eased(s)(x) = s·law(x/s). A large factor
    /// gives the law at rest, a linear spring; 1 gives the law itself; between them runs the homotopy
    /// that finds a first point. From the identity follows, for any law with force F and Jacobian J,
    /// dF/d(ln s) = F − J X.
    #[must_use]
    pub fn eased(&self, factor: f64) -> Self {
        match *self {
            Self::Jenkins(law) => Self::Jenkins(Jenkins {
                limit: law.limit * factor,
                ..law
            }),
            Self::Cubic(law) => Self::Cubic(Cubic {
                cubic: law.cubic / (factor * factor),
                ..law
            }),
            Self::Unilateral(law) => Self::Unilateral(Unilateral {
                gap: law.gap * factor,
                ..law
            }),
        }
    }

    /// The factor of [`Self::eased`] at which the law just is a linear spring for a motion of the given
    /// half range (max − min)/2 and mean: friction sticks, a cubic term is small against the
    /// stiffness `reference`.
    #[must_use]
    pub fn sticking_factor(&self, half_range: f64, mean: f64, reference: f64) -> f64 {
        match self {
            Self::Jenkins(law) => law.stiffness * half_range / law.limit,
            Self::Cubic(law) => law.sticking_factor(half_range + mean.abs(), reference),
            Self::Unilateral(law) => (half_range - mean).max(0.0) / law.gap,
        }
    }

    /// For a law without events: fills the spectrum Sₙ = (1/2π)∫ s(x(τ)) e^{−inτ} dτ, n ≥ 0, of the
    /// tangent stiffness s of its homogeneous term. `None`, and nothing is written: the law has
    /// events and speaks in pieces.
    pub fn nonlinear_spectrum(&self, set: &HarmonicSet, motion: &[f64], spectrum: &mut [Complex64]) -> Option<Smooth> {
        match self {
            Self::Jenkins(_) | Self::Unilateral(_) => None,
            Self::Cubic(law) => {
                law.spectrum(set, motion, spectrum);
                Some(Smooth {
                    linear: law.linear,
                    degree: 3.0,
                })
            }
        }
    }

    /// Exact pieces over one turn (half a turn for sets of odd harmonics) from the reversals of
    /// the motion; none for a smooth law.
    pub fn pieces(&self, set: &HarmonicSet, motion: &[f64], reversals: &[Extremum], pieces: &mut Vec<Piece>) {
        pieces.clear();
        match self {
            Self::Jenkins(law) => law.pieces(set, motion, reversals, pieces),
            Self::Unilateral(law) => law.pieces(set, motion, reversals, pieces),
            Self::Cubic(_) => {}
        }
    }

    /// Pieces in sample numbers over one turn from equidistant samples of the motion; none for a
    /// smooth law.
    pub fn sampled_pieces(&self, samples: &[f64], pieces: &mut Vec<Piece>) {
        pieces.clear();
        match self {
            Self::Jenkins(law) => law.sampled_pieces(samples, pieces),
            Self::Unilateral(law) => law.sampled_pieces(samples, pieces),
            Self::Cubic(_) => {}
        }
    }
}
