//! Turning points of a real Fourier series over one turn: the roots of its derivative.

use crate::error::{Result, try_vec};
use crate::fourier::HarmonicSet;
use crate::fourier::cubic_cell::CubicCell;
use crate::fourier::series::{VALUES_OF_A_CROSSING, jet, turning_point};
use crate::interrupt::Interrupt;
use num_complex::Complex64;
use pulp::{Arch, Simd, WithSimd};
use rustfft::{Fft, FftPlanner};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// An extremum of a signal: its time in τ and its value.
#[derive(Clone, Copy, Debug)]
pub struct Extremum {
    /// Time, in [0, 2π).
    pub tau: f64,
    /// Value of the signal at this time.
    pub x: f64,
}

/// Grid points per period of the highest harmonic.
/// Kind: tuned; measured on: not recorded.
const TURNING_POINTS_POINTS_PER_WAVE: usize = 8;

/// Highest reduced harmonic up to which a table of sines is quicker than a transform.
/// Kind: tuned; measured on: not recorded.
const TURNING_POINTS_TABLE_LIMIT: usize = 40;

/// Most grid points of a quarter of a turn that a table has.
/// Kind: fixed.
const QUARTER: usize = TURNING_POINTS_POINTS_PER_WAVE * TURNING_POINTS_TABLE_LIMIT / 4;

/// Finds every turning point of motions with one harmonic set: x′ and x″ on a grid, then roots of x′ in its cells, where it is
/// nearly a cubic.
///
/// For sets of odd harmonics only [0, π) is scanned: x(τ + π) = −x(τ).
pub struct TurningPoints {
    arch: Arch,
    points: usize,
    spacing: f64,
    slope: Vec<f64>,
    /// Values of x″ at the grid points.
    turning: Vec<f64>,
    kind: Grid,
}

enum Grid {
    /// Per harmonic, the rows −p sin(pτⱼ) and −p cos(pτⱼ).
    Table(Vec<f64>),
    /// Inverse transform over the whole turn of x′ + i x″.
    Transform {
        plan: Arc<dyn Fft<f64>>,
        buffer: Vec<Complex64>,
        scratch: Vec<Complex64>,
    },
}

impl TurningPoints {
    /// Tables and memory for motions of `set`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(set: &HarmonicSet) -> Result<Self> {
        let highest = set.highest_reduced().max(1);
        // A multiple of 4, so that half a turn is a whole number of cells.
        let whole = (TURNING_POINTS_POINTS_PER_WAVE * highest).max(16).next_multiple_of(4);
        let points = if set.is_odd() { whole / 2 } else { whole };
        let spacing = TAU / whole as f64;
        let kind = if highest <= TURNING_POINTS_TABLE_LIMIT {
            let sines = Sines::new(whole);
            let mut table = try_vec(2 * set.oscillating() * points, 0.0, "a table of sines")?;
            for (k, rows) in table.chunks_exact_mut(2 * points).enumerate() {
                let p = set.reduced(k);
                let (of_sine, of_cosine) = rows.split_at_mut(points);
                // p·j and p·j + whole/4 within one turn, without a division.
                let step = p % whole;
                let (mut at, mut ahead) = (0, whole / 4);
                for (sine, cosine) in of_sine.iter_mut().zip(of_cosine) {
                    *sine = -(p as f64) * sines.within(at);
                    *cosine = -(p as f64) * sines.within(ahead);
                    for k in [&mut at, &mut ahead] {
                        *k += step;
                        if *k >= whole {
                            *k -= whole;
                        }
                    }
                }
            }
            Grid::Table(table)
        } else {
            let whole = whole.next_power_of_two();
            let plan = FftPlanner::new().plan_fft_inverse(whole);
            let scratch = try_vec(plan.get_inplace_scratch_len(), Complex64::ZERO, "a transform")?;
            return Ok(Self {
                arch: Arch::new(),
                points: if set.is_odd() { whole / 2 } else { whole },
                spacing: TAU / whole as f64,
                slope: try_vec(whole + 1, 0.0, "a scan for turning points")?,
                turning: try_vec(whole + 1, 0.0, "a scan for turning points")?,
                kind: Grid::Transform {
                    plan,
                    buffer: try_vec(whole, Complex64::ZERO, "a transform")?,
                    scratch,
                },
            });
        };
        Ok(Self {
            arch: Arch::new(),
            points,
            spacing,
            slope: try_vec(points + 1, 0.0, "a scan for turning points")?,
            turning: try_vec(points + 1, 0.0, "a scan for turning points")?,
            kind,
        })
    }

    /// Fills `found` with the extrema of the signal in ascending time: over [0, 2π), or over
    /// [0, π) for sets of odd harmonics. A constant signal has none.
    ///
    /// No turning point is missed, however close to another: a force that lost a pair of them would jump as the
    /// motion varies. Bounds of derivatives identify the cells with at most one root; the others are halved until x varies
    /// in them by no more than rounding.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn find(
        &mut self,
        set: &HarmonicSet,
        packed: &[f64],
        found: &mut Vec<Extremum>,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        found.clear();
        let bounds = Bounds::new(set, packed);
        // This also covers a motion that overflows, for which no bound would end the search.
        if !(bounds.bend > 0.0 && bounds.bend.is_finite()) {
            return Ok(());
        }
        self.scan(set, packed);
        let n = self.points;
        let odd = set.is_odd();
        // One point past the end closes the cycle, with the sign that the mirror image has there.
        for values in [&mut self.slope, &mut self.turning] {
            values[n] = if odd { -values[0] } else { values[0] };
        }
        // The sign at the start is that of the last value before it above rounding.
        let before = self.slope[..n].iter().rfind(|f| f.abs() > bounds.noise);
        let first = before.map_or(self.slope[0] > 0.0, |f| (*f > 0.0) != odd);
        let sign = |value: f64, before: bool| {
            if value.abs() <= bounds.noise {
                before
            } else {
                value > 0.0
            }
        };
        let mut left = Slope {
            tau: 0.0,
            value: self.slope[0],
            turning: self.turning[0],
            positive: sign(self.slope[0], first),
        };
        let start = left.positive;
        let hidden = bounds.largest_dip(self.spacing);
        // Most cells hold no root, and certainly none: both ends are far from zero, on the same side.
        let far = hidden.max(bounds.noise);
        let (mut j, mut next_block) = (1, 1);
        while j <= n {
            if j >= next_block {
                next_block = j + TURNING_POINTS_BLOCK;
                if next_block <= n
                    && let Some(block) = self.slope[j..].first_chunk::<TURNING_POINTS_BLOCK>()
                    && is_far(left.value, block, far)
                {
                    j = next_block;
                    (left.tau, left.value) = ((j - 1) as f64 * self.spacing, block[TURNING_POINTS_BLOCK - 1]);
                    left.turning = self.turning[j - 1];
                    continue;
                }
            }
            let (value, turning, tau) = (self.slope[j], self.turning[j], j as f64 * self.spacing);
            j += 1;
            if j <= n && ((value > far && left.value > far) || (value < -far && left.value < -far)) {
                (left.tau, left.value, left.turning) = (tau, value, turning);
                continue;
            }
            let right = Slope {
                tau,
                value,
                turning,
                positive: if j > n {
                    start != odd
                } else {
                    sign(value, left.positive)
                },
            };
            if left.positive != right.positive || left.value.abs().min(right.value.abs()) <= hidden {
                interrupt.check_before((VALUES_OF_A_CROSSING * packed.len()) as u64)?;
                isolate(set, packed, [left, right], &bounds, found, interrupt)?;
            }
            left = right;
        }
        // Roots just past the end belong to the start of the turn.
        let turn = if odd { PI } else { TAU };
        for e in found.iter_mut() {
            if e.tau >= turn {
                e.tau -= turn;
                e.x = if odd { -e.x } else { e.x };
            }
        }
        if found.len() > 1 {
            found.sort_unstable_by(|a, b| a.tau.total_cmp(&b.tau));
        }
        Ok(())
    }

    /// x′ and x″ at the grid points.
    fn scan(&mut self, set: &HarmonicSet, packed: &[f64]) {
        let n = self.points;
        let rest = &packed[usize::from(set.has_mean())..];
        let (slope, turning) = (&mut self.slope[..n], &mut self.turning[..n]);
        match &mut self.kind {
            Grid::Table(table) => self.arch.dispatch(Scan {
                slope,
                turning,
                rest,
                table,
                numbers: (1.0, set.stride() as f64),
            }),
            Grid::Transform { plan, buffer, scratch } => {
                let whole = buffer.len();
                buffer.fill(Complex64::ZERO);
                for (k, pair) in rest.chunks_exact(2).enumerate() {
                    let p = set.reduced(k);
                    // Half of i·p·Xₚ, and i times half of −p²·Xₚ, with their mirror images.
                    let (half, number) = (0.5 * p as f64 * Complex64::new(-pair[1], pair[0]), p as f64);
                    buffer[p] = half - number * half;
                    buffer[whole - p] = (half + number * half).conj();
                }
                plan.process_with_scratch(buffer, scratch);
                for ((slope, turning), z) in slope.iter_mut().zip(turning).zip(buffer.iter()) {
                    (*slope, *turning) = (z.re, z.im);
                }
            }
        }
    }
}

/// Cells that are judged together.
/// Kind: block.
const TURNING_POINTS_BLOCK: usize = 4;

/// Whether all values, the first one and those of the block, are on the same side of zero and farther from it than
/// `far`.
#[inline]
fn is_far(first: f64, block: &[f64; TURNING_POINTS_BLOCK], far: f64) -> bool {
    let (mut low, mut high) = (first, first);
    for &value in block {
        low = if value < low { value } else { low };
        high = if value > high { value } else { high };
    }
    low > far || high < -far
}

/// Sines of the angles that divide a turn into equal parts, whose number is a multiple of 4.
struct Sines {
    /// Sines in the first quarter of the turn; and the number of parts of a turn.
    first: [f64; QUARTER + 1],
    quarter: usize,
}

impl Sines {
    /// The table for at most four times [`QUARTER`] parts.
    fn new(parts: usize) -> Self {
        let quarter = parts / 4;
        let mut first = [0.0; QUARTER + 1];
        for (k, sine) in first[..=quarter].iter_mut().enumerate() {
            *sine = (TAU * k as f64 / parts as f64).sin();
        }
        Self { first, quarter }
    }

    /// Sine of the angle of `parts` parts, less than a turn.
    fn within(&self, parts: usize) -> f64 {
        let (half, sign) = if parts < 2 * self.quarter {
            (parts, 1.0)
        } else {
            (parts - 2 * self.quarter, -1.0)
        };
        sign * self.first[half.min(2 * self.quarter - half)]
    }
}

/// Computes x′ and x″ at the grid points, from the rows of a table.
struct Scan<'a> {
    slope: &'a mut [f64],
    turning: &'a mut [f64],
    rest: &'a [f64],
    table: &'a [f64],
    /// First reduced number, and distance from one to the next.
    numbers: (f64, f64),
}

impl WithSimd for Scan<'_> {
    type Output = ();

    #[inline(always)]
    #[allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Self {
            slope,
            turning,
            rest,
            table,
            numbers: (mut p, stride),
        } = self;
        let n = slope.len();
        slope.fill(0.0);
        turning.fill(0.0);
        for (pair, rows) in rest.chunks_exact(2).zip(table.chunks_exact(2 * n)) {
            let (sines, cosines) = rows.split_at(n);
            let faster = [p * pair[0], p * pair[1]];
            for (((s, t), &a), &b) in slope.iter_mut().zip(&mut *turning).zip(sines).zip(cosines) {
                *s += pair[0] * a + pair[1] * b;
                *t += faster[0] * b - faster[1] * a;
            }
            p += stride;
        }
    }
}

/// Bounds that distinguish one root of x′ in a cell from several.
struct Bounds {
    /// Bounds of |x‴| and of the fifth derivative.
    bend: f64,
    fifth: f64,
    /// Size up to which values of x′ are rounding, mostly of the angles pτ.
    noise: f64,
    /// Upper bound of |x|.
    size: f64,
}

impl Bounds {
    fn new(set: &HarmonicSet, packed: &[f64]) -> Self {
        let rest = &packed[usize::from(set.has_mean())..];
        let (mut size, mut turn, mut bend, mut fifth) = (0.0, 0.0, 0.0, 0.0);
        let (mut p, stride) = (1.0, set.stride() as f64);
        for [a, b] in rest.as_chunks::<2>().0 {
            let amplitude = a.abs() + b.abs();
            size += amplitude;
            turn += amplitude * p * p;
            bend += amplitude * p * p * p;
            fifth += amplitude * p * p * p * p * p;
            p += stride;
        }
        Self {
            bend,
            fifth,
            noise: 4.0 * f64::EPSILON * turn,
            size,
        }
    }

    /// Whether x varies in a cell of this width by rounding only between roots of x′ that are not separated.
    #[inline]
    fn is_finest(&self, width: f64) -> bool {
        width * width * width < 1e-14 * (self.size / self.bend)
    }

    /// Largest departure of x′ from its chord within a cell.
    #[inline]
    fn largest_dip(&self, width: f64) -> f64 {
        0.125 * self.bend * width * width
    }
}

/// x′ at a time, with its sign; if x′ is zero to rounding, it has the sign of the time before.
#[derive(Clone, Copy)]
struct Slope {
    tau: f64,
    value: f64,
    /// Second derivative x″ at this time.
    turning: f64,
    positive: bool,
}

/// Stores every root of x′ between two times.
fn isolate(
    set: &HarmonicSet,
    packed: &[f64],
    [a, b]: [Slope; 2],
    bounds: &Bounds,
    found: &mut Vec<Extremum>,
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    let width = b.tau - a.tau;
    let crosses = a.positive != b.positive;
    let cell = CubicCell::new([a.value, b.value], [a.turning, b.turning], width);
    let is_certain =
        cell.is_monotone(bounds.fifth, bounds.noise) || (!crosses && cell.keeps_sign(bounds.fifth, bounds.noise));
    if is_certain || bounds.is_finest(width) {
        if crosses {
            let guess = a.tau + width * cell.root();
            push_root(set, packed, [a, b], guess, found);
        }
        return Ok(());
    }
    // A motion that hardly moves is halved to the end of the digits.
    interrupt.check_before(packed.len() as u64)?;
    let tau = 0.5 * (a.tau + b.tau);
    let at = jet(set, packed, tau);
    let (value, turning) = (at.dx, at.ddx);
    let positive = if value.abs() <= bounds.noise {
        a.positive
    } else {
        value > 0.0
    };
    let middle = Slope {
        tau,
        value,
        turning,
        positive,
    };
    isolate(set, packed, [a, middle], bounds, found, interrupt)?;
    isolate(set, packed, [middle, b], bounds, found, interrupt)
}

/// Refines the root of x′ between two times of opposite sign from a guess, and stores it.
fn push_root(set: &HarmonicSet, packed: &[f64], [a, b]: [Slope; 2], guess: f64, found: &mut Vec<Extremum>) {
    // Values of equal sign mean that one of them is rounding.
    if a.value * b.value >= 0.0 {
        let tau = if a.value.abs() < b.value.abs() { a.tau } else { b.tau };
        let x = jet(set, packed, tau).x;
        found.push(Extremum { tau, x });
        return;
    }
    let (tau, x) = turning_point(set, packed, (a.tau, b.tau), (a.value, guess));
    found.push(Extremum { tau, x });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn extrema(set: &HarmonicSet, packed: &[f64]) -> Vec<Extremum> {
        let mut found = Vec::new();
        let mut search = TurningPoints::new(set).unwrap();
        search.find(set, packed, &mut found, &Interrupt::none()).unwrap();
        found
    }

    #[test]
    fn turning_points_alternate_and_are_complete() {
        // Compared with a dense scan, on motions rich in high harmonics, by table and by transform.
        for (highest, k) in [1, 2, 5, 9, 63].into_iter().flat_map(|h| (0..8).map(move |k| (h, k))) {
            for odd in [false, true] {
                let set = HarmonicSet::excited(&[1], highest, true, odd, false).unwrap();
                let packed: Vec<f64> = (0..set.packed_len())
                    .map(|i| {
                        ((i * 37 + highest + 11 * k) as f64 * 0.7).sin() / (1.0 + 0.3 * i as f64).powi(1 + k as i32 % 3)
                    })
                    .collect();
                let found = extrema(&set, &packed);
                let turn = if odd { PI } else { TAU };
                let n = 40_000;
                let slope = |j: usize| jet(&set, &packed, (j as f64 + 0.5) * turn / n as f64).dx;
                let changes = (0..n).filter(|&j| {
                    let next = if j + 1 == n && odd {
                        -slope(0)
                    } else {
                        slope((j + 1) % n)
                    };
                    (slope(j) > 0.0) != (next > 0.0)
                });
                assert_eq!(found.len(), changes.count(), "H = {highest}, odd = {odd}");
                for e in &found {
                    let at = jet(&set, &packed, e.tau);
                    assert!(at.dx.abs() < 1e-9 * at.ddx.abs().max(1.0));
                    assert!((at.x - e.x).abs() < 1e-13);
                }
            }
        }
    }

    #[test]
    fn a_hidden_pair_of_turning_points_is_found() {
        // x' = cos t + 2b cos 2t has two roots around t = pi for b > 1/2; shifted by half a cell,
        // both lie between the same two grid points.
        let set = HarmonicSet::excited(&[1], 3, true, false, false).unwrap();
        let shifted = |b: f64| {
            let x1 = Complex64::new(0.0, -1.0) * Complex64::cis(0.13);
            let x2 = Complex64::new(0.0, -b) * Complex64::cis(0.26);
            [0.0, x1.re, x1.im, x2.re, x2.im, 0.0, 0.0]
        };
        assert_eq!(extrema(&set, &shifted(0.5001)).len(), 4);
        assert_eq!(extrema(&set, &shifted(0.4999)).len(), 2);
    }

    #[test]
    fn three_turning_points_within_one_cell_are_found() {
        // x′ = −sin t + b sin 3t has roots at 0 and ±e, e² = (3b − 1)/(4b), wherever the grid lies.
        for odd in [false, true] {
            let set = HarmonicSet::excited(&[1], 3, true, odd, false).unwrap();
            for (excess, count) in [(1e-2, 3), (1e-4, 3), (1e-6, 3), (1e-8, 3), (-1e-8, 1), (-1e-2, 1)] {
                for j in 0..100 {
                    let shift = 0.37 + 0.0077 * f64::from(j);
                    let b = (1.0 + excess) / 3.0;
                    let x1 = Complex64::cis(shift);
                    let x3 = -Complex64::cis(3.0 * shift) * b / 3.0;
                    let packed = if odd {
                        vec![x1.re, x1.im, x3.re, x3.im]
                    } else {
                        vec![0.0, x1.re, x1.im, 0.0, 0.0, x3.re, x3.im]
                    };
                    let found = extrema(&set, &packed);
                    assert_eq!(found.len(), if odd { count } else { 2 * count }, "{excess:e}, {shift}");
                }
            }
        }
    }

    #[test]
    fn a_motion_flat_over_much_of_its_period_is_scanned_in_bounded_time() {
        // x′ is a power of the sine: a root of order 31, which rounding splits arbitrarily.
        let set = HarmonicSet::excited(&[1], 31, true, true, false).unwrap();
        let mut binomial = 1.0;
        let mut packed = vec![0.0; set.packed_len()];
        for k in 0..16 {
            let p = 31 - 2 * k;
            packed[p - 1] = (if k % 2 == 0 { binomial } else { -binomial }) / p as f64;
            binomial *= (31 - k) as f64 / (k + 1) as f64;
        }
        let found = extrema(&set, &packed);
        assert!(found.len() % 2 == 1 && found.len() < 6, "{} roots", found.len());
    }
}
