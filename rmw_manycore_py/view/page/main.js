// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Connects to the server and hands what it says on to the parts of the page.

import { Charts } from "./charts.js";
import { Details } from "./details.js";
import { Finder } from "./finder.js";
import { Flow } from "./flow.js";
import { forgetHappened, showHappened } from "./events.js";
import { Picture } from "./picture.js";
import { setUpTheme } from "./theme.js";
import { Trace } from "./trace.js";

const RECONNECT_MS = 1000;
const stateLine = document.getElementById("state");
const totals = document.getElementById("totals");
const flow = new Flow(document.getElementById("flow"), document.getElementById("moving"));
const picture = new Picture(document.getElementById("picture"), select);
const finder = new Finder(select);
const details = new Details(select, (choice) => finder.focus(choice));
const trace = new Trace(document.getElementById("trace"));
const charts = new Charts(document.getElementById("charts"), [
  ["messages per second", (name) => name === "messages/s"],
  ["bytes per second", (name) => name === "bytes/s"],
  ["CPU of all processes, % of one", (name) => name === "CPU %"],
  ["SMEM, % of each cluster's", (name) => name.startsWith("SMEM")],
  ["fullest queue, %", (name) => name.startsWith("fullest")],
]);
let live = null;
let selected = null;

function select(choice) {
  if (choice === null && selected === null) {
    return;
  }
  selected = choice;
  flow.limit(picture.select(choice));
  details.open(choice, picture.together(choice?.topic));
  if (live !== null && live.readyState === WebSocket.OPEN) {
    live.send(JSON.stringify({ select: choice }));
  }
}

function show(news) {
  const began = performance.now();
  showState(news.state, news.there);
  if (news.svg !== undefined) {
    picture.replace(news.svg, news.arcs);
    fitPaper();
    flow.replace(picture.svg, news.arcs, news.rates);
    flow.limit(picture.select(selected));
    finder.replace(news.nodes, news.topics);
  }
  if (news.marks !== undefined) {
    picture.mark(news.marks);
    flow.mark(news.marks);
  }
  if (news.charts !== undefined) {
    charts.add(news.charts);
    showTotals(news.charts.series);
  }
  showHappened(news.happened, select);
  trace.show(news.trace, news.there);
  if (news.details !== undefined) {
    details.show(news.details);
  }
  // How long a frame takes, for benches: until the browser has painted it.
  requestAnimationFrame(() => setTimeout(() => {
    document.body.dataset.frameMs = (performance.now() - began).toFixed(1);
    document.body.dataset.frames = Number(document.body.dataset.frames ?? 0) + 1;
  }));
}

// As wide as the column, unless names become too small to read, or larger than the rest.
function fitPaper() {
  const width = picture.svg?.viewBox.baseVal.width ?? 0;
  const zoom = document.getElementById("zoom").value / 100;
  const paper = document.getElementById("paper");
  paper.style.width = `calc(clamp(${0.7 * width}px, 100%, ${1.5 * width}px) * ${zoom})`;
  flow.resize();
}

function showState(text, isThere) {
  if (stateLine.textContent !== text) {
    stateLine.textContent = text;
  }
  stateLine.classList.toggle("gone", !isThere);
  document.body.classList.toggle("gone-platform", !isThere);
}

function showTotals(series) {
  const last = (name) => Math.round((series[name] ?? [0]).at(-1) ?? 0).toLocaleString("en");
  totals.textContent = `${last("messages/s")} messages/s, CPU ${last("CPU %")} %`;
}

function connect() {
  const address = new URL("live", location.href);
  address.protocol = "ws:";
  live = new WebSocket(address);
  live.onopen = () => {
    flow.stop();
    charts.forget();
    forgetHappened(); // the server tells all of it again
    if (selected !== null) {
      live.send(JSON.stringify({ select: selected }));
    }
  };
  live.onmessage = (message) => show(JSON.parse(message.data));
  live.onclose = () => {
    showState("manycore view has ended, or cannot be reached; trying again", false);
    flow.stop();
    setTimeout(connect, RECONNECT_MS);
  };
}

setUpTheme(document.getElementById("theme"), () => {
  [charts, ...details.allCharts].forEach((one) => one.redraw());
});
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape") {
    select(null);
  } else if (event.key === "/" && event.target.tagName !== "INPUT") {
    event.preventDefault();
    document.getElementById("find").focus();
  }
});
document.getElementById("zoom").addEventListener("input", fitPaper);
connect();
