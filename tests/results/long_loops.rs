//! Loops of more times than are evaluated at once: each value is that of a loop of few times at the same time.

use crate::common::laws::{cases, solve};
use hbvib::{ContactLoop, Interrupt, Status};

/// Every 49th time, and twice the times of a slice and more.
const EVERY: usize = 49;
const FEW: usize = 1 << 10;

#[test]
fn a_loop_of_many_times_has_the_values_of_one_of_few() {
    for case in cases() {
        let branch = solve(&case);
        let few = branch.contact_loop(0, 0, FEW).unwrap();
        let many = branch.contact_loop(0, 0, FEW * EVERY).unwrap();
        let d = few.directions;
        assert_eq!(
            [many.motion.len(), many.force.len(), many.state.len()],
            [d * FEW * EVERY, d * FEW * EVERY, FEW * EVERY]
        );
        let close = |a: f64, b: f64, size: f64| (a - b).abs() <= 1e-13 * size;
        let sizes = [&few.motion, &few.force].map(|x| x.iter().fold(0.0_f64, |m, x| m.max(x.abs())));
        let mut differ = 0;
        for j in 0..FEW {
            for k in 0..d {
                let (a, b) = (j * d + k, j * EVERY * d + k);
                assert!(close(few.motion[a], many.motion[b], sizes[0]), "{}, {j}", case.name);
                assert!(close(few.force[a], many.force[b], sizes[1]), "{}, {j}", case.name);
            }
            differ += usize::from(few.state[j] != many.state[j * EVERY]);
        }
        // A time may fall on an event.
        assert!(differ <= 2, "{}: {differ} states differ", case.name);
    }
}

#[test]
fn one_direction_is_that_of_the_whole_loop_and_holds_what_is_wanted() {
    for case in cases() {
        let branch = solve(&case);
        let n = (1 << 14) + 3;
        let whole = branch.contact_loop(0, 0, n).unwrap();
        let d = whole.directions;
        for direction in 0..d {
            let of = |x: &[f64]| x[direction..].iter().step_by(d).copied().collect::<Vec<f64>>();
            for wanted in [
                [true; 3],
                [false, true, false],
                [true, false, false],
                [false, false, true],
            ] {
                let keep = |keep: bool, x: Vec<f64>| if keep { x } else { Vec::new() };
                let expected = ContactLoop {
                    directions: 1,
                    motion: keep(wanted[0], of(&whole.motion)),
                    force: keep(wanted[1], of(&whole.force)),
                    state: if wanted[2] { whole.state.clone() } else { Vec::new() },
                };
                let found = branch.contact_loop_along((0, 0, direction), n, wanted, &Interrupt::none());
                assert_eq!(found.unwrap(), expected, "{}, {direction}, {wanted:?}", case.name);
            }
        }
        let beyond = branch.contact_loop_along((0, 0, d), n, [true; 3], &Interrupt::none());
        assert!(beyond.is_err_and(|e| e.status == Status::Index));
    }
}
