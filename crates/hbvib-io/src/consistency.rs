//! Consistency of the matrices of a model: totals that a reader compares with those of the finite-element program, and values
//! that matrices of a structure do not have.

use crate::consistency_report::Cases;
use crate::consistency_report::Report;
use crate::directions;
use crate::matrix::{Dof, Matrices, Matrix, Symmetry};
use crate::nodes::Nodes;
use crate::nodes::Positions;
use crate::parts::dof_name;
use crate::rows::Rows;

/// Relative difference of mirror images that is rounding of the file.
const ROUNDING: f64 = 1e-7;

/// Least median of K_ii/M_ii, a square of frequency, in any unit of time.
const SLOWEST: f64 = 1e-6;

/// Checks the matrices of a model. A complex matrix is checked by its real part.
#[must_use]
pub fn report(found: &Matrices) -> Report {
    report_with(found, None)
}

/// The same, with the position of each node by its number.
#[must_use]
pub fn report_with(found: &Matrices, positions: Option<&dyn Fn(i64) -> Option<[f64; 3]>>) -> Report {
    report_of(found, positions, false)
}

/// The same for a stiffness with the stresses of a static load, in which motions of the whole meet forces: speed moves with them.
#[must_use]
pub fn report_stressed(found: &Matrices) -> Report {
    report_of(found, None, true)
}

fn report_of(found: &Matrices, positions: Option<Positions<'_>>, stressed: bool) -> Report {
    let mut report = Report::default();
    for (name, a) in found.named() {
        report.facts.push(format!(
            "{name}: {} x {}, {} entries{}",
            a.rows,
            a.columns,
            a.entries(),
            kind(a)
        ));
        if a.rows != a.columns {
            report
                .warnings
                .push(format!("{name} is {} x {}, needs a square matrix", a.rows, a.columns));
        }
    }
    if !found.others.is_empty() {
        report.facts.push(format!("left out: {}", found.others.join(", ")));
    }
    let square = |a: &Option<Matrix>| a.as_ref().filter(|a| a.rows == a.columns).map(Rows::of);
    let (stiffness, mass) = (square(&found.stiffness), square(&found.mass));
    let n = stiffness.as_ref().or(mass.as_ref()).map_or(0, Rows::len);
    let check = Check {
        dofs: &found.dofs,
        stiffness: stiffness.as_ref().filter(|a| a.len() == n),
        mass: mass.as_ref().filter(|a| a.len() == n),
    };
    check.fixed(&mut report);
    check.order(&mut report);
    for (name, a) in [("stiffness", check.stiffness), ("mass", check.mass)] {
        if let Some(a) = a {
            check.symmetry(name, a, &mut report);
            check.diagonal(name, a, &mut report);
        }
    }
    check.time_scale(&mut report);
    let nodes = Nodes::of(&found.dofs, check.mass, n);
    let scalar = |dof: &&Dof| dof.0 > 0 && !(1..=6).contains(&dof.1);
    let generalised = found.dofs.iter().filter(scalar).count();
    match &nodes {
        // The mass of a superelement is no mass of nodes: a translation moves its modes, too.
        Some(_) if generalised > 0 => report.facts.push(format!(
            "rows of a superelement without a direction, such as modes: {generalised}; masses along directions are not compared"
        )),
        Some(nodes) => directions::check(nodes, (check.stiffness, check.mass), (positions, stressed), &mut report),
        None => check.pattern(&mut report),
    }
    report
}

fn kind(a: &Matrix) -> &'static str {
    match a.symmetry {
        Symmetry::General => "",
        Symmetry::Symmetric => ", one triangle",
        Symmetry::Hermitian => ", one triangle of a Hermitian matrix",
        Symmetry::Skew => ", one triangle of a skew matrix",
    }
}

struct Check<'a> {
    dofs: &'a [Dof],
    stiffness: Option<&'a Rows>,
    mass: Option<&'a Rows>,
}

impl Check<'_> {
    fn row_name(&self, i: usize) -> String {
        match self.dofs.get(i) {
            Some(dof) => dof_name(*dof),
            None => format!("row {i}"),
        }
    }

    /// Finite-element programs list nodes and directions in ascending order.
    fn order(&self, report: &mut Report) {
        let mut sorted = self.dofs.to_vec();
        sorted.sort_unstable();
        let repeated = sorted.windows(2).filter(|two| two[0] == two[1]).count();
        if repeated > 0 {
            report.facts.push(format!(
                "rows that repeat the node and direction of another one: {repeated}"
            ));
        } else if let Some(two) = self.dofs.windows(2).find(|two| two[0] > two[1]) {
            report.warnings.push(format!(
                "rows are not in ascending order of node and direction: {} comes before {}",
                dof_name(two[0]),
                dof_name(two[1])
            ));
        }
    }

    fn fixed(&self, report: &mut Report) {
        let Some(stiffness) = self.stiffness else { return };
        let fixed = stiffness.fixed_by_penalty();
        let mut cases = Cases::default();
        for i in (0..fixed.len()).filter(|i| fixed[*i]) {
            cases.add(|| format!("{}, {:.1e}", self.row_name(i), stiffness.get(i, i)));
        }
        cases.told(&mut report.facts, |count, first| {
            format!("rows fixed by a diagonal that exceeds all else by 1/epsilon: {count}, first {first}")
        });
    }

    fn symmetry(&self, name: &str, a: &Rows, report: &mut Report) {
        let diagonal = a.diagonal();
        let largest = diagonal.iter().fold(0.0_f64, |m, d| m.max(d.abs()));
        let (mut unsymmetric, mut indefinite) = (Cases::default(), Cases::default());
        for i in 0..a.len() {
            for (j, v) in a.row(i).filter(|(j, _)| *j != i) {
                let mirror = a.get(j, i);
                let product = diagonal[i] * diagonal[j];
                let scale = if product > 0.0 { product.sqrt() } else { largest };
                // Both places are visited where both are listed.
                if (v - mirror).abs() > ROUNDING * scale && (i < j || mirror == 0.0) {
                    unsymmetric.add(|| format!("{v:.6e} at ({i}, {j}) and {mirror:.6e} at ({j}, {i})"));
                }
                if i < j && v * v > product * (1.0 + ROUNDING) && product > 0.0 {
                    indefinite.add(|| format!("{v:.6e} between {} and {}", self.row_name(i), self.row_name(j)));
                }
            }
        }
        unsymmetric.told(&mut report.warnings, |count, first| {
            format!("places where the {name} is not symmetric: {count}, first {first}")
        });
        indefinite.told(&mut report.warnings, |count, first| {
            format!(
                "the {name} is negative in some direction; entries that exceed their diagonals: {count}, first {first}"
            )
        });
    }

    fn diagonal(&self, name: &str, a: &Rows, report: &mut Report) {
        let (mut negative, mut zero, mut none) = (Cases::default(), Cases::default(), Cases::default());
        let fixed = self.stiffness.map(Rows::fixed_by_penalty).unwrap_or_default();
        let mut internal = 0;
        for i in 0..a.len() {
            let d = a.get(i, i);
            let empty = a.row(i).all(|(_, v)| v == 0.0);
            if d < 0.0 {
                negative.add(|| format!("{d:.6e} at {}", self.row_name(i)));
            } else if d == 0.0 && !empty {
                zero.add(|| self.row_name(i));
            } else if empty && name == "mass" && (self.is_internal(i) || fixed.get(i) == Some(&true)) {
                internal += 1;
            } else if empty {
                none.add(|| self.row_name(i));
            }
        }
        if internal > 0 {
            report.facts.push(format!(
                "rows without mass of internal nodes, rotations, scalars and fixed rows: {internal}"
            ));
        }
        negative.told(&mut report.warnings, |count, first| {
            format!("negative numbers on the diagonal of the {name}: {count}, first {first}")
        });
        zero.told(&mut report.warnings, |count, first| {
            format!("coupled rows of the {name} with 0 on the diagonal: {count}, first {first}")
        });
        none.told(&mut report.warnings, |count, first| {
            format!("rows without {name}: {count}, first {first}")
        });
    }

    /// A row that finite-element programs write without mass: of an internal node, a rotation or a scalar.
    fn is_internal(&self, i: usize) -> bool {
        self.dofs
            .get(i)
            .is_some_and(|&(node, direction)| node < 0 || !(1..=3).contains(&direction))
    }

    fn time_scale(&self, report: &mut Report) {
        let (Some(stiffness), Some(mass)) = (self.stiffness, self.mass) else {
            return;
        };
        let fixed = stiffness.fixed_by_penalty();
        let mut squares: Vec<f64> = stiffness
            .diagonal()
            .into_iter()
            .zip(mass.diagonal())
            .zip(fixed)
            .filter(|((k, m), fixed)| *k > 0.0 && *m > 0.0 && !fixed)
            .map(|((k, m), _)| k / m)
            .collect();
        squares.sort_by(f64::total_cmp);
        let Some(&median) = squares.get(squares.len() / 2) else {
            return;
        };
        report.facts.push(format!(
            "sqrt(K_ii/M_ii): {:.4e} to {:.4e}, median {:.4e} rad per time unit",
            squares[0].sqrt(),
            squares[squares.len() - 1].sqrt(),
            median.sqrt()
        ));
        if median < SLOWEST {
            report.warnings.push(format!(
                "sqrt(K_ii/M_ii) has the median {:.2e}: are stiffness and mass exchanged, or in different units?",
                median.sqrt()
            ));
        }
    }

    /// Rows that the mass couples and the stiffness does not, where the directions of rows are not known.
    fn pattern(&self, report: &mut Report) {
        let (Some(stiffness), Some(mass)) = (self.stiffness, self.mass) else {
            return;
        };
        let (mut all, mut missing) = (0, Cases::default());
        for i in 0..mass.len() {
            for (j, _) in mass.row(i).filter(|(j, v)| i < *j && *v != 0.0) {
                all += 1;
                if stiffness.get(i, j) == 0.0 {
                    missing.add(|| format!("{} and {}", self.row_name(i), self.row_name(j)));
                }
            }
        }
        if missing.count() * 5 > all {
            missing.told(&mut report.warnings, |count, first| {
                format!("the mass couples {count} of {all} pairs of rows that the stiffness does not, first {first}")
            });
        }
    }
}
