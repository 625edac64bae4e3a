//! Results in the .frd format of CalculiX: the mesh, and real and imaginary part of each harmonic at points of the curve, as `DISP` and
//! `DISPI` of a steady state.

use crate::building::built::Built;
use crate::outputs::node_motion::{Places, harmonics};
use crate::texts::outcome::Outcome;
use hbvib::{Branch, Special};
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Nodes of an element in one line.
const IN_LINE: usize = 10;

/// Writes the file.
///
/// # Errors
/// A sentence: no mesh; those of the system and of the library.
pub fn write(path: &Path, (built, places): (&Built, &Places), branch: &Branch, points: &[Special]) -> Outcome<()> {
    places.needs_mesh()?;
    let mut text = String::from("    1C\n    1UPGM               hbvib\n");
    let _ = writeln!(text, "    2C{:18}{:>12}{:37}1", "", places.numbers.len(), "");
    for (number, x) in places.numbers.iter().zip(&places.at) {
        row(&mut text, *number, x);
    }
    text += " -3\n";
    let elements = built.nodes.mesh.as_ref().map_or(Vec::new(), |mesh| mesh.drawn());
    if !elements.is_empty() {
        let _ = writeln!(text, "    3C{:18}{:>12}{:37}1", "", elements.len(), "");
        for element in elements {
            let _ = writeln!(
                text,
                " -1{:>10}{:>5}{:>5}{:>5}",
                element.number,
                element.shape.frd(),
                0,
                1
            );
            for line in element.shape.frd_order().chunks(IN_LINE) {
                text += " -2";
                for place in line {
                    let _ = write!(text, "{:>10}", element.nodes[*place]);
                }
                text += "\n";
            }
        }
        text += " -3\n";
    }
    let mut step = 0;
    for special in points {
        let hertz = special.omega / TAU;
        for (h, x) in harmonics(places, branch, special.point)?.iter().enumerate() {
            if x.iter().flatten().all(|z| *z == Complex64::ZERO) {
                continue;
            }
            step += 1;
            let _ = writeln!(text, "    1PSTEP{step:>26}{h:>12}{step:>12}");
            block(&mut text, places, ("DISP", hertz, step), x, |z| z.re);
            if h > 0 {
                block(&mut text, places, ("DISPI", hertz, step), x, |z| z.im);
            }
        }
    }
    text += " 9999\n";
    fs::write(path, text).map_err(|e| e.to_string())
}

/// Values of all nodes under one name.
fn block(
    text: &mut String,
    places: &Places,
    (name, hertz, step): (&str, f64, usize),
    x: &[[Complex64; 3]],
    of: fn(Complex64) -> f64,
) {
    let count = places.numbers.len();
    let _ = writeln!(
        text,
        "  100CL{:>5}{}{count:>12}{:20}{:>2}{step:>5}{:10}{:>2}",
        100 + step,
        number(hertz),
        "",
        2,
        "",
        1
    );
    let _ = writeln!(text, " -4  {name:<8}{:>5}{:>5}", 4, 1);
    for (k, component) in ["D1", "D2", "D3"].into_iter().enumerate() {
        let _ = writeln!(text, " -5  {component:<8}{:>5}{:>5}{:>5}{:>5}", 1, 2, k + 1, 0);
    }
    let _ = writeln!(text, " -5  {:<8}{:>5}{:>5}{:>5}{:>5}{:>5}ALL", "ALL", 1, 2, 0, 0, 1);
    for (node, u) in places.numbers.iter().zip(x) {
        row(text, *node, &u.map(of));
    }
    *text += " -3\n";
}

fn row(text: &mut String, node: i64, x: &[f64; 3]) {
    let _ = writeln!(text, " -1{node:>10}{}{}{}", number(x[0]), number(x[1]), number(x[2]));
}

/// A number in twelve columns, as C prints it by %12.5E.
fn number(x: f64) -> String {
    // Three digits of an exponent leave no room for a sign before the number.
    let x = if x.abs() < 1e-99 { 0.0 } else { x };
    let text = format!("{x:.5e}");
    let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
    let power: i32 = power.parse().unwrap_or(0);
    let sign = if power < 0 { '-' } else { '+' };
    format!("{:>12}", format!("{mantissa}E{sign}{:02}", power.abs()))
}
