#!/bin/sh
# Builds a wheel that runs on any Linux x86-64 with glibc 2.28 or newer (2018), and the source distribution:
#
#   sh examples/install/manylinux.sh FOLDER
#
# Needs, for the Python named by PYTHON (python3): pip install cargo-zigbuild ziglang auditwheel build 'hatchling>=1.24'.
# zig links against the symbols of the old glibc; auditwheel checks that the wheel needs no newer ones.
set -eu
[ $# = 1 ] || { echo "usage: sh examples/install/manylinux.sh FOLDER" >&2; exit 2; }
mkdir -p "$1"
folder=$(cd "$1" && pwd)
cd "$(dirname "$0")/../.."
python=${PYTHON:-python3}
platform=manylinux_2_28_x86_64
# The programs of these packages lie beside that of Python.
PATH=$(dirname "$(command -v "$python")"):$PATH
export PATH
cargo zigbuild --release --lib -p hbvib-c -p hbvib-io --target x86_64-unknown-linux-gnu.2.28
target=$(cargo metadata --format-version 1 --no-deps | sed -n 's/.*"target_directory":"\([^"]*\)".*/\1/p')
export HBVIB_WHEEL_LIBRARIES="$target/x86_64-unknown-linux-gnu/release" HBVIB_WHEEL_PLATFORM=$platform
"$python" -m build --no-isolation --outdir "$folder" .
wheel=$(ls -t "$folder"/hbvib-*-py3-none-$platform.whl | head -n 1)
"$python" -m auditwheel show "$wheel" | tee "$folder/auditwheel.txt"
# The tag that auditwheel finds is the wanted one, or an older one, which is stricter.
"$python" - "$folder/auditwheel.txt" <<'CHECK'
import re, sys
text = " ".join(open(sys.argv[1]).read().split())
found = re.search(r'consistent with the following platform tag: "(?:many)?linux_(\d+)_(\d+)_x86_64"', text) or re.search(
    r'platform tag: "manylinux_(\d+)_(\d+)_x86_64"', text)
sys.exit(0 if found and (int(found[1]), int(found[2])) <= (2, 28) else "the wheel needs a newer glibc than 2.28")
CHECK
echo "$wheel"
