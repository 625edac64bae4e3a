//! Checks of matrices whose rows are known as x, y and z of nodes: a translation moves the same mass along each direction, and
//! meets force at supports alone.

use crate::consistency_report::Cases;
use crate::consistency_report::Report;
use crate::nodes::Nodes;
use crate::nodes::Positions;
use crate::rotations;
use crate::rows::Rows;

/// Relative difference that is rounding of the file.
const ROUNDING: f64 = 1e-6;

/// Share of rows without force in a translation from which a row with force is told as next to a support.
const MOSTLY: f64 = 0.3;

/// Share of pairs of nodes without an entry of one direction up to which these are exceptions.
const FEW: f64 = 0.05;

pub(crate) fn check(
    nodes: &Nodes,
    (stiffness, mass): (Option<&Rows>, Option<&Rows>),
    (positions, stressed): (Option<Positions<'_>>, bool),
    report: &mut Report,
) {
    if !nodes.named {
        report
            .facts
            .push("rows are taken as x, y, z of one node after another".into());
    }
    if let Some(mass) = mass {
        totals(nodes, mass, report);
        scalar_blocks(nodes, mass, report);
    }
    if let Some(stiffness) = stiffness {
        supports(nodes, stiffness, stressed, report);
        neighbours(nodes, stiffness, report);
        if let Some(positions) = positions.filter(|_| nodes.named) {
            rotations::check(nodes, stiffness, positions, report);
        }
    }
    if let (Some(stiffness), Some(mass)) = (stiffness, mass) {
        pairs(nodes, (stiffness, mass), report);
    }
}

/// Mass of a translation along each direction, of all rows and of nodes with three rows.
fn totals(nodes: &Nodes, mass: &Rows, report: &mut Report) {
    let mut total = [0.0; 3];
    for (_, rows) in &nodes.full {
        for (d, &i) in rows.iter().enumerate() {
            let along = mass
                .row(i)
                .filter(|(j, _)| matches!(nodes.place[*j], Some((_, e)) if e == d));
            total[d] += along.map(|(_, v)| v).sum::<f64>();
        }
    }
    report.facts.push(format!(
        "mass of {} nodes with three rows: {:.6e} along x, {:.6e} along y, {:.6e} along z",
        nodes.full.len(),
        total[0],
        total[1],
        total[2]
    ));
    report.total_mass = total.to_vec();
    let largest = total.iter().fold(0.0_f64, |m, t| m.max(t.abs()));
    if total.iter().any(|t| *t <= 0.0 || largest - t > ROUNDING * largest) {
        report.warnings.push(format!(
            "a translation moves different masses along x, y and z: {:.6e}, {:.6e}, {:.6e}",
            total[0], total[1], total[2]
        ));
    }
}

/// The mass between two nodes acts along the direction of motion, equally in all, or in frames turned against each other.
fn scalar_blocks(nodes: &Nodes, mass: &Rows, report: &mut Report) {
    let (mut all, mut wrong) = (0, Cases::default());
    for k in 0..nodes.full.len() {
        let own = nodes.block(mass, k, k);
        for l in nodes.coupled(mass, k).into_iter().filter(|l| *l >= k) {
            all += 1;
            let other = nodes.block(mass, l, l);
            let size = |b: &[[f64; 3]; 3]| (0..3).map(|d| b[d][d].abs()).fold(0.0, f64::max);
            let scale = (size(&own) * size(&other)).sqrt();
            if !is_turned_scalar(&nodes.block(mass, k, l), ROUNDING * scale) {
                wrong.add(|| format!("{} and {}", nodes.name(k), nodes.name(l)));
            }
        }
    }
    wrong.told(&mut report.warnings, |count, first| {
        format!(
            "the mass of {count} of {all} pairs of nodes differs between directions or couples them, first {first}: rows and \
             degrees of freedom may not belong together (beams with consistent masses have this, too)"
        )
    });
}

/// Whether a block is a number times a rotation.
fn is_turned_scalar(b: &[[f64; 3]; 3], small: f64) -> bool {
    let scalar = (0..3).all(|i| (0..3).all(|j| (b[i][j] - if i == j { b[0][0] } else { 0.0 }).abs() <= small));
    if scalar {
        return true;
    }
    let product = |i: usize, j: usize| (0..3).map(|k| b[k][i] * b[k][j]).sum::<f64>();
    let size = product(0, 0);
    let near =
        |i: usize, j: usize| (product(i, j) - if i == j { size } else { 0.0 }).abs() <= 4.0 * small * size.sqrt();
    (0..3).all(|i| (0..3).all(|j| near(i, j)))
}

/// Forces of a translation: they are zero away from supports.
fn supports(nodes: &Nodes, stiffness: &Rows, stressed: bool, report: &mut Report) {
    let force = |i: usize, d: usize| {
        let (mut sum, mut size) = (0.0_f64, 0.0_f64);
        for (j, v) in stiffness.row(i) {
            size += v.abs();
            if matches!(nodes.place[j], Some((_, e)) if e == d) {
                sum += v;
            }
        }
        if sum.abs() <= ROUNDING * size { 0.0 } else { sum / size }
    };
    let (mut free, mut largest, mut mixed) = (0, 0.0_f64, Cases::default());
    for (k, (_, rows)) in nodes.full.iter().enumerate() {
        let forces = rows.map(|i| [0, 1, 2].map(|d| force(i, d)));
        let held = forces.map(|row| row.iter().any(|f| *f != 0.0));
        largest = forces.iter().flatten().fold(largest, |m, f| m.max(f.abs()));
        free += held.iter().filter(|held| !**held).count();
        if held.contains(&true) && held.contains(&false) {
            mixed.add(|| nodes.name(k));
        }
    }
    let rows = 3 * nodes.full.len();
    report.facts.push(format!(
        "stiffness times a translation: zero in {free} of {rows} rows, at most {largest:.1e} of the row's entries elsewhere"
    ));
    if stressed {
        return;
    }
    if nodes.all_full && free as f64 >= MOSTLY * rows as f64 {
        mixed.told(&mut report.warnings, |count, first| {
            format!(
                "a translation meets force in some, not all, rows of {count} nodes, first {first}: an entry of the stiffness may \
                 be wrong or missing (springs to the ground have this, too)"
            )
        });
    } else if nodes.all_full && free == 0 && nodes.full.len() > 8 {
        report.warnings.push(
            "every translation meets force in every row: rows and degrees of freedom may not belong together, or the structure is \
             supported everywhere"
                .into(),
        );
    }
}

/// The rows of a node are coupled with the same nodes, but for entries that vanish by chance.
fn neighbours(nodes: &Nodes, stiffness: &Rows, report: &mut Report) {
    let mut differ = Cases::default();
    for (k, (_, rows)) in nodes.full.iter().enumerate() {
        let [x, y, z] = rows.map(|i| nodes.coupled_to(stiffness, &[i]));
        if x != y || y != z {
            differ.add(|| nodes.name(k));
        }
    }
    if (differ.count() as f64) <= MOSTLY * nodes.full.len() as f64 {
        differ.told(&mut report.warnings, |count, first| {
            format!("the rows of {count} nodes are coupled with different nodes by the stiffness, first {first}")
        });
    }
}

/// Nodes that the mass couples are coupled by the stiffness as well, in each direction.
fn pairs(nodes: &Nodes, (stiffness, mass): (&Rows, &Rows), report: &mut Report) {
    let (mut all, mut none, mut part) = (0, Cases::default(), Cases::default());
    let mut partly = 0;
    for k in 0..nodes.full.len() {
        for l in nodes.coupled(mass, k).into_iter().filter(|l| *l > k) {
            all += 1;
            let block = nodes.block(stiffness, k, l);
            if block.iter().flatten().all(|v| *v == 0.0) {
                none.add(|| format!("{} and {}", nodes.name(k), nodes.name(l)));
            } else if (0..3).any(|d| block[d][d] == 0.0) {
                partly += 1;
                part.add(|| format!("{} and {}", nodes.name(k), nodes.name(l)));
            }
        }
    }
    none.told(&mut report.warnings, |count, first| {
        format!("the mass couples {count} of {all} pairs of nodes that the stiffness does not, first {first}")
    });
    if f64::from(partly) <= FEW * f64::from(all) {
        part.told(&mut report.warnings, |count, first| {
            format!("the stiffness of {count} of {all} pairs of nodes lacks a direction, first {first}")
        });
    }
}
