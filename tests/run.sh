#!/bin/sh
# All tests: the Rust ones, and the C, C++, Fortran and Python programs that they build and run.
# Installs compilers and tools where it may (apt as root) and Python packages in .venv; else says what
# is missing and fails. `sh tests/run.sh build` only compiles what the tests need. Checks that take longer: tests/deep.sh.
set -eu
cd "$(dirname "$0")/.."

packages() { # Debian packages
    [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null 2>&1 || return 0
    echo "installing $*"
    apt-get -o DPkg::Lock::Timeout=300 update -qq
    DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 install -y -qq --no-install-recommends "$@" >/dev/null
}
need() { # Debian package, command that shows that it is there
    package=$1
    shift
    "$@" >/dev/null 2>&1 && return
    packages "$package"
    "$@" >/dev/null 2>&1 || {
        echo "tests/run.sh: '$*' fails; install it (Debian: apt-get install $package) and run again" >&2
        exit 1
    }
}
cargo --version >/dev/null 2>&1 || { echo "tests/run.sh: no cargo here; install Rust from https://rustup.rs" >&2; exit 1; }
need gcc cc --version
need g++ c++ --version
need gfortran gfortran --version
need binutils readelf --version
need make make --version
need cmake cmake --version
need pkg-config pkg-config --version
need openmpi-bin mpirun --version
# mpicc itself comes with openmpi-bin.
need libopenmpi-dev sh -c 'echo "#include <mpi.h>" | mpicc -E -x c -'
need libeigen3-dev pkg-config --exists eigen3
need python3 python3 --version
need bsdutils script --version
need valgrind valgrind --version
need locales test -e /usr/share/i18n/locales/de_DE
need codespell codespell --version
need calculix-ccx sh -c 'command -v ccx'

# Python with numpy, what builds the wheel, what tables and figures need, and a type checker: the system's, or one of our own.
# All that comes from the network comes here, beside the compiler; the tests work without it.
modules="numpy scipy matplotlib distributed pip hatchling pandas xarray tqdm mypy typing_extensions pycparser meshio pyuff"
complete() { "$1" -c "import $(echo $modules | sed 's/ /, /g')" >/dev/null 2>&1; }
pip=""
if { [ -e .venv ] || ! complete python3; } && ! complete .venv/bin/python; then
    need python3-venv python3 -c 'import venv, ensurepip'
    echo "installing numpy, scipy, matplotlib, distributed, pandas, xarray, tqdm, hatchling, a type checker and readers of result files in .venv"
    (
        set -e
        python3 -m venv .venv
        .venv/bin/python -m pip install --quiet --disable-pip-version-check $(echo $modules | sed 's/pip //')
    ) &
    pip=$!
    trap 'kill $pip 2>/dev/null || true' EXIT
fi
python_is_there() {
    [ -n "$pip" ] || return 0
    wait $pip || {
        echo "tests/run.sh: could not install $modules; install them for python3 (pip or apt) and run again" >&2
        exit 1
    }
    trap - EXIT
}

# The crates of all platforms: a build takes those of its own, but a new project of a user is resolved with all.
cargo fetch --quiet

# Programs of tests report a full disk in words of their own, or in none.
full_disk() {
    for folder in . "${TMPDIR:-/tmp}"; do
        free=$(df -Pk "$folder" | awk 'NR == 2 { print int($4 / 1024) }')
        [ "$free" -ge 1000 ] || echo "tests/run.sh: only $free MB are free for $folder, which may be why a test fails" >&2
    done
}

# Does a step, and lists at the end how long each took.
times=""
step() { # name, command
    name=$1
    shift
    began=$(date +%s)
    "$@" || { code=$?; full_disk; exit $code; }
    times="$times$(printf '%6d s  %s' $(($(date +%s) - began)) "$name")
"
}
# In one call, which keeps all cores busy and compiles nothing twice: the libraries, which programs link against, the command, all tests,
# and the examples that some run. All calls name the same packages, since others give dependencies other features.
packages="--workspace --exclude hbvib-bindings"
step "compile" cargo build --release $packages --lib --bins --tests --example ring_damper --example flutter --example campbell
step "wait for the Python packages" python_is_there
[ "${1:-}" != build ] || { printf '%s' "$times"; exit 0; }
step "all tests, programs in five languages" cargo test --release $packages --no-fail-fast --tests
# Examples in the documentation of the Rust interface; the page of a matrix, which lies below the library, uses that.
step "examples of the Rust interface" cargo test --release $packages --exclude hbvib-numerics --doc
printf '%s' "$times"
echo "all tests passed; sanitisers, lints of tests, Windows, damaged input and what takes long are in tests/deep.sh"
