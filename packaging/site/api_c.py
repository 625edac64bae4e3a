"""Pages of the C interface, from hbvib.h: a page a section, a heading an item."""
import re
from pathlib import Path

from api_python import fenced


def pages(header: Path) -> list[tuple[str, str, str]]:
    """(name of the file, title, text) of each section."""
    text = header.read_text()
    banner = r"/\* =+\n \* ([^\n]*)\n(?: \*[^\n]*\n)*? \* =+ \*/\n"
    parts = re.split(banner, text)
    opening = re.sub(r"(?m)^(/\*| \*/?) ?", "", parts[0].partition("*/")[0]).strip()
    found = [("c-conventions.md", "conventions", f"# C: conventions\n\n```text\n{opening}\n```\n")]
    for title, body in zip(parts[1::2], parts[2::2]):
        name = re.sub(r"[^a-z]+", "-", title.partition(":")[0].lower()).strip("-")
        short = title.partition(":")[0]
        found.append((f"c-{name}.md", short, f"# C: {title}\n\n" + "\n".join(items(body))))
    return found


def items(body: str) -> list[str]:
    """Heading, description and declaration of each item of a section."""
    found = []
    for match in re.finditer(r"(?m)((?:^///[^\n]*\n)+)((?:^(?!///|$|#)[^\n]*\n|^  ///[^\n]*\n)+)", body):
        doc = "\n".join(line[3:].removeprefix(" ") for line in match[1].splitlines())
        code = match[2].replace("HBVIB_NODISCARD\n", "").strip()
        named = re.search(r"\b(hbvib_\w+)\(", code) if code.startswith(("hbvib_status ", "int", "uint", "const", "size_t")) else None
        named = named or re.search(r"(hbvib_\w+);\s*$", code) or re.search(r"\(\*(hbvib_\w+)\)", code)
        if named:
            found.append(f"## {named[1]}\n\n{fenced(doc)}\n```c\n{code}\n```\n")
    return found
