//! x
mod common;
use common::*;
use hbvib::contact::Contact;
use hbvib::linalg::matrix_view::MatrixView;
use hbvib::model::Model;
use hbvib::model::structure::MatrixKind;
#[test]
fn folds() {
    let mut seed = 12345u64;
    let mut rnd = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 33) as f64 / (1u64 << 31) as f64
    };
    let mut found = 0;
    let mut bad = 0;
    for case in 0..6000 {
        let n = 1 + case % 3;
        let mut m = vec![0.0; n * n];
        let mut k = vec![0.0; n * n];
        for i in 0..n {
            m[i * n + i] = 0.05 + rnd().powi(2);
            k[i * n + i] += rnd().powi(2);
            if i > 0 {
                let s = rnd();
                k[i * n + i] += s;
                k[(i - 1) * n + i - 1] += s;
                k[i * n + i - 1] -= s;
                k[(i - 1) * n + i] -= s;
            }
        }
        let mut model = Model::new(n).unwrap();
        model.set_matrix(MatrixKind::Mass, &MatrixView::dense(n, &m)).unwrap();
        model
            .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(n, &k))
            .unwrap();
        let beta = 0.02 * rnd().powi(2);
        model.set_rayleigh(0.0, beta).unwrap();
        let nc = 1 + (rnd() * 2.0) as usize;
        let mut desc = vec![];
        for _ in 0..nc {
            let a = (rnd() * n as f64) as usize;
            let b = (rnd() * n as f64) as usize;
            let kt = 10f64.powf(2.0 * rnd() - 1.0);
            let l = 10f64.powf(2.0 * rnd() - 1.5);
            let c = Contact::jenkins(a, if a == b { None } else { Some(b) }, kt, 1.0, l);
            desc.push((a, b, kt, l));
            model.add_contact(&c).unwrap();
        }
        model.add_force(0, 1, 1.0.into()).unwrap();
        if rnd() < 0.3 {
            let h = 2 + (rnd() * 2.0) as usize;
            model.add_force(n - 1, h, (2.0 * rnd()).into()).unwrap();
        }
        let h = [1, 3, 3, 5][(rnd() * 4.0) as usize].max(3);
        let o = hbvib::options::SolverOptions {
            max_points: 3000,
            ..harmonics(h)
        };
        let r = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| sweep(&model, &o, 0.1, 4.0, &[])));
        match r {
            Ok(r) => {
                if r.status() != hbvib::error::Status::Ok {
                    bad += 1;
                    println!(
                        "case {case} {:?} {} points end {} nforces {} H {h} contacts {desc:?} folds {}",
                        r.status(),
                        r.points(),
                        r.omega().last().unwrap(),
                        model.excitation().forces().len(),
                        r.folds().len()
                    );
                }
                if !r.folds().is_empty() {
                    found += 1;
                    if found < 40 {
                        println!(
                            "FOLD case {case} n {n} H {h} {:?} m {m:?} k {k:?} beta {beta} c {desc:?} f {:?} forces {:?}",
                            r.status(),
                            r.folds().iter().map(|f| (f.omega, f.amplitude)).collect::<Vec<_>>(),
                            model.excitation().forces()
                        );
                    }
                }
            }
            Err(_) => {
                bad += 1;
                println!("case {case} error");
            }
        }
    }
    println!("found {found} bad {bad}");
}
