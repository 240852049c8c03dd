#!/usr/bin/env bash
# Makes the pictures of the README's gallery again, with the very commands that stand there.
#
#     examples/gallery.sh [flags for every picture, such as --size 256]
set -euo pipefail
cd "$(dirname "$0")/.."

cargo build --release
iso() { target/release/iso "$@"; }
grep '^iso render .* -o docs/gallery/' README.md | while read -r command; do
    eval "$command --size 480 $*"
done
