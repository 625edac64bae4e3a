//! Degrees of freedom as the caller numbers them, and the independent ones that are solved for.
//!
//! A fixed degree of freedom does not move; one on the right face of a sector is the turned image of the left face of
//! the next sector. With the independent motion q_s of sector s, all degrees of freedom are u_s = T₀ q_s + T₁ q_{s+1};
//! a row of T₀ or T₁ is the image of a degree of freedom. In a whole wheel both are rows of one matrix: the images of the right
//! face of a sector are the left face of the next one, in the frame of the sector.

use crate::error::{Result, fail, try_copy, try_push, try_vec};
use crate::model::matrices::sector_faces::{Faces, Place};
use num_complex::Complex64;
use std::sync::Arc;

const CONTEXT: &str = "the map of the degrees of freedom";

/// The map from the caller's degrees of freedom to the independent ones. A copy shares its tables.
#[derive(Clone, Debug)]
pub struct DegreeMap {
    given: usize,
    /// Images of the degrees of freedom; `None`: all are independent.
    images: Option<Arc<Images>>,
}

/// Rows of T₀ and T₁, each with entries in one of them only.
#[derive(Debug)]
struct Images {
    /// Start of each row in `terms`; one more number than degrees of freedom.
    start: Vec<usize>,
    /// Terms of the rows: independent degree of freedom and coefficient.
    terms: Vec<(usize, f64)>,
    /// For each row, whether its entries lie in T₁.
    next: Vec<bool>,
    /// The caller's number of each independent degree of freedom.
    origin: Vec<usize>,
    fixed: Vec<bool>,
    faces: Option<Faces>,
    /// In a whole wheel, the number of degrees of freedom of each sector, to which the faces belong; else `None`.
    wheel: Option<usize>,
}

impl DegreeMap {
    /// Map of `given` degrees of freedom that are all independent.
    pub(crate) fn identity(given: usize) -> Self {
        Self { given, images: None }
    }

    /// Whether another map has the same independent degrees of freedom and the same images.
    pub fn is_same(&self, other: &Self) -> bool {
        self.given == other.given
            && match (&self.images, &other.images) {
                (None, None) => true,
                (Some(a), Some(b)) => a.start == b.start && a.terms == b.terms && a.next == b.next,
                _ => false,
            }
    }

    /// The map with fixed degrees of freedom and, for a sector, its faces.
    ///
    /// # Errors
    /// `Argument` for a pair that is fixed on one side only, and where all are fixed; `OutOfMemory`.
    pub(crate) fn new(fixed: Vec<bool>, faces: Option<Faces>) -> Result<Self> {
        Self::with(fixed, faces, None)
    }

    /// Map of all sectors of a wheel, one after the other, each with `of_sector` degrees of freedom and these faces;
    /// further degrees of freedom may follow them.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(crate) fn of_wheel(fixed: Vec<bool>, faces: Faces, of_sector: usize) -> Result<Self> {
        Self::with(fixed, Some(faces), Some(of_sector))
    }

    fn with(fixed: Vec<bool>, faces: Option<Faces>, wheel: Option<usize>) -> Result<Self> {
        let given = fixed.len();
        let n = wheel.unwrap_or(given);
        let mut place = try_vec(given, Place::Interior, CONTEXT)?;
        if let Some(faces) = &faces {
            match wheel {
                None => faces.check_fixed(&fixed)?,
                Some(n) => check_wheel(faces, &fixed, n)?,
            }
            faces.places(&mut place[..n]);
        }
        // The last sector is followed by the first one.
        let sectors = faces
            .as_ref()
            .filter(|_| wheel.is_some())
            .map_or(1, |faces| faces.sectors);
        for s in 1..sectors {
            place.copy_within(..n, s * n);
        }
        let mut number = try_vec(given, usize::MAX, CONTEXT)?;
        let mut origin = Vec::new();
        for (dof, place) in place.iter().enumerate() {
            if !fixed[dof] && !matches!(place, Place::Right { .. }) {
                number[dof] = origin.len();
                try_push(&mut origin, dof, CONTEXT)?;
            }
        }
        if origin.is_empty() {
            return fail!(Argument, "all degrees of freedom are fixed: nothing can move");
        }
        let mut start = try_vec(1, 0, CONTEXT)?;
        let mut terms = Vec::new();
        let mut next = try_vec(given, false, CONTEXT)?;
        for (dof, place) in place.iter().enumerate() {
            if number[dof] != usize::MAX {
                try_push(&mut terms, (number[dof], 1.0), CONTEXT)?;
            } else if let (Place::Right { row, component }, Some(faces), false) = (place, &faces, fixed[dof]) {
                next[dof] = wheel.is_none();
                let first = if wheel.is_some() {
                    (dof / n + 1) % sectors * n
                } else {
                    0
                };
                for (left, coefficient) in faces.image(*row, *component) {
                    let left = first + left;
                    if number[left] != usize::MAX {
                        try_push(&mut terms, (number[left], coefficient), CONTEXT)?;
                    }
                }
            }
            try_push(&mut start, terms.len(), CONTEXT)?;
        }
        Ok(Self {
            given,
            images: Some(Arc::new(Images {
                start,
                terms,
                next,
                origin,
                fixed,
                faces,
                wheel,
            })),
        })
    }

    /// The map of a sector with faces, and with degrees of freedom that are fixed.
    ///
    /// # Errors
    /// As [`Self::fixing`].
    pub(crate) fn of_sector(given: usize, faces: Faces, fixed: &[usize]) -> Result<Self> {
        Self::new(marked(try_vec(given, false, CONTEXT)?, fixed)?, Some(faces))
    }

    /// A copy of this map with further degrees of freedom fixed.
    ///
    /// # Errors
    /// `Index`; `Argument` for a pair of the faces that is fixed on one side only, and where all are fixed.
    pub(crate) fn fixing(&self, dofs: &[usize]) -> Result<Self> {
        let (fixed, faces, wheel) = self.parts()?;
        Self::with(marked(fixed, dofs)?, faces, wheel)
    }

    /// Copies of the marks of fixed degrees of freedom and of the faces; and the number of degrees of freedom of a
    /// sector in a whole wheel.
    fn parts(&self) -> Result<(Vec<bool>, Option<Faces>, Option<usize>)> {
        let Some(images) = self.images.as_deref() else {
            return Ok((try_vec(self.given, false, CONTEXT)?, None, None));
        };
        let faces = images.faces.as_ref().map(Faces::try_clone).transpose()?;
        Ok((try_copy(&images.fixed, CONTEXT)?, faces, images.wheel))
    }

    /// A copy of this map with `count` further independent degrees of freedom after all others.
    pub(crate) fn extended(&self, count: usize) -> Result<Self> {
        let Some(images) = self.images.as_deref() else {
            return Ok(Self::identity(self.given + count));
        };
        let mut fixed = try_vec(self.given + count, false, CONTEXT)?;
        fixed[..self.given].copy_from_slice(&images.fixed);
        let faces = images.faces.as_ref().map(Faces::try_clone).transpose()?;
        Self::with(fixed, faces, images.wheel)
    }

    /// Map onto `order` new independent degrees of freedom. The first ones are the old ones listed in `held`; the
    /// images of all others are empty.
    pub(crate) fn retaining(&self, held: &[usize], order: usize) -> Result<Self> {
        let mut start = try_vec(1, 0, CONTEXT)?;
        let mut terms = Vec::new();
        let mut next = try_vec(self.given, false, CONTEXT)?;
        for (dof, next) in next.iter_mut().enumerate() {
            let (sector, image) = self.image(dof);
            *next = sector != 0;
            for (number, coefficient) in image {
                if let Ok(new) = held.binary_search(&number) {
                    try_push(&mut terms, (new, coefficient), CONTEXT)?;
                }
            }
            try_push(&mut start, terms.len(), CONTEXT)?;
        }
        let mut origin = try_vec(order, 0, CONTEXT)?;
        for (origin, &number) in origin.iter_mut().zip(held) {
            *origin = self.origin(number);
        }
        let (fixed, faces, wheel) = self.parts()?;
        Ok(Self {
            given: self.given,
            images: Some(Arc::new(Images {
                start,
                terms,
                next,
                origin,
                fixed,
                faces,
                wheel,
            })),
        })
    }

    /// Number of degrees of freedom as the caller numbers them.
    pub fn given(&self) -> usize {
        self.given
    }

    /// Number of independent degrees of freedom.
    pub fn independent(&self) -> usize {
        self.images.as_ref().map_or(self.given, |images| images.origin.len())
    }

    /// Whether every degree of freedom is independent.
    pub fn is_identity(&self) -> bool {
        self.images.is_none()
    }

    /// For each degree of freedom, whether it is fixed; `None` where all are independent.
    pub(crate) fn fixed(&self) -> Option<&[bool]> {
        self.images.as_ref().map(|images| &images.fixed[..])
    }

    /// The faces of a sector; `None` without faces.
    pub(crate) fn faces(&self) -> Option<&Faces> {
        let images = self.images.as_ref()?;
        images.faces.as_ref().filter(|_| images.wheel.is_none())
    }

    /// The faces of the sectors of a whole wheel, and the number of degrees of freedom of a sector.
    pub(crate) fn faces_of_wheel(&self) -> Option<(&Faces, usize)> {
        let images = self.images.as_ref()?;
        Some((images.faces.as_ref()?, images.wheel?))
    }

    /// Image of a degree of freedom: the sector of the independent ones that move it, counted from its own sector,
    /// and their indices and coefficients. Empty for a fixed one.
    pub fn image(&self, dof: usize) -> (i64, impl Iterator<Item = (usize, f64)> + '_) {
        let (sector, own, terms) = match self.images.as_deref() {
            None => (0, Some((dof, 1.0)), &[][..]),
            Some(images) => (
                i64::from(images.next[dof]),
                None,
                &images.terms[images.start[dof]..images.start[dof + 1]],
            ),
        };
        (sector, own.into_iter().chain(terms.iter().copied()))
    }

    /// Whether a degree of freedom does not move.
    pub fn is_fixed(&self, dof: usize) -> bool {
        self.images.as_ref().is_some_and(|images| images.fixed[dof])
    }

    /// Index of a degree of freedom among the independent ones; `None` if it is fixed or on the right face.
    pub fn number(&self, dof: usize) -> Option<usize> {
        match self.images.as_deref() {
            None => Some(dof),
            Some(images) if images.next[dof] || images.fixed[dof] => None,
            Some(images) => {
                let first = images.terms.get(images.start[dof]).map(|&(number, _)| number);
                first.filter(|&number| images.origin[number] == dof)
            }
        }
    }

    /// The caller's number of an independent degree of freedom.
    pub fn origin(&self, independent: usize) -> usize {
        match self.images.as_deref() {
            None => independent,
            Some(images) => images.origin[independent],
        }
    }

    /// Motion of all degrees of freedom, from that of the independent ones; the motion of the next sector is `next`
    /// times that of this one.
    pub fn expand(&self, next: Complex64, independent: &[Complex64], all: &mut [Complex64]) {
        let Some(images) = self.images.as_deref() else {
            all.copy_from_slice(independent);
            return;
        };
        for (dof, x) in all.iter_mut().enumerate() {
            let terms = &images.terms[images.start[dof]..images.start[dof + 1]];
            let motion: Complex64 = terms.iter().map(|&(j, c)| c * independent[j]).sum();
            *x = if images.next[dof] { next * motion } else { motion };
        }
    }

    /// Motion of all degrees of freedom in time, from the independent motions of this sector and of the next one.
    pub fn expand_in_time(&self, own: &[f64], next: &[f64], all: &mut [f64]) {
        let Some(images) = self.images.as_deref() else {
            all.copy_from_slice(own);
            return;
        };
        for (dof, x) in all.iter_mut().enumerate() {
            let terms = &images.terms[images.start[dof]..images.start[dof + 1]];
            let from = if images.next[dof] { next } else { own };
            *x = terms.iter().map(|&(j, c)| c * from[j]).sum();
        }
    }

    /// Motion of the independent degrees of freedom, taken from that of all; dependent ones are not read.
    pub fn restrict(&self, all: &[Complex64], independent: &mut [Complex64]) {
        for (j, x) in independent.iter_mut().enumerate() {
            *x = all[self.origin(j)];
        }
    }
}

/// Refuses a pair of nodes in a wheel (right face of a sector, left face of the next) of which only one side is
/// fixed.
fn check_wheel(faces: &Faces, fixed: &[bool], n: usize) -> Result<()> {
    for s in 0..faces.sectors {
        let mut sides = try_copy(&fixed[s * n..(s + 1) * n], CONTEXT)?;
        let next = (s + 1) % faces.sectors * n;
        for left in faces.left.iter().flatten() {
            sides[*left] = fixed[next + left];
        }
        faces
            .check_fixed(&sides)
            .map_err(|e| e.at(format_args!("sectors {s} and {}", (s + 1) % faces.sectors)))?;
    }
    Ok(())
}

/// Adds degrees of freedom to the marks of fixed ones.
fn marked(mut fixed: Vec<bool>, dofs: &[usize]) -> Result<Vec<bool>> {
    let n = fixed.len();
    for (i, &dof) in dofs.iter().enumerate() {
        match fixed.get_mut(dof) {
            Some(mark) => *mark = true,
            None => return fail!(Index, "fixed[{i}] = {dof}, needs 0 .. {}", n - 1),
        }
    }
    Ok(fixed)
}
