//! Numbers as text in fields of a width, as Fortran programs write and read them.

/// Digits of a mantissa and an exponent: −1.5e-3 as ("-1.5", −3), the shortest that is read back as the same number.
fn parts(text: &str) -> (&str, i32) {
    let (mantissa, exponent) = text.split_once('e').unwrap_or((text, "0"));
    (mantissa, exponent.parse().unwrap_or(0))
}

/// As 1P,E23.16: seventeen digits, from which a number is read back to the last bit. An exponent of three digits has no letter.
pub(crate) fn e23_16(value: f64) -> String {
    let text = format!("{value:.16e}");
    let (mantissa, exponent) = parts(&text);
    let sign = if exponent < 0 { '-' } else { '+' };
    let size = exponent.unsigned_abs();
    if size < 100 {
        format!("{mantissa:>19}E{sign}{size:02}")
    } else {
        format!("{mantissa:>19}{sign}{size:03}")
    }
}

/// As many digits as a field has room for, the shortest if these are enough; with a letter for the exponent.
pub(crate) fn fitted(value: f64, width: usize, letter: char) -> String {
    let told = |text: &str| {
        let (mantissa, exponent) = parts(text);
        let point = if mantissa.contains('.') { "" } else { "." };
        format!("{mantissa}{point}{letter}{exponent:+}")
    };
    let shortest = told(&format!("{value:e}"));
    if shortest.len() <= width {
        return shortest;
    }
    // Rounding may lengthen the exponent by a digit.
    for digits in (0..=16).rev() {
        let text = told(&format!("{value:.digits$e}"));
        if text.len() <= width {
            return text;
        }
    }
    shortest
}

#[cfg(test)]
mod tests {
    use super::{e23_16, fitted};

    #[test]
    fn numbers_keep_their_digits_within_their_field() {
        for value in [0.0, 1.0, -1.5e-3, 1.0 / 3.0, -2.0e210 / 7.0, 4.5e-310, f64::MAX] {
            let text = e23_16(value);
            assert_eq!(text.len(), 23, "{text:?}");
            let sign = text.rfind(['+', '-']).unwrap();
            let (mantissa, exponent) = text.trim_end().split_at(sign);
            let plain = format!("{}e{exponent}", mantissa.trim().trim_end_matches('E'));
            assert_eq!(plain.parse::<f64>().unwrap().to_bits(), value.to_bits(), "{text}");
            // Fewer digits of the largest number may exceed it.
            for width in [16, 20].into_iter().filter(|_| value < f64::MAX) {
                let text = fitted(value, width, 'D');
                assert!(text.len() <= width && text.contains('.'), "{text}");
                let back: f64 = text.replace('D', "e").parse().unwrap();
                assert!((back - value).abs() <= 5e-9 * value.abs(), "{text} of {value}");
            }
        }
        assert_eq!(fitted(0.25, 16, 'D'), "2.5D-1");
    }
}
