//! Faces near a point or a box, by cells of a grid; and the nearest point of a face.

use crate::face_shapes::{Local, clamped, middle};
use crate::surface::Surface;
use crate::vectors::{Vector, dot, length, minus};
use std::collections::HashMap;

/// Steps of the search for the nearest point of a face.
const STEPS: usize = 30;

type Cell = [i64; 3];

/// Faces of a surface by the cells of a grid that their boxes touch.
pub(crate) struct FaceSearch<'a> {
    surface: &'a Surface,
    cell: f64,
    cells: HashMap<Cell, Vec<u32>>,
}

/// A point of a face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    pub face: usize,
    pub local: Local,
    pub distance: f64,
}

impl<'a> FaceSearch<'a> {
    /// A search for faces up to a distance.
    pub fn new(surface: &'a Surface, reach: f64) -> Self {
        let largest = (0..surface.faces.len()).map(|f| surface.size(f)).fold(0.0, f64::max);
        let mut search = Self {
            surface,
            cell: (largest + reach).max(f64::MIN_POSITIVE),
            cells: HashMap::new(),
        };
        for face in 0..surface.faces.len() {
            let [low, high] = surface.bounds(face);
            let (low, high) = (low.map(|x| x - reach), high.map(|x| x + reach));
            for cell in search.cells_of(low, high) {
                search.cells.entry(cell).or_default().push(face as u32);
            }
        }
        search
    }

    fn cells_of(&self, low: Vector, high: Vector) -> Vec<Cell> {
        let number = |x: f64| (x / self.cell).floor() as i64;
        let (low, high) = (low.map(number), high.map(number));
        let mut all = Vec::new();
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                all.extend((low[2]..=high[2]).map(|z| [x, y, z]));
            }
        }
        all
    }

    /// Faces whose boxes may touch a box, ascending.
    pub fn near(&self, [low, high]: [Vector; 2]) -> Vec<usize> {
        let found = self
            .cells_of(low, high)
            .into_iter()
            .filter_map(|cell| self.cells.get(&cell));
        let mut all: Vec<usize> = found.flatten().map(|face| *face as usize).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// The nearest point of the surface, if one is near enough to be found.
    pub fn nearest(&self, x: Vector) -> Option<Nearest> {
        let faces = self.near([x, x]).into_iter().map(|face| self.on_face(face, x));
        faces.min_by(|a, b| a.distance.total_cmp(&b.distance))
    }

    /// The nearest point of a face (Gauss–Newton, moved into the face after each step).
    fn on_face(&self, face: usize, x: Vector) -> Nearest {
        let nodes = self.surface.faces[face].len();
        let mut local = middle(nodes);
        let distance = |local| length(minus(x, self.surface.point(face, local)));
        for _ in 0..STEPS {
            let away = minus(x, self.surface.point(face, local));
            let [a, b] = self.surface.tangents(face, local);
            let (aa, ab, bb) = (dot(a, a), dot(a, b), dot(b, b));
            let (ra, rb) = (dot(a, away), dot(b, away));
            let determinant = aa * bb - ab * ab;
            if determinant <= 0.0 {
                break;
            }
            let step = [(bb * ra - ab * rb) / determinant, (aa * rb - ab * ra) / determinant];
            let next = clamped(nodes, [local[0] + step[0], local[1] + step[1]]);
            let moved = (next[0] - local[0]).abs().max((next[1] - local[1]).abs());
            local = next;
            if moved < 1e-14 {
                break;
            }
        }
        Nearest {
            face,
            local,
            distance: distance(local),
        }
    }
}
