//! The arithmetic that this code is compiled for: rounding to nearest, no traps, small numbers kept. A
//! host may run with another one: traps on overflow (gfortran -ffpe-trap), small numbers flushed to zero
//! (-ffast-math), another rounding. At the border its control word (on x86 with the flags in it) is laid aside
//! and put back, so that no trap fires inside, results do not depend on the host's settings, and the host
//! finds everything as it was.

/// Control word of the thread's floating-point unit.
#[derive(Clone, Copy)]
pub(super) struct Arithmetic(u64);

impl Arithmetic {
    /// The library's own.
    pub(super) const DEFAULT: Self = Self(unit::DEFAULT);

    /// The state that calls find, and their callbacks again.
    pub(super) fn of_the_host() -> Self {
        Self(unit::read())
    }

    /// Enters the library's own.
    pub(super) fn enter() {
        Self::DEFAULT.restore();
    }

    /// Puts the state back.
    pub(super) fn restore(self) {
        unit::write(self.0);
    }
}

#[cfg(target_arch = "x86_64")]
mod unit {
    use core::arch::asm;

    /// MXCSR after a reset: all traps masked, rounding to nearest, nothing flushed to zero.
    pub const DEFAULT: u64 = 0x1F80;

    pub fn read() -> u64 {
        let mut word = 0_u32;
        unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut word, options(nostack, preserves_flags)) };
        u64::from(word)
    }

    pub fn write(word: u64) {
        let word = word as u32;
        unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const word, options(nostack, preserves_flags, readonly)) };
    }
}

#[cfg(target_arch = "aarch64")]
mod unit {
    use core::arch::asm;

    /// FPCR after a reset; the flags stand in another register, which nothing here traps on.
    pub const DEFAULT: u64 = 0;

    pub fn read() -> u64 {
        let word: u64;
        unsafe { asm!("mrs {}, fpcr", out(reg) word, options(nomem, nostack, preserves_flags)) };
        word
    }

    pub fn write(word: u64) {
        unsafe { asm!("msr fpcr, {}", in(reg) word, options(nomem, nostack, preserves_flags)) };
    }
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
mod unit {
    /// Not known how to on this machine: the host's state is used as it is.
    pub const DEFAULT: u64 = 0;

    pub fn read() -> u64 {
        DEFAULT
    }

    pub fn write(_: u64) {}
}
