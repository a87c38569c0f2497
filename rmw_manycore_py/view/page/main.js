// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Connects to the server and hands what it says on to the parts of the page.

import { Charts } from "./charts.js";
import { Details } from "./details.js";
import { Finder } from "./finder.js";
import { Flow } from "./flow.js";
import { forgetHappened, showHappened } from "./events.js";
import { Picture } from "./picture.js";
import { setUpTheme } from "./theme.js";
import { Timeline } from "./timeline.js";
import { Trace } from "./trace.js";

const RECONNECT_MS = 1000;
const stateLine = document.getElementById("state");
const zoom = document.getElementById("zoom");
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
  ["SMEM, % of each cluster's", (name) => name.startsWith("SMEM") && name.endsWith("%")],
  ["SMEM, bytes", (name) => name.startsWith("SMEM") && name.endsWith("bytes")],
  ["fullest queue, %", (name) => name.startsWith("fullest")],
]);
const timeline = new Timeline((step) => send({ seek: step }), (seconds) => tell({ seconds }));
let live = null;
let selected = null;
let isOfTrace = false;
let others = null; // the pages of other traces beside this one

function select(choice) {
  if (choice !== null || selected !== null) {
    take(choice, true);
    tell({ choice });
  }
}

// isHere: whether it was chosen on this page, which then has the keyboard
function take(choice, isHere) {
  selected = choice;
  flow.limit(picture.select(choice));
  details.open(choice, picture.together(choice?.topic), isHere);
  send({ select: choice });
}

function send(message) {
  if (live !== null && live.readyState === WebSocket.OPEN) {
    live.send(JSON.stringify(message));
  }
}

function tell(message) {
  others?.postMessage(message);
}

function show(news) {
  const began = performance.now();
  showState(news.state, news.there);
  if (news.position !== null) {
    showMoment(news.position);
  }
  if (news.svg !== undefined) {
    picture.replace(news.svg, news.arcs);
    if (window.parent !== window && zoom.value === zoom.defaultValue) {
      zoom.value = zoomToWhole(); // one above another, each is seen whole
    }
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
  }
  if (news.totals !== undefined) {
    showTotals(news.totals);
  }
  showHappened(news.happened, isOfTrace, select);
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

function zoomToWhole() {
  const { width, height } = picture.svg.viewBox.baseVal;
  const stage = document.getElementById("stage");
  return Math.min(100, (100 * stage.clientHeight / stage.clientWidth) * (width / height));
}

// As wide as the column, unless names become too small to read, or larger than the rest.
function fitPaper() {
  const width = picture.svg?.viewBox.baseVal.width ?? 0;
  const paper = document.getElementById("paper");
  paper.style.width = `calc(clamp(${0.7 * width}px, 100%, ${1.5 * width}px) * ${zoom.value / 100})`;
  flow.resize();
}

function showState(text, isThere) {
  if (stateLine.textContent !== text) {
    stateLine.textContent = text;
  }
  stateLine.classList.toggle("gone", !isThere);
  document.body.classList.toggle("gone-platform", !isThere);
}

function showMoment(position) {
  if (!isOfTrace) {
    isOfTrace = true;
    document.body.classList.add("of-trace");
    [charts, details.charts].forEach((one) => one.beOfTrace((seconds) => timeline.byHand(seconds)));
    trace.showChains();
    others = new BroadcastChannel(location.pathname.split("/")[1]); // those of this server
    others.onmessage = ({ data }) => ("choice" in data ? take(data.choice, false) : timeline.follow(data.seconds));
  }
  timeline.show(position);
  const seconds = position.step === null ? null : timeline.secondsOf(position.step);
  [charts, details.charts].forEach((one) => one.moveTo(seconds));
}

function showTotals(values) {
  const rounded = (name) => Math.round(values[name]).toLocaleString("en");
  totals.textContent = `${rounded("messages/s")} messages/s, CPU ${rounded("CPU %")} %`;
}

function connect() {
  const address = new URL("live", location.href);
  address.protocol = "ws:";
  live = new WebSocket(address);
  let isFirst = true;
  live.onopen = () => {
    flow.stop();
    if (selected !== null) {
      send({ select: selected });
    }
    if (isOfTrace) {
      send({ seek: timeline.wanted }); // the server begins with the whole run
    }
  };
  live.onmessage = (message) => {
    if (isFirst) { // it tells again all that is shown until then
      charts.forget();
      forgetHappened();
      isFirst = false;
    }
    show(JSON.parse(message.data));
  };
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
zoom.addEventListener("input", fitPaper);
connect();
