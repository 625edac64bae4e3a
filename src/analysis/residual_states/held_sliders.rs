//! A forced response whose sticking contacts have their sliders at given places: the result that is bounded, with its derivatives by the
//! places.
//!
//! The contacts are held by a friction coefficient that is so large that they stick at any place, so that the solution is a smooth
//! function of the places beyond the limits of friction as well; [`slip_margins`] tells where it is a solution of the model.
//!
//! [`slip_margins`]: crate::analysis::residual_states::slip_margins

use crate::analysis::residual_states::slip_margins::{Held, Margin};
use crate::analysis::residual_states::stuck_contacts::StuckSlider;
use crate::condense::Condensed;
use crate::contact::forms::constants::Constant;
use crate::error::{Result, Status, fail, try_copy, try_push, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::model::Model;
use crate::options::{Exchanged, Response, SolverOptions};
use crate::sensitivity::{Adjoint, ForcedPoint, Parameter, SampledModel, TotalDerivative, peak_row, peak_shift};
use std::sync::Arc;

const CONTEXT: &str = "a response with held sliders";

/// Factor of the friction coefficient of a held contact.
/// Kind: tuned; measured on: not recorded.
pub(crate) const HELD: f64 = 1e6;

/// Newton iterations at one frequency, and corrections of the frequency of a peak.
/// Kind: cap.
const HELD_SLIDERS_ITERATIONS: usize = 15;
const HELD_SLIDERS_CORRECTIONS: usize = 12;

/// Residual, relative to the motion, of a solution.
/// Kind: rounding.
const RESIDUAL: f64 = 1e-13;

/// Residual at which a solution without further progress counts.
/// Kind: rounding.
const HELD_SLIDERS_ENOUGH: f64 = 1e-10;

/// Change of the frequency of a peak, relative to itself, that is rounding; and that which counts after all corrections.
/// Kind: rounding.
const HELD_SLIDERS_SETTLED: f64 = 1e-13;
const HELD_SLIDERS_NEARLY: f64 = 1e-9;

/// Result of a forced response that a band bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BandOf {
    /// The amplitude at the frequency of the point.
    Amplitude,
    /// The amplitude of the peak, which moves with the places of the sliders.
    PeakAmplitude,
    /// The angular frequency of the peak.
    PeakOmega,
}

/// The equations of a forced response with held sliders.
pub(crate) struct HeldSliders<'a> {
    pub model: &'a Model,
    /// The model with large friction coefficients at the free contacts, which therefore stick.
    pub held: Model,
    /// Options with exactly the carried harmonics.
    pub solver: SolverOptions,
    pub response_dof: usize,
    pub response: Option<Response<'a>>,
    pub sliders: Vec<StuckSlider>,
    pub of: BandOf,
    pub interrupt: &'a Interrupt<'a>,
}

/// A solution with held sliders, shared by several owners.
pub(crate) type HeldState = Arc<HeldSolution>;

/// A solution with held sliders.
pub(crate) struct HeldSolution {
    /// Places of the sliders.
    pub places: Vec<f64>,
    pub omega: f64,
    pub set: HarmonicSet,
    /// Packed motions in the caller's unit.
    pub motion: Vec<f64>,
    /// The result that the band bounds.
    pub value: f64,
    /// Derivatives of the result by the places of the sliders.
    pub gradient: Vec<f64>,
    pub amplitude: f64,
    /// Derivatives of the packed motions and the frequency by the places, one vector for each slider.
    by_place: Vec<Vec<f64>>,
    omega_by_place: Vec<f64>,
    pub margins: Vec<Margin>,
}

impl HeldSolution {
    /// The least margin, over the mean limit of its contact.
    pub fn least_margin(&self) -> f64 {
        self.margins.iter().map(Margin::share).fold(f64::INFINITY, f64::min)
    }
}

impl<'a> HeldSliders<'a> {
    /// The equations for the given sliders of `model`.
    ///
    /// # Errors
    /// Those of [`Model::set_slider`]; `OutOfMemory`.
    pub fn new(
        model: &'a Model,
        (solver, harmonics): (&SolverOptions, usize),
        (response_dof, response): (usize, Option<Response<'a>>),
        sliders: Vec<StuckSlider>,
        of: BandOf,
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Self> {
        let mut held = model.separate_clone()?;
        for slider in sliders.iter().filter(|slider| slider.direction == 0) {
            let mu = HELD * model.contacts()[slider.contact].constant(Constant::Mu);
            held.set_constant(slider.contact, Constant::Mu, mu)?;
        }
        // The mean and the even harmonics are carried wherever the sliders are.
        let solver = SolverOptions {
            harmonics,
            keep_even_harmonics: true,
            exchange: Exchanged::None,
            ..solver.fixed()
        };
        Ok(Self {
            model,
            held,
            solver,
            response_dof,
            response,
            sliders,
            of,
            interrupt,
        })
    }

    /// A copy of a model with the sliders at the given places.
    pub fn placed(&self, model: &Model, places: &[f64]) -> Result<Model> {
        let mut copy = model.try_clone()?;
        for (slider, &place) in self.sliders.iter().zip(places) {
            copy.set_slider(slider.contact, slider.direction, place)?;
        }
        Ok(copy)
    }

    /// Distance over which each slider can be dragged: μN/kt.
    pub fn distances(&self, state: &HeldState) -> Result<Vec<f64>> {
        let mut units = try_vec(self.sliders.len(), 0.0, CONTEXT)?;
        for (unit, slider) in units.iter_mut().zip(&self.sliders) {
            let own = state.margins.iter().filter(|m| m.contact == slider.contact);
            let limit = own.fold(0.0_f64, |most, m| most.max(m.limit.abs()));
            *unit = limit / slider.stiffness;
        }
        Ok(units)
    }

    /// The solution with the sliders where they are, from a packed motion over `set` in the caller's unit.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn first(&self, set: &HarmonicSet, motion: &[f64], omega: f64) -> Result<HeldState> {
        let mut places = Vec::new();
        for slider in &self.sliders {
            try_push(&mut places, slider.place, CONTEXT)?;
        }
        self.solution(&places, set, motion, omega)
    }

    /// The solution of [`Self::solve`]; `None` where it is not found.
    ///
    /// # Errors
    /// Its other ones.
    pub fn find(&self, places: &[f64], from: &HeldState) -> Result<Option<HeldState>> {
        match self.solve(places, from) {
            Ok(state) => Ok(Some(state)),
            Err(e) if e.recoverable || matches!(e.status, Status::NoConvergence | Status::Singular) => Ok(None),
            Err(e) => Err(e),
        }
    }

    /// The solution with the sliders at other places, from a solution nearby.
    ///
    /// # Errors
    /// `NoConvergence` where it is not found; those of the model and of callbacks; `OutOfMemory`; `StoppedByCaller`.
    pub fn solve(&self, places: &[f64], from: &HeldState) -> Result<HeldState> {
        let mut motion = try_copy(&from.motion, CONTEXT)?;
        let mut omega = from.omega;
        for (j, place) in places.iter().enumerate() {
            let change = place - from.places[j];
            for (u, by) in motion.iter_mut().zip(&from.by_place[j]) {
                *u += change * by;
            }
            omega += change * from.omega_by_place[j];
        }
        if !(omega > 0.5 * from.omega && omega < 2.0 * from.omega) {
            return fail!(NoConvergence, "a held slider is too far from the last one");
        }
        self.solution(places, &from.set, &motion, omega)
    }

    fn solution(&self, places: &[f64], set: &HarmonicSet, motion: &[f64], mut omega: f64) -> Result<HeldState> {
        let model = self.placed(&self.held, places)?;
        let condensed = Condensed::with_reference(&model, &self.solver, (omega, omega), None, self.interrupt)?;
        let length = condensed.length();
        let mut u = try_vec(condensed.unknowns(), 0.0, CONTEXT)?;
        if motion.len() / set.packed_len().max(1) != condensed.coordinates() {
            return fail!(Internal, "held sliders have other coordinates than their branch");
        }
        condensed.set().transfer(set, motion, 1.0 / length, &mut u);
        let mut point = self.point(&condensed, omega)?;
        let is_peak = self.of != BandOf::Amplitude;
        let mut adjoint = newton(&mut point, &mut u, omega)?;
        if is_peak {
            adjoint = to_peak(&mut point, &mut u, &mut omega, adjoint)?;
        }
        let at_frequency = model.at_frequency(omega)?;
        let samples = self.solver.samples;
        let by_places = |adjoint: &Adjoint, values: &mut [f64]| -> Result<()> {
            let solution = SampledModel {
                condensed: &condensed,
                samples,
            };
            let mut total = TotalDerivative::new(&model, &at_frequency, solution, adjoint, self.interrupt)?;
            for (value, slider) in values.iter_mut().zip(&self.sliders) {
                let parameter = Parameter::Contact {
                    constant: Constant::Slider(slider.direction),
                    contact: Some(slider.contact),
                };
                *value = total.by(&parameter)?.0;
            }
            Ok(())
        };
        let count = self.sliders.len();
        let mut gradient = try_vec(count, 0.0, CONTEXT)?;
        by_places(&adjoint, &mut gradient)?;
        let omega_by_place = if is_peak {
            peak_shift(&mut point, &u, omega, adjoint.amplitude, count, by_places)?
        } else {
            try_vec(count, 0.0, CONTEXT)?
        };
        // The matrix of the point itself again.
        adjoint_at(&mut point, &u, omega)?;
        let tangent = if is_peak { point.tangent(omega)? } else { Vec::new() };
        let mut sliders = try_copy(&self.sliders, CONTEXT)?;
        let mut by_place = Vec::new();
        for (j, slider) in sliders.iter_mut().enumerate() {
            slider.place = places[j];
            let mut change = point.by_slider(slider.coordinate, slider.stiffness, omega)?;
            for (c, t) in change.iter_mut().zip(&tangent) {
                // The motions are in the solver's unit of lengths, the places are not.
                *c += length * t * omega_by_place[j];
            }
            try_push(&mut by_place, change, CONTEXT)?;
        }
        let margins = Held {
            model: &*self.model.at_frequency(omega)?,
            condensed: &condensed,
            motion: &u,
            sliders: &sliders,
            by_place: &by_place,
        }
        .margins(self.interrupt)?;
        for x in &mut u {
            *x *= length;
        }
        let of_peak_omega = self.of == BandOf::PeakOmega;
        Ok(Arc::new(HeldSolution {
            places: try_copy(places, CONTEXT)?,
            omega,
            set: condensed.set().try_clone()?,
            motion: u,
            value: if of_peak_omega { omega } else { adjoint.amplitude },
            gradient: if of_peak_omega {
                try_copy(&omega_by_place, CONTEXT)?
            } else {
                gradient
            },
            amplitude: adjoint.amplitude,
            by_place,
            omega_by_place,
            margins,
        }))
    }

    fn point<'c>(&self, condensed: &'c Condensed, omega: f64) -> Result<ForcedPoint<'c>>
    where
        'a: 'c,
    {
        let samples = self.solver.samples;
        let point = ForcedPoint::new(condensed, self.response_dof, samples, omega, self.interrupt)?;
        match &self.response {
            Some(response) => point.watching(response, self.response_dof, samples),
            None => Ok(point),
        }
    }
}

fn adjoint_at(point: &mut ForcedPoint<'_>, u: &[f64], omega: f64) -> Result<Adjoint> {
    match point.adjoint(u, omega)? {
        Some(adjoint) => Ok(adjoint),
        None => fail!(NoConvergence, "the response has a fold where a slider is held"),
    }
}

/// Newton's method at a fixed frequency; returns the adjoint of the solution.
fn newton(point: &mut ForcedPoint<'_>, u: &mut [f64], omega: f64) -> Result<Adjoint> {
    let mut last = f64::INFINITY;
    for _ in 0..HELD_SLIDERS_ITERATIONS {
        let adjoint = adjoint_at(point, u, omega)?;
        let residual = norm(point.residual()) / point.scale();
        if residual < RESIDUAL || (residual < HELD_SLIDERS_ENOUGH && residual > 0.5 * last) {
            return Ok(adjoint);
        }
        if !residual.is_finite() {
            break;
        }
        last = residual;
        for (u, step) in u.iter_mut().zip(&point.newton_step()?) {
            *u += step;
        }
    }
    fail!(NoConvergence, "no solution was found where a slider is held")
}

/// Corrects the frequency to that of the peak; returns the adjoint at the peak.
fn to_peak(point: &mut ForcedPoint<'_>, u: &mut [f64], omega: &mut f64, first: Adjoint) -> Result<Adjoint> {
    let mut adjoint = first;
    let mut settled = f64::INFINITY;
    for _ in 0..HELD_SLIDERS_CORRECTIONS {
        let (_, curvature) = peak_row(point, u, *omega, &adjoint)?;
        if curvature.is_nan() || curvature >= 0.0 {
            return fail!(NoConvergence, "the peak vanishes where a slider is held");
        }
        // The matrix of the point again.
        adjoint = adjoint_at(point, u, *omega)?;
        let change = -adjoint.by_omega / curvature;
        settled = (change / *omega).abs();
        if settled < HELD_SLIDERS_SETTLED {
            break;
        }
        let tangent = point.tangent(*omega)?;
        for (u, t) in u.iter_mut().zip(&tangent) {
            *u += change * t;
        }
        *omega += change;
        adjoint = newton(point, u, *omega)?;
    }
    if settled > HELD_SLIDERS_NEARLY {
        return fail!(
            NoConvergence,
            "the frequency of the peak does not settle where a slider is held"
        );
    }
    Ok(adjoint)
}
