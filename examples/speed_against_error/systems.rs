//! The structures whose responses are timed: one of each kind of law, some with many contacts or masses, one with light damping.

use std::error::Error;
use std::f64::consts::TAU;
use std::path::Path;

use hbvib::{Contact, ContactState, MatrixKind, MatrixView, Model};
use num_complex::Complex64;

use crate::model::{B2, Parameters};
use crate::sector::{Sector, Size};

/// A structure, the range of its response, and the ways in which that is computed.
pub struct System {
    /// Letter that identifies the system in files.
    pub key: char,
    /// Description.
    pub title: &'static str,
    /// Structure, contacts and forces.
    pub model: Model,
    /// Range of angular frequency of the response.
    pub range: (f64, f64),
    /// The response degree of freedom.
    pub response: usize,
    /// Highest harmonics of the fixed ways, ascending, as accurate as the laws allow.
    pub fixed: &'static [usize],
    /// Highest harmonics combined with each of [`SAMPLES`].
    pub sampled: &'static [usize],
    /// Requested relative errors.
    pub tolerances: &'static [f64],
    /// Harmonics and samples of the truth, which is checked with half of them.
    pub truth: (usize, usize),
}

/// Samples per period of the sampled ways.
pub const SAMPLES: [usize; 4] = [64, 256, 1024, 4096];

/// Requested relative errors.
const TOLERANCES: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-6];

type Built = Result<System, Box<dyn Error>>;

/// All systems; that of finite elements is read from a folder.
///
/// # Errors
///
/// If a model is refused, or a file of it cannot be read.
pub fn all(data: &Path) -> Result<Vec<System>, Box<dyn Error>> {
    Ok(vec![
        blisk()?,
        duffing()?,
        stop()?,
        plane()?,
        beam()?,
        chain()?,
        light()?,
        sector(data)?,
    ])
}

/// The bladed disk with its light friction ring.
fn blisk() -> Built {
    Ok(System {
        key: 'a',
        title: "bladed disk with friction ring, 5 N, 205 to 213 Hz",
        model: Parameters::default().model()?,
        range: (205.0 * TAU, 213.0 * TAU),
        response: B2,
        fixed: &[1, 3, 5, 7, 9, 13, 17, 21, 25, 31, 41, 51, 63, 91, 127, 191, 255],
        sampled: &[9, 31, 63],
        tolerances: &TOLERANCES,
        truth: (511, 0),
    })
}

/// A mass on a linear and a cubic spring.
fn duffing() -> Built {
    let mut model = structure(&[1.0], &[0.05], &[1.0])?;
    model.add_contact(&Contact::cubic(0, None, 0.0, 0.1))?;
    model.add_force(0, 1, 0.18.into())?;
    Ok(System {
        key: 'b',
        title: "Duffing oscillator through both folds",
        model,
        range: (0.5, 1.6),
        response: 0,
        fixed: &[1, 3, 5, 7, 9, 13, 17, 21],
        sampled: &[],
        tolerances: &TOLERANCES,
        truth: (63, 0),
    })
}

/// A mass that strikes a spring behind a gap.
fn stop() -> Built {
    let mut model = structure(&[1.0], &[0.05], &[1.0])?;
    model.add_contact(&Contact::unilateral(None, Some(0), 5.0, 0.2))?;
    model.add_force(0, 1, 0.1.into())?;
    Ok(System {
        key: 'c',
        title: "mass against a stop behind a gap",
        model,
        range: (0.6, 1.9),
        response: 0,
        fixed: &[1, 2, 3, 4, 5, 7, 9, 11, 13, 17, 21, 25, 31, 41, 51, 63, 91, 127],
        sampled: &[9, 31, 63],
        tolerances: &TOLERANCES,
        truth: (255, 0),
    })
}

/// A mass pressed on a rough plane, with forces along both tangents and along the normal.
fn plane() -> Built {
    let mass = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let damping = mass.map(|m| 0.15 * m);
    let mut stiffness = mass.map(|m| 0.5 * m);
    stiffness[4] = 0.7;
    stiffness[8] = 1.0;
    let mut model = structure(&mass, &damping, &stiffness)?;
    let dofs = [Some(0), Some(1), Some(2)];
    model.add_contact(&Contact::friction_3d(dofs, [None; 3], (1.0, 0.6), 0.6, 0.5))?;
    for (dof, force) in [
        Complex64::new(0.3, 0.0),
        Complex64::new(0.0, 0.2),
        Complex64::new(0.25, 0.0),
    ]
    .into_iter()
    .enumerate()
    {
        model.add_force(dof, 1, force)?;
    }
    Ok(System {
        key: 'd',
        title: "mass on a rough plane, slip in two directions and lift-off",
        model,
        range: (0.9, 1.9),
        response: 0,
        fixed: &[1, 2, 3, 4, 5, 7, 9, 13, 17],
        sampled: &[9, 17],
        tolerances: &[1e-2, 1e-3, 1e-4],
        truth: (31, 8192),
    })
}

/// Free nodes of the beam, each with deflection and slope.
const NODES: usize = 20;

/// A steel cantilever with friction against the ground at every second node.
fn beam() -> Built {
    const LENGTH: f64 = 0.8;
    const BENDING: f64 = 525.0;
    const DENSITY: f64 = 2.355;
    let l = LENGTH / NODES as f64;
    let bend = BENDING / (l * l * l);
    // Cubic shape functions over deflection and slope times length of both ends.
    let stiffness = [
        [12.0, 6.0, -12.0, 6.0],
        [6.0, 4.0, -6.0, 2.0],
        [-12.0, -6.0, 12.0, -6.0],
        [6.0, 2.0, -6.0, 4.0],
    ];
    let mass = [
        [156.0, 22.0, 54.0, -13.0],
        [22.0, 4.0, 13.0, -3.0],
        [54.0, 13.0, 156.0, -22.0],
        [-13.0, -3.0, -22.0, 4.0],
    ];
    let n = 2 * NODES;
    let (mut m, mut k) = (vec![0.0; n * n], vec![0.0; n * n]);
    for element in 0..NODES {
        for i in 0..4 {
            for j in 0..4 {
                // Node 0 is clamped.
                let (Some(row), Some(column)) = ((2 * element + i).checked_sub(2), (2 * element + j).checked_sub(2))
                else {
                    continue;
                };
                let unit = l.powi((i % 2 + j % 2) as i32);
                m[row * n + column] += DENSITY * l / 420.0 * unit * mass[i][j];
                k[row * n + column] += bend * unit * stiffness[i][j];
            }
        }
    }
    let damping: Vec<f64> = k.iter().map(|k| 1e-4 * k).collect();
    let mut model = structure(&m, &damping, &k)?;
    for node in (1..NODES).step_by(2) {
        model.add_contact(&Contact::jenkins(2 * node, None, 150.0, 0.3, 0.2))?;
    }
    model.add_force(n - 2, 1, 0.5.into())?;
    let stuck = model.linear_modes(0, ContactState::Stuck)?.omega[0];
    Ok(System {
        key: 'e',
        title: "cantilever of 40 degrees of freedom, 10 friction contacts",
        model,
        range: (0.9 * stuck, 1.1 * stuck),
        response: n - 2,
        fixed: &[1, 3, 5, 7, 9, 13, 17, 21, 31],
        sampled: &[9, 31],
        tolerances: &TOLERANCES,
        truth: (127, 0),
    })
}

/// Mass and stiffness of a chain of equal masses, fixed at its beginning.
fn chain_matrices(n: usize, mass: f64, spring: f64) -> (Vec<f64>, Vec<f64>) {
    let (mut m, mut k) = (vec![0.0; n * n], vec![0.0; n * n]);
    for i in 0..n {
        m[i * n + i] = mass;
        k[i * n + i] = if i + 1 == n { spring } else { 2.0 * spring };
        if i > 0 {
            k[i * n + i - 1] = -spring;
            k[(i - 1) * n + i] = -spring;
        }
    }
    (m, k)
}

/// A long chain of masses with a slider in its middle.
fn chain() -> Built {
    const MASSES: usize = 40;
    let (mass, stiffness) = chain_matrices(MASSES, 0.1, 1e6);
    let damping: Vec<f64> = stiffness.iter().map(|k| 1e-6 * k).collect();
    let mut model = structure(&mass, &damping, &stiffness)?;
    model.add_contact(&Contact::jenkins(20, None, 1e6, 30.0, 1.0))?;
    model.add_force(MASSES - 1, 1, 5.0.into())?;
    let first = model.linear_modes(0, ContactState::Stuck)?.omega[0];
    Ok(System {
        key: 'f',
        title: "chain of 40 masses with a slider, 0.5 to 1.2 times the first resonance",
        model,
        range: (0.5 * first, 1.2 * first),
        response: MASSES - 1,
        fixed: &[1, 3, 5, 7, 9, 13, 17, 21, 31],
        sampled: &[],
        tolerances: &[1e-2, 1e-3, 1e-4],
        truth: (127, 0),
    })
}

/// A chain whose resonances are damped by a slider alone: the structure has a damping ratio of 1e-5.
fn light() -> Built {
    const MASSES: usize = 5;
    let (mass, stiffness) = chain_matrices(MASSES, 1.0, 1.0);
    let mut model = structure(&mass, &[0.0; MASSES * MASSES], &stiffness)?;
    let stuck =
        |model: &Model| -> Result<f64, Box<dyn Error>> { Ok(model.linear_modes(0, ContactState::Stuck)?.omega[0]) };
    model.add_contact(&Contact::jenkins(2, None, 0.3, 0.05, 1.0))?;
    let first = stuck(&model)?;
    model.set_rayleigh(0.0, 2e-5 / first)?;
    model.add_force(MASSES - 1, 1, 0.02.into())?;
    Ok(System {
        key: 'g',
        title: "chain of 5 masses with a slider, damping ratio 1e-5",
        model,
        range: (0.8 * first, 1.1 * first),
        response: MASSES - 1,
        fixed: &[1, 3, 5, 7, 9, 13, 17, 21, 31],
        sampled: &[],
        tolerances: &[1e-2, 1e-3, 1e-4],
        truth: (127, 0),
    })
}

/// The finite-element sector of the example `fe_sector`, with 60 contacts.
fn sector(data: &Path) -> Built {
    let sector = Sector::read(data, Size::Reduced)?;
    Ok(System {
        key: 'h',
        title: "finite-element sector, 293 degrees of freedom, 60 friction contacts, 2 N",
        model: sector.forced(2.0)?,
        range: (510.0 * TAU, 560.0 * TAU),
        response: sector.size.tip(),
        fixed: &[1, 3, 5, 7, 9],
        sampled: &[],
        tolerances: &[1e-2],
        truth: (21, 0),
    })
}

fn structure(mass: &[f64], damping: &[f64], stiffness: &[f64]) -> Result<Model, Box<dyn Error>> {
    let n = mass.len().isqrt();
    let mut model = Model::new(n)?;
    for (kind, values) in [
        (MatrixKind::Mass, mass),
        (MatrixKind::Damping, damping),
        (MatrixKind::Stiffness, stiffness),
    ] {
        model.set_matrix(kind, &MatrixView::dense(n, values))?;
    }
    Ok(model)
}
