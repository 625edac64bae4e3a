#!/bin/sh
# All tests: the Rust ones, and the C programs that they compile against header and library.
# Installs the C and C++ compilers where it may (apt as root); else says what is missing and fails.
set -eu
cd "$(dirname "$0")/.."

need() { # program, Debian package
    command -v "$1" >/dev/null 2>&1 && return
    if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null 2>&1; then
        echo "installing $2 for $1"
        apt-get -o DPkg::Lock::Timeout=300 update -qq
        DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 install -y -qq --no-install-recommends "$2" >/dev/null
    fi
    command -v "$1" >/dev/null 2>&1 || {
        echo "tests/run.sh: no $1 here; install it (Debian: apt-get install $2) and run again" >&2
        exit 1
    }
}
command -v cargo >/dev/null 2>&1 || { echo "tests/run.sh: no cargo here; install Rust from https://rustup.rs" >&2; exit 1; }
need cc gcc
need c++ g++
need nm binutils
need readelf binutils

# The library first: the C programs link against it; and the examples, which tests run.
cargo build --release --lib --examples
cargo test --release --lib --tests
