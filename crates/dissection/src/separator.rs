//! Small separators of graphs: vertices without which a graph falls into two parts of similar size.
//!
//! Pairs of neighbours are merged until few vertices are left, separators of that graph are found from several starts, and
//! the best is carried back, improved in every graph on the way by moves of single vertices (Karypis & Kumar 1998,
//! doi:10.1137/S1064827595287997; Ashcraft & Liu 1998, doi:10.1137/S0895479896297744).

use crate::graph::{Graph, scattered};
use crate::memory::{OutOfMemory, Result, Vertex, narrow, try_push, try_room, try_vec, wide};
use crate::nested_dissection::Host;
use std::collections::BinaryHeap;

/// Vertices of a graph that is not merged further, and the share of them that is left where merging ends early.
/// Kind: tuned; measured on: not recorded.
const COARSEST: usize = 120;
const STALLED: f64 = 0.95;

/// Separators from which the best of the coarsest graph is taken.
/// Kind: tuned; measured on: not recorded.
const STARTS: usize = 5;

/// Graphs with less than this share of the vertices are merged and separated more than once.
/// Kind: tuned; measured on: not recorded.
const REPEATED_BELOW: usize = 4;
const TRIES: usize = 2;

/// Largest share of the weight in one part, and weight of the parts' difference against that of the separator.
/// Kind: tuned; measured on: not recorded.
const SEPARATOR_LARGEST: f64 = 0.6;
const BALANCE: f64 = 0.1;

/// Passes over the separator in one graph, and moves without gain that end a pass.
/// Kind: tuned; measured on: not recorded.
const PASSES: u8 = 8;
const SEPARATOR_PATIENCE: usize = 100;

/// Part that contains a vertex: 0, 1, or the separator between them.
pub(crate) type Part = u8;

/// Mark of the separator.
pub(crate) const SEPARATOR: Part = 2;

/// Divides a graph: the part of each vertex, such that no edge joins parts 0 and 1. Equal graphs are divided equally.
pub(crate) fn separated<H: Host>(graph: &Graph, host: &H) -> core::result::Result<Vec<Part>, H::Error> {
    best_of(graph, graph.vertices() / REPEATED_BELOW, &mut 1, host)
}

fn best_of<H: Host>(
    graph: &Graph,
    repeated_below: usize,
    seed: &mut u64,
    host: &H,
) -> core::result::Result<Vec<Part>, H::Error> {
    let n = graph.vertices();
    let mut best: Option<(f64, Vec<Part>)> = None;
    let mut keep = |parts: Vec<Part>| -> core::result::Result<(), H::Error> {
        let mut cut = Cut::new(graph, parts)?;
        cut.improve(host)?;
        let cost = cut.cost();
        if best.as_ref().is_none_or(|(least, _)| cost < *least) {
            best = Some((cost, cut.parts));
        }
        Ok(())
    };
    let mut merges = n > COARSEST;
    if merges {
        for _ in 0..if n > repeated_below { 1 } else { TRIES } {
            host.before((8 * graph.ends()) as u64)?;
            let (merged, pair) = graph.of_pairs(seed)?;
            merges = (merged.vertices() as f64) < STALLED * n as f64;
            if !merges {
                break;
            }
            let coarse = best_of(&merged, repeated_below, seed, host)?;
            drop(merged);
            let mut parts = try_room(n)?;
            parts.extend(pair.iter().map(|&k| coarse[wide(k)]));
            keep(parts)?;
        }
    }
    if !merges {
        for &start in scattered(n, seed)?.iter().take(STARTS) {
            keep(grown(graph, wide(start))?)?;
        }
    }
    Ok(best.map_or_else(Vec::new, |(_, parts)| parts))
}

/// Grows part 0 from a vertex to half of the weight; its vertices next to the rest become the separator.
fn grown(graph: &Graph, start: usize) -> Result<Vec<Part>> {
    let n = graph.vertices();
    let all: i64 = (0..n).map(|v| graph.weight(v)).sum();
    let mut parts = try_vec(n, 1)?;
    let mut queue = Vec::new();
    let (mut taken, mut at, mut others) = (0, 0, 0..n);
    try_push(&mut queue, start)?;
    parts[start] = 0;
    while 2 * taken < all {
        if at == queue.len() {
            // Another connected part.
            let Some(v) = others.find(|&v| parts[v] == 1) else {
                break;
            };
            parts[v] = 0;
            try_push(&mut queue, v)?;
        }
        let v = queue[at];
        at += 1;
        taken += graph.weight(v);
        for u in graph.around(v) {
            if parts[u] == 1 {
                parts[u] = 0;
                try_push(&mut queue, u)?;
            }
        }
    }
    // Vertices that were reached, but not taken.
    for &v in &queue[at..] {
        parts[v] = SEPARATOR;
    }
    Ok(parts)
}

/// Parts of a graph while vertices are moved between them.
struct Cut<'a> {
    graph: &'a Graph,
    parts: Vec<Part>,
    /// Weights of part 0, part 1 and the separator.
    weights: [i64; 3],
    /// For each vertex, the weights of its neighbours in part 0 and part 1.
    beside: Vec<[i64; 2]>,
    /// For each vertex, the pass in which it left the separator last.
    left: Vec<u8>,
    /// Moves into part 0 and part 1, as (gain, vertex); those outdated since are passed over.
    moves: [BinaryHeap<(i64, Vertex)>; 2],
    /// Log of the moves: vertex, and the part that it was in.
    log: Vec<(Vertex, Part)>,
}

impl<'a> Cut<'a> {
    fn new(graph: &'a Graph, parts: Vec<Part>) -> Result<Self> {
        let n = graph.vertices();
        let mut state = Self {
            graph,
            weights: [0; 3],
            beside: try_vec(n, [0; 2])?,
            left: try_vec(n, 0)?,
            moves: [BinaryHeap::new(), BinaryHeap::new()],
            log: Vec::new(),
            parts,
        };
        for v in 0..n {
            let part = state.parts[v];
            state.weights[usize::from(part)] += graph.weight(v);
            if part != SEPARATOR {
                for u in graph.around(v) {
                    state.beside[u][usize::from(part)] += graph.weight(v);
                }
            }
        }
        Ok(state)
    }

    /// Cost of the division: weight of the separator, increased where the parts differ, and much where one is too
    /// large.
    fn cost(&self) -> f64 {
        let [a, b, cut] = self.weights.map(|w| w as f64);
        let beyond = (a.max(b) - SEPARATOR_LARGEST * (a + b + cut)).max(0.0);
        cut * (1.0 + BALANCE * (a - b).abs() / (a + b).max(1.0)) + beyond
    }

    fn improve<H: Host>(&mut self, host: &H) -> core::result::Result<(), H::Error> {
        for pass in 1..=PASSES {
            host.before(self.graph.ends() as u64)?;
            if !self.pass(pass)? {
                break;
            }
        }
        Ok(())
    }

    /// Moves vertices out of the separator, each once, even where the separator grows for a while, and returns to the
    /// best division. `false` where none was better than the first.
    fn pass(&mut self, number: u8) -> Result<bool> {
        self.log.clear();
        self.moves.iter_mut().for_each(BinaryHeap::clear);
        for v in 0..self.parts.len() {
            if self.parts[v] == SEPARATOR {
                self.offer(v)?;
            }
        }
        let limit = (SEPARATOR_LARGEST * self.weights.iter().sum::<i64>() as f64) as i64;
        let first = self.cost();
        let (mut least, mut kept, mut without) = (first, 0, 0);
        while without < SEPARATOR_PATIENCE {
            let Some((v, part)) = self.next(limit, number) else {
                break;
            };
            self.carry(v, part, number)?;
            let cost = self.cost();
            without += 1;
            if cost < least {
                (least, kept, without) = (cost, self.log.len(), 0);
            }
        }
        while self.log.len() > kept {
            if let Some((v, part)) = self.log.pop() {
                self.set(wide(v), part);
            }
        }
        Ok(least < first)
    }

    /// Decrease of the separator's weight by a move.
    fn gain(&self, v: usize, part: usize) -> i64 {
        self.graph.weight(v) - self.beside[v][1 - part]
    }

    fn offer(&mut self, v: usize) -> Result<()> {
        for part in 0..2 {
            let gain = self.gain(v, part);
            let moves = &mut self.moves[part];
            if moves.try_reserve(1).is_err() {
                return Err(OutOfMemory);
            }
            moves.push((gain, narrow(v)));
        }
        Ok(())
    }

    /// Vertex and part of the allowed move with the largest gain; into the smaller part where gains are equal.
    fn next(&mut self, limit: i64, number: u8) -> Option<(usize, usize)> {
        let mut best: Option<(i64, i64, usize, usize)> = None;
        for part in 0..2 {
            while let Some(&(gain, v)) = self.moves[part].peek() {
                let v = wide(v);
                let valid = self.parts[v] == SEPARATOR && self.left[v] != number && self.gain(v, part) == gain;
                // A move that is too large is so for the rest of the pass, or comes back when a neighbour changes.
                let too_large =
                    self.weights[part] + self.graph.weight(v) > limit && self.weights[part] > self.weights[1 - part];
                if !valid || too_large {
                    self.moves[part].pop();
                    continue;
                }
                let rank = (gain, -self.weights[part], v, part);
                if best.is_none_or(|(g, w, ..)| (gain, -self.weights[part]) > (g, w)) {
                    best = Some(rank);
                }
                break;
            }
        }
        best.map(|(_, _, v, part)| (v, part))
    }

    /// Moves a vertex into a part, and its neighbours of the other part into the separator.
    fn carry(&mut self, v: usize, part: usize, number: u8) -> Result<()> {
        let graph = self.graph;
        self.left[v] = number;
        try_push(&mut self.log, (narrow(v), SEPARATOR))?;
        self.set(v, part as Part);
        for u in graph.around(v) {
            if usize::from(self.parts[u]) == 1 - part {
                try_push(&mut self.log, (narrow(u), self.parts[u]))?;
                self.set(u, SEPARATOR);
                self.offer(u)?;
                for w in graph.around(u) {
                    if self.parts[w] == SEPARATOR && self.left[w] != number {
                        self.offer(w)?;
                    }
                }
            }
        }
        for u in graph.around(v) {
            if self.parts[u] == SEPARATOR && self.left[u] != number {
                self.offer(u)?;
            }
        }
        Ok(())
    }

    fn set(&mut self, v: usize, part: Part) {
        let graph = self.graph;
        let before = core::mem::replace(&mut self.parts[v], part);
        let weight = graph.weight(v);
        self.weights[usize::from(before)] -= weight;
        self.weights[usize::from(part)] += weight;
        for u in graph.around(v) {
            if before != SEPARATOR {
                self.beside[u][usize::from(before)] -= weight;
            }
            if part != SEPARATOR {
                self.beside[u][usize::from(part)] += weight;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nested_dissection::tests::Plain;

    /// The graph of a square grid.
    fn grid(side: usize) -> Graph {
        let (mut col_ptr, mut rows) = (vec![0], Vec::new());
        for j in 0..side * side {
            rows.push(j);
            if (j + 1) % side != 0 {
                rows.push(j + 1);
            }
            if j + side < side * side {
                rows.push(j + side);
            }
            col_ptr.push(rows.len());
        }
        Graph::of_triangle(&col_ptr, &rows).unwrap().0
    }

    #[test]
    fn a_grid_falls_apart_along_little_more_than_one_line() {
        for side in [8, 30, 60] {
            let graph = grid(side);
            let parts = separated(&graph, &Plain).unwrap();
            let size = |part| (0..parts.len()).filter(|&v| parts[v] == part).count();
            let largest = SEPARATOR_LARGEST * (side * side) as f64;
            assert!(
                size(SEPARATOR) <= side + side / 4,
                "{} of {side} vertices separate",
                size(SEPARATOR)
            );
            assert!(size(0).max(size(1)) as f64 <= largest + 1.0);
            for v in 0..parts.len() {
                assert!(graph.around(v).all(|u| parts[u] + parts[v] != 1));
            }
            assert_eq!(parts, separated(&graph, &Plain).unwrap());
        }
    }

    #[test]
    fn weights_are_counted_after_every_move_and_way_back() {
        let graph = grid(20);
        let mut cut = Cut::new(&graph, grown(&graph, 7).unwrap()).unwrap();
        let before = cut.cost();
        cut.improve(&Plain).unwrap();
        assert!(cut.cost() <= before);
        let new = Cut::new(&graph, cut.parts).unwrap();
        assert_eq!((new.weights, new.beside), (cut.weights, cut.beside));
    }
}
