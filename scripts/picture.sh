#!/bin/sh
# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#
# Draws a run of the image pipeline and, if Chromium is installed, the page that shows it:
# scripts/picture.sh CHIP.svg PAGE.png
set -eu
. "$(dirname "$0")/start_view.sh"
export MANYCORE_PLATFORM="picture-$$"
topic=/camera/image_inverted
manycore run image_pipeline >build/picture.log 2>&1 &
run=$!
view=
trap 'kill -INT $view $run 2>/dev/null || true; wait $view $run' EXIT
# Waits for the topic, and then for a message that has passed the pipeline.
manycore topic echo --once --no-arr $topic sensor_msgs/msg/Image >/dev/null
manycore view --once --period 3 -o "$1"
echo "wrote $1"
require_chromium "$2"
start_view
python scripts/page_picture.py "$link" $topic "$2"
echo "wrote $2"
