"""Known vulnerabilities of the crates of Cargo.lock, from a copy of the database of RustSec that need not be online.

Usage: python3 tests/advisories.py <folder of https://github.com/rustsec/advisory-db>. Prints the advisories that concern a
version in use, and fails where one is a vulnerability; others tell that nobody maintains a crate.
"""

import pathlib
import re
import sys
import tomllib


def numbers(version: str) -> tuple[int, int, int]:
    parts = [int(n) for n in re.split(r"[-+]", version)[0].split(".")]
    return tuple((parts + [0, 0])[:3])


def meets(version: str, requirement: str) -> bool:
    """Whether a version meets a requirement of several comparisons, as Cargo reads them."""
    here = numbers(version)
    for part in requirement.split(","):
        operator, wanted = re.fullmatch(r"\s*(>=|<=|>|<|=|\^|~)?\s*([\w.+-]+)\s*", part).groups()
        there = numbers(wanted)
        first = next((i for i, n in enumerate(there) if n > 0), 2)
        compatible = here >= there and here[: first + 1] == there[: first + 1]
        verdict = {">=": here >= there, "<=": here <= there, ">": here > there, "<": here < there, "=": here == there,
                   "~": here >= there and here[:2] == there[:2]}
        if not verdict.get(operator, compatible):
            return False
    return True


def main() -> int:
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    database = pathlib.Path(sys.argv[1]) / "crates"
    root = pathlib.Path(__file__).resolve().parent.parent
    packages = tomllib.loads((root / "Cargo.lock").read_text())["package"]
    if not database.is_dir():
        print(f"{database} is no copy of the database", file=sys.stderr)
        return 2
    read = vulnerable = 0
    for package in packages:
        for path in sorted((database / package["name"]).glob("RUSTSEC-*.md")):
            read += 1
            text = path.read_text(encoding="utf-8")
            entry = tomllib.loads(re.search(r"```toml\n(.*?)```", text, re.DOTALL).group(1))
            advisory, versions = entry["advisory"], entry.get("versions", {})
            if "withdrawn" in advisory:
                continue
            fine = versions.get("patched", []) + versions.get("unaffected", [])
            if any(meets(package["version"], requirement) for requirement in fine):
                continue
            kind = advisory.get("informational", "vulnerability")
            vulnerable += kind == "vulnerability"
            print(f"{advisory['id']}: {package['name']} {package['version']}, {kind}")
    print(f"{len(packages)} packages, {read} advisories of these names, {vulnerable} vulnerabilities")
    return vulnerable > 0


if __name__ == "__main__":
    sys.exit(main())
