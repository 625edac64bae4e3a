//! The matrices of a block of perturbations: m sectors closed to a ring with the factor c.
//!
//! Between the sectors s and s′ of the ring lies A_{ss′} = 1/m Σ_δ A(δ) e^{−2πi(s − s′)δ/N}, the sum over the diameters
//! δ of the block. A relative motion that reaches over the end of the ring has the factor c there.

use crate::error::{Result, try_push};
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::sparse::{Csc, Form};
use crate::model::matrices::sector_motion::{MOTION_TERMS, SectorMotion};
use crate::model::matrices::structure::{MatrixKind, Structure};
use crate::model::matrices::wave::Wave;
use crate::stability::closure::Closure;
use crate::time_integration::{Number, System, VariationalElement, VariationalEquations};
use num_complex::Complex64;

const CONTEXT: &str = "the equations of perturbations";

/// Entries of a sum over diameters below this share of the largest are rounding.
/// Kind: rounding.
const RING_ROUNDING: f64 = 1e-14;

/// Row of a relative motion over the ring: pairs (degree of freedom, coefficient).
pub(super) type Row = [Option<(usize, Complex64)>; MOTION_TERMS];

/// A contact of the ring.
pub(super) struct RingElement {
    /// Index of the element in the structure in time.
    pub source: usize,
    pub rows: Vec<Row>,
    /// Index of the slider of this contact among the sliders of the ring; `None` without a slider.
    pub slider: Option<usize>,
    /// Whether the law of the contact has no events.
    pub smooth: bool,
}

/// Matrices and contacts of a block of perturbations.
pub(super) struct Ring {
    pub closure: Closure,
    /// Number of degrees of freedom of all sectors of the ring.
    pub order: usize,
    pub mass: Csc,
    pub damping: Csc,
    pub stiffness: Csc,
    pub elements: Vec<RingElement>,
    /// Number of sliders of the ring.
    pub sliders: usize,
}

impl Ring {
    pub fn new(structure: &Structure, system: &System<'_>, closure: Closure) -> Result<Self> {
        let order = structure.ndof() * closure.sectors;
        let mass = matrix(structure, MatrixKind::Mass, &closure)?;
        let mut stiffness = matrix(structure, MatrixKind::Stiffness, &closure)?;
        let mut elements = Vec::new();
        let mut sliders = 0;
        for (source, element) in system.elements.iter().enumerate() {
            if element.sector >= closure.sectors {
                continue;
            }
            let mut rows = Vec::new();
            for motion in &element.motions {
                try_push(&mut rows, row(structure, motion, element.sector, &closure), CONTEXT)?;
            }
            let slider = element.slider().map(|_| sliders);
            sliders += usize::from(slider.is_some());
            try_push(
                &mut elements,
                RingElement {
                    source,
                    rows,
                    slider,
                    smooth: element.smooth().is_some(),
                },
                CONTEXT,
            )?;
        }
        let mut entries = Vec::new();
        for spring in system.springs.iter().filter(|s| s.sector < closure.sectors) {
            let row = row(structure, &spring.motion, spring.sector, &closure);
            for &(i, a) in row.iter().flatten() {
                for &(j, b) in row.iter().flatten() {
                    try_push(&mut entries, (i, j, spring.stiffness * a.conj() * b), CONTEXT)?;
                }
            }
        }
        if !entries.is_empty() {
            let springs = Csc::from_triplets(order, order, entries)?;
            let one = Complex64::ONE;
            stiffness = Csc::sum(order, &[(one, &stiffness, Form::Plain), (one, &springs, Form::Plain)])?;
        }
        Ok(Self {
            closure,
            order,
            mass,
            damping: matrix(structure, MatrixKind::Damping, &closure)?,
            stiffness,
            elements,
            sliders,
        })
    }

    /// Number of states of a perturbation: displacements, velocities and sliders.
    pub fn states(&self) -> usize {
        2 * self.order + self.sliders
    }

    /// Whether matrices and relative motions are real.
    pub fn is_real(&self) -> bool {
        let rows = self.elements.iter().flat_map(|e| e.rows.iter().flatten());
        [&self.mass, &self.damping, &self.stiffness].iter().all(|a| a.is_real())
            && rows.flatten().all(|(_, a)| a.im == 0.0)
    }

    /// The equations of perturbations of the ring; in real numbers their imaginary parts are left out.
    pub fn equations<T: Number>(&self, interrupt: &Interrupt<'_>) -> Result<VariationalEquations<T>> {
        let mut elements = Vec::new();
        for e in &self.elements {
            let mut rows = Vec::new();
            for row in &e.rows {
                try_push(&mut rows, row.map(|term| term.map(|(dof, a)| (dof, T::of(a)))), CONTEXT)?;
            }
            let element = VariationalElement {
                source: e.source,
                rows,
                slider: e.slider,
                smooth: e.smooth,
            };
            try_push(&mut elements, element, CONTEXT)?;
        }
        let matrices = [&self.mass, &self.damping, &self.stiffness];
        VariationalEquations::new(matrices, elements, self.sliders, interrupt)
    }
}

/// Matrix M, C or K of the ring.
fn matrix(structure: &Structure, which: MatrixKind, closure: &Closure) -> Result<Csc> {
    let (ndof, sectors) = (structure.ndof(), closure.sectors);
    let count = structure.sectors() / sectors;
    let mut waves = Vec::new();
    for d in 0..sectors {
        let diameter = (d * count + closure.index) as i64;
        let wave = match which {
            MatrixKind::Stiffness => structure.acting_stiffness(Wave::Diameter(diameter))?,
            which => structure.diameter_matrix(which, diameter)?,
        };
        try_push(&mut waves, wave, CONTEXT)?;
    }
    let largest = waves.iter().fold(0.0_f64, |m, a| m.max(a.max_abs()));
    let share = 1.0 / sectors as f64;
    let mut entries = Vec::new();
    for offset in 1 - sectors as i64..sectors as i64 {
        let mut terms = Vec::new();
        for (d, a) in waves.iter().enumerate() {
            let turn = structure.wave_phase((d * count + closure.index) as i64, -offset);
            try_push(&mut terms, (share * turn, a, Form::Plain), CONTEXT)?;
        }
        let block = Csc::sum(ndof, &terms)?;
        for j in 0..ndof {
            for (i, mut v) in block.column(j) {
                if v.im.abs() <= RING_ROUNDING * largest {
                    v.im = 0.0;
                }
                if v.norm() <= RING_ROUNDING * largest {
                    continue;
                }
                for s in 0..sectors as i64 {
                    let to = s + offset;
                    if (0..sectors as i64).contains(&to) {
                        let entry = (s as usize * ndof + i, to as usize * ndof + j, v);
                        try_push(&mut entries, entry, CONTEXT)?;
                    }
                }
            }
        }
    }
    Csc::from_triplets(ndof * sectors, ndof * sectors, entries)
}

/// Row of a relative motion whose side a lies in sector `s`.
fn row(structure: &Structure, motion: &SectorMotion, s: usize, closure: &Closure) -> Row {
    let (ndof, all) = (structure.ndof(), structure.sectors() as i64);
    let place = |dof: usize, offset: i64| (s as i64 + offset).rem_euclid(all) as usize * ndof + dof;
    motion.ring_row(place).map(|term| {
        term.map(|(dof, a)| {
            let (sector, within) = (dof / ndof, dof % ndof);
            let turns = sector / closure.sectors;
            let place = sector % closure.sectors * ndof + within;
            (place, a * closure.factor(structure, turns))
        })
    })
}
