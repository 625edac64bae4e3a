//! The sector from the files of the finite-element program, as a model of the library.
//!
//! One of 24 equal sectors of a bladed disk with a friction ring in a groove under its rim, in two sizes: the full
//! mesh, and a reduced model whose contact and tip degrees of freedom are physical. Degrees of freedom are
//! cylindrical (r, θ, z) at each node, so that the blocks are those of every sector.
//!
//! # The sign of the wave
//!
//! Convention of the files: sector n *leads* by n·φ, φ = 2π·EO/24 with EO 21, and the matrix of a wave of ND
//! diameters is K(ND) = K0 + K1 e^{+i·ND·2π/24} + K1ᵀ e^{−i·ND·2π/24}. Convention of the library: sector s + 1
//! *lags* by 2π·EO/24, so that the matrix of harmonic h is A0 + A1 e^{−ihφ} + A1ᵀ e^{+ihφ}. Leading by 21/24 of a
//! turn is lagging by 3/24, for harmonic h by 3h/24: the same wave has engine order 3 here. K1 itself, from a
//! sector to the next one, is unchanged. Natural frequencies do not distinguish the two signs (K(−ND) is the
//! conjugate of K(ND)), the forced response with friction does.

#![allow(dead_code, reason = "the tests use a part of this module")]

use std::path::Path;

use hbvib::{Contact, ContactState, MatrixKind, MatrixView, Model, Spring};
use num_complex::Complex64;

use crate::matrix_market::{self, Matrix};
use crate::table::Table;

/// Sectors of the wheel.
pub const SECTORS: usize = 24;
/// Engine order of the wave in the convention that a sector lags behind the previous one.
pub const ENGINE_ORDER: i64 = 3;
/// Damping C = `DAMPING`·K of the structure, without the contact, s.
const DAMPING: f64 = 5e-7;

/// One of the two models.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// 293 degrees of freedom.
    Reduced,
    /// 3813 degrees of freedom.
    Full,
}

impl Size {
    /// Name in the flags, and prefix of its columns in the table of contacts.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reduced => "rom",
            Self::Full => "full",
        }
    }

    /// Prefix of the names of its files.
    fn files(self) -> &'static str {
        match self {
            Self::Reduced => "rom",
            Self::Full => "coarse",
        }
    }

    /// Degree of freedom of the blade tip in the direction θ: the forced one, and the response degree of freedom.
    pub fn tip(self) -> usize {
        match self {
            Self::Reduced => 181,
            Self::Full => 16,
        }
    }
}

/// A pair of nodes that touch, on the rim and on the ring.
#[derive(Clone, Debug)]
pub struct Pair {
    /// Position around the wheel, rad.
    pub theta: f64,
    /// Position along the axis, m.
    pub z: f64,
    /// Jenkins contacts of rim against ring: along θ and along z.
    pub friction: [Contact; 2],
    /// Bilateral spring along r; in this data set the ring does not lift off.
    pub normal: Spring,
}

/// Connection of rim and ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interface {
    /// No connection.
    Absent,
    /// The normal springs.
    Springs,
    /// The normal springs, and friction.
    Friction2d,
}

/// A sector read from files.
#[derive(Clone, Debug)]
pub struct Sector {
    /// The model.
    pub size: Size,
    /// The contact pairs in the order of the table.
    pub pairs: Vec<Pair>,
    structure: Model,
}

impl Sector {
    /// Reads the matrices and contacts of one size from a folder.
    ///
    /// # Errors
    ///
    /// A sentence naming the file, and the line or the entry.
    pub fn read(folder: &Path, size: Size) -> Result<Self, String> {
        let part = |name: &str| -> Result<(Matrix, String), String> {
            let path = folder.join(format!("{}_{name}.mtx.gz", size.files()));
            Ok((matrix_market::read(&path)?, path.display().to_string()))
        };
        let (k0, k0_path) = part("K0")?;
        let mut structure = Model::cyclic(k0.rows, SECTORS).map_err(|e| format!("{k0_path}: {e}"))?;
        let mut give = |(matrix, path): (Matrix, String), which, coupling| {
            give(&mut structure, which, coupling, &matrix.view()).map_err(|e| format!("{path}: {e}"))
        };
        give((k0, k0_path), MatrixKind::Stiffness, false)?;
        give(part("K1")?, MatrixKind::Stiffness, true)?;
        give(part("M0")?, MatrixKind::Mass, false)?;
        give(part("M1")?, MatrixKind::Mass, true)?;
        structure.set_rayleigh(0.0, DAMPING).map_err(|e| e.to_string())?;
        structure.set_wave(ENGINE_ORDER);
        let pairs = read_pairs(&folder.join("contacts.csv"), size, structure.ndof())?;
        Ok(Self { size, pairs, structure })
    }

    /// Degrees of freedom.
    pub fn ndof(&self) -> usize {
        self.structure.ndof()
    }

    /// The model without force. Contact 2p is pair p along θ, 2p + 1 along z.
    ///
    /// # Errors
    ///
    /// Those of the library.
    pub fn model(&self, interface: Interface) -> hbvib::Result<Model> {
        let mut model = self.structure.clone();
        if interface != Interface::Absent {
            let springs: Vec<Spring> = self.pairs.iter().map(|p| p.normal).collect();
            model.add_springs(&springs)?;
        }
        if interface == Interface::Friction2d {
            let contacts: Vec<Contact> = self.pairs.iter().flat_map(|p| p.friction.clone()).collect();
            model.add_contacts(&contacts)?;
        }
        Ok(model)
    }

    /// The model with friction under a force at the blade tip along θ, amplitude in N.
    ///
    /// # Errors
    ///
    /// Those of the library.
    pub fn forced(&self, force: f64) -> hbvib::Result<Model> {
        let mut model = self.model(Interface::Friction2d)?;
        model.add_force(self.size.tip(), 1, Complex64::new(force, 0.0))?;
        Ok(model)
    }
}

/// The lowest `count` natural frequencies of a model and nodal diameter, rad/s.
///
/// # Errors
///
/// Those of the library.
pub fn natural_frequencies(model: &Model, diameter: i64, state: ContactState, count: usize) -> hbvib::Result<Vec<f64>> {
    Ok(model.lowest_modes(diameter, state, count)?.omega)
}

fn give(model: &mut Model, which: MatrixKind, coupling: bool, view: &MatrixView<'_>) -> hbvib::Result<()> {
    if coupling {
        model.set_coupling(which, view)
    } else {
        model.set_matrix(which, view)
    }
}

fn read_pairs(path: &Path, size: Size, ndof: usize) -> Result<Vec<Pair>, String> {
    let table = Table::read(path)?;
    let pair = |row: usize| {
        let dof = |side: &str, direction: &str| {
            let column = format!("{}_{side}_{direction}", size.name());
            table.index(row, &column, ndof)
        };
        let (kt, kn) = (table.number(row, "kt_N_per_m")?, table.number(row, "kn_N_per_m")?);
        let (mu, preload) = (table.number(row, "mu")?, table.number(row, "N0_uniform_N")?);
        let friction = |direction: &str| {
            let (rim, ring) = (dof("rim", direction)?, dof("ring", direction)?);
            let contact = Contact::jenkins(rim, Some(ring), kt, mu, preload);
            contact.check_constants().map_err(|e| table.wrong(row, e.message()))?;
            apart(&table, row, rim, ring).map(|()| contact)
        };
        let (rim, ring) = (dof("rim", "r")?, dof("ring", "r")?);
        apart(&table, row, rim, ring)?;
        Ok(Pair {
            theta: table.number(row, "theta_rad")?,
            z: table.number(row, "z_m")?,
            friction: [friction("theta")?, friction("z")?],
            normal: Spring {
                dof_a: Some(rim),
                dof_b: Some(ring),
                sector_offset: 0,
                stiffness: kn,
            },
        })
    };
    (0..table.len()).map(pair).collect()
}

fn apart(table: &Table, row: usize, rim: usize, ring: usize) -> Result<(), String> {
    if rim == ring {
        return Err(table.wrong(row, &format!("rim and ring are both degree of freedom {rim}")));
    }
    Ok(())
}
