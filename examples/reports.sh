#!/usr/bin/env bash
# Measures the reports and plots of the documentation again, about ten minutes on a machine that does nothing else.
#
#     examples/reports.sh [paper|barth_sextic|sheets|octree|engines]...
set -euo pipefail
cd "$(dirname "$0")/.."

cargo build --release
iso() { target/release/iso "$@"; }

paper='(x^2+y^2-1)^2 + 4z^2 + 0.5x = 0.2'
barth_sextic='p := (1+sqrt(5))/2; 4(p^2 x^2-y^2)(p^2 y^2-z^2)(p^2 z^2-x^2) - (1+2p)(x^2+y^2+z^2-1)^2 = 0'
sheets='u := z - 0.3 sin(2x)*cos(2y); u*(u - 1e-3) = 0'
barth_decic='p := (1+sqrt(5))/2; r := x^2+y^2+z^2; 8(x^2-p^4 y^2)(y^2-p^4 z^2)(z^2-p^4 x^2)(x^4+y^4+z^4-2x^2 y^2-2x^2 z^2-2y^2 z^2) + (3+5p)*(r-1)^2*(r-(2-p))^2 = 0'
waves='w(a) := sin(4x+a) + sin(4y+2a) + sin(4z+3a); w(0)*w(1)*w(2) + w(3)*w(4) = 0.3'

# Keeps of a report's folder what the documentation holds.
keep() {
    rm "$1"/report.json
    for plot in "$1"/plots/*.svg; do
        case " $2 " in *" $(basename "$plot" .svg) "*) ;; *) rm "$plot" ;; esac
    done
}

report() { # name, formula, box
    iso report "$2" --box "$3" --budget 60s -o "docs/reports/$1"
    keep "docs/reports/$1" 'wrong distance cells'
}

octree() { # name, formula, box
    iso report "$2" --box "$3" --methods grid,octree --engines jit --grids 8,16,32,64,128,256 --refines 2 --steps 0.05 \
        --root-finders bisection --tolerances 0 --runs 3 --budget 70s -o "docs/octree-or-grid/$1"
    rm "docs/octree-or-grid/$1/report.html"
    keep "docs/octree-or-grid/$1" 'preprocess trace evaluations missed memory cells'
}

for part in "${@:-paper barth_sextic sheets octree engines}"; do
    for name in $part; do
        case $name in
        paper) report paper "$paper" -1.6,-1.6,-0.8,1.6,1.6,0.8 ;;
        barth_sextic) report barth_sextic "$barth_sextic" -1.9,1.9 ;;
        sheets) report sheets "$sheets" -1,1 ;;
        octree)
            octree paper "$paper" -1.6,-1.6,-0.8,1.6,1.6,0.8
            octree barth_decic "$barth_decic" -1.6,1.6
            octree waves "$waves" -1.5,1.5
            ;;
        engines)
            iso engines --budget 200s -o docs/interpreter-or-jit
            iso engines --sizes 3,10,30,100 --sides 1024,2048,4096 --runs 2 --patience 6s --budget 200s -o docs/interpreter-or-jit/large
            rm docs/interpreter-or-jit/large/evaluations*
            ;;
        *) echo "no part is called $name" >&2 && exit 2 ;;
        esac
    done
done
