#!/bin/sh
# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#
# Draws a run of the image pipeline: scripts/picture.sh FILE.svg
set -eu
export MANYCORE_PLATFORM="picture-$$"
manycore run image_pipeline >build/picture.log 2>&1 &
run=$!
trap 'kill -INT $run 2>/dev/null; wait $run' EXIT
# Waits for the topic, and then for a message at its end.
manycore topic echo --once --no-arr /camera/image_inverted sensor_msgs/msg/Image >/dev/null
manycore view --once --period 3 -o "$1"
echo "wrote $1"
