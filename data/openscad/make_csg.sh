#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes each .csg of this folder again from its .scad and says which ones changed.
#
#   make_csg.sh           writes the files; prints "changed NAME" or "new NAME"
#   make_csg.sh --check   writes nothing here; exit 1 if a file would change
#   make_csg.sh [--check] NAME...   only these models (without an ending)
#
# OpenSCAD exits 0 on warnings, errors and failed assertions and then writes a shortened file, so its
# standard error is read as well.
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
check=no
if [ "${1:-}" = --check ]; then
  check=yes
  shift
fi
command -v openscad >/dev/null || { echo "make_csg.sh: openscad is not installed" >&2; exit 2; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# OpenSCAD looks for a display and a settings folder; give it neither a chance to matter.
export HOME="$work" QT_QPA_PLATFORM=offscreen

status=0
if [ $# -eq 0 ]; then
  set -- $(cd "$here" && ls ./*.scad | sed -e 's|^\./||' -e 's|\.scad$||')
fi
for name in "$@"; do
  made="$work/$name.csg"
  # Run inside the folder: a .csg names files relative to its source.
  if ! (cd "$here" && openscad --render -o "$made" "$name.scad") 2>"$work/messages" ||
    grep -Eq 'WARNING|ERROR|TRACE|DEPRECATED' "$work/messages"; then
    echo "failed $name" >&2
    cat "$work/messages" >&2
    status=1
    continue
  fi
  # When a file that a model names was last touched is no part of the model.
  sed -i "s/timestamp = [0-9]*/timestamp = 0/" "$made"
  kept="$here/$name.csg"
  if [ -f "$kept" ] && cmp -s "$made" "$kept"; then continue; fi
  if [ -f "$kept" ]; then echo "changed $name"; else echo "new $name"; fi
  if [ "$check" = yes ]; then status=1; else cp "$made" "$kept"; fi
done
exit $status
