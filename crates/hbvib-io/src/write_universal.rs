//! Writing universal files (UFF): nodes (2411), functions (58) and shapes (55).

use crate::Result;
use crate::error::Error;
use crate::output_file::OutputFile;
use crate::universal::Universal;
use crate::universal_data::{Function, Shape};
use std::fmt::Write as _;
use std::path::Path;

/// Begin and end of a data set.
const MARK: &str = "    -1\n";

/// Lines of text of a data set.
const LINES: usize = 5;

/// Characters of such a line.
const WIDTH: usize = 80;

/// Most values of a node that are written on one line.
const IN_LINE: usize = 3;

/// Writes the nodes, functions and shapes of a universal file; functions and shapes are complex, functions over frequency, shapes of
/// displacements.
///
/// # Errors
/// Numbers that are not finite, arrays of different lengths; the reason of the system.
pub fn write_universal(path: &Path, all: &Universal) -> Result<()> {
    check(all).map_err(|e| Error::new(path, 0, e))?;
    let mut file = OutputFile::create(path)?;
    if !all.nodes.is_empty() {
        file.put(format!("{MARK}  2411\n"))?;
        for node in &all.nodes {
            let [x, y, z] = node.position.map(|x| exponent(x, 16, 25, 'D'));
            file.put(format!("{:>10}{:>10}{:>10}{:>10}\n{x}{y}{z}\n", node.number, 1, 1, 11))?;
        }
        file.put(MARK)?;
    }
    for (k, function) in all.functions.iter().enumerate() {
        write_function(&mut file, k, function)?;
    }
    for shape in &all.shapes {
        write_shape(&mut file, shape)?;
    }
    file.finish()
}

fn check(all: &Universal) -> core::result::Result<(), String> {
    let finite = |values: &[(f64, f64)]| values.iter().all(|(re, im)| re.is_finite() && im.is_finite());
    if !all.nodes.iter().flat_map(|node| node.position).all(f64::is_finite) {
        return Err("positions of nodes need to be finite".into());
    }
    for (k, one) in all.functions.iter().enumerate() {
        if one.abscissa.len() != one.values.len() || !finite(&one.values) || !one.abscissa.iter().all(|x| x.is_finite())
        {
            return Err(format!("function {k} needs as many finite values as frequencies"));
        }
    }
    for (k, one) in all.shapes.iter().enumerate() {
        let fits = one.nodes.len().checked_mul(one.per_node) == Some(one.values.len());
        if !fits || !finite(&one.values) || !one.reals.iter().all(|x| x.is_finite()) {
            return Err(format!(
                "shape {k} needs {} finite values for each of its nodes",
                one.per_node
            ));
        }
    }
    Ok(())
}

/// The five lines of text, without what would break them.
fn text(lines: &[String]) -> String {
    let mut all = String::new();
    for k in 0..LINES {
        let line = lines.get(k).map_or("NONE", String::as_str);
        let plain = line
            .chars()
            .map(|c| if c.is_ascii() && !c.is_ascii_control() { c } else { '?' });
        let plain: String = plain.take(WIDTH).collect();
        // A line with −1 alone ends the data set.
        let plain = if plain.trim().is_empty() || plain.trim() == "-1" {
            "NONE"
        } else {
            &plain
        };
        all += plain;
        all += "\n";
    }
    all
}

fn write_function(file: &mut OutputFile, k: usize, one: &Function) -> Result<()> {
    let ((node, direction), (other, along)) = (one.response, one.reference);
    let mut head = format!("{MARK}    58\n{}", text(&one.text));
    let _ = writeln!(
        head,
        "{:>5}{:>10}{:>5}{:>10} {:<10}{node:>10}{direction:>4} {:<10}{other:>10}{along:>4}",
        one.kind,
        k + 1,
        0,
        0,
        "NONE",
        "NONE"
    );
    // Complex, in double precision, at uneven frequencies.
    let first = one.abscissa.first().copied().unwrap_or(0.0);
    let _ = writeln!(
        head,
        "{:>10}{:>10}{:>10}{}{}{}",
        6,
        one.values.len(),
        0,
        short(first),
        short(0.0),
        short(0.0)
    );
    let label = match one.quantity {
        8 => "Displacement",
        9 => "Reaction force",
        11 => "Velocity",
        12 => "Acceleration",
        13 => "Excitation force",
        _ => "NONE",
    };
    for (kind, label, units) in [
        (18, "Frequency", "Hz"),
        (one.quantity, label, "NONE"),
        (0, "NONE", "NONE"),
        (0, "NONE", "NONE"),
    ] {
        let _ = writeln!(head, "{kind:>10}{:>5}{:>5}{:>5} {label:<20} {units:<20}", 0, 0, 0);
    }
    file.put(head)?;
    for (x, (re, im)) in one.abscissa.iter().zip(&one.values) {
        file.put(format!(
            "{}{}{}\n",
            fitted(*x),
            exponent(*re, 12, 20, 'E'),
            exponent(*im, 12, 20, 'E')
        ))?;
    }
    file.put(MARK)
}

fn write_shape(file: &mut OutputFile, one: &Shape) -> Result<()> {
    // A structure, translations, displacement, complex.
    let kind = if one.per_node == 3 { 2 } else { 3 };
    let mut head = format!("{MARK}    55\n{}", text(&one.text));
    let _ = writeln!(
        head,
        "{:>10}{:>10}{kind:>10}{:>10}{:>10}{:>10}",
        1, one.analysis, 8, 5, one.per_node
    );
    let _ = write!(head, "{:>10}{:>10}", one.integers.len(), one.reals.len());
    for integer in &one.integers {
        let _ = write!(head, "{integer:>10}");
    }
    head += "\n";
    for reals in one.reals.chunks(2 * IN_LINE) {
        head.extend(reals.iter().map(|x| fitted(*x)));
        head += "\n";
    }
    file.put(head)?;
    for (node, values) in one.nodes.iter().zip(one.values.chunks_exact(one.per_node.max(1))) {
        let mut line = format!("{node:>10}\n");
        for part in values.chunks(IN_LINE) {
            line.extend(part.iter().map(|(re, im)| short(*re) + &short(*im)));
            line += "\n";
        }
        file.put(line)?;
    }
    file.put(MARK)
}

/// A number as Fortran writes it by E13.5.
fn short(x: f64) -> String {
    exponent(x, 5, 13, 'E')
}

/// A number with an exponent of at least two digits and a sign, in a field.
fn exponent(x: f64, digits: usize, width: usize, letter: char) -> String {
    let text = format!("{x:.digits$e}");
    let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
    let power: i32 = power.parse().unwrap_or(0);
    let sign = if power < 0 { '-' } else { '+' };
    let number = format!("{mantissa}{letter}{sign}{:02}", power.abs());
    format!("{number:>width$}")
}

/// A number in 13 columns, one of them blank, with as many digits as there is room for: a reader of E13.5 takes them all.
fn fitted(x: f64) -> String {
    for digits in (0..=10).rev() {
        let text = format!("{x:.digits$}");
        if text.len() <= 12 && x.abs() >= 1e-3 {
            return format!("{text:>13}");
        }
    }
    short(x)
}

#[cfg(test)]
mod tests {
    use super::{exponent, fitted, short};

    #[test]
    fn numbers_fill_their_columns() {
        assert_eq!(short(-1.234_567_8e-5), " -1.23457E-05");
        assert_eq!(short(0.0), "  0.00000E+00");
        assert_eq!(exponent(1.0 / 3.0, 12, 20, 'E'), "  3.333333333333E-01");
        assert_eq!(exponent(-2.5, 16, 25, 'D'), "  -2.5000000000000000D+00");
        assert_eq!(fitted(208.841_140_123_4), " 208.84114012");
        assert_eq!(fitted(1e-7), "  1.00000E-07");
        assert_eq!(
            (fitted(123_456_789.5).len(), fitted(1e200).len(), short(1e-200).len()),
            (13, 13, 13)
        );
    }
}
