#!/bin/sh
# Fetches the gallery's meshes from a Debian package without installing it: demos/fetch.sh [DIR], default build/data.
# Keeps what is there; exit 1 with one line when the package can't be had (the gallery then uses its built-in meshes).
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
data=${1:-$root/build/data}
package=libcgal-demo
archive=usr/share/doc/libcgal-dev/data.tar.gz
meshes='armadillo bunny00 ChineseDragon-10kv lion-head refined_elephant camel'

missing=
for mesh in $meshes; do
  [ -s "$data/meshes/$mesh.off" ] || missing="$missing $mesh"
done
[ -n "$missing" ] || exit 0

fail() {
  echo "demos/fetch.sh: $1; the gallery will use its built-in meshes instead of:$missing" >&2
  exit 1
}
command -v apt-get >/dev/null && command -v dpkg-deb >/dev/null || fail "no apt-get and dpkg-deb here"
mkdir -p "$data/meshes"
work=$(mktemp -d "$data/fetch.XXXXXX")
trap 'rm -rf "$work"' EXIT
chmod 755 "$work" # apt's own user writes here when root downloads
echo "demos/fetch.sh: fetching $package (24 MB) for its meshes" >&2
(cd "$work" && apt-get download "$package" >log 2>&1) ||
  fail "'apt-get download $package' failed ($(tail -n 1 "$work/log" 2>/dev/null); try 'apt-get update' first)"
dpkg-deb --fsys-tarfile "$work"/"$package"_*.deb | tar -x -C "$work" -f - "./$archive" ||
  fail "$package holds no $archive"
for mesh in $missing; do
  tar -x -z -C "$work" -f "$work/$archive" "data/meshes/$mesh.off" || fail "$archive holds no data/meshes/$mesh.off"
  mv "$work/data/meshes/$mesh.off" "$data/meshes/$mesh.off"
done
