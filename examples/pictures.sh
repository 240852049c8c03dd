#!/usr/bin/env bash
# Makes the pictures of the documentation again, with the very commands that stand there.
#
#     examples/pictures.sh [flags for every picture, such as --size 256]
set -euo pipefail
cd "$(dirname "$0")/.."

cargo build --release
iso() { target/release/iso "$@"; }
grep -h '^iso render .* -o docs/' README.md docs/certified.md | while read -r command; do
    eval "$command --size 480 --smooth 2 $*"
done
