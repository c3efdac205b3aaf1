#!/usr/bin/env bash
# install.sh CMAKE BUILD: what `cmake --install` puts into a folder is all that is used, and is used
# from there.
set -euo pipefail
cmake=$1 build=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "install: $*" >&2; exit 1; }

"$cmake" --install "$build" --prefix "$folder/local" >/dev/null
cat >"$folder/expected" <<'FILES'
bin/tesserae
share/bash-completion/completions/tesserae
share/doc/tesserae/CHANGELOG.md
share/doc/tesserae/copyright
share/fish/vendor_completions.d/tesserae.fish
share/man/man1/tesserae.1
share/zsh/site-functions/_tesserae
FILES
(cd "$folder/local" && find . -type f -printf '%P\n') | LC_ALL=C sort >"$folder/found"
diff "$folder/expected" "$folder/found" || fail "other files than expected"

# The program finds its libraries, and does the same as the build's.
program=$folder/local/bin/tesserae
for words in --version "reference man"; do
    [ "$("$program" $words)" = "$("$build/tesserae" $words)" ] || fail "tesserae $words: differs"
done
"$program" generate pile --bodies 20 >"$folder/pile.toml"
for at in "$program" "$build/tesserae"; do
    rm -f "$folder/pile.h5"
    "$at" simulate "$folder/pile.toml" -o "$folder/pile.h5" --set physics.duration=0.1 --quiet >/dev/null
    "$at" hash "$folder/pile.h5" >>"$folder/hashes"
done
[ "$(wc -l <"$folder/hashes")" = 2 ] || fail "no hashes"
[ "$(sort -u "$folder/hashes" | wc -l)" = 1 ] || fail "bodies move otherwise"

# Its pages and completions are found where programs look for them.
if command -v man >/dev/null; then
    [ "$(man -M "$folder/local/share/man" -w tesserae)" = "$folder/local/share/man/man1/tesserae.1" ] ||
        fail "man does not find its page"
fi
. "$folder/local/share/bash-completion/completions/tesserae"
complete -p tesserae >/dev/null || fail "bash has no completion"

# Where packages of Debian put them, a folder for its zsh.
"$cmake" --install "$build" --prefix "$folder/usr" >/dev/null
if [ -e /etc/debian_version ]; then
    [ -f "$folder/usr/share/zsh/vendor-completions/_tesserae" ] || fail "no completion for Debian's zsh"
fi
