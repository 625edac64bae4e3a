//! A job in a locale with a decimal comma has the outputs of one without it, to the byte.

use crate::comma_locale;
use std::path::Path;
use std::process::Command;

#[test]
fn a_decimal_comma_changes_no_table_and_no_figure() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("decimal_comma");
    let _ = std::fs::remove_dir_all(&folder);
    let locales = comma_locale::locale(&folder);
    let job = crate::common::ring_damper()
        + "[[contact]]\nkind = 'jenkins'\na = [2]\nb = [3]\nkt = 5e7\nmu = 0.3\npreload = 488.5\n\
           [[force]]\ndof = 0\nvalue = 5.0\n[forced]\nfrom_hz = 207.0\nto_hz = 211.0\n\
           [output]\ncsv = 'response.csv'\nfigure = 'response.svg'\n";
    let outputs = ["C", comma_locale::NAME].map(|name| {
        let own = folder.join(name);
        std::fs::create_dir_all(&own).unwrap();
        std::fs::write(own.join("job.toml"), &job).unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_hbvib"))
            .args(["run", "job.toml"])
            .current_dir(&own)
            .env("LC_ALL", name)
            .env("LOCPATH", &locales)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        ["response.csv", "response.svg"].map(|file| std::fs::read(own.join(file)).unwrap())
    });
    assert_eq!(outputs[0], outputs[1]);
    assert!(outputs[0][0].len() > 1000);
}
