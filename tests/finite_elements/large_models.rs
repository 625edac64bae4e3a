//! Structures of 20,000 to 90,000 degrees of freedom through the public calls: motion, work and memory of a response on a basis
//! against factors.

use crate::common::{all_harmonics, at_dof, harmonics, processor_time, sweep};
use crate::plate::Plate;
use hbvib::internals::{Definite, entries_of_factor};
use hbvib::{
    Contact, ContactState, Flexibility, Interrupt, MatrixKind, Model, SectorDescription, SectorFrame, SolverOptions,
    contact_evaluate,
};
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

const KT: f64 = 2e7;
const LIMIT: f64 = 0.3;
const SLIDERS: usize = 10;

/// A thick plate as one of 24 sectors: its edges y = 0 and y = 0.7 m are the faces.
fn sector(elements: [usize; 3]) -> (Plate, Model) {
    let (plate, mut model) = without_contacts(elements, 3);
    model.add_contacts(&plate.sliders(SLIDERS, KT, LIMIT)).unwrap();
    model.add_force(driven(&plate), 1, Complex64::ONE).unwrap();
    (plate, model)
}

fn driven(plate: &Plate) -> usize {
    let [nx, ny, nz] = plate.elements;
    plate.dof([nx, ny / 2, nz], 2)
}

/// The sector without sliders and forces, in the wave of another engine order.
fn without_contacts(elements: [usize; 3], engine_order: i64) -> (Plate, Model) {
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
        engine_order,
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
    (plate, model)
}

/// The motion of all degrees of freedom, harmonic after harmonic, under the excitation and the contact forces of a motion x,
/// each odd harmonic by one factorisation: as the fundamental of a wave of h times the engine order at h times the frequency.
/// A solution is its own image.
fn image_by_factors(elements: [usize; 3], (x, harmonics): (&[Complex64], usize), omega: f64) -> Vec<Complex64> {
    let (plate, _) = without_contacts(elements, 3);
    let n = plate.ndof();
    let law = Contact::jenkins(0, None, KT, LIMIT, 1.0);
    let forces: Vec<(usize, Vec<Complex64>)> = plate
        .places_of_sliders(SLIDERS)
        .into_iter()
        .map(|dof| {
            let motion: Vec<Complex64> = (0..=harmonics).map(|h| x[h * n + dof]).collect();
            let mut force = vec![Complex64::ZERO; motion.len()];
            contact_evaluate(&law, harmonics, 0, omega, &motion, &mut force, None).unwrap();
            (dof, force)
        })
        .collect();
    let mut image = vec![Complex64::ZERO; (harmonics + 1) * n];
    for h in (1..=harmonics).step_by(2) {
        let (_, mut model) = without_contacts(elements, 3 * h as i64);
        for (dof, force) in &forces {
            model.add_force(*dof, 1, -force[h]).unwrap();
        }
        if h == 1 {
            model.add_force(driven(&plate), 1, Complex64::ONE).unwrap();
        }
        let solver = SolverOptions {
            response_dof: Some(plate.corner()),
            flexibility: Flexibility::Direct,
            ..crate::common::harmonics(1)
        };
        let at = h as f64 * omega;
        let linear = all_harmonics(&sweep(&model, &solver, at, at, &[]), 0);
        image[h * n..(h + 1) * n].copy_from_slice(&linear[n..2 * n]);
    }
    image
}

/// The difference of two motions, relative to the second.
fn distance(x: &[Complex64], exact: &[Complex64]) -> f64 {
    let size = |x: &mut dyn Iterator<Item = Complex64>| x.map(|z| z.norm_sqr()).sum::<f64>().sqrt();
    size(&mut x.iter().zip(exact).map(|(a, b)| a - b)) / size(&mut exact.iter().copied())
}

/// The motion of all degrees of freedom by direct factors at two frequencies, also solved by them alone on request; the work of the preparation as a multiple of
/// factors of each wave, and memory beside the model.
fn agrees_with_direct_factors(elements: [usize; 3], (setup, beside): (f64, f64), solved_by_factors: bool) {
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
            response_dof: Some(plate.corner()),
            flexibility,
            ..crate::common::harmonics(harmonics)
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
        assert!(work < setup, "{work}");
        for at in [0.97 * omega, 1.01 * omega] {
            let x = all_harmonics(&sweep(&model, &reduced, at, at, &[]), 0);
            let n = plate.ndof();
            let image = image_by_factors(elements, (&x, harmonics), at);
            let mut off = vec![distance(&x, &image)];
            for h in (1..=harmonics).step_by(2) {
                let of = h * n..(h + 1) * n;
                off.push(distance(&x[of.clone()], &image[of]));
            }
            let told: Vec<String> = off.iter().map(|off| format!("{off:.1e}")).collect();
            println!(
                "  {:.2} Hz, all and each harmonic: {} from direct factors",
                at / TAU,
                told.join(", ")
            );
            assert!(off.iter().all(|off| *off < 1e-8), "{off:?}");
            if solved_by_factors {
                let direct = all_harmonics(&sweep(&model, &solver(Flexibility::Direct), at, at, &[]), 0);
                assert!(distance(&x, &direct) < 1e-8);
            }
        }
        assert!(most < beside, "{most}");
    }
}

#[test]
#[ignore = "a quarter of a minute; tests/deep.sh runs it"]
fn a_sector_of_thousands_of_degrees_of_freedom_agrees_with_direct_factors() {
    agrees_with_direct_factors([12, 16, 5], (f64::INFINITY, 1.5e9), true);
}

#[test]
#[ignore = "minutes; tests/deep.sh runs it"]
fn a_sector_of_89_000_degrees_of_freedom_agrees_with_direct_factors() {
    agrees_with_direct_factors([90, 82, 3], (6.0, 1.5e9), false);
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
            // By itself the size from which malloc gives freed memory back grows to that of blocks freed before.
            .env("MALLOC_MMAP_THRESHOLD_", "131072")
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
    let solver = at_dof(plate.corner(), harmonics(3));
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
