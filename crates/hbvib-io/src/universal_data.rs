//! Data at nodes (data set 55) and functions at nodal degrees of freedom (58) of a universal file.

use crate::Result;
use crate::bytes_read::Kind;
use crate::universal_lines::UniversalLines;

/// Data at nodes: the shape of a mode, or a deflection at a frequency.
#[derive(Clone, Debug)]
pub struct Shape {
    /// The five lines of text.
    pub text: Vec<String>,
    /// 1 static, 2 normal mode, 3 and 7 complex modes, 4 transient, 5 frequency response.
    pub analysis: i64,
    /// Whole numbers of the analysis: load case, number of the mode, ...
    pub integers: Vec<i64>,
    /// Numbers of the analysis: frequency, modal mass and damping ratios of a normal mode; eigenvalue of a complex one; the frequency of
    /// a response.
    pub reals: Vec<f64>,
    /// Numbers of the nodes.
    pub nodes: Vec<i64>,
    /// Values of a node: 3 along x, y and z, or 6 with rotations.
    pub per_node: usize,
    /// Real and imaginary parts, `per_node` a node.
    pub values: Vec<(f64, f64)>,
}

/// A function at a nodal degree of freedom.
#[derive(Clone, Debug)]
pub struct Function {
    /// The five lines of text.
    pub text: Vec<String>,
    /// 1 a history in time, 4 a frequency response, 12 a spectrum, ...
    pub kind: i64,
    /// Node and direction of the response: 1 to 3 along x, y, z, 4 to 6 about them, with a sign.
    pub response: (i64, i64),
    /// Node and direction of the reference.
    pub reference: (i64, i64),
    /// Kind of the values, as data set 58 numbers it: 8 displacements, 9 reaction forces, 11 velocities, 12 accelerations, 13 forces; 0
    /// unknown.
    pub quantity: i64,
    /// Times or frequencies.
    pub abscissa: Vec<f64>,
    /// Real and imaginary parts.
    pub values: Vec<(f64, f64)>,
}

/// Lines of the head of a function.
const HEAD: usize = 11;

/// Reads data at nodes, to the end of the data set.
pub(crate) fn shape(lines: &mut UniversalLines) -> Result<Shape> {
    let mut text = Vec::new();
    for _ in 0..5 {
        text.push(lines.expect("a line of text")?.trim().to_owned());
    }
    let head = lines.integers(6, "numbers of the kind of data")?;
    let (analysis, kind, per_node) = (head[1], head[4], head[5]);
    let is_complex = match kind {
        2 => false,
        5 => true,
        other => return lines.fail(format_args!("data of type {other}, needs 2 (real) or 5 (complex)")),
    };
    let per_node = match usize::try_from(per_node) {
        Ok(count) if (1..=lines.length()).contains(&count) => count,
        _ => return lines.fail(format_args!("{per_node} values of a node, needs at least 1")),
    };
    let line = lines.expect("the whole numbers of the analysis")?;
    let mut integers = lines.of_line(&line, "numbers of the analysis")?;
    let count = |at: usize| {
        integers
            .get(at)
            .and_then(|n| usize::try_from(*n).ok())
            .filter(|n| *n <= 1000)
    };
    let (Some(wholes), Some(numbers)) = (count(0), count(1)) else {
        return lines.fail("needs the counts of whole and real numbers of the analysis");
    };
    while integers.len() < 2 + wholes {
        let line = lines.expect("more whole numbers of the analysis")?;
        integers.extend(lines.of_line(&line, "numbers of the analysis")?);
    }
    integers.drain(..2);
    let reals = lines.reals(numbers, "numbers of the analysis")?;
    let mut shape = Shape {
        text,
        analysis,
        integers,
        reals,
        nodes: Vec::new(),
        per_node,
        values: Vec::new(),
    };
    while let Some(line) = lines.item()? {
        let [node] = lines.of_line(&line, "node")?[..] else {
            return lines.fail("needs the number of a node");
        };
        shape.nodes.push(node);
        let numbers = lines.reals(if is_complex { 2 * per_node } else { per_node }, "values of a node")?;
        shape.values.extend(paired(&numbers, is_complex));
    }
    Ok(shape)
}

fn paired(numbers: &[f64], is_complex: bool) -> Vec<(f64, f64)> {
    if is_complex {
        numbers.chunks_exact(2).map(|two| (two[0], two[1])).collect()
    } else {
        numbers.iter().map(|re| (*re, 0.0)).collect()
    }
}

/// Reads a function, not the end of its data set; `binary` is the head of a binary one.
pub(crate) fn function(lines: &mut UniversalLines, binary: Option<&str>) -> Result<Function> {
    let mut head = Vec::new();
    for _ in 0..HEAD {
        head.push(lines.expect("a line of the head of a function")?);
    }
    // Names of entities may be empty or hold blanks, so that fields have fixed columns.
    let field = |from: usize, to: usize| {
        let line = &head[5];
        line.get(from..line.len().min(to))
            .unwrap_or("")
            .trim()
            .parse::<i64>()
            .unwrap_or(0)
    };
    let mut words = head[6].split_whitespace();
    let mut number = || {
        words
            .next()
            .and_then(|word| word.replace(['D', 'd'], "e").parse::<f64>().ok())
    };
    let (Some(kind), Some(count), Some(even)) = (number(), number(), number()) else {
        return lines.fail("needs type, number of values and spacing in the seventh line of a function");
    };
    let (first, step) = (number().unwrap_or(0.0), number().unwrap_or(0.0));
    let (is_complex, double) = match kind as i64 {
        2 => (false, false),
        4 => (false, true),
        5 => (true, false),
        6 => (true, true),
        other => return lines.fail(format_args!("values of type {other}, needs 2, 4, 5 or 6")),
    };
    let even = even as i64 == 1;
    let count = if (0.0..=lines.length() as f64).contains(&count) {
        count as usize
    } else {
        usize::MAX
    };
    let per_value = usize::from(!even) + if is_complex { 2 } else { 1 };
    let total = count.saturating_mul(per_value);
    let numbers = match binary {
        None => lines.reals(total, "values of a function")?,
        Some(line) => binary_values(lines, line, (total, per_value), (even, double))?,
    };
    let mut abscissa = Vec::new();
    let mut values = Vec::new();
    for (k, one) in numbers.chunks_exact(per_value).enumerate() {
        let (x, value) = if even {
            (first + step * k as f64, one)
        } else {
            (one[0], &one[1..])
        };
        abscissa.push(x);
        values.extend(paired(value, is_complex));
    }
    let quantity = head[8].split_whitespace().next().and_then(|word| word.parse().ok());
    Ok(Function {
        quantity: quantity.unwrap_or(0),
        kind: field(0, 5),
        response: (field(41, 51), field(51, 55)),
        reference: (field(66, 76), field(76, 80)),
        text: head[..5].iter().map(|line| line.trim().to_owned()).collect(),
        abscissa,
        values,
    })
}

/// Values of a binary function. Abscissae of uneven ones are in single precision.
fn binary_values(
    lines: &mut UniversalLines,
    head: &str,
    (total, per_value): (usize, usize),
    (even, double): (bool, bool),
) -> Result<Vec<f64>> {
    let words: Vec<i64> = head
        .split_whitespace()
        .skip(1)
        .filter_map(|word| word.parse().ok())
        .collect();
    let &[order, format, _, bytes, ..] = &words[..] else {
        return lines.fail("needs byte order, format, lines of the head and bytes of a binary function");
    };
    if !matches!(order, 1 | 2) || format != 2 {
        return lines.fail(format_args!(
            "byte order {order} and format {format} of numbers, needs 1 or 2, and 2 (IEEE 754)"
        ));
    }
    let little = order == 1;
    let size = if double { 8 } else { 4 };
    // Abscissae are in single precision; some programs write them as the values. The announced length is wrong in files of others.
    let widths = if even { vec![size] } else { vec![4, size] };
    let length = |width: usize| {
        let of_value = if even {
            per_value * size
        } else {
            width + (per_value - 1) * size
        };
        (total / per_value).checked_mul(of_value)
    };
    let fits = |width: &&usize| length(**width).is_some_and(|length| lines.mark_follows(length));
    let Some(&width) = widths.iter().find(fits) else {
        return lines.fail(format_args!(
            "the data set does not end after {} values; {bytes} bytes are announced",
            total / per_value
        ));
    };
    let needed = length(width);
    let data = lines.take_bytes(needed.unwrap_or(0))?;
    let mut all = Vec::new();
    let mut rest = &data[..];
    while !rest.is_empty() {
        let size = if !even && all.len().is_multiple_of(per_value) {
            4
        } else {
            size
        };
        let (number, after) = rest.split_at(size.min(rest.len()));
        all.push(Kind::Real(size).value(number, little).0);
        rest = after;
    }
    if all.iter().any(|x| !x.is_finite()) {
        return lines.fail("a value of a binary function is not finite");
    }
    Ok(all)
}
