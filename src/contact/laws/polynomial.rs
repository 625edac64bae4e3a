//! Polynomial springs and dampers of one or more directions: fᵢ = Σ c·Π uⱼᵖ·Π vⱼ^q.
//!
//! A polynomial of degree P in motions of H harmonics has harmonics up to P·H, and its tangents up
//! to (P − 1)·H. With N > (P + 1)·H equidistant samples none of them is mistaken for one of the
//! force (up to H) or of the tangents (up to 2·H) that are needed: harmonic balance is exact. See
//! Krack & Gross, Harmonic Balance for Nonlinear Vibration Problems (2019),
//! doi:10.1007/978-3-030-14023-6, on polynomial forces.

mod polynomial_terms;

use crate::byte_stream::{ByteReader, ByteWriter};
use crate::contact::forms::constants::LawData;
use crate::contact::forms::law::{ContactLaw, Form, Law, LawInTime, Memoryless};
use crate::contact::forms::linearisation::{LINEARISATION_SMALL, Range};
use crate::contact::forms::samples::Samples;
use crate::contact::laws::polynomial::polynomial_terms::{Collector, Factor, Term, Terms, check, power};
use crate::error::{Result, fail, try_push};
use std::sync::Arc;

pub use crate::contact::laws::polynomial::polynomial_terms::{HIGHEST_EXPONENT, Monomial};

/// A polynomial law. Copies share the terms.
#[derive(Clone, Debug)]
pub struct Polynomial {
    directions: usize,
    content: Arc<Terms>,
    length: f64,
}

impl Polynomial {
    /// Number of the law in saved models.
    /// Kind: fixed.
    pub(super) const POLYNOMIAL_NUMBER: u8 = 7;

    /// The sum of monomials in `directions` relative motions. Terms of equal powers are merged, and
    /// those that vanish left out.
    ///
    /// # Errors
    /// `Argument`, `Index`, `Dimension` or `NotFinite`, naming the monomial by its place, and
    /// `OutOfMemory`.
    pub fn new(directions: usize, monomials: &[Monomial<'_>]) -> Result<Self> {
        let mut collector = Collector::new(directions)?;
        for (place, monomial) in monomials.iter().enumerate() {
            check(directions, monomial).map_err(|e| e.at(format_args!("monomial {place}")))?;
            collector.powers.clear();
            let (x, v) = (monomial.displacements, monomial.velocities);
            let variables = x.iter().enumerate();
            let variables = variables.chain(v.iter().enumerate().map(|(j, power)| (directions + j, power)));
            for (variable, &power) in variables.filter(|(_, power)| **power > 0) {
                try_push(&mut collector.powers, Factor { variable, power }, "a polynomial")?;
            }
            collector.add(monomial.direction, monomial.coefficient)?;
        }
        Self::of(collector)
    }

    /// Spring and damper of one motion: f = Σ spring\[k\]·y^(k+1) + Σ damper\[k\]·v^(k+1).
    ///
    /// # Errors
    /// Those of [`Self::new`], the monomials counted through springs, then dampers.
    pub fn scalar(spring: &[f64], damper: &[f64]) -> Result<Self> {
        let mut collector = Collector::new(1)?;
        for (name, variable, coefficients) in [("spring", 0, spring), ("damper", 1, damper)] {
            if coefficients.len() > HIGHEST_EXPONENT as usize {
                return fail!(
                    Argument,
                    "{name} has powers up to {}, needs at most {HIGHEST_EXPONENT}",
                    coefficients.len()
                );
            }
            for (k, &coefficient) in coefficients.iter().enumerate() {
                if !coefficient.is_finite() {
                    return fail!(NotFinite, "{name}[{k}] is {coefficient}, needs a finite number");
                }
                collector.powers.clear();
                let power = k as u32 + 1;
                try_push(&mut collector.powers, Factor { variable, power }, "a polynomial")?;
                collector.add(0, coefficient)?;
            }
        }
        Self::of(collector)
    }

    /// Stiffness tensors of `directions` = d motions: fᵢ = Σ K1ᵢⱼ xⱼ + Σ K2ᵢⱼₖ xⱼ xₖ + Σ K3ᵢⱼₖₗ xⱼ xₖ xₗ.
    /// Each is dense, the last index running fastest, or empty for none; nothing is taken for
    /// symmetric.
    ///
    /// # Errors
    /// `Dimension` or `NotFinite`, naming the tensor and the entry; `OutOfMemory`.
    pub fn tensors(directions: usize, linear: &[f64], quadratic: &[f64], cubic: &[f64]) -> Result<Self> {
        let mut collector = Collector::new(directions)?;
        for (name, rank, tensor) in [("linear", 2, linear), ("quadratic", 3, quadratic), ("cubic", 4, cubic)] {
            let needed = directions.checked_pow(rank);
            if !tensor.is_empty() && needed != Some(tensor.len()) {
                return fail!(
                    Dimension,
                    "the {name} stiffness has {} entries, needs {directions}^{rank}",
                    tensor.len()
                );
            }
            for (entry, &coefficient) in tensor.iter().enumerate() {
                if coefficient == 0.0 {
                    continue;
                }
                // Digits of the entry's number to the base d, the last index first.
                let digit = |place: u32| entry / directions.pow(place) % directions;
                if !coefficient.is_finite() {
                    return fail!(
                        NotFinite,
                        "{name} stiffness: entry {entry} (row {}) is {coefficient}, needs a finite number",
                        digit(rank - 1)
                    );
                }
                collector.powers.clear();
                for place in 0..rank - 1 {
                    let variable = digit(place);
                    match collector.powers.iter_mut().find(|f| f.variable == variable) {
                        Some(factor) => factor.power += 1,
                        None => try_push(&mut collector.powers, Factor { variable, power: 1 }, "a polynomial")?,
                    }
                }
                // The permutations of an entry's indices are one monomial.
                collector.powers.sort_unstable();
                collector.add(digit(rank - 1), coefficient)?;
            }
        }
        Self::of(collector)
    }

    fn of(collector: Collector) -> Result<Self> {
        Ok(Self {
            directions: collector.directions(),
            content: Arc::new(collector.finish()?),
            length: 1.0,
        })
    }

    /// Reads a polynomial.
    ///
    /// # Errors
    /// `Argument` for bytes that are none; `OutOfMemory`.
    pub(crate) fn load_from(input: &mut ByteReader<'_>) -> Result<Self> {
        let length = input.finite()?;
        let directions = input.count()?;
        let mut collector = Collector::new(directions)?;
        for _ in 0..input.entries(24)? {
            let (direction, coefficient) = (input.count()?, input.finite()?);
            collector.powers.clear();
            for _ in 0..input.entries(12)? {
                let (variable, power) = (input.count()?, input.u32()?);
                let follows = collector.powers.last().is_none_or(|last| last.variable < variable);
                if !follows || variable / 2 >= directions || !(1..=HIGHEST_EXPONENT).contains(&power) {
                    return Err(input.damaged("powers of a polynomial do not exist"));
                }
                try_push(&mut collector.powers, Factor { variable, power }, "a polynomial")?;
            }
            if collector.powers.is_empty() || direction >= directions {
                return Err(input.damaged("a term of a polynomial has no motion"));
            }
            collector.add(direction, coefficient)?;
        }
        if length <= 0.0 {
            return Err(input.damaged("a polynomial has no unit of length"));
        }
        Ok(Self {
            length,
            ..Self::of(collector)?
        })
    }

    /// The law in units of `length` of its present unit: x = length·x̂, f = length·f̂.
    #[must_use]
    pub fn in_units(&self, length: f64) -> Self {
        Self {
            length: self.length * length,
            ..self.clone()
        }
    }

    /// Highest degree of a term, 0 without any.
    #[must_use]
    pub fn degree(&self) -> u32 {
        self.content.terms.iter().map(|t| t.degree).max().unwrap_or(0)
    }

    /// Linear stiffness of the force i by the motion j.
    #[must_use]
    pub fn linear_stiffness(&self, i: usize, j: usize) -> f64 {
        let linear = |t: &&Term| t.degree == 1 && t.direction == i && self.content.factors[t.first].variable == j;
        self.content.terms.iter().find(linear).map_or(0.0, |t| t.coefficient)
    }
}

impl LawData for Polynomial {
    fn number(&self) -> u8 {
        Self::POLYNOMIAL_NUMBER
    }

    fn save_to(&self, out: &mut ByteWriter<'_>) -> Result<()> {
        out.f64(self.length);
        out.count(self.directions);
        out.count(self.content.terms.len());
        for term in &self.content.terms {
            out.count(term.direction);
            out.f64(term.coefficient);
            out.count(term.count);
            for factor in &self.content.factors[term.first..term.first + term.count] {
                out.count(factor.variable);
                out.u32(factor.power);
            }
        }
        Ok(())
    }
}

impl ContactLaw for Polynomial {
    fn name(&self) -> &'static str {
        "polynomial"
    }

    fn motions(&self) -> Option<usize> {
        Some(self.directions)
    }

    fn stiffness_at_small_motion(&self, k: usize, l: usize) -> f64 {
        self.linear_stiffness(k, l)
    }

    fn stiffness(&self, _k: usize) -> f64 {
        0.0
    }

    fn is_per_area(&self) -> bool {
        false
    }

    fn law(&self, length: f64) -> Result<Arc<dyn Law>> {
        Ok(Arc::new(self.in_units(length)))
    }

    fn in_time(&self) -> Result<LawInTime> {
        Ok(LawInTime::smooth(self.law(1.0)?))
    }
}

impl Law for Polynomial {
    fn directions(&self) -> usize {
        self.directions
    }

    fn is_odd(&self) -> bool {
        self.content.terms.iter().all(|t| t.degree % 2 == 1)
    }

    fn form(&self) -> Form<'_> {
        Form::Memoryless(self)
    }

    /// From this scale on every term of higher degree is small.
    fn linearisation_scale(&self, ranges: &[Range], reference: f64) -> f64 {
        let size = |variable: usize| match variable.checked_sub(self.directions) {
            None => ranges[variable].size(),
            Some(j) => ranges[j].speed,
        };
        let largest = ranges.iter().fold(0.0_f64, |m, r| m.max(r.size()));
        let mut factor = 0.0_f64;
        for term in self.content.terms.iter().filter(|t| t.degree > 1) {
            let factors = &self.content.factors[term.first..term.first + term.count];
            let whole = term.coefficient.abs() * power(self.length, term.degree - 1);
            let force = factors.iter().fold(whole, |p, f| p * power(size(f.variable), f.power));
            // c·(x/s)ⁿ against LINEARISATION_SMALL·reference·x/s
            let share = force / (LINEARISATION_SMALL * reference * largest);
            if share > 0.0 {
                factor = factor.max(share.powf(1.0 / f64::from(term.degree - 1)));
            }
        }
        factor
    }
}

impl Memoryless for Polynomial {
    fn uses_velocity(&self) -> bool {
        self.content.factors.iter().any(|f| f.variable >= self.directions)
    }

    fn is_alias_free(&self) -> bool {
        true
    }

    /// (P + 1)·H + 1, whatever is requested; at least the 2·H + 1 of a law, if no term is left.
    fn samples(&self, highest: usize, _requested: usize) -> usize {
        (self.degree().max(1) as usize + 1)
            .saturating_mul(highest)
            .saturating_add(1)
    }

    fn evaluate(&self, _omega: f64, samples: usize, u: &[f64], v: &[f64], out: Samples<'_>) -> Result<()> {
        let d = self.directions;
        for term in &self.content.terms {
            let factors = &self.content.factors[term.first..term.first + term.count];
            let coefficient = term.coefficient * power(self.length, term.degree - 1);
            let i = term.direction;
            for j in 0..samples {
                let at = |f: Factor| {
                    if f.variable < d {
                        u[j * d + f.variable]
                    } else {
                        v[j * d + f.variable - d]
                    }
                };
                let row = (j * d + i) * d;
                if let [f] = *factors {
                    let x = at(f);
                    let below = coefficient * power(x, f.power - 1);
                    out.f[j * d + i] += below * x;
                    let slopes = if f.variable < d {
                        &mut *out.df_du
                    } else {
                        &mut *out.df_dv
                    };
                    slopes[row + f.variable % d] += f64::from(f.power) * below;
                    continue;
                }
                let mut whole = coefficient;
                for (k, f) in factors.iter().enumerate() {
                    // The others' powers by themselves, not by division: motions pass zero.
                    let x = at(*f);
                    let below = power(x, f.power - 1);
                    let others = factors[k + 1..].iter().fold(whole, |p, f| p * power(at(*f), f.power));
                    let slopes = if f.variable < d {
                        &mut *out.df_du
                    } else {
                        &mut *out.df_dv
                    };
                    slopes[row + f.variable % d] += f64::from(f.power) * below * others;
                    whole *= below * x;
                }
                out.f[j * d + i] += whole;
            }
        }
        Ok(())
    }
}
