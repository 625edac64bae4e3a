#!/bin/sh
# An analysis under valgrind, which must see a planted fault first. Usage: sh tests/valgrind.sh
set -eu
cd "$(dirname "$0")/.."
target=$(cargo metadata --format-version 1 --no-deps | sed -n 's/.*"target_directory":"\([^"]*\)".*/\1/p')
work=$target/valgrind
rm -rf "$work"
mkdir -p "$work"
cargo build --release --quiet --lib
cp "$target/release/libhbvib.so" "$work/libhbvib.so"
ln -s libhbvib.so "$work/$(readelf -d "$work/libhbvib.so" | sed -n 's/.*SONAME.*\[\(.*\)\]/\1/p')"
leaks=definite,indirect

watched() { # name of a C file, arguments
    program=$work/$1
    cc -g -O1 -std=gnu99 -Iinclude "tests/safety/$1.c" -o "$program" -L"$work" -Wl,-rpath,"$work" -lhbvib -lpthread -lm
    shift
    valgrind -q --error-exitcode=99 --leak-check=full --show-leak-kinds=$leaks --errors-for-leak-kinds=$leaks "$program" "$@" \
        >"$program.log" 2>&1
}
if watched planted_fault address || ! grep -q "Invalid write" "$work/planted_fault.log"; then
    echo "valgrind: the planted fault was not seen" >&2
    exit 1
fi
watched every_analysis forced || {
    cat "$work/every_analysis.log" >&2
    exit 1
}
echo "valgrind: the planted fault is seen, and no report otherwise"
