//! The JSON schema of a job: the committed copy is that of the structs, and it knows the keys of a job.

use serde_json::Value;
use std::path::Path;
use std::process::Command;

fn printed() -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_hbvib"))
        .arg("schema")
        .output()
        .unwrap();
    assert!(output.status.success());
    String::from_utf8(output.stdout).unwrap()
}

/// `HBVIB_WRITE_SCHEMA=1` writes the copy.
#[test]
fn the_committed_schema_is_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/job.schema.json");
    if std::env::var_os("HBVIB_WRITE_SCHEMA").is_some() {
        std::fs::write(&path, printed()).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap();
    assert!(
        committed == printed(),
        "docs/job.schema.json is not current: write it with HBVIB_WRITE_SCHEMA=1"
    );
}

#[test]
fn the_schema_refuses_unknown_keys_and_names_what_a_job_needs() {
    let schema: Value = serde_json::from_str(&printed()).unwrap();
    assert_eq!(schema["additionalProperties"], Value::Bool(false));
    assert_eq!(schema["required"], serde_json::json!(["model"]));
    for (name, part) in schema["$defs"].as_object().unwrap() {
        if part["type"] == "object" {
            assert_eq!(part["additionalProperties"], Value::Bool(false), "{name}");
        }
    }
    // The folder of the job is no key of it.
    assert!(schema["properties"].get("folder").is_none());
    assert_eq!(
        schema["$defs"]["KindName"]["enum"],
        serde_json::json!([
            "jenkins",
            "friction_2d",
            "friction_3d",
            "unilateral",
            "cubic",
            "regularised"
        ])
    );
    assert_eq!(
        schema["$defs"]["ForcedPart"]["required"],
        serde_json::json!(["from_hz", "to_hz"])
    );
}
