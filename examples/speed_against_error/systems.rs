//! The structures whose responses are timed: one of each kind of law, and one with many contacts.

use std::error::Error;
use std::f64::consts::TAU;

use hbvib::contact::Contact;
use hbvib::linalg::matrix_view::MatrixView;
use hbvib::model::Model;
use hbvib::model::linear_modes::ContactState;
use hbvib::model::structure::MatrixKind;
use num_complex::Complex64;

use crate::model::{B2, Parameters};

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

/// All systems.
///
/// # Errors
///
/// If a model is refused.
pub fn all() -> Result<Vec<System>, Box<dyn Error>> {
    Ok(vec![blisk()?, duffing()?, stop()?, plane()?, beam()?])
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
