//! Numbers of things in sentences.

/// 1 point, 2 points, 1 degree of freedom, 2 degrees of freedom, 2 nonlinear modes, 2 quantities.
pub fn counted(number: usize, one: &str) -> String {
    // The word before "of" or "over" has the plural, else the last one.
    let end = [" of ", " over "].iter().filter_map(|word| one.find(word)).min();
    let (first, rest) = end.map_or((one, ""), |end| one.split_at(end));
    match first.strip_suffix('y') {
        _ if number == 1 => format!("1 {one}"),
        Some(stem) => format!("{number} {stem}ies{rest}"),
        None => format!("{number} {first}s{rest}"),
    }
}

#[cfg(test)]
mod tests {
    use super::counted;

    #[test]
    fn one_thing_is_no_plural() {
        assert_eq!(counted(0, "force"), "0 forces");
        assert_eq!(counted(1, "degree of freedom"), "1 degree of freedom");
        assert_eq!(counted(24, "degree of freedom"), "24 degrees of freedom");
        assert_eq!(counted(2, "nonlinear mode"), "2 nonlinear modes");
        assert_eq!(counted(1, "quantity"), "1 quantity");
        assert_eq!(counted(3, "quantity"), "3 quantities");
    }
}
