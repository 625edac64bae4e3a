//! Strict command lines of flags with values: an unknown argument is refused by its name.
#![allow(dead_code, reason = "each example uses a part of this module")]

use std::ffi::OsString;
use std::fmt::Write;
use std::path::PathBuf;
use std::str::FromStr;

/// A flag that a program knows.
#[derive(Clone, Copy, Debug)]
pub struct Flag {
    /// Name with its dashes.
    pub name: &'static str,
    /// Placeholder of its value in the help; empty for a flag without value.
    pub value: &'static str,
    /// Whether it may be given more than once.
    pub repeatable: bool,
    /// One line for the help.
    pub help: &'static str,
}

impl Flag {
    /// A flag that may be given once.
    pub const fn new(name: &'static str, value: &'static str, help: &'static str) -> Self {
        Self {
            name,
            value,
            repeatable: false,
            help,
        }
    }

    /// The same flag, which may be given repeatedly.
    pub const fn repeatable(self) -> Self {
        Self {
            repeatable: true,
            ..self
        }
    }
}

/// The flags that were given, with their values still as text.
#[derive(Debug, Default)]
pub struct Flags {
    given: Vec<(&'static str, OsString)>,
}

impl Flags {
    /// Reads the arguments of a program, without the name of the program.
    ///
    /// # Errors
    ///
    /// A sentence naming the argument that is unknown, lacks its value or is repeated.
    pub fn read(arguments: impl IntoIterator<Item = OsString>, known: &[Flag]) -> Result<Self, String> {
        let mut given: Vec<(&'static str, OsString)> = Vec::new();
        let mut arguments = arguments.into_iter();
        while let Some(argument) = arguments.next() {
            let Some(flag) = known.iter().find(|flag| argument == flag.name) else {
                return Err(format!("unknown argument {}", argument.display()));
            };
            if !flag.repeatable && given.iter().any(|g| g.0 == flag.name) {
                return Err(format!("{} is given twice", flag.name));
            }
            let value = if flag.value.is_empty() {
                OsString::new()
            } else {
                let value = arguments
                    .next()
                    .filter(|v| !v.is_empty() && known.iter().all(|k| v != k.name));
                value.ok_or_else(|| format!("{} needs a value: {} {}", flag.name, flag.name, flag.value))?
            };
            given.push((flag.name, value));
        }
        Ok(Self { given })
    }

    /// Whether no flag was given at all.
    pub fn is_empty(&self) -> bool {
        self.given.is_empty()
    }

    /// Whether a flag was given.
    pub fn has(&self, name: &str) -> bool {
        self.given.iter().any(|g| g.0 == name)
    }

    /// The first flag given of those in `known`.
    pub fn first_of(&self, known: &[Flag]) -> Option<&'static str> {
        let mut names = self.given.iter().map(|g| g.0);
        names.find(|name| known.iter().any(|k| k.name == *name))
    }

    /// The value of a flag as a path.
    pub fn path(&self, name: &str) -> Option<PathBuf> {
        self.given.iter().find(|g| g.0 == name).map(|g| PathBuf::from(&g.1))
    }

    /// Every value of a flag in the given order; `needs` describes the check of `valid` in words.
    ///
    /// # Errors
    ///
    /// A sentence naming the flag and the value that cannot be read or is not valid.
    pub fn values<T: FromStr>(&self, name: &str, needs: &str, valid: impl Fn(&T) -> bool) -> Result<Vec<T>, String> {
        let texts = self.given.iter().filter(|g| g.0 == name).map(|g| &g.1);
        let read = |text: &OsString| text.to_str().and_then(|t| t.parse().ok()).filter(&valid);
        texts
            .map(|text| read(text).ok_or_else(|| format!("{name} {}: needs {needs}", text.display())))
            .collect()
    }

    /// A finite number above 0 that is given at most once.
    ///
    /// # Errors
    ///
    /// As [`Self::values`].
    pub fn positive(&self, name: &str) -> Result<Option<f64>, String> {
        self.value(name, "a finite number above 0", is_positive)
    }

    /// A finite number of at least 0 that is given at most once.
    ///
    /// # Errors
    ///
    /// As [`Self::values`].
    pub fn amount(&self, name: &str) -> Result<Option<f64>, String> {
        self.value(name, "a finite number of at least 0", |x: &f64| {
            x.is_finite() && *x >= 0.0
        })
    }

    /// The value of a flag that is given at most once.
    ///
    /// # Errors
    ///
    /// As [`Self::values`].
    pub fn value<T: FromStr>(&self, name: &str, needs: &str, valid: impl Fn(&T) -> bool) -> Result<Option<T>, String> {
        Ok(self.values(name, needs, valid)?.pop())
    }
}

/// Whether a number is finite and above 0.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "what Flags::values takes")]
pub fn is_positive(x: &f64) -> bool {
    x.is_finite() && *x > 0.0
}

/// The flags as a table for the help.
pub fn table(known: &[Flag]) -> String {
    let left = |flag: &Flag| format!("{} {}", flag.name, flag.value);
    let width = known.iter().map(|flag| left(flag).len()).max().unwrap_or(0);
    known.iter().fold(String::new(), |mut text, flag| {
        // Writing into a string cannot fail.
        let _ = writeln!(text, "  {:width$}  {}", left(flag), flag.help);
        text
    })
}
