#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the gallery's contact sheets, scenes/gallery/contact.jpg and joints.jpg: a row of four moments
# for each film, in the order of the manual's page on pictures. Takes some minutes on two cores; frames
# stay in out/gallery.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
install_packages "${packages[@]}"
build "$root/build/release" tesserae -DCMAKE_BUILD_TYPE=Release

# sheet NAME FILM:FRAMES...: the frames of each film, a row each, become scenes/gallery/NAME.jpg.
sheet() {
    local sheet=$root/scenes/gallery/$1.jpg stills=() film name frames frame folder number i
    shift
    for film in "$@"; do
        name=${film%%:*} frames=${film#*:} folder=$root/out/gallery/${film%%:*}
        "$root/build/release/tesserae" run "$root/scenes/gallery/$name.toml" -o "$folder" \
            --size 480x270 --samples 16 --frames "$frames" --quiet >&2
        for frame in ${frames//,/ }; do
            stills+=(-i "$(printf '%s/preview/%s.%04d.png' "$folder" "$name" "$frame")")
        done
    done

    number=$((${#stills[@]} / 2))
    local scaled inputs layout
    scaled=$(for ((i = 0; i < number; ++i)); do printf '[%d:v]scale=240:135:flags=area[s%d];' "$i" "$i"; done)
    inputs=$(for ((i = 0; i < number; ++i)); do printf '[s%d]' "$i"; done)
    layout=$(for ((i = 0; i < number; ++i)); do printf '%d_%d|' $((i % 4 * 240)) $((i / 4 * 135)); done)
    ffmpeg -hide_banner -loglevel error -y "${stills[@]}" -filter_complex \
        "$scaled${inputs}xstack=inputs=$number:layout=${layout%|}" \
        -q:v 5 -frames:v 1 -update 1 "$sheet"
    ls -l "$sheet" >&2
}

sheet contact first:6,18,30,44 shapes:14,26,38,66 drum:10,30,50,70 tower:4,21,27,90 dominoes:4,14,26,90 \
    polychora:4,20,34,66 heap:4,18,24,90 race:4,24,44,66 turn:4,30,60,90
sheet joints car:30,60,100,240 pendulum:4,72,135,216 chain:30,102,112,128 wrecking:12,22,44,72 \
    tesseract:10,30,48,163
