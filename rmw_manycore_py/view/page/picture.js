// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// The SVG as the server has drawn it, and the marks that change from look to look.

export class Picture {
  constructor(place, onSelect) {
    this.place = place;
    this.svg = null;
    this.elements = new Map();
    this.selected = null;
    place.addEventListener("click", (event) => onSelect(choiceOf(event.target)));
    place.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") {
        event.preventDefault();
        onSelect(choiceOf(event.target));
      }
    });
  }

  replace(text) {
    const focused = document.activeElement?.id;
    const parsed = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
    this.place.replaceChildren(parsed);
    this.svg = parsed;
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
    this.selected?.classList.add("selected");
  }

  select(choice) {
    this.selected?.classList.remove("selected");
    this.selected = null;
    if (choice !== null && this.svg !== null) {
      const [[kind, name]] = Object.entries(choice);
      this.selected = this.svg.querySelector(`[data-${kind}="${CSS.escape(name)}"]`);
      this.selected?.classList.add("selected");
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
