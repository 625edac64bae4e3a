//! Contacts of each law by their degrees of freedom and constants.

use crate::contact::described::description::Contact;
use crate::contact::laws::{ContactKind, Cubic, Friction2d, Friction3d, Jenkins, Regularised, Unilateral};

impl Contact {
    /// A contact along t1 between degree of freedom `a` and `b` (or the ground).
    #[must_use]
    pub fn between(a: usize, b: Option<usize>, kind: ContactKind) -> Self {
        Self::of_sides(kind, [Some(a), None, None], [b, None, None])
    }

    /// A contact between two sides by their degrees of freedom along t1, t2 and n; `None` is the ground, and places that are
    /// not used.
    #[must_use]
    pub fn of_sides(kind: ContactKind, dof_a: [Option<usize>; 3], dof_b: [Option<usize>; 3]) -> Self {
        Self {
            kind,
            dof_a,
            dof_b,
            frame: None,
            sector_offset: 0,
            dofs: Vec::new(),
            rigid: None,
        }
    }

    /// A polynomial or law of the caller over the motions of degrees of freedom.
    #[must_use]
    pub fn over(dofs: Vec<usize>, kind: ContactKind) -> Self {
        Self {
            dofs,
            ..Self::of_sides(kind, [None; 3], [None; 3])
        }
    }

    /// A Jenkins contact between degree of freedom `a` and `b` (or the ground).
    #[must_use]
    pub fn jenkins(a: usize, b: Option<usize>, kt: f64, mu: f64, preload: f64) -> Self {
        let law = Jenkins {
            kt,
            mu,
            preload,
            slider: 0.0,
        };
        Self::between(a, b, ContactKind::Jenkins(law))
    }

    /// Friction of stiffness `kt` along a direction under a normal load of stiffness `kn`, between the
    /// degrees of freedom (tangential, normal) of side `a` and side `b`; `None` is the ground.
    #[must_use]
    pub fn friction_2d(
        a: [Option<usize>; 2],
        b: [Option<usize>; 2],
        (kt, kn): (f64, f64),
        mu: f64,
        preload: f64,
    ) -> Self {
        let law = Friction2d {
            kt,
            kn,
            mu,
            preload,
            ..Friction2d::default()
        };
        Self::of_sides(ContactKind::Friction2d(law), [a[0], None, a[1]], [b[0], None, b[1]])
    }

    /// Friction as in [`Self::friction_2d`] in the plane of two tangential directions, between the degrees of freedom along t1,
    /// t2 and n.
    #[must_use]
    pub fn friction_3d(
        a: [Option<usize>; 3],
        b: [Option<usize>; 3],
        (kt, kn): (f64, f64),
        mu: f64,
        preload: f64,
    ) -> Self {
        let law = Friction3d {
            kt,
            kn,
            mu,
            preload,
            ..Friction3d::default()
        };
        Self::of_sides(ContactKind::Friction3d(law), a, b)
    }

    /// Regularised friction of limit μN₀ between degree of freedom `a` and `b` (or the ground).
    #[must_use]
    pub fn regularised(a: usize, b: Option<usize>, mu: f64, preload: f64, velocity: f64) -> Self {
        let law = Regularised { mu, preload, velocity };
        Self::between(a, b, ContactKind::Regularised(law))
    }

    /// A spring f = kt·y + k3·y³ between degree of freedom `a` and `b` (or the ground), hardening for
    /// k3 > 0, softening for k3 < 0.
    #[must_use]
    pub fn cubic(a: usize, b: Option<usize>, kt: f64, k3: f64) -> Self {
        Self::between(a, b, ContactKind::Cubic(Cubic { kt, cubic: k3 }))
    }

    /// A unilateral spring of stiffness `kn` between side `a` and side `b` (`None` is the ground), which
    /// presses when b has moved over a by more than `gap`.
    #[must_use]
    pub fn unilateral(a: Option<usize>, b: Option<usize>, kn: f64, gap: f64) -> Self {
        let law = Unilateral { kn, preload: 0.0, gap };
        Self::of_sides(ContactKind::Unilateral(law), [None, None, a], [None, None, b])
    }
}
