//! The progress bar, on a terminal alone.

use hbvib::Progress;
use std::io::{IsTerminal, Write, stderr};

/// Characters of a full bar.
const WIDTH: usize = 30;

/// A bar on standard error, if that is a terminal. The line ends with the bar.
pub struct Bar {
    shown: bool,
}

impl Bar {
    pub fn new() -> Self {
        Self {
            shown: stderr().is_terminal(),
        }
    }

    pub fn show(&self, progress: &Progress) {
        if self.shown {
            let _ = write!(stderr(), "\r{}", line(progress.fraction_done, progress.point));
        }
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        if self.shown {
            let _ = writeln!(stderr());
        }
    }
}

fn line(done: f64, points: usize) -> String {
    let done = done.clamp(0.0, 1.0);
    let full = (done * WIDTH as f64).round() as usize;
    format!(
        "[{}{}] {:3.0} %  {points} points  ",
        "#".repeat(full),
        ".".repeat(WIDTH - full),
        100.0 * done
    )
}

#[cfg(test)]
mod tests {
    use super::{WIDTH, line};

    #[test]
    fn the_bar_has_one_width() {
        for (done, full) in [
            (-1.0, 0),
            (0.0, 0),
            (0.5, WIDTH / 2),
            (1.0, WIDTH),
            (2.0, WIDTH),
            (f64::NAN, 0),
        ] {
            let bar = line(done, 7);
            assert_eq!(bar.matches('#').count(), full, "{bar}");
            assert_eq!(bar.find(']'), Some(WIDTH + 1), "{bar}");
        }
    }
}
