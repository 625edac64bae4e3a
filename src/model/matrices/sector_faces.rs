//! A sector as a finite-element program writes it: a left and a right face, whose nodes are images of each other.
//!
//! The right face of sector s is the left one of sector s + 1. In a frame that turns with the sector, of unit vectors
//! along radius, circumference and axis, both move alike; in a Cartesian frame u_right = R u_left, where R turns by
//! 2π/N about the axis.

use crate::error::{Result, fail, try_copy, try_push};
use crate::model::matrices::face_coordinates::check_coordinates;
use crate::model::matrices::part_of_turn::lag;
use core::fmt;
use num_complex::Complex64;

pub use crate::model::matrices::face_coordinates::Positions;

const CONTEXT: &str = "the faces of the sector";

/// Frame of the degrees of freedom on the faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SectorFrame {
    /// Axes x, y and z at each node, equal on both faces.
    Cartesian,
    /// Axes along radius, circumference and axis at each node, or any other frame that turns with the sector.
    Cylindrical,
}

/// Description of a sector by its faces.
#[derive(Clone, Copy, Debug)]
pub struct SectorDescription<'a> {
    /// Number of degrees of freedom of the sector with both faces.
    pub ndof: usize,
    /// Number of sectors N, at least 2.
    pub sectors: usize,
    /// Engine order of the wave; its sign is the sense of the wave.
    pub engine_order: i64,
    /// Number of degrees of freedom of a node pair: 3 (x, y, z) or 6 (and the rotations) in a Cartesian frame, any
    /// number in a cylindrical one.
    pub components: usize,
    /// Degrees of freedom of the left face, node after node; `None` where a component is missing.
    pub left: &'a [Option<usize>],
    /// Degrees of freedom of the right face, in the order of `left`.
    pub right: &'a [Option<usize>],
    /// Degrees of freedom that do not move.
    pub fixed: &'a [usize],
    /// Frame of the degrees of freedom.
    pub frame: SectorFrame,
    /// Axis of the wheel, of any length; it passes through the origin.
    pub axis: [f64; 3],
    /// Whether sector s + 1 follows sector s by +2π/N about the axis; else by −2π/N.
    pub forward: bool,
    /// Cartesian positions of the nodes of the left and the right face, which are then checked.
    pub coordinates: Option<(Positions<'a>, Positions<'a>)>,
}

/// Position of a degree of freedom in a sector.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Place {
    /// Inside of the sector, or on the left face.
    Interior,
    /// On the right face, by its row (node) and component.
    Right { row: usize, component: usize },
}

/// Three components of a node that turn as a vector.
type Vector = [Option<usize>; 3];

/// The faces of a sector after checks.
#[derive(Debug)]
pub(crate) struct Faces {
    pub(crate) left: Vec<Option<usize>>,
    pub(crate) right: Vec<Option<usize>>,
    pub(crate) components: usize,
    pub(crate) frame: SectorFrame,
    pub(crate) axis: [f64; 3],
    pub(crate) forward: bool,
    pub(crate) sectors: usize,
    /// Rotation by 2π/N about the axis.
    turn: [[f64; 3]; 3],
    /// Pairs (degree of freedom, entry of a face), ascending.
    sorted: Vec<(usize, usize)>,
    /// Whether each node of the faces has `components` consecutive degrees of freedom, beginning with a multiple of
    /// their number.
    regular: bool,
}

impl Faces {
    /// Checks the faces of a sector.
    ///
    /// # Errors
    /// `Dimension`, `Index`, `NotFinite` or `Argument`, naming the pair and the degree of freedom.
    pub fn new(sector: &SectorDescription<'_>) -> Result<Self> {
        Self::about(sector, unit(sector.axis)?)
    }

    /// Checks the faces of a sector, with the unit vector `axis` in place of the axis of the description.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(crate) fn about(sector: &SectorDescription<'_>, axis: [f64; 3]) -> Result<Self> {
        let c = sector.components;
        if sector.sectors < 2 {
            return fail!(Argument, "sectors = {}, needs at least 2", sector.sectors);
        }
        if c == 0 || (sector.frame == SectorFrame::Cartesian && c != 3 && c != 6) {
            return fail!(
                Dimension,
                "{c} components per node, needs 3 (x, y, z) or 6 (and the rotations) in a Cartesian frame, at least 1 in a cylindrical one"
            );
        }
        let (left, right) = (sector.left.len(), sector.right.len());
        if left != right {
            return fail!(
                Dimension,
                "the left face has {left} degrees of freedom, the right one {right}: needs pairs"
            );
        }
        if left == 0 || left % c != 0 {
            return fail!(
                Dimension,
                "a face has {left} entries, needs a multiple of its {c} components per node, at least 1 node"
            );
        }
        let mut faces = Self {
            left: try_copy(sector.left, CONTEXT)?,
            right: try_copy(sector.right, CONTEXT)?,
            components: c,
            frame: sector.frame,
            axis,
            forward: sector.forward,
            sectors: sector.sectors,
            turn: rotation(axis, sector.forward, 1, sector.sectors),
            sorted: Vec::new(),
            regular: false,
        };
        faces.sort(sector.ndof)?;
        faces.regular = faces.is_regular();
        if let Some((left, right)) = sector.coordinates {
            check_coordinates(left, right, faces.pairs(), axis, sector.forward, sector.sectors)?;
        }
        Ok(faces)
    }

    /// A copy that returns an error if memory is short.
    pub fn try_clone(&self) -> Result<Self> {
        Ok(Self {
            left: try_copy(&self.left, CONTEXT)?,
            right: try_copy(&self.right, CONTEXT)?,
            sorted: try_copy(&self.sorted, CONTEXT)?,
            ..*self
        })
    }

    fn pairs(&self) -> usize {
        self.left.len() / self.components
    }

    /// Sorts the degrees of freedom of both faces and refuses one that is named twice.
    fn sort(&mut self, ndof: usize) -> Result<()> {
        for (name, face, shift) in [("left", &self.left, 0), ("right", &self.right, self.left.len())] {
            for (i, dof) in face.iter().enumerate() {
                let Some(dof) = *dof else { continue };
                if dof >= ndof {
                    return fail!(Index, "{name}[{i}] = {dof}, needs 0 .. {} or -1", ndof - 1);
                }
                try_push(&mut self.sorted, (dof, i + shift), CONTEXT)?;
            }
        }
        self.sorted.sort_unstable();
        match self.sorted.windows(2).find(|two| two[0].0 == two[1].0) {
            None => Ok(()),
            Some(two) => {
                let ((name, i), (other, j)) = (self.entry(two[0].1), self.entry(two[1].1));
                let (dof, c) = (two[0].0, self.components);
                if name == other {
                    return fail!(
                        Argument,
                        "degree of freedom {dof} is twice in the {name} face, in pairs {} and {}",
                        i / c,
                        j / c
                    );
                }
                fail!(
                    Argument,
                    "degree of freedom {dof} is in both faces, in pair {} of the left and pair {} of the right one; a node on the axis cannot be paired",
                    i / c,
                    j / c
                )
            }
        }
    }

    /// Name of the face to which an entry belongs, and the position of the entry on this face.
    fn entry(&self, at: usize) -> (&'static str, usize) {
        match at.checked_sub(self.left.len()) {
            None => ("left", at),
            Some(at) => ("right", at),
        }
    }

    /// Whether each node has consecutive degrees of freedom, beginning with a multiple of their number.
    fn is_regular(&self) -> bool {
        let c = self.components;
        let mut complete = false;
        let regular = self.left.chunks_exact(c).chain(self.right.chunks_exact(c)).all(|node| {
            complete |= node.iter().all(Option::is_some);
            let mut numbers = node
                .iter()
                .enumerate()
                .filter_map(|(k, dof)| dof.map(|dof| (dof / c, dof % c == k)));
            let first = numbers.next();
            first.is_none_or(|(number, fits)| fits && numbers.all(|other| other == (number, true)))
        });
        regular && complete
    }

    /// Marks the degrees of freedom of the right face.
    pub fn places(&self, place: &mut [Place]) {
        for (i, dof) in self.right.iter().enumerate() {
            if let Some(dof) = *dof {
                place[dof] = Place::Right {
                    row: i / self.components,
                    component: i % self.components,
                };
            }
        }
    }

    /// Image of a degree of freedom on the right face: degrees of freedom on the left face, with coefficients.
    pub fn image(&self, row: usize, component: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let first = row * self.components;
        let turned = self.frame == SectorFrame::Cartesian;
        let (group, k) = (component / 3 * 3, component % 3);
        let terms = (0..3).map(move |j| match (turned, j) {
            (true, j) => (self.left[first + group + j], self.turn[k][j]),
            (false, 0) => (self.left[first + component], 1.0),
            (false, _) => (None, 0.0),
        });
        terms.filter_map(|(dof, c)| dof.filter(|_| c != 0.0).map(|dof| (dof, c)))
    }

    /// Refuses pairs of which only one side is fixed. A missing component counts as fixed.
    pub fn check_fixed(&self, fixed: &[bool]) -> Result<()> {
        let still = |dof: Option<usize>| dof.is_none_or(|dof| fixed[dof]);
        let side = |dof| Side { dof, fixed: still(dof) };
        for (i, (&left, &right)) in self.left.iter().zip(&self.right).enumerate() {
            let (pair, component) = (i / self.components, i % self.components);
            if still(left) != still(right) {
                return fail!(
                    Argument,
                    "pair {pair} is fixed on one side only: component {component} is {} on the left and {} on the right",
                    side(left),
                    side(right)
                );
            }
            if self.frame == SectorFrame::Cylindrical || !still(right) {
                continue;
            }
            // A direction that is fixed on the right must be one that is fixed on the left.
            let (group, k) = (component / 3 * 3, component % 3);
            for j in 0..3 {
                let turned = self.left[pair * self.components + group + j];
                if self.turn[k][j] != 0.0 && !still(turned) {
                    return fail!(
                        Argument,
                        "pair {pair} is fixed along component {component} on both sides, but the axes of the next sector are turned: fix component {} too, or use a cylindrical frame",
                        group + j
                    );
                }
            }
        }
        Ok(())
    }

    /// Whether two degrees of freedom belong to the left and the right node of one pair; returns the pair.
    pub fn is_own_image(&self, a: usize, b: usize) -> Option<usize> {
        let (a, b) = (self.find(a)?, self.find(b)?);
        let n = self.left.len();
        let whole = if self.frame == SectorFrame::Cartesian {
            self.components
        } else {
            1
        };
        ((a < n) != (b < n) && a % n / whole == b % n / whole).then_some(a % n / self.components)
    }

    fn find(&self, dof: usize) -> Option<usize> {
        let at = self.sorted.binary_search_by_key(&dof, |&(dof, _)| dof).ok()?;
        Some(self.sorted[at].1)
    }

    /// Rotation of the axes of the sector at `offset`; `None` where the axes are not turned, or turn with the sector.
    pub fn turn_of(&self, offset: i64) -> Option<[[f64; 3]; 3]> {
        let residue = i128::from(offset).rem_euclid(self.sectors as i128) as usize;
        (residue != 0 && self.frame == SectorFrame::Cartesian)
            .then(|| rotation(self.axis, self.forward, residue, self.sectors))
    }

    /// Angle between sectors, degrees.
    pub fn angle(&self) -> f64 {
        360.0 / self.sectors as f64
    }

    /// The vector of components to which a degree of freedom belongs, and its position in this vector: from the
    /// faces, from the numbering, or from `given`, the x, y and z of a contact.
    pub fn vector_of(&self, dof: usize, ndof: usize, given: Option<(Vector, usize)>) -> Option<(Vector, usize)> {
        let c = self.components;
        if let Some(at) = self.find(dof) {
            let (name, i) = self.entry(at);
            let face = if name == "left" { &self.left } else { &self.right };
            let first = i / 3 * 3;
            return Some(([face[first], face[first + 1], face[first + 2]], i % 3));
        }
        if given.is_some() {
            return given;
        }
        let first = dof / c * c + dof % c / 3 * 3;
        (self.regular && first + 2 < ndof).then(|| ([Some(first), Some(first + 1), Some(first + 2)], dof % c % 3))
    }
}

/// One side of a pair, to be printed in a sentence.
struct Side {
    dof: Option<usize>,
    fixed: bool,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.dof {
            None => f.write_str("missing (-1)"),
            Some(dof) if self.fixed => write!(f, "degree of freedom {dof}, which is fixed,"),
            Some(dof) => write!(f, "degree of freedom {dof}"),
        }
    }
}

/// The axis scaled to length 1.
fn unit(axis: [f64; 3]) -> Result<[f64; 3]> {
    if let Some(i) = axis.iter().position(|x| !x.is_finite()) {
        return fail!(NotFinite, "axis[{i}] = {}, needs a finite number", axis[i]);
    }
    let largest = axis.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if largest == 0.0 {
        return fail!(Argument, "axis is zero, needs a direction");
    }
    let scaled = axis.map(|x| x / largest);
    let length = scaled.iter().map(|x| x * x).sum::<f64>().sqrt();
    Ok(scaled.map(|x| x / length))
}

/// Rotation by `parts` sectors about the unit vector a: cos φ + sin φ [a]× + (1 − cos φ) a aᵀ, exact at quarter turns.
fn rotation(a: [f64; 3], forward: bool, parts: usize, sectors: usize) -> [[f64; 3]; 3] {
    let Complex64 { re: cos, im } = lag(parts % sectors, sectors);
    let sin = if forward { -im } else { im };
    let mut turn = [[0.0; 3]; 3];
    for (i, row) in turn.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            let cross = match (3 + j - i) % 3 {
                0 => 0.0,
                1 => -a[3 - i - j],
                _ => a[3 - i - j],
            };
            let own = if i == j { cos } else { 0.0 };
            *entry = own + sin * cross + (1.0 - cos) * a[i] * a[j];
        }
    }
    turn
}
