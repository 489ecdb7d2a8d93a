#!/bin/sh
# Sets up the peers in out/peers: setup.sh PYTHON
set -eu
here=$(dirname "$0"); out="$here/../../out/peers"
mkdir -p "$out"
if [ ! -x "$out/venv/bin/ncsim" ]; then
  "$1" -m venv "$out/venv"
  "$out/venv/bin/python" -m pip install --quiet --disable-pip-version-check anrg-ncsim==1.0.0
fi
if [ -e /usr/include/simgrid/s4u.hpp ]; then
  g++ -O2 -o "$out/simgrid_lv08" "$here/simgrid_lv08.cpp" -lsimgrid
else
  echo "SimGrid is not installed (Debian: libsimgrid-dev); left out"
fi
