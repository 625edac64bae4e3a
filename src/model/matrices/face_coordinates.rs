//! Positions of the nodes on both faces of a sector: the right node must be the image of the left one.

use crate::error::{Result, fail};

/// Positions of the nodes of a face.
pub type Positions<'a> = &'a [[f64; 3]];

/// Distance from the axis, over the size of the sector, below which a node lies on it.
/// Kind: rounding.
const ON_AXIS: f64 = 1e-9;

/// Largest deviation of an angle or a position, over that between the sectors: meshes and their files are rounded.
/// Kind: rounding.
const ROUNDED: f64 = 1e-3;

/// Rounding of a position in a file, over the size of the sector.
/// Kind: rounding.
const DIGITS: f64 = 1e-6;

/// Compares the positions of all pairs with the sense and the number of sectors.
///
/// # Errors
/// `Dimension` for another number of positions, `NotFinite`; `Argument` for a node on the axis, an angle between
/// the faces that contradicts `sense` and `sectors`, or nodes that are no image of each other, naming the pair.
pub(crate) fn check_coordinates(
    left: Positions<'_>,
    right: Positions<'_>,
    pairs: usize,
    axis: [f64; 3],
    forward: bool,
    sectors: usize,
) -> Result<()> {
    let mut size = 0.0_f64;
    for (name, positions) in [("left", left), ("right", right)] {
        if positions.len() != pairs {
            return fail!(
                Dimension,
                "coordinates: {} nodes on the {name} face, needs one for each of the {pairs} pairs",
                positions.len()
            );
        }
        for (pair, x) in positions.iter().enumerate() {
            if let Some(k) = x.iter().position(|x| !x.is_finite()) {
                return fail!(
                    NotFinite,
                    "coordinates: {name}[{pair},{k}] = {}, needs a finite number",
                    x[k]
                );
            }
            size = size.max(dot(*x, *x).sqrt());
        }
    }
    let step = 360.0 / sectors as f64;
    let expected = if forward { step } else { -step };
    for (pair, (&l, &r)) in left.iter().zip(right).enumerate() {
        let (from, to) = (Polar::new(l, axis), Polar::new(r, axis));
        for (name, node) in [("left", &from), ("right", &to)] {
            if node.radius <= ON_AXIS * size {
                return fail!(
                    Argument,
                    "pair {pair}: its {name} node lies on the axis, where it is its own image; a sector with nodes on the axis is not provided for"
                );
            }
        }
        let angle = from.angle_to(&to, axis).to_degrees();
        // Half a turn forwards is half a turn backwards.
        let off = (angle - expected + 180.0).rem_euclid(360.0) - 180.0;
        let slack = ROUNDED * step + (DIGITS * size / from.radius).to_degrees();
        if off.abs() > slack {
            return fail!(
                Argument,
                "pair {pair}: its right node lies at {angle:.4} degrees about the axis from the left one, but direction = {} and sectors = {sectors} put it at {expected:.4}",
                if forward { 1 } else { -1 }
            );
        }
        let apart = (from.radius - to.radius).hypot(from.height - to.height);
        if apart > ROUNDED * from.radius * step.to_radians() + DIGITS * size {
            return fail!(
                Argument,
                "pair {pair}: its nodes lie at radii {} and {} and at heights {} and {} along the axis: they are no image of each other",
                from.radius,
                to.radius,
                from.height,
                to.height
            );
        }
    }
    Ok(())
}

/// A position, by its part normal to the axis and along it.
struct Polar {
    /// Part of the position normal to the axis.
    normal: [f64; 3],
    radius: f64,
    height: f64,
}

impl Polar {
    fn new(x: [f64; 3], axis: [f64; 3]) -> Self {
        let height = dot(x, axis);
        let normal = [0, 1, 2].map(|k| x[k] - height * axis[k]);
        Self {
            normal,
            radius: dot(normal, normal).sqrt(),
            height,
        }
    }

    /// Angle about the axis from this position to another one.
    fn angle_to(&self, other: &Self, axis: [f64; 3]) -> f64 {
        let (a, b) = (self.normal, other.normal);
        let cross = [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ];
        dot(cross, axis).atan2(dot(a, b))
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
