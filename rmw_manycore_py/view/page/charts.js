// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Time series: one chart per group of series.

import uPlot from "./uplot/uPlot.esm.js";

const LENGTH = 600;
const COMPACT = new Intl.NumberFormat("en", { notation: "compact" });
// Each of a contrast of 3 on both panels.
const COLOURS = ["#3b7dd8", "#b35c00", "#4f8f5b", "#a95fca", "#d9433b", "#00838f"];

export class Charts {
  // groups: [title, which series belong to it]; fromZero: whether the curves show where zero is
  constructor(place, groups, fromZero = true) {
    this.place = place;
    this.groups = groups;
    this.fromZero = fromZero;
    this.onPick = null; // of a trace: called with the moment that was clicked
    this.moment = null; // of a trace, in seconds since its begin; null: the whole
    new ResizeObserver(() => this.plots.forEach(([plot]) => plot.setSize(this.size()))).observe(place);
    this.forget();
  }

  forget() {
    this.times = [];
    this.series = new Map();
    this.plots = [];
    this.place.replaceChildren();
  }

  // news: {times, series: {name: values}, all}
  add(news) {
    if (news.all) {
      this.times = [];
      this.series.clear();
    }
    const names = Object.keys(news.series);
    const isOther = names.join() !== [...this.series.keys()].join();
    for (const name of new Set([...this.series.keys(), ...names])) {
      const known = this.series.get(name) ?? this.times.map(() => null);
      known.push(...(news.series[name] ?? news.times.map(() => null)));
      this.series.set(name, known.slice(-LENGTH));
    }
    this.times = [...this.times, ...news.times].slice(-LENGTH);
    if (isOther || news.all) {
      this.redraw();
    } else {
      this.plots.forEach(([plot, own]) => plot.setData(this.data(own)));
    }
    this.tell();
  }

  // The charts of a trace: its times are seconds since its begin, and a click chooses one.
  beOfTrace(onPick) {
    this.onPick = onPick;
  }

  moveTo(seconds) {
    this.moment = seconds;
    this.tell();
  }

  tell() {
    for (const [plot, own, latest] of this.plots) {
      latest.textContent = this.latest(own);
      if (this.onPick !== null) {
        plot.setCursor({ left: this.moment === null ? -10 : plot.valToPos(this.moment, "x"), top: 0 });
      }
    }
  }

  // The index of the look whose values stand beside the curves.
  look() {
    if (this.onPick === null) {
      return this.times.length - 1;
    }
    return this.moment === null ? -1 : this.times.findIndex((time) => time >= this.moment - 1e-6);
  }

  // The newest values in words, beside the curves.
  latest(names) {
    const look = this.look();
    if (look < 0) {
      return "";
    }
    const values = names.map((name) => {
      const value = this.series.get(name)[look];
      const text = value === null || value === undefined ? "nothing" : COMPACT.format(value);
      return names.length > 1 ? `${name} ${text}` : text;
    });
    return values.join(", ");
  }

  data(names) {
    return [this.times, ...names.map((name) => this.series.get(name))];
  }

  size() {
    return { width: Math.max(this.place.clientWidth, 240), height: 110 };
  }

  redraw() {
    this.plots.forEach(([plot]) => plot.destroy());
    this.place.replaceChildren();
    this.plots = [];
    for (const [title, belongs] of this.groups) {
      const names = [...this.series.keys()].filter(belongs).filter((name) => this.isKnown(name));
      if (names.length > 0) {
        this.plots.push(this.plot(title, names));
      }
    }
    this.tell();
  }

  // What a trace does not tell is not shown.
  isKnown(name) {
    return this.onPick === null || this.series.get(name).some((value) => value !== null);
  }

  plot(title, names) {
    const figure = document.createElement("figure");
    const caption = document.createElement("figcaption");
    caption.textContent = title || names.join(", ");
    const latest = document.createElement("output");
    latest.setAttribute("aria-live", "off");
    figure.append(caption, latest);
    this.place.append(figure);
    const style = getComputedStyle(document.documentElement);
    const axis = {
      stroke: style.getPropertyValue("--quiet"),
      grid: { stroke: style.getPropertyValue("--edge"), width: 1 },
      size: 46,
      values: (_, values) => values.map((value) => COMPACT.format(value)),
    };
    const options = {
      ...this.size(),
      legend: { show: names.length > 1, live: false },
      cursor: { y: false, drag: { x: this.onPick === null } },
      axes: [{ ...axis, size: 24, values: undefined }, axis],
      scales: { x: { time: this.onPick === null }, y: this.fromZero ? { range: withZero } : {} },
      series: [{}, ...names.map((label, index) => (
        { label, stroke: COLOURS[index % COLOURS.length], width: 1.5, points: { show: false } }
      ))],
    };
    const plot = new uPlot(options, this.data(names), figure);
    plot.root.setAttribute("aria-hidden", "true"); // curves and legend; the values are in `latest`
    plot.over.addEventListener("mouseleave", () => this.tell());
    plot.over.addEventListener("click", () => this.onPick?.(plot.posToVal(plot.cursor.left, "x")));
    return [plot, names, latest];
  }
}

function withZero(_, low, high) {
  return [Math.min(low ?? 0, 0), Math.max(high ?? 1, 1)];
}
