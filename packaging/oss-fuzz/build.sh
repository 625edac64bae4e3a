#!/bin/bash -eu
# Builds the targets of fuzz/ and their seeds, as OSS-Fuzz calls it: $SRC, $OUT.
cd "$SRC/hbvib/fuzz"
cargo fuzz build --features libfuzzer -O
cargo run --release --bin mutate -- corpus corpus
for path in fuzz_targets/*.rs; do
    target=$(basename "$path" .rs)
    cp "target/x86_64-unknown-linux-gnu/release/$target" "$OUT/"
    [ ! -d "corpus/$target" ] || (cd "corpus/$target" && zip -q -r "$OUT/${target}_seed_corpus.zip" .)
done
