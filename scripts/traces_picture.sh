#!/bin/sh
# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#
# Draws a run of the image pipeline above its prediction, as the page shows them:
# scripts/traces_picture.sh TRACES.png
set -eu
. "$(dirname "$0")/start_view.sh"
require_chromium "$1"
export MANYCORE_PLATFORM="picture-$$"
profile=build/picture.profile.json
manycore profile record image_pipeline --duration 10 -o $profile >build/picture.log
manycore run image_pipeline --duration 10 --trace build/measured.json >>build/picture.log
manycore simulate image_pipeline --profile $profile --duration 10 --trace build/simulated.json \
  >>build/picture.log
view=
trap 'kill -INT $view 2>/dev/null || true; wait $view' EXIT
start_view --file build/measured.json --file build/simulated.json
python scripts/traces_picture.py "$link" /camera/image_inverted "$1"
echo "wrote $1"
