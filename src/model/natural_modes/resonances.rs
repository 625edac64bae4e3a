//! Resonances of the structure with its contacts in their linear state: frequencies and half widths, where the response
//! of a harmonic has its poles.

use crate::error::{Error, Result, Status, check_memory, try_copy, try_extend, try_push};
use crate::interrupt::Interrupt;
use crate::linalg::dense::eigen;
use crate::linalg::exact_sums::quadratic::about_quadratic;
use crate::linalg::factors::inertia::eigenvalues_below;
use crate::linalg::iterative::{lanczos, spectrum_slices};
use crate::linalg::libraries::{DMatrix, Schur};
use crate::linalg::sparse_storage::held_rows::MovingRows;
use crate::linalg::sparse_storage::sparse::{Csc, Form};
use crate::model::Model;
use crate::model::matrices::modal_directions::split_damping;
use crate::model::matrices::structure::MatrixKind;
use crate::model::matrices::wave::Wave;
use crate::model::natural_modes::all_undamped::all_undamped;
use crate::model::natural_modes::linear_modes::ALL_MODES_UP_TO;
use crate::model::natural_modes::linear_modes::ContactState;
use crate::model::natural_modes::quadratic_problem::Quadratic;
use crate::model::natural_modes::quadratic_search::within;
use crate::options::Range;
use num_complex::Complex64;

/// A pole p = ω + iσ of the response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resonance {
    /// Angular frequency ω of the resonance.
    pub omega: f64,
    /// Half width σ: the response is 1/√2 of its peak at ω ± σ. Zero without damping.
    pub half_width: f64,
}

/// Half width relative to the frequency below which a resonance is undamped up to rounding.
/// Kind: rounding.
const RESONANCES_UNDAMPED: f64 = 1e-13;

impl Resonance {
    /// Whether the half width is rounding.
    pub fn is_undamped(&self) -> bool {
        self.half_width <= RESONANCES_UNDAMPED * self.omega
    }
}

/// Degrees of freedom from which a range that has few modes is searched, and how many times fewer these are.
/// Kind: tuned; measured on: chains of 32 to 100 masses.
const NARROW_FROM: usize = 48;
const NARROW_SHARE: usize = 16;

/// The same where a range has too many modes for a search.
/// Kind: tuned; measured on: not recorded.
const DENSE_IF_MANY: usize = 600;

/// Number of the lowest modes of a large structure that are found before those of the range.
/// Kind: tuned; measured on: not recorded.
const FIRST_MODES: usize = 24;

/// ω² relative to that of the upper end by which a search reaches beyond both ends.
/// Kind: rounding.
const AT_END: f64 = 1e-9;

/// Largest number of modes of a search in the range.
/// Kind: cap.
const RESONANCES_MOST_MODES: usize = 500;

/// Entries of all mode shapes of a structure up to which there may be more, 144 MB.
/// Kind: cap.
const RESONANCES_ENTRIES: usize = 9_000_000;

/// The same with gyroscopic forces, in a disc about the range.
/// Kind: cap; the work of the search grows with the square of the number.
const RESONANCES_MOST_GYROSCOPIC: usize = 120;

/// Width of a range over the sum of its ends from which on it counts as wide.
/// Kind: tuned; measured on: chains and dense structures of 40 to 100 masses with gyroscopic forces.
const WIDE_RANGE: f64 = 0.1;

/// Degrees of freedom with gyroscopic forces up to which all modes by dense algebra cost less than a search.
/// Kind: tuned; measured on: chains of 20 to 100 masses.
const GYROSCOPIC_DENSE_UP_TO: usize = 30;

/// Largest number of square matrices that the dense eigensolver holds at a time.
/// Kind: fixed.
const RESONANCES_EIGEN_COPIES: usize = 8;

/// Coupling of two modes by damping, relative to the distance of their frequencies, up to which each has its own
/// half width.
/// Kind: tuned; measured on: not recorded.
const COUPLED: f64 = 0.1;

/// Most iterations of the eigenvalues of coupled modes.
/// Kind: cap.
const RESONANCES_MAX_ITERATIONS: usize = 10_000;

const CONTEXT: &str = "the resonances";

/// The resonances of all harmonics in which forces vibrate, see [`Model::resonances`].
#[doc(hidden)]
pub(crate) fn forced_resonances(
    model: &Model,
    range: Range,
    contacts: ContactState<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Vec<Resonance>>> {
    let mut found = Vec::new();
    let mut forced = Vec::new();
    for force in model.excitation().forces() {
        let h = force.harmonic;
        if h == 0 || force.value == Complex64::ZERO || forced.contains(&h) {
            continue;
        }
        try_push(&mut forced, h, CONTEXT)?;
        let Some(own) = model.resonances(h, range, contacts, interrupt)? else {
            return Ok(None);
        };
        try_extend(&mut found, &own, CONTEXT)?;
    }
    found.sort_by(|a, b| a.omega.total_cmp(&b.omega));
    Ok(Some(found))
}

/// The resonances of harmonic `h` between two excitation frequencies, ascending.
#[doc(hidden)]
pub(crate) fn resonances(
    model: &Model,
    h: usize,
    range: Range,
    contacts: ContactState<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Vec<Resonance>>> {
    match small_motion_frequencies(model, h, range, contacts, interrupt) {
        Err(e) if matches!(e.status, Status::OutOfMemory | Status::StoppedByCaller) => Err(e),
        found => Ok(found.ok().flatten()),
    }
}

fn small_motion_frequencies(
    model: &Model,
    h: usize,
    range: Range,
    contacts: ContactState<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Vec<Resonance>>> {
    let structure = model.structure();
    let stiffness = model.stiffness_at_small_motion(Wave::Harmonic(h), contacts)?;
    let mass = structure.inertia(Wave::Harmonic(h))?;
    let structural = structure.wave_matrix(MatrixKind::Structural, h)?;
    let terms = [
        (Complex64::ONE, &stiffness, Form::Plain),
        (Complex64::I, &structural, Form::Plain),
    ];
    let stiffness = Csc::sum(mass.rows, &terms)?;
    if model.structure().has_gyroscopic_modes(h)? {
        let (damping, modal) = match split_damping(structure, Wave::Harmonic(h), interrupt)? {
            Some(found) => found,
            None => (structure.wave_matrix(MatrixKind::Damping, h)?, Vec::new()),
        };
        let problem = Quadratic {
            mass: &mass,
            damping: &damping,
            stiffness: &stiffness,
            modal: &modal,
        };
        return gyroscopic_frequencies(h, range, &problem, interrupt);
    }
    damped_frequencies(
        h,
        range,
        (&stiffness, &mass),
        || structure.wave_matrix(MatrixKind::Damping, h),
        interrupt,
    )
}

/// The resonances of harmonic `h` where gyroscopic forces act at a fixed speed, which are no small damping: eigenvalues of the
/// quadratic problem. `None` if there are too many in the range: a response goes on without them.
///
/// # Errors
/// Those of the eigensolvers.
pub fn gyroscopic_frequencies(
    h: usize,
    range: Range,
    problem: &Quadratic<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Vec<Resonance>>> {
    let (low, high) = (range.low(), range.high());
    let n = problem.mass.rows;
    let number = h as f64;
    // A wide range has most modes of a small structure.
    let is_wide = high - low > WIDE_RANGE * (high + low);
    let by_dense_algebra = n <= GYROSCOPIC_DENSE_UP_TO || n <= ALL_MODES_UP_TO && is_wide;
    let mut values = None;
    if !by_dense_algebra {
        let frequencies = Range::new(low * number, high * number);
        values = within(problem, frequencies, RESONANCES_MOST_GYROSCOPIC, interrupt)?;
    }
    if values.is_none() && n <= ALL_MODES_UP_TO {
        let mut all = Vec::new();
        for (value, _) in problem.lowest(n, interrupt)? {
            try_push(&mut all, value, CONTEXT)?;
        }
        values = Some(all);
    }
    let Some(values) = values else { return Ok(None) };
    let mut found = Vec::new();
    for value in values {
        let resonance = Resonance {
            omega: value.im / number,
            half_width: (-value.re).max(0.0) / number,
        };
        if resonance.omega > 0.0 && resonance.omega >= low && resonance.omega <= high {
            try_push(&mut found, resonance, CONTEXT)?;
        }
    }
    Ok(Some(found))
}

/// The resonances of harmonic `h` for given matrices, see [`Model::resonances`].
///
/// # Errors
/// Those of the eigensolvers.
pub fn damped_frequencies(
    h: usize,
    range: Range,
    (stiffness, mass): (&Csc, &Csc),
    damping: impl FnOnce() -> Result<Csc>,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Vec<Resonance>>> {
    let (low, high) = (range.low(), range.high());
    let (hermitian, skew) = parts(stiffness)?;
    let number = h as f64;
    let Some(modes) = modes_within(&hermitian, mass, Range::new(low * number, high * number), interrupt)? else {
        return Ok(None);
    };
    let mut frequencies = Vec::new();
    let mut shapes = Vec::new();
    for (value, shape) in modes.values.iter().zip(modes.vectors.column_iter()) {
        let omega = value.max(0.0).sqrt();
        if omega >= low * number && omega <= high * number && omega > 0.0 {
            try_push(&mut frequencies, omega, CONTEXT)?;
            try_push(&mut shapes, try_copy(shape.as_slice(), CONTEXT)?, CONTEXT)?;
        }
    }
    let damping = damping()?;
    let widths = Widths { damping, skew };
    let mut found = Vec::new();
    let mut first = 0;
    while first < frequencies.len() {
        let mut next = first + 1;
        while next < frequencies.len() && widths.couple(&frequencies, &shapes, next)? {
            next += 1;
        }
        let group = first..next;
        widths.poles(&frequencies[group.clone()], &shapes[group], number, &mut found)?;
        first = next;
    }
    found.sort_by(|a, b| a.omega.total_cmp(&b.omega));
    Ok(Some(found))
}

/// Hermitian part of K; and its skew-Hermitian part times −i.
fn parts(k: &Csc) -> Result<(Csc, Csc)> {
    let half = Complex64::new(0.5, 0.0);
    let turned = Complex64::new(0.0, -0.5);
    // Aᴴ as the conjugate of the transpose.
    let transposed = Csc::sum(k.rows, &[(Complex64::ONE, k, Form::Transposed)])?;
    let combine =
        |a: Complex64, b: Complex64| Csc::sum(k.rows, &[(a, k, Form::Plain), (b, &transposed, Form::Conjugated)]);
    Ok((combine(half, half)?, combine(turned, -turned)?))
}

/// All modes within a range of frequencies, and some others; `None` if there are too many.
fn modes_within(k: &Csc, m: &Csc, range: Range, interrupt: &Interrupt<'_>) -> Result<Option<eigen::Pairs>> {
    let (low, high) = (range.low(), range.high());
    if let Some(moving) = MovingRows::of(k)? {
        let pairs = modes_within(&moving.reduced(k)?, &moving.reduced(m)?, range, interrupt)?;
        return pairs.map(|pairs| moving.expanded_pairs(pairs)).transpose();
    }
    let n = k.rows;
    // Rounding at an end loses no mode there.
    let interval = (low * low - AT_END * high * high, (1.0 + AT_END) * high * high);
    if n > DENSE_IF_MANY {
        // The law of inertia tells whether the lowest modes would reach beyond the range.
        let real = k.is_real() && m.is_real();
        let below = eigenvalues_below(k, (interval.1, m), real, interrupt)?;
        if below.is_none_or(|below| below.count < FIRST_MODES) {
            let pairs = lanczos::lowest(k, m, FIRST_MODES, interrupt)?;
            if pairs.values.len() < FIRST_MODES || pairs.values.last().is_some_and(|&x| x > high * high) {
                return Ok(Some(pairs));
            }
        }
        let most = RESONANCES_MOST_MODES.max(RESONANCES_ENTRIES / n);
        return spectrum_slices::within((k, m), interval, most, interrupt);
    }
    if n >= NARROW_FROM {
        let share = if n > ALL_MODES_UP_TO { 4 } else { NARROW_SHARE };
        // Factors of a small matrix take no time that is worth a report.
        let is_stopped = || interrupt.check().is_err();
        let quiet = Interrupt::new(Some(&is_stopped), None);
        let interrupt = if n > ALL_MODES_UP_TO { interrupt } else { &quiet };
        // The law of inertia tells first whether there are few. Dense algebra finds what a search does not.
        match spectrum_slices::within((k, m), interval, n / share, interrupt) {
            Err(e) if matches!(e.status, Status::OutOfMemory | Status::StoppedByCaller) => return Err(e),
            Ok(Some(pairs)) => return Ok(Some(pairs)),
            _ => {}
        }
    }
    all_undamped(k, m, interrupt).map(Some)
}

/// Damping matrices, from which half widths follow.
struct Widths {
    damping: Csc,
    skew: Csc,
}

impl Widths {
    /// Coupling φᴴ(C + Im K/ω)φ of two shapes by damping.
    fn between(&self, a: &[Complex64], b: &[Complex64], omega: f64) -> Result<Complex64> {
        let mut sum = Complex64::ZERO;
        for (matrix, factor) in [(&self.damping, 1.0), (&self.skew, omega.recip())] {
            if matrix.max_abs() > 0.0 {
                let product = matrix.times(b, CONTEXT)?;
                let inner: Complex64 = a.iter().zip(&product).map(|(a, p)| a.conj() * p).sum();
                sum += inner * factor;
            }
        }
        Ok(sum)
    }

    /// Whether damping couples a mode to the one before.
    fn couple(&self, frequencies: &[f64], shapes: &[Vec<Complex64>], mode: usize) -> Result<bool> {
        let coupling = self.between(&shapes[mode - 1], &shapes[mode], frequencies[mode])?;
        Ok(coupling.norm() > COUPLED * (frequencies[mode] - frequencies[mode - 1]))
    }

    /// The poles of a group of coupled modes.
    fn poles(
        &self,
        frequencies: &[f64],
        shapes: &[Vec<Complex64>],
        number: f64,
        found: &mut Vec<Resonance>,
    ) -> Result<()> {
        let count = frequencies.len();
        let half_i = Complex64::new(0.0, 0.5);
        let mut add = |pole: Complex64| {
            let resonance = Resonance {
                omega: pole.re / number,
                half_width: pole.im.max(0.0) / number,
            };
            try_push(found, resonance, CONTEXT)
        };
        if let ([omega], [shape]) = (frequencies, shapes) {
            let own = about_quadratic(&self.damping, shape) + about_quadratic(&self.skew, shape) / omega;
            // A mode beyond critical damping has no resonance; the undamped frequency stands for it.
            let sigma = 0.5 * own;
            let damped = (omega * omega - sigma * sigma).max(0.0).sqrt();
            let at = if damped > 0.0 { damped } else { *omega };
            return add(Complex64::new(at, sigma));
        }
        check_memory::<Complex64>(
            count.saturating_mul(count).saturating_mul(RESONANCES_EIGEN_COPIES),
            CONTEXT,
        )?;
        let mut matrix = DMatrix::<Complex64>::zeros(count, count);
        for i in 0..count {
            for j in 0..count {
                matrix[(i, j)] = half_i * self.between(&shapes[i], &shapes[j], frequencies[i])?;
            }
            matrix[(i, i)] += frequencies[i];
        }
        let Some(schur) = Schur::try_new(matrix, f64::EPSILON, RESONANCES_MAX_ITERATIONS) else {
            return Err(Error::new(Status::NoConvergence, format_args!("coupled resonances")));
        };
        let (_, triangular) = schur.unpack();
        (0..count).try_for_each(|i| add(triangular[(i, i)]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::sparse_storage::matrix_view::MatrixView;
    use crate::model::matrices::speed::Speed;

    /// A chain of n masses whose neighbours are coupled by gyroscopic forces, with dampers of several sizes.
    fn rotating_chain(n: usize) -> Model {
        let (mut mass, mut damping) = (vec![0.0; n * n], vec![0.0; n * n]);
        let (mut stiffness, mut gyroscopic) = (vec![0.0; n * n], vec![0.0; n * n]);
        for i in 0..n {
            mass[i * n + i] = 1.0 + 0.3 * (1.7 * i as f64).sin();
            damping[i * n + i] = [1e-4, 0.01, 0.0, 0.8][i % 4];
            stiffness[i * n + i] = 2.0 + 0.2 * (0.9 * i as f64).cos();
            if i + 1 < n {
                (stiffness[i * n + i + 1], stiffness[(i + 1) * n + i]) = (-1.0, -1.0);
                let g = if i % 2 == 0 { 0.4 } else { 0.0 };
                (gyroscopic[i * n + i + 1], gyroscopic[(i + 1) * n + i]) = (g, -g);
            }
        }
        let mut model = Model::new(n).unwrap();
        for (kind, values) in [
            (MatrixKind::Mass, &mass),
            (MatrixKind::Damping, &damping),
            (MatrixKind::Stiffness, &stiffness),
            (MatrixKind::Gyroscopic, &gyroscopic),
        ] {
            model.set_matrix(kind, &MatrixView::dense(n, values)).unwrap();
        }
        model.set_speed(Speed::Fixed(1.5)).unwrap();
        model
    }

    #[test]
    fn a_search_with_gyroscopic_forces_finds_what_all_eigenvalues_have_in_the_range() {
        let none = Interrupt::none();
        let model = rotating_chain(40);
        let structure = model.structure();
        let problem = Quadratic {
            mass: &structure.wave_matrix(MatrixKind::Mass, 1).unwrap(),
            damping: &structure.wave_matrix(MatrixKind::Damping, 1).unwrap(),
            stiffness: &structure.wave_matrix(MatrixKind::Stiffness, 1).unwrap(),
            modal: &[],
        };
        let all = problem.lowest(40, &none).unwrap();
        for (low, high) in [(0.7, 0.72), (0.2, 0.9), (0.0, 3.0), (1.3, 2.6), (1.0, 1.0)] {
            let found = gyroscopic_frequencies(1, (low, high).into(), &problem, &none)
                .unwrap()
                .unwrap();
            let is_inside = |value: &Complex64| value.im >= low && value.im <= high && value.im > 0.0;
            let sharp = |value: &Complex64| -value.re <= 0.5 * (high - low).max(0.01 * (low + high));
            let expected: Vec<_> = all
                .iter()
                .map(|(value, _)| *value)
                .filter(|v| is_inside(v) && sharp(v))
                .collect();
            for value in &expected {
                let is_it = |r: &Resonance| (r.omega - value.im).hypot(r.half_width + value.re) < 1e-10;
                assert!(found.iter().any(is_it), "{value} in {low} .. {high}: {found:?}");
            }
            assert!(found.len() <= all.iter().filter(|(value, _)| is_inside(value)).count());
            assert!(low == high || !expected.is_empty());
        }
    }

    #[test]
    fn damping_that_couples_two_close_modes_moves_their_half_widths() {
        // A damper on the difference of two equal masses: the common motion is undamped.
        let mut model = Model::new(2).unwrap();
        for (kind, values) in [
            (MatrixKind::Mass, [1.0, 0.0, 0.0, 1.0]),
            (MatrixKind::Damping, [1e-3, -1e-3, -1e-3, 1e-3]),
            (MatrixKind::Stiffness, [1.0, 0.0, 0.0, 1.0 + 1e-6]),
        ] {
            model.set_matrix(kind, &MatrixView::dense(2, &values)).unwrap();
        }
        let found = model
            .resonances(1, (0.5, 2.0).into(), ContactState::Stuck, &Interrupt::none())
            .unwrap()
            .unwrap();
        let mut widths: Vec<f64> = found.iter().map(|r| r.half_width).collect();
        widths.sort_by(f64::total_cmp);
        assert!(widths[0] < 1e-9 && (widths[1] - 1e-3).abs() < 1e-9, "{found:?}");
        // In the second harmonic at half the frequency.
        let second = model
            .resonances(2, (0.4, 0.6).into(), ContactState::Stuck, &Interrupt::none())
            .unwrap()
            .unwrap();
        assert!(second.len() == 2 && (second[0].omega - 0.5).abs() < 1e-6);
    }

    #[test]
    fn a_range_of_few_modes_has_all_of_them() {
        // Two equal chains side by side: ω = 2 sin(πj/(2n + 2)), each twice; narrow ranges are searched, wide ones are not.
        let n = 40;
        let mut model = Model::new(2 * n).unwrap();
        let (mut mass, mut stiffness) = (vec![0.0; 4 * n * n], vec![0.0; 4 * n * n]);
        for i in 0..2 * n {
            mass[i * 2 * n + i] = 1.0;
            stiffness[i * 2 * n + i] = 2.0;
            if i % n > 0 {
                stiffness[i * 2 * n + i - 1] = -1.0;
                stiffness[(i - 1) * 2 * n + i] = -1.0;
            }
        }
        for (kind, values) in [(MatrixKind::Mass, &mass), (MatrixKind::Stiffness, &stiffness)] {
            model.set_matrix(kind, &MatrixView::dense(2 * n, values)).unwrap();
        }
        // So little damping lowers ω² by less than rounding.
        model.set_rayleigh(0.0, 1e-8).unwrap();
        let exact = |j: usize| 2.0 * (std::f64::consts::FRAC_PI_2 * j as f64 / (n as f64 + 1.0)).sin();
        for (first, last) in [(1, 1), (7, 8), (20, 21), (40, 40), (1, 40), (3, 2)] {
            let between = |j: usize| {
                if j == 0 {
                    0.5 * exact(1)
                } else {
                    0.5 * (exact(j) + exact(j + 1))
                }
            };
            let range = Range::new(between(first - 1), between(last));
            let found = model.resonances(1, range, ContactState::Stuck, &Interrupt::none());
            let found = found.unwrap().unwrap();
            assert_eq!(found.len(), 2 * (last + 1 - first), "{first} to {last}");
            for (k, pole) in found.iter().enumerate() {
                let omega = exact(first + k / 2);
                // Rounding of ω² is relative to the largest.
                let error = (pole.omega * pole.omega - omega * omega).abs();
                assert!(error < 1e-12, "{first} to {last}, {k}: {error:e}");
                let sigma = 0.5e-8 * omega * omega;
                assert!((pole.half_width - sigma).abs() < 1e-9 * sigma);
            }
        }
    }
}
