use super::*;
use crate::condense::Reference;
use crate::condense::test_chains::long_chain;
use crate::options::SolverOptions;

#[test]
fn tables_of_the_excitation_alone_have_the_column_of_whole_ones() {
    let interrupt = Interrupt::none();
    for contacts in [1, 3] {
        let mut model = long_chain(120, contacts, (0.01, 1e-3));
        model.add_force(70, 1, Complex64::new(0.7, -0.2)).unwrap();
        model.add_force(33, 3, Complex64::new(0.0, 0.4)).unwrap();
        let options = SolverOptions {
            harmonics: 3,
            ..SolverOptions::default()
        };
        let condensed = Condensed::with_reference(&model, &options, 0.4, Some(Reference::Stuck), &interrupt).unwrap();
        let mut whole = FrequencyCache::new(&condensed, 7, 0.4.into(), &interrupt).unwrap();
        let mut alone = FrequencyCache::new(&condensed, 7, 0.4.into(), &interrupt).unwrap();
        (whole.has_slopes, alone.has_slopes) = (true, true);
        for omega in [0.4, 0.55] {
            whole.tabulate(&condensed, (omega, true), &interrupt).unwrap();
            alone.tabulate(&condensed, (omega, false), &interrupt).unwrap();
            for (i, (a, b)) in alone.current().iter().zip(whole.current()).enumerate() {
                let last = contacts * (contacts + 1);
                for (part, (a, b)) in [(&a.value, &b.value), (&a.slope, &b.slope)].into_iter().enumerate() {
                    let largest = b[last..].iter().map(|z| z.norm()).fold(0.0, f64::max);
                    for (a, b) in a[last..].iter().zip(&b[last..]) {
                        let allowed = [1e-12, 1e-10][part] * largest;
                        assert!((a - b).norm() <= allowed, "{contacts}, {i}, {part}: {a} {b}");
                    }
                    assert_eq!(largest == 0.0, !condensed.blocks()[i].has_force());
                }
                assert!(alone.current()[i].value[..last].iter().all(|z| *z == Complex64::ZERO));
            }
        }
    }
}
