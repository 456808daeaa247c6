#!/bin/bash
# Checks documents and the comments of headers with Vale 3 and the rules in tools/vale/prostm.
# usage: tools/check_prose.sh
# Vale is $VALE, or `vale` on the PATH, or build/tools/vale. Without it this prints a message and succeeds:
# check_words.py applies the same rules in the tests.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
for vale in "${VALE:-vale}" "$PWD/build/tools/vale" ""; do
  [[ -n $vale ]] || { echo "skipped: there is no Vale (\$VALE, PATH, build/tools/vale)"; exit 0; }
  ! command -v "$vale" >/dev/null || break
done
git -c safe.directory='*' ls-files -z README.md CHANGELOG.md CONTRIBUTING.md SECURITY.md 'docs/*.md' 'src/*.hpp' |
  xargs -0 "$vale" --config .vale.ini --output line || exit 1
