//! Files of formats that are not read, known by their first bytes or their extension: a sentence says which format it is, and
//! how to export another one.

use std::path::Path;

/// Names the format of a file that is not read; `None` for one that may be.
pub(crate) fn format(path: &Path, start: &[u8]) -> Option<String> {
    let extension = path
        .extension()
        .and_then(|e| e.to_str())
        .unwrap_or("")
        .to_ascii_lowercase();
    let numpy = "load it by numpy.load or scipy.sparse.load_npz and pass the arrays to hbvib.Model, or write it by \
                 scipy.io.mmwrite as Matrix Market";
    let matlab =
        "write it as Matrix Market (mmwrite), or load it by scipy.io.loadmat and pass the matrices to hbvib.Model";
    let sentence = if start.starts_with(b"PK\x03\x04") {
        format!("a ZIP archive, as NumPy's .npz, which is not read: {numpy}")
    } else if start.starts_with(b"\x93NUMPY") {
        format!("a NumPy array (.npy), which is not read: {numpy}")
    } else if start.starts_with(b"MATLAB 5.0") || (extension == "mat" && !is_text(start)) {
        format!("a MATLAB file (.mat), which is not read: {matlab}")
    } else if start.starts_with(b"\x89HDF") {
        format!("an HDF5 file, as MATLAB's .mat of version 7.3, which is not read: {matlab}")
    } else if extension == "full" {
        "an Ansys binary .full file, which is not read: write its matrices by HBMAT with FORM = ASCII (Harwell-Boeing), \
         or by *EXPORT with MMF (Matrix Market)"
            .into()
    } else if matches!(extension.as_str(), "sim" | "odb") {
        "a binary file of Abaqus, which is not read: write the matrices by *MATRIX OUTPUT, FORMAT=MATRIX INPUT (job_STIF1.mtx, \
         job_MASS1.mtx)"
            .into()
    } else if extension == "op4" && start.iter().take(4).any(|b| *b == 0) {
        "a binary OP4 file whose head is not one of words of four bytes, which is not read: write it with FORM = FORMATTED"
            .into()
    } else if extension == "op2" {
        "a Nastran OP2 file, which is not read: write the matrices by OUTPUT4 with ASSIGN OUTPUT4 = 'file.op4', FORM = \
         FORMATTED"
            .into()
    } else if is_dmig(start) {
        "Nastran bulk data with DMIG, which is not read: write the matrices by EXTSEOUT(DMIGOP4=unit) or OUTPUT4 as OP4 \
         (ASSIGN OUTPUT4 ... FORMATTED, or binary)"
            .into()
    } else {
        return None;
    };
    Some(sentence)
}

fn is_text(start: &[u8]) -> bool {
    core::str::from_utf8(start).is_ok() && !start.contains(&0)
}

/// Whether the first line with data, after comments, is one of DMIG.
fn is_dmig(start: &[u8]) -> bool {
    let text = String::from_utf8_lossy(start);
    let line = text
        .lines()
        .find(|line| !line.trim().is_empty() && !line.starts_with('$'));
    line.is_some_and(|line| {
        let word = line.get(..4).unwrap_or("");
        let next = line.as_bytes().get(4);
        word.eq_ignore_ascii_case("DMIG") && next.is_none_or(|c| b" *,".contains(c))
    })
}
