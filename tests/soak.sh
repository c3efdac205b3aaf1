#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the program for a long time and watches it: memory, open files, energy.
#   bash tests/soak.sh [SECONDS]    an hour by default; writes bench/results/soak.csv and soak.png
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/../scenes/setup.sh"
install_packages "${packages[@]}" python3
build "$root/build/release" tesserae -DCMAKE_BUILD_TYPE=Release
python3 "$root/tests/soak/soak.py" "$root/build/release/tesserae" "${1:-3600}" "$root/bench/results/soak.csv"
gnuplot -e "set terminal pngcairo size 900,420 font 'DejaVu Sans,11'; set output '$root/bench/results/soak.png'; \
    set datafile separator ','; set key left top; set xlabel 'time [s]'; set ylabel 'resident memory [MB]'; \
    set yrange [0:*]; set grid; \
    plot '< grep ^simulate $root/bench/results/soak.csv' using 2:3 with lines lw 2 title 'simulate, 10,000 boxes, sleeping', \
         '< grep ^render $root/bench/results/soak.csv' using 2:3 with lines lw 2 title 'render, small frames'"
