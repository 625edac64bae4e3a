"""Builds the site: the book with search, generated pages of the Python and C interfaces, notebooks of the programs in Python, the
files that pages point to, and the Rust pages where they are given. Then every link inside it is followed.

    python packaging/site/build.py FOLDER [--mdbook PROGRAM] [--rust FOLDER]

FOLDER/VERSION receives the site of this version, FOLDER/index.html leads to the newest one, FOLDER/versions.html lists all.
Needs mdbook (0.4 or 0.5), and the library for the Python pages: HBVIB_LIBRARY, or target/release."""
import argparse
import html
import html.parser
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from urllib.parse import unquote, urldefrag

import api_c
import api_python

ROOT = Path(__file__).resolve().parents[2]
LINK = re.compile(r"(!?\[[^\]]*\]\()([^)\s]+)(\))")
# Pages of the project: their place in the site, since a README.md becomes an index there, and their title.
PROJECT = {"README.md": ("read-me.md", "Read me"), "CHANGELOG.md": ("changes.md", "Changes"),
           "CONTRIBUTING.md": ("contributing.md", "Contributing"), "SECURITY.md": ("security.md", "Security"),
           "tests/README.md": ("tests.md", "Tests")}


def main() -> None:
    given = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0])
    given.add_argument("folder", type=Path)
    given.add_argument("--mdbook", default="mdbook")
    given.add_argument("--rust", type=Path, help="target/doc, as cargo doc writes it")
    options = given.parse_args()
    version = re.search(r'(?m)^version = "([^"]+)"', (ROOT / "Cargo.toml").read_text()).group(1)
    place = options.folder.resolve() / version
    with tempfile.TemporaryDirectory() as scratch:
        source = Path(scratch, "book")
        pages = gathered(source)
        chapters = [("Python", api_python.pages()), ("C", api_c.pages(ROOT / "include/hbvib.h"))]
        if options.rust is not None:
            shutil.copytree(options.rust, source / "rust")
        summary(source, chapters, options.rust is not None)
        notebooks(source, pages)
        (source / "book.toml").write_text(book_toml(version))
        # Docstrings and comments of the header have up to 120 columns.
        (source / "wide.css").write_text(":root { --content-max-width: 1050px; }\n")
        shutil.rmtree(place, ignore_errors=True)
        subprocess.run([options.mdbook, "build", str(source), "--dest-dir", str(place)], check=True)
    front(options.folder, version)
    broken = broken_links(place)
    for line in broken:
        print(line, file=sys.stderr)
    if broken:
        sys.exit(f"{len(broken)} links are broken")
    print(f"{len(list(place.rglob('*.html')))} pages in {place}, no broken link")


def gathered(source: Path) -> list[Path]:
    """Copies docs and the pages of the project; files that they point to outside go to source/. Returns the pages."""
    shutil.copytree(ROOT / "docs", source)
    origins = {path: ROOT / "docs" / path.relative_to(source) for path in source.rglob("*.md") if path.name != "SUMMARY.md"}
    (source / "project").mkdir()
    for name, (place, _) in PROJECT.items():
        copy = source / "project" / place
        copy.write_text((ROOT / name).read_text())
        origins[copy] = ROOT / name
    for page, origin in origins.items():

        def moved(match: re.Match[str], page: Path = page, origin: Path = origin) -> str:
            target, anchor = urldefrag(match[2])
            if "://" in target or not target:
                return match[0]
            path = Path(os.path.normpath(origin.parent / target))
            if not path.exists():
                return match[0]
            new = os.path.relpath(brought(source, path), page.parent)
            return match[1] + new + (f"#{anchor}" if anchor else "") + match[3]

        text = page.read_text()
        parts = re.split(r"(?ms)(^```.*?^```$)", text)
        parts[::2] = [LINK.sub(moved, part) for part in parts[::2]]
        page.write_text("".join(parts))
    return list(origins)


def brought(source: Path, path: Path) -> Path:
    """The place in the site of a file of the checkout; a folder becomes a page with its files."""
    inside = path.relative_to(ROOT)
    if str(inside) == "docs/SUMMARY.md":
        return source / "toc.html"
    if inside.parts[0] == "docs" and path.is_file():
        return source / inside.relative_to("docs")
    if str(inside) in PROJECT:
        return source / "project" / PROJECT[str(inside)][0]
    copy = source / "source" / inside
    copy.parent.mkdir(parents=True, exist_ok=True)
    if path.is_file():
        # A text is shown by a browser, which would save a file of an unknown kind.
        binary = path.suffix in (".png", ".gz", ".svg")
        copy = copy if binary else copy.with_name(copy.name + ".txt")
        shutil.copy(path, copy)
        return copy
    copy.mkdir(exist_ok=True)
    listed = copy / "files.html"
    if not listed.exists():
        listed.write_text("")
        files = sorted(file for file in path.rglob("*") if file.is_file() and "__pycache__" not in file.parts)
        rows = []
        for file in files:
            there = brought(source, file)
            rows.append(f'<li><a href="{os.path.relpath(there, copy)}">{html.escape(str(file.relative_to(path)))}</a></li>')
        listed.write_text(f"<!doctype html><meta charset=utf-8><title>{inside}</title><h1>{inside}</h1><ul>{''.join(rows)}</ul>")
    return listed


def summary(source: Path, chapters: list[tuple[str, list[tuple[str, str, str]]]], rust: bool) -> None:
    """The table of contents with the generated chapters: (name of the file, title, text) each."""
    text = (source / "SUMMARY.md").read_text() + "\n# Reference\n\n"
    for language, pages in chapters:
        for name, title, body in pages:
            path = source / "reference" / name
            path.parent.mkdir(exist_ok=True)
            path.write_text(body)
            text += f"- [{language}: {title}](reference/{name})\n"
    if rust:
        (source / "reference/rust.md").write_text(
            "# Rust\n\nThe pages of all public items: [crate hbvib](../rust/hbvib/index.html).\n")
        text += "- [Rust](reference/rust.md)\n"
    text += "\n# The project\n\n" + "".join(f"- [{title}](project/{place})\n" for place, title in PROJECT.values())
    (source / "SUMMARY.md").write_text(text)


def notebooks(source: Path, pages: list[Path]) -> None:
    """A notebook beside each page with programs in Python: its prose and its programs, which the tests of the book run."""
    for page in pages:
        text = page.read_text()
        if "```python\n" not in text:
            continue
        cells = []
        for part in re.split(r"(?ms)^(```python\n.*?^```$)", text):
            code = re.fullmatch(r"(?s)```python\n(.*)```", part)
            lines = (code[1] if code else part).strip("\n").splitlines(keepends=True)
            if not lines:
                continue
            cell = dict(cell_type="code" if code else "markdown", id=f"cell-{len(cells)}", metadata={}, source=lines)
            cells.append(cell | (dict(execution_count=None, outputs=[]) if code else {}))
        about = dict(kernelspec=dict(name="python3", display_name="Python 3", language="python"))
        notebook = dict(cells=cells, metadata=about, nbformat=4, nbformat_minor=5)
        page.with_suffix(".ipynb").write_text(json.dumps(notebook, indent=1))
        title, _, rest = text.partition("\n")
        page.write_text(f"{title}\n\n[This page as a notebook]({page.stem}.ipynb)\n{rest}")


def book_toml(version: str) -> str:
    return (f'[book]\ntitle = "hbvib {version}"\ndescription = "Harmonic balance of vibrating structures with friction contacts"\n'
            'language = "en"\nsrc = "."\n\n[output.html]\nno-section-label = true\nadditional-css = ["wide.css"]\n\n[output.html.search]\nlimit-results = 30\n\n'
            '[output.html.print]\nenable = false\n')


def front(folder: Path, version: str) -> None:
    """The first page, which leads to the newest version, and the list of versions."""
    def order(name: str) -> list[int]:
        return [int(part) for part in re.findall(r"\d+", name)]

    versions = sorted((path.name for path in folder.iterdir() if (path / "index.html").is_file()), key=order, reverse=True)
    (folder / "index.html").write_text(
        f'<!doctype html><meta charset=utf-8><meta http-equiv=refresh content="0; url={versions[0]}/index.html">'
        f'<title>hbvib</title><a href="{versions[0]}/index.html">hbvib {versions[0]}</a>\n')
    rows = "".join(f'<li><a href="{name}/index.html">hbvib {name}</a></li>' for name in versions)
    (folder / "versions.html").write_text(f"<!doctype html><meta charset=utf-8><title>hbvib: versions</title><ul>{rows}</ul>\n")


class Anchors(html.parser.HTMLParser):
    """Links and names of a page."""

    def __init__(self) -> None:
        super().__init__()
        self.links: set[str] = set()
        self.names: set[str] = set()

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        found = dict(attributes)
        self.names.update(value for key in ("id", "name") if (value := found.get(key)))
        self.links.update(value for key in ("href", "src") if tag not in ("base",) and (value := found.get(key)))


def broken_links(place: Path) -> list[str]:
    """Links that lead to no file of the site or to no name of its page; those to other sites are not followed."""
    known: dict[Path, Anchors] = {}
    for page in place.rglob("*.html"):
        known[page] = Anchors()
        if "rust" != page.relative_to(place).parts[0]:
            known[page].feed(page.read_text(errors="replace"))
    broken = []
    for page, anchors in known.items():
        if page.name in ("404.html", "toc.html", "print.html"):  # their links are relative to where they are shown
            continue
        for link in sorted(anchors.links):
            if re.match(r"[a-z]+:|//", link):
                continue
            path, name = urldefrag(unquote(link))
            target = page if not path else Path(os.path.normpath(page.parent / path))
            if not target.exists():
                broken.append(f"{page.relative_to(place)}: {link} does not exist")
            elif name and target.suffix == ".html" and name not in known[target].names:
                broken.append(f"{page.relative_to(place)}: {link}: no such heading")
    return broken


if __name__ == "__main__":
    main()
