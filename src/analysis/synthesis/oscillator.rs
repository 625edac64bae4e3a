//! The mode at one amplitude as an oscillator under a force.

use crate::linalg::inner;
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::few_motions::reduced_wave::MotionRow;
use crate::results::stored::mode_branch::ModePoint;
use num_complex::Complex64;

/// A synthesised response at one frequency.
#[derive(Clone, Copy, Debug)]
pub struct SynthesisPoint {
    /// Angular frequency Ω of the force.
    pub omega: f64,
    /// Fundamental of the response degree of freedom of the branch, with its phase relative to the force.
    pub response: Complex64,
    /// Modal amplitude of the mode at this response.
    pub modal_amplitude: f64,
    /// Natural angular frequency ω₀ at this amplitude.
    pub natural_omega: f64,
    /// Damping ratio at this amplitude, including the damping that the options add.
    pub damping_ratio: f64,
}

/// Force and additional damping that act on the mode.
pub(crate) struct Load {
    pub force: Vec<Complex64>,
    /// Forces over ω² of unbalances, taken at the natural frequency of each amplitude.
    pub unbalance: Vec<Complex64>,
    pub damping: Option<Csc>,
    pub structural: Option<Csc>,
    pub ratio: f64,
    /// Row of the response degree of freedom in the fundamental.
    pub response: MotionRow,
}

/// The mode at one amplitude, reduced to an oscillator.
#[derive(Clone, Copy, Debug)]
pub(crate) struct State {
    pub omega: f64,
    pub damping: f64,
    /// Damping ratio of the mode itself, with which its motion was computed, without the damping that the load adds.
    pub own_damping: f64,
    /// Square of the modal amplitude.
    pub square: f64,
    /// Complex work X₁ᴴ F of the force on the fundamental.
    pub work: Complex64,
    /// Fundamental X₁ of the response degree of freedom.
    pub response: Complex64,
    pub log10: f64,
    pub fundamental_share: f64,
}

impl Load {
    pub fn state(&self, omega: f64, point: &ModePoint, x: &[Complex64]) -> State {
        let square = point.modal_amplitude * point.modal_amplitude;
        let mut damping = point.damping_ratio + self.ratio;
        // xᴴ (ωC + D) x = 2Dω²·xᴴ M x with the damping ratio D on the right.
        for (matrix, factor) in [(&self.damping, omega), (&self.structural, 1.0)] {
            if let Some(a) = matrix {
                damping += 0.5 * factor * form(a, x) / (omega * omega * square);
            }
        }
        State {
            omega,
            damping,
            own_damping: point.damping_ratio,
            square,
            work: inner(x, &self.force) + inner(x, &self.unbalance) * (omega * omega),
            response: self.response.along(x),
            log10: point.log10_amplitude,
            fundamental_share: point.fundamental_share,
        }
    }
}

/// Real part of the quadratic form xᴴ A x.
pub(crate) fn form(a: &Csc, x: &[Complex64]) -> f64 {
    let mut form = 0.0;
    for (j, xj) in x.iter().enumerate() {
        for (i, v) in a.column(j) {
            form += (x[i].conj() * v * xj).re;
        }
    }
    form
}

impl State {
    /// Damping force at resonance minus excitation force: 2D(1 − D²)^½ω₀²a² − |X₁ᴴF|.
    pub fn excess(&self) -> f64 {
        let d = self.damping;
        2.0 * d * (1.0 - d * d).max(0.0).sqrt() * self.omega * self.omega * self.square - self.work.norm()
    }

    /// Factor of the force that has the motion of the mode at this amplitude, in phase with its velocity, as a logarithm; `None`
    /// where there is none.
    pub fn log_force_factor(&self) -> Option<f64> {
        let needed = 2.0 * self.damping * self.omega * self.omega * self.square;
        let factor = needed / self.work.norm();
        (factor > 0.0 && factor.is_finite()).then(|| factor.ln())
    }

    /// Half the difference of the two solutions Ω²; `None` if the force cannot maintain the amplitude.
    pub fn spread(&self) -> Option<f64> {
        let (d, w2) = (self.damping, self.omega * self.omega);
        let b = self.work.norm() / self.square;
        let square = b * b - 4.0 * d * d * (1.0 - d * d) * w2 * w2;
        (square >= 0.0).then(|| square.sqrt())
    }

    pub fn at(&self, spread: f64) -> Option<SynthesisPoint> {
        let (d, w2) = (self.damping, self.omega * self.omega);
        let square = w2 * (1.0 - 2.0 * d * d) + spread;
        if square <= 0.0 {
            return None;
        }
        let omega = square.sqrt();
        Some(SynthesisPoint {
            omega,
            response: self.response * self.turn(omega),
            modal_amplitude: self.square.sqrt(),
            natural_omega: self.omega,
            damping_ratio: d,
        })
    }

    /// Phase factor of the response at frequency `omega` relative to the mode, with which the force does the required
    /// work.
    pub fn turn(&self, omega: f64) -> Complex64 {
        let stiffness = Complex64::new(
            self.omega * self.omega - omega * omega,
            2.0 * self.damping * self.omega * omega,
        );
        let phase = self.work / stiffness;
        if phase.norm() > 0.0 {
            phase / phase.norm()
        } else {
            Complex64::ONE
        }
    }

    /// The point of the largest response; `None` where the damping leaves none above zero frequency.
    pub fn at_peak(&self) -> Option<SynthesisPoint> {
        self.at(0.0).filter(|point| point.omega > 0.0)
    }
}
