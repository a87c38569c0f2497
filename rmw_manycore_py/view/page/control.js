// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Restart and move the node that was clicked, as `manycore restart` and `manycore move` do.

import { post } from "./requests.js";

export class Control {
  constructor() {
    this.section = document.getElementById("details-control");
    this.text = document.getElementById("control-text");
    this.place = document.getElementById("place");
    this.node = null;
    this.restart = document.getElementById("restart");
    this.move = document.getElementById("move");
    this.restart.addEventListener("click", () => this.ask("restart", {}));
    this.move.addEventListener("click", () => this.ask("move", { place: this.place.value }));
  }

  // node: null for none
  open(node) {
    this.node = node;
    this.section.hidden = node === null;
    this.text.textContent = "";
    this.place.value = "";
  }

  async ask(verb, options) {
    const { node } = this;
    const where = options.place ? ` to ${options.place}` : "";
    if (!confirm(`${verb} ${node}${where}? Its process is stopped and started again.`)) {
      return;
    }
    this.text.textContent = "asking";
    this.restart.disabled = this.move.disabled = true;
    const answer = await post(`${verb}?${new URLSearchParams({ node, ...options })}`);
    this.restart.disabled = this.move.disabled = false;
    if (this.node === node) {
      this.text.textContent = answer.error ?? (answer.result.trim() || "done");
      this.text.classList.toggle("alarm", answer.error !== undefined);
    }
  }
}
