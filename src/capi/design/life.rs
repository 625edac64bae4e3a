//! Section "Design studies" of the header: wear of contacts over a life.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{Range, check_pointer, count, disjoint, input, optional, output, put};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::read;
use crate::capi::crossing::outcome::Outcome;
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out, init, load};
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_hooks};
use crate::capi::solving::solve_options::{hbvib_solver_options, solver_options};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, Status, fail, try_push};
use crate::model::Model;
use crate::options::{Duty, LIFE_MOST_STEPS, LIFE_TOLERANCE, LifeFollow, LifeOptions, Wear};
use crate::studies::{self, Life, LifeEventKind};
use core::ptr;

/// Vibration that wears contacts.
#[repr(C)]
pub enum hbvib_life_follow {
    /// Steady states of given frequencies, forces and shares of the time.
    HBVIB_LIFE_DUTIES = 0,
    /// The peak of the response, as it moves.
    HBVIB_LIFE_PEAK = 1,
}

/// Events of a life.
#[repr(C)]
pub enum hbvib_life_event {
    /// A contact begins to slip.
    HBVIB_LIFE_SLIPS = 0,
    /// A contact ends to slip.
    HBVIB_LIFE_STICKS = 1,
    /// A contact loses its load.
    HBVIB_LIFE_LOST = 2,
    /// A contact gets load again.
    HBVIB_LIFE_PRESSED = 3,
    /// The amplitude passes the limit.
    HBVIB_LIFE_LIMIT = 4,
    /// The motion that was followed ends, as at a fold, or its peak does: the amplitude jumps.
    HBVIB_LIFE_JUMPS = 5,
}

/// Options of hbvib_life. Fill it by hbvib_life_options_init, then set contacts and vibration.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_life_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// A value of enum hbvib_life_follow; default HBVIB_LIFE_DUTIES.
    pub follow: i32,
    /// Contacts that wear, contacts_len numbers; their laws have a normal load.
    pub contacts: *const i64,
    /// Worn volume per work of friction of each of them, >= 0.
    pub rates: *const f64,
    /// Area of each of them, > 0, or NULL: 1.
    pub areas: *const f64,
    /// Number of contacts that wear, 1 .. 2000.
    pub contacts_len: i64,
    /// Static stiffness between their normals, force per depth, contacts_len x contacts_len,
    /// symmetric; NULL: the normal stiffness of each contact by itself, which its law then has.
    pub stiffness: *const f64,
    /// Depths that are worn at the beginning, contacts_len numbers >= 0; NULL: none.
    pub worn: *const f64,
    /// Angular frequencies of the duties, > 0, duties_len numbers; NULL with HBVIB_LIFE_PEAK.
    pub duty_omega: *const f64,
    /// Factors on the forces in each duty, >= 0; NULL: 1.
    pub duty_force: *const f64,
    /// Shares of the time of each duty, >= 0, relative to their sum; NULL: equal ones.
    pub duty_share: *const f64,
    /// Number of duties.
    pub duties_len: i64,
    /// First angular frequency of the range of HBVIB_LIFE_PEAK, > 0.
    pub omega_start: f64,
    /// Last one.
    pub omega_stop: f64,
    /// Error allowed of the loads, relative to the largest one at the beginning, and of the
    /// amplitude: 1e-12 .. 0.1; default 1e-4.
    pub tolerance: f64,
    /// Amplitude whose crossing is an event; default 0: none.
    pub limit: f64,
    /// Largest number of steps, >= 1; default 10000.
    pub most_steps: i64,
}

unsafe impl VersionedStruct for hbvib_life_options {
    const NAME: &'static str = "hbvib_life_options";
    const FIRST_SIZE: usize = 128;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            follow: hbvib_life_follow::HBVIB_LIFE_DUTIES as i32,
            contacts: ptr::null(),
            rates: ptr::null(),
            areas: ptr::null(),
            contacts_len: 0,
            stiffness: ptr::null(),
            worn: ptr::null(),
            duty_omega: ptr::null(),
            duty_force: ptr::null(),
            duty_share: ptr::null(),
            duties_len: 0,
            omega_start: 0.0,
            omega_stop: 0.0,
            tolerance: LIFE_TOLERANCE,
            limit: 0.0,
            most_steps: LIFE_MOST_STEPS as i64,
        }
    }
}

/// Fills the options of a life: no contact, no duty, a tolerance of 1e-4.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_life_options_init(o: *mut hbvib_life_options, size_of_o: usize) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// Numbers of a life. Fill it by hbvib_life_info_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_life_info {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 0.
    pub reserved: i32,
    /// Steps that were taken.
    pub steps: i64,
    /// Steady vibrations that were solved.
    pub solutions: i64,
    /// Wanted cycles that were reached.
    pub points: i64,
    /// Cycles that were reached.
    pub reached: f64,
    /// Largest amplitude over the life.
    pub largest: f64,
    /// Cycles at which it occurs.
    pub largest_at: f64,
    /// Amplitude at the beginning.
    pub amplitude_new: f64,
    /// Amplitude at the cycles that were reached.
    pub amplitude_worn: f64,
}

unsafe impl VersionedStruct for hbvib_life_info {
    const NAME: &'static str = "hbvib_life_info";
    const FIRST_SIZE: usize = 72;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            reserved: 0,
            steps: 0,
            solutions: 0,
            points: 0,
            reached: 0.0,
            largest: 0.0,
            largest_at: 0.0,
            amplitude_new: 0.0,
            amplitude_worn: 0.0,
        }
    }
}

/// Fills the numbers of a life with zeros.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_life_info_init(i: *mut hbvib_life_info, size_of_i: usize) -> hbvib_status {
    call(|| unsafe { init(i, size_of_i) })
}

/// Lists of the options of a life in the types of the library.
struct Given<'a> {
    wear: Vec<Wear>,
    duties: Vec<Duty>,
    stiffness: &'a [f64],
    worn: &'a [f64],
    options: hbvib_life_options,
}

/// Reads the options of a life, argument 3.
unsafe fn given<'a>(options: *const hbvib_life_options) -> Result<Given<'a>> {
    const CONTEXT: &str = "the options of a life";
    let o = unsafe { load(options, 3) }?;
    let n = count(o.contacts_len, 3, "contacts_len")?;
    let list = |p: *const f64, n: usize, name: &str| -> Result<&'a [f64]> {
        if p.is_null() {
            return Ok(&[]);
        }
        unsafe { input(p, n, 3, name) }
    };
    check_pointer(o.contacts, 3, "contacts")?;
    check_pointer(o.rates, 3, "rates")?;
    let contacts = unsafe { input(o.contacts, n, 3, "contacts") }?;
    let rates = list(o.rates, n, "rates")?;
    let areas = list(o.areas, n, "areas")?;
    let mut wear = Vec::new();
    for (i, (&contact, &rate)) in contacts.iter().zip(rates).enumerate() {
        let Ok(contact) = usize::try_from(contact) else {
            return fail!(Index, "contacts[{i}] = {contact}, needs a number of a contact").with_argument(3);
        };
        let area = areas.get(i).copied().unwrap_or(1.0);
        try_push(&mut wear, Wear { contact, rate, area }, CONTEXT)?;
    }
    let mut duties = Vec::new();
    if o.follow == hbvib_life_follow::HBVIB_LIFE_DUTIES as i32 {
        let m = count(o.duties_len, 3, "duties_len")?;
        check_pointer(o.duty_omega, 3, "duty_omega")?;
        let omega = list(o.duty_omega, m, "duty_omega")?;
        let (force, share) = (
            list(o.duty_force, m, "duty_force")?,
            list(o.duty_share, m, "duty_share")?,
        );
        for (i, &omega) in omega.iter().enumerate() {
            let duty = Duty {
                omega,
                force: force.get(i).copied().unwrap_or(1.0),
                share: share.get(i).copied().unwrap_or(1.0),
            };
            try_push(&mut duties, duty, CONTEXT)?;
        }
    } else if o.follow != hbvib_life_follow::HBVIB_LIFE_PEAK as i32 {
        return fail!(Argument, "follow = {}, needs 0 or 1", o.follow).with_argument(3);
    }
    if o.most_steps < 1 {
        return fail!(Argument, "most_steps = {}, needs at least 1", o.most_steps).with_argument(3);
    }
    Ok(Given {
        wear,
        duties,
        stiffness: list(o.stiffness, n.saturating_mul(n), "stiffness")?,
        worn: list(o.worn, n, "worn")?,
        options: o,
    })
}

impl Given<'_> {
    fn options<'b>(&'b self, cycles: &'b [f64]) -> LifeOptions<'b> {
        let o = &self.options;
        LifeOptions {
            wear: &self.wear,
            stiffness: self.stiffness,
            follow: if o.follow == hbvib_life_follow::HBVIB_LIFE_PEAK as i32 {
                LifeFollow::Peak {
                    omega_start: o.omega_start,
                    omega_stop: o.omega_stop,
                }
            } else {
                LifeFollow::Duties(&self.duties)
            },
            cycles,
            worn: self.worn,
            tolerance: o.tolerance,
            limit: o.limit,
            most_steps: usize::try_from(o.most_steps).unwrap_or(usize::MAX),
        }
    }
}

/// Arrays of states that the caller wants, each with its numbers a state.
struct Wanted {
    arrays: [(*mut f64, usize, i32, &'static str); 5],
}

impl Wanted {
    /// Writes the states, NaN where the life did not come.
    unsafe fn fill(&self, found: &Life, n: usize) -> Result<()> {
        for (which, &(p, each, argument, name)) in self.arrays.iter().enumerate() {
            if p.is_null() {
                continue;
            }
            let rows = unsafe { output(p, n * each, argument, name) }?;
            rows.fill(f64::NAN);
            for (row, point) in rows.chunks_exact_mut(each.max(1)).zip(&found.points) {
                match which {
                    0 => row.copy_from_slice(&point.depths),
                    1 => row.copy_from_slice(&point.loads),
                    2 => row.copy_from_slice(&point.works),
                    3 => row[0] = point.amplitude,
                    _ => row[0] = point.omega,
                }
            }
        }
        Ok(())
    }
}

/// Follows the wear of contacts over the cycles of a life. The depth that a contact has worn grows
/// per cycle by its rate times the work of friction of a cycle over its area, and the loads are
/// those of the model less stiffness times depths. Rates are those of the steady vibration under
/// the loads of the time. Steps keep the tolerance, and end where a contact begins or ends to slip
/// or loses its load. Where the motion ends, as at a fold, the life tells that and goes on with the
/// one that is found there.
///
/// model           stays as it is: it has the loads without wear.
/// solver          options, tolerance 0 or not; NULL: the defaults.
/// options         contacts, vibration, tolerance.
/// hooks           progress, called at each step with its cycles in `parameter`; phase and
///                 cancellation. NULL: none.
/// n               number of wanted cycles, >= 1.
/// cycles          wanted cycles, >= 0, in ascending order; the last is the end of the life.
/// depths          receives the worn depths, n x contacts_len, or NULL.
/// loads           receives the loads, n x contacts_len, or NULL.
/// works           receives the works of a cycle, n x contacts_len, or NULL.
/// amplitude       receives the amplitudes, n numbers, or NULL; the largest of several duties.
/// omega           receives their angular frequencies, n numbers, or NULL.
/// capacity        events that fit into each of the next arrays.
/// event_cycles    receives the cycles of the first events, or NULL.
/// event_kind      receives numbers of enum hbvib_life_event, or NULL.
/// event_contact   receives numbers of contacts, -1 for the amplitude; or NULL.
/// events          receives the number of events; or NULL.
/// info            receives the numbers of the life; fill it by hbvib_life_info_init before; or
///                 NULL.
/// A life that ends early has a positive status: HBVIB_STOPPED_STEP_TOO_SMALL where no vibration is
/// found beyond, HBVIB_STOPPED_MAX_POINTS, HBVIB_STOPPED_BY_CALLER; states beyond are NaN.
/// Errors: HBVIB_E_INDEX (contacts), HBVIB_E_ARGUMENT, HBVIB_E_DIMENSION, HBVIB_E_NOT_FINITE
/// (options, cycles, overlapping arrays), HBVIB_E_UNSUPPORTED (a contact without load, a load that
/// follows a speed tied to the frequency, a law of the caller), those of hbvib_forced_response for
/// the first vibration, HBVIB_STOPPED_NO_PEAK where that has no peak. Threads: any number on one
/// model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_life(
    model: *const hbvib_model,
    solver: *const hbvib_solver_options,
    options: *const hbvib_life_options,
    hooks: *const hbvib_hooks,
    n: i64,
    cycles: *const f64,
    depths: *mut f64,
    loads: *mut f64,
    works: *mut f64,
    amplitude: *mut f64,
    omega: *mut f64,
    capacity: i64,
    event_cycles: *mut f64,
    event_kind: *mut i64,
    event_contact: *mut i64,
    events: *mut i64,
    info: *mut hbvib_life_info,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let solver = unsafe { solver_options(solver, model.ndof()) }?;
        check_pointer(cycles, 6, "cycles")?;
        let given = unsafe { given(options) }?;
        let hooks = unsafe { load_hooks(hooks, 4) }?;
        let n = count(n, 5, "n")?;
        let cycles = unsafe { input(cycles, n, 6, "cycles") }?;
        let options = given.options(cycles);
        options
            .check(&model)
            .map_err(|e| if e.argument == 0 { e.in_argument(3) } else { e })?;
        let worn = given.wear.len();
        let wanted = Wanted {
            arrays: [
                (depths, worn, 7, "depths"),
                (loads, worn, 8, "loads"),
                (works, worn, 9, "works"),
                (amplitude, 1, 10, "amplitude"),
                (omega, 1, 11, "omega"),
            ],
        };
        let room = count(capacity, 12, "capacity")?;
        let mut ranges = Vec::new();
        for (p, each, argument, name) in wanted.arrays {
            optional((p, argument), name)?;
            try_push(
                &mut ranges,
                Range::new(p, n.saturating_mul(each), argument, name)?,
                "the arrays of a life",
            )?;
        }
        optional((event_cycles, 13), "event_cycles")?;
        optional((event_kind, 14), "event_kind")?;
        optional((event_contact, 15), "event_contact")?;
        optional((events, 16), "events")?;
        for range in [
            Range::new(event_cycles, room, 13, "event_cycles")?,
            Range::new(event_kind, room, 14, "event_kind")?,
            Range::new(event_contact, room, 15, "event_contact")?,
            Range::new(events, 1, 16, "events")?,
        ] {
            try_push(&mut ranges, range, "the arrays of a life")?;
        }
        disjoint(&[Range::new(cycles.as_ptr(), n, 6, "cycles")?], &ranges)?;
        if !info.is_null() {
            unsafe { check_out(info, 17) }?;
        }
        let found = unsafe { with_hooks(&hooks, |hooks| studies::life(&model, &solver, &options, hooks)) }?;
        unsafe {
            wanted.fill(&found, n)?;
            for (i, event) in found.events.iter().take(room).enumerate() {
                let kind = match event.kind {
                    LifeEventKind::Slips => hbvib_life_event::HBVIB_LIFE_SLIPS,
                    LifeEventKind::Sticks => hbvib_life_event::HBVIB_LIFE_STICKS,
                    LifeEventKind::Lost => hbvib_life_event::HBVIB_LIFE_LOST,
                    LifeEventKind::Pressed => hbvib_life_event::HBVIB_LIFE_PRESSED,
                    LifeEventKind::Limit => hbvib_life_event::HBVIB_LIFE_LIMIT,
                    LifeEventKind::Jumps => hbvib_life_event::HBVIB_LIFE_JUMPS,
                };
                put(event_cycles, i, event.cycles);
                put(event_kind, i, kind as i64);
                put(event_contact, i, event.contact.map_or(-1, |contact| contact as i64));
            }
            put(events, 0, found.events.len() as i64);
            if !info.is_null() {
                fill_out(info, numbers(&found));
            }
        }
        Ok(Outcome {
            status: found.status,
            reason: found.reason,
        })
    })
}

fn numbers(found: &Life) -> hbvib_life_info {
    hbvib_life_info {
        steps: found.steps as i64,
        solutions: found.solutions as i64,
        points: found.points.len() as i64,
        reached: found.reached,
        largest: found.largest.0,
        largest_at: found.largest.1,
        amplitude_new: found.ends.0,
        amplitude_worn: found.ends.1,
        ..hbvib_life_info::defaults()
    }
}

/// Loads with which the largest amplitude over a life is least. Fill it by hbvib_best_load_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_best_load {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 0.
    pub reserved: i32,
    /// Factor on the loads of the contacts that wear.
    pub factor: f64,
    /// Largest amplitude over the life with it.
    pub amplitude: f64,
    /// Amplitude of the new machine.
    pub amplitude_new: f64,
    /// Amplitude at the end of the life.
    pub amplitude_worn: f64,
    /// Lives that were followed.
    pub lives: i64,
}

unsafe impl VersionedStruct for hbvib_best_load {
    const NAME: &'static str = "hbvib_best_load";
    const FIRST_SIZE: usize = 48;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            reserved: 0,
            factor: 0.0,
            amplitude: 0.0,
            amplitude_new: 0.0,
            amplitude_worn: 0.0,
            lives: 0,
        }
    }
}

/// Fills the best loads with zeros.
///
/// b          the struct; untouched on error.
/// size_of_b  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_best_load_init(b: *mut hbvib_best_load, size_of_b: usize) -> hbvib_status {
    call(|| unsafe { init(b, size_of_b) })
}

/// Searches for the factor on the loads of the contacts that wear, as the model has them, with
/// which the largest amplitude over the life is least: as a rule that with which the new and the
/// worn machine vibrate alike. It is the lowest of the minima that nine lives over the range of
/// factors show.
///
/// model        the model with the loads of which factors are sought.
/// solver       options; NULL: the defaults.
/// options      contacts, vibration, tolerance: as of hbvib_life.
/// cycles       end of the life, > 0.
/// factor_low   least factor, > 0.
/// factor_high  largest factor.
/// hooks        progress, called after each life with its factor in `parameter`; cancellation.
///              NULL: none.
/// out          receives the factor; fill it by hbvib_best_load_init before.
/// Errors: as of hbvib_life; HBVIB_E_ARGUMENT (factors, cycles); HBVIB_E_NO_CONVERGENCE (a life
/// without a peak at its start, or one that ends early: the sentence tells the factor and why);
/// HBVIB_STOPPED_BY_CALLER. Nothing is written then. Threads: any number on one model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_best_load_for_life(
    model: *const hbvib_model,
    solver: *const hbvib_solver_options,
    options: *const hbvib_life_options,
    cycles: f64,
    factor_low: f64,
    factor_high: f64,
    hooks: *const hbvib_hooks,
    out: *mut hbvib_best_load,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let solver = unsafe { solver_options(solver, model.ndof()) }?;
        unsafe { check_out(out, 8) }?;
        let given = unsafe { given(options) }?;
        if !(cycles.is_finite() && cycles > 0.0) {
            return fail!(Argument, "cycles = {cycles}, needs a finite number > 0").with_argument(4);
        }
        let end = [cycles];
        let options = given.options(&end);
        options
            .check(&model)
            .map_err(|e| if e.argument == 0 { e.in_argument(3) } else { e })?;
        if !(factor_low.is_finite() && factor_low > 0.0) {
            return fail!(Argument, "factor_low = {factor_low}, needs a finite number > 0").with_argument(5);
        }
        if !(factor_high.is_finite() && factor_high > factor_low) {
            return fail!(
                Argument,
                "factor_high = {factor_high}, needs a finite number > factor_low = {factor_low}"
            )
            .with_argument(6);
        }
        let hooks = unsafe { load_hooks(hooks, 7) }?;
        let found = unsafe {
            with_hooks(&hooks, |hooks| {
                studies::best_load_for_life(&model, &solver, &options, (factor_low, factor_high), hooks)
            })
        }?;
        let value = hbvib_best_load {
            factor: found.factor,
            amplitude: found.amplitude,
            amplitude_new: found.new,
            amplitude_worn: found.worn,
            lives: found.lives as i64,
            ..hbvib_best_load::defaults()
        };
        unsafe { fill_out(out, value) };
        Ok(Status::Ok)
    })
}
