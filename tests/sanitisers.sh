#!/bin/sh
# Programs of tests/c_abi and tests/safety under a tool that watches them and the library: address or thread (sanitisers,
# with the library instrumented too) or valgrind. A planted fault must be seen first. With "short" one program alone.
# Usage: sh tests/sanitisers.sh address|thread|valgrind [short]
set -eu
cd "$(dirname "$0")/.."
tool=$1
short=${2:-}
target=$(cargo metadata --format-version 1 --no-deps | sed -n 's/.*"target_directory":"\([^"]*\)".*/\1/p')
work=$target/sanitisers/$tool
rm -rf "$work"
mkdir -p "$work"
host=$(rustc -vV | sed -n 's/^host: //p')
runtime=$(rustc --print sysroot)/lib/rustlib/$host/lib

# The stable compiler has the sanitisers of a nightly one.
instrumented() {
    RUSTC_BOOTSTRAP=1 RUSTFLAGS="$*" cargo build --release --quiet -p hbvib-c --target "$host" --target-dir "$target/$tool"
    cp "$target/$tool/$host/release/libhbvib.so" "$work/libhbvib.so"
}
case $tool in
address)
    instrumented -Zsanitizer=address -Cforce-frame-pointers=yes
    nm "$work/libhbvib.so" | grep -q __asan_init
    flags="-fsanitize=address,undefined"
    watch=
    ;;
thread)
    instrumented -Zsanitizer=thread -Cunsafe-allow-abi-mismatch=sanitizer
    nm "$work/libhbvib.so" | grep -q __tsan_init
    flags="-fsanitize=thread"
    watch=
    ;;
valgrind)
    cargo build --release --quiet --lib
    cp "$target/release/libhbvib.so" "$work/libhbvib.so"
    flags=
    leaks=definite,indirect
    watch="valgrind -q --error-exitcode=99 --leak-check=full --show-leak-kinds=$leaks --errors-for-leak-kinds=$leaks"
    ;;
*)
    echo "usage: sh tests/sanitisers.sh address|thread|valgrind [short]" >&2
    exit 2
    ;;
esac
ln -s libhbvib.so "$work/$(readelf -d "$work/libhbvib.so" | sed -n 's/.*SONAME.*\[\(.*\)\]/\1/p')"

compile() { # path of a C file, program
    cc -g -O1 -std=gnu99 $flags -Iinclude -c "$1" -o "$2.o"
    if [ "$tool" = thread ]; then
        # The runtime of Rust, exported for the library: that of gcc lacks some of its functions.
        cc "$2.o" -o "$2" -Wl,--whole-archive "$runtime"/librustc-*_rt.tsan.a -Wl,--no-whole-archive -Wl,--export-dynamic \
            -L"$work" -Wl,-rpath,"$work" -lhbvib -lpthread -lm -ldl -lrt
    else
        cc $flags "$2.o" -o "$2" -L"$work" -Wl,-rpath,"$work" -lhbvib -lpthread -lm -ldl
    fi
}

fault=address
[ "$tool" = thread ] && fault=race
compile tests/safety/planted_fault.c "$work/planted_fault"
if $watch "$work/planted_fault" $fault >"$work/planted_fault.log" 2>&1; then
    echo "the planted fault was not seen" >&2
    exit 1
fi
grep -qE "heap-buffer-overflow|data race|Invalid write" "$work/planted_fault.log"
echo "$tool: the planted fault is seen"

programs=0
try() { # C file, arguments
    name=$(basename "$1" .c)
    source=$1
    shift
    compile "$source" "$work/$name"
    $watch "$work/$name" "$@" >"$work/$name.log" 2>&1 || {
        tail -60 "$work/$name.log"
        echo "$tool: $name fails" >&2
        exit 1
    }
    programs=$((programs + 1))
}
if [ -n "$short" ]; then
    try tests/safety/every_analysis.c forced
else
    try tests/safety/every_analysis.c
    # Without those that measure time, read files or load a second library.
    for source in tests/c_abi/*.c; do
        case $(basename "$source" .c) in
        header | process | phases | extremes | mode | time) ;;
        *) try "$source" ;;
        esac
    done
    if [ "$tool" != valgrind ]; then
        try tests/safety/random_calls.c 7 60
        try tests/safety/threads.c 4 60
        tail -1 "$work/random_calls.log" "$work/threads.log"
    fi
fi
echo "$tool: no report in $programs programs"
