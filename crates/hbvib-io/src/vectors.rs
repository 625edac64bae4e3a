//! Vectors of three numbers.

/// x, y and z.
pub(crate) type Vector = [f64; 3];

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub(crate) fn minus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|d| a[d] - b[d])
}

/// a + f b
pub(crate) fn plus(a: Vector, f: f64, b: Vector) -> Vector {
    [0, 1, 2].map(|d| a[d] + f * b[d])
}

pub(crate) fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// A vector of length 1, or zero.
pub(crate) fn unit(a: Vector) -> Vector {
    let size = length(a);
    if size > 0.0 { a.map(|x| x / size) } else { a }
}

/// Two vectors of length 1 that are perpendicular to a third one and to each other; right-handed with it last.
pub(crate) fn perpendicular(n: Vector) -> (Vector, Vector) {
    let d = (0..3).min_by(|a, b| n[*a].abs().total_cmp(&n[*b].abs())).unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[d] = 1.0;
    let first = unit(cross(axis, n));
    (first, cross(n, first))
}
