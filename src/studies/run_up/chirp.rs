//! The forces of a run-up: a phase whose frequency changes at a constant rate between two frequencies, constant before and behind.

use std::f64::consts::TAU;

/// Phase and frequency of the forces over the time of a run-up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chirp {
    start: f64,
    stop: f64,
    /// Rate dω/dt, with its sign.
    rate: f64,
    duration: f64,
    last_phase: f64,
}

impl Chirp {
    /// A chirp between two angular frequencies, both > 0, at |dω/dt| > 0.
    pub fn new(start: f64, stop: f64, rate: f64) -> Self {
        let rate = if stop < start { -rate } else { rate };
        let duration = (stop - start) / rate;
        Self {
            start,
            stop,
            rate,
            duration,
            last_phase: duration * 0.5 * (start + stop),
        }
    }

    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Number of turns of the forces within the chirp.
    pub fn turns(&self) -> f64 {
        self.last_phase / TAU
    }

    /// Angular frequency at a time.
    pub fn omega(&self, time: f64) -> f64 {
        if time >= self.duration {
            self.stop
        } else {
            self.start + self.rate * time.max(0.0)
        }
    }

    /// Rate of the frequency at a time; 0 before and after the chirp.
    pub fn rate(&self, time: f64) -> f64 {
        if (0.0..self.duration).contains(&time) {
            self.rate
        } else {
            0.0
        }
    }

    /// Phase at a time; 0 at the beginning of the chirp.
    pub fn phase(&self, time: f64) -> f64 {
        if time <= 0.0 {
            self.start * time
        } else if time < self.duration {
            time * (self.start + 0.5 * self.rate * time)
        } else {
            self.last_phase + self.stop * (time - self.duration)
        }
    }

    /// Time at which the forces have a phase.
    pub fn time(&self, phase: f64) -> f64 {
        if phase <= 0.0 {
            phase / self.start
        } else if phase < self.last_phase {
            let square = self.start * self.start + 2.0 * self.rate * phase;
            2.0 * phase / (self.start + square.max(0.0).sqrt())
        } else {
            self.duration + (phase - self.last_phase) / self.stop
        }
    }
}
