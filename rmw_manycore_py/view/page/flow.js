// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Messages that move along the topics. Drawn on a canvas above the picture, so that the picture
// itself is not painted anew; a dot stands for a message up to MAX_DOTS_HZ per second.

const MAX_DOTS_HZ = 3;
const MAX_LINES = 150;
const SPEED = 160; // units of the picture per second
const FRAME_MS = 50;

export class Flow {
  constructor(canvas, toggle) {
    this.canvas = canvas;
    this.toggle = toggle;
    this.arcs = new Map();
    this.rates = new Map();
    this.only = null;
    this.viewBox = null;
    this.timer = null;
    toggle.checked = !matchMedia("(prefers-reduced-motion: reduce)").matches;
    toggle.addEventListener("change", () => this.run());
    document.addEventListener("visibilitychange", () => this.run());
    addEventListener("resize", () => this.resize());
  }

  replace(svg, arcs, rates) {
    this.viewBox = svg.viewBox.baseVal;
    this.arcs = new Map(Object.entries(arcs).map(([id, arc]) => [id, arc.lines.map(measured)]));
    this.rates = new Map(Object.entries(rates));
    this.resize();
    this.run();
  }

  mark(marks) {
    for (const [id, mark] of Object.entries(marks)) {
      if (mark.rate !== undefined) {
        this.rates.set(id, mark.rate);
      }
    }
    this.run();
  }

  // ids: of the arcs along which messages are shown; null for all
  limit(ids) {
    this.only = ids;
    this.run();
  }

  resize() {
    this.canvas.width = this.canvas.clientWidth;
    this.canvas.height = this.canvas.clientHeight;
  }

  stop() {
    this.rates.clear();
    this.run();
  }

  run() {
    const moves = this.toggle.checked && !document.hidden && this.moving().length > 0;
    if (moves && this.timer === null) {
      this.timer = setInterval(() => this.draw(), FRAME_MS);
    } else if (!moves && this.timer !== null) {
      clearInterval(this.timer);
      this.timer = null;
      this.draw();
    }
  }

  // The busiest topics' lines, each with its rate.
  moving() {
    const shown = [...this.rates].filter(([id, rate]) => rate > 0 && (this.only?.has(id) ?? true));
    const busiest = shown.sort((a, b) => b[1] - a[1]);
    const found = [];
    for (const [id, rate] of busiest) {
      for (const line of this.arcs.get(id) ?? []) {
        if (found.length === MAX_LINES) {
          return found;
        }
        found.push([line, Math.min(rate, MAX_DOTS_HZ)]);
      }
    }
    return found;
  }

  draw() {
    const { canvas, viewBox } = this;
    const context = canvas.getContext("2d");
    context.clearRect(0, 0, canvas.width, canvas.height);
    if (this.timer === null || viewBox === null) {
      return;
    }
    const scale = canvas.width / viewBox.width;
    const style = getComputedStyle(document.body);
    context.fillStyle = style.getPropertyValue("--accent");
    context.strokeStyle = style.getPropertyValue("--back"); // they also show on a wide line
    const now = performance.now() / 1000;
    for (const [line, rate] of this.moving()) {
      const gap = SPEED / rate;
      for (let at = (now * SPEED) % gap; at < line.length; at += gap) {
        const [x, y] = pointOn(line, at);
        context.beginPath();
        context.arc(x * scale, y * scale, 3, 0, 2 * Math.PI);
        context.fill();
        context.stroke();
      }
    }
  }
}

// numbers: x and y of each point in turn
function measured(numbers) {
  const points = [];
  let length = 0;
  for (let n = 0; n < numbers.length; n += 2) {
    const [x, y] = [numbers[n], numbers[n + 1]];
    length += n === 0 ? 0 : Math.abs(x - numbers[n - 2]) + Math.abs(y - numbers[n - 1]);
    points.push({ x, y, at: length });
  }
  return { points, length };
}

function pointOn({ points }, at) {
  const next = points.findIndex((point) => point.at >= at);
  const [from, to] = [points[Math.max(next - 1, 0)], points[next]];
  const share = to.at > from.at ? (at - from.at) / (to.at - from.at) : 0;
  return [from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)];
}
