// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// The SVG as the server has drawn it, and the marks that change from look to look.

export class Picture {
  constructor(place, onSelect) {
    this.place = place;
    this.svg = null;
    this.elements = new Map();
    this.arcs = {};
    this.marked = []; // elements and the class that the choice gives them
    place.addEventListener("click", (event) => onSelect(choiceOf(event.target)));
    place.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") {
        event.preventDefault();
        onSelect(choiceOf(event.target));
      }
    });
  }

  // arcs: {id: {lines, topics: {name: nodes}}}
  replace(text, arcs) {
    const focused = document.activeElement?.id;
    const parsed = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
    this.place.replaceChildren(parsed);
    this.svg = parsed;
    this.arcs = arcs;
    this.marked = [];
    this.elements = new Map([...parsed.querySelectorAll("[id]")].map((one) => [one.id, one]));
    if (focused && this.elements.has(focused)) {
      this.elements.get(focused).focus({ preventScroll: true });
    }
  }

  mark(marks) {
    for (const [id, mark] of Object.entries(marks)) {
      const element = this.elements.get(id);
      if (element === undefined) {
        continue;
      }
      if (mark.class !== undefined) {
        element.setAttribute("class", mark.class);
      }
      if (mark.text !== undefined) {
        element.textContent = mark.text;
      }
      if (mark.width !== undefined) {
        element.setAttribute("width", mark.width);
      }
    }
    this.marked.forEach(([element, name]) => element.classList.add(name));
  }

  // The topics that are drawn as one line with this one.
  together(topic) {
    const arc = Object.values(this.arcs).find((one) => Object.hasOwn(one.topics, topic));
    return Object.keys(arc?.topics ?? {}).filter((name) => name !== topic);
  }

  // What is joined to the choice stays, the rest steps back. Returns the ids of the arcs that stay;
  // null for all.
  select(choice) {
    this.marked.forEach(([element, name]) => element.classList.remove(name));
    this.marked = [];
    if (this.svg === null || choice === null) {
      return null;
    }
    const [[kind, name]] = Object.entries(choice);
    const isMeant = ([topic, nodes]) => (kind === "topic" ? topic === name : nodes.includes(name));
    const meant = Object.entries(this.arcs).map(([id, arc]) => [id, Object.entries(arc.topics).filter(isMeant)]);
    const joined = meant.filter(([, topics]) => topics.length > 0);
    const nodes = new Set(joined.flatMap(([, topics]) => topics.flatMap(([, own]) => own)));
    if (kind === "node") {
      nodes.add(name);
    }
    for (const [id] of joined) {
      this.markAs("related", this.elements.get(id));
      this.markAs("related", this.svg.querySelector(`[data-of="${CSS.escape(id)}"]`));
    }
    for (const node of this.svg.querySelectorAll("[data-node]")) {
      this.markAs("related", nodes.has(node.dataset.node) ? node : null);
      this.markAs("selected", kind === "node" && node.dataset.node === name ? node : null);
    }
    this.markAs("selected", kind === "topic" && joined.length > 0 ? this.elements.get(joined[0][0]) : null);
    if (joined.length === 0 && kind === "topic") {
      return null; // one that is not drawn
    }
    this.markAs("choosing", this.svg);
    return new Set(joined.map(([id]) => id));
  }

  markAs(name, element) {
    if (element) {
      element.classList.add(name);
      this.marked.push([element, name]);
    }
  }
}

function choiceOf(target) {
  const own = target.closest("[data-node], [data-topic]");
  if (own === null) {
    return null;
  }
  return own.dataset.node !== undefined ? { node: own.dataset.node } : { topic: own.dataset.topic };
}
