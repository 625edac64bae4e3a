//! Structures of 20,000 to 90,000 degrees of freedom through the public calls: motion, work and memory of a response on a basis
//! against factors.

use crate::common::{all_harmonics, processor_time, sweep};
use crate::plate::Plate;
use hbvib::interrupt::Interrupt;
use hbvib::linalg::cholesky::{Definite, entries_of_factor};
use hbvib::model::Model;
use hbvib::model::linear_modes::ContactState;
use hbvib::model::sector_faces::{SectorDescription, SectorFrame};
use hbvib::model::structure::MatrixKind;
use hbvib::options::{Flexibility, SolverOptions};
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::time::Instant;

/// Bytes of a line of /proc/self/status.
fn memory(name: &str) -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with(name)).unwrap();
    1024.0 * line.split_whitespace().nth(1).unwrap().parse::<f64>().unwrap()
}

/// Seconds of processor time of this thread.
fn seconds() -> f64 {
    processor_time(Instant::now()).as_secs_f64()
}

/// Begins to measure the largest resident memory anew, without what earlier tests have freed.
fn forget_the_peak() {
    // SAFETY: it takes a number and no pointer.
    unsafe { libc::malloc_trim(0) };
    std::fs::write("/proc/self/clear_refs", "5").unwrap();
}

/// A thick plate as one of 24 sectors: its edges y = 0 and y = 0.7 m are the faces.
fn sector(elements: [usize; 3]) -> (Plate, Model) {
    let mut plate = Plate::new(elements);
    plate.size[2] = 0.05;
    let [nx, ny, nz] = elements;
    let face = |y: usize| -> Vec<Option<usize>> {
        let mut dofs = Vec::new();
        for x in 1..=nx {
            for z in 0..=nz {
                dofs.extend((0..3).map(|k| Some(plate.dof([x, y, z], k))));
            }
        }
        dofs
    };
    let n = plate.ndof();
    let mut model = Model::sector(&SectorDescription {
        ndof: n,
        sectors: 24,
        engine_order: 3,
        components: 3,
        left: &face(0),
        right: &face(ny),
        fixed: &[],
        frame: SectorFrame::Cylindrical,
        axis: [0.0, 0.0, 1.0],
        forward: true,
        coordinates: None,
    })
    .unwrap();
    plate.give_matrices(&mut model).unwrap();
    model.set_rayleigh(0.0, 1e-6).unwrap();
    model.add_contacts(&plate.sliders(10, 2e7, 0.3)).unwrap();
    model
        .add_force(plate.dof([nx, ny / 2, nz], 2), 1, Complex64::ONE)
        .unwrap();
    (plate, model)
}

/// The motion of all degrees of freedom by direct factors at two frequencies, the work of the preparation as a multiple of
/// factors of each wave, and memory beside the model.
fn agrees_with_direct_factors(elements: [usize; 3], setup: f64, beside: f64) {
    let (plate, model) = sector(elements);
    let omega = model.lowest_modes(3, ContactState::Stuck, 1).unwrap().omega[0];
    let interrupt = Interrupt::none();
    for harmonics in [1, 3] {
        let (_, model) = sector(elements);
        let waves: Vec<_> = (1..=harmonics)
            .step_by(2)
            .map(|h| [MatrixKind::Stiffness, MatrixKind::Mass].map(|k| model.structure().wave_matrix(k, h).unwrap()))
            .collect();
        let begin = seconds();
        for [k, m] in &waves {
            assert!(
                Definite::new(k, (1e-2 * omega * omega, m), &interrupt)
                    .unwrap()
                    .is_some()
            );
        }
        let factors = seconds() - begin;
        drop(waves);
        let solver = |flexibility| SolverOptions {
            tolerance: 0.0,
            harmonics,
            response_dof: Some(plate.corner()),
            flexibility,
            ..SolverOptions::default()
        };
        let reduced = solver(Flexibility::Automatic);
        forget_the_peak();
        let before = memory("VmRSS");
        let begin = seconds();
        let branch = sweep(&model, &reduced, 0.95 * omega, 1.05 * omega, &[]);
        let work = (seconds() - begin) / factors;
        let most = memory("VmHWM") - before;
        let reduction = branch.reduction();
        println!(
            "{} degrees of freedom, harmonics to {harmonics}: {} points, basis {}, certificate {:.1e}, {work:.1} times the factors \
             ({:.1} s), {:.2} GB beside the model",
            model.structure().ndof(),
            branch.points(),
            reduction.basis,
            reduction.certificate,
            factors,
            most / 1e9
        );
        assert!(reduction.basis > 0 && reduction.certificate <= 1e-8);
        assert!(work < setup && most < beside, "{work} {most}");
        for at in [0.97 * omega, 1.01 * omega] {
            let [x, exact] = [Flexibility::Automatic, Flexibility::Direct]
                .map(|flexibility| all_harmonics(&sweep(&model, &solver(flexibility), at, at, &[]), 0));
            let size = |x: &mut dyn Iterator<Item = Complex64>| x.map(|z| z.norm_sqr()).sum::<f64>().sqrt();
            let off = size(&mut x.iter().zip(&exact).map(|(a, b)| a - b)) / size(&mut exact.iter().copied());
            println!("  {:.2} Hz: {off:.1e} from direct factors", at / TAU);
            assert!(off < 1e-8, "{off:e}");
        }
    }
}

#[test]
fn a_sector_of_thousands_of_degrees_of_freedom_agrees_with_direct_factors() {
    agrees_with_direct_factors([12, 16, 5], f64::INFINITY, 1.5e9);
}

#[test]
#[ignore = "minutes; tests/deep.sh runs it"]
fn a_sector_of_89_000_degrees_of_freedom_agrees_with_direct_factors() {
    agrees_with_direct_factors([90, 82, 3], 6.0, 1.5e9);
}

/// Elements of the plate that a process of its own sweeps.
const ALONE: &str = "HBVIB_TEST_PLATE";

/// A sweep in one go; the memory counts with the matrices, and the factor is L of L Lᵀ. Every plate is swept in a process of
/// its own: memory that earlier tests have freed and the allocator keeps would count as used before.
#[test]
#[ignore = "a minute; tests/deep.sh runs it"]
fn plates_are_swept_within_the_memory_of_a_few_factors() {
    if let Ok(elements) = std::env::var(ALONE) {
        let elements: Vec<usize> = elements.split(' ').map(|x| x.parse().unwrap()).collect();
        return plate_is_swept([elements[0], elements[1], elements[2]]);
    }
    for elements in ["58 56 1", "123 121 1"] {
        let alone = std::process::Command::new(std::env::current_exe().unwrap())
            .args([
                "--exact",
                "large_models::plates_are_swept_within_the_memory_of_a_few_factors",
            ])
            .args(["--ignored", "--nocapture", "--test-threads=1"])
            .env(ALONE, elements)
            .output()
            .unwrap();
        print!("{}", String::from_utf8_lossy(&alone.stdout));
        assert!(alone.status.success(), "{}", String::from_utf8_lossy(&alone.stderr));
    }
}

fn plate_is_swept(elements: [usize; 3]) {
    let plate = Plate::new(elements);
    let before = memory("VmRSS");
    let model = plate.with_sliders(20, 2e5, 0.05).unwrap();
    // Without the matrices that the caller held until the model had its own.
    forget_the_peak();
    let solver = SolverOptions {
        tolerance: 0.0,
        harmonics: 3,
        response_dof: Some(plate.corner()),
        ..SolverOptions::default()
    };
    // The first natural frequency of either plate is 16.6 Hz.
    let omega = TAU * 16.6;
    let branch = sweep(&model, &solver, 0.8 * omega, 1.2 * omega, &[]);
    let most = memory("VmHWM") - before;
    let k = model.structure().wave_matrix(MatrixKind::Stiffness, 1).unwrap();
    let factor = 8.0 * entries_of_factor(&k).unwrap() as f64;
    println!(
        "{} degrees of freedom, {} points, basis {}, certificate {:.1e}: {:.0} MB at most, {:.2} times the factor",
        plate.ndof(),
        branch.points(),
        branch.reduction().basis,
        branch.reduction().certificate,
        most / 1e6,
        most / factor
    );
    assert!(branch.points() >= 40 && branch.reduction().basis > 0);
    assert!(most < 2.5 * factor, "{:.2}", most / factor);
}
