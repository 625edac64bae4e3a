//! The linear mode, contacts stuck, that a nonlinear mode starts from, in the wave of the model's
//! engine order.

use crate::error::{Result, Status, fail, try_copy, try_extend, try_push};
use crate::linalg::definite;
use crate::linalg::inner;
use crate::linalg::quadratic::quadratic;
use crate::model::Model;
use crate::model::linear_modes::{ContactState, LinearModes, Pencil};
use crate::model::repeated_modes::{self, Multiple};
use crate::model::spring_stiffness::Wave;
use crate::options::ModeChoice;
use num_complex::Complex64;
use std::ops::Range;

/// A natural mode with the contacts stuck.
#[derive(Clone, Debug)]
pub struct SelectedMode {
    /// Its number, from 0 by rising stuck frequency; of equal frequencies the first, unless the
    /// number was asked for.
    pub index: usize,
    /// Its angular frequency, rad per time unit.
    pub omega: f64,
    /// Its shape, φᴴ M φ = 1 over one sector. The degree of freedom that moves most is real and
    /// positive, but for [`Multiple::Projected`], which keeps the phase of the shape given.
    pub shape: Vec<Complex64>,
    /// How many modes share the frequency.
    pub multiplicity: usize,
    /// What was done about that.
    pub multiple: Multiple,
    /// The stuck frequencies known, ascending: all of a small structure, the lowest of a large one.
    pub stuck: Vec<f64>,
    /// As many frequencies with the contacts removed; empty where these could not be found.
    pub free: Vec<f64>,
}

/// Frequencies that differ by no more than this, relative, count as equal.
const EQUAL: f64 = 1e-8;

/// Strain energy, relative to the sum of its terms' moduli, that is rounding and no more.
const NO_STRAIN: f64 = 1e-14;

/// Modes of a large structure among which a given shape is looked for.
const COMPARED: usize = 40;

const CONTEXT: &str = "the start mode";

impl Model {
    /// The linear mode of the engine-order wave, contacts stuck, that `choice` names.
    ///
    /// Equal frequencies (within 1e-8, relative) leave the shape open; see [`Multiple`].
    /// [`ModeChoice::Near`] and [`ModeChoice::Shape`] take them as one.
    ///
    /// # Errors
    /// Those of [`ModeChoice::check`]; `Index` for a mode that does not exist; `Argument` for a
    /// rigid-body or unstable mode, or a shape without mass; `NotHermitian`,
    /// `NotPositiveDefinite` for the matrices; `NoConvergence`, `Singular`, `OutOfMemory`.
    pub fn select_mode(&self, choice: ModeChoice<'_>) -> Result<SelectedMode> {
        choice.check(self.ndof())?;
        let pencil = self.pencil(Wave::Harmonic(1), ContactState::Stuck)?;
        let (known, chosen) = Known::find(&pencil, choice)?;
        known.check_frequency(chosen.index)?;
        let n = self.ndof();
        let shapes = &known.modes.shapes[chosen.cluster.start * n..chosen.cluster.end * n];
        let (shape, multiple) =
            repeated_modes::resolve(&pencil, shapes, chosen.index - chosen.cluster.start, chosen.projection)?;
        let free = self
            .pencil(Wave::Harmonic(1), ContactState::Free)
            .and_then(|free| sharpened(&free, known.modes.omega.len()));
        Ok(SelectedMode {
            index: chosen.index,
            omega: known.modes.omega[chosen.index],
            shape,
            multiplicity: chosen.cluster.len(),
            multiple,
            stuck: known.modes.omega,
            free: match free {
                Ok(modes) => modes.omega,
                Err(e) if e.status == Status::OutOfMemory => return Err(e),
                Err(_) => Vec::new(),
            },
        })
    }
}

/// The mode chosen, and those of its frequency.
struct Chosen {
    index: usize,
    cluster: Range<usize>,
    /// Parts of the given shape along the modes of the cluster.
    projection: Option<Vec<Complex64>>,
}

/// Modes that are known so far.
struct Known<'a> {
    pencil: &'a Pencil,
    modes: LinearModes,
    /// Whether there are no others.
    all: bool,
}

impl<'a> Known<'a> {
    /// As many modes as it takes to choose.
    fn find(pencil: &'a Pencil, choice: ModeChoice<'_>) -> Result<(Self, Chosen)> {
        let n = pencil.mass.rows;
        // A positive semidefinite matrix has no more rank than positive entries on its diagonal.
        let heavy = (0..n).filter(|&i| pencil.mass.get(i, i).re > 0.0).count();
        let mut count = match choice {
            ModeChoice::Index(k) => {
                if heavy > 0 && k >= heavy {
                    return no_such_mode(k, heavy);
                }
                k.saturating_add(3)
            }
            ModeChoice::Near(_) => 8,
            ModeChoice::Shape(_) => COMPARED,
        };
        if !pencil.finds_all(count) {
            definite::check_mass(&pencil.mass)?;
        }
        loop {
            let dense = pencil.finds_all(count);
            let modes = sharpened(pencil, if dense { n } else { count })?;
            let known = Self {
                pencil,
                all: dense || modes.omega.len() < count,
                modes,
            };
            if let Some(chosen) = known.choose(choice)? {
                return Ok((known, chosen));
            }
            count = count.saturating_mul(2);
        }
    }

    /// `None`: more modes must be known.
    fn choose(&self, choice: ModeChoice<'_>) -> Result<Option<Chosen>> {
        let omega = &self.modes.omega;
        let Some(&highest) = omega.last() else {
            return fail!(NotPositiveDefinite, "mass matrix is zero: there is no vibration mode");
        };
        let mut projection = None;
        let (index, cluster) = match choice {
            ModeChoice::Index(k) if k >= omega.len() => {
                return if self.all {
                    no_such_mode(k, omega.len())
                } else {
                    Ok(None)
                };
            }
            ModeChoice::Index(k) => (k, self.cluster(k)),
            ModeChoice::Near(wanted) => {
                if !self.all && highest <= wanted {
                    return Ok(None);
                }
                let distance = |&i: &usize| (omega[i] - wanted).abs();
                let nearest = (0..omega.len()).min_by(|i, j| distance(i).total_cmp(&distance(j)));
                let cluster = self.cluster(nearest.unwrap_or(0));
                (cluster.start, cluster)
            }
            ModeChoice::Shape(shape) => {
                let (cluster, parts) = self.most_alike(shape)?;
                projection = Some(parts);
                (cluster.start, cluster)
            }
        };
        // Equal frequencies may go on beyond the last one known.
        if !self.all && cluster.end == omega.len() {
            return Ok(None);
        }
        Ok(Some(Chosen {
            index,
            cluster,
            projection,
        }))
    }

    /// The modes whose frequency is that of mode `k`.
    fn cluster(&self, k: usize) -> Range<usize> {
        let omega = &self.modes.omega;
        let equal = |i: usize| omega[i + 1] - omega[i] <= EQUAL * omega[i + 1];
        let (mut start, mut end) = (k, k + 1);
        while start > 0 && equal(start - 1) {
            start -= 1;
        }
        while end < omega.len() && equal(end - 1) {
            end += 1;
        }
        start..end
    }

    /// The modes of one frequency that hold most of the modal mass of `shape`, and its parts along
    /// them.
    fn most_alike(&self, shape: &[Complex64]) -> Result<(Range<usize>, Vec<Complex64>)> {
        let n = shape.len();
        // Any size may come in, so that squares might overflow.
        let size = shape.iter().fold(0.0_f64, |m, z| m.max(z.re.abs()).max(z.im.abs()));
        let mut scaled = try_copy(shape, CONTEXT)?;
        for z in &mut scaled {
            *z /= size;
        }
        let mass = quadratic(&self.pencil.mass, &scaled);
        let weighted = self.pencil.mass.times(&scaled, CONTEXT)?;
        let mut parts = Vec::new();
        for mode in self.modes.shapes.chunks_exact(n) {
            let part = inner(mode, &weighted);
            try_push(&mut parts, part, CONTEXT)?;
        }
        let (mut best, mut most) = (0..0, 0.0);
        let mut at = 0;
        while at < parts.len() {
            let cluster = self.cluster(at);
            at = cluster.end;
            let share: f64 = parts[cluster.clone()].iter().map(Complex64::norm_sqr).sum();
            if share > most {
                (best, most) = (cluster, share);
            }
        }
        if best.is_empty() || most <= 1e-12 * mass {
            return fail!(
                Argument,
                "shape is unlike each of the {} lowest modes, or moves no mass",
                parts.len()
            );
        }
        let mut along = Vec::new();
        try_extend(&mut along, &parts[best.clone()], CONTEXT)?;
        Ok((best, along))
    }

    /// Refuses a mode without stiffness.
    fn check_frequency(&self, index: usize) -> Result<()> {
        let n = self.pencil.mass.rows;
        let shape = &self.modes.shapes[index * n..(index + 1) * n];
        let k = &self.pencil.stiffness;
        let energy = quadratic(k, shape);
        let mut terms = 0.0;
        for (j, x) in shape.iter().enumerate() {
            terms += x.norm() * k.column(j).map(|(i, v)| v.norm() * shape[i].norm()).sum::<f64>();
        }
        if energy < -NO_STRAIN * terms {
            return fail!(
                Argument,
                "mode {index} has no frequency: its stiffness is negative (statically unstable)"
            );
        }
        if energy <= NO_STRAIN * terms {
            return fail!(Argument, "mode {index} has no frequency (rigid body)");
        }
        Ok(())
    }
}

fn no_such_mode<T>(index: usize, count: usize) -> Result<T> {
    fail!(
        Index,
        "mode_index = {index}, needs 0 .. {} (natural modes with mass)",
        count - 1
    )
}

/// The `count` lowest modes with frequencies from the quotient of their shapes.
fn sharpened(pencil: &Pencil, count: usize) -> Result<LinearModes> {
    let n = pencil.mass.rows;
    let modes = pencil.lowest(count)?;
    let mut order = Vec::new();
    for (i, shape) in modes.shapes.chunks_exact(n).enumerate() {
        try_push(&mut order, (pencil.quotient(shape).max(0.0).sqrt(), i), CONTEXT)?;
    }
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut omega, mut shapes) = (Vec::new(), Vec::new());
    for (w, i) in order {
        try_push(&mut omega, w, CONTEXT)?;
        try_extend(&mut shapes, &modes.shapes[i * n..(i + 1) * n], CONTEXT)?;
    }
    Ok(LinearModes { omega, shapes })
}
