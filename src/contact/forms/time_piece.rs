//! Pieces in time: the mode of a contact between two events, and its force there, affine in the relative
//! motions.

/// Mode of a contact between two events in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
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

impl Mode {
    /// Whether the slider moves.
    pub fn moves_slider(self) -> bool {
        self != Self::Stick
    }
}

/// An event that is touched, not passed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grazing {
    /// The force of friction touches its limit.
    SlipLimit,
    /// The contact closes without normal speed.
    Landing,
}

/// Relative motions and velocities at a time.
#[derive(Clone, Copy, Debug)]
pub struct Instant {
    /// x and y
    pub motion: [f64; 2],
    /// x′ and y′
    pub rate: [f64; 2],
}

/// Forces within a step: force + slope·(motion − origin).
#[derive(Clone, Copy, Debug, Default)]
pub struct TimePiece {
    /// Tangent stiffness, rows first.
    pub slope: [[f64; 2]; 2],
    /// Forces at the begin of the step.
    pub force: [f64; 2],
    /// Relative motions at the begin of the step.
    pub origin: [f64; 2],
    /// Derivative of minus the force along x by the position of the slider.
    pub memory: f64,
}

impl TimePiece {
    /// A line of `slope` along the first motion, with `force` at the motion.
    pub fn line(slope: f64, force: f64, motion: [f64; 2]) -> Self {
        Self {
            slope: [[slope, 0.0], [0.0, 0.0]],
            force: [force, 0.0],
            origin: motion,
            memory: 0.0,
        }
    }

    /// Forces at a motion.
    #[must_use]
    pub fn at(&self, motion: [f64; 2]) -> [f64; 2] {
        let change = self.along([motion[0] - self.origin[0], motion[1] - self.origin[1]]);
        [self.force[0] + change[0], self.force[1] + change[1]]
    }

    /// Change of the forces by a change of the motion.
    pub fn along(&self, change: [f64; 2]) -> [f64; 2] {
        self.slope.map(|s| s[0] * change[0] + s[1] * change[1])
    }
}

/// Largest number of margins of a piece.
/// Kind: fixed.
pub const MARGINS: usize = 3;

/// Number of zeros that each margin of a piece has at its begin by construction.
pub type Zeros = [usize; MARGINS];

/// Writes the margin of a level: the distance of the motion beyond it in the direction of the sign.
pub fn margin_of_level(sign: f64, level: f64, x: &[f64], margin: &mut [f64]) {
    for (m, x) in margin.iter_mut().zip(x) {
        *m = sign * x;
    }
    margin[0] = sign * (x[0] - level);
}
