//! The Hermitian eigenproblem K φ = λ M φ with a mass matrix that may be singular.

use crate::error::{Result, Status, fail, try_copy, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::hermitian;
use crate::linalg::dense::real_pencil;
use crate::linalg::dense::small_pencil;
use crate::linalg::factors::lu::Lu;
use nalgebra::DMatrix;
use num_complex::Complex64;

const CONTEXT: &str = "the eigenvalues of a matrix";

/// Eigenvalues in ascending order, with mass-normalised vectors as columns. Infinite eigenvalues (motion without
/// mass) are left out.
pub struct Pairs {
    /// Eigenvalues λ, ascending.
    pub values: Vec<f64>,
    /// Vectors φ with φᴴ M φ = 1; one column per eigenvalue.
    pub vectors: DMatrix<Complex64>,
}

/// Order up to which the eigensolver of nalgebra is so quick that nobody needs to interrupt it.
/// Kind: tuned; measured on: not recorded.
pub const EIGEN_SMALL_UP_TO: usize = 100;

/// Columns of a product between two checks of the interrupt.
/// Kind: block.
const EIGEN_AT_ONCE: usize = 16;

/// Ratio of the smallest to the largest pivot of a mass matrix that is regular.
/// Kind: rounding.
const REGULAR: f64 = 1e-5;

/// Relative size below which an eigenvalue of the mass matrix counts as zero.
/// Kind: rounding.
const MASSLESS: f64 = 1e-12;

/// All finite eigenpairs of a Hermitian K and a positive semidefinite Hermitian M.
///
/// Where masses differ by far and their stiffness differs alike, as rotations beside translations, each motion is measured in a unit,
/// a power of two, in which its own mass is about 1: a mass that is small in its unit alone would be taken for none.
///
/// # Errors
/// `NotPositiveDefinite` when M has a negative eigenvalue, `Singular` when K cannot be condensed
/// onto the directions with mass, `NoConvergence` from the eigensolver; `StoppedByCaller`.
pub fn generalised(k: &DMatrix<Complex64>, m: &DMatrix<Complex64>, interrupt: &Interrupt<'_>) -> Result<Pairs> {
    let Some(units) = units(k, m)? else {
        return in_one_unit(k, m, interrupt);
    };
    let n = k.nrows();
    let scaled = |a: &DMatrix<Complex64>| filled(n, n, |i, j| a[(i, j)] * units[i] * units[j]);
    let mut pairs = in_one_unit(&scaled(k)?, &scaled(m)?, interrupt)?;
    for mut column in pairs.vectors.column_iter_mut() {
        for (z, unit) in column.iter_mut().zip(&units) {
            *z *= *unit;
        }
    }
    Ok(pairs)
}

/// The eigenpairs of matrices in which the masses of all motions may be compared.
///
/// M is diagonalised first, M = U Λ Uᴴ; massless directions are condensed statically onto the
/// others (their rows carry K only), and the rest is scaled by Λ^(-1/2).
fn in_one_unit(k: &DMatrix<Complex64>, m: &DMatrix<Complex64>, interrupt: &Interrupt<'_>) -> Result<Pairs> {
    let n = k.nrows();
    if n > EIGEN_SMALL_UP_TO
        && let Some(pairs) = with_definite_mass(k, m, REGULAR, interrupt)?
    {
        return Ok(pairs);
    }
    // The common case, M positive definite.
    if n <= EIGEN_SMALL_UP_TO
        && let Some((values, vectors)) = small_pencil::with_definite_mass(k, m, REGULAR)?
    {
        interrupt.check()?;
        return Ok(Pairs { values, vectors });
    }
    let (mass, u) = hermitian(m, interrupt)?;
    let largest = mass.last().copied().unwrap_or(0.0);
    if let Some(pivot) = mass
        .iter()
        .position(|&x| x < -MASSLESS * largest.abs().max(f64::MIN_POSITIVE))
    {
        return fail!(
            NotPositiveDefinite,
            "mass matrix is not positive semidefinite: eigenvalue {pivot} is {}",
            mass[pivot]
        );
    }
    let massless = mass.iter().take_while(|&&x| x <= MASSLESS * largest).count();
    let heavy = n - massless;
    if heavy == 0 {
        return fail!(NotPositiveDefinite, "mass matrix is zero: there is no vibration mode");
    }
    let k = product(&adjoint(&u)?, &product(k, &u, interrupt)?, interrupt)?;
    let kss = filled(massless, massless, |i, j| k[(i, j)])?;
    let ksh = filled(massless, heavy, |i, j| k[(i, massless + j)])?;
    let khh = filled(heavy, heavy, |i, j| k[(massless + i, massless + j)])?;
    let (condensed, static_part) = if massless == 0 {
        (khh, zeros(0, heavy)?)
    } else {
        let mut lu = Lu::new(massless, heavy)?;
        lu.matrix().copy_from_slice(kss.as_slice());
        let mut x = copy(&ksh)?;
        match lu.factor(interrupt) {
            Err(e) if e.status == Status::Singular => {
                return fail!(Singular, "stiffness of the massless degrees of freedom is singular");
            }
            factored => factored?,
        }
        lu.solve_columns(x.as_mut_slice(), false, interrupt)?;
        (khh - product(&adjoint(&ksh)?, &x, interrupt)?, -x)
    };
    let scale: Vec<f64> = mass[massless..].iter().map(|x| 1.0 / x.sqrt()).collect();
    let a = filled(heavy, heavy, |i, j| condensed[(i, j)] * scale[i] * scale[j])?;
    let (values, reduced) = hermitian(&a, interrupt)?;
    let heavy_part = filled(heavy, heavy, |i, j| reduced[(i, j)] * scale[i])?;
    let light_part = product(&static_part, &heavy_part, interrupt)?;
    let mut stacked = zeros(n, heavy)?;
    stacked.view_mut((0, 0), (massless, heavy)).copy_from(&light_part);
    stacked.view_mut((massless, 0), (heavy, heavy)).copy_from(&heavy_part);
    Ok(Pairs {
        values,
        vectors: product(&u, &stacked, interrupt)?,
    })
}

/// Factor for each motion, a power of two near 1/√M_ii. `None` where the masses are about equal, where one is zero or
/// negative, and where one is so small beside its own stiffness that it counts as none.
fn units(k: &DMatrix<Complex64>, m: &DMatrix<Complex64>) -> Result<Option<Vec<f64>>> {
    let (mass, stiffness) = (m.diagonal(), k.diagonal());
    let range = |numbers: &mut dyn Iterator<Item = f64>| {
        numbers.fold((f64::INFINITY, 0.0_f64), |(least, most), x| (least.min(x), most.max(x)))
    };
    let masses = range(&mut mass.iter().map(|z| z.re));
    let shares = range(&mut mass.iter().zip(stiffness.iter()).map(|(m, k)| m.re / k.re));
    let are_usable = masses.0 > 0.0 && shares.0 > MASSLESS * shares.1 && shares.1.is_finite();
    if !are_usable || stiffness.iter().any(|k| k.re <= 0.0) || masses.0 > REGULAR * masses.1 {
        return Ok(None);
    }
    let mut units = try_vec(mass.len(), 1.0, CONTEXT)?;
    for (unit, mass) in units.iter_mut().zip(mass.iter()) {
        *unit = (-0.5 * mass.re.log2()).round().exp2();
    }
    Ok(Some(units))
}

/// The eigenpairs by M = L Lᴴ; `None` where M is not definite, or its smallest pivot is below a share `regular` of
/// the largest.
///
/// # Errors
/// `NoConvergence`, `OutOfMemory`; `StoppedByCaller`.
pub fn with_definite_mass(
    k: &DMatrix<Complex64>,
    m: &DMatrix<Complex64>,
    regular: f64,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Pairs>> {
    let n = k.nrows();
    // On a small stack blocked products of real numbers have no room.
    if n > EIGEN_SMALL_UP_TO
        && let Some((values, vectors)) = real_pencil::with_definite_mass(k, m, regular, interrupt)?
    {
        return Ok(Some(Pairs { values, vectors }));
    }
    let mut l = copy(m)?;
    if !hermitian::cholesky(l.as_mut_slice(), n, interrupt)? {
        return Ok(None);
    }
    let diagonal = l.diagonal().map(|x| x.re);
    if diagonal.min() <= regular * diagonal.max() {
        return Ok(None);
    }
    let l = l.as_slice();
    let mut left = copy(k)?;
    hermitian::solve_triangular(l, n, false, left.as_mut_slice(), interrupt)?;
    let mut a = adjoint(&left)?;
    hermitian::solve_triangular(l, n, false, a.as_mut_slice(), interrupt)?;
    let (values, mut vectors) = hermitian(&a, interrupt)?;
    hermitian::solve_triangular(l, n, true, vectors.as_mut_slice(), interrupt)?;
    Ok(Some(Pairs { values, vectors }))
}

/// A matrix of zeros, or an error if memory is short.
fn zeros(rows: usize, cols: usize) -> Result<DMatrix<Complex64>> {
    let values = try_vec(rows.saturating_mul(cols), Complex64::ZERO, CONTEXT)?;
    Ok(DMatrix::from_vec(rows, cols, values))
}

/// A matrix with given entries, or an error if memory is short.
fn filled(rows: usize, cols: usize, entry: impl Fn(usize, usize) -> Complex64) -> Result<DMatrix<Complex64>> {
    let mut a = zeros(rows, cols)?;
    for (j, mut column) in a.column_iter_mut().enumerate() {
        for (i, value) in column.iter_mut().enumerate() {
            *value = entry(i, j);
        }
    }
    Ok(a)
}

/// A copy of a matrix, or an error if memory is short.
fn copy(a: &DMatrix<Complex64>) -> Result<DMatrix<Complex64>> {
    Ok(DMatrix::from_vec(
        a.nrows(),
        a.ncols(),
        try_copy(a.as_slice(), CONTEXT)?,
    ))
}

/// The conjugate transpose of a matrix, or an error if memory is short.
fn adjoint(a: &DMatrix<Complex64>) -> Result<DMatrix<Complex64>> {
    filled(a.ncols(), a.nrows(), |i, j| a[(j, i)].conj())
}

/// Product a b, computed a few columns at a time with checks for a stop.
fn product(a: &DMatrix<Complex64>, b: &DMatrix<Complex64>, interrupt: &Interrupt<'_>) -> Result<DMatrix<Complex64>> {
    let mut c = zeros(a.nrows(), b.ncols())?;
    for first in (0..b.ncols()).step_by(EIGEN_AT_ONCE) {
        let count = EIGEN_AT_ONCE.min(b.ncols() - first);
        interrupt.check_before((8 * a.nrows() * a.ncols() * count) as u64)?;
        let part = a * b.columns(first, count);
        c.columns_mut(first, count).copy_from(&part);
    }
    Ok(c)
}

/// Eigenvalues in ascending order and orthonormal eigenvectors of a Hermitian matrix.
fn hermitian(a: &DMatrix<Complex64>, interrupt: &Interrupt<'_>) -> Result<(Vec<f64>, DMatrix<Complex64>)> {
    interrupt.check()?;
    let n = a.nrows();
    if n <= EIGEN_SMALL_UP_TO {
        return small_pencil::hermitian(a);
    }
    let half = Complex64::new(0.5, 0.0);
    let mut symmetric = filled(n, n, |i, j| (a[(i, j)] + a[(j, i)].conj()) * half)?;
    let (values, vectors) = hermitian::eigen(symmetric.as_mut_slice(), n, interrupt)?;
    Ok((values, DMatrix::from_vec(n, n, vectors)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn real(n: usize, v: &[f64]) -> DMatrix<Complex64> {
        DMatrix::from_fn(n, n, |i, j| v[j * n + i].into())
    }

    #[test]
    fn a_massless_dof_is_condensed() {
        // Two springs in series between ground and a unit mass, massless joint: 1/(1/2 + 1/2) = 1.
        let k = real(2, &[4.0, -2.0, -2.0, 2.0]);
        let m = real(2, &[0.0, 0.0, 0.0, 1.0]);
        let pairs = generalised(&k, &m, &Interrupt::none()).unwrap();
        assert_eq!(pairs.values.len(), 1);
        assert!((pairs.values[0] - 1.0).abs() < 1e-14);
        assert!((pairs.vectors[(0, 0)] - pairs.vectors[(1, 0)] * 0.5).norm() < 1e-14);
    }

    #[test]
    fn a_large_chain_with_massless_joints_has_its_frequencies_in_closed_form() {
        // Every second joint of a chain of 2·n + 1 springs of 2 is massless: springs of 1 between unit masses.
        let n = 70;
        for massless in [false, true] {
            let order = if massless { 2 * n + 1 } else { 2 * n };
            let mut k = DMatrix::<Complex64>::zeros(order, order);
            let mut m = DMatrix::<Complex64>::zeros(order, order);
            for i in 0..order {
                k[(i, i)] = 4.0.into();
                if i > 0 {
                    k[(i, i - 1)] = (-2.0).into();
                    k[(i - 1, i)] = (-2.0).into();
                }
                m[(i, i)] = if massless && i % 2 == 0 {
                    Complex64::ZERO
                } else {
                    Complex64::ONE
                };
            }
            let pairs = generalised(&k, &m, &Interrupt::none()).unwrap();
            let count = if massless { n } else { order };
            assert_eq!(pairs.values.len(), count);
            let stiffness = if massless { 1.0 } else { 2.0 };
            for (j, value) in pairs.values.iter().enumerate() {
                let half = 0.5 * (j + 1) as f64 * std::f64::consts::PI / (count + 1) as f64;
                let exact = 4.0 * stiffness * half.sin().powi(2);
                assert!((value - exact).abs() < 1e-12, "{massless} {j}: {value} {exact}");
            }
            let x = pairs.vectors.column(3);
            assert!((x.dotc(&(&m * x)).re - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn an_indefinite_mass_is_an_error() {
        let pairs = generalised(
            &real(2, &[1.0, 0.0, 0.0, 1.0]),
            &real(2, &[1.0, 0.0, 0.0, -1.0]),
            &Interrupt::none(),
        );
        assert!(pairs.is_err_and(|e| e.status == crate::error::Status::NotPositiveDefinite));
    }

    #[test]
    fn a_negative_definite_mass_is_an_error() {
        for n in 1..=4 {
            let k = DMatrix::<Complex64>::identity(n, n);
            let m = DMatrix::from_fn(n, n, |i, j| match i.abs_diff(j) {
                0 => Complex64::from(-2.0),
                1 => Complex64::new(0.0, if i > j { 0.4 } else { -0.4 }),
                _ => Complex64::ZERO,
            });
            let pairs = generalised(&k, &m, &Interrupt::none());
            assert!(
                pairs.is_err_and(|e| e.status == crate::error::Status::NotPositiveDefinite),
                "{n}"
            );
        }
    }
}
