#!/bin/sh
# Sets up what `make test-web` needs beside the virtual environment: a headless browser where it may, the packages of
# tests/web always. Without them the tests skip and name what is missing.
set -eu
cd "$(dirname "$0")/.."

browser=""
for program in chromium-headless-shell chromium google-chrome; do
    command -v "$program" >/dev/null && browser=$program
done
if [ -z "$browser" ] && command -v apt-get >/dev/null; then
    if [ "$(id -u)" = 0 ]; then as_root=""; else as_root="sudo -n"; fi
    if $as_root true 2>/dev/null; then
        $as_root apt-get update -q
        $as_root apt-get install -y -q --no-install-recommends chromium-headless-shell || true
    fi
fi
if command -v npm >/dev/null; then npm ci --silent --no-fund --no-audit --prefix tests/web; fi
