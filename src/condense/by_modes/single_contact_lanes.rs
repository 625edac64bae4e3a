//! Flexibility tables from modes of all harmonics of a single relative motion at once: several harmonics share a vector of the
//! processor. The formulas, and the order in which numbers are combined, are those of [`crate::condense::by_modes::single_contact`].

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::condense::by_factors::flexibility::Table;
use crate::condense::by_modes::modal_table::ModalTable;
use crate::condense::by_modes::sum_terms::Factors;
use crate::condense::by_modes::wave_modes::NEAR_RESONANCE;
use crate::error::{Result, try_push, try_room};
use crate::linalg::libraries::{Arch, Simd, WithSimd};
use core::array::from_fn;
use num_complex::Complex64;

/// Harmonics of a group: a multiple of the numbers in a vector of any processor.
/// Kind: block.
const HARMONIC_LANES: usize = 8;

/// Entries of a table: of the contact and the response by the contact, of both by the excitation.
/// Kind: fixed.
const LANE_ENTRIES: usize = 4;

/// A real number for each harmonic of a group.
type Numbers = [f64; HARMONIC_LANES];

/// A complex number for each harmonic of a group.
#[derive(Clone, Copy)]
struct Lanes {
    re: Numbers,
    im: Numbers,
}

/// The k-th mode of each harmonic of a group.
struct Mode {
    /// Eigenvalue μ of the mode in each harmonic.
    value: Numbers,
    /// For each entry of the table, the product of output and input of the mode.
    products: [Lanes; LANE_ENTRIES],
}

/// Up to eight harmonics that are computed together.
struct Group {
    /// Index of the first harmonic of the group among the carried ones, and the number of harmonics in it. Lanes
    /// beyond that number repeat the last harmonic.
    first: usize,
    count: usize,
    number: Numbers,
    /// Damping factors α and β and loss factor η of each harmonic.
    alpha: Numbers,
    beta: Numbers,
    loss_factor: Numbers,
    /// Stiffness of the contact and Im κ in each harmonic.
    stiffness: Numbers,
    imaginary: Numbers,
    /// Number of the first lanes that hold all harmonics in which the excitation moves a mode.
    forced: usize,
    modes: Vec<Mode>,
}

/// All carried harmonics of a model with one contact, in groups.
pub(crate) struct SingleContactLanes {
    arch: Arch,
    groups: Vec<Group>,
}

impl SingleContactLanes {
    /// Groups the harmonics of these tables; `None` unless each table is one of a single contact.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(tables: &[Option<ModalTable>]) -> Result<Option<Self>> {
        const CONTEXT: &str = "the flexibility from modes";
        let mut groups = try_room(tables.len().div_ceil(HARMONIC_LANES), CONTEXT)?;
        for (k, tables) in tables.chunks(HARMONIC_LANES).enumerate() {
            let all = tables
                .iter()
                .all(|table| table.as_ref().is_some_and(|t| t.single().is_some()));
            if !all {
                return Ok(None);
            }
            let of = |lane: usize| tables[lane.min(tables.len() - 1)].as_ref().and_then(ModalTable::single);
            let number = |value: &dyn Fn(&crate::condense::by_modes::modal_table::SinglePart<'_>) -> f64| -> Numbers {
                from_fn(|lane| of(lane).map_or(0.0, |part| value(&part)))
            };
            let count = |lane: usize| of(lane).map_or(0, |part| part.contact.modes().len());
            let most = (0..HARMONIC_LANES).map(count).max().unwrap_or(0);
            let mut modes = try_room(most, CONTEXT)?;
            for m in 0..most {
                // A wave with fewer modes has others that do not move.
                let value = number(&|part| part.contact.modes().get(m).map_or(0.0, |mode| mode.value));
                let product = |entry: usize, side: usize| {
                    let of_mode = |mode: &crate::condense::by_modes::single_contact::Mode| mode.products[side][entry];
                    number(&|part| part.contact.modes().get(m).map_or(0.0, of_mode))
                };
                let products = from_fn(|entry| Lanes {
                    re: product(entry, 0),
                    im: product(entry, 1),
                });
                modes.push(Mode { value, products });
            }
            let group = Group {
                first: k * HARMONIC_LANES,
                count: tables.len(),
                number: number(&|part| part.number),
                alpha: number(&|part| part.proportional.0),
                beta: number(&|part| part.proportional.1),
                loss_factor: number(&|part| part.loss_factor),
                stiffness: number(&|part| part.coefficients.entry(0, Factors::of_stiffness(Complex64::ONE)).re),
                imaginary: number(&|part| -part.coefficients.entry(0, Factors::of_stiffness(Complex64::ZERO)).im),
                forced: (0..tables.len())
                    .rfind(|&lane| of(lane).is_some_and(|part| part.contact.is_forced()))
                    .map_or(0, |lane| lane + 1),
                modes,
            };
            try_push(&mut groups, group, CONTEXT)?;
        }
        Ok(Some(Self {
            arch: Arch::new(),
            groups,
        }))
    }

    /// Makes all tables and their slopes at `omega`. Returns `false`, with unusable tables, where a denominator is
    /// small or a number is not finite.
    pub fn evaluate(&self, omega: f64, tables: &mut [Table]) -> bool {
        self.groups.iter().all(|group| {
            let mut found = [[Lanes::ZERO; LANE_ENTRIES]; 2];
            if !self.arch.dispatch(Evaluate(group, omega, &mut found)) {
                return false;
            }
            let [value, slope] = &found;
            let tables = &mut tables[group.first..group.first + group.count];
            for (lane, table) in tables.iter_mut().enumerate() {
                for (to, from) in [(&mut table.value, value), (&mut table.slope, slope)] {
                    for (to, from) in to.iter_mut().zip(from) {
                        *to = Complex64::new(from.re[lane], from.im[lane]);
                    }
                }
            }
            true
        })
    }
}

/// Fills in the table entries of a group and their slopes at ω; the result is `false` where a denominator is small or
/// a number is not finite.
struct Evaluate<'a>(&'a Group, f64, &'a mut [[Lanes; LANE_ENTRIES]; 2]);

impl WithSimd for Evaluate<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        let Self(group, omega, tables) = self;
        let vectors = group.count.div_ceil(size_of::<S::f64s>() / size_of::<f64>());
        // A closure would be compiled without the instructions of the caller.
        for k in 0..vectors {
            if !(Vectors { simd, k }).evaluate(group, omega, tables) {
                return false;
            }
        }
        true
    }
}

/// A view on the numbers of as many harmonics as fit a vector of the processor.
#[derive(Clone, Copy)]
struct Vectors<S> {
    simd: S,
    /// Index of the vector among those of a group.
    k: usize,
}

/// A vector of complex numbers.
#[derive(Clone, Copy)]
struct Complex<V> {
    re: V,
    im: V,
}

impl<S: Simd> Vectors<S> {
    #[inline(always)]
    fn read(self, numbers: &Numbers) -> S::f64s {
        S::as_simd_f64s(numbers).0[self.k]
    }

    #[inline(always)]
    fn write(self, from: Complex<S::f64s>, to: &mut Lanes) {
        S::as_mut_simd_f64s(&mut to.re).0[self.k] = from.re;
        S::as_mut_simd_f64s(&mut to.im).0[self.k] = from.im;
    }

    #[inline(always)]
    fn add(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.simd.add_f64s(a, b)
    }

    #[inline(always)]
    fn sub(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.simd.sub_f64s(a, b)
    }

    #[inline(always)]
    fn mul(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.simd.mul_f64s(a, b)
    }

    /// Products z p of two numbers with their derivatives.
    #[inline(always)]
    fn scaled(self, [z, d_z]: [Complex<S::f64s>; 2], [p, d_p]: [Complex<S::f64s>; 2]) -> [Complex<S::f64s>; 2] {
        [self.times(z, p), self.plus(self.times(d_z, p), self.times(z, d_p))]
    }

    #[inline(always)]
    fn plus(self, a: Complex<S::f64s>, b: Complex<S::f64s>) -> Complex<S::f64s> {
        Complex {
            re: self.simd.add_f64s(a.re, b.re),
            im: self.simd.add_f64s(a.im, b.im),
        }
    }

    // Products are rounded before they are added, as those of plain numbers.
    #[inline(always)]
    fn times(self, a: Complex<S::f64s>, b: Complex<S::f64s>) -> Complex<S::f64s> {
        let simd = self.simd;
        Complex {
            re: simd.sub_f64s(simd.mul_f64s(a.re, b.re), simd.mul_f64s(a.im, b.im)),
            im: simd.add_f64s(simd.mul_f64s(a.re, b.im), simd.mul_f64s(a.im, b.re)),
        }
    }

    /// Product of a complex number with i·x.
    #[inline(always)]
    fn times_imaginary(self, a: Complex<S::f64s>, x: S::f64s) -> Complex<S::f64s> {
        Complex {
            re: self.simd.neg_f64s(self.simd.mul_f64s(a.im, x)),
            im: self.simd.mul_f64s(a.re, x),
        }
    }

    #[inline(always)]
    fn square(self, a: Complex<S::f64s>) -> S::f64s {
        let simd = self.simd;
        simd.add_f64s(simd.mul_f64s(a.re, a.re), simd.mul_f64s(a.im, a.im))
    }

    /// Computes the tables and their slopes; `false` where a denominator is small or a number is not finite.
    #[inline(always)]
    fn evaluate(self, group: &Group, omega: f64, tables: &mut [[Lanes; LANE_ENTRIES]; 2]) -> bool {
        let simd = self.simd;
        let (zero, one) = (simd.splat_f64s(0.0), simd.splat_f64s(1.0));
        let none = Complex { re: zero, im: zero };
        let (number, alpha, beta) = (
            self.read(&group.number),
            self.read(&group.alpha),
            self.read(&group.beta),
        );
        let nu = self.mul(number, simd.splat_f64s(omega));
        // c = i·of_damping, s = ν² − iνα
        let of_damping = self.add(self.mul(nu, beta), self.read(&group.loss_factor));
        let d_of_damping = self.mul(number, beta);
        let square = self.mul(nu, nu);
        let s = Complex {
            re: square,
            im: simd.neg_f64s(self.mul(nu, alpha)),
        };
        let d_s = Complex {
            re: self.mul(number, self.mul(simd.splat_f64s(2.0), nu)),
            im: simd.neg_f64s(self.mul(number, alpha)),
        };
        let (mut sums, mut d_sums, mut least) = ([none; LANE_ENTRIES], [none; LANE_ENTRIES], one);
        let is_forced = self.k * (size_of::<S::f64s>() / size_of::<f64>()) < group.forced;
        let entries = if is_forced { LANE_ENTRIES } else { LANE_ENTRIES / 2 };
        for mode in &group.modes {
            let value = self.read(&mode.value);
            let d = Complex {
                re: self.sub(one, self.mul(s.re, value)),
                im: self.sub(of_damping, self.mul(s.im, value)),
            };
            let squared = self.square(d);
            let size = self.mul(
                simd.splat_f64s(NEAR_RESONANCE),
                self.add(one, self.mul(square, simd.abs_f64s(value))),
            );
            least = simd.min_f64s(least, self.sub(squared, self.mul(size, size)));
            let reciprocal = simd.div_f64s(one, squared);
            let inverse = Complex {
                re: self.mul(d.re, reciprocal),
                im: simd.neg_f64s(self.mul(d.im, reciprocal)),
            };
            let change = Complex {
                re: self.mul(d_s.re, value),
                im: self.sub(self.mul(d_s.im, value), d_of_damping),
            };
            let slope = self.times(change, self.times(inverse, inverse));
            for ((sum, d_sum), product) in sums.iter_mut().zip(&mut d_sums).zip(&mode.products[..entries]) {
                let product = Complex {
                    re: self.read(&product.re),
                    im: self.read(&product.im),
                };
                *sum = self.plus(*sum, self.times(product, inverse));
                *d_sum = self.plus(*d_sum, self.times(product, slope));
            }
        }
        // The low-rank term, whose coefficient e is imaginary.
        let stiffness = self.read(&group.stiffness);
        let e = self.sub(self.mul(of_damping, stiffness), self.read(&group.imaginary));
        let d_e = self.mul(d_of_damping, stiffness);
        let ([own, to, from, direct], [d_own, d_to, d_from, d_direct]) = (sums, d_sums);
        let along = self.times_imaginary(own, e);
        let rest = Complex {
            re: self.sub(one, along.re),
            im: self.sub(zero, along.im),
        };
        let squared = self.square(rest);
        let p = Complex {
            re: simd.div_f64s(rest.re, squared),
            im: simd.div_f64s(simd.neg_f64s(rest.im), squared),
        };
        let d_along = self.plus(self.times_imaginary(d_own, e), self.times_imaginary(own, d_e));
        let d_p = self.times(self.times(p, p), d_along);
        let mut found = [
            self.scaled([own, d_own], [p, d_p]),
            self.scaled([to, d_to], [p, d_p]),
            [none; 2],
            [none; 2],
        ];
        if is_forced {
            let e_p = self.times_imaginary(p, e);
            let force = self.times(e_p, from);
            let d_e_p = self.plus(self.times_imaginary(p, d_e), self.times_imaginary(d_p, e));
            let d_force = self.plus(self.times(d_e_p, from), self.times(e_p, d_from));
            let d_to_force = self.plus(self.plus(d_direct, self.times(d_to, force)), self.times(to, d_force));
            found[2] = self.scaled([from, d_from], [p, d_p]);
            found[3] = [self.plus(direct, self.times(to, force)), d_to_force];
        }
        // Any number that is not finite makes a sum of zeros that is not 0.
        let mut zeros = zero;
        let [values, slopes] = tables;
        for ((value, slope), found) in values.iter_mut().zip(slopes).zip(found) {
            for (to, from) in [value, slope].into_iter().zip(found) {
                zeros = self.add(zeros, self.add(self.mul(zero, from.re), self.mul(zero, from.im)));
                self.write(from, to);
            }
        }
        let mut checks = [[0.0; HARMONIC_LANES]; 2];
        for (check, vector) in checks.iter_mut().zip([zeros, least]) {
            S::as_mut_simd_f64s(check).0[self.k] = vector;
        }
        let lanes = size_of::<S::f64s>() / size_of::<f64>();
        let lanes = self.k * lanes..(self.k + 1) * lanes;
        checks[0][lanes.clone()].iter().all(|x| *x == 0.0) && checks[1][lanes].iter().all(|x| *x > 0.0)
    }
}

impl Lanes {
    const ZERO: Self = Self {
        re: [0.0; HARMONIC_LANES],
        im: [0.0; HARMONIC_LANES],
    };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::condense::Condensed;
    use crate::condense::by_modes::modal_rows::ModalRows;
    use crate::condense::by_modes::modal_table::ModalWork;
    use crate::condense::by_modes::wave_cache::SharedWaves;
    use crate::condense::test_chains::{DAMPED, structure};
    use crate::contact::Contact;
    use crate::interrupt::Interrupt;
    use crate::options::SolverOptions;
    use std::sync::Arc;

    /// Tables from modes of a chain with one contact, one for each carried harmonic.
    fn tables(sectors: usize, damping: (f64, f64), loss_factor: f64, harmonics: usize) -> Vec<Option<ModalTable>> {
        let mut model = structure(sectors, damping);
        model.add_contact(&Contact::jenkins(1, Some(4), 9.0, 0.3, 1.0)).unwrap();
        model.set_loss_factor(loss_factor).unwrap();
        let options = SolverOptions {
            harmonics,
            ..SolverOptions::default()
        };
        let condensed = Condensed::with_reference(&model, &options, (0.3, 2.0), None, &Interrupt::none()).unwrap();
        let condensed = SharedWaves::default()
            .attach(&model, condensed, &Interrupt::none())
            .unwrap();
        let table = |i: usize| {
            let source = condensed.blocks()[i].source.clone()?;
            let rows = ModalRows::new((&condensed, i, 8), source).ok()?;
            ModalTable::new((&condensed, i), Arc::new(rows), 0.0).ok()
        };
        (0..condensed.blocks().len()).map(table).collect()
    }

    #[test]
    fn all_harmonics_at_once_are_those_one_after_the_other() {
        let mut compared = 0;
        for sectors in [1, 24] {
            for (damping, loss_factor) in DAMPED {
                for harmonics in [1, 5, 9, 17] {
                    let mut single = tables(sectors, damping, loss_factor, harmonics);
                    let lanes = SingleContactLanes::new(&single).unwrap().unwrap();
                    let mut work = ModalWork::default();
                    let make = || (0..single.len()).map(|_| Table::new(1).unwrap()).collect::<Vec<_>>();
                    let (mut found, mut expected) = (make(), make());
                    for k in 0..40 {
                        let omega = 0.11 + 0.237 * f64::from(k);
                        let each = single.iter_mut().zip(&mut expected);
                        let clear = each.fold(true, |clear, (table, to)| {
                            let table = table.as_mut().unwrap();
                            clear
                                & table
                                    .evaluate((omega, true), &mut work, to, &Interrupt::none())
                                    .unwrap()
                        });
                        assert_eq!(lanes.evaluate(omega, &mut found), clear);
                        for (a, b) in found.iter().zip(&expected).filter(|_| clear) {
                            assert_eq!(a.value, b.value);
                            assert_eq!(a.slope, b.slope);
                            compared += 1;
                        }
                    }
                }
            }
        }
        assert!(compared > 1000, "{compared}");
    }

    #[test]
    fn near_a_resonance_and_where_numbers_overflow_nothing_is_told() {
        let single = tables(1, (0.0, 1e-7), 0.0, 3);
        let lanes = SingleContactLanes::new(&single).unwrap().unwrap();
        let part = single[0].as_ref().and_then(ModalTable::single).unwrap();
        let value = part.contact.modes().last().unwrap().value;
        let resonance = value.sqrt().recip() / part.number;
        let mut found: Vec<_> = (0..single.len()).map(|_| Table::new(1).unwrap()).collect();
        assert!(!lanes.evaluate(resonance, &mut found));
        assert!(!lanes.evaluate(f64::NAN, &mut found));
        assert!(!lanes.evaluate(f64::INFINITY, &mut found));
        assert!(lanes.evaluate(1.01 * resonance, &mut found));
    }
}
