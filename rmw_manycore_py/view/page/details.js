// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// The node or topic that was clicked.

import { Charts } from "./charts.js";
import { Control } from "./control.js";
import { post } from "./requests.js";
import { Samples } from "./samples.js";

const FIGURES = ["size", "copies", "held", "queue", "lost", "superseded", "deadlines_missed"];
const WORDS = { deadlines_missed: "deadlines missed" };

export class Details {
  // onLost: called with what was shown, when the element that had opened it is gone.
  constructor(onSelect, onLost) {
    this.onSelect = onSelect;
    this.onLost = onLost;
    this.opener = null;
    this.section = document.getElementById("details");
    this.title = document.getElementById("details-title");
    this.facts = document.getElementById("details-facts");
    this.together = document.getElementById("together");
    this.endpoints = document.getElementById("endpoints");
    this.parameters = document.getElementById("details-parameters");
    this.parametersText = document.getElementById("parameters-text");
    this.charts = new Charts(
      document.getElementById("details-charts"),
      ["messages/s", "bytes/s", "queue %", "CPU %"].map((own) => [own, (name) => name === own]),
    );
    this.control = new Control();
    this.samples = new Samples();
    this.allCharts = [this.charts, this.samples.charts];
    this.choice = null;
    document.getElementById("details-close").addEventListener("click", () => onSelect(null));
    document.getElementById("parameters").addEventListener("click", () => this.ask());
  }

  // together: the topics that are drawn as one line with the chosen one
  // isHere: whether it was chosen on this page
  open(choice, together, isHere) {
    const focused = document.activeElement;
    const wasInside = this.section.contains(focused);
    const previous = this.choice;
    this.choice = choice;
    this.section.hidden = choice === null;
    this.charts.forget();
    this.control.open(choice?.node ?? null);
    this.samples.open(choice?.topic ?? null);
    this.together.hidden = together.length === 0;
    this.together.replaceChildren("In the same line: ", ...together.map((name) => this.link(name)));
    if (choice === null) {
      if (wasInside) {
        this.giveBack(previous);
      }
      return;
    }
    this.opener = wasInside ? this.opener : focused;
    const [[kind, name]] = Object.entries(choice);
    this.title.textContent = name;
    this.facts.textContent = "";
    this.endpoints.replaceChildren();
    this.parameters.hidden = kind !== "node";
    this.parametersText.textContent = "";
    if (isHere) {
      this.title.focus({ preventScroll: true });
    }
  }

  link(topic) {
    const found = text("button", topic);
    found.type = "button";
    found.addEventListener("click", () => this.onSelect({ topic }));
    return found;
  }

  // The keyboard goes on where it was before.
  giveBack(choice) {
    if (this.opener?.isConnected && this.opener !== document.body) {
      this.opener.focus({ preventScroll: true });
    } else {
      this.onLost(choice);
    }
  }

  show({ kind, name, found, charts }) {
    if (this.choice?.[kind] !== name) {
      return; // another one was clicked meanwhile
    }
    if (found === null) {
      this.facts.textContent = `This ${kind} is not there any more.`;
      this.facts.classList.add("alarm");
      return;
    }
    this.facts.textContent = kind === "node" ? nodeFacts(found) : topicFacts(found);
    this.facts.classList.toggle("alarm", found.dead === true);
    this.endpoints.replaceChildren(...found.endpoints.map((one) => item(kind, one)));
    this.charts.add(charts);
  }

  async ask() {
    const node = this.choice?.node;
    this.parametersText.textContent = "asking";
    const answer = await post(`parameters?node=${encodeURIComponent(node)}`);
    if (this.choice?.node === node) {
      this.parametersText.textContent = answer.error ?? answer.result;
    }
  }
}

function nodeFacts(node) {
  const facts = [
    node.dead ? "died" : `CPU ${node.cpu}`,
    `cluster ${node.cluster}, ${node.core === null ? "no core" : `core ${node.core}`}` +
      (node.host_cpu === null ? "" : `, host CPU ${node.host_cpu}`),
    `pid ${node.pid}, ${node.program}`,
  ];
  if (node.shared_with.length > 0) {
    facts.push(`in one process with ${node.shared_with.join(", ")}`);
  }
  if (node.workers > 0) {
    facts.push(`${node.workers} workers`);
  }
  return facts.join("\n");
}

function topicFacts(topic) {
  const facts = [topic.types.join(", "), topic.load].filter((one) => one !== "");
  if (topic.latency !== null) {
    const { p50_us, p99_us, count } = topic.latency;
    facts.push(
      `latency of ${count} takes: median ${p50_us.toFixed(1)} us, ` +
        `99 % below ${p99_us.toFixed(1)} us`,
    );
  } else if (!document.body.classList.contains("of-trace")) {
    facts.push("latency: start a trace to see it");
  }
  return facts.join("\n");
}

// An endpoint: what it joins, its figures, none of which is broken, and its QoS.
function item(kind, endpoint) {
  const found = document.createElement("li");
  const name = text("b", kind === "node" ? endpoint.topic : endpoint.node);
  const figures = document.createElement("div");
  const given = FIGURES.filter((one) => endpoint[one]);
  figures.append(text("span", endpoint.rate), ...given.map((one) => {
    const figure = text("span", `${WORDS[one] ?? one} ${endpoint[one].toLocaleString("en")}`);
    figure.classList.toggle("alarm", one === "lost" || one === "deadlines_missed");
    return figure;
  }));
  figures.className = "figures";
  const words = kind === "node" ? [endpoint.type, endpoint.qos] : [endpoint.qos];
  const quiet = words.filter((one) => one !== "").join(", "); // a trace may tell neither
  found.append(`${endpoint.kind} `, name, figures, text("small", quiet));
  return found;
}

function text(tag, content) {
  const found = document.createElement(tag);
  found.textContent = content;
  return found;
}
