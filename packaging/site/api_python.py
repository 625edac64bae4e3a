"""Pages of the Python interface, from its docstrings: signature, text, and the example, which tests/languages/python runs."""
import enum
import inspect
import os
import re
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "include"))
os.environ.setdefault("HBVIB_LIBRARY", str(ROOT / "target/release/libhbvib.so"))

GROUPS = [("python-model.md", "Model"), ("python-branch.md", "Branch"), ("python-functions.md", "functions"),
          ("python-classes.md", "other classes"), ("python-results.md", "options and results"),
          ("python-constants.md", "constants"), ("python-errors.md", "errors")]


def pages() -> list[tuple[str, str, str]]:
    """(name of the file, title, text) of each page."""
    import hbvib

    texts: dict[str, list[str]] = {title: [] for _, title in GROUPS}
    for name in sorted(set(hbvib.__all__) - {"lib", "structs"}):
        item = getattr(hbvib, name)
        if inspect.isclass(item):
            texts[group(name, item)].append(of_class(name, item))
        elif callable(item):
            texts["functions"].append(entry(f"hbvib.{name}", item))
        else:
            texts["constants"].append(f"## hbvib.{name}\n\n{item!r}\n")
    for module in (hbvib.io, hbvib.testing):
        for name, item in inspect.getmembers(module, inspect.isfunction):
            if not name.startswith("_") and item.__module__ == module.__name__:
                texts["functions"].append(entry(f"{module.__name__}.{name}", item))
    found = []
    for file, title in GROUPS:
        about = inspect.getdoc(hbvib) if title == "Model" else ""
        text = f"# Python: {title}\n\n" + (fenced(about or "") + "\n" if about else "") + "\n".join(texts[title])
        found.append((file, title, text))
    return found


def group(name: str, item: type) -> str:
    if name in ("Model", "Branch"):
        return name
    if issubclass(item, enum.Enum):
        return "constants"
    if issubclass(item, (Exception, Warning)):
        return "errors"
    results = issubclass(item, tuple) or hasattr(item, "__total__")
    return "options and results" if results else "other classes"


def of_class(name: str, item: type) -> str:
    text = entry(f"hbvib.{name}", item)
    if issubclass(item, (enum.Enum, tuple, Exception)) or hasattr(item, "__total__"):
        return text
    for own, member in inspect.getmembers(item):
        if own.startswith("_") or not (callable(member) or isinstance(member, property)):
            continue
        text += "\n" + entry(f"{name}.{own}", member, level=3)
    return text


def entry(name: str, item: Any, level: int = 2) -> str:
    """Heading, signature, text and example of one item."""
    text = f"{'#' * level} {name}\n\n"
    if not isinstance(item, property):
        try:
            signature = str(inspect.signature(item))
        except (TypeError, ValueError):
            signature = "(...)"
        short = re.sub(r"(\w+\.)+(?=\w)", "", signature.replace("'", ""))
        if len(short) > 100:
            short = re.sub(r", (?=\*{0,2}\w+(?:[:=,)]| =))", ",\n    ", short)
        text += f"```python\n{name}{short}\n```\n\n"
    doc = inspect.getdoc(item) or ""
    body, mark, example = doc.partition("\n>>> ")
    text += fenced(body)
    if mark:
        text += f"\n```python\n>>> {example}\n```\n"
    return text


def fenced(body: str) -> str:
    """Paragraphs as prose, but those with columns or indented lines as they are set."""
    found: list[tuple[bool, str]] = []
    for paragraph in re.split(r"\n\s*\n", body.strip("\n").rstrip()):
        lines = paragraph.splitlines()
        is_set = any(re.match(r"\s", line) or re.search(r"\S {2,}\S", line) for line in lines)
        text = paragraph if is_set else prose(" ".join(paragraph.split()))
        if is_set and found and found[-1][0]:
            found[-1] = (True, f"{found[-1][1]}\n\n{text}")
        else:
            found.append((is_set, text))
    return "\n".join(f"```text\n{text}\n```\n" if is_set else f"{text}\n" for is_set, text in found)


def prose(text: str) -> str:
    """Text for Markdown: code between backticks, all other marks as they are."""
    parts = text.split("`")
    if len(parts) % 2 == 0:
        parts = [text.replace("`", "'")]
    return "".join(f"`{part}`" if k % 2 else re.sub(r"([<>*_\[\]])", r"\\\1", part) for k, part in enumerate(parts))
