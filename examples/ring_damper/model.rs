//! The bladed disk with its ring damper: parameters, matrices and natural frequencies.
//!
//! A sector has two blade masses b2 and b1, the disk d and the ring r; friction acts between d and
//! r: b2 –Kb2– b1 –Kb1– d, d –KG– ground, d –Kd– next d, r –Kr– next r. The lumped model is that of
//! Laxalde et al., European Journal of Mechanics A/Solids 26 (2007), 676-687, with the data of
//! "Nonlinear Vibrational Analysis for Integrally Bladed Disk Using Frictional Ring Damper".

use std::error::Error;
use std::f64::consts::{PI, TAU};

use hbvib::{Contact, ContactState, LinearModes, MatrixKind, MatrixView, Model};
use num_complex::Complex64;

/// Degrees of freedom of a sector, in this order.
pub const DOFS: [&str; 4] = ["b2", "b1", "d", "r"];
/// Their numbers; a response reports all, and the first is its response degree of freedom.
pub const REPORTED_DOFS: [usize; DOFS.len()] = [B2, B1, DISK, RING];
/// The blade tip, the response degree of freedom.
pub const B2: usize = 0;
const B1: usize = 1;
const DISK: usize = 2;
const RING: usize = 3;

/// Number of the contact between disk and ring.
pub const CONTACT: usize = 0;

/// Sectors of the wheel.
pub const SECTORS: usize = 24;
const BLADE_TIP_MASS: f64 = 0.2;
const BLADE_ROOT_MASS: f64 = 0.3;
const DISK_MASS: f64 = 1.2;
const BLADE_TIP_STIFFNESS: f64 = 2e6;
const BLADE_ROOT_STIFFNESS: f64 = 1e6;
const DISK_STIFFNESS: f64 = 5e7;
const GROUND_STIFFNESS: f64 = 6e5;
const RING_STIFFNESS: f64 = 2e7;
const FRICTION: f64 = 0.3;
/// The paper does not give the radius of the ring. With this value the ring sticks at 0.5 N, slides at 50 N, and
/// damps best with 30 g at 3000 rpm, as in the paper.
const RADIUS: f64 = 0.165;

/// Parameters that a study varies; the default is the base case.
#[derive(Clone, Copy, Debug)]
pub struct Parameters {
    /// Amplitude of the force on each forced mass, N.
    pub force: f64,
    /// Whether the force acts on b2 only instead of on b2 and b1.
    pub tip_only: bool,
    /// Mass of the ring per sector, kg.
    pub ring_mass: f64,
    /// Speed that presses the ring against the disk, 1/min. It does not follow the frequency.
    pub rpm: f64,
    /// Engine order of the force.
    pub engine_order: i64,
    /// Tangential stiffness of the contact, N/m.
    pub kt: f64,
    /// Damping C = beta·K, where K is the structure without the contact, s.
    pub beta: f64,
}

impl Default for Parameters {
    fn default() -> Self {
        Self {
            force: 5.0,
            tip_only: false,
            ring_mass: 0.03,
            rpm: 3000.0,
            engine_order: 2,
            kt: 5e7,
            beta: 1.5e-6,
        }
    }
}

impl Parameters {
    /// The centrifugal force that presses the ring of one sector against the disk, N.
    pub fn normal_load(&self) -> f64 {
        self.ring_mass * RADIUS * (self.rpm * 2.0 * PI / 60.0).powi(2)
    }

    /// The relative motion of disk and ring at which the contact begins to slip, m.
    pub fn slip_length(&self) -> f64 {
        FRICTION * self.normal_load() / self.kt
    }

    /// The model of a sector with ring, contact and forces.
    ///
    /// # Errors
    ///
    /// If a parameter is out of its range.
    pub fn model(&self) -> Result<Model, Box<dyn Error>> {
        let mut model = structure(Some(self.ring_mass))?;
        model.set_rayleigh(0.0, self.beta)?;
        model.set_wave(self.engine_order);
        model.add_contact(&Contact::jenkins(
            DISK,
            Some(RING),
            self.kt,
            FRICTION,
            self.normal_load(),
        ))?;
        model.add_force(B2, 1, self.force.into())?;
        if !self.tip_only {
            model.add_force(B1, 1, self.force.into())?;
        }
        Ok(model)
    }

    /// A range of frequency, Hz, around the resonance of the first family at the nodal diameter of the engine
    /// order: from the ring sliding freely to the ring stuck, with a margin on both sides.
    ///
    /// # Errors
    ///
    /// If a parameter is out of its range.
    pub fn resonance_range(&self) -> Result<(f64, f64), Box<dyn Error>> {
        let model = self.model()?;
        let diameter = model.structure().diameter_of(1);
        let free = modes_without_ring(diameter)?;
        let stuck = model.linear_modes(diameter, ContactState::Stuck)?;
        let (a, b) = (
            free.omega[0] / TAU,
            frequency_of_most_similar(&stuck, &free.shapes[..RING]) / TAU,
        );
        let (low, high) = (a.min(b), a.max(b));
        let room = (0.3 * (high - low)).max(0.003 * high);
        Ok((((low - room) * 2.0).floor() / 2.0, ((high + room) * 2.0).ceil() / 2.0))
    }
}

/// Natural modes of a nodal diameter with the ring absent.
///
/// # Errors
///
/// If there is no such nodal diameter.
pub fn modes_without_ring(diameter: i64) -> Result<LinearModes, Box<dyn Error>> {
    Ok(structure(None)?.linear_modes(diameter, ContactState::Free)?)
}

/// Natural modes of a nodal diameter with the ring stuck to the disk by its contact stiffness.
///
/// # Errors
///
/// If there is no such nodal diameter.
pub fn modes_with_ring_stuck(parameters: &Parameters, diameter: i64) -> Result<LinearModes, Box<dyn Error>> {
    Ok(parameters.model()?.linear_modes(diameter, ContactState::Stuck)?)
}

/// The largest nodal diameter.
pub const LARGEST_DIAMETER: i64 = SECTORS as i64 / 2;

/// Masses and springs of a sector, with the ring if it has a mass.
fn structure(ring_mass: Option<f64>) -> Result<Model, Box<dyn Error>> {
    let n = if ring_mass.is_some() { RING + 1 } else { RING };
    let mut mass = vec![0.0; n * n];
    let mut stiffness = vec![0.0; n * n];
    let mut coupling = vec![0.0; n * n];
    let masses = [BLADE_TIP_MASS, BLADE_ROOT_MASS, DISK_MASS];
    for (i, m) in masses.into_iter().chain(ring_mass).enumerate() {
        mass[i * n + i] = m;
    }
    for (i, j, k) in [(B2, B1, BLADE_TIP_STIFFNESS), (B1, DISK, BLADE_ROOT_STIFFNESS)] {
        stiffness[i * n + i] += k;
        stiffness[j * n + j] += k;
        stiffness[i * n + j] -= k;
        stiffness[j * n + i] -= k;
    }
    stiffness[DISK * n + DISK] += GROUND_STIFFNESS;
    for (i, k) in [(DISK, DISK_STIFFNESS), (RING, RING_STIFFNESS)]
        .into_iter()
        .filter(|p| p.0 < n)
    {
        // One spring to the next sector and one to the sector before.
        stiffness[i * n + i] += 2.0 * k;
        coupling[i * n + i] -= k;
    }
    let mut model = Model::cyclic(n, SECTORS)?;
    model.set_matrix(MatrixKind::Mass, &MatrixView::dense(n, &mass))?;
    model.set_matrix(MatrixKind::Stiffness, &MatrixView::dense(n, &stiffness))?;
    model.set_coupling(MatrixKind::Stiffness, &MatrixView::dense(n, &coupling))?;
    Ok(model)
}

/// Angular frequency of the mode whose motion of blade and disk is most similar to `shape`.
fn frequency_of_most_similar(modes: &LinearModes, shape: &[Complex64]) -> f64 {
    let masses = [BLADE_TIP_MASS, BLADE_ROOT_MASS, DISK_MASS];
    let likeness = |mode: &[Complex64]| {
        let product = shape.iter().zip(mode).zip(masses);
        product.map(|((a, b), m)| a.conj() * b * m).sum::<Complex64>().norm()
    };
    let pairs = modes.omega.iter().zip(modes.shapes.chunks(DOFS.len()));
    let best = pairs.max_by(|a, b| likeness(a.1).total_cmp(&likeness(b.1)));
    best.map_or(0.0, |pair| *pair.0)
}
