// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// A list of nodes and topics: the way to them by keyboard, by screen reader, and by name.

const MAX_SHOWN = 100;

export class Finder {
  constructor(onSelect) {
    this.input = document.getElementById("find");
    this.list = document.getElementById("found");
    this.onSelect = onSelect;
    this.choices = [];
    this.input.addEventListener("input", () => this.show());
  }

  replace(nodes, topics) {
    this.choices = [
      ...[...new Set(nodes)].sort().map((name) => ({ node: name })),
      ...topics.map((name) => ({ topic: name })),
    ];
    this.show();
  }

  show() {
    const wanted = this.input.value.trim().toLowerCase();
    const found = this.choices.filter((one) => nameOf(one).toLowerCase().includes(wanted));
    const items = found.slice(0, MAX_SHOWN).map((choice) => this.item(choice));
    if (found.length > MAX_SHOWN) {
      items.push(document.createElement("li"));
      items.at(-1).textContent = `and ${found.length - MAX_SHOWN} more`;
    }
    const focused = this.list.contains(document.activeElement) ? document.activeElement : null;
    this.list.replaceChildren(...items);
    if (focused !== null) { // the graph changed while it was there
      const again = items.find((one) => one.textContent === focused.textContent);
      (again?.firstElementChild ?? this.input).focus({ preventScroll: true });
    }
  }

  // The way back to a node or topic that is no longer shown in full.
  focus(choice) {
    const text = textOf(choice);
    const item = [...this.list.children].find((one) => one.textContent === text);
    (item?.firstElementChild ?? this.input).focus({ preventScroll: true });
  }

  item(choice) {
    const item = document.createElement("li");
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = textOf(choice);
    button.addEventListener("click", () => this.onSelect(choice));
    item.append(button);
    return item;
  }
}

function textOf(choice) {
  return `${Object.keys(choice)[0]} ${nameOf(choice)}`;
}

function nameOf(choice) {
  return Object.values(choice)[0];
}
