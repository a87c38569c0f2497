// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// The list of events, newest first.

const MAX_SHOWN = 200;
const list = document.getElementById("happened");

export function forgetHappened() {
  list.replaceChildren();
}

export function showHappened(rows, isOfTrace, onSelect) {
  for (const row of rows) {
    list.prepend(item(row, isOfTrace, onSelect));
  }
  while (list.children.length > MAX_SHOWN) {
    list.lastChild.remove();
  }
}

function item(row, isOfTrace, onSelect) {
  const found = document.createElement("li");
  const time = document.createElement("time");
  if (isOfTrace) {
    time.dateTime = `PT${row.time_s}S`;
    time.textContent = `${row.time_s.toFixed(2)} s`;
  } else {
    const moment = new Date(row.time_s * 1000);
    time.dateTime = moment.toISOString();
    time.textContent = moment.toLocaleTimeString("en-GB");
  }
  const text = document.createElement("span");
  text.className = row.kind;
  text.textContent = ` ${row.text}`;
  found.append(time, text);
  if (row.topic !== null || row.node !== null) {
    const choice = row.topic !== null ? { topic: row.topic } : { node: row.node };
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = "show";
    button.setAttribute("aria-label", `show ${row.topic ?? row.node}`);
    button.addEventListener("click", () => onSelect(choice));
    found.append(" ", button);
  }
  return found;
}
