#!/usr/bin/env bash
# Compiles examples/stream/prostm_receiver.cpp for Windows and runs it under Wine against a stream on this machine.
#
# usage: tools/windows_receiver.sh [BUILD]     BUILD is the folder with the program (default: build/release)
#
# Installs nothing: it names missing Debian packages. Wine uses a prefix in BUILD and leaves the user's own unchanged.
# The receiver must get samples, lose none that prostm sent over TCP, and be silent at the end.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
build=$(realpath "${1:-$root/build/release}")
compiler=x86_64-w64-mingw32-g++-posix
wine=$(command -v wine64 || command -v wine || ls /usr/lib/wine/wine64 2>/dev/null || true)

missing=()
command -v "$compiler" >/dev/null || missing+=(g++-mingw-w64-x86-64-posix)
[ -n "$wine" ] || missing+=(wine64)
if [ ${#missing[@]} -gt 0 ]; then
  echo "missing: ${missing[*]}; on Debian: apt-get install ${missing[*]}" >&2
  exit 2
fi
if [ ! -x "$build/prostm" ]; then
  echo "$build/prostm is missing; build it first: ./run build" >&2
  exit 2
fi

work=$(mktemp -d)
sender=
clean() {
  [ -z "$sender" ] || kill "$sender" 2>/dev/null || true
  rm -rf "$work"
}
trap clean EXIT

"$compiler" -std=c++17 -O2 -Wall -Wextra -static "$root/examples/stream/prostm_receiver.cpp" -o "$work/prostm_receiver.exe" \
  -lws2_32
echo "compiled: $(du -k "$work/prostm_receiver.exe" | cut -f1) kB"
export WINEPREFIX="$build/wine" WINEDEBUG=-all WINEDLLOVERRIDES="mscoree,mshtml=" DISPLAY=
"$wine" wineboot --init >/dev/null 2>&1 || true

port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
"$build/prostm" run --device "stream://127.0.0.1:$port" --seconds 60 --grid 32 >"$work/prostm.txt" 2>&1 &
sender=$!
for over in "" --udp; do
  echo "over ${over:-tcp}:"
  "$wine" "$work/prostm_receiver.exe" "127.0.0.1:$port" $over --seconds 8 | tr -d '\r' >"$work/receiver.txt"
  tail -1 "$work/receiver.txt"
  python3 - "$work/receiver.txt" <<'EOF'
import json
import sys

last = json.loads(open(sys.argv[1], encoding="utf-8").read().splitlines()[-1])
assert last["samples"] > 100_000, "too few samples came"
assert last["malformed"] == 0, "messages were malformed"
EOF
done

echo "kill -9 of prostm while it is received:"
"$wine" "$work/prostm_receiver.exe" "127.0.0.1:$port" --seconds 6 >"$work/killed.txt" &
receiver=$!
sleep 4
kill -9 "$sender"
wait "$sender" 2>/dev/null || true
sender=
wait "$receiver"
tr -d '\r' <"$work/killed.txt" | grep '^silent [-0-9]' | tail -1 || {
  echo "the receiver did not fall silent" >&2
  exit 1
}
