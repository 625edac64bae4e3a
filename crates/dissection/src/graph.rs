//! Undirected graphs with weights: the pattern of a symmetric sparse matrix, and what is merged or cut out of it.

use crate::memory::{Result, Vertex, narrow, try_push, try_room, try_vec, wide};

/// Mark for no vertex.
const NONE: Vertex = Vertex::MAX;

/// A graph without loops.
#[derive(Debug)]
pub(crate) struct Graph {
    /// Start of the neighbours of each vertex; and the end of the last ones.
    starts: Vec<usize>,
    neighbours: Vec<Vertex>,
    /// Number of edges that were merged into each edge.
    edges: Vec<u32>,
    /// Number of rows of the matrix that each vertex represents.
    weights: Vec<u32>,
}

impl Graph {
    /// The graph of a matrix from its lower triangle, with the vertex of each row. Vertexs with equal patterns, such as
    /// those of a node of finite elements, are one vertex.
    pub(crate) fn of_triangle(col_ptr: &[usize], rows: &[usize]) -> Result<(Self, Vec<Vertex>)> {
        let (starts, all) = mirrored(col_ptr, rows)?;
        let n = starts.len() - 1;
        let pattern = |i: usize| &all[starts[i]..starts[i + 1]];
        let hash = |i: usize| {
            let mix = |h: u64, &j: &Vertex| (h ^ u64::from(j)).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29);
            pattern(i).iter().fold(0, mix)
        };
        let mut hashes = try_room(n)?;
        hashes.extend((0..n).map(hash));
        let mut of_row = try_vec(n, NONE)?;
        let mut first = Vec::new();
        let mut weights: Vec<u32> = Vec::new();
        for i in 0..n {
            // Vertexs with one pattern have each other in it.
            let before = pattern(i).iter().map(|&j| wide(j)).take_while(|&j| j < i);
            let mut alike = before.filter(|&j| hashes[j] == hashes[i]);
            if let Some(j) = alike.find(|&j| pattern(j) == pattern(i)) {
                of_row[i] = of_row[j];
                weights[wide(of_row[j])] += 1;
            } else {
                of_row[i] = narrow(first.len());
                try_push(&mut first, i)?;
                try_push(&mut weights, 1)?;
            }
        }
        drop(hashes);
        let is_edge = |i: usize, j: usize| first[wide(of_row[j])] == j && of_row[i] != of_row[j];
        let kept = |&i: &usize| pattern(i).iter().filter(move |&&j| is_edge(i, wide(j)));
        let mut ends = try_room(first.len() + 1)?;
        ends.push(0);
        let mut count = 0;
        for i in &first {
            count += kept(i).count();
            ends.push(count);
        }
        let mut neighbours = try_room(count)?;
        for i in &first {
            neighbours.extend(kept(i).map(|&j| of_row[wide(j)]));
        }
        let graph = Self {
            starts: ends,
            edges: try_vec(neighbours.len(), 1)?,
            neighbours,
            weights,
        };
        Ok((graph, of_row))
    }

    /// Number of vertices of the graph.
    pub(crate) fn vertices(&self) -> usize {
        self.weights.len()
    }

    /// Number of edges, each counted from both ends.
    pub(crate) fn ends(&self) -> usize {
        self.neighbours.len()
    }

    /// Neighbours of a vertex.
    pub(crate) fn around(&self, v: usize) -> impl Iterator<Item = usize> + '_ {
        self.neighbours[self.starts[v]..self.starts[v + 1]]
            .iter()
            .map(|&u| wide(u))
    }

    /// Number of rows that a vertex represents.
    pub(crate) fn weight(&self, v: usize) -> i64 {
        self.weights[v].into()
    }

    /// The graph in which pairs of neighbours are merged, those with the most edges between them first; and the pair
    /// of each vertex.
    pub(crate) fn of_pairs(&self, seed: &mut u64) -> Result<(Self, Vec<Vertex>)> {
        let n = self.vertices();
        let mut pair = try_vec(n, NONE)?;
        let mut members = Vec::new();
        for v in scattered(n, seed)?.into_iter().map(wide) {
            if pair[v] != NONE {
                continue;
            }
            let mut best = (0, 0, v);
            for at in self.starts[v]..self.starts[v + 1] {
                let u = wide(self.neighbours[at]);
                let rank = (self.edges[at], u32::MAX - self.weights[u]);
                if pair[u] == NONE && rank > (best.0, best.1) {
                    best = (rank.0, rank.1, u);
                }
            }
            let number = narrow(members.len());
            (pair[v], pair[best.2]) = (number, number);
            try_push(&mut members, [v, best.2])?;
        }
        let mut merged = Self {
            starts: try_room(members.len() + 1)?,
            neighbours: try_room(self.neighbours.len())?,
            edges: try_room(self.neighbours.len())?,
            weights: try_room(members.len())?,
        };
        merged.starts.push(0);
        // Place of each pair among the neighbours of the present one.
        let mut place = try_vec(members.len(), usize::MAX)?;
        for (k, &[a, b]) in members.iter().enumerate() {
            let begin = merged.neighbours.len();
            let both = if a == b { &[a][..] } else { &[a, b] };
            merged.weights.push(both.iter().map(|&v| self.weights[v]).sum());
            for at in both.iter().flat_map(|&v| self.starts[v]..self.starts[v + 1]) {
                let u = pair[wide(self.neighbours[at])];
                let known = place[wide(u)];
                if wide(u) == k {
                } else if known >= begin && known < merged.neighbours.len() && merged.neighbours[known] == u {
                    merged.edges[known] += self.edges[at];
                } else {
                    place[wide(u)] = merged.neighbours.len();
                    merged.neighbours.push(u);
                    merged.edges.push(self.edges[at]);
                }
            }
            merged.starts.push(merged.neighbours.len());
        }
        Ok((merged, pair))
    }

    /// The part of the graph with the given vertices.
    pub(crate) fn part(&self, vertices: &[Vertex]) -> Result<Self> {
        let mut number = try_vec(self.vertices(), NONE)?;
        for (k, &v) in vertices.iter().enumerate() {
            number[wide(v)] = narrow(k);
        }
        let inside =
            |v: usize| (self.starts[v]..self.starts[v + 1]).filter(|&at| number[wide(self.neighbours[at])] != NONE);
        let count = vertices.iter().map(|&v| inside(wide(v)).count()).sum();
        let mut part = Self {
            starts: try_room(vertices.len() + 1)?,
            neighbours: try_room(count)?,
            edges: try_room(count)?,
            weights: try_room(vertices.len())?,
        };
        part.starts.push(0);
        for v in vertices.iter().map(|&v| wide(v)) {
            for at in inside(v) {
                part.neighbours.push(number[wide(self.neighbours[at])]);
                part.edges.push(self.edges[at]);
            }
            part.starts.push(part.neighbours.len());
            part.weights.push(self.weights[v]);
        }
        Ok(part)
    }

    /// Pattern of a lower triangle: start of the later neighbours of each vertex, and these neighbours.
    pub(crate) fn triangle(&self) -> Result<(Vec<usize>, Vec<usize>)> {
        let mut starts = try_room(self.starts.len())?;
        let mut later = try_room(self.neighbours.len() / 2)?;
        starts.push(0);
        for v in 0..self.vertices() {
            let begin = later.len();
            later.extend(self.around(v).filter(|&u| u > v));
            later[begin..].sort_unstable();
            starts.push(later.len());
        }
        Ok((starts, later))
    }
}

/// The numbers below n in an irregular order. A seed determines the order, and is changed by the call.
pub(crate) fn scattered(n: usize, seed: &mut u64) -> Result<Vec<Vertex>> {
    let mut all = try_room(n)?;
    all.extend((0..n).map(narrow));
    for k in (1..n).rev() {
        // Steele & Flood's generator of splittable numbers
        *seed = seed.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = *seed;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        all.swap(k, ((z ^ (z >> 31)) % (k as u64 + 1)) as usize);
    }
    Ok(all)
}

/// Vertexs of each column of the whole symmetric matrix, ascending and with the diagonal.
fn mirrored(col_ptr: &[usize], rows: &[usize]) -> Result<(Vec<usize>, Vec<Vertex>)> {
    let n = col_ptr.len() - 1;
    let below = |j: usize| rows[col_ptr[j]..col_ptr[j + 1]].iter().copied().filter(move |&i| i > j);
    let mut starts = try_vec(n + 1, 0)?;
    for j in 0..n {
        starts[j + 1] += 1;
        for i in below(j) {
            starts[i + 1] += 1;
            starts[j + 1] += 1;
        }
    }
    for j in 0..n {
        starts[j + 1] += starts[j];
    }
    let mut next = try_room(n)?;
    next.extend_from_slice(&starts[..n]);
    let mut all = try_vec(starts[n], 0)?;
    for j in 0..n {
        for i in below(j) {
            all[next[i]] = narrow(j);
            next[i] += 1;
        }
        // Earlier columns have put all rows above the diagonal here.
        all[next[j]] = narrow(j);
        next[j] += 1;
        for i in below(j) {
            all[next[j]] = narrow(i);
            next[j] += 1;
        }
    }
    Ok((starts, all))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lower triangle of a path of nodes with three rows each.
    fn path(nodes: usize) -> (Vec<usize>, Vec<usize>) {
        let (mut col_ptr, mut rows) = (vec![0], Vec::new());
        for j in 0..3 * nodes {
            rows.extend(j..(3 * (j / 3 + 2)).min(3 * nodes));
            col_ptr.push(rows.len());
        }
        (col_ptr, rows)
    }

    #[test]
    fn rows_of_a_node_are_one_vertex() {
        let (col_ptr, rows) = path(7);
        let (graph, of_row) = Graph::of_triangle(&col_ptr, &rows).unwrap();
        assert_eq!(graph.vertices(), 7);
        assert!((0..21).all(|i| wide(of_row[i]) == i / 3));
        assert!((0..7).all(|v| graph.weight(v) == 3));
        assert_eq!(graph.around(3).collect::<Vec<_>>(), [2, 4]);
        let (starts, later) = graph.triangle().unwrap();
        assert_eq!((starts, later), (vec![0, 1, 2, 3, 4, 5, 6, 6], vec![1, 2, 3, 4, 5, 6]));
    }

    #[test]
    fn merged_and_cut_graphs_keep_weights_and_edges() {
        let (col_ptr, rows) = path(50);
        let (graph, _) = Graph::of_triangle(&col_ptr, &rows).unwrap();
        let (merged, pair) = graph.of_pairs(&mut 1).unwrap();
        assert!((25..=40).contains(&merged.vertices()));
        assert_eq!((0..merged.vertices()).map(|v| merged.weight(v)).sum::<i64>(), 150);
        for v in 0..50 {
            for u in graph.around(v).filter(|&u| pair[u] != pair[v]) {
                assert!(merged.around(wide(pair[v])).any(|k| k == wide(pair[u])));
            }
        }
        let part = graph.part(&[4, 5, 6, 20]).unwrap();
        let around = |v| part.around(v).collect::<Vec<_>>();
        assert_eq!(
            [around(0), around(1), around(2), around(3)],
            [vec![1], vec![0, 2], vec![1], vec![]]
        );
    }
}
