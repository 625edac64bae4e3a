#!/bin/sh
# Fuzzing guided by coverage, with AddressSanitizer, of what reads files and bytes of others: each target in
# fuzz/fuzz_targets from good input on. Prints executions, the slowest input and the peak of memory. Input that fails stays in
# fuzz/artifacts, and what was found on the way in fuzz/corpus. Usage: sh tests/fuzz.sh [executions] [target]
set -eu
cd "$(dirname "$0")/../fuzz"
executions=${1:-1000000}
only=${2:-}
cargo fuzz --version >/dev/null 2>&1 || cargo install cargo-fuzz

cargo run --quiet --release --bin mutate -- corpus corpus
for path in fuzz_targets/*.rs; do
    target=$(basename "$path" .rs)
    [ -z "$only" ] || [ "$only" = "$target" ] || continue
    log=$(mktemp)
    # The stable compiler has the sanitisers of a nightly one. Seconds for an input of 4 kB are too long, and so is memory far
    # above what it can need.
    RUSTC_BOOTSTRAP=1 cargo fuzz run --features libfuzzer --sanitizer address "$target" -- -runs="$executions" -max_len=4096 \
        -timeout=5 -rss_limit_mb=2048 -print_final_stats=1 >"$log" 2>&1 || {
        tail -40 "$log" >&2
        echo "$target: fails, see fuzz/artifacts/$target" >&2
        exit 1
    }
    figure() { sed -n "s/^stat::$1: *//p" "$log"; }
    echo "$target: $(figure number_of_executed_units) executions, $(figure new_units_added) kept, slowest" \
        "$(figure slowest_unit_time_sec) s, peak $(figure peak_rss_mb) MB"
    rm "$log"
done
