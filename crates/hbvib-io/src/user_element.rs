//! Superelements and element matrices as `*USER ELEMENT` with `*MATRIX`, which `*SUBSTRUCTURE MATRIX OUTPUT` of CalculiX and Abaqus
//! and `*ELEMENT MATRIX OUTPUT` write: nodes and directions of the rows, then lower triangles row by row, or with UNSYMM whole
//! matrices column by column.

use crate::Result;
use crate::lines::Lines;
use crate::matrix::{Dof, Matrices, Matrix, Symmetry};
use crate::numbers::{real, whole};

/// Matrices in the order of the fields of [`Matrices`].
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    Nothing,
    Nodes,
    Directions,
    Matrix(usize),
    Other,
}

/// Whether the first lines of a file hold the keyword of such a matrix.
pub(crate) fn is_user_element(text: &str) -> bool {
    let keyword = |line: &str| {
        line.split(',')
            .next()
            .unwrap_or("")
            .trim()
            .replace(' ', "")
            .to_ascii_uppercase()
    };
    text.lines()
        .any(|line| keyword(line) == "*USERELEMENT" || (keyword(line) == "*MATRIX" && line.contains(',')))
}

#[derive(Default)]
struct Element {
    unsymmetric: bool,
    nodes: Vec<i64>,
    /// Number of nodes that the keyword tells.
    announced: Option<usize>,
    /// Position of the first node, from 0, with such directions, and the directions.
    directions: Vec<(usize, Vec<i64>)>,
    /// Line of the keyword and numbers of each matrix.
    numbers: [Option<(usize, Vec<f64>)>; 4],
    others: Vec<String>,
    seen: bool,
}

/// The matrices of a file.
///
/// # Errors
/// The line and reason.
pub(crate) fn matrices(lines: &mut Lines) -> Result<Matrices> {
    let mut element = Element::default();
    let mut part = Part::Nothing;
    while lines.advance()? {
        let line = lines.text().trim().to_owned();
        if let Some(comment) = line.strip_prefix("**") {
            if comment.trim().to_ascii_uppercase().starts_with("ELEMENT NODES") {
                part = Part::Nodes;
            } else if part == Part::Nodes {
                element.take_nodes(lines, comment)?;
            }
        } else if line.starts_with('*') {
            if lines.is_unended() {
                return lines.fail("the file ends with a keyword, before its data");
            }
            part = element.keyword(lines, &line)?;
        } else if !line.is_empty() {
            if part == Part::Nodes {
                part = Part::Directions;
            }
            element.data(lines, part, &line)?;
        }
    }
    element.finished(lines)
}

impl Element {
    fn keyword(&mut self, lines: &Lines, line: &str) -> Result<Part> {
        let mut options = line
            .split(',')
            .map(|word| word.trim().to_ascii_uppercase().replace(' ', ""));
        let word = options.next().unwrap_or_default();
        let options: Vec<String> = options.collect();
        let value = |name: &str| {
            let pairs = options.iter().filter_map(|option| option.split_once('='));
            pairs
                .filter(|(key, _)| *key == name)
                .map(|(_, value)| value.to_owned())
                .next()
        };
        match &word[..] {
            "*USERELEMENT" => {
                if self.seen {
                    return lines.fail("a second *USER ELEMENT, needs one superelement in a file");
                }
                self.seen = true;
                self.unsymmetric = options.iter().any(|option| option == "UNSYMM");
                if let Some(count) = value("NODES") {
                    self.announced = usize::try_from(whole(lines, Some(&count), "NODES")?).ok();
                }
                Ok(Part::Directions)
            }
            "*MATRIX" => {
                let kind = value("TYPE").unwrap_or_default();
                let at = match &kind[..] {
                    "STIFFNESS" => 0,
                    "MASS" => 1,
                    _ if kind.contains("STRUCTURAL") => 3,
                    _ if kind.contains("DAMPING") || kind.contains("VISCOUS") => 2,
                    _ => {
                        self.others.push(format!("*MATRIX, TYPE={kind}"));
                        return Ok(Part::Other);
                    }
                };
                if self.numbers[at].replace((lines.number(), Vec::new())).is_some() {
                    return lines.fail(format_args!("a second *MATRIX, TYPE={kind}, needs one of each"));
                }
                Ok(Part::Matrix(at))
            }
            _ => {
                self.others.push(word);
                Ok(Part::Other)
            }
        }
    }

    /// Numbers of nodes in a comment.
    fn take_nodes(&mut self, lines: &Lines, comment: &str) -> Result<()> {
        for word in comment.split([',', ' ', '\t']).filter(|word| !word.is_empty()) {
            self.nodes.push(whole(lines, Some(word), "node")?);
        }
        Ok(())
    }

    fn data(&mut self, lines: &Lines, part: Part, line: &str) -> Result<()> {
        let words: Vec<&str> = line.split([',', ' ', '\t']).filter(|word| !word.is_empty()).collect();
        match part {
            Part::Other => Ok(()),
            Part::Nothing => lines.fail("data before a keyword, needs *USER ELEMENT or *MATRIX"),
            Part::Nodes | Part::Directions => {
                let mut numbers = Vec::new();
                for word in words {
                    numbers.push(whole(lines, Some(word), "direction")?);
                }
                let position = if self.directions.is_empty() {
                    1
                } else {
                    numbers.remove(0)
                };
                let last = self.directions.last().map_or(-1, |(at, _)| *at as i64);
                if position - 1 <= last || numbers.is_empty() || numbers.iter().any(|d| *d < 1) {
                    return lines.fail("needs the position of a node, ascending, and its directions from 1");
                }
                self.directions.push(((position - 1) as usize, numbers));
                Ok(())
            }
            Part::Matrix(at) => {
                for word in words {
                    let value = real(lines, Some(word), "value")?;
                    if let Some((_, numbers)) = &mut self.numbers[at] {
                        if numbers.try_reserve(1).is_err() {
                            return lines.fail("no memory for the entries");
                        }
                        numbers.push(value);
                    }
                }
                Ok(())
            }
        }
    }

    /// Rows by node and direction; none where the file does not name nodes.
    fn dofs(&self, lines: &Lines) -> Result<Vec<Dof>> {
        let nodes = match self.announced {
            // Fortran fills the last line of nodes with zeros.
            Some(count) if self.nodes.len() >= count && self.nodes[count..].iter().all(|n| *n == 0) => {
                &self.nodes[..count]
            }
            Some(count) if !self.nodes.is_empty() => {
                return lines.fail(format_args!(
                    "{} nodes are listed, and NODES = {count}",
                    self.nodes.len()
                ));
            }
            _ => &self.nodes[..],
        };
        let mut dofs = Vec::new();
        let mut list = 0;
        for (position, node) in nodes.iter().enumerate() {
            while self
                .directions
                .get(list + 1)
                .is_some_and(|(first, _)| *first <= position)
            {
                list += 1;
            }
            if let Some((_, directions)) = self.directions.get(list) {
                dofs.extend(directions.iter().map(|direction| (*node, *direction)));
            }
        }
        Ok(dofs)
    }

    fn finished(mut self, lines: &Lines) -> Result<Matrices> {
        let dofs = self.dofs(lines)?;
        let mut all = Matrices::default();
        let places = [&mut all.stiffness, &mut all.mass, &mut all.damping, &mut all.structural];
        let mut order = (!dofs.is_empty()).then_some(dofs.len());
        for (place, numbers) in places.into_iter().zip(&mut self.numbers) {
            let Some((line, numbers)) = numbers.take() else {
                continue;
            };
            let (n, whole) = match order {
                Some(n) => (n, self.unsymmetric),
                None => match sizes(numbers.len(), self.unsymmetric) {
                    Some(n) => (n, self.unsymmetric),
                    None => {
                        return lines.fail_at(
                            line,
                            format_args!("{} numbers are no triangle of a matrix", numbers.len()),
                        );
                    }
                },
            };
            let needed = if whole {
                n.saturating_mul(n)
            } else {
                n.saturating_mul(n + 1) / 2
            };
            if numbers.len() != needed {
                return lines.fail_at(
                    line,
                    format_args!("{} numbers, needs {needed} for {n} degrees of freedom", numbers.len()),
                );
            }
            order = Some(n);
            *place = Some(matrix(lines, (n, whole), &numbers)?);
        }
        if all.named().next().is_none() {
            return lines.fail("*USER ELEMENT without *MATRIX, TYPE=STIFFNESS or MASS");
        }
        all.dofs = dofs;
        all.others = self.others;
        Ok(all)
    }
}

/// The order of a matrix of so many numbers.
fn sizes(count: usize, whole: bool) -> Option<usize> {
    let numbers = |n: usize| if whole { n * n } else { n * (n + 1) / 2 };
    let root = if whole { count.isqrt() } else { (2 * count).isqrt() };
    (root.saturating_sub(1)..=root + 1).find(|n| numbers(*n) == count && count > 0)
}

fn matrix(lines: &Lines, (n, whole): (usize, bool), numbers: &[f64]) -> Result<Matrix> {
    let symmetry = if whole { Symmetry::General } else { Symmetry::Symmetric };
    let mut matrix = Matrix::new(lines, (n, n), symmetry, (0, false))?;
    let mut next = numbers.iter();
    for j in 0..n {
        for i in 0..if whole { n } else { j + 1 } {
            let value = next.next().copied().unwrap_or(0.0);
            let (row, column) = if whole { (i, j) } else { (j, i) };
            matrix.push(lines, row as u32, column as u32, (value, 0.0))?;
        }
    }
    Ok(matrix.finished())
}
