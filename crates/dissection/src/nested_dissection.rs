//! Nested dissection: an order of elimination in which separators come after the parts between which they lie (George 1973,
//! doi:10.1137/0710032). On large meshes its factors are far smaller than those of minimum degrees.

use crate::graph::Graph;
use crate::memory::{OutOfMemory, Result, Vertex, narrow, try_push, try_room, try_vec, wide};
use crate::separator::{SEPARATOR, separated};

/// Answers of the program that asks for an order.
pub trait Host {
    /// Why an order was not made.
    type Error: From<OutOfMemory>;

    /// Called before about so many operations; an error ends the work.
    ///
    /// # Errors
    /// Those of the host, which [`order`] passes on.
    fn before(&self, operations: u64) -> core::result::Result<(), Self::Error>;

    /// Position of each vertex in the order of a piece that is small or hardly divided, such as by minimum degrees. The
    /// later neighbours of vertex v are `later[starts[v] .. starts[v + 1]]`, ascending.
    ///
    /// # Errors
    /// Those of the host, which [`order`] passes on.
    fn positions(&self, starts: &[usize], later: &[usize]) -> core::result::Result<Vec<usize>, Self::Error>;
}

/// Vertices of a piece that the host orders.
/// Kind: tuned; measured on: not recorded.
const LEAF: usize = 100;

/// Share of the vertices in one part above which dissection ends.
/// Kind: tuned; measured on: not recorded.
const MOST: f64 = 0.9;

/// A part of the graph: its vertices, and their first position in the order.
struct Piece {
    graph: Graph,
    vertices: Vec<Vertex>,
    place: usize,
}

/// The order of elimination of a symmetric matrix, from the pattern of its lower triangle: the row at each position.
///
/// `col_ptr` has the start of each column in `rows`, and the end of the last; the diagonal may be there or not. A matrix has
/// fewer than 2^32 rows.
///
/// # Errors
/// [`OutOfMemory`]; those of the host.
pub fn order<H: Host>(col_ptr: &[usize], rows: &[usize], host: &H) -> core::result::Result<Vec<usize>, H::Error> {
    host.before((8 * rows.len()) as u64)?;
    let (graph, of_row) = Graph::of_triangle(col_ptr, rows)?;
    let n = graph.vertices();
    let mut vertices = try_room(n)?;
    vertices.extend((0..n).map(narrow));
    let mut order = try_vec(n, 0)?;
    let mut pieces = Vec::new();
    let whole = Piece {
        graph,
        vertices,
        place: 0,
    };
    try_push(&mut pieces, whole)?;
    while let Some(piece) = pieces.pop() {
        let Piece {
            graph,
            vertices,
            mut place,
        } = piece;
        let count = vertices.len();
        let parts = if count > LEAF {
            separated(&graph, host)?
        } else {
            Vec::new()
        };
        let parts = &parts;
        let members = |part| (0..parts.len()).filter(move |&v| parts[v] == part);
        let sizes = [members(0).count(), members(1).count()];
        if sizes.contains(&0) || sizes.iter().any(|&size| size as f64 > MOST * count as f64) {
            // Small, or hardly separated.
            let (starts, later) = graph.triangle()?;
            for (&k, &v) in host.positions(&starts, &later)?.iter().zip(&vertices) {
                order[place + k] = v;
            }
            continue;
        }
        for part in [0, 1] {
            let mut inside = try_room(sizes[usize::from(part)])?;
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
            try_push(&mut pieces, piece)?;
            place += size;
        }
        for (at, v) in members(SEPARATOR).enumerate() {
            order[place + at] = vertices[v];
        }
    }
    Ok(expanded(&order, &of_row)?)
}

/// The row at each position, from the vertex at each position.
fn expanded(order: &[Vertex], of_row: &[Vertex]) -> Result<Vec<usize>> {
    let mut starts = try_vec(order.len() + 1, 0)?;
    for &v in of_row {
        starts[wide(v) + 1] += 1;
    }
    let mut place = 0;
    // First the place of each vertex's first row.
    let sizes = try_room(order.len()).map(|mut sizes: Vec<usize>| {
        sizes.extend_from_slice(&starts[1..]);
        sizes
    })?;
    for &v in order {
        starts[wide(v)] = place;
        place += sizes[wide(v)];
    }
    let mut rows = try_vec(of_row.len(), 0)?;
    for (row, &v) in of_row.iter().enumerate() {
        rows[starts[wide(v)]] = row;
        starts[wide(v)] += 1;
    }
    Ok(rows)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Never stops; pieces are eliminated from the first vertex to the last.
    pub(crate) struct Plain;

    impl Host for Plain {
        type Error = OutOfMemory;
        fn before(&self, _operations: u64) -> Result<()> {
            Ok(())
        }
        fn positions(&self, starts: &[usize], _later: &[usize]) -> Result<Vec<usize>> {
            Ok((0..starts.len() - 1).collect())
        }
    }

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
        order(&col_ptr, &rows, &Plain).unwrap()
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
