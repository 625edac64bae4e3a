//! A response that a run has stored as .npz: read again to go on from, and to draw.

use crate::texts::outcome::Outcome;
use hbvib_io::NumberArray;
use num_complex::Complex64;
use std::path::Path;

/// The arrays of a stored response.
pub struct Stored {
    pub omega: Vec<f64>,
    pub amplitude: Vec<f64>,
    pub residual: Vec<f64>,
    /// Empty where the file has none.
    pub harmonics_used: Vec<f64>,
    pub floquet_radius: Vec<f64>,
    pub unstable_directions: Vec<f64>,
    pub free_sliders: Vec<f64>,
    /// Derivatives by the places of sliders, two for each contact in a row for each point.
    pub by_place: Vec<f64>,
    /// Slip fractions, a row for each point, and their number in a row.
    pub slip: Vec<f64>,
    pub contacts: usize,
    /// Values and errors of each response, a row for each of them.
    pub responses: Vec<f64>,
    pub response_errors: Vec<f64>,
    /// Angular frequency and amplitude.
    pub peaks: Vec<[f64; 2]>,
    pub folds: Vec<[f64; 2]>,
    /// Number of the request, angular frequency and amplitude.
    pub requested: Vec<[f64; 3]>,
    /// Number of the response, angular frequency and amplitude.
    pub response_peaks: Vec<[f64; 3]>,
    /// All harmonics, a row of `rows` × `ndof` numbers for each point.
    pub harmonics: Vec<Complex64>,
    pub rows: usize,
    pub ndof: usize,
    /// Node and direction of each degree of freedom; empty where they have no names.
    pub dofs: Vec<[f64; 2]>,
    /// Damping ratio and log10 of the amplitude, of a nonlinear mode.
    pub damping_ratio: Vec<f64>,
    pub log10_amplitude: Vec<f64>,
}

impl Stored {
    /// Reads a file of `[output]`, `npz`.
    ///
    /// # Errors
    /// A sentence with the file: arrays that are missing, of other lengths, or not finite.
    pub fn read(path: &Path) -> Outcome<Self> {
        let all = hbvib_io::read_number_arrays(path).map_err(|e| e.to_string())?;
        Self::of(&all).map_err(|e| format!("{}: {e}", path.display()))
    }

    fn of(all: &[NumberArray]) -> Outcome<Self> {
        let named = |name: &str| all.iter().find(|array| array.name == name);
        let needed = |name: &str| named(name).ok_or_else(|| format!("has no array {name}: it is no response of hbvib"));
        let omega = needed("omega")?.real.clone();
        let points = omega.len();
        let of_points = |name: &str| -> Outcome<Vec<f64>> {
            match named(name) {
                None => Ok(Vec::new()),
                Some(array) if array.real.len() == points => Ok(array.real.clone()),
                Some(array) => Err(format!(
                    "{name} has {} numbers, needs {points} as omega has",
                    array.real.len()
                )),
            }
        };
        let harmonics = needed("harmonics")?;
        let [n, rows, ndof] = harmonics.shape[..] else {
            return Err(format!(
                "harmonics has the shape {:?}, needs three numbers",
                harmonics.shape
            ));
        };
        if n != points || harmonics.imaginary.len() != harmonics.real.len() || rows == 0 {
            return Err(format!(
                "harmonics has the shape {:?}, needs complex numbers of {points} points",
                harmonics.shape
            ));
        }
        let parts = harmonics.real.iter().zip(&harmonics.imaginary);
        let slip = named("slip_fraction").map_or((Vec::new(), 0), |array| {
            (array.real.clone(), array.shape.last().copied().unwrap_or(0))
        });
        let per_response = |name: &str| named(name).map_or(Vec::new(), |array| array.real.clone());
        let stored = Self {
            amplitude: needed("amplitude").and_then(|_| of_points("amplitude"))?,
            residual: of_points("residual")?,
            harmonics_used: of_points("harmonics_used")?,
            floquet_radius: of_points("floquet_radius")?,
            unstable_directions: of_points("unstable_directions")?,
            free_sliders: of_points("free_sliders")?,
            by_place: per_response("d_amplitude_by_place"),
            damping_ratio: of_points("damping_ratio")?,
            log10_amplitude: of_points("log10_amplitude")?,
            contacts: slip.1,
            slip: slip.0,
            responses: per_response("responses"),
            response_errors: per_response("response_errors"),
            peaks: rows_of(named("peaks")),
            folds: rows_of(named("folds")),
            requested: rows_of(named("requested")),
            response_peaks: rows_of(named("response_peaks")),
            harmonics: parts.map(|(re, im)| Complex64::new(*re, *im)).collect(),
            rows,
            ndof,
            dofs: rows_of(named("dofs")),
            omega,
        };
        let finite = |x: &[f64]| x.iter().all(|x| x.is_finite());
        if !finite(&stored.omega) || !finite(&stored.amplitude) || !stored.harmonics.iter().all(|z| z.is_finite()) {
            return Err("has numbers that are not finite".into());
        }
        Ok(stored)
    }

    /// All harmonics of a point.
    pub fn harmonics_at(&self, point: usize) -> &[Complex64] {
        let length = self.rows * self.ndof;
        &self.harmonics[point * length..(point + 1) * length]
    }

    /// A degree of freedom by its number or by node and direction, as 12.3.
    ///
    /// # Errors
    /// A sentence: one that the file does not have.
    pub fn dof(&self, name: &str) -> Outcome<usize> {
        if let Ok(dof) = name.parse::<usize>() {
            return Some(dof).filter(|dof| *dof < self.ndof).ok_or_else(|| {
                let last = self.ndof.saturating_sub(1);
                format!("has {} degrees of freedom, needs --dof 0 to {last}", self.ndof)
            });
        }
        let parts = name.split_once('.');
        let parts =
            parts.and_then(|(node, direction)| Some((node.parse::<i64>().ok()?, direction.parse::<u8>().ok()?)));
        let Some((node, direction)) = parts else {
            return Err(format!(
                "--dof {name}, needs a number from 0, or node and direction as 12.3"
            ));
        };
        let wanted = (node, i64::from(direction));
        let found = self
            .dofs
            .iter()
            .position(|[node, direction]| (*node as i64, *direction as i64) == wanted);
        found.ok_or_else(|| match self.dofs.len() {
            0 => format!("--dof {name}: the file names no nodes, needs a number from 0"),
            _ => format!("--dof {name}: the file has no such node and direction"),
        })
    }

    /// Number of responses.
    pub fn responses(&self) -> usize {
        self.responses.len() / self.omega.len().max(1)
    }
}

/// Rows of a table.
fn rows_of<const N: usize>(array: Option<&NumberArray>) -> Vec<[f64; N]> {
    let numbers = array.map_or(&[][..], |array| &array.real);
    let mut rows = Vec::new();
    for row in numbers.chunks_exact(N) {
        let mut one = [0.0; N];
        one.copy_from_slice(row);
        rows.push(one);
    }
    rows
}
