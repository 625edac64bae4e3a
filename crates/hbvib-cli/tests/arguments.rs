//! Arguments of the command: help and version of all verbs, mistakes with exit code 1, completions that shells take, the manual page,
//! and lines of JSON for each event.

use serde_json::Value;
use std::path::PathBuf;
use std::process::{Command, Output};

fn hbvib(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hbvib"))
        .args(arguments)
        .output()
        .unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// Verbs of the help.
fn verbs() -> Vec<String> {
    let help = text(&hbvib(&["--help"]).stdout);
    let lines = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let names = lines.take_while(|line| !line.is_empty());
    names
        .map(|line| line.split_whitespace().next().unwrap().to_owned())
        .filter(|name| name != "help")
        .collect()
}

#[test]
fn every_verb_has_help_with_examples() {
    let all = verbs();
    for verb in ["run", "check", "modes", "schema", "completions", "man"] {
        assert!(all.iter().any(|name| name == verb), "{verb} is not in {all:?}");
    }
    for verb in &all {
        for arguments in [[verb.as_str(), "--help"], ["help", verb.as_str()]] {
            let output = hbvib(&arguments);
            let help = text(&output.stdout);
            assert!(output.status.success() && output.stderr.is_empty(), "{verb}");
            assert!(
                help.contains("Usage: hbvib") && help.contains("Example"),
                "{verb}: {help}"
            );
            assert!(help.contains(&format!("hbvib {verb}")), "{verb}: {help}");
        }
    }
    let help = text(&hbvib(&["--help"]).stdout);
    assert!(help.contains("Exit codes") && help.contains("Examples"));
    let version = text(&hbvib(&["--version"]).stdout);
    assert_eq!(version, format!("hbvib {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn mistakes_end_with_one_and_name_the_word() {
    for (arguments, word) in [
        (&["chek", "job.toml"][..], "'check'"),
        (&["run"], "<JOB.TOML>"),
        (&["run", "--strickt", "job.toml"], "--strict"),
        (&["completions", "tcsh"], "bash, zsh, fish"),
        (&["--log", "xml", "run", "job.toml"], "text, json"),
        (&[], "Commands:"),
    ] {
        let output = hbvib(arguments);
        let errors = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {errors}");
        assert!(
            output.stdout.is_empty() && errors.contains(word),
            "{arguments:?}: {errors}"
        );
    }
}

#[test]
fn completions_and_the_manual_page_have_all_verbs() {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("arguments");
    std::fs::create_dir_all(&folder).unwrap();
    for shell in ["bash", "zsh", "fish"] {
        let completions = text(&hbvib(&["completions", shell]).stdout);
        for verb in verbs() {
            assert!(completions.contains(&verb), "{shell} lacks {verb}");
        }
        assert!(completions.contains("strict"), "{shell}");
    }
    // bash takes its file, and completes a verb.
    let path = folder.join("hbvib.bash");
    std::fs::write(&path, hbvib(&["completions", "bash"]).stdout).unwrap();
    let script = format!(
        "source '{}'; COMP_WORDS=(hbvib ch); COMP_CWORD=1; _hbvib hbvib ch hbvib; echo \"${{COMPREPLY[@]}}\"",
        path.display()
    );
    let output = Command::new("bash").args(["-c", &script]).output().unwrap();
    assert_eq!(text(&output.stdout).trim(), "check", "{}", text(&output.stderr));
    let page = text(&hbvib(&["man"]).stdout);
    assert!(page.contains(".TH hbvib 1"));
    for verb in verbs() {
        assert!(page.contains(&format!("HBVIB {}", verb.to_uppercase())), "{verb}");
    }
    for words in ["Exit codes", "strict"] {
        assert!(page.contains(words), "{words}");
    }
}

/// The job of the ring damper with three harmonics.
fn job() -> String {
    format!(
        "{}[[contact]]\nkind = 'jenkins'\na = [2]\nb = [3]\nkt = 5e7\nmu = 0.3\npreload = 488.5\n[[force]]\ndof = 0\nvalue = 5.0\n\
         [forced]\nfrom_hz = 207.0\nto_hz = 211.0\nharmonics = 3\n[output]\ncsv = 'response.csv'\n",
        crate::common::ring_damper()
    )
}

#[test]
fn a_job_alone_is_run() {
    let (output, folder) = crate::common::hbvib("run", ("arguments", "alone"), &job());
    std::fs::remove_file(folder.join("response.csv")).unwrap();
    let alone = hbvib(&[folder.join("job.toml").to_str().unwrap()]);
    assert!(alone.status.success(), "{}", text(&alone.stderr));
    assert_eq!(alone.stdout, output.stdout);
    assert!(folder.join("response.csv").is_file());
}

#[test]
fn every_event_is_a_line_of_json() {
    let (plain, folder) = crate::common::hbvib("run", ("arguments", "json"), &job());
    let path = folder.join("job.toml");
    let output = hbvib(&["run", "--log", "json", path.to_str().unwrap()]);
    assert!(output.status.success());
    assert_eq!(output.stdout, plain.stdout, "the summary is the same");
    let events: Vec<Value> = text(&output.stderr)
        .lines()
        .map(|line| serde_json::from_str(line).unwrap_or_else(|e| panic!("{line}: {e}")))
        .collect();
    let of = |name: &str| events.iter().filter(|e| e["event"] == name).collect::<Vec<_>>();
    assert_eq!(events[0]["event"], "start");
    assert_eq!(events.last().unwrap()["exit_code"], 0);
    let points = text(&std::fs::read(folder.join("response.csv")).unwrap())
        .lines()
        .count()
        - 1;
    assert!(
        of("point").len() >= points && points > 10,
        "{} of {points}",
        of("point").len()
    );
    assert_eq!(of("point").last().unwrap()["fraction_done"], 1.0);
    let wrote = of("wrote");
    assert!(wrote.len() == 1 && wrote[0]["path"].as_str().unwrap().ends_with("response.csv"));
    // Stages come before the first point.
    let first = events.iter().position(|e| e["event"] == "point").unwrap();
    assert!(
        events[..first]
            .iter()
            .any(|e| e["event"] == "stage" && e["stage"] == "first point")
    );
    let seconds: Vec<f64> = events.iter().map(|e| e["seconds"].as_f64().unwrap()).collect();
    assert!(seconds.is_sorted());

    // An error, a warning and wrong arguments are events, too.
    std::fs::write(&path, job().replace("stiffness.mtx", "none.mtx")).unwrap();
    for arguments in [
        &["--log", "json", "run", path.to_str().unwrap()][..],
        &["fly", "--log=json"],
    ] {
        let output = hbvib(arguments);
        assert_eq!(output.status.code(), Some(1));
        let last: Vec<Value> = text(&output.stderr)
            .lines()
            .map(|line| serde_json::from_str(line).unwrap())
            .collect();
        let [.., error, end] = &last[..] else {
            panic!("{last:?}")
        };
        assert!(error["event"] == "error" && end["exit_code"] == 1, "{last:?}");
    }
}

#[test]
fn modes_and_check_need_no_analysis() {
    let job = job().replace("[forced]\nfrom_hz = 207.0\nto_hz = 211.0\nharmonics = 3\n", "");
    let (output, _) = crate::common::hbvib("modes", ("arguments", "modes"), &job);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(text(&output.stdout).lines().count(), 1 + 13 * 4);
    let (output, _) = crate::common::hbvib("check", ("arguments", "check"), &job);
    assert!(output.status.success() && text(&output.stdout).contains("names no analysis"));
    let (output, _) = crate::common::hbvib("run", ("arguments", "run"), &job);
    assert!(output.status.code() == Some(1) && text(&output.stderr).contains("names no analysis"));
}
