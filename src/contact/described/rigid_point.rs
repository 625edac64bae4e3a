//! Side a of a contact as a point of a rigid body, and axes of side b that are turned.
//!
//! The point at the arm r from the centre of mass moves by u + θ × r, and along d by d·u + (r × d)·θ.

use crate::contact::described::relative_motion::{Frame, Side, TERMS_B};

/// Point of a rigid body on side a of a contact with a frame, whose `dof_a` are the motions of the centre of mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidPoint {
    /// Degrees of freedom of the rotations about the axes of `dof_a`; `None`: there is none about this axis.
    pub rotations: [Option<usize>; 3],
    /// The point, from the centre of mass.
    pub arm: [f64; 3],
    /// Angle in radians by which the axes of side b are turned about the third one of side a.
    pub turn: f64,
}

impl RigidPoint {
    /// Motion of the point along a direction of the frame, over the translations `dofs` and the rotations.
    pub(super) fn side_a(&self, frame: &Frame, dofs: [Option<usize>; 3], direction: usize) -> Side {
        let mut side = frame.side(dofs, direction);
        let ([x, y, z], [a, b, c]) = (self.arm, frame.axes()[direction]);
        let levers = [y * c - z * b, z * a - x * c, x * b - y * a];
        for ((s, dof), lever) in side[TERMS_B..].iter_mut().zip(self.rotations).zip(levers) {
            *s = dof.filter(|_| lever != 0.0).map(|dof| (dof, lever));
        }
        side
    }

    /// Whether nothing differs from the contact of two nodes.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.rotations == [None; 3] && self.turn == 0.0
    }
}
