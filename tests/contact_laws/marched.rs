//! Laws marched over samples: a law of rates with its derivative by the frequency.

use crate::common::plane::{OMEGA, Random, gap, largest};
use hbvib::internals::Evaluation;
use hbvib::internals::HarmonicSet;
use hbvib::internals::Hysteretic;
use hbvib::internals::HystereticEvaluator;
use hbvib::internals::March;
use hbvib::internals::Range;
use hbvib::internals::{Form, Law};
use hbvib::{Interrupt, Result};
use num_complex::Complex64;
use std::f64::consts::PI;

/// A spring and a dashpot in series beside a dashpot: z' = k v − z/T by the trapezoidal rule, f = z + c v.
#[derive(Debug)]
struct Maxwell {
    k: f64,
    time: f64,
    c: f64,
}

impl Law for Maxwell {
    fn is_odd(&self) -> bool {
        true
    }
    fn form(&self) -> Form<'_> {
        Form::Hysteretic(self)
    }
    fn linearisation_scale(&self, _: &[Range], _: f64) -> f64 {
        1.0
    }
}

impl Hysteretic for Maxwell {
    fn samples(&self, _: usize, asked: usize) -> usize {
        asked
    }
    fn states(&self) -> usize {
        1
    }
    fn uses_velocity(&self) -> bool {
        true
    }
    fn march(&self, omega: f64, samples: usize, _u: &[f64], v: &[f64], z0: &[f64], out: &mut March) -> Result<()> {
        out.clear(samples);
        let mut z = z0[0];
        let mut before = v[samples - 1];
        let half = PI / (omega * samples as f64);
        let s = half / self.time;
        for (j, now) in v.iter().enumerate().take(samples) {
            let pull = self.k * half * (before + now);
            let next = ((1.0 - s) * z + pull) / (1.0 + s);
            out.z[j] = next;
            out.dz.z[j] = (1.0 - s) / (1.0 + s);
            out.dz.v_before[j] = self.k * half / (1.0 + s);
            out.dz.v[j] = self.k * half / (1.0 + s);
            // half and s go with 1/ω.
            out.dz.omega[j] = -(s * (-z - next) + pull) / (omega * (1.0 + s));
            out.f[j] = next + self.c * now;
            out.df_dz[j] = 1.0;
            out.df_dv[j] = self.c;
            (z, before) = (next, *now);
        }
        Ok(())
    }
}

#[test]
fn a_law_of_rates_has_its_complex_stiffness_and_its_derivative_by_frequency() {
    let law = Maxwell {
        k: 2.0,
        time: 4.0,
        c: 0.3,
    };
    // Every third harmonic: the period is a third of that of ω.
    let set = HarmonicSet::excited(&[3, 6], 6, false, true, false).unwrap();
    for set in [HarmonicSet::all(3).unwrap(), set] {
        let motion = Random(9).motion(&set, 1, 1.0);
        let mut way = HystereticEvaluator::new(&set, &law, 2048).unwrap();
        let mut out = Evaluation::new(&set, 1).unwrap();
        let mut force = |omega: f64| {
            way.evaluate(&law, omega, &motion, &mut out, &Interrupt::none())
                .unwrap();
            out.clone()
        };
        let out = force(OMEGA);
        if set.base() == 1 {
            for (i, h) in set.numbers().iter().enumerate() {
                let rate = Complex64::new(0.0, *h as f64 * OMEGA);
                let stiffness = law.k * law.time * rate / (1.0 + law.time * rate) + law.c * rate;
                let error = (set.get(&out.force, i) - stiffness * set.get(&motion, i)).norm();
                assert!(error < 1e-5, "harmonic {h}: {error:.1e}");
            }
        }
        assert!(largest(&out.offset) < 1e-12 && !out.stuck);
        let h = 1e-4;
        let (up, down) = (force(OMEGA + h).force, force(OMEGA - h).force);
        let by_omega: Vec<f64> = up.iter().zip(&down).map(|(a, b)| (a - b) / (2.0 * h)).collect();
        println!("derivative by the frequency {:.1e}", gap(&by_omega, &out.by_omega));
        assert!(gap(&by_omega, &out.by_omega) < 1e-7);
    }
}

#[test]
fn too_few_samples_are_refused() {
    let set = HarmonicSet::all(5).unwrap();
    let law = Maxwell {
        k: 2.0,
        time: 4.0,
        c: 0.3,
    };
    let error = HystereticEvaluator::new(&set, &law, 10).err().unwrap();
    assert!(error.message().contains("11"), "{error}");
    assert!(HystereticEvaluator::new(&set, &law, 11).is_ok());
}
