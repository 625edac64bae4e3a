#!/bin/sh
# The classes of MATLAB in GNU Octave: one command installs them, they give the numbers of Python to the bit, the programs of the
# book run, and Ctrl-C stops a solve and leaves the session alive. Run after tests/run.sh; tests/deep.sh does.
set -eu
cd "$(dirname "$0")/.."
root=$PWD
if ! command -v mkoctfile >/dev/null 2>&1; then
    if [ "$(id -u)" != 0 ] || ! command -v apt-get >/dev/null 2>&1; then
        echo "tests/octave.sh needs octave and mkoctfile (Debian: octave octave-dev)" >&2
        exit 1
    fi
    apt-get -o DPkg::Lock::Timeout=300 update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends octave octave-dev >/dev/null
fi
python=python3
[ ! -x .venv/bin/python ] || python=.venv/bin/python
target=$(cargo metadata --format-version 1 --no-deps | sed -n 's/.*"target_directory":"\([^"]*\)".*/\1/p')
library=${HBVIB_LIBRARY:-$target/release/libhbvib.so}
work=$target/octave
rm -rf "$work"
mkdir -p "$work/programs"
cp -r matlab/. "$work/first"
octave() { command octave --no-gui --no-init-file --quiet --path "$work/matlab" --path "$root/tests/languages/octave" "$@"; }

# One command; the folder may be moved afterwards.
(cd "$work/first" && command octave --no-gui --no-init-file --quiet --eval "hbvib_install('$library', '$root/include')" 2>&1) || true
mv "$work/first" "$work/matlab"
[ -f "$work/matlab/hbvib_mex.mex" ] || { echo "the gateway was not installed" >&2; exit 1; }

HBVIB_LIBRARY=$library PYTHONPATH=include "$python" tests/languages/octave/reference.py >"$work/numbers.json"
octave --eval "check('$work/numbers.json')" 2>&1 | tee "$work/check.log"
grep -qx "check passed" "$work/check.log"

# The fit of a joint prints what it prints in Python.
octave --path "$root/examples/matlab" --eval "fit_joint('$root/examples/data/joint.csv')" >"$work/fit.log" 2>/dev/null || true
HBVIB_LIBRARY=$library PYTHONPATH=include "$python" examples/python/fit_joint.py | cmp - "$work/fit.log"

# Programs of the book, each in a session of its own; those that print a resonance print that of Python.
"$python" - "$work" <<'END'
import re, sys
from pathlib import Path
number = 0
for page in [Path("README.md"), *sorted(Path("docs").rglob("*.md"))]:
    for text in re.findall(r"(?ms)^```matlab\n(.*?)^```", page.read_text()):
        number += 1
        Path(sys.argv[1], "programs", f"program_{number}.m").write_text(text)
print(number, "programs of the book")
END
for program in "$work"/programs/*.m; do
    octave "$program" >"$program.log" 2>&1 || true
    if grep -E "^error: " "$program.log" | grep -v "preparing to exit"; then
        echo "$program failed" >&2
        exit 1
    fi
done

# Ctrl-C: the solve ends with an error, and the session goes on.
printf 'endless\ndisp(strcat("ali", "ve"))\n' >"$work/lines"
command octave --no-gui --no-init-file --quiet --interactive --path "$work/matlab" --path "$root/tests/languages/octave" \
    <"$work/lines" >"$work/stopped.log" 2>&1 &
session=$!
waited=0
until grep -q solving "$work/stopped.log" 2>/dev/null; do
    sleep 1
    waited=$((waited + 1))
    [ $waited -lt 60 ] || { cat "$work/stopped.log"; kill $session; exit 1; }
done
sleep 1
kill -INT $session
waited=0
while kill -0 $session 2>/dev/null; do
    sleep 1
    waited=$((waited + 1))
    [ $waited -lt 20 ] || { echo "Ctrl-C did not stop Octave" >&2; kill -9 $session; exit 1; }
done
grep -q "stopped by Ctrl-C" "$work/stopped.log"
grep -q alive "$work/stopped.log"
! grep -q "not stopped" "$work/stopped.log"
echo "tests of Octave passed"
