#!/bin/bash
# Tries this checkout on a bare Debian 12: minbase with git and ca-certificates only, entered by chroot.
set -euo pipefail

usage() {
  cat <<'USAGE'
usage: tools/bare_debian.sh [--folder DIR] [--keep] [COMMAND…]

Sets up a minimal Debian 12 in DIR (default: a new folder under /var/tmp), clones the commit that is checked out here
into it, runs each COMMAND there, and prints how long each step took. Without a COMMAND it runs the README's:
  './run build' './run demo' './run test'
Needs root, debootstrap and a Debian mirror; the mirror, the proxy and the certificates are this machine's own.

  --folder DIR   where to set it up; a DIR that already holds a Debian is used again
  --keep         leave the folder (a folder given by --folder always stays)

example: tools/bare_debian.sh --folder /var/tmp/bare './run test'
USAGE
}

fail() { echo "bare_debian: $*" >&2; exit 2; }
say() { echo "bare_debian: $*"; }

folder="" keep=0 commands=()
while (($#)); do
  case $1 in
    --folder) [[ $# -ge 2 ]] || fail "--folder needs a directory"; folder=$2; keep=1; shift 2 ;;
    --keep) keep=1; shift ;;
    -h | --help) usage; exit 0 ;;
    -*) fail "unknown option '$1'; see --help" ;;
    *) commands+=("$1"); shift ;;
  esac
done
((${#commands[@]})) || commands=('./run build' './run demo' './run test')
[[ $(id -u) -eq 0 ]] || fail "must be run as root, since it makes a chroot"
command -v debootstrap >/dev/null || fail "needs debootstrap: apt-get install debootstrap"
source=$(git -C "$(dirname "$0")" rev-parse --show-toplevel)

# prints the first archive from which this machine itself takes bookworm
mirror_of_host() {
  local files=(/etc/apt/sources.list.d/*.sources /etc/apt/sources.list /etc/apt/sources.list.d/*.list) file
  for file in "${files[@]}"; do
    [[ -r $file ]] || continue
    case $file in
      *.sources) awk 'BEGIN { RS = "" } /(^|\n)Suites:[^\n]*bookworm( |\n|$)/ {
                   if (match($0, /(^|\n)URIs:[ \t]*[^ \t\n]+/)) {
                     line = substr($0, RSTART, RLENGTH); sub(/.*URIs:[ \t]*/, "", line); print line; exit } }' "$file" ;;
      *) sed -nE 's/^deb +(\[[^]]*\] +)?([^ ]+) +bookworm +.*/\2/p' "$file" | head -n 1 ;;
    esac
  done | head -n 1
}

# copies the machine's access to archives: proxy and TLS settings of apt, its own certificates, name servers
copy_network_settings() {
  apt-config dump Acquire | grep -iE '^Acquire::(https?::|Retries)' >"$root/etc/apt/apt.conf.d/90host" || true
  if compgen -G '/usr/local/share/ca-certificates/*.crt' >/dev/null; then
    cp /usr/local/share/ca-certificates/*.crt "$root/usr/local/share/ca-certificates/"
    chroot "$root" update-ca-certificates >/dev/null
  fi
  rm -f "$root/etc/resolv.conf"
  cp -L /etc/resolv.conf "$root/etc/resolv.conf"
}

# removes /etc/hosts, as in minbase, so that a test that needs the name localhost fails, unless a name server knows it
forget_localhost() {
  rm -f "$root/etc/hosts"
  if in_chroot 'getent ahosts localhost >/dev/null'; then
    say "the name server here knows localhost, so a test that needs this name is NOT detected"
  fi
}

in_chroot() {
  local name proxies=()
  for name in http_proxy https_proxy no_proxy HTTP_PROXY HTTPS_PROXY NO_PROXY; do
    [[ -n ${!name:-} ]] && proxies+=("$name=${!name}")
  done
  env -i HOME=/root LANG=C.UTF-8 TERM="${TERM:-dumb}" PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
    "${proxies[@]}" chroot "$root" /bin/bash -c "$1"
}

# unmounts everything in reverse order; deletes the folder only if nothing is mounted in it any more
mounted=()
clean_up() {
  local i
  for ((i = ${#mounted[@]} - 1; i >= 0; --i)); do
    umount "${mounted[i]}" 2>/dev/null || umount -l "${mounted[i]}" || true
  done
  if ((!keep)) && ! grep -q " $root/" /proc/mounts; then rm -rf --one-file-system "$root"; fi
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

step() {
  local title=$1 start=$SECONDS status=0
  shift
  "$@" || status=$?
  times+=("$(printf '%5d s  %s%s' $((SECONDS - start)) "$title" "$( ((status)) && echo " (failed: $status)")")")
  return "$status"
}
report() {
  say "times:"
  printf '  %s\n' "${times[@]}"
}
times=()

root=$(realpath -m "${folder:-$(mktemp -d /var/tmp/prostm-bare.XXXXXX)}")
mirror=$(mirror_of_host)
[[ -n $mirror ]] || fail "found no archive of bookworm in /etc/apt/sources.list or /etc/apt/sources.list.d"

# the bare system
if [[ -e $root/etc/debian_version ]]; then
  say "using the Debian in $root"
else
  say "setting up Debian 12 (minbase, git, ca-certificates) in $root"
  mkdir -p "$root"
  step "debootstrap" debootstrap --variant=minbase --include=git,ca-certificates bookworm "$root" "$mirror" \
    >"$root.log" 2>&1 || { tail -n 20 "$root.log" >&2; fail "debootstrap failed; its log is $root.log"; }
  rm -f "$root.log"
fi
copy_network_settings
mount -t proc proc "$root/proc"
mounted+=("$root/proc")
mkdir -p "$root/dev/pts" "$root/dev/shm"
mount -t devpts -o newinstance,ptmxmode=0666 devpts "$root/dev/pts"
mounted+=("$root/dev/pts")
mount -t tmpfs tmpfs "$root/dev/shm"
mounted+=("$root/dev/shm")
forget_localhost

# a clone of this commit, through a bundle, so that only committed files get in
git -C "$source" bundle create -q "$root/srv/prostm.bundle" HEAD
rm -rf "$root/srv/prostm"
step "git clone" in_chroot "cd /srv && git -c advice.detachedHead=false clone -q prostm.bundle prostm && git -C prostm log -1 --format='%h %s'"

for command in "${commands[@]}"; do
  say "$command"
  step "$command" in_chroot "cd /srv/prostm && $command" || { report; exit 1; }
done
report
