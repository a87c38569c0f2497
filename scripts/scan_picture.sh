#!/bin/sh
# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#
# Draws a scan in its map, as the page shows it during a simulated drive:
# scripts/scan_picture.sh SCAN.png
set -eu
. "$(dirname "$0")/start_view.sh"
require_chromium "$1"
export MANYCORE_PLATFORM="picture-$$"
export ROS_DOMAIN_ID=$((1 + $$ % 100))
manycore ndt simulate build/picture-street --length 160 --beams 64 >/dev/null 2>&1
run= view= replay=
trap 'kill -INT $replay $view $run 2>/dev/null || true; wait $replay $view $run' EXIT
manycore run ndt_offload >build/picture.log 2>&1 &
run=$!
start_view
manycore ndt replay build/picture-street/drive.npz --voxel 0.2 >build/picture-replay.log 2>&1 &
replay=$!
python scripts/scan_picture.py "$link" "$1"
echo "wrote $1"
