//! Faces of three, four, six and eight nodes: shape functions, points of quadrature and maps from the plane.

/// Coordinates of a point within a face.
pub(crate) type Local = [f64; 2];

/// Gauss–Legendre points on −1 .. 1 and their weights: exact up to degree 7.
const GAUSS: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];

/// Corners of a face of so many nodes.
pub(crate) fn corners(nodes: usize) -> usize {
    if matches!(nodes, 3 | 6) { 3 } else { 4 }
}

/// Whether a face has nodes between its corners.
pub(crate) fn is_quadratic(nodes: usize) -> bool {
    nodes > 4
}

/// The middle of a face.
pub(crate) fn middle(nodes: usize) -> Local {
    if corners(nodes) == 3 { [1.0 / 3.0; 2] } else { [0.0; 2] }
}

/// Shape functions of a face, and their derivatives by both coordinates.
pub(crate) fn shapes(nodes: usize, [r, s]: Local) -> Vec<(f64, [f64; 2])> {
    match nodes {
        3 => vec![(1.0 - r - s, [-1.0, -1.0]), (r, [1.0, 0.0]), (s, [0.0, 1.0])],
        6 => {
            let t = 1.0 - r - s;
            vec![
                (t * (2.0 * t - 1.0), [1.0 - 4.0 * t, 1.0 - 4.0 * t]),
                (r * (2.0 * r - 1.0), [4.0 * r - 1.0, 0.0]),
                (s * (2.0 * s - 1.0), [0.0, 4.0 * s - 1.0]),
                (4.0 * r * t, [4.0 * (t - r), -4.0 * r]),
                (4.0 * r * s, [4.0 * s, 4.0 * r]),
                (4.0 * s * t, [-4.0 * s, 4.0 * (t - s)]),
            ]
        }
        4 => CORNERS
            .iter()
            .map(|[a, b]| {
                let (f, g) = (1.0 + a * r, 1.0 + b * s);
                (f * g / 4.0, [a * g / 4.0, b * f / 4.0])
            })
            .collect(),
        _ => {
            let corner = CORNERS.iter().map(|[a, b]| {
                let (f, g, h) = (1.0 + a * r, 1.0 + b * s, a * r + b * s - 1.0);
                (f * g * h / 4.0, [a * g * (h + f) / 4.0, b * f * (h + g) / 4.0])
            });
            let between = [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]].map(|[a, b]: [f64; 2]| {
                if a == 0.0 {
                    let (f, g) = (1.0 - r * r, 1.0 + b * s);
                    (f * g / 2.0, [-r * g, b * f / 2.0])
                } else {
                    let (f, g) = (1.0 - s * s, 1.0 + a * r);
                    (f * g / 2.0, [a * f / 2.0, -s * g])
                }
            });
            corner.chain(between).collect()
        }
    }
}

/// Corners of a quadrilateral.
const CORNERS: [Local; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// The same, exact up to degree 15.
const FINE: [(f64, f64); 8] = [
    (-0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
    (-0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (-0.525_532_409_916_329, 0.313_706_645_877_887_27),
    (-0.183_434_642_495_649_8, 0.362_683_783_378_361_96),
    (0.183_434_642_495_649_8, 0.362_683_783_378_361_96),
    (0.525_532_409_916_329, 0.313_706_645_877_887_27),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

/// Points within a triangle of area ½ and their weights: exact up to degree 6, or 14 if `fine`.
pub(crate) fn triangle_points(fine: bool) -> Vec<(Local, f64)> {
    // A square that is folded onto the triangle.
    let points: &[(f64, f64)] = if fine { &FINE } else { &GAUSS };
    let mut all = Vec::new();
    for (x, a) in points {
        for (y, b) in points {
            let (u, v) = (f64::midpoint(1.0, *x), f64::midpoint(1.0, *y));
            all.push(([u, v * (1.0 - u)], a * b * (1.0 - u) / 4.0));
        }
    }
    all
}

/// Points within a face and their weights.
pub(crate) fn face_points(nodes: usize) -> Vec<(Local, f64)> {
    if corners(nodes) == 3 {
        return triangle_points(false);
    }
    let both = GAUSS
        .iter()
        .flat_map(|(x, a)| GAUSS.iter().map(move |(y, b)| ([*x, *y], a * b)));
    both.collect()
}

/// Coordinates moved into the face, if they lie outside.
pub(crate) fn clamped(nodes: usize, [r, s]: Local) -> Local {
    if corners(nodes) == 4 {
        return [r.clamp(-1.0, 1.0), s.clamp(-1.0, 1.0)];
    }
    let [r, s] = [r.max(0.0), s.max(0.0)];
    if r + s <= 1.0 {
        return [r, s];
    }
    // The nearest point of the third side.
    let along = ((1.0 + r - s) / 2.0).clamp(0.0, 1.0);
    [along, 1.0 - along]
}
