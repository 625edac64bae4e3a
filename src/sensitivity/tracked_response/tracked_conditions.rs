//! The equations of a followed response and their derivatives: R(u, p) = 0, with the condition of a peak, a fold or an extremum.

use crate::error::{Result, fail, try_copy, try_vec};
use crate::linalg::factors::lu::Lu;
use crate::problem::epmc::OMEGA_UNIT;
use crate::sensitivity::adjoint::{Adjoint, CONTEXT};
use crate::sensitivity::extremum_point::{ExtremumBorder, extremum_gradient, extremum_matrix};
use crate::sensitivity::fold_point::{Borders, FoldCondition, fold_gradient};
use crate::sensitivity::forced_point::ForcedPoint;
use crate::sensitivity::peak_point::peak_row;
use crate::sensitivity::sampled_model::SampledModel;
use crate::sensitivity::total_derivative::TotalDerivative;
use crate::sensitivity::tracked::Tracked;
use crate::sensitivity::tracked_response::{At, ResponsePoint, TrackedResponse};

/// A motion, in the unit of lengths of the condensed model, at a frequency and a value of the parameter.
struct Place<'b> {
    at: &'b At,
    own: &'b [f64],
    omega: f64,
    p: f64,
}

impl TrackedResponse<'_> {
    /// Evaluates the equations at one value of the parameter; returns the scale of the residual, and writes derivatives
    /// and results if `fully`.
    pub(super) fn evaluate_equations(&mut self, u: &[f64], p: f64, fully: bool, values: &mut [f64]) -> Result<f64> {
        let m = self.motions();
        let omega = self.frequency(u);
        let at = self.at(p, omega)?;
        let unit = self.length / at.condensed.length();
        let own = &self.own_motion(u, &at.condensed)?;
        let mut point = self.point(&at.condensed, omega)?;
        let (point, place) = (&mut point, &Place { at: &at, own, omega, p });
        let scale = match self.followed.kind {
            ResponsePoint::Fold => self.fold_equations(point, place, fully, values)?,
            ResponsePoint::Extremum => self.extremum_equations(point, place, fully, values)?,
            ResponsePoint::Fixed | ResponsePoint::Peak => self.peak_equations(point, place, fully, values)?,
        };
        for value in &mut values[..m] {
            *value /= unit;
        }
        // Without contacts the condition of the frequency, whose size is 1, is the only equation.
        Ok(if m == 0 { 1.0 } else { scale / unit })
    }

    /// Evaluates the equations at a fixed frequency or in a peak; returns the scale of their residual, in the unit of
    /// the condensed model.
    fn peak_equations(
        &mut self,
        point: &mut ForcedPoint<'_>,
        place: &Place<'_>,
        fully: bool,
        values: &mut [f64],
    ) -> Result<f64> {
        let &Place { at, own, omega, .. } = place;
        let m = own.len();
        let unit = self.length / at.condensed.length();
        let Some(adjoint) = point.adjoint(own, omega)? else {
            return fail!(Singular, "the response is in a fold over the frequency");
        };
        values[..m].copy_from_slice(point.residual());
        let scale = point.scale();
        let by_gauge = OMEGA_UNIT * omega / adjoint.amplitude;
        if self.is_free() {
            values[m] = adjoint.by_omega * by_gauge;
        }
        if !fully {
            return Ok(scale);
        }
        self.fill_motions(point.jacobian());
        self.last.gradient.fill(0.0);
        if self.is_free() {
            let by_omega = point.residual_by_omega(omega)?;
            let (row, curvature) = peak_row(point, own, omega, &adjoint)?;
            self.last.curvature = curvature;
            self.fill_frequency(&by_omega, &row, omega, unit, by_gauge);
            self.last.gradient[m] = adjoint.by_omega * OMEGA_UNIT * omega;
        }
        let slope = self.by_parameter(place, &adjoint)?;
        self.last.gradient[values.len()] = slope;
        (self.last.amplitude, self.last.d_amplitude) = (adjoint.amplitude, slope);
        Ok(scale)
    }

    /// Evaluates the equations in a fold; returns the scale of their residual.
    fn fold_equations(
        &mut self,
        point: &mut ForcedPoint<'_>,
        place: &Place<'_>,
        fully: bool,
        values: &mut [f64],
    ) -> Result<f64> {
        let &Place { at, own, omega, .. } = place;
        let (m, n) = (own.len(), values.len());
        let length = at.condensed.length();
        let unit = self.length / length;
        let (by_motion, amplitude) = point.amplitude(own, omega)?;
        values[..m].copy_from_slice(point.residual());
        let scale = point.scale();
        let condition = self.condition(point.jacobian(), m)?;
        values[m] = condition.value;
        if !fully {
            return Ok(scale);
        }
        self.fill_motions(point.jacobian());
        let none = try_vec(m, 0.0, CONTEXT)?;
        let partial = point.of_lambda(own, omega, amplitude, &none)?;
        let by_omega = point.residual_by_omega(omega)?;
        let g = fold_gradient(point, own, omega, length, &condition, |adjoint| {
            self.by_parameter(place, adjoint)
        })?;
        self.fill_frequency(&by_omega, &g.by_unknowns, omega, unit, 1.0);
        self.note_amplitude(place, length * amplitude.norm(), &by_motion, &partial)?;
        // The adjoint of motions, frequency and condition together.
        let mut system = Lu::new(n, 1)?;
        system.matrix().copy_from_slice(&self.unknowns.matrix);
        self.last.d_amplitude = f64::NAN;
        if system.factor(self.interrupt).is_ok() {
            let mut lambda = try_copy(&self.last.gradient[..n], CONTEXT)?;
            system.solve_transposed(&mut lambda);
            // R is in the unit of the unknowns, and the result of an adjoint motion in that of the condensed model.
            let weight = lambda.pop().unwrap_or(f64::NAN);
            for x in &mut lambda {
                *x /= self.length;
            }
            point.amplitude(own, omega)?;
            let adjoint = point.of_lambda(own, omega, amplitude, &lambda)?;
            self.last.d_amplitude = self.by_parameter(place, &adjoint)? - weight * g.by_parameter;
        }
        Ok(scale)
    }

    /// Evaluates the equations in a peak or in the minimum that meets it; returns the scale of their residual.
    fn extremum_equations(
        &mut self,
        point: &mut ForcedPoint<'_>,
        place: &Place<'_>,
        fully: bool,
        values: &mut [f64],
    ) -> Result<f64> {
        let &Place { at, own, omega, .. } = place;
        let m = own.len();
        let length = at.condensed.length();
        let unit = self.length / length;
        let (by_motion, amplitude) = point.amplitude(own, omega)?;
        values[..m].copy_from_slice(point.residual());
        let scale = point.scale();
        let none = try_vec(m, 0.0, CONTEXT)?;
        let partial = point.of_lambda(own, omega, amplitude, &none)?;
        let by_omega = point.residual_by_omega(omega)?;
        let border = ExtremumBorder {
            by_omega: &by_omega,
            by_motion: &by_motion,
            slope: partial.by_omega / length,
        };
        let condition = self.extremum_condition(point, &border, omega)?;
        values[m] = condition.value;
        if !fully {
            return Ok(scale);
        }
        self.fill_motions(point.jacobian());
        let row = extremum_gradient(point, own, omega, length, &condition, OMEGA_UNIT * omega)?;
        self.fill_frequency(&by_omega, &row, omega, unit, 1.0);
        self.note_amplitude(place, length * amplitude.norm(), &by_motion, &partial)?;
        // The amplitude does not change with the frequency there, so that its derivative is that at a fixed one.
        self.last.d_amplitude = match point.adjoint(own, omega)? {
            Some(adjoint) => self.by_parameter(place, &adjoint)?,
            None => f64::NAN,
        };
        Ok(scale)
    }

    /// Keeps the amplitude, and its change with all unknowns and the parameter one by one: where Newton's matrix is singular its
    /// adjoint at a fixed frequency does not exist.
    fn note_amplitude(
        &mut self,
        place: &Place<'_>,
        amplitude: f64,
        by_motion: &[f64],
        partial: &Adjoint,
    ) -> Result<()> {
        let m = by_motion.len();
        self.last.amplitude = amplitude;
        for (to, from) in self.last.gradient.iter_mut().zip(by_motion) {
            *to = self.length * from;
        }
        self.last.gradient[m] = partial.by_omega * OMEGA_UNIT * place.omega;
        self.last.gradient[m + 1] = self.by_parameter(place, partial)?;
        Ok(())
    }

    /// The condition of an extremum at the point linearised last.
    fn extremum_condition(
        &mut self,
        point: &ForcedPoint<'_>,
        border: &ExtremumBorder<'_>,
        omega: f64,
    ) -> Result<FoldCondition> {
        let matrix = extremum_matrix(point.jacobian(), border, OMEGA_UNIT * omega)?;
        self.condition(&matrix, border.by_motion.len() + 1)
    }

    /// The condition that a matrix of order n is singular, by the borders of the first evaluation.
    fn condition(&mut self, matrix: &[f64], n: usize) -> Result<FoldCondition> {
        let borders = match self.borders.take() {
            Some(borders) => borders,
            None => Borders::near(matrix, n, self.interrupt)?,
        };
        let at = borders.condition(matrix, self.interrupt);
        self.borders = Some(borders);
        at
    }

    /// Replaces the borders by the null vectors at a solution.
    pub(super) fn follow_borders(&mut self, point: &mut ForcedPoint<'_>, own: &[f64], omega: f64) -> Result<()> {
        if self.borders.is_none() {
            return Ok(());
        }
        let (by_motion, amplitude) = point.amplitude(own, omega)?;
        let null = if self.followed.kind == ResponsePoint::Extremum {
            let none = try_vec(own.len(), 0.0, CONTEXT)?;
            let slope = point.of_lambda(own, omega, amplitude, &none)?.by_omega / point.length();
            let by_omega = point.residual_by_omega(omega)?;
            let border = ExtremumBorder {
                by_omega: &by_omega,
                by_motion: &by_motion,
                slope,
            };
            Some(self.extremum_condition(point, &border, omega)?)
        } else {
            None
        };
        if let Some(borders) = &mut self.borders {
            let null = match null {
                Some(null) => null,
                None => borders.condition(point.jacobian(), self.interrupt)?,
            };
            borders.follow(&null)?;
        }
        Ok(())
    }

    /// Writes Newton's matrix of the motions as a part of the Jacobian.
    fn fill_motions(&mut self, jacobian: &[f64]) {
        let (m, n) = (self.motions(), self.unknowns.len());
        self.unknowns.matrix.fill(0.0);
        for (column, from) in self
            .unknowns
            .matrix
            .chunks_exact_mut(n.max(1))
            .zip(jacobian.chunks_exact(m.max(1)))
        {
            column[..m].copy_from_slice(from);
        }
    }

    /// Writes the column of the frequency, and the row of its condition, the latter times a factor.
    fn fill_frequency(&mut self, column: &[f64], row: &[f64], omega: f64, unit: f64, factor: f64) {
        let (m, n) = (self.motions(), self.unknowns.len());
        for (x, r) in self.unknowns.matrix[m * n..m * n + m].iter_mut().zip(column) {
            *x = OMEGA_UNIT * omega * r / unit;
        }
        for (k, x) in row[..m].iter().enumerate() {
            // The unknowns are in another unit than those of the condensed model.
            self.unknowns.matrix[k * n + m] = x * unit * factor;
        }
        self.unknowns.matrix[m * n + m] = row[m] * OMEGA_UNIT * omega * factor;
    }

    /// Derivative by the parameter of the result to which an adjoint motion belongs.
    fn by_parameter(&self, place: &Place<'_>, adjoint: &Adjoint) -> Result<f64> {
        let At { model, condensed } = place.at;
        let at_frequency = model.at_frequency(adjoint.omega)?;
        let solution = SampledModel {
            condensed,
            samples: self.solver.samples,
        };
        let mut total = TotalDerivative::new(model, &at_frequency, solution, adjoint, self.interrupt)?;
        let (by_parameter, _) = total.by(&self.followed.parameter)?;
        Ok(self.followed.parameter.relative_at(place.p) * by_parameter)
    }
}
