#!/usr/bin/env bash
# Makes the pictures of docs/certified.md again, with the commands that stand there, by sampling and by proof.
set -euo pipefail
cd "$(dirname "$0")/.."

cargo build --release
iso() { target/release/iso "$@"; }
grep '^iso render .* -o docs/proofs/' docs/certified.md | while read -r command; do
    for method in grid certified; do
        eval "$command-$method.png --method $method"
    done
done
