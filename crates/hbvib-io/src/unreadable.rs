//! Files of formats that are not read, known by their first bytes or their extension: a sentence says which format it is, and
//! how to export another one.

use crate::ansys_full;
use std::path::Path;

/// Names the format of a file that is not read; `None` for one that may be.
pub(crate) fn format(path: &Path, start: &[u8]) -> Option<String> {
    let extension = path
        .extension()
        .and_then(|e| e.to_str())
        .unwrap_or("")
        .to_ascii_lowercase();
    let matlab = "save it by save -v7 or -v7.3 (scipy.io.savemat writes that), or as Matrix Market (mmwrite)";
    let sentence = if start.starts_with(b"MATLAB 7.3") {
        // With the feature it is read.
        "a MATLAB file of version 7.3 (HDF5), which is read where this was built with the feature hdf5: build it so, or save the file by \
         save -v7"
            .into()
    } else if start.starts_with(b"\x89HDF") {
        format!("an HDF5 file without the head of MATLAB's version 7.3, which is not read: {matlab}")
    } else if start.starts_with(b"MATLAB") || (extension == "mat" && !is_text(start)) {
        format!("a MATLAB file (.mat) without the head of version 5, which is not read: {matlab}")
    } else if let Some(kind) = ansys_full::kind(start) {
        let name = match kind {
            2 => "element matrices (.emat)",
            8 => "a superelement (.sub)",
            12 => "results (.rst)",
            _ => "no assembled matrices",
        };
        format!(
            "an Ansys binary file with {name}, which is not read: write its matrices by *SMAT or *DMAT and *EXPORT with MMF (Matrix \
             Market), or those of the model by HBMAT with FORM = ASCII (Harwell-Boeing)"
        )
    } else if extension == "full" {
        "no Ansys .full file by its head, which is not read: write its matrices by HBMAT with FORM = ASCII (Harwell-Boeing), \
         or by *EXPORT with MMF (Matrix Market)"
            .into()
    } else if matches!(extension.as_str(), "sim" | "odb") {
        "a binary file of Abaqus, which is not read: write the matrices by *MATRIX OUTPUT, FORMAT=MATRIX INPUT (job_STIF1.mtx, \
         job_MASS1.mtx)"
            .into()
    } else if extension == "op4" && start.iter().take(4).any(|b| *b == 0) {
        "a binary OP4 file whose head is not one of words of four bytes, which is not read: write it with FORM = FORMATTED"
            .into()
    } else if is_universal(start) {
        "a universal file (UFF), which has shapes and nodes (hbvib_io::read_universal) and no matrices that are read: write these as OP4 \
         or Matrix Market"
            .into()
    } else if extension == "op2" {
        "a Nastran OP2 file, which is not read: write the matrices by OUTPUT4 with ASSIGN OUTPUT4 = 'file.op4', FORM = \
         FORMATTED"
            .into()
    } else {
        return None;
    };
    Some(sentence)
}

fn is_text(start: &[u8]) -> bool {
    core::str::from_utf8(start).is_ok() && !start.contains(&0)
}

/// Whether the first line is the mark of a universal file.
fn is_universal(start: &[u8]) -> bool {
    let line = start.split(|byte| *byte == b'\n').next().unwrap_or(&[]);
    core::str::from_utf8(line).is_ok_and(|line| line.trim() == "-1")
}
