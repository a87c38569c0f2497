// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// A cloud from above, coloured by height, on the map around it in grey. y is up: north, in a map.

const BACK = 0xff1c1612; // alpha, blue, green, red; dark in both themes, like the colours
const MAP = 0xff8a7d70;
const STOPS = [[79, 134, 247], [53, 192, 160], [235, 218, 84], [240, 110, 60]]; // low to high
const COLOURS = Uint32Array.from({ length: 256 }, (_, index) => colourAt(index / 255));
const CLOUD_PX = 2;
const SHOWN_SHARE = 0.98; // of the points, when all are fitted in: single ones may be far away
const MARGIN = 1.1;
const BUTTON_STEP = 1.5;
const FREE_SHARE = 0.15; // of the picture, by which a cloud may be off its middle
const [FARTHEST, NEAREST] = [1e-4, 1e4]; // pixels per metre

export class CloudPicture {
  constructor() {
    this.place = document.getElementById("cloud");
    this.canvas = document.getElementById("cloud-canvas");
    this.judgement = document.getElementById("cloud-judgement");
    this.text = document.getElementById("cloud-text");
    this.tools = document.getElementById("cloud-tools");
    this.forget();
    this.canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoomByWheel(event);
    }, { passive: false });
    this.canvas.addEventListener("pointerdown", ({ pointerId }) => this.canvas.setPointerCapture(pointerId));
    this.canvas.addEventListener("pointermove", (event) => this.pan(event));
    const onClick = (id, act) => document.getElementById(id).addEventListener("click", act);
    onClick("cloud-in", () => this.zoom(BUTTON_STEP));
    onClick("cloud-out", () => this.zoom(1 / BUTTON_STEP));
    onClick("cloud-fit", () => this.fit());
    onClick("cloud-large", () => toggleFullScreen(this.place));
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  forget() {
    this.cloud = this.map = this.centre = null; // centre: x and y in the middle of the picture [m]
    this.follows = true; // until it is panned
    this.pxPerMetre = 1;
    this.place.hidden = this.canvas.hidden = this.tools.hidden = true;
    this.judgement.textContent = this.text.textContent = "";
  }

  // cloud: as cloud_samples.py makes it; undefined for a message that is none
  show(cloud) {
    this.map = this.map?.frame === cloud?.frame ? this.map : null;
    const isFirst = this.canvas.hidden;
    this.place.hidden = cloud === undefined;
    if (cloud === undefined) {
      return;
    }
    this.cloud = cloud.problem === undefined ? decoded(cloud) : null;
    this.canvas.hidden = this.tools.hidden = this.cloud === null;
    this.text.classList.toggle("alarm", this.cloud === null);
    if (this.cloud === null) {
      this.text.textContent = cloud.problem;
      return;
    }
    if (this.centre === null) {
      this.fit();
    } else if (this.follows) {
      this.follow();
    }
    this.tell();
    this.draw();
    if (isFirst) {
      this.place.scrollIntoView({ block: "nearest" });
    }
  }

  // map: null when the one that is shown has gone to another frame, or is empty
  showMap(map) {
    this.map = map === null ? null : decoded(map);
    this.tell();
    this.draw();
  }

  showJudgement({ text, believed }) {
    this.place.hidden = false; // a refused scan may have no cloud
    this.judgement.textContent = `newest scan: ${text}`;
    this.judgement.classList.toggle("alarm", !believed);
  }

  tell() {
    if (this.cloud === null) {
      return;
    }
    const { count, shown, frame, heights: [low, high] } = this.cloud;
    const number = (value) => value.toLocaleString("en");
    const points = shown < count ? `${number(shown)} of ${number(count)}` : number(count);
    const map = this.map === null ? "" : `; grey: ${this.map.topic}`;
    this.text.textContent = `${points} points in frame '${frame}' from above, x to the right; ` +
      `height ${metres(low)} m (blue) to ${metres(high)} m (red)${map}`;
  }

  fit() {
    const { origin, points } = this.cloud;
    const far = new Float32Array(points.length / 3).map((_, index) => (
      Math.max(Math.abs(points[3 * index]), Math.abs(points[3 * index + 1]))
    )).sort();
    const reach = MARGIN * Math.max(far[Math.floor(SHOWN_SHARE * (far.length - 1))], 1);
    this.centre = [origin[0], origin[1]];
    this.follows = true;
    this.pxPerMetre = Math.min(this.canvas.clientWidth, this.canvas.clientHeight) / 2 / reach;
    this.draw();
  }

  // Not from cloud to cloud, or the map would tremble.
  follow() {
    const { origin: [x, y] } = this.cloud;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const away = [Math.abs(x - this.centre[0]) / width, Math.abs(y - this.centre[1]) / height];
    if (Math.max(...away) * this.pxPerMetre > FREE_SHARE) {
      this.centre = [x, y];
    }
  }

  // As in RViz, zooming does not end following: the middle stays in place, or following would take
  // back what the pointer has moved. A panned view zooms about the pointer, as maps do.
  zoomByWheel({ deltaY, offsetX, offsetY }) {
    this.zoom(Math.exp(-deltaY / 500), ...(this.follows ? [] : [offsetX, offsetY]));
  }

  // The place at these pixels stays there; by default that of the middle.
  zoom(wanted, x = this.canvas.clientWidth / 2, y = this.canvas.clientHeight / 2) {
    const factor = Math.min(Math.max(this.pxPerMetre * wanted, FARTHEST), NEAREST) / this.pxPerMetre;
    const [right, up] = [x - this.canvas.clientWidth / 2, this.canvas.clientHeight / 2 - y];
    const metres = (1 - 1 / factor) / this.pxPerMetre;
    this.centre = [this.centre[0] + right * metres, this.centre[1] + up * metres];
    this.pxPerMetre *= factor;
    this.draw();
  }

  pan({ buttons, movementX, movementY }) {
    if (buttons !== 0) {
      const [x, y] = this.centre;
      this.centre = [x - movementX / this.pxPerMetre, y + movementY / this.pxPerMetre];
      this.follows = false;
      this.draw();
    }
  }

  draw() {
    const { canvas } = this;
    if (this.cloud === null || canvas.clientWidth === 0) {
      return;
    }
    const ratio = devicePixelRatio;
    canvas.width = Math.round(canvas.clientWidth * ratio);
    canvas.height = Math.round(canvas.clientHeight * ratio);
    const context = canvas.getContext("2d");
    const image = context.createImageData(canvas.width, canvas.height);
    const pixels = new Uint32Array(image.data.buffer).fill(BACK);
    const paint = (cloud, size, colourOf) => paintPoints(
      { pixels, width: canvas.width, height: canvas.height },
      { cloud, centre: this.centre, pxPerMetre: this.pxPerMetre * ratio, size, colourOf },
    );
    if (this.map !== null) {
      paint(this.map, 1, () => MAP);
    }
    const { heights: [low, high] } = this.cloud;
    const perMetre = 255 / Math.max(high - low, 0.1);
    const base = this.cloud.origin[2] - low;
    paint(this.cloud, Math.round(CLOUD_PX * ratio), (z) => (
      COLOURS[Math.min(Math.max((base + z) * perMetre, 0), 255) | 0]
    ));
    context.putImageData(image, 0, 0);
    context.scale(ratio, ratio);
    drawScale(context, canvas.clientHeight, this.pxPerMetre);
  }
}

function metres(value) {
  return (Math.round(10 * value) / 10 + 0).toFixed(1); // + 0: no -0.0
}

function decoded(cloud) {
  const bytes = Uint8Array.from(atob(cloud.points), (one) => one.charCodeAt(0));
  return { ...cloud, points: new Float32Array(bytes.buffer) };
}

function colourAt(share) {
  const place = share * (STOPS.length - 1);
  const index = Math.min(Math.floor(place), STOPS.length - 2);
  const [red, green, blue] = STOPS[index].map((low, channel) => (
    Math.round(low + (place - index) * (STOPS[index + 1][channel] - low))
  ));
  return (0xff << 24 | blue << 16 | green << 8 | red) >>> 0;
}

// Squares of `size` pixels, the later over the earlier ones: points are sorted by height.
function paintPoints({ pixels, width, height }, { cloud, centre, pxPerMetre, size, colourOf }) {
  const { origin, points } = cloud;
  const left = width / 2 + (origin[0] - centre[0]) * pxPerMetre - size / 2;
  const top = height / 2 - (origin[1] - centre[1]) * pxPerMetre - size / 2;
  for (let index = 0; index < points.length; index += 3) {
    const column = Math.round(left + points[index] * pxPerMetre);
    const row = Math.round(top - points[index + 1] * pxPerMetre);
    if (column >= 0 && row >= 0 && column + size <= width && row + size <= height) {
      const colour = colourOf(points[index + 2]);
      for (let line = row; line < row + size; line++) {
        pixels.fill(colour, line * width + column, line * width + column + size);
      }
    }
  }
}

// A bar of 1, 2 or 5 times a power of ten metres.
function drawScale(context, height, pxPerMetre) {
  const maxMetres = 120 / pxPerMetre;
  const power = 10 ** Math.floor(Math.log10(maxMetres));
  const metres = ([5, 2].find((one) => one * power <= maxMetres) ?? 1) * power;
  const length = metres * pxPerMetre;
  context.fillStyle = context.strokeStyle = "#ffffff";
  context.font = "12px system-ui, sans-serif";
  context.fillText(`${metres.toLocaleString("en", { maximumSignificantDigits: 1 })} m`, 14, height - 18);
  context.fillRect(10, height - 12, length, 2);
  context.fillRect(10, height - 16, 1, 6);
  context.fillRect(10 + length - 1, height - 16, 1, 6);
}

function toggleFullScreen(place) {
  if (document.fullscreenElement === null) {
    place.requestFullscreen();
  } else {
    document.exitFullscreen();
  }
}
