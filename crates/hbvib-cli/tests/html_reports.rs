//! The report of a run: one page without links to other places, whose figures and tables are those of the run.

use std::path::{Path, PathBuf};
use std::process::Command;

fn python() -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../.venv/bin/python");
    if own.exists() { own } else { "python3".into() }
}

/// Every element is closed in its order, figures are XML, and nothing is loaded from elsewhere.
const READ: &str = "
import html.parser, re, sys, xml.etree.ElementTree as tree
text = open('report.html', encoding='utf-8').read()
empty = {'meta'}
class Reader(html.parser.HTMLParser):
    def __init__(self):
        super().__init__(); self.open = []; self.count = {}
    def handle_starttag(self, tag, attributes):
        assert tag not in ('script', 'link', 'img', 'iframe'), tag
        assert not any(name in ('src', 'href') or (value or '').startswith('http') and name != 'xmlns' for name, value in attributes)
        self.count[tag] = self.count.get(tag, 0) + 1
        if tag not in empty: self.open.append(tag)
    def handle_startendtag(self, tag, attributes):
        self.count[tag] = self.count.get(tag, 0) + 1
    def handle_endtag(self, tag):
        assert self.open.pop() == tag, (tag, self.open)
reader = Reader(); reader.feed(text); reader.close()
assert not reader.open, reader.open
figures = re.findall(r'<svg.*?</svg>', text, flags=re.S)
for figure in figures: tree.fromstring(figure)
assert '@import' not in text and 'url(' not in text
print(len(figures), reader.count['table'], reader.count['h2'])
";

fn run(name: &str, job: &str) -> (String, String, PathBuf) {
    let (output, folder) = crate::common::hbvib("run", ("html_reports", name), job);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{errors}");
    let page = std::fs::read_to_string(folder.join("report.html")).unwrap();
    let read = Command::new(python())
        .args(["-c", READ])
        .current_dir(&folder)
        .output()
        .unwrap();
    assert!(read.status.success(), "{}", String::from_utf8_lossy(&read.stderr));
    let counts = String::from_utf8_lossy(&read.stdout).trim().to_owned();
    println!("{}", String::from_utf8_lossy(&output.stdout));
    (page, counts, folder)
}

#[test]
fn the_report_holds_the_run_in_one_page() {
    let job = format!(
        "# <a job> & its \"report\"\n{}[[contact]]\nname = '<ring>'\nkind = 'jenkins'\na = [2]\nb = [3]\nkt = 5e7\nmu = 0.3\npreload = 488.5\n\
         [[force]]\ndof = 0\nvalue = 5.0\n[[force]]\ndof = 1\nvalue = 5.0\n\
         [forced]\nfrom_hz = 207.0\nto_hz = 211.0\nharmonics = 3\nat_hz = [208.0]\n[output]\nreport = 'report.html'\ncsv = 'a.csv'\nunits.length = 'm'\n",
        crate::common::ring_damper()
    );
    let (page, counts, folder) = run("ring", &job);
    // Response, slip and one loop; points and contacts; without a mesh there is no picture of it.
    assert_eq!(counts, "3 2 6");
    assert!(page.contains("# &lt;a job&gt; &amp; its") && !page.contains("<ring>") && page.contains("&lt;ring&gt;"));
    assert!(page.contains("amplitude, m"));
    // The peak of the table is at least as high as all points of the curve, and the requested frequency is there.
    let cells = |name: &str| -> Vec<f64> {
        let row = page.split(&format!("<tr><td>{name}</td><td>")).nth(1).unwrap();
        let row = row.split("</td></tr>").next().unwrap();
        row.split("</td><td>").map(|x| x.parse().unwrap()).collect()
    };
    let csv = std::fs::read_to_string(folder.join("a.csv")).unwrap();
    let highest = csv
        .lines()
        .skip(1)
        .map(|row| row.split(',').nth(1).unwrap().parse().unwrap())
        .fold(0.0, f64::max);
    let peak = cells("peak");
    assert!(
        peak[1] >= highest * (1.0 - 1e-6) && peak[1] < 1.01 * highest,
        "{peak:?} {highest}"
    );
    assert!((cells("requested")[0] - 208.0).abs() < 1e-9);
    // A Jenkins contact has a constant load.
    let ring = cells("&lt;ring&gt;");
    assert!(
        ring[0].abs() > 0.0 && ring[1] > 0.0 && ring[2] == 0.0 && (ring[4] - 488.5).abs() < 0.1,
        "{ring:?}"
    );
}

#[test]
fn a_mesh_shows_its_contacts() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let data = data.display();
    let job = format!(
        "[model]\nmatrices = '{data}/beam.sti'\nmesh = '{data}/beam.inp'\nrayleigh = [0.0, 1e-7]\n[[contact]]\nkind = 'friction_3d'\n\
         normal = [0, -1, 0]\nkt = 1e6\nkn = 1e6\nmu = 0.3\npreload = 1.0\n[contact.nodes]\na = [2]\nb = [8]\nlargest_distance = 1.0\n\
         [[force]]\ndof = '3.1'\nvalue = 1.0\n[forced]\nfrom_hz = 100.0\nto_hz = 200.0\nharmonics = 1\n[output]\nreport = 'report.html'\n"
    );
    let (page, counts, _) = run("beam", &job);
    assert_eq!(counts, "4 2 7");
    for node in [2, 8] {
        assert!(page.contains(&format!("<title>node {node}: slip ")), "{node}");
    }
    // Every node is drawn, and those of the contact once more.
    let picture = page.split("Contacts on the mesh").nth(1).unwrap();
    assert_eq!(
        picture.split("</svg>").next().unwrap().matches("<circle").count(),
        24 + 2
    );
}
