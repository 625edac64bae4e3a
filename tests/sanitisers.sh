#!/bin/sh
# Programs in C and C++ under a tool that watches them and the library: address (with leaks and undefined behaviour of the
# programs) or thread, sanitisers with which the library is instrumented too, or valgrind. Planted faults must be seen
# first. With "short" one program alone. Usage: sh tests/sanitisers.sh address|thread|valgrind [short]
set -eu
cd "$(dirname "$0")/.."
tool=${1:-}
short=${2:-}
target=$(cargo metadata --format-version 1 --no-deps | sed -n 's/.*"target_directory":"\([^"]*\)".*/\1/p')
work=$target/sanitisers/$tool
rm -rf "$work"
mkdir -p "$work"
host=$(rustc -vV | sed -n 's/^host: //p')
runtime=$(rustc --print sysroot)/lib/rustlib/$host/lib
flags=
watch=
# Requests that no machine can meet are part of the tests.
export ASAN_OPTIONS=allocator_may_return_null=1 TSAN_OPTIONS=allocator_may_return_null=1

# The stable compiler has the sanitisers of a nightly one.
instrumented() { # symbol that shows it, options of rustc, those of cargo
    symbol=$1
    RUSTC_BOOTSTRAP=1 RUSTFLAGS=$2 cargo build --release --quiet ${3:-} -p hbvib-c --target "$host" --target-dir "$target/$tool"
    cp "$target/$tool/$host/release/libhbvib.so" "$work/libhbvib.so"
    nm "$work/libhbvib.so" | grep -q "$symbol"
}
case $tool in
address)
    instrumented __asan_init "-Zsanitizer=address -Cforce-frame-pointers=yes"
    flags="-fsanitize=address,undefined -fno-sanitize-recover=all"
    faults="address leak"
    ;;
thread)
    # With the standard library: a lock that threads wait for is taken in it, and else all that it guards seems a race.
    rustup component add rust-src
    instrumented __tsan_init -Zsanitizer=thread -Zbuild-std
    flags="-fsanitize=thread"
    faults=race
    ;;
valgrind)
    cargo build --release --quiet --lib
    cp "$target/release/libhbvib.so" "$work/libhbvib.so"
    flags="-DONE_REFUSAL_IN=20"
    leaks=definite,indirect
    watch="valgrind -q --error-exitcode=99 --leak-check=full --show-leak-kinds=$leaks --errors-for-leak-kinds=$leaks"
    faults="address leak"
    ;;
*)
    echo "usage: sh tests/sanitisers.sh address|thread|valgrind [short]" >&2
    exit 2
    ;;
esac
ln -s libhbvib.so "$work/$(readelf -d "$work/libhbvib.so" | sed -n 's/.*SONAME.*\[\(.*\)\]/\1/p')"

compile() { # path of a file in C or C++, program
    case $1 in
    *.c) compiler="cc -std=gnu99" ;;
    *) compiler="c++ -std=c++17 $(pkg-config --cflags-only-I eigen3)" ;;
    esac
    $compiler -g -O1 $flags -Iinclude -c "$1" -o "$2.o"
    if [ "$tool" = thread ]; then
        # The runtime of Rust, exported for the library: that of gcc lacks some of its functions.
        ${compiler%% *} "$2.o" -o "$2" -Wl,--whole-archive "$runtime"/librustc-*_rt.tsan.a -Wl,--no-whole-archive -Wl,--export-dynamic \
            -L"$work" -Wl,-rpath,"$work" -lhbvib -lpthread -lm -ldl -lrt
    else
        ${compiler%% *} $flags "$2.o" -o "$2" -L"$work" -Wl,-rpath,"$work" -lhbvib -lpthread -lm -ldl
    fi
}

compile tests/safety/planted_fault.c "$work/planted_fault"
for fault in $faults; do
    if $watch "$work/planted_fault" "$fault" >"$work/planted_fault.log" 2>&1 ||
        ! grep -qE "heap-buffer-overflow|LeakSanitizer|data race|Invalid write|definitely lost" "$work/planted_fault.log"; then
        cat "$work/planted_fault.log" >&2
        echo "$tool: the planted fault ($fault) was not seen" >&2
        exit 1
    fi
done
echo "$tool: planted faults are seen ($faults)"

# Numbers of the reference data, as the tests of the programs give them.
numbers() { # file of tests/data, expression in Python for a list
    python3 -c 'import json, sys; d = json.load(open("tests/data/" + sys.argv[1])); print(*eval("(" + sys.argv[2] + ")"))' "$@"
}
programs=0
try() { # file in C or C++, arguments
    name=$(basename "$1").run
    source=$1
    shift
    compile "$source" "$work/$name"
    (cd "$work" && $watch "./$name" "$@" >"$name.log" 2>&1) || {
        tail -60 "$work/$name.log" >&2
        echo "$tool: $source fails" >&2
        exit 1
    }
    programs=$((programs + 1))
}
if [ -n "$short" ]; then
    try tests/safety/every_analysis.c forced
    echo "$tool: no report in one program"
    exit
fi
try tests/safety/every_analysis.c
point=point_F5_208p85.json
for source in tests/c_abi/*.c tests/languages/cpp/*.cpp; do
    case $(basename "$source") in
    header.c | phases.c | extremes.c) ;; # One that is compiled alone, and those that measure time.
    process.c) ;; # Small stacks, where sanitisers need larger ones, and floating-point traps, which valgrind has not.
    mode.c) try "$source" $(numbers nnm_base.json '[r[k] for t in [d["H"]["3"]["table"]] for r in (t[0], t[len(t) // 2]) for k in
        ("alpha", "omega", "D")] + [d["H"]["3"]["D_max"]["D"]]') ;;
    time.c) try "$source" $(numbers $point '[d["td"]["f_Hz"]] + d["td"]["X"]["1"][0]') ;;
    verify.c) try "$source" $(numbers $point '[d["td"]["f_Hz"]] + d["td"]["X"]["1"][0] +
        [d["hbm"]["hbm_exactN"]["9"]["rel_err_b2_vs_td"]]') ;;
    handles.c) # Measures resident memory, where freed blocks must not be kept.
        ASAN_OPTIONS=$ASAN_OPTIONS:quarantine_size_mb=0
        [ "$tool" != valgrind ] || watch="$watch --freelist-vol=0"
        try "$source"
        ASAN_OPTIONS=${ASAN_OPTIONS%:*}
        watch=${watch% --freelist-vol=0}
        ;;
    *) try "$source" ;;
    esac
done
# Calls may be slow here.
try tests/safety/random_calls.c 7 120 1000000 60
[ "$tool" = valgrind ] || try tests/safety/threads.c 4 60
grep -h " failures" "$work"/*.run.log
echo "$tool: no report in $programs programs"
