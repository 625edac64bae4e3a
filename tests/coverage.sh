#!/bin/sh
# Line coverage of the library by its tests, the programs in C, C++, Fortran and Python that they run among them: of the whole,
# of each folder, and the lines that nothing ran, by file. Instrumented code is slower and larger: tests that measure time or
# memory may fail, which is told. Prints the figures; target/coverage/lines has the lines.
# Usage: sh tests/coverage.sh [test crate]..., without names all crates.
set -eu
cd "$(dirname "$0")/.."
host=$(rustc -vV | sed -n 's/^host: //p')
tools=$(rustc --print sysroot)/lib/rustlib/$host/bin
[ -x "$tools/llvm-cov" ] || rustup component add llvm-tools
work=$(cargo metadata --format-version 1 --no-deps | sed -n 's/.*"target_directory":"\([^"]*\)".*/\1/p')/coverage
mkdir -p "$work"
rm -rf "$work/profiles"

# The crates of this workspace alone are instrumented; what they depend on is as fast as ever.
printf '#!/bin/sh\nexec "$@" -Cinstrument-coverage\n' >"$work/wrapper"
chmod +x "$work/wrapper"
export RUSTC_WORKSPACE_WRAPPER="$work/wrapper" CARGO_TARGET_DIR="$work" LLVM_PROFILE_FILE="$work/profiles/%4m.profraw"
which="-p hbvib-tests -p hbvib-unit-tests -p hbvib-numerics-unit-tests -p hbvib-dissection --tests"
[ $# = 0 ] || which=$(printf ' --test %s' "$@")
cargo build --release --quiet --lib --examples
cargo build --release --quiet --lib --bins -p hbvib-io -p hbvib-cli
executables=$(cargo test --release --quiet $which --no-run --message-format=json |
    sed -n '/"profile":{[^}]*"test":true/s/.*"executable":"\([^"]*\)".*/\1/p')
# What compilers ran is no test.
rm -rf "$work/profiles"
cargo test --release $which --no-fail-fast >"$work/tests.log" 2>&1 || {
    echo "these tests fail when instrumented:"
    sed -n 's/^test \(.*\) \.\.\. FAILED$/  \1/p' "$work/tests.log"
}
"$tools/llvm-profdata" merge -sparse "$work"/profiles/*.profraw -o "$work/all.profdata"
objects=
for object in $executables "$work"/release/libhbvib.so $(find "$work/release/examples" -maxdepth 1 -type f -perm -u+x ! -name '*-*'); do
    objects="$objects --object $object"
done
"$tools/llvm-cov" export --format=lcov --instr-profile="$work/all.profdata" $objects --sources "$PWD/src" "$PWD/crates/numerics/src" "$PWD/crates/dissection/src" >"$work/lcov" 2>"$work/export.log"
python3 - "$work/lcov" "$PWD/" <<'PYTHON' >"$work/lines"
import collections, sys

lines = collections.defaultdict(dict)
for row in open(sys.argv[1]):
    key, _, value = row.strip().partition(":")
    if key == "SF":
        name = value.removeprefix(sys.argv[2])
    elif key == "DA":
        line, count = map(int, value.split(",")[:2])
        lines[name][line] = max(count, lines[name].get(line, 0))
folders = collections.defaultdict(lambda: [0, 0])
for name, counts in lines.items():
    source, _, inner = name.partition("src/")
    source += "src"
    room = inner.split("/")[0] if "/" in inner else "*.rs"
    for folder in ("all", source, f"{source}/{room}"):
        folders[folder][0] += sum(count > 0 for count in counts.values())
        folders[folder][1] += len(counts)
for folder, (covered, all) in sorted(folders.items()):
    print(f"{folder:24} {100 * covered / all:6.2f} %  {covered} of {all} lines")
print()
for name, counts in sorted(lines.items()):
    missed = sorted(line for line, count in counts.items() if count == 0)
    if missed:
        ranges, start = [], missed[0]
        for line, following in zip(missed, missed[1:] + [None]):
            if following != line + 1:
                ranges.append(f"{start}" if start == line else f"{start}-{line}")
                start = following
        print(f"{name}: {', '.join(ranges)}")
PYTHON
sed '/^$/q' "$work/lines"
