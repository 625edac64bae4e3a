//! Nested dissection: an order of elimination in which separators come after the parts between which they lie (George 1973,
//! doi:10.1137/0710032). On large meshes its factors are far smaller than those of minimum degrees.

use crate::error::{Error, Result, try_push, try_room, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::elimination_order::graph::Graph;
use crate::linalg::elimination_order::separator::{SEPARATOR, separated};
use crate::linalg::sparse_storage::row_index::{Row, narrow, wide};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

const CONTEXT: &str = "nested dissection";

/// Vertices that are ordered by minimum degrees.
/// Kind: tuned; measured on: not recorded.
const LEAF: usize = 100;

/// Share of the vertices in one part above which dissection ends.
/// Kind: tuned; measured on: not recorded.
const MOST: f64 = 0.9;

/// A part of the graph: its vertices, and their first position in the order.
struct Piece {
    graph: Graph,
    vertices: Vec<Row>,
    place: usize,
}

/// The order of elimination of a symmetric matrix, from the pattern of its lower triangle: the row at each position.
///
/// # Errors
/// `OutOfMemory`; `StoppedByCaller`.
pub fn order(col_ptr: &[usize], rows: &[usize], interrupt: &Interrupt<'_>) -> Result<Vec<usize>> {
    interrupt.check_before((8 * rows.len()) as u64)?;
    let (graph, of_row) = Graph::of_triangle(col_ptr, rows)?;
    let n = graph.vertices();
    let mut vertices = try_room(n, CONTEXT)?;
    vertices.extend((0..n).map(narrow));
    let mut order = try_vec(n, 0, CONTEXT)?;
    let mut pieces = Vec::new();
    let whole = Piece {
        graph,
        vertices,
        place: 0,
    };
    try_push(&mut pieces, whole, CONTEXT)?;
    while let Some(piece) = pieces.pop() {
        let Piece {
            graph,
            vertices,
            mut place,
        } = piece;
        let count = vertices.len();
        let parts = if count > LEAF {
            separated(&graph, interrupt)?
        } else {
            Vec::new()
        };
        let parts = &parts;
        let members = |part| (0..parts.len()).filter(move |&v| parts[v] == part);
        let sizes = [members(0).count(), members(1).count()];
        if sizes.contains(&0) || sizes.iter().any(|&size| size as f64 > MOST * count as f64) {
            // Small, or hardly separated.
            for (&k, &v) in by_degrees(&graph)?.iter().zip(&vertices) {
                order[place + k] = v;
            }
            continue;
        }
        for part in [0, 1] {
            let mut inside = try_room(sizes[usize::from(part)], CONTEXT)?;
            inside.extend(members(part).map(narrow));
            let of_part = graph.part(&inside)?;
            for v in &mut inside {
                *v = vertices[wide(*v)];
            }
            let size = inside.len();
            let piece = Piece {
                graph: of_part,
                vertices: inside,
                place,
            };
            try_push(&mut pieces, piece, CONTEXT)?;
            place += size;
        }
        for (at, v) in members(SEPARATOR).enumerate() {
            order[place + at] = vertices[v];
        }
    }
    expanded(&order, &of_row)
}

/// The position of each vertex by approximate minimum degrees.
fn by_degrees(graph: &Graph) -> Result<Vec<usize>> {
    let n = graph.vertices();
    let no_memory = || Error::out_of_memory(CONTEXT);
    let (starts, later) = graph.triangle()?;
    let pattern = SymbolicSparseColMatRef::new_checked(n, n, &starts, None, &later);
    let mut order = try_vec(n, 0, CONTEXT)?;
    let mut place = try_vec(n, 0, CONTEXT)?;
    let need = amd::order_scratch::<usize>(n, later.len());
    let mut scratch = MemBuffer::try_new(need).map_err(|_| no_memory())?;
    let control = amd::Control::default();
    amd::order(&mut order, &mut place, pattern, control, MemStack::new(&mut scratch)).map_err(|_| no_memory())?;
    Ok(place)
}

/// The row at each position, from the vertex at each position.
fn expanded(order: &[Row], of_row: &[Row]) -> Result<Vec<usize>> {
    let mut starts = try_vec(order.len() + 1, 0, CONTEXT)?;
    for &v in of_row {
        starts[wide(v) + 1] += 1;
    }
    let mut place = 0;
    // First the place of each vertex's first row.
    let sizes = try_room(order.len(), CONTEXT).map(|mut sizes: Vec<usize>| {
        sizes.extend_from_slice(&starts[1..]);
        sizes
    })?;
    for &v in order {
        starts[wide(v)] = place;
        place += sizes[wide(v)];
    }
    let mut rows = try_vec(of_row.len(), 0, CONTEXT)?;
    for (row, &v) in of_row.iter().enumerate() {
        rows[starts[wide(v)]] = row;
        starts[wide(v)] += 1;
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each row once.
    fn is_order(rows: &[usize], n: usize) -> bool {
        let mut all = rows.to_vec();
        all.sort_unstable();
        all == (0..n).collect::<Vec<_>>()
    }

    /// The lower triangle with the entries (row, column) for which `is_entry` holds.
    fn order_of(n: usize, is_entry: impl Fn(usize, usize) -> bool) -> Vec<usize> {
        let (mut col_ptr, mut rows) = (vec![0], Vec::new());
        for j in 0..n {
            rows.extend((j..n).filter(|&i| i == j || is_entry(i, j)));
            col_ptr.push(rows.len());
        }
        order(&col_ptr, &rows, &Interrupt::none()).unwrap()
    }

    #[test]
    fn every_graph_has_an_order() {
        for n in [0, 1, 2, 3, 50, 700] {
            let noise = |i: usize, j: usize| (i * 7919 + j * 104_729).is_multiple_of(211);
            for (which, rows) in [
                order_of(n, |_, _| false),
                order_of(n, |_, _| true),
                order_of(n, |i, j| i == j + 1),
                // A dense row: the last, and the first.
                order_of(n, |i, _| i + 1 == n),
                order_of(n, |_, j| j == 0),
                order_of(n, noise),
                order_of(n, |i, j| i + 1 == n || noise(i, j)),
                // Two halves without an edge between them, and many small parts.
                order_of(n, |i, j| i - j < 9 && (2 * i < n) == (2 * j < n)),
                order_of(n, |i, j| i / 5 == j / 5),
                // Pairs of a vertex with one neighbour.
                order_of(n, |i, j| i % 2 == 1 && (i == j + 1 || j % 2 == 1 && i == j + 2)),
            ]
            .iter()
            .enumerate()
            {
                assert!(is_order(rows, n), "pattern {which} of order {n}");
            }
        }
    }
}
