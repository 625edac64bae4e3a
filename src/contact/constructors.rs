//! Contacts of each law by their degrees of freedom and constants.

use crate::contact::description::Contact;
use crate::contact::laws::registry::ContactKind;

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
            velocity: 0.0,
            slider: [0.0; 2],
            dofs: Vec::new(),
            rigid: None,
        }
    }

    /// A law without constants of its own between degree of freedom `a` and `b` (or the ground): a
    /// table, or a polynomial or law of the caller over one motion.
    #[must_use]
    pub fn between(a: usize, b: Option<usize>, kind: ContactKind) -> Self {
        Self {
            kind,
            ..Self::jenkins(a, b, 0.0, 0.0, 0.0)
        }
    }

    /// A polynomial or law of the caller over the motions of degrees of freedom.
    #[must_use]
    pub fn over(dofs: Vec<usize>, kind: ContactKind) -> Self {
        Self {
            kind,
            dof_a: [None; 3],
            dofs,
            ..Self::jenkins(0, None, 0.0, 0.0, 0.0)
        }
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
        Self {
            kind: ContactKind::Friction2d,
            dof_a: [a[0], None, a[1]],
            dof_b: [b[0], None, b[1]],
            kn,
            ..Self::jenkins(0, None, kt, mu, preload)
        }
    }

    /// The same in the plane of two tangential directions, between the degrees of freedom along t1, t2
    /// and n.
    #[must_use]
    pub fn friction_3d(
        a: [Option<usize>; 3],
        b: [Option<usize>; 3],
        (kt, kn): (f64, f64),
        mu: f64,
        preload: f64,
    ) -> Self {
        Self {
            kind: ContactKind::Friction3d,
            dof_a: a,
            dof_b: b,
            kn,
            ..Self::jenkins(0, None, kt, mu, preload)
        }
    }

    /// Regularised friction of limit μN₀ between degree of freedom `a` and `b` (or the ground).
    #[must_use]
    pub fn regularised(a: usize, b: Option<usize>, mu: f64, preload: f64, velocity: f64) -> Self {
        Self {
            kind: ContactKind::Regularised,
            velocity,
            ..Self::jenkins(a, b, 0.0, mu, preload)
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
}
