//! Hysteresis loops and slip fractions of contacts as CSV, and the figures beside them.

use crate::building::built::Built;
use crate::building::built::Names;
use crate::job_file::job::{HysteresisPart, Job};
use crate::outputs::contact_figures::{loops_figure, slip_figure};
use crate::outputs::curve::Curve;
use crate::outputs::files::Files;
use crate::outputs::points::chosen;
use crate::texts::outcome::Outcome;
use hbvib::{Branch, ContactLoop, Error, Special, State};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Most times of a loop.
const MOST_SAMPLES: usize = 1_000_000;

/// Writes what the job names. A loop that cannot be evaluated at one point is told, and left out.
pub fn write(job: &Job, curve: &Curve<'_>, built: &Built, files: &mut Files<'_>) {
    let branch = curve.branch;
    let (labels, names) = (built.labels(), &built.names);
    files.write(job.output.slip_csv.as_deref(), &|path| slip_table(path, curve, &labels));
    files.write(job.output.slip_figure.as_deref(), &|path| {
        slip_figure(path, curve, &labels)
    });
    for part in &job.output.hysteresis {
        let contact = match part.contact(names) {
            Ok(contact) => contact,
            Err(e) => {
                files.fail(e);
                continue;
            }
        };
        let points = chosen(branch, part.points);
        let (loops, failed) = evaluated(branch, &points, (contact, part.samples));
        for (omega, e) in failed {
            let hertz = omega / TAU;
            files.fail(format!(
                "[[output.hysteresis]], contact \"{}\", {hertz:.6} Hz: {e}",
                part.contact
            ));
        }
        if loops.is_empty() && !points.is_empty() {
            continue;
        }
        files.write(part.csv.as_deref(), &|path| loops_table(path, &loops));
        files.write(part.figure.as_deref(), &|path| {
            loops_figure(path, &labels[contact], &loops)
        });
    }
}

/// A point with its loop.
type PointLoop = (Special, ContactLoop);

/// The loops of a contact at points, and the frequencies at which there is none, each with the reason.
fn evaluated(
    branch: &Branch,
    points: &[Special],
    (contact, samples): (usize, usize),
) -> (Vec<PointLoop>, Vec<(f64, Error)>) {
    let (mut loops, mut failed) = (Vec::new(), Vec::new());
    for &point in points {
        match branch.contact_loop(point.point, contact, samples) {
            Ok(found) => loops.push((point, found)),
            Err(e) => failed.push((point.omega, e)),
        }
    }
    (loops, failed)
}

impl HysteresisPart {
    /// Number of the contact in the model.
    ///
    /// # Errors
    /// A sentence: an unknown name, no such pair.
    pub fn contact(&self, names: &Names) -> Outcome<usize> {
        let Some((_, range)) = names.iter().find(|(name, _)| *name == self.contact) else {
            let known: Vec<&str> = names.iter().map(|(name, _)| name.as_str()).collect();
            return Err(format!(
                "[[output.hysteresis]]: contact = \"{}\" is none of {}",
                self.contact,
                known.join(", ")
            ));
        };
        if self.pair >= range.len() {
            return Err(format!(
                "[[output.hysteresis]]: pair = {}, needs 0 .. {} of contact \"{}\"",
                self.pair,
                range.len(),
                self.contact
            ));
        }
        if !(1..=MOST_SAMPLES).contains(&self.samples) {
            return Err(format!(
                "[[output.hysteresis]], contact \"{}\": samples = {}, needs 1 .. {MOST_SAMPLES}",
                self.contact, self.samples
            ));
        }
        Ok(range.start + self.pair)
    }
}

/// A row for each time of each point; motions and forces in all directions of the contact.
fn loops_table(path: &Path, loops: &[(Special, ContactLoop)]) -> Outcome<()> {
    let directions = loops.first().map_or(1, |(_, one)| one.directions);
    let mut text = String::from("frequency_hz,angle");
    for quantity in ["motion", "force"] {
        for d in 0..directions {
            let _ = write!(text, ",{quantity}_{d}");
        }
    }
    text += ",state\n";
    for (point, one) in loops {
        let rows = one
            .motion
            .chunks_exact(directions)
            .zip(one.force.chunks_exact(directions));
        for (j, ((motion, force), state)) in rows.zip(&one.state).enumerate() {
            let angle = TAU * j as f64 / one.state.len() as f64;
            let _ = write!(text, "{:.16e},{angle:.16e}", point.omega / TAU);
            for value in motion.iter().chain(force) {
                let _ = write!(text, ",{value:.16e}");
            }
            text += match state {
                State::Stick => ",stick\n",
                State::Slip => ",slip\n",
                State::Open => ",open\n",
            };
        }
    }
    fs::write(path, text).map_err(|e| e.to_string())
}

/// A row for each point of the curve, a column for each contact.
fn slip_table(path: &Path, curve: &Curve<'_>, labels: &[String]) -> Outcome<()> {
    let mut text = String::from("frequency_hz");
    for label in labels {
        let _ = write!(text, ",\"{}\"", label.replace('"', "\"\""));
    }
    text += "\n";
    let omega = curve.omega();
    for (point, omega) in omega.iter().enumerate() {
        let _ = write!(text, "{:.16e}", omega / TAU);
        for slip in curve.slip(point) {
            let _ = write!(text, ",{slip:.10e}");
        }
        text += "\n";
    }
    fs::write(path, text).map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::evaluated;
    use hbvib::{
        Call, Contact, ContactKind, ForcedOptions, Hooks, MatrixKind, MatrixView, Model, SolverOptions, Special, User,
        UserForce, forced_response,
    };
    use std::sync::{Arc, Mutex};

    /// A cubic spring that cannot be computed beyond a motion; it keeps the largest one that it was asked for.
    struct Breaking {
        beyond: f64,
        largest: Mutex<f64>,
    }

    impl UserForce for Breaking {
        fn evaluate(&self, call: &mut Call<'_>) -> i32 {
            let most = call.u.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
            if most > self.beyond {
                return 1;
            }
            let mut largest = self.largest.lock().unwrap();
            *largest = largest.max(most);
            for (j, u) in call.u.iter().enumerate() {
                call.f[j] = 0.1 * u.powi(3);
                call.df_du[j] = 0.3 * u.powi(2);
            }
            0
        }
    }

    /// The points of a sweep of an oscillator with this law, and the law.
    fn sweep(beyond: f64) -> (hbvib::Branch, Arc<Breaking>) {
        let law = Arc::new(Breaking {
            beyond,
            largest: Mutex::new(0.0),
        });
        let mut model = Model::new(1).unwrap();
        for (kind, value) in [
            (MatrixKind::Mass, 1.0),
            (MatrixKind::Damping, 0.1),
            (MatrixKind::Stiffness, 1.0),
        ] {
            model.set_matrix(kind, &MatrixView::dense(1, &[value])).unwrap();
        }
        let user = User {
            velocity: false,
            ..User::new(law.clone(), 1, 16).unwrap()
        };
        model
            .add_contact(&Contact::over(vec![0], ContactKind::User(user)))
            .unwrap();
        model.add_force(0, 1, 0.1.into()).unwrap();
        let options = SolverOptions {
            harmonics: 3,
            tolerance: 0.0,
            samples: 16,
            ..SolverOptions::default()
        };
        let range = ForcedOptions {
            omega_start: 0.7,
            omega_stop: 1.4,
            at: &[0.8, 1.05, 1.3],
            guess: None,
            responses: &[],
            together: false,
            ..ForcedOptions::default()
        };
        (
            forced_response(&model, &options, &range, &mut Hooks::default()).unwrap(),
            law,
        )
    }

    /// The solver asks for sixteen times of a period, a loop for four thousand: one of them is beyond the law at the peak.
    #[test]
    fn a_loop_that_cannot_be_evaluated_at_one_point_costs_that_of_this_point() {
        let (branch, law) = sweep(f64::INFINITY);
        let asked = *law.largest.lock().unwrap();
        let points: Vec<Special> = (0..branch.points())
            .map(|point| Special {
                point,
                omega: branch.omega()[point],
                amplitude: branch.amplitude()[point],
            })
            .chain(branch.peaks().iter().copied())
            .collect();
        let most = |point: &Special| {
            let motion = branch.contact_loop(point.point, 0, 4000).unwrap().motion;
            motion.iter().fold(0.0_f64, |most, x| most.max(x.abs()))
        };
        let mut largest: Vec<f64> = points.iter().map(most).collect();
        let beyond = largest.iter().filter(|most| **most > asked).count();
        assert!(beyond > 0, "no motion is larger between the samples");
        largest.sort_by(f64::total_cmp);
        let [second, first] = largest[largest.len() - 2..] else {
            panic!("one point")
        };
        let limit = 0.5 * (second.max(asked) + first);
        assert!(limit < first && limit > asked);

        let (branch, _) = sweep(limit);
        let (loops, failed) = evaluated(&branch, &points, (0, 4000));
        assert_eq!((loops.len(), failed.len()), (points.len() - 1, 1));
        let highest = points
            .iter()
            .max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
            .unwrap();
        assert_eq!(failed[0].0.to_bits(), highest.omega.to_bits());
        assert!(failed[0].1.to_string().contains('1'), "{}", failed[0].1);
        assert!(
            loops
                .iter()
                .all(|(point, one)| point.omega.to_bits() != highest.omega.to_bits() && one.motion.len() == 4000)
        );
    }
}
