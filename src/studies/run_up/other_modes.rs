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

/// One of the other modes, under the forces.
struct Other {
    square: f64,
    /// Viscous damping φᴴ C φ, with unit modal mass.
    viscous: f64,
    /// Modal force φᴴ F.
    force: Complex64,
}

/// The other modes: their observed displacements and relative motions at contacts, arranged as in a mode's table.
pub(crate) struct OtherModes {
    modes: Vec<Other>,
    motions: usize,
    /// Motions of each mode, `motions` numbers a mode.
    shapes: Vec<Complex64>,
    /// Product Mφ of the slow flow's own mode, over the independent degrees of freedom, and its modal force φᴴ F;
    /// `None` if it is not among the lowest modes.
    pub own: Option<(Vec<Complex64>, Complex64)>,
}

impl OtherModes {
    /// The modes beside mode `number`, counted from 0 by rising frequency with stuck contacts.
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

    /// An empty set of modes.
    pub fn none() -> Self {
        Self {
            modes: Vec::new(),
            motions: 1,
            shapes: Vec::new(),
            own: None,
        }
    }

    /// Whether the set of other modes is empty.
    pub fn is_empty(&self) -> bool {
        self.modes.is_empty()
    }

    /// Complex amplitude of a motion (0: the observed one) at a force frequency W that changes at a rate; and its
    /// part of first order in the rate. With Z = ω² − W² + icW and X = F/Z, this part is −((2iW + c) X′ + iW′X)/Z.
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

/// Product A x of a sparse matrix and a vector.
fn product(a: &Csc, x: &[Complex64]) -> Result<Vec<Complex64>> {
    let mut y = try_vec(x.len(), Complex64::ZERO, CONTEXT)?;
    for (j, x) in x.iter().enumerate() {
        for (i, v) in a.column(j) {
            y[i] += v * x;
        }
    }
    Ok(y)
}
