"""A copy of the sources in which every tuned number of the ledger can be changed at run time.

In the copy `const NAME: f64 = 0.7;` becomes `fn NAME() -> f64 { varied(17, 0.7) }`, and each use of NAME a call of it, which the unique
names of the ledger allow. So one build serves all numbers, and the shipped library has none of this. A name that stands where Rust
wants a constant (the length of an array, a pattern) is left as it is: `cargo check` tells which."""

import json
import os
import re
import shutil
import subprocess

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
_FOLDERS = ("src", "crates/numerics/src", "crates/dissection/src")
_ROW = re.compile(r"\| `([A-Z0-9_]+)` \| `(.*?)` \| tuned\b")
_DECLARED = re.compile(r"^([ \t]*)((?:pub(?:\([a-z]+\))? )?)const ([A-Z][A-Z0-9_]*): ([^=]+?) = ((?:[^;\[\]]|\[[^\[\]]*(?:\[[^\[\]]*\][^\[\]]*)*\])*);",
                       re.MULTILINE)
_LITERAL = re.compile(r"(?<![\w.])\d[\d_]*(?:\.[\d_]+)?(?:e[+-]?\d+)?(?![\w.])")

#: The numbers that a run reads, and the one that it changes: HBVIB_VARIED=17:0.5. HBVIB_READ names a file of the numbers read.
_RUNTIME = """//! Numbers that a run may change.
#![allow(missing_docs)]
use std::io::Write;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

static CHOSEN: OnceLock<(usize, f64, Option<String>)> = OnceLock::new();
static READ: [AtomicBool; COUNT] = [const { AtomicBool::new(false) }; COUNT];

fn chosen() -> &'static (usize, f64, Option<String>) {
    CHOSEN.get_or_init(|| {
        let text = std::env::var("HBVIB_VARIED").unwrap_or_default();
        let (which, factor) = text.split_once(':').unwrap_or(("", ""));
        let which = which.parse().unwrap_or(usize::MAX);
        (which, factor.parse().unwrap_or(1.0), std::env::var("HBVIB_READ").ok())
    })
}

pub trait Varied: Copy {
    fn times(self, factor: f64) -> Self;
}

macro_rules! varied {
    ($($kind:ty),*) => { $(impl Varied for $kind {
        fn times(self, factor: f64) -> Self { (self as f64 * factor).round() as $kind }
    })* };
}

varied!(u8, u32, u64, usize, i32, i64);

// The double of a share or a cosine above one half would be none: half of its distance from one is left instead.
impl Varied for f64 {
    fn times(self, factor: f64) -> Self {
        if factor > 1.0 && (0.5..1.0).contains(&self) { 1.0 - (1.0 - self) / factor } else { self * factor }
    }
}

#[inline]
pub fn varied<T: Varied>(index: usize, value: T) -> T {
    let (which, factor, record) = chosen();
    if let Some(path) = record
        && !READ[index].swap(true, Ordering::Relaxed)
        && let Ok(mut file) = std::fs::OpenOptions::new().append(true).create(true).open(path)
    {
        let _ = writeln!(file, "{index}");
    }
    if *which == index { value.times(*factor) } else { value }
}
"""


def tuned():
    """Names of the tuned numbers in the order of the ledger, each with its room."""
    found, room = {}, ""
    with open(os.path.join(ROOT, "docs/thresholds.md"), encoding="utf-8") as page:
        for line in page:
            match = _ROW.match(line)
            if line.startswith("## "):
                room = line[3:].strip()
            elif match:
                found[match.group(1)] = room
    return found


def _sources(folder):
    for base in _FOLDERS:
        for where, _, files in os.walk(os.path.join(folder, base)):
            for name in files:
                if name.endswith(".rs"):
                    yield os.path.join(where, name)


def _uses(code, names, called):
    """Calls in place of names, outside of comments, strings and imports."""
    pattern = re.compile(r"//[^\n]*|\"(?:[^\"\\]|\\[\s\S])*\"|\b(?:pub(?:\([a-z]+\))? )?use [^;]*;|(?<!')\b([A-Z][A-Z0-9_]*)\b(?!\s*\()")

    def call(match):
        name = match.group(1)
        if name not in names:
            return match.group(0)
        called.add(name)
        return f"{name}()"

    return pattern.sub(call, code)


def _instrument(text, path, numbers, functions):
    """One file with the numbers as functions; `functions` are constants that are made of them."""
    home = "crate" if "crates/" in path else "hbvib_numerics"
    names = numbers.keys() | functions

    def declare(match):
        indent, public, name, kind, value = match.groups()
        if name not in names:
            return match.group(0)
        if name in numbers:
            def vary(expression):
                return f"{home}::varied::varied({numbers[name]}, {expression})"
            value = vary(value) if kind[0] not in "([" else _LITERAL.sub(lambda literal: vary(literal.group(0)), value)
        return f"{indent}{public}fn {name}() -> {kind} {{ {value} }}"

    head, mark, tests = text.partition("\n#[cfg(test)]\nmod ")
    pieces, last = [], 0
    for match in _DECLARED.finditer(head):
        pieces.append(_uses(head[last:match.start()], names, set()))
        declared = declare(match)
        before, brace, body = declared.partition("{") if declared != match.group(0) else (declared, "", "")
        pieces.append(before + brace + _uses(body, names, set()) if brace else declared)
        last = match.end()
    pieces.append(_uses(head[last:], names, set()))
    return "".join(pieces) + mark + tests


def _derived(texts, names):
    """Constants whose values are made of these."""
    found = set()
    while True:
        more = {match.group(3) for text in texts for match in _DECLARED.finditer(text)
                if match.group(3) not in names | found
                and set(re.findall(r"\b[A-Z][A-Z0-9_]*\b", match.group(5))) & (names | found)}
        if not more:
            return found
        found |= more


def copy(folder):
    """Copies the sources to a folder and makes the numbers functions; those that must stay constants are left out. Returns the others:
    name to index, and the indices as they are written."""
    os.makedirs(folder, exist_ok=True)
    for name in ("Cargo.toml", "Cargo.lock", "build.rs", "cbindgen.toml", "README.md", "src", "crates", "include", "docs", "tests", "benches",
                 "examples", "fuzz"):
        source, target = os.path.join(ROOT, name), os.path.join(folder, name)
        if os.path.isdir(source):
            shutil.copytree(source, target, dirs_exist_ok=True, ignore=shutil.ignore_patterns("target", ".venv*", "__pycache__"))
        elif os.path.exists(source):
            shutil.copy(source, target)
    numbers = {name: i for i, name in enumerate(tuned())}
    originals = {path: _read(path) for path in _sources(folder)}
    for path, text in originals.items():
        if path.endswith("src/lib.rs"):
            originals[path] = "#![allow(non_snake_case)]\n" + text
    left = {}
    for _ in range(12):
        functions = _derived(originals.values(), set(numbers))
        for path, text in originals.items():
            _write(path, _instrument(text, path, numbers, functions))
        _runtime(folder, max(numbers.values()) + 1)
        wrong = _refused(folder, numbers, functions, originals)
        if not wrong:
            break
        for name in wrong:
            left[name] = numbers.pop(name, None)
    else:
        raise SystemExit("the copy does not compile: " + ", ".join(sorted(left)))
    with open(os.path.join(folder, "numbers.json"), "w", encoding="utf-8") as file:
        json.dump({"numbers": numbers, "constants": sorted(left)}, file)
    return numbers, sorted(left)


def _runtime(folder, count):
    _write(os.path.join(folder, "crates/dissection/src/varied.rs"), _RUNTIME.replace("COUNT", str(count)))
    for crate, line in (("dissection", "pub mod varied;"), ("numerics", "pub use hbvib_dissection::varied;")):
        path = os.path.join(folder, f"crates/{crate}/src/lib.rs")
        text = _read(path)
        if line not in text:
            _write(path, f"{text}\n{line}\n")


def _refused(folder, numbers, functions, originals):
    """Numbers on the lines that the compiler refuses."""
    run = subprocess.run(["cargo", "check", "--release", "--lib", "--message-format", "json"], cwd=folder, env=_environment(),
                         stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    wrong, unexplained = set(), []
    for line in run.stdout.splitlines():
        message = json.loads(line).get("message") or {}
        if message.get("level") != "error":
            continue
        lines = [piece["text"] for span in message.get("spans", []) for piece in span.get("text", [])]
        found = {name for line in lines for name in re.findall(r"\b[A-Z][A-Z0-9_]*\b", line)}
        here = found & numbers.keys()
        for name in found & functions:
            here |= _behind(name, originals, numbers.keys(), functions)
        wrong |= here
        if not here and message.get("spans"):
            unexplained.append(message.get("rendered", ""))
    if run.returncode and not wrong:
        raise SystemExit("the copy does not compile:\n" + "\n".join(unexplained) + run.stderr)
    return wrong


def _behind(name, originals, names, functions):
    """Numbers that a constant is made of."""
    found = set()
    for text in originals.values():
        for match in _DECLARED.finditer(text):
            if match.group(3) == name:
                used = set(re.findall(r"\b[A-Z][A-Z0-9_]*\b", match.group(5)))
                found |= used & names
                for other in (used & functions) - {name}:
                    found |= _behind(other, originals, names, functions)
    return found


def build(folder):
    """Compiles the copy; returns the path of the library."""
    subprocess.run(["cargo", "build", "--release", "--lib", "-p", "hbvib-c", "-p", "hbvib-io"], cwd=folder, env=_environment(), check=True)
    return os.path.join(_environment()["CARGO_TARGET_DIR"], "release/libhbvib.so")


def _environment():
    own = dict(os.environ)
    own.setdefault("HBVIB_LEDGER_TARGET", os.path.join(ROOT, "target/ledger/target"))
    return dict(own, CARGO_TARGET_DIR=own["HBVIB_LEDGER_TARGET"])


def _read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def _write(path, text):
    """Writes a file where it changes, so that what is the same is not compiled again."""
    if not os.path.exists(path) or _read(path) != text:
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
