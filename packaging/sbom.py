"""Software bill of materials of the library, CycloneDX 1.5 as JSON: python packaging/sbom.py [hbvib-c] > hbvib.cdx.json

Crates that go into the libraries by `cargo metadata`, with version, licence, check sum of Cargo.lock and what needs what."""
import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def main() -> None:
    wanted = sys.argv[1:] or ["hbvib-c", "hbvib-io"]
    command = ["cargo", "metadata", "--format-version", "1", "--locked", "--filter-platform", "x86_64-unknown-linux-gnu"]
    data = json.loads(subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout)
    packages = {package["id"]: package for package in data["packages"]}
    nodes = {node["id"]: node for node in data["resolve"]["nodes"]}
    sums: dict[str, str] = {}
    for name, version, checksum in re.findall(
            r'name = "([^"]+)"\nversion = "([^"]+)"\nsource = "[^"]+"\nchecksum = "([0-9a-f]{64})"', (ROOT / "Cargo.lock").read_text()):
        sums[f"{name} {version}"] = checksum
    seen: dict[str, list[str]] = {}
    open_ends = [package["id"] for package in packages.values() if package["name"] in wanted and package["source"] is None]
    while open_ends:
        own = open_ends.pop()
        if own in seen:
            continue
        needs = [entry["pkg"] for entry in nodes[own]["deps"] if any(kind["kind"] is None for kind in entry["dep_kinds"])]
        seen[own] = needs
        open_ends += needs
    version = next(package["version"] for package in packages.values() if package["name"] == "hbvib")
    document = dict(
        bomFormat="CycloneDX", specVersion="1.5", version=1,
        metadata=dict(component=dict(type="library", name="hbvib", version=version, **{"bom-ref": "hbvib"},
                                     licenses=[dict(expression="MIT OR Apache-2.0")])),
        components=[component(packages[own], sums) for own in sorted(seen, key=lambda own: packages[own]["name"])],
        dependencies=[dict(ref=reference(packages[own]), dependsOn=sorted(reference(packages[need]) for need in needs))
                      for own, needs in sorted(seen.items(), key=lambda entry: reference(packages[entry[0]]))])
    json.dump(document, sys.stdout, indent=1)
    print()


def reference(package: dict) -> str:
    return f"pkg:cargo/{package['name']}@{package['version']}"


def component(package: dict, sums: dict[str, str]) -> dict:
    found = dict(type="library", name=package["name"], version=package["version"], purl=reference(package),
                 **{"bom-ref": reference(package)})
    if package["license"]:
        found["licenses"] = [dict(expression=package["license"].replace("/", " OR "))]
    checksum = sums.get(f"{package['name']} {package['version']}")
    if checksum:
        found["hashes"] = [dict(alg="SHA-256", content=checksum)]
    return found


if __name__ == "__main__":
    main()
