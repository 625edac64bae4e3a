//! How many cases of a kind a test runs: some of every kind with each change, all of them in `tests/deep.sh`, which sets `HBVIB_THOROUGH`.

/// Whether all cases are asked for.
pub fn thorough() -> bool {
    std::env::var_os("HBVIB_THOROUGH").is_some()
}

/// `all` cases where they are asked for, otherwise `some`.
pub fn some_of<T>(some: T, all: T) -> T {
    if thorough() { all } else { some }
}
