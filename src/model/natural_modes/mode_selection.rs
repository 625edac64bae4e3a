//! The linear mode with stuck contacts from which a nonlinear mode starts, in the wave of the engine order of the
//! model.

use crate::error::{Result, Status, fail, try_copy, try_extend, try_push, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::exact_sums::quadratic::{QUADRATIC_ROUNDING, quadratic, terms};
use crate::linalg::inner;
use crate::linalg::sparse_storage::definite;
use crate::model::Model;
use crate::model::matrices::wave::Wave;
use crate::model::natural_modes::linear_modes::{ContactState, LinearModes, Pencil};
use crate::model::natural_modes::repeated_modes::{self, Multiple};
use crate::options::ModeChoice;
use num_complex::Complex64;
use std::ops::Range;

/// A natural mode with the contacts stuck.
#[derive(Clone, Debug)]
pub struct SelectedMode {
    /// Index of the mode, from 0 by rising stuck frequency; that of the first of equal frequencies, unless another
    /// one was requested.
    pub index: usize,
    /// Angular frequency of the mode, rad per time unit.
    pub omega: f64,
    /// Shape of the mode, φᴴ M φ = 1 over one sector. The degree of freedom that moves most is real and positive,
    /// except with [`Multiple::Projected`], which keeps the phase of the given shape.
    pub shape: Vec<Complex64>,
    /// Number of modes of this frequency.
    pub multiplicity: usize,
    /// Rule that chose among the modes of this frequency.
    pub multiple: Multiple,
    /// The known stuck frequencies, ascending: all of a small structure, the lowest of a large one.
    pub stuck: Vec<f64>,
    /// As many frequencies with the contacts removed; empty if they could not be found.
    pub free: Vec<f64>,
}

/// Frequencies that differ by no more than this, relative, count as equal.
/// Kind: rounding.
const MODE_SELECTION_EQUAL: f64 = 1e-8;

/// Number of modes of a large structure with which a given shape is compared.
/// Kind: tuned; measured on: not recorded.
const COMPARED: usize = 40;

const CONTEXT: &str = "the start mode";

/// Selects a mode as [`Model::select_mode`], with contacts stuck or linearised about a static state, and the caller
/// may stop it.
#[doc(hidden)]
pub(crate) fn select_mode_with(
    model: &Model,
    choice: ModeChoice<'_>,
    contacts: ContactState<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<SelectedMode> {
    interrupt.phase(Phase::Modes, 0.0)?;
    choice.check(model.ndof())?;
    let mut restricted;
    let choice = match choice {
        ModeChoice::Shape(shape) => {
            restricted = try_vec(model.structure().ndof(), Complex64::ZERO, CONTEXT)?;
            model.structure().degrees().restrict(shape, &mut restricted);
            ModeChoice::Shape(&restricted)
        }
        other => other,
    };
    let pencil = model.pencil(Wave::Harmonic(1), contacts)?;
    let (known, chosen) = KnownModes::find(&pencil, choice, interrupt)?;
    known.check_frequency(chosen.index)?;
    let n = model.structure().ndof();
    let shapes = &known.modes.shapes[chosen.cluster.start * n..chosen.cluster.end * n];
    let (shape, multiple) =
        repeated_modes::resolve(&pencil, shapes, chosen.index - chosen.cluster.start, chosen.projection)?;
    let free = model
        .pencil(Wave::Harmonic(1), ContactState::Free)
        .and_then(|free| lowest_by_quotient(&free, known.modes.omega.len(), interrupt));
    Ok(SelectedMode {
        index: chosen.index,
        omega: known.modes.omega[chosen.index],
        shape,
        multiplicity: chosen.cluster.len(),
        multiple,
        stuck: known.modes.omega,
        free: match free {
            Ok(modes) => modes.omega,
            Err(e) if matches!(e.status, Status::OutOfMemory | Status::StoppedByCaller) => return Err(e),
            Err(_) => Vec::new(),
        },
    })
}

/// The chosen mode, and the modes of its frequency.
struct ChosenMode {
    index: usize,
    cluster: Range<usize>,
    /// Components of the given shape along the modes of the cluster.
    projection: Option<Vec<Complex64>>,
}

/// The modes that have been computed.
struct KnownModes<'a> {
    pencil: &'a Pencil,
    modes: LinearModes,
    /// Whether these are all modes of the structure.
    all: bool,
}

impl<'a> KnownModes<'a> {
    /// Computes as many modes as the choice requires.
    fn find(pencil: &'a Pencil, choice: ModeChoice<'_>, interrupt: &Interrupt<'_>) -> Result<(Self, ChosenMode)> {
        let n = pencil.mass.rows;
        // The rank of a positive semidefinite matrix is at most the number of positive entries on its diagonal.
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
            definite::check_mass(&pencil.mass, interrupt)?;
        }
        loop {
            let dense = pencil.finds_all(count);
            let modes = lowest_by_quotient(pencil, if dense { n } else { count }, interrupt)?;
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

    /// Selects a mode; `None` if more modes must be computed first.
    fn choose(&self, choice: ModeChoice<'_>) -> Result<Option<ChosenMode>> {
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
            ModeChoice::Near(requested) => {
                if !self.all && highest <= requested {
                    return Ok(None);
                }
                let distance = |&i: &usize| (omega[i] - requested).abs();
                let nearest = (0..omega.len()).min_by(|i, j| distance(i).total_cmp(&distance(j)));
                let cluster = self.cluster(nearest.unwrap_or(0));
                (cluster.start, cluster)
            }
            ModeChoice::Shape(shape) => {
                let (cluster, components) = self.most_similar(shape)?;
                projection = Some(components);
                (cluster.start, cluster)
            }
        };
        // More equal frequencies may follow the last known one.
        if !self.all && cluster.end == omega.len() {
            return Ok(None);
        }
        Ok(Some(ChosenMode {
            index,
            cluster,
            projection,
        }))
    }

    /// The modes with the frequency of mode `k`.
    fn cluster(&self, k: usize) -> Range<usize> {
        let omega = &self.modes.omega;
        let equal = |i: usize| omega[i + 1] - omega[i] <= MODE_SELECTION_EQUAL * omega[i + 1];
        let (mut start, mut end) = (k, k + 1);
        while start > 0 && equal(start - 1) {
            start -= 1;
        }
        while end < omega.len() && equal(end - 1) {
            end += 1;
        }
        start..end
    }

    /// The modes of one frequency that hold most of the modal mass of `shape`, and its components along them.
    fn most_similar(&self, shape: &[Complex64]) -> Result<(Range<usize>, Vec<Complex64>)> {
        let n = shape.len();
        // The shape may have any size, so that squares might overflow.
        let size = shape.iter().fold(0.0_f64, |m, z| m.max(z.re.abs()).max(z.im.abs()));
        let mut scaled = try_copy(shape, CONTEXT)?;
        for z in &mut scaled {
            *z /= size;
        }
        let mass = quadratic(&self.pencil.mass, &scaled);
        let weighted = self.pencil.mass.times(&scaled, CONTEXT)?;
        let mut components = Vec::new();
        for mode in self.modes.shapes.chunks_exact(n) {
            let part = inner(mode, &weighted);
            try_push(&mut components, part, CONTEXT)?;
        }
        let (mut best, mut most) = (0..0, 0.0);
        let mut at = 0;
        while at < components.len() {
            let cluster = self.cluster(at);
            at = cluster.end;
            let share: f64 = components[cluster.clone()].iter().map(Complex64::norm_sqr).sum();
            if share > most {
                (best, most) = (cluster, share);
            }
        }
        if best.is_empty() || most <= 1e-12 * mass {
            return fail!(
                Argument,
                "shape is unlike each of the {} lowest modes, or moves no mass",
                components.len()
            );
        }
        let mut along = Vec::new();
        try_extend(&mut along, &components[best.clone()], CONTEXT)?;
        Ok((best, along))
    }

    /// Refuses a mode without stiffness.
    fn check_frequency(&self, index: usize) -> Result<()> {
        let n = self.pencil.mass.rows;
        let shape = &self.modes.shapes[index * n..(index + 1) * n];
        let k = &self.pencil.stiffness;
        let energy = quadratic(k, shape);
        let rounding = QUADRATIC_ROUNDING * terms(k, shape);
        if energy < -rounding {
            return fail!(
                Argument,
                "mode {index} has no frequency: its stiffness is negative (statically unstable)"
            );
        }
        if energy <= rounding {
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

/// The `count` lowest modes, with frequencies from the Rayleigh quotients of their shapes.
fn lowest_by_quotient(pencil: &Pencil, count: usize, interrupt: &Interrupt<'_>) -> Result<LinearModes> {
    let n = pencil.mass.rows;
    let modes = pencil.lowest(count, interrupt)?;
    let mut order = Vec::new();
    for (i, shape) in modes.shapes.chunks_exact(n).enumerate() {
        interrupt.check()?;
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
