# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#
# For scripts that draw the page. Sets `view` to the process and `link` to the URL of a new viewer,
# which gets all arguments.
# Fails if the viewer ends, or prints no link within 30 s.
start_view() {
  log=build/picture-view.log
  rm -f $log
  manycore view --port 0 "$@" >$log 2>&1 &
  view=$!
  tries=300
  # Not in a subshell: there the shell would not notice the end of its child.
  until link=$(grep -os "http://.*" $log); do
    tries=$((tries - 1))
    if [ $tries -eq 0 ] || ! kill -0 $view 2>/dev/null; then
      echo "manycore view does not start: $(tail -n 1 $log)" >&2
      return 1
    fi
    sleep 0.1
  done
}

# Ends the script, without an error, if there is no Chromium that draws this picture.
require_chromium() { # require_chromium PICTURE
  command -v chromium >/dev/null && command -v chromedriver >/dev/null && return
  echo "$1 is unchanged; to draw it: apt-get install chromium chromium-driver"
  exit
}
