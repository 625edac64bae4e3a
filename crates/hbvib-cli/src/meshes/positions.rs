//! Positions in space: lengths, rotations about an axis, and how close is the same place.

/// Largest distance between a node of the right face and the image of a left one, over the largest distance from the
/// origin, unless the job has another one.
pub const NEAR: f64 = 1e-4;

pub fn norm(x: &[f64; 3]) -> f64 {
    x[0].hypot(x[1]).hypot(x[2])
}

/// A point turned about an axis through the origin (Rodrigues' formula).
pub fn turned(x: [f64; 3], axis: [f64; 3], angle: f64) -> [f64; 3] {
    let n = axis.map(|a| a / norm(&axis));
    let (sin, cos) = angle.sin_cos();
    let along = n[0] * x[0] + n[1] * x[1] + n[2] * x[2];
    let across = [
        n[1] * x[2] - n[2] * x[1],
        n[2] * x[0] - n[0] * x[2],
        n[0] * x[1] - n[1] * x[0],
    ];
    [0, 1, 2].map(|k| cos * x[k] + sin * across[k] + (1.0 - cos) * along * n[k])
}
