//! One step of friction in a plane: tangential travel d and limit r = μN both linear in s ∈ [0, 1],
//! followed exactly with stick, slip, opening and closing inside the step.
//!
//! Since r' is constant, slip never turns into stick within a step: with the angle ψ from the force
//! to the travel, kt·γ = kt|d| cos ψ − r' grows because ψ' = −(kt|d|/r) sin ψ. A step is therefore
//! stick up to an onset, then slip to its end. Onset: the root of |f + kt d s| = r(s), a quadratic.
//! Slip over the rest h of the step: with κ = kt|d|h·L, L = ln(r₁/rₑ)/(r₁ − rₑ),
//!
//! > tan(ψ₁/2) = tan(ψₑ/2) e^{−κ},  f₁ = r₁ e₁.
//!
//! Derivatives. The rate of the force jumps at the onset by kt·γ e and |f| meets the limit at the rate
//! kt·γ. The contribution of the moving onset is thus a multiple of e, which moves the force back onto the circle:
//! δfₑ = (1 − e eᵀ) δf_stick + e δr, all at the time of the onset kept. Nothing is divided by γ, so a
//! grazing onset is no special case. At an opening the force is zero with its derivatives. At a closing
//! the force starts from zero, and the moving time s_c contributes its rate.

/// Loads whose ratio is below count as no load: the force is then as small against the other end's.
pub(super) const NO_LOAD: f64 = 1e-14;

/// A force this close to the limit, relatively, is at the limit.
const AT_LIMIT: f64 = 1e-14;

/// Force at the end of a step and its derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Step {
    /// Tangential force.
    pub force: [f64; 2],
    /// Its derivative by the force at the start, rows first.
    pub by_force: [[f64; 2]; 2],
    /// By the travel.
    pub by_travel: [[f64; 2]; 2],
    /// By n₀ − kn·y at the start.
    pub by_load_before: [f64; 2],
    /// By n₀ − kn·y at the end.
    pub by_load: [f64; 2],
    /// Share of the step spent slipping.
    pub slip: f64,
    /// Share of the step spent open.
    pub open: f64,
}

/// Derivatives by the data of a step: the force at its start (2), the travel (2), the load before and after.
type Gradient = [f64; 6];

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// A quarter turn to the left.
fn left(a: [f64; 2]) -> [f64; 2] {
    [-a[1], a[0]]
}

fn scaled(a: [f64; 2], factor: f64) -> [f64; 2] {
    [a[0] * factor, a[1] * factor]
}

/// a·x + b·y
fn combined(a: f64, x: &Gradient, b: f64, y: &Gradient) -> Gradient {
    std::array::from_fn(|i| a * x[i] + b * y[i])
}

/// Steps from `force` over the travel while the load goes from `before` to `after`; negative loads mean
/// that the sides are apart.
pub(super) fn step(kt: f64, mu: f64, force: [f64; 2], travel: [f64; 2], before: f64, after: f64) -> Step {
    let open_before = before <= 0.0 || before <= NO_LOAD * after.min(f64::MAX);
    let open_after = after <= 0.0 || after <= NO_LOAD * before.min(f64::MAX);
    if open_after {
        let closed = if open_before {
            0.0
        } else {
            (before / (before - after)).min(1.0)
        };
        return Step {
            slip: closed * slip_before_opening(kt, mu * before, force, scaled(travel, closed)),
            open: 1.0 - closed,
            ..Step::default()
        };
    }
    if kt == 0.0 || mu == 0.0 {
        let open = if open_before {
            (-before).max(0.0) / (after - before)
        } else {
            0.0
        };
        // Without a tangential force there is nothing to slip.
        return Step {
            open,
            ..Step::default()
        };
    }
    if open_before {
        return closing(kt, mu, travel, before, after);
    }
    closed(kt, mu, force, travel, before, after)
}

/// Share of the time from the start of the step to an opening that is spent slipping; over it the
/// limit falls from r to zero and the sides travel `d`.
fn slip_before_opening(kt: f64, r: f64, force: [f64; 2], d: [f64; 2]) -> f64 {
    if r == 0.0 || kt == 0.0 {
        return 0.0;
    }
    let (force, at_limit) = relative(force, r);
    1.0 - onset(force, at_limit, scaled(d, kt / r), -1.0).unwrap_or(1.0)
}

/// The sides close: force from zero, stick if the limit grows faster than kt|d|, else slip along d.
fn closing(kt: f64, mu: f64, d: [f64; 2], before: f64, after: f64) -> Step {
    let before = before.min(0.0);
    let growth = after - before;
    // s_c = −n/(n' − n), h = 1 − s_c
    let (s, h) = (-before / growth, after / growth);
    let length = d[0].hypot(d[1]);
    let mut out = Step {
        open: s,
        ..Step::default()
    };
    if kt * length < mu * growth {
        out.force = scaled(d, kt * h);
        out.by_travel = [[kt * h, 0.0], [0.0, kt * h]];
        out.by_load_before = scaled(d, kt * h / growth);
        out.by_load = scaled(d, kt * s / growth);
    } else {
        let e = scaled(d, 1.0 / length);
        let n = left(e);
        out.force = scaled(e, mu * after);
        for i in 0..2 {
            for k in 0..2 {
                out.by_travel[i][k] = mu * after / length * n[i] * n[k];
            }
        }
        out.by_load = scaled(e, mu);
        out.slip = h;
    }
    out
}

/// The force in units of the limit, reduced to it where it lies beyond; `true` if it is at the limit.
fn relative(force: [f64; 2], r: f64) -> ([f64; 2], bool) {
    let f = scaled(force, 1.0 / r);
    let length = f[0].hypot(f[1]);
    if length > 1.0 {
        (scaled(f, 1.0 / length), true)
    } else {
        (f, length >= 1.0 - AT_LIMIT)
    }
}

/// First s ≥ 0 from which |f + g s| would exceed 1 + c s, for |f| ≤ 1.
fn onset(f: [f64; 2], at_limit: bool, g: [f64; 2], c: f64) -> Option<f64> {
    // a s² + 2 b s + q = 0 with q ≤ 0
    let speed = g[0].hypot(g[1]);
    let a = (speed - c.abs()) * (speed + c.abs());
    let b = dot(f, g) - c;
    let length = f[0].hypot(f[1]);
    let q = if at_limit {
        0.0
    } else {
        ((length - 1.0) * (length + 1.0)).min(0.0)
    };
    if at_limit && b > 0.0 {
        return Some(0.0);
    }
    if b > 0.0 {
        let square = b * b - a * q;
        // A negative square: the limit outruns the force just before it is met.
        return (square >= 0.0).then(|| -q / (b + square.sqrt()));
    }
    (a > 0.0).then(|| ((b * b - a * q).sqrt() - b) / a)
}

/// The sides touch throughout.
fn closed(kt: f64, mu: f64, force: [f64; 2], d: [f64; 2], before: f64, after: f64) -> Step {
    let (r, r_after) = (mu * before, mu * after);
    // Derivatives of the two components of the force in stick, at first those of the start.
    let mut stick: [Gradient; 2] = [[0.0; 6]; 2];
    stick[0][0] = 1.0;
    stick[1][1] = 1.0;
    let mut start = force;
    let mut begin = None;
    if r.is_finite() {
        let size = force[0].hypot(force[1]);
        let (f, at_limit) = relative(force, r);
        if size > r * (1.0 + AT_LIMIT) {
            // Not a state of this motion: replaced by the nearest one.
            start = scaled(f, r);
            let n = left(f);
            for i in 0..2 {
                for k in 0..2 {
                    stick[i][k] = r / size * n[i] * n[k];
                }
                stick[i][4] = mu * f[i];
            }
        }
        begin = onset(f, at_limit, scaled(d, kt / r), (r_after - r) / r).filter(|s| *s < 1.0);
    }
    let s = begin.unwrap_or(1.0);
    let mut f = start;
    for i in 0..2 {
        f[i] += kt * s * d[i];
        stick[i][2 + i] += kt * s;
    }
    if begin.is_none() {
        return written(f, &stick, 0.0);
    }
    slipping(kt, mu, d, s, f, &stick, [before, after])
}

/// Slip from the onset at `s`, where stick has led to the force `f`, to the end.
fn slipping(kt: f64, mu: f64, d: [f64; 2], s: f64, f: [f64; 2], stick: &[Gradient; 2], load: [f64; 2]) -> Step {
    let h = 1.0 - s;
    let size = f[0].hypot(f[1]);
    let e = scaled(f, 1.0 / size);
    let n = left(e);
    let r = mu * (h * load[0] + s * load[1]);
    let r_end = mu * load[1];
    let r_by: Gradient = [0.0, 0.0, 0.0, 0.0, mu * h, mu * s];
    let r_end_by: Gradient = [0.0, 0.0, 0.0, 0.0, 0.0, mu];
    // Angle of the force at the onset.
    let angle_by = combined(n[0] / r, &stick[0], n[1] / r, &stick[1]);
    let (mean, mean_by_end, mean_by_start) = inverse_mean(r, r_end);
    let pull = kt * h * mean / r;
    let turned = turn(e, scaled(d, pull));
    // δθ₁ = m δθₑ + G·δw with w = kt h L d.
    let mut angle_end: Gradient = [0.0; 6];
    angle_end[2] = pull * turned.by_pull[0];
    angle_end[3] = pull * turned.by_pull[1];
    let along = kt * h * dot(turned.by_pull, d) / (r * r);
    let by_mean = combined(along * mean_by_start, &r_by, along * mean_by_end, &r_end_by);
    for i in 0..6 {
        angle_end[i] += turned.by_angle * angle_by[i] + by_mean[i];
    }
    let normal = left(turned.e);
    let by: [Gradient; 2] = std::array::from_fn(|i| combined(turned.e[i], &r_end_by, r_end * normal[i], &angle_end));
    written(scaled(turned.e, r_end), &by, h)
}

fn written(force: [f64; 2], by: &[Gradient; 2], slip: f64) -> Step {
    let part = |at: usize| by.map(|g| [g[at], g[at + 1]]);
    Step {
        force,
        by_force: part(0),
        by_travel: part(2),
        by_load_before: by.map(|g| g[4]),
        by_load: by.map(|g| g[5]),
        slip,
        open: 0.0,
    }
}

/// With ρ = r₁/r − 1 and q = ln(1 + ρ)/ρ, the mean of 1/r over a step in units of 1/r: q, and r² times the
/// derivatives of L = q/r by r₁, which is q', and by r, which is −(q + (1 + ρ) q') = (q − 1)/ρ.
fn inverse_mean(r: f64, r_end: f64) -> (f64, f64, f64) {
    const NEAR: f64 = 0.1;
    let growth = (r_end - r) / r;
    if growth.abs() < NEAR {
        // q = Σ (−ρ)ᵏ/(k + 1) and its derivatives; the first term left out is below 1e-17.
        let (mut q, mut by_end, mut by_start) = (0.0, 0.0, 0.0);
        for k in (0..17).rev() {
            let k = f64::from(k);
            q = 1.0 / (k + 1.0) - growth * q;
            by_end = -(k + 1.0) / (k + 2.0) - growth * by_end;
            by_start = -1.0 / (k + 2.0) - growth * by_start;
        }
        return (q, by_end, by_start);
    }
    let q = (r_end / r).ln() / growth;
    (q, (r / r_end - q) / growth, (q - 1.0) / growth)
}

/// A unit vector after a turn.
struct Turned {
    e: [f64; 2],
    /// Derivative of its angle by the angle at the start.
    by_angle: f64,
    /// Derivative of its angle by the pull.
    by_pull: [f64; 2],
}

/// Turns e by e' = w − (e·w) e over a unit of time: with κ = |w| and the angle ψ from e to w,
/// tan(ψ₁/2) = tan(ψ/2) e^{−κ}, ∂ψ₁/∂ψ = m = sin ψ₁/sin ψ, ∂ψ₁/∂κ = −sin ψ₁.
fn turn(e: [f64; 2], w: [f64; 2]) -> Turned {
    let pull = w[0].hypot(w[1]);
    if pull == 0.0 {
        return Turned {
            e,
            by_angle: 1.0,
            by_pull: left(e),
        };
    }
    let axis = scaled(w, 1.0 / pull);
    let (cos, sin) = (dot(e, axis), e[0] * axis[1] - e[1] * axis[0]);
    // 1 ± cos ψ without cancellation.
    let (plus, minus) = if cos >= 0.0 {
        (1.0 + cos, sin * sin / (1.0 + cos))
    } else {
        (sin * sin / (1.0 - cos), 1.0 - cos)
    };
    // A force against the motion, ψ = π, slips only while its limit falls, which bounds e^κ by the
    // ratio of the limits; the bound keeps the square from vanishing.
    let decay = (-pull).exp().max(1e-150);
    let square = decay * decay;
    let whole = plus + minus * square;
    let by_angle = 2.0 * decay / whole;
    let (cos_end, sin_end) = ((plus - minus * square) / whole, sin * by_angle);
    // (1 − m)/κ, which tends to cos ψ.
    let across = if pull > 1.0 {
        (1.0 - by_angle) / pull
    } else {
        by_angle * (2.0 * (0.5 * pull).sinh().powi(2) + cos * pull.sinh()) / pull
    };
    let normal = left(axis);
    let raw: [f64; 2] = std::array::from_fn(|i| cos_end * axis[i] - sin_end * normal[i]);
    Turned {
        e: scaled(raw, 1.0 / raw[0].hypot(raw[1])),
        by_angle,
        by_pull: std::array::from_fn(|i| across * normal[i] + sin_end * axis[i]),
    }
}
