//! Search for the damped modes of lowest frequency of a large structure, none missing and none twice.
//!
//! Eigenvalues next to a shift are found with the radius of a disc in which none is missing. Wanted are those with 0 < Im λ ≤ w. A
//! first disc about a shift near iw/2 covers them up to a share of w on both sides of the imaginary axis; rectangles further out, in which
//! strong dampers put few eigenvalues, are covered by discs of their own.

use crate::error::{Result, Status, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::hermitian;
use crate::linalg::exact_sums::quadratic::{QUADRATIC_ROUNDING, quadratic, terms};
use crate::linalg::factors::factor::Factor;
use crate::linalg::iterative::lanczos;
use crate::linalg::iterative::lanczos::DENSE_IF_HARD;
use crate::linalg::iterative::near_shift::{Goal, Near, NearShift};
use crate::linalg::sparse_storage::definite::resists_all_motion;
use crate::linalg::sparse_storage::sparse::{Csc, Form};
use crate::model::natural_modes::linear_modes::RIGID_MODES;
use crate::model::natural_modes::quadratic_problem::{ONE_VALUE, Pair, Quadratic, is_one};
use crate::options::Range;
use core::f64::consts::SQRT_2;
use num_complex::Complex64;

/// The first shift over the estimated w: beside the axis, where undamped modes lie.
const QUADRATIC_SEARCH_SHIFT: Complex64 = Complex64::new(0.05, 0.5);

/// Share of w on both sides of the imaginary axis that the first disc covers.
/// Kind: tuned; measured on: not recorded.
const BESIDE_AXIS: f64 = 0.5;

/// Growth of the half width of the strip from rectangle to rectangle, and its end over w: beyond are modes with a damping ratio above 0.99.
/// Kind: tuned; measured on: not recorded.
const WIDER: f64 = 2.5;
const FARTHEST: f64 = 8.0;

/// That end with structural damping, where a bound mostly ends the search before.
/// Kind: cap.
const FARTHEST_HELD: f64 = 1e4;

/// Most eigenvalues in a rectangle beyond the number that is requested: more are overdamped motions next to each other.
/// Kind: cap.
const MOST_ASIDE: usize = 60;

/// w over the imaginary part of the shift, between which the shift suits.
/// Kind: tuned; measured on: not recorded.
const SUITS: (f64, f64) = (1.2, 3.5);

/// Most shifts for the first disc, and most growths of the number that is searched.
/// Kind: cap.
const SHIFTS: usize = 8;
const GROWTHS: usize = 12;

/// Relative distance of a second shift where the first hit an eigenvalue.
/// Kind: tuned; measured on: not recorded.
const QUADRATIC_SEARCH_ASIDE: f64 = 0.03;

/// Damping ratio up to which a mode counts within the narrowest range: beyond, its peak is wider than the range.
/// Kind: tuned; measured on: chains of 20 to 600 masses with gyroscopic forces.
const RATIO_WITHIN: f64 = 0.01;

const CONTEXT: &str = "the damped modes";

/// Modes of lowest frequency by a search: at least `count`, the first `count` of which are the lowest. `None` where
/// not so many were found in a share of all eigenvalues, so that all should be computed.
///
/// # Errors
/// Those of the eigensolvers.
pub fn lowest_by_search(
    problem: &Quadratic<'_>,
    hermitian: &Csc,
    count: usize,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Vec<Pair>>> {
    let mut first = match first_disc(problem, hermitian, count, interrupt) {
        Ok(Some(first)) => first,
        Ok(None) => return Ok(None),
        Err(e) if e.status == Status::NoConvergence && problem.mass.rows <= DENSE_IF_HARD => return Ok(None),
        Err(e) => return Err(e),
    };
    let covered = first.covered();
    // Structural damping gives a frequency to motions that strong dampers hold, however far away.
    let bounds = Bounds::new(problem, hermitian, interrupt)?;
    let has_structural = bounds.structural.is_some();
    let farthest = if has_structural { FARTHEST_HELD } else { FARTHEST } * first.height;
    for side in [-1.0, 1.0] {
        let mut inside = covered;
        loop {
            if bounds.hold(side, inside, first.height, interrupt)? {
                break;
            }
            if inside >= farthest {
                if problem.mass.rows <= DENSE_IF_HARD && has_structural {
                    return Ok(None);
                }
                break;
            }
            let outside = WIDER * inside;
            let Some(found) = aside(problem, &first, side, inside, outside, interrupt)? else {
                if problem.mass.rows <= DENSE_IF_HARD {
                    return Ok(None);
                }
                break;
            };
            for pair in found {
                if !first.pairs.iter().any(|known| is_one(known, &pair)) {
                    try_push(&mut first.pairs, pair, CONTEXT)?;
                }
            }
            inside = outside;
        }
    }
    first.pairs.sort_by(|a, b| a.0.im.total_cmp(&b.0.im));
    Ok(Some(first.pairs))
}

/// Eigenvalues of the modes whose frequencies lie within a range, and of some beside it: those in a disc about the middle of the range, whose
/// radius covers as much on both sides of the imaginary axis as along it. `None` if they are more than `most`, or cannot be told apart.
///
/// # Errors
/// Those of the eigensolvers.
pub fn within(
    problem: &Quadratic<'_>,
    range: Range,
    most: usize,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Vec<Complex64>>> {
    let hermitian = problem.hermitian_stiffness()?;
    if let Some((found, _)) = problem.on_moving_rows(&hermitian, |moving| within(moving, range, most, interrupt))? {
        return Ok(found);
    }
    let middle = 0.5 * (range.low() + range.high());
    let radius = SQRT_2 * (0.5 * range.width()).max(RATIO_WITHIN * middle);
    let middle = Complex64::new(0.0, middle);
    let mut search = operator(problem, middle, interrupt)?;
    // A shift that was moved aside lies off the middle.
    let reach = radius + (search.shift() - middle).norm();
    let near = match search.search(Goal::Within(reach, most)) {
        Err(e) if e.status == Status::NoConvergence => return Ok(None),
        near => near?,
    };
    if near.radius < reach * (1.0 - ONE_VALUE) {
        return Ok(None);
    }
    let mut modes = Vec::new();
    for (value, shape) in near.pairs {
        if let Some(value) = problem.as_mode(value, &shape) {
            try_push(&mut modes, value, CONTEXT)?;
        }
    }
    modes.sort_by(|a, b| a.im.total_cmp(&b.im));
    Ok(Some(modes))
}

/// Modes in a disc that contains the lowest ones, except those far from the imaginary axis.
struct Disc {
    pairs: Vec<Pair>,
    shift: Complex64,
    radius: f64,
    /// Frequency w of the last requested mode.
    height: f64,
    count: usize,
}

impl Disc {
    /// Radius of a disc about the shift that covers the strip up to the frequency w.
    fn needed(shift: Complex64, height: f64) -> f64 {
        let along = shift.im.max(height - shift.im);
        (BESIDE_AXIS * height + shift.re.abs()).hypot(along)
    }

    /// Half width of the strip that the disc covers.
    fn covered(&self) -> f64 {
        let along = self.shift.im.max(self.height - self.shift.im);
        let width = (self.radius.powi(2) - along.powi(2)).max(0.0).sqrt() - self.shift.re.abs();
        width.clamp(BESIDE_AXIS * self.height, FARTHEST * self.height)
    }
}

fn first_disc(
    problem: &Quadratic<'_>,
    hermitian: &Csc,
    count: usize,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Disc>> {
    let n = problem.mass.rows;
    let mut height = estimate(problem, hermitian, count, interrupt)?;
    let mut number = count + count / 2 + 10;
    for at in 0..SHIFTS {
        let shift = QUADRATIC_SEARCH_SHIFT * height;
        let mut search = operator(problem, shift, interrupt)?;
        for _ in 0..GROWTHS {
            if number > n {
                return Ok(None);
            }
            let Near { pairs, radius } = search.search(Goal::Nearest(number))?;
            let is_whole = radius == f64::INFINITY;
            let mut modes = Vec::new();
            for (value, shape) in pairs {
                if (value - shift).norm() > radius {
                    continue;
                }
                if let Some(value) = problem.as_mode(value, &shape) {
                    try_push(&mut modes, (value, shape), CONTEXT)?;
                }
            }
            modes.sort_by(|a, b| a.0.im.total_cmp(&b.0.im));
            let Some(last) = modes.get(count - 1).map(|(value, _)| value.im).filter(|im| *im > 0.0) else {
                if is_whole {
                    return Ok(None);
                }
                number *= 2;
                continue;
            };
            let ratio = last / shift.im;
            let suits = (SUITS.0..=SUITS.1).contains(&ratio);
            let needed = Disc::needed(shift, last);
            if radius >= needed {
                return Ok(Some(Disc {
                    pairs: modes,
                    shift,
                    radius,
                    height: last,
                    count,
                }));
            }
            if !suits && at + 1 < SHIFTS {
                height = last;
                break;
            }
            let more = (number as f64 * (needed / radius).min(2.0)) as usize;
            number = more.max(number + 8);
        }
    }
    Ok(None)
}

/// Frequency of mode number `count` without damping and gyroscopic forces, or of a typical mode where this cannot be
/// computed.
fn estimate(problem: &Quadratic<'_>, hermitian: &Csc, count: usize, interrupt: &Interrupt<'_>) -> Result<f64> {
    let n = problem.mass.rows;
    // Motions that nothing holds are no modes, and rounding is all that is known of their frequencies.
    let mut wanted = count;
    for _ in 0..2 {
        match lanczos::lowest(hermitian, problem.mass, wanted, interrupt) {
            Ok(pairs) => {
                let held = |shape: &[Complex64]| {
                    quadratic(hermitian, shape).abs() > QUADRATIC_ROUNDING * terms(hermitian, shape)
                };
                let (mut highest, mut modes) = (0.0_f64, 0);
                for (value, shape) in pairs.values.iter().zip(pairs.vectors.column_iter()) {
                    interrupt.check()?;
                    if modes < count && held(shape.as_slice()) {
                        highest = highest.max(*value);
                        modes += 1;
                    }
                }
                if highest > 0.0 && (modes == count || wanted > count) {
                    return Ok(highest.sqrt());
                }
                wanted = count + RIGID_MODES;
            }
            Err(e) if matches!(e.status, Status::OutOfMemory | Status::StoppedByCaller) => return Err(e),
            Err(_) => break,
        }
    }
    let sum = |a: &Csc| -> f64 { (0..n).map(|i| a.get(i, i).re.abs()).sum() };
    Ok((sum(hermitian) / sum(problem.mass)).sqrt())
}

/// The operator at a shift, which is moved aside if it hits an eigenvalue.
fn operator<'a>(problem: &Quadratic<'a>, shift: Complex64, interrupt: &'a Interrupt<'a>) -> Result<NearShift<'a>> {
    let matrices = [problem.mass, problem.damping, problem.stiffness];
    match NearShift::with_directions(matrices, problem.modal, shift, interrupt) {
        Err(e) if e.status == Status::Singular => NearShift::with_directions(
            matrices,
            problem.modal,
            shift * (1.0 + QUADRATIC_SEARCH_ASIDE),
            interrupt,
        ),
        found => found,
    }
}

/// Modes of a rectangle beside the first disc; `None` if there are too many to be separated.
fn aside(
    problem: &Quadratic<'_>,
    first: &Disc,
    side: f64,
    inside: f64,
    outside: f64,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Vec<Pair>>> {
    let shift = Complex64::new(side * 0.5 * (inside + outside), 0.5 * first.height);
    let radius = (0.5 * (outside - inside)).hypot(0.5 * first.height) * (1.0 + QUADRATIC_SEARCH_ASIDE);
    let mut search = operator(problem, shift, interrupt)?;
    let goal = Goal::Within(radius, first.count + MOST_ASIDE);
    let near = match search.search(goal) {
        Err(e) if e.status == Status::NoConvergence => return Ok(None),
        near => near?,
    };
    if near.radius < radius * (1.0 - QUADRATIC_SEARCH_ASIDE) {
        return Ok(None);
    }
    let mut modes = Vec::new();
    for (value, shape) in near.pairs {
        let is_here = value.im <= first.height && (value - first.shift).norm() > first.radius * (1.0 - ONE_VALUE);
        if let Some(value) = is_here.then(|| problem.as_mode(value, &shape)).flatten() {
            try_push(&mut modes, (value, shape), CONTEXT)?;
        }
    }
    Ok(Some(modes))
}

/// The matrix D of K = K_h + iD with Hermitian parts; `None` where it is rounding.
fn structural(problem: &Quadratic<'_>, hermitian: &Csc) -> Result<Option<Csc>> {
    let terms = [
        (-Complex64::I, problem.stiffness, Form::Plain),
        (Complex64::I, hermitian, Form::Plain),
    ];
    let found = Csc::sum(problem.mass.rows, &terms)?;
    Ok((found.max_abs() > f64::EPSILON * hermitian.max_abs()).then_some(found))
}

/// Largest xᴴL Lᴴx/xᴴMx of the damping beside C, an eigenvalue of LᴴM⁻¹L; infinite where some motion has no mass.
fn largest_rate(problem: &Quadratic<'_>, interrupt: &Interrupt<'_>) -> Result<f64> {
    let (n, count) = (problem.mass.rows, problem.modal.len());
    if count == 0 {
        return Ok(0.0);
    }
    let mut moved = try_vec(n * count, Complex64::ZERO, CONTEXT)?;
    for (column, direction) in moved.chunks_exact_mut(n).zip(problem.modal) {
        for &(p, z) in direction {
            column[p] = z;
        }
    }
    let mut factor = Factor::new(problem.mass, count)?;
    let solved = factor.factor(problem.mass, interrupt);
    match solved.and_then(|()| factor.solve(&mut moved, false, interrupt)) {
        Ok(()) => {}
        Err(e) if e.status == Status::Singular => return Ok(f64::INFINITY),
        Err(e) => return Err(e),
    }
    let mut rates = try_vec(count * count, Complex64::ZERO, CONTEXT)?;
    for (rates, x) in rates.chunks_exact_mut(count).zip(moved.chunks_exact(n)) {
        for (rate, direction) in rates.iter_mut().zip(problem.modal) {
            *rate = direction.iter().map(|&(p, z)| z.conj() * x[p]).sum();
        }
    }
    let (values, _) = hermitian::eigen(&mut rates, count, interrupt)?;
    Ok(values.last().copied().unwrap_or(0.0))
}

/// Matrices and numbers that bound the real parts of modes.
struct Bounds<'a> {
    problem: &'a Quadratic<'a>,
    hermitian: &'a Csc,
    structural: Option<Csc>,
    /// Largest rate of the damping beside C.
    rate: f64,
}

impl<'a> Bounds<'a> {
    fn new(problem: &'a Quadratic<'a>, hermitian: &'a Csc, interrupt: &Interrupt<'_>) -> Result<Self> {
        Ok(Self {
            problem,
            hermitian,
            structural: structural(problem, hermitian)?,
            rate: largest_rate(problem, interrupt)?,
        })
    }

    /// Whether no mode of a frequency up to `height` lies further from the imaginary axis than `covered`, on the left or on the right.
    ///
    /// A mode λ = a + ib with motion x, m = xᴴMx, c = xᴴCx of the Hermitian part and k + id = xᴴKx, k > 0, has
    ///
    /// > c/m = −a − (a k + b d)/(|λ|² m)
    ///
    /// by the real part of λ̄ times its equation. Where |d| is below k covered/height the last term has the sign of the first: −c/m ≤ a ≤ 0 if
    /// c ≥ 0, and a ≤ −c/m if not. A mode of negative k grows by √(−k/m) or less, without D.
    fn hold(&self, side: f64, covered: f64, height: f64, interrupt: &Interrupt<'_>) -> Result<bool> {
        let Self { problem, hermitian, .. } = *self;
        let n = problem.mass.rows;
        let sum = |a: (f64, &Csc), b: (f64, &Csc)| {
            Csc::sum(n, &[(a.0.into(), a.1, Form::Plain), (b.0.into(), b.1, Form::Plain)])
        };
        if let Some(structural) = &self.structural
            && !resists_all_motion(&sum((covered / height, hermitian), (side, structural))?, interrupt)?
        {
            return Ok(false);
        }
        let transposed = Csc::sum(n, &[(Complex64::ONE, problem.damping, Form::Transposed)])?;
        let half = Complex64::new(0.5, 0.0);
        let damping = Csc::sum(
            n,
            &[
                (half, problem.damping, Form::Plain),
                (half, &transposed, Form::Conjugated),
            ],
        )?;
        // The bounds hold for k ≥ −covered² m.
        let stiffer = sum((1.0, hermitian), (covered * covered, problem.mass))?;
        if !resists_all_motion(&stiffer, interrupt)? {
            return Ok(false);
        }
        // Damping of modes moves eigenvalues to the left alone.
        let covered = if side < 0.0 { covered - self.rate } else { covered };
        if covered.is_nan() || covered <= 0.0 {
            return Ok(false);
        }
        if damping.max_abs() <= f64::EPSILON * problem.damping.max_abs() {
            return Ok(true);
        }
        resists_all_motion(&sum((side, &damping), (covered, problem.mass))?, interrupt)
    }
}
