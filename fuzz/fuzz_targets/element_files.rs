//! Target of cargo-fuzz.

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    hbvib_fuzz::element_files(data);
});
