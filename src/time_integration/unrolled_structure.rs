//! The structure in time: M ẍ + C ẋ + K x + f = F(t) for all sectors that the wave needs, with its loads, springs and
//! contacts.

use crate::contact::forms::time_piece::Mode;
use crate::error::{Result, Status, fail, try_push, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::factors::factor::Factor;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::Model;
use crate::model::matrices::degree_map::DegreeMap;
use crate::model::matrices::structure::{MatrixKind, Structure};
use crate::time_integration::event_law::{Element, OF_ONE_SECTOR, Spring, unroll};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Operations of an element at one time.
/// Kind: block.
pub(super) const OF_ONE_ELEMENT: usize = 20;

const CONTEXT: &str = "the structure in time";

/// A real sparse matrix, column by column.
pub(crate) struct Sparse {
    starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
}

impl Sparse {
    fn new(a: &Csc) -> Result<Self> {
        let mut real = Self {
            starts: try_vec(a.col_ptr.len(), 0, CONTEXT)?,
            rows: try_vec(a.row_idx.len(), 0, CONTEXT)?,
            values: try_vec(a.values.len(), 0.0, CONTEXT)?,
        };
        real.starts.copy_from_slice(&a.col_ptr);
        real.rows.copy_from_slice(&a.row_idx);
        for (real, v) in real.values.iter_mut().zip(&a.values) {
            *real = v.re;
        }
        Ok(real)
    }

    /// y ← y + s·A x.
    pub fn multiply_add(&self, s: f64, x: &[f64], y: &mut [f64]) {
        for (j, &x) in x.iter().enumerate() {
            let sx = s * x;
            if sx != 0.0 {
                for k in self.starts[j]..self.starts[j + 1] {
                    y[self.rows[k]] += self.values[k] * sx;
                }
            }
        }
    }

    /// Visits the entries of the matrix: `put(row, column, value)`.
    pub fn each(&self, mut put: impl FnMut(usize, usize, f64)) {
        for j in 0..self.starts.len() - 1 {
            for k in self.starts[j]..self.starts[j + 1] {
                put(self.rows[k], j, self.values[k]);
            }
        }
    }
}

/// Factors of the mass matrix.
enum Mass {
    /// Reciprocals 1/mᵢᵢ of a diagonal mass matrix.
    Diagonal(Vec<f64>),
    General {
        factor: Box<Factor>,
        buffer: Vec<Complex64>,
    },
}

/// A harmonic force Re(value·e^{i·harmonic·ωt}).
#[derive(Clone)]
pub(crate) struct Load {
    pub dof: usize,
    pub harmonic: usize,
    pub value: Complex64,
}

/// The equations of motion of all carried sectors.
pub(crate) struct System<'s> {
    /// Interrupt that every loop of the integration checks.
    pub interrupt: &'s Interrupt<'s>,
    /// Number of independent degrees of freedom of a sector.
    pub ndof: usize,
    /// Map from the caller's degrees of freedom to the independent ones.
    pub degrees: DegreeMap,
    pub wave: CarriedSectors,
    /// Angular frequency of harmonic 1, at time 0 where it changes.
    pub omega: f64,
    /// Its change per time; 0 in a periodic motion.
    pub omega_rate: f64,
    pub matrices: Matrices,
    pub loads: Vec<Load>,
    /// The springs within the stiffness.
    pub springs: Vec<Spring>,
    /// Contacts with events or smooth laws, all sectors of one contact after the other.
    pub elements: Vec<Element>,
}

/// The sectors that are carried, and how the others follow from them.
pub(crate) struct CarriedSectors {
    /// Sectors that are carried.
    pub sectors: usize,
    /// Number of lapses in a period.
    pub lapses: usize,
    /// Whether only half of the sectors are carried, and the others move opposite to them.
    pub folded: bool,
    /// Number j of sectors with x_{s+j}(t + T/sectors) = x_s(t).
    pub follower: usize,
}

/// Matrices of a sector.
pub(crate) struct Matrices {
    solver: Mass,
    /// M
    pub inertia: Sparse,
    /// Damping matrix C of all carried sectors.
    pub damping: Sparse,
    /// Stiffness matrix K with springs and contacts that always stick.
    pub stiffness: Sparse,
}

impl<'s> System<'s> {
    /// The structure of a model at angular frequency `omega`.
    pub fn new(model: &Model, omega: f64, interrupt: &'s Interrupt<'s>) -> Result<Self> {
        let mut system = Self::unforced(model, omega, interrupt)?;
        system.apply_forces(&*model.at_frequency(omega)?)?;
        Ok(system)
    }

    /// The structure of a model at angular frequency `omega`, without the forces of the model.
    pub fn unforced(model: &Model, omega: f64, interrupt: &'s Interrupt<'s>) -> Result<Self> {
        interrupt.phase(Phase::Setup, 0.0)?;
        let model = &*model.at_frequency(omega)?;
        let structure = model.structure();
        refuse_structural_damping(structure, omega)?;
        let (ndof, sectors) = (structure.ndof(), structure.repeating_sectors());
        let (mut springs, mut elements) = (Vec::new(), Vec::new());
        for spring in model.springs() {
            let motion = structure.spring_motion(spring);
            for s in 0..sectors {
                interrupt.check_before(OF_ONE_SECTOR)?;
                try_push(
                    &mut springs,
                    Spring::new(structure, &motion, s, spring.stiffness),
                    CONTEXT,
                )?;
            }
        }
        unroll(structure, model.contacts(), &mut springs, &mut elements, interrupt)?;
        let inertia = structure.unrolled(MatrixKind::Mass, interrupt)?;
        let damping = structure.unrolled(MatrixKind::Damping, interrupt)?;
        let stiffness = with_springs(
            &structure.unrolled(MatrixKind::Stiffness, interrupt)?,
            &springs,
            interrupt,
        )?;
        interrupt.check()?;
        Ok(Self {
            interrupt,
            ndof,
            degrees: structure.degrees().clone(),
            wave: CarriedSectors {
                sectors,
                lapses: sectors,
                folded: false,
                follower: structure.sectors_per_part(),
            },
            omega,
            omega_rate: 0.0,
            matrices: Matrices {
                solver: Mass::new(&inertia, ndof, interrupt)?,
                inertia: Sparse::new(&inertia)?,
                damping: Sparse::new(&damping)?,
                stiffness: Sparse::new(&stiffness)?,
            },
            loads: Vec::new(),
            springs,
            elements,
        })
    }

    fn apply_forces(&mut self, model: &Model) -> Result<()> {
        let structure = model.structure();
        for force in model.excitation().forces() {
            let (offset, terms) = structure.degrees().image(force.dof);
            for (dof, c) in terms {
                for s in 0..self.wave.sectors {
                    self.interrupt.check_before(OF_ONE_SECTOR)?;
                    let load = Load {
                        dof: (s + offset as usize) % self.wave.sectors * self.ndof + dof,
                        harmonic: force.harmonic,
                        value: c * force.value * structure.phase(force.harmonic, s as i64),
                    };
                    try_push(&mut self.loads, load, CONTEXT)?;
                }
            }
        }
        Ok(())
    }

    /// Adds forces of a harmonic on all degrees of freedom of this sector; the others lag with the wave.
    pub fn add_forces(&mut self, structure: &Structure, harmonic: usize, force: &[Complex64]) -> Result<()> {
        for s in 0..self.wave.sectors {
            self.interrupt.check_before(OF_ONE_SECTOR)?;
            let phase = structure.phase(harmonic, s as i64);
            for (dof, &value) in force.iter().enumerate().filter(|(_, f)| **f != Complex64::ZERO) {
                let load = Load {
                    dof: s * self.ndof + dof,
                    harmonic,
                    value: value * phase,
                };
                try_push(&mut self.loads, load, CONTEXT)?;
            }
        }
        Ok(())
    }

    /// Number of operations of one product with the matrices, for the checks of the interrupt.
    pub fn operations(&self) -> u64 {
        let entries = self.matrices.stiffness.values.len()
            + self.matrices.damping.values.len()
            + self.matrices.inertia.values.len();
        (2 * entries + OF_ONE_ELEMENT * self.elements.len()) as u64 + 1000
    }

    /// Number of degrees of freedom of all carried sectors.
    pub fn order(&self) -> usize {
        self.ndof * self.wave.sectors
    }

    /// Length of a lapse: part of the period after which every sector repeats the motion of another one.
    pub fn lapse(&self) -> f64 {
        TAU / self.omega / self.wave.lapses as f64
    }

    /// The sector whose motion after a lapse equals the present one of sector `s`, and the sign with which it does.
    pub fn after_lapse(&self, s: usize) -> (usize, f64) {
        let to = s + self.wave.follower;
        let opposite = self.wave.folded && !(to / self.wave.sectors).is_multiple_of(2);
        (to % self.wave.sectors, if opposite { -1.0 } else { 1.0 })
    }

    /// The equations of half the sectors, for motions whose other half moves opposite to them. The number of sectors
    /// must be even, forces must have odd harmonics, and laws must be odd.
    pub fn folded(&self) -> Result<Self> {
        let half = self.wave.sectors / 2;
        let n = half * self.ndof;
        let fold = |a: &Sparse| -> Result<Csc> {
            let mut entries = try_vec(a.values.len(), (0, 0, Complex64::ZERO), CONTEXT)?;
            let mut count = 0;
            a.each(|i, j, v| {
                if i < n {
                    entries[count] = if j < n {
                        (i, j, v.into())
                    } else {
                        (i, j - n, (-v).into())
                    };
                    count += 1;
                }
            });
            entries.truncate(count);
            Csc::from_triplets(n, n, entries)
        };
        let (mut loads, mut elements) = (Vec::new(), Vec::new());
        for load in self.loads.iter().filter(|load| load.dof < n) {
            try_push(&mut loads, load.clone(), CONTEXT)?;
        }
        for e in self.elements.iter().filter(|e| e.sector < half) {
            let mut e = e.clone();
            for (dof, a) in e.rows.iter_mut().flatten().flatten().filter(|(dof, _)| *dof >= n) {
                (*dof, *a) = (*dof - n, -*a);
            }
            try_push(&mut elements, e, CONTEXT)?;
        }
        let inertia = fold(&self.matrices.inertia)?;
        Ok(Self {
            interrupt: self.interrupt,
            ndof: self.ndof,
            degrees: self.degrees.clone(),
            wave: CarriedSectors {
                sectors: half,
                lapses: self.wave.lapses,
                folded: true,
                follower: self.wave.follower,
            },
            omega: self.omega,
            omega_rate: self.omega_rate,
            matrices: Matrices {
                solver: Mass::new(&inertia, self.ndof, self.interrupt)?,
                inertia: Sparse::new(&inertia)?,
                damping: Sparse::new(&fold(&self.matrices.damping)?)?,
                stiffness: Sparse::new(&fold(&self.matrices.stiffness)?)?,
            },
            loads,
            springs: Vec::new(),
            elements,
        })
    }

    /// Whether every law is linear between events.
    pub fn is_piecewise_linear(&self) -> bool {
        !self.elements.iter().any(|e| e.smooth().is_some())
    }

    /// a ← M⁻¹ a.
    pub fn accelerate(&mut self, a: &mut [f64]) -> Result<()> {
        match &mut self.matrices.solver {
            Mass::Diagonal(inverse) => {
                for (a, m) in a.iter_mut().zip(inverse) {
                    *a *= *m;
                }
            }
            Mass::General { factor, buffer } => {
                for (z, a) in buffer.iter_mut().zip(a.iter()) {
                    *z = (*a).into();
                }
                factor.solve(buffer, false, self.interrupt)?;
                for (a, z) in a.iter_mut().zip(buffer.iter()) {
                    *a = z.re;
                }
            }
        }
        Ok(())
    }

    /// Adds the loads at time t to `f`.
    pub fn load(&self, t: f64, f: &mut [f64]) {
        for load in &self.loads {
            f[load.dof] += (load.value * self.turn(load.harmonic, t)).re;
        }
    }

    /// Phase factor e^{ihφ} at time t, with φ = ωt, or φ = ωt + ω′t²/2 where the frequency changes.
    pub fn turn(&self, harmonic: usize, t: f64) -> Complex64 {
        let h = harmonic as f64;
        if self.omega_rate == 0.0 {
            return Complex64::cis(h * self.omega * t);
        }
        Complex64::cis(h * t * (self.omega + 0.5 * self.omega_rate * t))
    }

    /// Sets the modes at a state; stretches are moved into their range. `dependent` receives the modes of sliders
    /// whose place follows from the motion.
    pub fn begin(&self, x: &[f64], v: &[f64], stretch: &mut [f64], modes: &mut [Mode], dependent: &mut [Option<Mode>]) {
        for (i, e) in self.elements.iter().enumerate() {
            (modes[i], dependent[i]) = match e.events() {
                Some(law) => law.begin(&e.instant(x, v), &mut stretch[i]),
                None => (Mode::Smooth, None),
            };
        }
    }
}

/// Stiffness K with the springs added.
fn with_springs(stiffness: &Csc, springs: &[Spring], interrupt: &Interrupt<'_>) -> Result<Csc> {
    let n = stiffness.rows;
    let mut entries = Vec::new();
    for j in 0..n {
        interrupt.check_before(OF_ONE_SECTOR)?;
        for (i, v) in stiffness.column(j) {
            try_push(&mut entries, (i, j, v), CONTEXT)?;
        }
    }
    for spring in springs {
        interrupt.check_before(OF_ONE_SECTOR)?;
        for &(i, a) in spring.row.iter().flatten() {
            for &(j, b) in spring.row.iter().flatten() {
                try_push(&mut entries, (i, j, (spring.stiffness * a * b).into()), CONTEXT)?;
            }
        }
    }
    Csc::from_triplets(n, n, entries)
}

impl Mass {
    fn new(m: &Csc, ndof: usize, interrupt: &Interrupt<'_>) -> Result<Self> {
        refuse_massless(m, ndof)?;
        if (0..m.cols).all(|j| m.column(j).all(|(i, v)| i == j || v.re == 0.0)) {
            let mut inverse = try_vec(m.cols, 0.0, CONTEXT)?;
            for (i, d) in inverse.iter_mut().enumerate() {
                *d = 1.0 / m.get(i, i).re;
            }
            return Ok(Self::Diagonal(inverse));
        }
        let mut factor = Box::new(Factor::new(m, 1)?);
        if let Err(e) = factor.factor(m, interrupt) {
            return match e.status {
                Status::Singular => fail!(
                    Unsupported,
                    "the mass matrix is singular: some motion in time has no differential equation; give it mass"
                ),
                _ => Err(e),
            };
        }
        Ok(Self::General {
            factor,
            buffer: try_vec(m.cols, Complex64::ZERO, CONTEXT)?,
        })
    }
}

/// Refuses degrees of freedom without mass, `ndof` to a sector.
///
/// # Errors
/// `Unsupported`.
pub(crate) fn refuse_massless(m: &Csc, ndof: usize) -> Result<()> {
    match (0..m.cols).find(|&i| m.get(i, i).re <= 0.0) {
        Some(i) => fail!(
            Unsupported,
            "degree of freedom {} has no mass: its motion in time has no differential equation; give it mass or remove it",
            i % ndof
        ),
        None => Ok(()),
    }
}

/// Refuses structural damping, which defines no motion in time: its force depends on the future of the motion, too
/// (Crandall 1970, doi:10.1016/0022-460X(70)90105-5).
///
/// # Errors
/// `Unsupported`.
pub(crate) fn refuse_structural_damping(structure: &Structure, omega: f64) -> Result<()> {
    const REASON: &str = "structural damping has no causal law in time, only harmonics, and is not integrated";
    let eta = structure.loss_factor();
    if structure.has_structural_matrix() {
        return fail!(
            Unsupported,
            "{REASON}; its viscous equivalent at angular frequency {omega} is the damping matrix D/{omega} instead of \
             the structural matrix D"
        );
    }
    if structure.has_complex_stiffness() {
        return fail!(
            Unsupported,
            "{REASON}; the viscous equivalent of a complex symmetric stiffness K at angular frequency {omega} is the damping \
             matrix Im K/{omega} beside the stiffness Re K"
        );
    }
    if eta != 0.0 {
        return fail!(
            Unsupported,
            "{REASON}; the viscous equivalent of the loss factor {eta} at angular frequency {omega} is Rayleigh \
             damping with beta_stiffness = {:.6e}",
            eta / omega
        );
    }
    Ok(())
}
