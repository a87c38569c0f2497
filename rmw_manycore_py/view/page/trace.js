// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// The button that starts a trace, and what comes of it: a file and the latency of chains.

import { get, post } from "./requests.js";

const SVG = "http://www.w3.org/2000/svg";
const HOPS = ["bridge", "communication", "node"]; // the parts that add up to a chain

export class Trace {
  constructor(button) {
    this.button = button;
    this.section = document.getElementById("trace-result");
    this.text = document.getElementById("trace-text");
    this.file = document.getElementById("trace-file");
    this.chains = document.getElementById("chains");
    this.busy = false;
    this.state = null;
    button.addEventListener("click", () => this.press());
  }

  show(state, isThere) {
    this.state = state ?? null;
    if (this.busy) {
      return;
    }
    const { on = false, events = 0 } = this.state ?? {};
    const count = events.toLocaleString("en");
    this.button.disabled = !isThere || this.state === null;
    this.button.classList.toggle("on", on);
    this.button.textContent = on
      ? `Stop and save trace (${count} events)`
      : this.waits() ? `Save trace (${count} events)` : "Start trace";
  }

  // Whether there is something to be saved, and be it how many events were lost.
  waits() {
    return this.state !== null && this.state.events + this.state.lost > 0;
  }

  async press() {
    this.busy = true;
    this.button.disabled = true;
    const saves = this.state.on || this.waits();
    const answer = await post(saves ? "trace/stop" : "trace/start");
    this.busy = false;
    this.button.disabled = false;
    this.section.hidden = false;
    if (answer.error !== undefined) {
      this.text.textContent = answer.error;
    } else if (saves) {
      this.offer(answer.result);
    } else {
      this.text.textContent = "The platform is traced: topics show their latency.";
      this.file.hidden = true;
      this.chains.replaceChildren();
    }
  }

  // What a trace file tells of its chains.
  async showChains() {
    const answer = await get("chains");
    this.section.hidden = false;
    this.text.textContent = answer.error ?? (answer.length > 0 ? "" : "No message went through a chain.");
    this.chains.replaceChildren(...(answer.error === undefined ? answer : []).map(chainOf));
  }

  offer({ file, bytes, events, lost, chains }) {
    const lostText = lost > 0 ? `, ${lost.toLocaleString("en")} more were lost` : "";
    this.text.textContent = `${events.toLocaleString("en")} events${lostText}.`;
    this.file.hidden = false;
    this.file.href = `trace/${encodeURIComponent(file)}`;
    this.file.download = file;
    this.file.textContent = `${file} (${(bytes / 1024).toFixed(0)} KiB, for ui.perfetto.dev)`;
    this.chains.replaceChildren(...chains.map(chainOf));
    this.file.focus();
  }
}

// A bar of the medians of a chain's parts, and a table of their figures.
function chainOf({ chain, nodes, parts }) {
  const place = document.createElement("div");
  place.className = "chain";
  const title = document.createElement("h3");
  title.textContent = chain.map((topic, index) => `${topic} (${nodes[index]})`).join(" > ");
  const steps = parts.filter(({ part }) => HOPS.includes(part.split(" ")[0]));
  place.append(title, barOf(steps), tableOf(parts));
  return place;
}

function barOf(steps) {
  const total = steps.reduce((sum, step) => sum + (step.p50_us || 0), 0) || 1;
  const bar = document.createElementNS(SVG, "svg");
  bar.setAttribute("class", "parts");
  bar.setAttribute("viewBox", "0 0 100 10");
  bar.setAttribute("preserveAspectRatio", "none");
  bar.setAttribute("width", "100%");
  bar.setAttribute("aria-hidden", "true");
  let x = 0;
  for (const step of steps) {
    const width = 100 * (step.p50_us || 0) / total;
    const rect = document.createElementNS(SVG, "rect");
    rect.setAttribute("class", step.part.split(" ")[0]);
    rect.setAttribute("x", x);
    rect.setAttribute("width", width);
    rect.setAttribute("height", 10);
    bar.append(rect);
    x += width;
  }
  return bar;
}

function tableOf(parts) {
  const table = document.createElement("table");
  const rows = parts.filter(({ count }) => count > 0).map(({ part, count, p50_us, p99_us, max_us }) => (
    [part, count, ...[p50_us, p99_us, max_us].map((value) => value.toFixed(1))]
  ));
  for (const [index, texts] of [["part", "count", "p50 us", "p99 us", "max us"], ...rows].entries()) {
    const row = table.insertRow();
    for (const text of texts) {
      const cell = document.createElement(index === 0 ? "th" : "td");
      cell.textContent = text;
      if (index === 0) {
        cell.scope = "col";
      }
      row.append(cell);
    }
  }
  return table;
}
