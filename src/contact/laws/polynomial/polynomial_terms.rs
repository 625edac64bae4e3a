//! Terms of a polynomial law: products of powers of motions and velocities, checked, merged and sorted.

use crate::error::{Result, fail, try_push};

/// Highest exponent of a single motion or velocity.
/// Kind: cap.
pub const HIGHEST_EXPONENT: u32 = 15;

/// One product of powers, as the caller gives it.
#[derive(Clone, Copy, Debug)]
pub struct Monomial<'a> {
    /// Direction i of the force that it belongs to.
    pub direction: usize,
    /// Its coefficient.
    pub coefficient: f64,
    /// Exponents of the d relative motions; empty for none.
    pub displacements: &'a [u32],
    /// Exponents of the d velocities; empty for none.
    pub velocities: &'a [u32],
}

/// A power of one variable: 0 .. d are the motions, d .. 2d the velocities.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Factor {
    pub(crate) variable: usize,
    pub(crate) power: u32,
}

/// A product of factors, stored one after the other for all terms.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Term {
    pub(crate) direction: usize,
    pub(crate) coefficient: f64,
    pub(crate) first: usize,
    pub(crate) count: usize,
    pub(crate) degree: u32,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Terms {
    pub(crate) terms: Vec<Term>,
    pub(crate) factors: Vec<Factor>,
}

/// xⁿ by repeated squaring.
pub(crate) fn power(x: f64, n: u32) -> f64 {
    match n {
        0 => 1.0,
        1 => x,
        2 => x * x,
        3 => x * x * x,
        n => {
            let half = power(x, n / 2);
            if n % 2 == 0 { half * half } else { half * half * x }
        }
    }
}

pub(crate) fn check(directions: usize, monomial: &Monomial<'_>) -> Result<()> {
    let (x, v) = (monomial.displacements, monomial.velocities);
    if monomial.direction >= directions {
        return fail!(
            Index,
            "direction = {}, needs one below {directions}",
            monomial.direction
        );
    }
    if !monomial.coefficient.is_finite() {
        return fail!(
            NotFinite,
            "coefficient = {}, needs a finite number",
            monomial.coefficient
        );
    }
    for (name, exponents) in [("displacements", x), ("velocities", v)] {
        if !exponents.is_empty() && exponents.len() != directions {
            return fail!(
                Dimension,
                "{} exponents of {name}, needs {directions} or none",
                exponents.len()
            );
        }
        if let Some((j, p)) = exponents.iter().enumerate().find(|(_, p)| **p > HIGHEST_EXPONENT) {
            return fail!(
                Argument,
                "exponent {j} of {name} = {p}, needs at most {HIGHEST_EXPONENT}"
            );
        }
    }
    if x.iter().chain(v).all(|p| *p == 0) {
        return fail!(
            Argument,
            "all exponents are 0; a constant force is an excitation in harmonic 0"
        );
    }
    Ok(())
}

/// Gathers terms while a polynomial is made.
pub(crate) struct Collector {
    directions: usize,
    content: Terms,
    /// Factors of the current term, by ascending variable.
    pub(crate) powers: Vec<Factor>,
}

impl Collector {
    pub(crate) fn new(directions: usize) -> Result<Self> {
        if directions == 0 {
            return fail!(Argument, "polynomial: directions = 0, needs at least 1");
        }
        Ok(Self {
            directions,
            content: Terms::default(),
            powers: Vec::new(),
        })
    }

    /// Relative motions d.
    pub(crate) fn directions(&self) -> usize {
        self.directions
    }

    /// Stores the current term.
    pub(crate) fn add(&mut self, direction: usize, coefficient: f64) -> Result<()> {
        let term = Term {
            direction,
            coefficient,
            first: self.content.factors.len(),
            count: self.powers.len(),
            degree: self.powers.iter().map(|f| f.power).sum(),
        };
        for &factor in &self.powers {
            try_push(&mut self.content.factors, factor, "a polynomial")?;
        }
        try_push(&mut self.content.terms, term, "a polynomial")
    }

    /// Merges terms of equal powers, in order, and leaves out those that vanish.
    pub(crate) fn finish(self) -> Result<Terms> {
        let Terms { mut terms, factors } = self.content;
        let of = |t: &Term| &factors[t.first..t.first + t.count];
        // In place: a stable sort would need memory. Equal terms keep their order by `first`.
        terms.sort_unstable_by(|a, b| {
            let key = (a.direction, a.degree).cmp(&(b.direction, b.degree));
            key.then_with(|| of(a).cmp(of(b))).then(a.first.cmp(&b.first))
        });
        terms.dedup_by(|next, kept| {
            let same = next.direction == kept.direction && of(next) == of(kept);
            if same {
                kept.coefficient += next.coefficient;
            }
            same
        });
        terms.retain(|t| t.coefficient != 0.0);
        if let Some(term) = terms.iter().find(|t| !t.coefficient.is_finite()) {
            return fail!(
                NotFinite,
                "polynomial: the terms of degree {} in direction {} add up to {}, needs a finite number",
                term.degree,
                term.direction,
                term.coefficient
            );
        }
        // The factors of the terms that are left, in their order.
        let mut content = Terms::default();
        for term in &terms {
            let first = content.factors.len();
            for &factor in of(term) {
                try_push(&mut content.factors, factor, "a polynomial")?;
            }
            try_push(&mut content.terms, Term { first, ..*term }, "a polynomial")?;
        }
        Ok(content)
    }
}
