//! Forces of a rotation, where the positions of nodes are known: away from supports they are zero, so that rows, directions and
//! positions that do not belong together show.

use crate::consistency_report::Cases;
use crate::consistency_report::Report;
use crate::nodes::Nodes;
use crate::nodes::Positions;
use crate::rows::Rows;

/// Force relative to the sum of its terms that is rounding of positions.
const ROUNDING: f64 = 1e-5;

/// The same, beyond which initial stress and terms of the speed are no reason.
const WRONG: f64 = 1e-2;

/// Share of rows up to which rows with force are exceptions.
const FEW: f64 = 0.3;

pub(crate) fn check(nodes: &Nodes, stiffness: &Rows, positions: Positions<'_>, report: &mut Report) {
    let at: Vec<Option<[f64; 3]>> = nodes.full.iter().map(|(number, _)| positions(*number)).collect();
    let known: Vec<&[f64; 3]> = at.iter().flatten().collect();
    if known.len() < nodes.full.len() || known.is_empty() {
        return;
    }
    let (mut all, mut largest, mut held) = (0_usize, 0.0_f64, Cases::default());
    let mut wrong = 0_usize;
    for (k, (_, rows)) in nodes.full.iter().enumerate() {
        for &i in rows {
            // A translation, and what it meets; then rotations about the axes through the node itself.
            let (mut move_by, mut turn_by, mut size, mut arm) = ([0.0_f64; 3], [0.0_f64; 3], 0.0_f64, 0.0_f64);
            let mut inside = true;
            for (j, v) in stiffness.row(i) {
                let Some((node, d)) = nodes.place[j] else {
                    inside = false;
                    continue;
                };
                let x = known[node];
                let r = [0, 1, 2].map(|d| x[d] - known[k][d]);
                size += v.abs();
                arm = r.iter().fold(arm, |m, x| m.max(x.abs()));
                move_by[d] += v;
                let (e, f) = ((d + 1) % 3, (d + 2) % 3);
                // (e × r) of the axes: along d they are r of the third axis, with signs.
                turn_by[e] += v * r[f];
                turn_by[f] -= v * r[e];
            }
            let supported = move_by.iter().any(|f| f.abs() > ROUNDING * size);
            if !inside || supported || size == 0.0 || arm == 0.0 {
                continue;
            }
            all += 1;
            let force = turn_by.iter().fold(0.0_f64, |m, f| m.max(f.abs())) / (size * arm);
            largest = largest.max(force);
            if force > ROUNDING {
                held.add(|| nodes.name(k));
            }
            wrong += usize::from(force > WRONG);
        }
    }
    report.facts.push(format!(
        "stiffness times a rotation: zero in {} of {all} rows away from supports, at most {largest:.1e} elsewhere",
        all - held.count()
    ));
    let few = held.count() as f64 <= FEW * all as f64;
    if few || wrong as f64 > FEW * all as f64 {
        held.told(&mut report.warnings, |count, first| {
            format!(
                "a rotation meets force in {count} of {all} rows away from supports, first {first}: entries may be wrong, or rows, \
                 directions and the mesh do not belong together"
            )
        });
    }
}
