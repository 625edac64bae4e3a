//! The floating-point environment that this code is compiled for: rounding to nearest, no traps,
//! subnormal numbers kept. A caller may have another one: traps on overflow (gfortran -ffpe-trap),
//! subnormal numbers flushed to zero (-ffast-math), another rounding. The library runs in the default
//! environment, so that no trap fires inside and results do not depend on the settings of the caller; the
//! control word of the caller (on x86 with its flags) is restored for callbacks and on return.

/// Control word of the thread's floating-point unit.
#[derive(Clone, Copy)]
pub(crate) struct FloatEnvironment(u64);

impl FloatEnvironment {
    /// The environment of the library.
    pub(crate) const DEFAULT: Self = Self(unit::DEFAULT);

    /// The present environment: that of the caller at the start of a call or the end of a callback.
    pub(crate) fn of_the_caller() -> Self {
        Self(unit::read())
    }

    /// Sets the environment of the library.
    pub(crate) fn enter() {
        Self::DEFAULT.restore();
    }

    /// Sets this environment.
    pub(crate) fn restore(self) {
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

    /// FPCR after a reset; the flags are in another register, which causes no trap here.
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
    /// This machine is not supported: the environment of the caller is used as it is.
    pub const DEFAULT: u64 = 0;

    pub fn read() -> u64 {
        DEFAULT
    }

    pub fn write(_: u64) {}
}
