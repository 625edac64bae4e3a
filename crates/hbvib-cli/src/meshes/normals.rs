//! Normals of contacts against the positions of their nodes.

use crate::texts::outcome::Outcome;

/// Length of the mean of all gaps over the mean of their lengths, from which they have one direction.
const COHERENT: f64 = 0.5;

/// Cosine of the angle between gap and normal below which the normal lies in the contact plane.
const OBLIQUE: f64 = 0.5;

/// Mean gap relative to the size of the positions that is rounding.
const CLOSED: f64 = 1e-9;

/// Refuses a normal, which points from side b to side a, that the gaps between the nodes contradict. Gaps of no common direction
/// say nothing, as of meshes that do not match.
///
/// # Errors
/// A sentence with both directions.
pub fn check(normal: [f64; 3], at_a: &[[f64; 3]], at_b: &[[f64; 3]]) -> Outcome<()> {
    let length = |x: &[f64; 3]| x[0].hypot(x[1]).hypot(x[2]);
    let (mut sum, mut lengths, mut size) = ([0.0; 3], 0.0, 0.0_f64);
    for (a, b) in at_a.iter().zip(at_b) {
        let gap = [0, 1, 2].map(|k| a[k] - b[k]);
        for k in 0..3 {
            sum[k] += gap[k];
        }
        lengths += length(&gap);
        size = size.max(length(a)).max(length(b));
    }
    let across = length(&sum);
    if lengths <= CLOSED * size * at_a.len() as f64 || across < COHERENT * lengths {
        return Ok(());
    }
    let cosine = (0..3).map(|k| sum[k] * normal[k]).sum::<f64>() / (across * length(&normal));
    let direction = sum.map(|x| x / across);
    let told = format!(
        "normal = {normal:?}, but side a lies along [{:.3}, {:.3}, {:.3}] of side b, by {:.3e} on average",
        direction[0],
        direction[1],
        direction[2],
        lengths / at_a.len() as f64
    );
    let remedy = "normal points from b to a; any_normal = true accepts it, as for meshes that overlap";
    if cosine <= -OBLIQUE {
        return Err(format!("{told}: it points the wrong way ({remedy})"));
    }
    if cosine < OBLIQUE {
        return Err(format!("{told}: it lies in the plane of the contact ({remedy})"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::check;

    #[test]
    fn a_normal_is_that_of_the_gap_or_refused() {
        let a: Vec<[f64; 3]> = (0..6).map(|i| [f64::from(i), f64::from(i % 2), 1e-3]).collect();
        let b: Vec<[f64; 3]> = a.iter().map(|x| [x[0] + 1e-4, x[1], 0.0]).collect();
        assert!(check([0.0, 0.0, 2.0], &a, &b).is_ok());
        assert!(check([0.0, 0.0, -1.0], &a, &b).unwrap_err().contains("the wrong way"));
        for plane in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]] {
            assert!(check(plane, &a, &b).unwrap_err().contains("in the plane"));
        }
        // Equal places, and offsets of any direction, say nothing.
        assert!(check([1.0, 0.0, 0.0], &a, &a).is_ok());
        let shaken: Vec<[f64; 3]> = a
            .iter()
            .enumerate()
            .map(|(i, x)| [x[0] + if i % 2 == 0 { 1e-4 } else { -1e-4 }, x[1], x[2]])
            .collect();
        assert!(check([0.0, 0.0, 1.0], &a, &shaken).is_ok());
    }
}
