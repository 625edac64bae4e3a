//! The ends of a band over many sliders in a plane are motions in time: twenty nodes on friction in a plane, of which half stick,
//! integrated step by step by the test, because the library does not integrate friction in a plane.

use crate::bands_of_many_sliders::{NODE_CONTACT, NODE_DAMPING, node_forces, node_friction, node_stiffness, nodes};
use crate::common::{all_harmonics, harmonics, solve_at};
use hbvib::{BandOptions, Hooks, band};
use num_complex::Complex64;
use std::f64::consts::TAU;

const NODES: usize = 20;
const OMEGA: f64 = 1.35;

/// Harmonic 1 of motion 0 in time, the largest drag of a slider that is given, and how many nodes stick through the last period.
struct InTime {
    amplitude: f64,
    dragged: f64,
    stuck: usize,
}

/// Velocity Verlet with a return to the disc of the limit, from a motion and the places of the sliders that are given by
/// (node, direction). These are held until the others have forgotten theirs.
fn in_time(motion: &[Complex64], sliders: &[(usize, usize)], places: &[f64], steps: usize) -> InTime {
    const PERIODS: usize = 240;
    const HELD: usize = 160;
    let n = 3 * NODES;
    let (stiffness, (kt, kn)) = (node_stiffness(NODES), NODE_CONTACT);
    let dt = TAU / OMEGA / steps as f64;
    let rows = || motion.chunks_exact(n).enumerate();
    let mut x: Vec<f64> = (0..n).map(|i| rows().map(|(_, row)| row[i].re).sum()).collect();
    let mut v: Vec<f64> = (0..n)
        .map(|i| rows().map(|(h, row)| -(h as f64) * OMEGA * row[i].im).sum())
        .collect();
    let mut slider = [[0.0; 2]; NODES];
    let mut is_given = [false; NODES];
    for (&(node, k), &place) in sliders.iter().zip(places) {
        (slider[node][k], is_given[node]) = (place, true);
    }
    let given = slider;
    let mut slipped = [false; NODES];
    let mut a = vec![0.0; n];
    let mut first = Complex64::ZERO;
    let mut half = vec![0.0; n];
    let forces = node_forces(NODES);
    for step in 0..=steps * PERIODS {
        let t = dt * step as f64;
        let (is_held, is_last) = (step < steps * HELD, step > steps * (PERIODS - 1));
        if step > 0 {
            for i in 0..n {
                half[i] = v[i] + 0.5 * dt * a[i];
                x[i] += dt * half[i];
                // The velocity that the forces see.
                v[i] = half[i] + 0.5 * dt * a[i];
            }
        } else {
            half.copy_from_slice(&v);
        }
        for (i, (a, row)) in a.iter_mut().zip(stiffness.chunks_exact(n)).enumerate() {
            let elastic: f64 = row.iter().zip(&x).map(|(k, x)| k * x).sum();
            *a = -elastic - NODE_DAMPING * v[i];
        }
        for (dof, force) in &forces {
            a[*dof] += (force * Complex64::from_polar(1.0, OMEGA * t)).re;
        }
        for node in 0..NODES {
            let (mu, preload) = node_friction(node);
            let load = (preload - kn * x[3 * node + 2]).max(0.0);
            let mut pull = [0, 1].map(|k| kt * (x[3 * node + k] - slider[node][k]));
            let size = pull[0].hypot(pull[1]);
            if size > mu * load && !(is_held && is_given[node]) {
                pull = pull.map(|p| p * mu * load / size);
                slider[node] = [0, 1].map(|k| x[3 * node + k] - pull[k] / kt);
                slipped[node] |= is_last;
            }
            a[3 * node] -= pull[0];
            a[3 * node + 1] -= pull[1];
            a[3 * node + 2] += load;
        }
        if step > 0 {
            for i in 0..n {
                v[i] = half[i] + 0.5 * dt * a[i];
            }
        }
        if is_last {
            first += x[0] * Complex64::from_polar(2.0 / steps as f64, -OMEGA * t);
        }
    }
    let drag = |node: usize| (slider[node][0] - given[node][0]).hypot(slider[node][1] - given[node][1]);
    InTime {
        amplitude: first.norm(),
        dragged: (0..NODES).filter(|n| is_given[*n]).map(drag).fold(0.0, f64::max),
        stuck: slipped.iter().filter(|s| !**s).count(),
    }
}

#[test]
#[ignore = "a minute: the band of twenty nodes with nine harmonics, and integration in time"]
fn the_ends_of_twenty_nodes_are_motions_in_time() {
    let model = nodes(NODES);
    let solver = harmonics(9);
    let branch = solve_at(&model, &solver, OMEGA);
    let options = BandOptions {
        starts: 1,
        ..BandOptions::default()
    };
    let found = band(&model, &branch, 0, &solver, &options, &mut Hooks::default()).unwrap();
    let (lower, upper) = (&found.lower, &found.upper);
    let width = upper.value - lower.value;
    println!("{} free, {} .. {}", found.sliders.len(), lower.value, upper.value);
    assert!(found.is_complete && found.sliders.len() >= 20);
    for (end, other) in [(lower, upper), (upper, lower)] {
        let motion = all_harmonics(end.branch.as_ref().unwrap(), 0);
        let there = in_time(&motion, &found.sliders, &end.places, 4000);
        println!(
            "{} in time {}, dragged by {:.1e}, {} stick, {} at the limit",
            end.value,
            there.amplitude,
            there.dragged,
            there.stuck,
            end.at_limit.len()
        );
        // Nine harmonics leave an end beyond a limit by a little, which drags its slider.
        assert!((there.amplitude - end.value).abs() < 0.02 * width && there.dragged < 1e-3);
        // A state just within is kept.
        let mix = |(own, other): (&f64, &f64)| 0.95 * own + 0.05 * other;
        let places: Vec<f64> = end.places.iter().zip(&other.places).map(mix).collect();
        let mut placed = model.try_clone().unwrap();
        for ((contact, k), place) in found.sliders.iter().zip(&places) {
            placed.set_slider(*contact, *k, *place).unwrap();
        }
        let within = solve_at(&placed, &solver, OMEGA);
        let there = in_time(&all_harmonics(&within, 0), &found.sliders, &places, 4000);
        let value = within.amplitude()[0];
        println!(
            "{value} in time {}, dragged by {:.1e}, {} stick",
            there.amplitude, there.dragged, there.stuck
        );
        assert!((there.amplitude - value).abs() < 0.02 * width && there.dragged < 1e-9);
        assert!(there.stuck >= 10);
    }
}
