#!/bin/sh
# A Chromium for the browser tests: the one that is there, else the distribution's, if we may install it.
set -u

for browser in "${ELBOWROOM_CHROMIUM:-}" chromium-headless-shell chrome-headless-shell \
    chromium chromium-browser google-chrome google-chrome-stable; do
    if [ -n "$browser" ] && command -v "$browser" >/dev/null 2>&1; then
        exit 0
    fi
done

if [ "$(id -u)" = 0 ]; then
    as_root=""
elif command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then
    as_root="sudo -n"
else
    echo "No Chromium here, and no right to install one: the browser tests are skipped (sudo apt install chromium)."
    exit 0
fi

if command -v apt-get >/dev/null 2>&1; then
    echo "Installing Chromium from the distribution ..."
    export DEBIAN_FRONTEND=noninteractive
    $as_root apt-get update -qq >/dev/null 2>&1
    # The one without windows is smaller and opens pages at half the cost; not every distribution has it.
    for browser in chromium-headless-shell chromium; do
        $as_root apt-get install -y -qq --no-install-recommends "$browser" fonts-dejavu-core >/dev/null 2>&1 &&
            command -v "$browser" >/dev/null 2>&1 && exit 0
    done
fi
echo "Chromium could not be installed: the browser tests are skipped (install it, or set ELBOWROOM_CHROMIUM to one)."
