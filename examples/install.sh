#!/bin/sh
# Installs hbvib so that CMake, pkg-config, compilers and Python find it:
#
#   sh examples/install.sh PREFIX
#
# The installed folder may be moved: no file in it contains its own path. DESTDIR precedes PREFIX, for
# packagers; CARGO and STRIP name programs to use instead of cargo and strip.
set -eu
# Files that root installs are readable for all users.
umask 022

[ $# = 1 ] && [ -n "$1" ] || { echo "usage: sh examples/install.sh PREFIX" >&2; exit 2; }
case $1 in
/*) prefix=${DESTDIR:-}$1 ;;
*) [ -z "${DESTDIR:-}" ] || { echo "install.sh: with DESTDIR the prefix must be absolute, not $1" >&2; exit 2; }
   prefix=$PWD/$1 ;;
esac
cd "$(dirname "$0")/.."
cargo=${CARGO:-cargo}
strip=${STRIP:-strip}

[ "$(uname -s)" = Linux ] || { echo "install.sh supports shared libraries of Linux only; elsewhere use cargo-c" >&2; exit 1; }
"$cargo" build --release --lib
"$cargo" build --release --lib -p hbvib-io
target=$("$cargo" metadata --format-version 1 --no-deps | sed -n 's/.*"target_directory":"\([^"]*\)".*/\1/p')
built=$target/${CARGO_BUILD_TARGET:+$CARGO_BUILD_TARGET/}release
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
# Before 1.0 every minor version may change the interface, and so the SONAME (build.rs).
abi=${version%.*}

# Installs a file completely or not at all, so that a running program keeps its old library.
put() { # mode, file, place
    mkdir -p "$(dirname "$prefix/$3")"
    cp "$2" "$prefix/$3.new"
    chmod "$1" "$prefix/$3.new"
    mv -f "$prefix/$3.new" "$prefix/$3"
}

# Installs a template with the version filled in.
fill() { # template, place
    sed -e "s/@VERSION@/$version/g" -e "s/@ABI@/$abi/g" "examples/install/$1" >"$scratch/$1"
    put 644 "$scratch/$1" "$2"
}

# Strips the internal symbols of a library, which makes it smaller; without strip it is installed unchanged.
stripped() { # file, option
    cp "$built/$1" "$scratch/$1"
    if command -v "$strip" >/dev/null 2>&1; then "$strip" "$2" "$scratch/$1"; fi
}

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
trap 'exit 1' HUP INT TERM

stripped libhbvib.so --strip-unneeded
put 755 "$scratch/libhbvib.so" "lib/libhbvib.so.$version"
ln -sf "libhbvib.so.$version" "$prefix/lib/libhbvib.so.$abi"
ln -sf "libhbvib.so.$abi" "$prefix/lib/libhbvib.so"
stripped libhbvib.a --strip-debug
put 644 "$scratch/libhbvib.a" lib/libhbvib.a
# The readers of finite-element files, which hbvib.io of Python needs.
stripped libhbvib_io.so --strip-unneeded
put 755 "$scratch/libhbvib_io.so" lib/libhbvib_io.so

for file in hbvib.h hbvib_io.h hbvib_plain.h hbvib.hpp hbvib.f90; do put 644 "include/$file" "include/$file"; done
for file in include/hbvib/*.py include/hbvib/py.typed; do put 644 "$file" "share/hbvib/hbvib/${file##*/}"; done
for file in LICENSE-MIT LICENSE-APACHE; do put 644 "$file" "share/doc/hbvib/$file"; done
fill hbvib.pc lib/pkgconfig/hbvib.pc
fill hbvib-config.cmake lib/cmake/hbvib/hbvib-config.cmake
fill hbvib-config-version.cmake lib/cmake/hbvib/hbvib-config-version.cmake
echo "hbvib $version installed in $prefix"
