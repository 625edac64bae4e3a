//! `hbvib demo` as a new user types it: the folder, the job that runs again, and nothing overwritten.

use crate::common::{empty_folder, printed};
use std::process::Command;

#[test]
fn a_demo_writes_its_report_and_overwrites_nothing() {
    let folder = empty_folder("demo", "first");
    let typed = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hbvib"));
        command.args(arguments).current_dir(&folder).output().unwrap()
    };
    let first = typed(&["demo"]);
    let screen = printed(&first.stdout);
    assert!(first.status.success(), "{screen}{}", printed(&first.stderr));
    assert!(screen.contains("report.html has figures and tables"), "{screen}");
    let made = folder.join("hbvib-demo");
    for name in ["response.csv", "response.svg", "loop.svg", "report.html"] {
        assert!(std::fs::metadata(made.join(name)).unwrap().len() > 1000, "{name}");
    }
    let again = typed(&["demo"]);
    assert_eq!(again.status.code(), Some(1));
    assert!(
        printed(&again.stderr).contains("is there already"),
        "{}",
        printed(&again.stderr)
    );
    assert!(typed(&["run", "hbvib-demo/job.toml"]).status.success());
}

#[test]
fn a_demo_makes_the_folders_above_its_own_or_tells_which_it_cannot_make() {
    let folder = empty_folder("demo", "deep");
    let typed = |place: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hbvib"));
        command.args(["demo", place]).current_dir(&folder).output().unwrap()
    };
    let made = typed("some/missing/folder");
    assert!(made.status.success(), "{}", printed(&made.stderr));
    assert!(folder.join("some/missing/folder/report.html").is_file());
    std::fs::write(folder.join("file"), "no folder").unwrap();
    let refused = typed("file/below/it");
    assert_eq!(refused.status.code(), Some(1));
    let said = printed(&refused.stderr);
    assert!(said.contains("file/below: no folder can be made there"), "{said}");
}
