//! Universal files (UFF): nodes (2411), responses over frequency (58) and shapes at points of the curve (55).

use crate::build::{Built, Outcome};
use crate::curve::Curve;
use crate::node_motion::{Places, harmonics};
use hbvib::Special;
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Begin and end of a data set.
const MARK: &str = "    -1\n";

/// Writes nodes, the response degree of freedom in each harmonic, and the shapes of points. Without names of nodes there are no nodes
/// and shapes, and the response has its degree of freedom as node 1 + its number.
///
/// # Errors
/// Those of the system and of the library.
pub fn write(
    path: &Path,
    (built, places): (&Built, Option<&Places>),
    curve: &Curve<'_>,
    points: &[Special],
) -> Outcome<()> {
    let mut text = String::new();
    if let Some(places) = places.filter(|places| !places.at.is_empty()) {
        nodes(&mut text, places);
    }
    responses(&mut text, built, curve)?;
    for special in places.map_or(&[][..], |_| points) {
        let Some(places) = places else { break };
        for (h, x) in harmonics(places, curve.branch, special.point)?.iter().enumerate() {
            if x.iter().flatten().any(|z| *z != Complex64::ZERO) {
                shape(&mut text, places, (h, x), special);
            }
        }
    }
    fs::write(path, text).map_err(|e| e.to_string())
}

fn nodes(text: &mut String, places: &Places) {
    let _ = writeln!(text, "{MARK}  2411");
    for (number, x) in places.numbers.iter().zip(&places.at) {
        let _ = writeln!(text, "{number:>10}{:>10}{:>10}{:>10}", 1, 1, 11);
        let _ = writeln!(text, "{}{}{}", long(x[0], 'D'), long(x[1], 'D'), long(x[2], 'D'));
    }
    *text += MARK;
}

/// The response degree of freedom in each harmonic that it has, complex over frequency.
fn responses(text: &mut String, built: &Built, curve: &Curve<'_>) -> Outcome<()> {
    let (dof, omega, ndof) = (curve.branch.response_dof(), curve.omega(), curve.branch.ndof());
    let name = built.nodes.name_of(dof);
    let (node, direction) = match name.split_once('.') {
        Some((node, direction)) => (node.parse().unwrap_or(0), direction.parse().unwrap_or(0)),
        None => (dof as i64 + 1, 0),
    };
    let mut all: Vec<Vec<Complex64>> = vec![Vec::new(); curve.rows()];
    let mut x = Vec::new();
    for point in 0..curve.points() {
        curve.harmonics_at(point, &mut x)?;
        for (h, of) in all.iter_mut().enumerate() {
            of.push(x[h * ndof + dof]);
        }
    }
    for (h, values) in all.iter().enumerate() {
        if values.iter().all(|z| *z == Complex64::ZERO) {
            continue;
        }
        let _ = writeln!(text, "{MARK}    58");
        let _ = writeln!(text, "hbvib: response {name}, harmonic {h}");
        *text += "complex amplitude over the frequency of the excitation\nNONE\nNONE\nNONE\n";
        // A spectrum.
        let _ = writeln!(
            text,
            "{:>5}{:>10}{:>5}{:>10} {:<10}{node:>10}{direction:>4} {:<10}{:>10}{:>4}",
            12, h, 0, 0, "NONE", "NONE", 0, 0
        );
        // Complex, in double precision, at uneven frequencies.
        let first = omega.first().map_or(0.0, |w| w / TAU);
        let _ = writeln!(
            text,
            "{:>10}{:>10}{:>10}{}{}{}",
            6,
            values.len(),
            0,
            short(first),
            short(0.0),
            short(0.0)
        );
        for (kind, label, units) in [
            (18, "Frequency", "Hz"),
            (8, "Displacement", "NONE"),
            (0, "NONE", "NONE"),
            (0, "NONE", "NONE"),
        ] {
            let _ = writeln!(text, "{kind:>10}{:>5}{:>5}{:>5} {label:<20} {units:<20}", 0, 0, 0);
        }
        for (omega, z) in omega.iter().zip(values) {
            let _ = writeln!(text, "{}{}{}", fitted(omega / TAU), double(z.re), double(z.im));
        }
        *text += MARK;
    }
    Ok(())
}

/// A harmonic of all nodes at one point.
fn shape(text: &mut String, places: &Places, (h, x): (usize, &[[Complex64; 3]]), special: &Special) {
    let hertz = special.omega / TAU;
    let _ = writeln!(text, "{MARK}    55");
    let _ = writeln!(text, "hbvib: motion in harmonic {h}");
    let _ = writeln!(
        text,
        "{hertz:.9} Hz, amplitude of the response {:.6e}",
        special.amplitude
    );
    *text += "NONE\nNONE\nNONE\n";
    // A structure, a frequency response, translations, displacement, complex, three a node.
    let _ = writeln!(text, "{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}", 1, 5, 2, 8, 5, 3);
    let _ = writeln!(text, "{:>10}{:>10}{:>10}{:>10}", 2, 1, 1, h);
    let _ = writeln!(text, "{}", fitted(hertz));
    let all = places.numbers.iter().zip(x).enumerate();
    for (_, (number, u)) in all.filter(|(i, _)| places.moves(*i)) {
        let _ = writeln!(text, "{number:>10}");
        for z in u {
            let _ = write!(text, "{}{}", short(z.re), short(z.im));
        }
        *text += "\n";
    }
    *text += MARK;
}

/// A number as Fortran writes it by E13.5.
fn short(x: f64) -> String {
    exponent(x, 5, 13, 'E')
}

/// A number as Fortran writes it by E20.12.
fn double(x: f64) -> String {
    exponent(x, 12, 20, 'E')
}

/// A number as Fortran writes it by D25.16.
fn long(x: f64, letter: char) -> String {
    exponent(x, 16, 25, letter)
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
    use super::{double, fitted, long, short};

    #[test]
    fn numbers_fill_their_columns() {
        assert_eq!(short(-1.234_567_8e-5), " -1.23457E-05");
        assert_eq!(short(0.0), "  0.00000E+00");
        assert_eq!(double(1.0 / 3.0), "  3.333333333333E-01");
        assert_eq!(long(-2.5, 'D'), "  -2.5000000000000000D+00");
        assert_eq!(fitted(208.841_140_123_4), " 208.84114012");
        assert_eq!(fitted(1e-7), "  1.00000E-07");
        assert_eq!(
            (fitted(123_456_789.5).len(), fitted(1e200).len(), short(1e-200).len()),
            (13, 13, 13)
        );
    }
}
