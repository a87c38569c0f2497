// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Messages that move along the topics. Drawn on a canvas above the picture, so that the picture
// itself is not painted anew; a dot stands for a message up to MAX_DOTS_HZ per second.

const MAX_DOTS_HZ = 8;
const MAX_CURVES = 150;
const TRAVEL_S = 1.2;
const FRAME_MS = 50;

export class Flow {
  constructor(canvas, toggle) {
    this.canvas = canvas;
    this.toggle = toggle;
    this.arcs = new Map();
    this.rates = new Map();
    this.viewBox = null;
    this.timer = null;
    toggle.checked = !matchMedia("(prefers-reduced-motion: reduce)").matches;
    toggle.addEventListener("change", () => this.run());
    document.addEventListener("visibilitychange", () => this.run());
    addEventListener("resize", () => this.resize());
  }

  replace(svg, arcs, rates) {
    this.viewBox = svg.viewBox.baseVal;
    this.arcs = new Map(Object.entries(arcs));
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

  // The busiest topics' curves, each with its rate.
  moving() {
    const busiest = [...this.rates].filter(([, rate]) => rate > 0).sort((a, b) => b[1] - a[1]);
    const found = [];
    for (const [id, rate] of busiest) {
      for (const curve of this.arcs.get(id) ?? []) {
        if (found.length === MAX_CURVES) {
          return found;
        }
        found.push([curve, Math.min(rate, MAX_DOTS_HZ)]);
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
    context.fillStyle = getComputedStyle(document.body).getPropertyValue("--accent");
    const now = performance.now() / 1000;
    for (const [curve, rate] of this.moving()) {
      const gap = 1 / (rate * TRAVEL_S);
      for (let at = (now / TRAVEL_S) % gap; at < 1; at += gap) {
        const [x, y] = pointOn(curve, at);
        context.beginPath();
        context.arc(x * scale, y * scale, 3, 0, 2 * Math.PI);
        context.fill();
      }
    }
  }
}

function pointOn([x0, y0, x1, y1, x2, y2], at) {
  const a = (1 - at) * (1 - at);
  const b = 2 * at * (1 - at);
  const c = at * at;
  return [a * x0 + b * x1 + c * x2, a * y0 + b * y1 + c * y2];
}
