//! The shared library, loaded to read the defaults of its structs.

use crate::declarations::Result;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::Path;

unsafe extern "C" {
    fn dlopen(path: *const c_char, flags: c_int) -> *mut c_void;
    fn dlsym(library: *mut c_void, name: *const c_char) -> *mut c_void;
    fn dlerror() -> *const c_char;
}

const RTLD_NOW: c_int = 2;

/// A library that is never unloaded.
pub struct Library(*mut c_void);

type Init = unsafe extern "C" fn(*mut c_void, usize) -> i32;

impl Library {
    pub fn open(path: &Path) -> Result<Self> {
        let name = CString::new(path.as_os_str().as_encoded_bytes()).map_err(|e| e.to_string())?;
        let handle = unsafe { dlopen(name.as_ptr(), RTLD_NOW) };
        if handle.is_null() {
            return Err(reason());
        }
        Ok(Self(handle))
    }

    /// Calls an `_init` function on the bytes of a struct.
    pub fn init(&self, name: &str, bytes: &mut [u8]) -> Result<()> {
        let symbol = CString::new(name).map_err(|e| e.to_string())?;
        let function = unsafe { dlsym(self.0, symbol.as_ptr()) };
        if function.is_null() {
            return Err(reason());
        }
        // All functions whose names end in _init have this type.
        let function: Init = unsafe { std::mem::transmute(function) };
        let mut aligned = vec![0_u64; bytes.len().div_ceil(8)];
        let status = unsafe { function(aligned.as_mut_ptr().cast(), bytes.len()) };
        if status != 0 {
            return Err(format!("{name} returned {status} for {} bytes", bytes.len()));
        }
        let filled: Vec<u8> = aligned.iter().flat_map(|word| word.to_ne_bytes()).collect();
        bytes.copy_from_slice(&filled[..bytes.len()]);
        Ok(())
    }
}

fn reason() -> String {
    let text = unsafe { dlerror() };
    if text.is_null() {
        return "no reason known".into();
    }
    unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
}
