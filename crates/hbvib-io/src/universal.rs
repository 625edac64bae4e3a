//! Universal files (UFF, .unv): nodes (data sets 15 and 2411), elements (2412), trace lines (82), shapes (55) and functions (58, text
//! or binary) of test and finite-element programs. Other data sets are passed over and listed.

use crate::Result;
use crate::universal_data::{Function, Shape, function, shape};
use crate::universal_lines::{MARK, UniversalLines};
use std::path::Path;

/// A node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniversalNode {
    /// Number of the node.
    pub number: i64,
    /// x, y and z.
    pub position: [f64; 3],
}

/// An element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UniversalElement {
    /// Number of the element.
    pub number: i64,
    /// Its kind: 41 a triangle, 44 a quadrilateral, 111 a tetrahedron, 115 a brick, ...
    pub kind: i64,
    /// Numbers of its nodes.
    pub nodes: Vec<i64>,
}

/// Contents of a universal file.
#[derive(Clone, Debug, Default)]
pub struct Universal {
    /// Name of the model (data set 151).
    pub name: String,
    /// Nodes, of all data sets.
    pub nodes: Vec<UniversalNode>,
    /// Elements.
    pub elements: Vec<UniversalElement>,
    /// Trace lines: nodes in order, 0 where the pen is lifted.
    pub lines: Vec<Vec<i64>>,
    /// Data at nodes: shapes of modes, deflections.
    pub shapes: Vec<Shape>,
    /// Functions at nodal degrees of freedom: frequency responses, histories.
    pub functions: Vec<Function>,
    /// Numbers of the data sets that were passed over.
    pub others: Vec<i64>,
}

/// Reads a universal file.
///
/// # Errors
/// File, line and reason.
pub fn read_universal(path: &Path) -> Result<Universal> {
    let mut lines = UniversalLines::open(path)?;
    let mut all = Universal::default();
    let mut any = false;
    while let Some(line) = lines.next() {
        if line.trim().is_empty() {
            continue;
        }
        if line.trim() != MARK {
            return lines.fail("needs a line with -1 before each data set");
        }
        // Some programs end a file with a mark too many.
        let Some(head) = lines.next() else { break };
        if head.trim().is_empty() {
            continue;
        }
        any = true;
        data_set(&mut lines, &head, &mut all)?;
    }
    if any { Ok(all) } else { lines.fail("holds no data set") }
}

fn data_set(lines: &mut UniversalLines, head: &str, all: &mut Universal) -> Result<()> {
    let mut words = head.split_whitespace();
    let first = words.next().unwrap_or("");
    let binary = first.ends_with(['b', 'B']) || words.next().is_some_and(|word| word.eq_ignore_ascii_case("b"));
    let Ok(number) = first.trim_end_matches(['b', 'B']).parse::<i64>() else {
        return lines.fail(format_args!("{first:?} needs to be the number of a data set"));
    };
    if binary && number != 58 {
        return lines.fail(format_args!(
            "data set {number} is binary, which only 58 is read as: write it as text"
        ));
    }
    match number {
        15 => nodes(lines, all, false),
        151 => {
            let name = lines.expect("the name of the model")?;
            name.trim().clone_into(&mut all.name);
            pass(lines)
        }
        2411 => nodes(lines, all, true),
        2412 => elements(lines, all),
        82 => trace(lines, all),
        55 => {
            all.shapes.push(shape(lines)?);
            Ok(())
        }
        58 => {
            all.functions.push(function(lines, binary.then_some(head))?);
            pass(lines)
        }
        other => {
            all.others.push(other);
            pass(lines)
        }
    }
}

/// Moves behind the end of a data set.
fn pass(lines: &mut UniversalLines) -> Result<()> {
    while lines.item()?.is_some() {}
    Ok(())
}

fn nodes(lines: &mut UniversalLines, all: &mut Universal, two_lines: bool) -> Result<()> {
    while let Some(line) = lines.item()? {
        let (numbers, position) = if two_lines {
            (line, lines.reals(3, "coordinates")?)
        } else {
            let (numbers, rest) = line.split_at_checked(40).unwrap_or((&line, ""));
            let values: Vec<f64> = rest.split_whitespace().filter_map(|word| word.parse().ok()).collect();
            (numbers.to_owned(), values)
        };
        let number = lines.of_line(&numbers, "node")?.first().copied();
        let (Some(number), &[x, y, z]) = (number, &position[..]) else {
            return lines.fail("needs the number of a node and three coordinates");
        };
        if ![x, y, z].iter().all(|x| x.is_finite()) {
            return lines.fail(format_args!("the position of node {number} is not finite"));
        }
        all.nodes.push(UniversalNode {
            number,
            position: [x, y, z],
        });
    }
    Ok(())
}

/// Kinds of beams, whose nodes follow a line with their orientation.
const BEAMS: [i64; 5] = [11, 21, 22, 23, 24];

fn elements(lines: &mut UniversalLines, all: &mut Universal) -> Result<()> {
    while let Some(line) = lines.item()? {
        let [number, kind, .., count] = lines.of_line(&line, "element")?[..] else {
            return lines.fail("needs the six numbers of an element");
        };
        if BEAMS.contains(&kind) {
            lines.expect("the orientation of a beam")?;
        }
        let nodes = lines.integers(bounded(lines, count)?, "nodes of an element")?;
        all.elements.push(UniversalElement { number, kind, nodes });
    }
    Ok(())
}

fn trace(lines: &mut UniversalLines, all: &mut Universal) -> Result<()> {
    while let Some(line) = lines.item()? {
        let [_, count, ..] = lines.of_line(&line, "trace line")?[..] else {
            return lines.fail("needs the number of a trace line and that of its nodes");
        };
        lines.expect("the name of a trace line")?;
        let nodes = lines.integers(bounded(lines, count)?, "nodes of a trace line")?;
        all.lines.push(nodes);
    }
    Ok(())
}

fn bounded(lines: &UniversalLines, count: i64) -> Result<usize> {
    match usize::try_from(count) {
        Ok(count) if count <= lines.length() => Ok(count),
        _ => lines.fail(format_args!("{count} nodes, needs 0 .. {}", lines.length())),
    }
}
