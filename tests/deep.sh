#!/bin/sh
# Checks that take too long for every change, on one thread. Run after tests/run.sh has passed.
set -eu
cd "$(dirname "$0")/.."
cargo test --release --tests -- --ignored --test-threads=1
