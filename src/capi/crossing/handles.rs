//! Handles: numbers with the type of a pointer. A handle holds the slot of its object in the one table,
//! the generation and the type, and it is looked up before anything is read, so that a freed, foreign or
//! random handle is an error and never an access to memory.
//!
//! The table is locked for the look-up alone. While a call uses an object, the slot counts its readers or
//! notes its one writer; freeing or changing it meanwhile is `HBVIB_E_BUSY`.

use crate::error::{Error, Result, Status, reserved, try_push};
use crate::model::Model;
use crate::results::Branch;
use crate::studies::batch::Batch;
use core::cell::UnsafeCell;
use core::ops::{Deref, DerefMut};
use std::sync::{Mutex, MutexGuard, PoisonError};

#[cfg(not(target_pointer_width = "64"))]
compile_error!("handles need pointers of 64 bits");

/// Bits of a handle from the top: 12 magic, 4 type, 24 generation, 24 slot. The magic makes it an
/// address that no process can have.
const MAGIC: u64 = 0xB5A;
const SLOT_BITS: u32 = 24;
const GENERATION_BITS: u32 = 24;
const MAX_SLOTS: usize = 1 << SLOT_BITS;
const MAX_GENERATION: u32 = (1 << GENERATION_BITS) - 1;

/// Number of readers that represents one writer.
const WRITER: u32 = u32::MAX;

/// End of the list of free slots.
const NONE: u32 = u32::MAX;

/// A branch, and a number that only its queries need.
pub(crate) struct KeptBranch {
    pub branch: Branch,
    /// Number of exact frequencies, or amplitudes of a mode, that were requested.
    pub requested: usize,
    /// Handles of its children, which are freed with it.
    pub children: Vec<usize>,
    /// Whether it is a child itself.
    pub is_child: bool,
}

/// Content of a slot. The one-element vectors are boxes whose memory can be reserved fallibly.
pub(crate) enum Object {
    Free { next: u32 },
    Model(Vec<Model>),
    Branch(Vec<KeptBranch>),
    Batch(Vec<Batch>),
}

struct Slot {
    generation: u32,
    users: u32,
    object: Object,
}

struct Table {
    slots: Vec<Slot>,
    free: u32,
}

static TABLE: Mutex<Table> = Mutex::new(Table {
    slots: Vec::new(),
    free: NONE,
});

/// First generation of a slot: another number in each copy of the library that a process has
/// loaded, so that a handle of one copy is invalid in another.
fn first_generation() -> u32 {
    1 + ((&raw const TABLE).addr() >> 12 & 0x3F_FFFF) as u32
}

fn table() -> MutexGuard<'static, Table> {
    TABLE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Frees the memory of the table where no handle is alive: the library is being unloaded.
pub(crate) fn release() {
    if let Ok(mut table) = TABLE.try_lock()
        && table
            .slots
            .iter()
            .all(|slot| matches!(slot.object, Object::Free { .. }))
    {
        table.slots = Vec::new();
        table.free = NONE;
    }
}

/// The lock of the table while the process is copied.
struct Held(UnsafeCell<Option<MutexGuard<'static, Table>>>);

// Only the thread that holds the lock uses it.
unsafe impl Sync for Held {}

static HELD: Held = Held(UnsafeCell::new(None));

/// Holds the table, so that no other thread changes it, before the process is copied.
pub(crate) fn hold() {
    let guard = table();
    // SAFETY: this thread holds the lock.
    unsafe { *HELD.0.get() = Some(guard) };
}

/// Lets go of the table, in both processes.
pub(crate) fn let_go() {
    // SAFETY: this thread, or the one whose copy it is, holds the lock.
    drop(unsafe { (*HELD.0.get()).take() });
}

/// A type of object to which handles refer.
pub(crate) trait Kept: Sized {
    /// The opaque type of the header.
    type Opaque;
    /// Type bits of the handle.
    const TAG: u64;
    /// "model"
    const NAME: &'static str;
    /// Puts the object into a slot.
    fn wrap(object: Vec<Self>) -> Object;
    /// The object of a slot, if it is of this type.
    fn pick(object: &mut Object) -> Option<*mut Self>;
    /// Whether the slot has an object of this type.
    fn holds(object: &Object) -> bool;
}

/// Puts an object into the table and returns its handle.
pub(crate) fn insert<T: Kept>(object: T) -> Result<*mut T::Opaque> {
    let mut one = Vec::new();
    reserved(&one.try_reserve_exact(1), T::NAME)?;
    one.push(object);
    let mut table = table();
    if table.free == NONE {
        if table.slots.len() >= MAX_SLOTS {
            return Err(Error::out_of_memory("another handle"));
        }
        let slot = Slot {
            generation: first_generation(),
            users: 0,
            object: Object::Free { next: NONE },
        };
        try_push(&mut table.slots, slot, "another handle")?;
        table.free = (table.slots.len() - 1) as u32;
    }
    let number = table.free;
    let slot = &mut table.slots[number as usize];
    let generation = slot.generation;
    if let Object::Free { next } = core::mem::replace(&mut slot.object, T::wrap(one)) {
        table.free = next;
    }
    let bits = MAGIC << 52 | T::TAG << 48 | u64::from(generation) << SLOT_BITS | u64::from(number);
    Ok(core::ptr::without_provenance_mut(bits as usize))
}

impl Table {
    /// The slot of a live handle.
    fn find<T: Kept>(&mut self, handle: *const T::Opaque, argument: i32) -> Result<&mut Slot> {
        let bits = handle.addr() as u64;
        let refuse = |why: &str| {
            Err(Error::new(
                Status::Handle,
                format_args!("argument {argument} is not the handle of a {}: {why}", T::NAME),
            )
            .in_argument(argument))
        };
        if handle.is_null() {
            return refuse("it is NULL");
        }
        if bits >> 52 != MAGIC {
            return refuse("it was never returned by this library");
        }
        if bits >> 48 & 0xF != T::TAG {
            return refuse("it is of another type");
        }
        let number = bits as usize & (MAX_SLOTS - 1);
        let generation = (bits >> SLOT_BITS) as u32 & MAX_GENERATION;
        match self.slots.get_mut(number) {
            Some(slot) if slot.generation == generation && T::holds(&slot.object) => Ok(slot),
            _ => refuse("it was freed, or never returned by this library"),
        }
    }

    /// The slot of a handle that is in use, and so cannot have been freed.
    fn in_use(&mut self, handle: usize) -> Option<&mut Slot> {
        self.slots.get_mut(handle & (MAX_SLOTS - 1))
    }
}

fn busy<T: Kept, R>(argument: i32) -> Result<R> {
    Err(Error::new(
        Status::Busy,
        format_args!(
            "the {} is in use by a running call; wait until that call has returned",
            T::NAME
        ),
    )
    .in_argument(argument))
}

/// An object borrowed for reading; others may read it too.
pub(crate) struct Reading<T> {
    handle: usize,
    object: *const T,
}

/// Borrows an object for reading.
pub(crate) fn read<T: Kept>(handle: *const T::Opaque, argument: i32) -> Result<Reading<T>> {
    let mut table = table();
    let slot = table.find::<T>(handle, argument)?;
    if slot.users >= WRITER - 1 {
        return busy::<T, _>(argument);
    }
    let Some(object) = T::pick(&mut slot.object) else {
        return busy::<T, _>(argument);
    };
    slot.users += 1;
    Ok(Reading {
        handle: handle.addr(),
        object,
    })
}

impl<T> Deref for Reading<T> {
    type Target = T;

    fn deref(&self) -> &T {
        // The counted reader keeps the object from being freed or changed.
        unsafe { &*self.object }
    }
}

impl<T> Drop for Reading<T> {
    fn drop(&mut self) {
        if let Some(slot) = table().in_use(self.handle) {
            slot.users -= 1;
        }
    }
}

/// An object borrowed for changing; nobody else may touch it.
pub(crate) struct Writing<T> {
    handle: usize,
    object: *mut T,
}

/// Borrows an object for changing.
pub(crate) fn write<T: Kept>(handle: *mut T::Opaque, argument: i32) -> Result<Writing<T>> {
    let mut table = table();
    let slot = table.find::<T>(handle, argument)?;
    if slot.users != 0 {
        return busy::<T, _>(argument);
    }
    let Some(object) = T::pick(&mut slot.object) else {
        return busy::<T, _>(argument);
    };
    slot.users = WRITER;
    Ok(Writing {
        handle: handle.addr(),
        object,
    })
}

impl<T> Deref for Writing<T> {
    type Target = T;

    fn deref(&self) -> &T {
        unsafe { &*self.object }
    }
}

impl<T> DerefMut for Writing<T> {
    fn deref_mut(&mut self) -> &mut T {
        // The noted writer keeps everybody else out.
        unsafe { &mut *self.object }
    }
}

impl<T> Drop for Writing<T> {
    fn drop(&mut self) {
        if let Some(slot) = table().in_use(self.handle) {
            slot.users = 0;
        }
    }
}

/// Frees objects at once; none where one of them is in use.
pub(crate) fn free_all<T: Kept>(handles: &[usize], argument: i32) -> Result<()> {
    let mut objects = Vec::new();
    reserved(&objects.try_reserve_exact(handles.len()), T::NAME)?;
    let mut guard = table();
    for handle in handles {
        if guard.find::<T>(core::ptr::without_provenance(*handle), argument)?.users != 0 {
            return busy::<T, _>(argument);
        }
    }
    for handle in handles {
        let free = guard.free;
        let slot = guard.find::<T>(core::ptr::without_provenance(*handle), argument)?;
        objects.push(core::mem::replace(&mut slot.object, Object::Free { next: free }));
        slot.generation += 1;
        if slot.generation < MAX_GENERATION {
            guard.free = (handle & (MAX_SLOTS - 1)) as u32;
        }
    }
    drop(guard);
    drop(objects);
    Ok(())
}

/// Frees an object; NULL is accepted and does nothing.
pub(crate) fn free<T: Kept>(handle: *mut T::Opaque, argument: i32) -> Result<()> {
    if handle.is_null() {
        return Ok(());
    }
    let mut guard = table();
    let free = guard.free;
    let slot = guard.find::<T>(handle, argument)?;
    if slot.users != 0 {
        return busy::<T, _>(argument);
    }
    let object = core::mem::replace(&mut slot.object, Object::Free { next: free });
    slot.generation += 1;
    // A slot whose generations are used up is never used again.
    if slot.generation < MAX_GENERATION {
        guard.free = (handle.addr() & (MAX_SLOTS - 1)) as u32;
    }
    drop(guard);
    drop(object);
    Ok(())
}
