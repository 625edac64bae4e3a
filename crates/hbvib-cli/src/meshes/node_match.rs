//! Pairs of nodes by nearest distance.

use crate::job_file::job_words::Node;
use crate::texts::outcome::Outcome;

/// Distances that differ by less than this share of the larger are equal.
const EQUAL: f64 = 1e-9;

/// A list of nodes with their positions.
pub struct Positioned<'a> {
    /// Name of the list in the job.
    pub name: &'a str,
    pub nodes: &'a [Node],
    pub at: &'a [[f64; 3]],
}

impl Positioned<'_> {
    /// A node as the job names it.
    fn node(&self, i: usize) -> String {
        let list = self.name;
        match self.nodes.get(i) {
            Some(Node::Number(number)) => format!("{list}[{i}] (node {number})"),
            Some(Node::Dofs(dofs)) => format!("{list}[{i}] (degrees of freedom {dofs:?})"),
            None => format!("{list}[{i}]"),
        }
    }
}

/// The number in list b of each node of list a: its nearest one.
///
/// # Errors
/// A sentence that names the node: none of b within the largest distance, two equally near, a node of b that is the
/// nearest of two or of none; a distance that is no number above zero.
pub fn pairs(a: &Positioned<'_>, b: &Positioned<'_>, largest: f64) -> Outcome<Vec<usize>> {
    if !(largest.is_finite() && largest > 0.0) {
        return Err(format!("largest_distance = {largest}, needs a finite distance > 0"));
    }
    if a.at.is_empty() || b.at.is_empty() {
        return Err(format!("{} and {} need at least one node each", a.name, b.name));
    }
    let mut taken: Vec<Option<usize>> = vec![None; b.at.len()];
    let mut partner = Vec::with_capacity(a.at.len());
    for (i, x) in a.at.iter().enumerate() {
        let ((near, j), second) = nearest_two(x, b.at);
        if near > largest {
            return Err(format!(
                "{} has no node of {} within {largest}: the nearest, {}, lies {near:.6e} away",
                a.node(i),
                b.name,
                b.node(j)
            ));
        }
        if let Some((far, k)) = second.filter(|(far, _)| far - near <= EQUAL * far) {
            return Err(format!(
                "{} is as near to {} as to {}, {far:.6e}: the pair is not one to one",
                a.node(i),
                b.node(j),
                b.node(k)
            ));
        }
        if let Some(other) = taken[j] {
            return Err(format!(
                "{} is the nearest of both {} and {}: the pair is not one to one",
                b.node(j),
                a.node(other),
                a.node(i)
            ));
        }
        taken[j] = Some(i);
        partner.push(j);
    }
    if let Some(j) = taken.iter().position(Option::is_none) {
        return Err(format!(
            "{} is the nearest of no node of {}: the pairs are not one to one",
            b.node(j),
            a.name
        ));
    }
    Ok(partner)
}

type Near = (f64, usize);

/// Distance and number of the nearest point, and of the second one.
fn nearest_two(x: &[f64; 3], points: &[[f64; 3]]) -> (Near, Option<Near>) {
    let (mut first, mut second) = ((f64::INFINITY, 0), None);
    for (j, y) in points.iter().enumerate() {
        let d = (x[0] - y[0]).hypot(x[1] - y[1]).hypot(x[2] - y[2]);
        if d < first.0 {
            second = (j > 0).then_some(first);
            first = (d, j);
        } else if second.is_none_or(|(far, _)| d < far) {
            second = Some((d, j));
        }
    }
    (first, second)
}

#[cfg(test)]
mod tests {
    use super::{Positioned, pairs};
    use crate::job_file::job_words::Node;

    fn matched(at_a: &[[f64; 3]], at_b: &[[f64; 3]], largest_distance: f64) -> Result<Vec<usize>, String> {
        let numbers = |from: i64, count: usize| (from..).take(count).map(Node::Number).collect::<Vec<_>>();
        let (a, b) = (numbers(100, at_a.len()), numbers(200, at_b.len()));
        let list = |name, nodes, at| Positioned { name, nodes, at };
        pairs(&list("a", &a, at_a), &list("b", &b, at_b), largest_distance)
    }

    #[test]
    fn each_node_has_its_nearest_in_any_order() {
        // Points of a line and the same ones, moved a little and in another order: 7 i mod 10.
        let a: Vec<[f64; 3]> = (0..10).map(|i| [f64::from(i), 0.5, -1.0]).collect();
        let b: Vec<[f64; 3]> = (0..10).map(|i| [f64::from(7 * i % 10) + 0.1, 0.4, -1.1]).collect();
        let found = matched(&a, &b, 0.2).unwrap();
        for (i, &j) in found.iter().enumerate() {
            assert_eq!(7 * j % 10, i);
        }
    }

    #[test]
    fn far_doubled_and_unmatched_nodes_are_named() {
        let line = |xs: &[f64]| xs.iter().map(|&x| [x, 0.0, 0.0]).collect::<Vec<_>>();
        let refused = |a: &[f64], b: &[f64], words: &[&str]| {
            let error = matched(&line(a), &line(b), 0.5).unwrap_err();
            for word in words {
                assert!(error.contains(word), "{error} lacks {word}");
            }
        };
        refused(
            &[0.0, 3.0],
            &[0.1, 4.0],
            &["a[1] (node 101)", "b[1] (node 201)", "within 0.5", "1.000000e0"],
        );
        refused(
            &[0.0, 0.2],
            &[0.1, 4.0],
            &["b[0] (node 200)", "a[0] (node 100)", "a[1] (node 101)"],
        );
        refused(&[0.0], &[0.1, 0.3], &["b[1] (node 201)", "no node of a"]);
        refused(
            &[0.0],
            &[-0.1, 0.1],
            &["a[0] (node 100)", "b[0] (node 200)", "b[1] (node 201)"],
        );
        refused(&[], &[0.1], &["at least one"]);
        assert!(matched(&line(&[0.0]), &line(&[0.0]), 0.0).is_err());
        assert_eq!(matched(&line(&[0.0]), &line(&[0.0]), 1e-9), Ok(vec![0]));
    }
}
