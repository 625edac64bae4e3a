//! Messages on standard error: sentences, or a line of JSON for each event.

use crate::texts::arguments::LogForm;
use serde_json::{Map, Value, json};
use std::io::{Write, stderr};
use std::path::Path;
use std::sync::OnceLock;
use std::time::Instant;

/// Form of the messages, and the start of the command.
static LOG: OnceLock<(LogForm, Instant)> = OnceLock::new();

/// Chooses the form of the messages, once.
pub fn start(form: LogForm) {
    let _ = LOG.set((form, Instant::now()));
}

/// Whether messages are lines of JSON.
pub fn are_json() -> bool {
    LOG.get().is_some_and(|(form, _)| *form == LogForm::Json)
}

/// Tells an error, or why a run ended early.
pub fn error(sentence: &str) {
    message("error", "", sentence);
}

/// Tells a warning.
pub fn warning(sentence: &str) {
    message("warning", "warning: ", sentence);
}

fn message(event: &str, before: &str, sentence: &str) {
    if are_json() {
        line(event, json!({ "message": sentence }));
    } else {
        let _ = writeln!(stderr(), "hbvib: {before}{sentence}");
    }
}

/// Tells a file that was written; as text the summary names it.
pub fn wrote(path: &Path) {
    line("wrote", json!({ "path": path.display().to_string() }));
}

/// Writes a line of JSON, where messages have that form: the event, the seconds since the start and what belongs to the event.
pub fn line(event: &str, of: Value) {
    let Some((LogForm::Json, start)) = LOG.get() else {
        return;
    };
    let mut all = Map::new();
    all.insert("event".into(), event.into());
    all.insert("seconds".into(), json!(start.elapsed().as_secs_f64()));
    if let Value::Object(of) = of {
        all.extend(of);
    }
    let _ = writeln!(stderr(), "{}", Value::Object(all));
}
