//! Numbers of things in sentences.

/// 1 point, 2 points, 1 degree of freedom, 2 degrees of freedom.
pub fn counted(number: usize, one: &str) -> String {
    let (first, rest) = one.find(' ').map_or((one, ""), |end| one.split_at(end));
    let plural = if number == 1 { "" } else { "s" };
    format!("{number} {first}{plural}{rest}")
}

#[cfg(test)]
mod tests {
    use super::counted;

    #[test]
    fn one_thing_is_no_plural() {
        assert_eq!(counted(0, "force"), "0 forces");
        assert_eq!(counted(1, "degree of freedom"), "1 degree of freedom");
        assert_eq!(counted(24, "degree of freedom"), "24 degrees of freedom");
    }
}
