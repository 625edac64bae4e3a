//! The modes beside the one of a slow flow: with stuck contacts, each steady at the frequency of the forces.

use crate::analysis::synthesis::{Load, form};
use crate::error::{Result, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::inner;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::Model;
use crate::model::matrices::structure::MatrixKind;
use crate::model::natural_modes::linear_modes::ContactState;
use crate::time_integration::Element;
use num_complex::Complex64;

/// Modes that are taken, the lowest ones.
/// Kind: tuned; measured on: not recorded.
const OTHER_MODES_MOST: usize = 24;

const CONTEXT: &str = "the other modes";

/// One mode under the forces.
struct Other {
    square: f64,
    /// φᴴ C φ
    viscous: f64,
    /// φᴴ F
    force: Complex64,
}

/// The other modes: motions of what is observed and of contacts, as in the table of a mode.
pub(crate) struct OtherModes {
    modes: Vec<Other>,
    motions: usize,
    /// `motions` for each mode.
    shapes: Vec<Complex64>,
    /// Mφ of the mode of the slow flow itself, in independent degrees of freedom, and its φᴴ F; `None` if it is not among the lowest.
    pub own: Option<(Vec<Complex64>, Complex64)>,
}

impl OtherModes {
    /// Those beside the mode of a number, from 0 by rising frequency with stuck contacts.
    ///
    /// # Errors
    /// Those of the natural modes.
    pub fn new(
        model: &Model,
        load: &Load,
        number: usize,
        (dof, elements): (usize, &[Element]),
        interrupt: &Interrupt<'_>,
    ) -> Result<Self> {
        let given = model.ndof();
        let degrees = model.structure().degrees();
        let own = degrees.independent();
        let mut found = Self {
            modes: Vec::new(),
            motions: 1 + elements.iter().map(|e| e.rows.len()).sum::<usize>(),
            shapes: Vec::new(),
            own: None,
        };
        let modes = model.lowest_modes_with(0, ContactState::Stuck, own.min(OTHER_MODES_MOST), interrupt)?;
        let mass = model.structure().wave_matrix(MatrixKind::Mass, 1)?;
        let damping = model.structure().wave_matrix(MatrixKind::Damping, 1)?;
        let mut x = try_vec(own, Complex64::ZERO, CONTEXT)?;
        for (j, (shape, &omega)) in modes.shapes.chunks_exact(given).zip(&modes.omega).enumerate() {
            interrupt.check()?;
            degrees.restrict(shape, &mut x);
            let force = inner(&x, &load.force);
            if j == number {
                found.own = Some((product(&mass, &x)?, force));
                continue;
            }
            let viscous = form(&damping, &x) + 2.0 * load.ratio * omega.abs();
            let square = omega * omega.abs();
            try_push(&mut found.modes, Other { square, viscous, force }, CONTEXT)?;
            try_push(&mut found.shapes, shape[dof], CONTEXT)?;
            for row in elements.iter().flat_map(|e| &e.rows) {
                let motion = row.iter().flatten().map(|&(dof, a)| x[dof] * a).sum();
                try_push(&mut found.shapes, motion, CONTEXT)?;
            }
        }
        if found.own.is_none() {
            found.modes.clear();
        }
        Ok(found)
    }

    /// None.
    pub fn none() -> Self {
        Self {
            modes: Vec::new(),
            motions: 1,
            shapes: Vec::new(),
            own: None,
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.modes.is_empty()
    }

    /// Complex amplitude of a motion, 0 the observed one, at a frequency of the forces that changes at a rate, and its part of the
    /// first order in the rate: with Z = ω² − W² + icW, X = F/Z, it is −((2iW + c) X′ + iW′X)/Z.
    pub fn motion(&self, motion: usize, omega: f64, rate: f64) -> (Complex64, Complex64) {
        let (mut whole, mut change) = (Complex64::ZERO, Complex64::ZERO);
        for (mode, shape) in self.modes.iter().zip(self.shapes.chunks_exact(self.motions)) {
            let stiffness = Complex64::new(mode.square - omega * omega, mode.viscous * omega);
            let x = shape[motion] * mode.force / stiffness;
            let slope = x * Complex64::new(2.0 * omega, -mode.viscous) / stiffness * rate;
            let by_rate =
                -(Complex64::new(mode.viscous, 2.0 * omega) * slope + Complex64::new(0.0, rate) * x) / stiffness;
            whole += x + by_rate;
            change += by_rate;
        }
        (whole, change)
    }
}

/// A x
fn product(a: &Csc, x: &[Complex64]) -> Result<Vec<Complex64>> {
    let mut y = try_vec(x.len(), Complex64::ZERO, CONTEXT)?;
    for (j, x) in x.iter().enumerate() {
        for (i, v) in a.column(j) {
            y[i] += v * x;
        }
    }
    Ok(y)
}
