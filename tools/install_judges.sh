#!/bin/sh
# Programs of others that judge our readers in the browser tests (tests/judges), once for each state of their lock file.
set -u

folder="$(dirname "$0")/../tests/judges"
if [ -f "$folder/node_modules/.lock" ] && cmp -s "$folder/package-lock.json" "$folder/node_modules/.lock"; then
    exit 0
fi
echo "Installing the judges of the browser tests ..."
"$1" "$(dirname "$0")/../hatch_build.py" judges ci --no-audit --no-fund --loglevel=error &&
    cp "$folder/package-lock.json" "$folder/node_modules/.lock" && exit 0
echo "They could not be installed: the tests that they judge are skipped."
