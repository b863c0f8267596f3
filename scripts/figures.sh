#!/bin/sh
# Draws the figures of the manual from the command's own output: figures.sh build/sinew [FOLDER].
# docs/theory/figures/hysteresis.svg: H against frequency of the bodies of docs/theory/memory.md.
set -eu
cd "$(dirname "$0")/.."
sinew=$(realpath "${1:-build/sinew}")
folder=$(realpath -m "${2:-docs/theory/figures}")
command -v gnuplot >/dev/null || {
    echo "figures.sh: gnuplot is missing (on Debian and Ubuntu: apt-get install gnuplot-nox)" >&2
    exit 1
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$folder"
cd "$work"

linear='law: linear, modulus: 10 kPa'
exponential='law: exponential, B: 20, C: 10 kPa'
kelvin='law: kelvin, tau_epsilon: 0.5 s, tau_sigma: 1 s'
spectrum='law: fung-spectrum, c: 0.1, tau1: 10 ms, tau2: 100 s'
sweep() { # sweep NAME ELASTIC MEMORY
    printf 'tissue: %s\nelastic: {%s}\nmemory: {%s}\n' "$1" "$2" "$3" >"$1.yaml"
    "$sinew" test "$1.yaml" --protocol hysteresis --stretch 1.2 --from "0.1 ms" --to "1e4 s" --points 81 \
        --out "$1.csv" --quiet
}
sweep maxwell "$linear" 'law: maxwell, tau: 1 s'
sweep voigt "$linear" 'law: voigt, tau: 1 s'
sweep kelvin "$linear" "$kelvin"
sweep kelvin-exponential "$exponential" "$kelvin"
sweep spectrum "$linear" "$spectrum"
sweep spectrum-exponential "$exponential" "$spectrum"

gnuplot -d <<'G'
set terminal svg size 960,400 dynamic font 'sans-serif,13' background '#ffffff' name 'hysteresis'
set output 'hysteresis.svg'
set datafile separator ','
set datafile commentschars '#'
set multiplot layout 1,2
set logscale x 10
set format x '10^{%T}'
set xrange [5e-5:5e3]
set xtics 100
set xlabel 'frequency of the test, 1/(2 ramp time) [Hz]'
set ylabel 'hysteresis H [1]'
set grid lc '#dddddd' lt 1
set border 3
set tics nomirror out
set key top center
set yrange [0:2.5]
set title 'one time: a sigmoid'
plot 'maxwell.csv' every ::1 using 1:2 with lines lw 2 lc '#0072b2' title 'Maxwell', \
     'voigt.csv' every ::1 using 1:2 with lines lw 2 lc '#d55e00' title 'Voigt'
set yrange [0:1]
set title 'nonlinear springs rescale the bell; a spectrum is flat'
plot 'kelvin.csv' every ::1 using 1:2 with lines lw 2 lc '#0072b2' title 'Kelvin, linear', \
     'kelvin-exponential.csv' every ::1 using 1:2 with lines lw 2 dt 2 lc '#0072b2' title 'Kelvin, exponential', \
     'spectrum.csv' every ::1 using 1:2 with lines lw 2 lc '#d55e00' title 'spectrum, linear', \
     'spectrum-exponential.csv' every ::1 using 1:2 with lines lw 2 dt 2 lc '#d55e00' title 'spectrum, exponential'
unset multiplot
G
mv hysteresis.svg "$folder/hysteresis.svg"
