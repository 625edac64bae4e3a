//! Harmonics in which a mode of the structure resonates. Near a mode the contacts feel its term of the flexibility alone,
//!
//! > ‖kt^½ G_h kt^½‖ ≈ Σ_c kt_c |r_c φ_k|²/|ω_k² − ν² + i(ν c_k + d_k)|,  ν = hω,
//!
//! with φᴴ M φ = 1, the motions r_c of the contacts, c_k = φᴴ C φ and d_k = φᴴ D φ of structural damping. Where damping is light this is
//! large within a band that is narrower than the distance of two harmonics: a search for the cut-off in steps passes it, and a cut-off
//! that was found at one frequency does not hold at the next. Modes and poles that are known cost a few operations a harmonic.
//!
//! The forces of contacts fall as 1/h² at least, so that a harmonic counts as far as this norm over h². One that counts as much as those
//! behind the last of a point, whose change the estimate tells, belongs to the estimate, however far it lies above them.

use crate::condense::by_modes::sum_terms::Source;
use crate::condense::{Condensed, HarmonicBlock};
use crate::error::{Result, try_push};
use crate::harmonics::carried_harmonics::{block_of, carried_from, carried_to};
use crate::harmonics::estimate::CONTEXT;
use crate::linalg::dense::eigen::Pairs;
use crate::linalg::iterative::refined_modes::dense;
use crate::linalg::libraries::DMatrix;
use num_complex::Complex64;

/// Norm of kt^½ G kt^½ from which on the structure is compliant in a harmonic.
/// Kind: tuned; measured on: not recorded.
pub(super) const COMPLIANT: f64 = 0.5;

/// Share of the first harmonics that are left out from which a resonant one counts beside them.
/// Kind: tuned; measured on: chains of 6 to 300 masses at the onset of slip, damping ratios 1e-4 to 3e-2.
const COUNTS_BESIDE: f64 = 0.3;

/// Modes on each side of a harmonic whose terms are summed: close modes resonate together, and all those below act alike beyond the
/// highest.
/// Kind: cap.
const MODES_BESIDE: usize = 16;

/// Frequency over that of the highest mode up to which harmonics are looked at.
/// Kind: tuned; measured on: the chains of `COUNTS_BESIDE`.
const BEYOND_MODES: f64 = 1.25;

/// Harmonics that are looked at for one point: stiff links have modes at a million times the frequency.
/// Kind: cap.
const MOST_LOOKED_AT: usize = 1024;

/// Harmonics among which one is sought.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sought {
    /// The last harmonic of the point.
    pub own: usize,
    /// The harmonic above which the search is of use.
    pub from: usize,
    /// The last one that may be found.
    pub most: usize,
}

/// Modes of the waves of a model, as its contacts feel them.
#[derive(Default)]
pub(super) struct ResonantHarmonics {
    /// For each carried harmonic the modes of its wave in the order of their frequencies; none where they are not known.
    waves: Vec<Vec<Mode>>,
}

/// A mode with unit modal mass.
struct Mode {
    /// ω_k².
    square: f64,
    /// c_k.
    damping: f64,
    /// d_k.
    structural: f64,
    /// Σ_c kt_c |r_c φ_k|², with the stiffness of contacts at the frequency of the mode.
    felt: f64,
}

impl Mode {
    /// Σ_c kt_c |r_c φ_k|² of a mode, from the size of its motion at each coordinate.
    fn felt(condensed: &Condensed, square: f64, size: impl Fn(usize) -> f64) -> f64 {
        let nu = square.max(0.0).sqrt();
        (0..condensed.coordinates())
            .map(|c| condensed.impedance(c, nu) * size(c))
            .sum()
    }
}

impl ResonantHarmonics {
    /// Adds the wave of the next carried harmonic from its undamped modes, which are all.
    pub fn add_pairs(&mut self, condensed: &Condensed, block: &HarmonicBlock, pairs: &Pairs) -> Result<()> {
        let n = pairs.vectors.nrows();
        let of = |values: &[Complex64]| dense(&block.matrices.reference, values);
        let damping = of(&block.matrices.damping)?;
        let structural = block
            .matrices
            .structural
            .as_ref()
            .map(|values| of(values))
            .transpose()?;
        let mut wave = Vec::new();
        for (k, &square) in pairs.values.iter().enumerate() {
            let shape = &pairs.vectors.as_slice()[k * n..(k + 1) * n];
            let form = |a: &DMatrix<Complex64>| {
                let columns = a.as_slice().chunks_exact(n.max(1)).zip(shape);
                columns
                    .map(|(column, x)| crate::linalg::inner(shape, column) * x)
                    .sum::<Complex64>()
                    .re
            };
            let mode = Mode {
                square,
                damping: form(&damping),
                structural: structural.as_ref().map_or(0.0, form),
                felt: Mode::felt(condensed, square, |c| block.motions.rows[c].along(shape).norm_sqr()),
            };
            try_push(&mut wave, mode, CONTEXT)?;
        }
        try_push(&mut self.waves, wave, CONTEXT)
    }

    /// Adds the wave of the next carried harmonic from the modes or poles by which its flexibility is a sum; none without.
    ///
    /// Modes have φᴴ K φ = 1 and μ = 1/ω². A pole λ has the term l r λ/(λ − iν), which near its resonance is that of a mode with
    /// |φ|² = 2|λ|² |l r|, ω = |λ| and c = −2 Re λ.
    pub fn add_source(&mut self, condensed: &Condensed, block: &HarmonicBlock, source: Option<&Source>) -> Result<()> {
        let mut wave = Vec::new();
        let Some(source) = source else {
            return try_push(&mut self.waves, wave, CONTEXT);
        };
        let n = block.matrices.reference.rows;
        let (shapes, adjoints) = source.shapes();
        // The stiffest come first. Poles of negative frequencies resonate in no harmonic.
        for k in (0..source.len()).rev() {
            let of = |all: &[Complex64], c: usize| block.motions.rows[c].along(&all[k * n..(k + 1) * n]).norm();
            let felt =
                |square: f64, unit: f64| Mode::felt(condensed, square, |c| unit * of(shapes, c) * of(adjoints, c));
            let mode = match source {
                Source::Modes(modes) => {
                    let square = modes.values[k].recip();
                    let (alpha, beta) = modes.proportional;
                    Mode {
                        square,
                        damping: alpha + beta * square,
                        structural: modes.loss_factor * square,
                        felt: felt(square, square),
                    }
                }
                Source::Poles(poles) => {
                    let pole = poles.values[k].inv();
                    let square = if pole.im > 0.0 { pole.norm_sqr() } else { 0.0 };
                    Mode {
                        square,
                        damping: -2.0 * pole.re,
                        structural: 0.0,
                        felt: felt(square, 2.0 * square),
                    }
                }
            };
            if mode.square.is_finite() && mode.square > 0.0 {
                try_push(&mut wave, mode, CONTEXT)?;
            }
        }
        try_push(&mut self.waves, wave, CONTEXT)
    }

    /// The last harmonic of those `sought` in which a mode resonates at the angular frequency ω; the first of them where none does.
    pub fn last(&self, condensed: &Condensed, omega: f64, sought: Sought) -> usize {
        let highest = self.waves.iter().filter_map(|wave| wave.last());
        let highest = highest.map(|mode| mode.square).fold(0.0, f64::max).sqrt();
        let set = condensed.set();
        let step = set.base() * set.stride();
        let top = ((BEYOND_MODES * highest / omega) as usize).saturating_add(step);
        let mut h = carried_to(set, sought.most.min(top).min(sought.from + MOST_LOOKED_AT * step));
        if h <= sought.from {
            return sought.from;
        }
        let first = carried_from(set, sought.own + 1);
        let first = (first..=carried_from(set, 2 * sought.own + 1).max(first + step)).step_by(step);
        let beside = first.map(|k| self.size(condensed, k, omega, usize::MAX) / (k as f64).powi(2));
        let beside = COUNTS_BESIDE * beside.fold(0.0, f64::max);
        while h > sought.from {
            let size = self.size(condensed, h, omega, MODES_BESIDE);
            if size >= COMPLIANT || (beside > 0.0 && size >= beside * (h as f64).powi(2)) {
                return h;
            }
            if h <= step {
                break;
            }
            h -= step;
        }
        sought.from
    }

    /// |Σ_c kt_c G_cc| in a harmonic by so many modes on each side of it; 0 where its modes are not known.
    fn size(&self, condensed: &Condensed, h: usize, omega: f64, beside: usize) -> f64 {
        let nu = h as f64 * omega;
        let Some(wave) = block_of(condensed, h).and_then(|i| self.waves.get(i)) else {
            return 0.0;
        };
        let place = wave.partition_point(|mode| mode.square < nu * nu);
        let near = place.saturating_sub(beside)..place.saturating_add(beside).min(wave.len());
        let term = |mode: &Mode| mode.felt / Complex64::new(mode.square - nu * nu, nu * mode.damping + mode.structural);
        wave[near].iter().map(term).sum::<Complex64>().norm()
    }
}
