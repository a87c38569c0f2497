// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Messages of the topic that was clicked: fields, an image or a cloud, and a number over time.

import { Charts } from "./charts.js";
import { CloudPicture } from "./cloud.js";

const MAX_FIELDS = 200;

export class Samples {
  constructor() {
    this.section = document.getElementById("details-samples");
    this.button = document.getElementById("samples");
    this.text = document.getElementById("samples-text");
    this.canvas = document.getElementById("samples-image");
    this.picture = document.getElementById("samples-picture");
    this.fields = document.getElementById("samples-fields");
    this.cloud = new CloudPicture();
    this.charts = new Charts(document.getElementById("samples-plot"), [["", () => true]], false);
    this.topic = null;
    this.socket = null;
    this.plotted = null; // path of a number
    this.button.addEventListener("click", () => (this.socket === null ? this.listen() : this.stop()));
  }

  // topic: null for none
  open(topic) {
    this.stop();
    this.topic = topic;
    this.section.hidden = topic === null;
    this.text.textContent = "";
    this.fields.replaceChildren();
    this.canvas.hidden = this.picture.hidden = true;
    this.cloud.forget();
    this.plot(null);
  }

  listen() {
    const address = new URL(`samples?${new URLSearchParams({ topic: this.topic })}`, location.href);
    address.protocol = "ws:";
    const socket = new WebSocket(address);
    this.socket = socket;
    this.showState("waiting for a message");
    socket.onmessage = ({ data }) => {
      if (socket === this.socket) {
        this.show(JSON.parse(data));
      }
    };
    socket.onclose = () => {
      if (socket === this.socket) {
        this.stop();
      }
    };
  }

  stop() {
    this.socket?.close();
    this.socket = null;
    this.showState(this.text.textContent);
  }

  showState(text) {
    this.text.textContent = text;
    this.button.textContent = this.socket === null ? "Show messages" : "Stop";
    this.button.setAttribute("aria-pressed", String(this.socket !== null));
  }

  show({ error, map, judgement, ...message }) {
    if (error !== undefined) {
      this.showState(error);
    } else if (map !== undefined) {
      this.cloud.showMap(map);
    } else if (judgement !== undefined) {
      this.cloud.showJudgement(judgement);
    } else {
      this.showMessage(message);
    }
  }

  showMessage({ time_s, fields, image, cloud }) {
    this.showState(`at ${new Date(time_s * 1000).toLocaleTimeString("en-GB")}`);
    const leaves = [...leavesOf("", fields)].slice(0, MAX_FIELDS);
    this.showFields(leaves);
    this.showImage(image);
    this.cloud.show(cloud);
    const plotted = leaves.find(([path]) => path === this.plotted);
    if (plotted !== undefined) {
      this.charts.add({ times: [time_s], series: { [this.plotted]: [plotted[1]] }, all: false });
    }
  }

  // The fields keep their elements: one of them may have the focus.
  showFields(leaves) {
    const known = [...this.fields.children].map((item) => item.dataset.path).join("\n");
    if (known !== leaves.map(([path]) => path).join("\n")) {
      this.fields.replaceChildren(...leaves.map(([path, value]) => this.item(path, value)));
    }
    leaves.forEach(([, value], index) => {
      this.fields.children[index].lastChild.textContent = String(value);
    });
  }

  item(path, value) {
    const found = document.createElement("li");
    found.dataset.path = path;
    const name = document.createElement(typeof value === "number" ? "button" : "span");
    name.textContent = path;
    if (typeof value === "number") {
      name.type = "button";
      name.setAttribute("aria-label", `plot ${path}`);
      name.setAttribute("aria-pressed", String(path === this.plotted));
      name.addEventListener("click", () => this.plot(path));
    }
    found.append(name, " ", document.createElement("output"));
    found.lastChild.setAttribute("aria-live", "off");
    return found;
  }

  // Of a number that is plotted already: ends that.
  plot(path) {
    this.plotted = path === this.plotted ? null : path;
    this.charts.forget();
    for (const button of this.fields.querySelectorAll("button")) {
      button.setAttribute("aria-pressed", String(button.textContent === this.plotted));
    }
  }

  showImage(image) {
    this.canvas.hidden = !image?.rgba;
    this.picture.hidden = !image?.url;
    if (image?.url) {
      this.picture.src = image.url;
    } else if (image?.rgba) {
      const bytes = Uint8ClampedArray.from(atob(image.rgba), (one) => one.charCodeAt(0));
      [this.canvas.width, this.canvas.height] = [image.width, image.height];
      this.canvas.getContext("2d").putImageData(new ImageData(bytes, image.width), 0, 0);
    }
  }
}

// Path and value of each number, text or flag in a message.
function* leavesOf(path, value) {
  if (value !== null && typeof value === "object") {
    for (const [name, part] of Object.entries(value)) {
      yield* leavesOf(Array.isArray(value) ? `${path}[${name}]` : path ? `${path}.${name}` : name, part);
    }
  } else {
    yield [path, value];
  }
}
