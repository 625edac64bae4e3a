//! A subharmonic curve under hard forcing, found without a guess: against an integration over many periods.

use crate::common::{harmonics, omega_range, one_mass};
use hbvib::{Contact, ContactKind, ForcedOptions, Hooks, Polynomial, VerifyOptions, forced_response, verify};
use num_complex::Complex64;

/// x″ + 0.01 x′ + 0.002 x′³ + x + 0.4 x³ = 8 cos 3.6 t moves with a third of the frequency from some starts: scipy found
/// |X⅓| = 1.10973 and |X₁| = 0.71062 from random ones.
#[test]
fn a_subharmonic_of_order_three_is_found_beside_the_response() {
    let law = Polynomial::scalar(&[0.0, 0.0, 0.4], &[0.0, 0.0, 0.002]).unwrap();
    let model = one_mass(0.01, &Contact::between(0, None, ContactKind::Polynomial(law)), 8.0);
    let range = ForcedOptions {
        at: &[3.6],
        branches: 3,
        branch_depth: 1,
        ..omega_range(3.4, 3.8)
    };
    let found = forced_response(&model, &harmonics(5), &range, &mut Hooks::default()).unwrap();
    println!("{:?}", found.searched());
    let longer = model.with_longer_period(3).unwrap();
    let mut is_there = false;
    for child in found.children() {
        let periods = child.descent().unwrap().periods;
        println!("{periods} {} {:?}", child.points(), child.status());
        for at in child.at(0).iter().filter(|_| periods == 3) {
            let mut x = vec![Complex64::ZERO; child.harmonics() + 1];
            child.harmonics_at(at.point, &mut x).unwrap();
            println!("{} {}", x[1].norm(), x[3].norm());
            if (x[1].norm() - 1.109_73).abs() < 2e-5 && (x[3].norm() - 0.710_62).abs() < 2e-5 {
                let found = verify(
                    &longer,
                    child,
                    at.point,
                    &VerifyOptions::default(),
                    &mut Hooks::default(),
                )
                .unwrap();
                is_there |= found.same;
            }
        }
    }
    assert!(is_there);
}
