// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// The moment of a trace that is shown: moved by hand, by playing, or by the page of another trace
// beside this one.

const TICK_MS = 100;

export class Timeline {
  // onSeek: called with the step to ask for; null: the whole run
  // onChoice: called with what was chosen here, in seconds since the begin
  constructor(onSeek, onChoice) {
    this.onSeek = onSeek;
    this.onChoice = onChoice;
    this.place = document.getElementById("timeline");
    this.moment = document.getElementById("moment");
    this.text = document.getElementById("moment-text");
    this.playing = document.getElementById("play");
    this.picture = document.getElementById("picture-link");
    this.length = null; // of the trace: steps and seconds
    this.wanted = null; // step
    this.asked = null; // step, of the question that is not answered yet
    this.isAsking = false;
    this.timer = null;
    this.moment.addEventListener("input", () => this.byHand(this.secondsOf(this.moment.valueAsNumber)));
    this.playing.addEventListener("click", () => (this.timer === null ? this.play() : this.pause()));
    document.getElementById("whole").addEventListener("click", () => this.byHand(null));
  }

  // position: {step, steps, seconds}, of the news
  show({ step, steps, seconds }) {
    if (this.length === null) {
      this.length = { steps, seconds };
      this.place.hidden = false;
      this.moment.max = steps;
    }
    if (step === this.wanted || !this.moment.matches(":active")) {
      this.moment.value = step ?? steps; // else the thumb would jump back under the pointer
    }
    this.text.textContent = step === null ? "the whole run" : `${this.secondsOf(step).toFixed(2)} s`;
    this.picture.href = step === null ? "chip.svg" : `chip.svg?step=${step}`;
    this.isAsking = false;
    if (this.wanted !== step && this.wanted !== this.asked) {
      this.ask();
    }
  }

  secondsOf(step) {
    return this.length.seconds * step / this.length.steps;
  }

  // What was chosen on the page of another trace.
  follow(seconds) {
    this.pause();
    this.seek(seconds);
  }

  // seconds since the begin; null: the whole run
  seek(seconds) {
    const { steps, seconds: end } = this.length;
    this.wanted = seconds === null ? null : Math.min(Math.round(steps * seconds / end) || 0, steps);
    if (!this.isAsking) {
      this.ask();
    }
  }

  ask() {
    this.isAsking = true;
    this.asked = this.wanted;
    this.onSeek(this.wanted);
  }

  byHand(seconds) {
    this.pause();
    this.choose(seconds);
  }

  choose(seconds) {
    this.seek(seconds);
    this.onChoice(seconds);
  }

  play() {
    const end = this.length.seconds;
    const from = this.wanted === null || this.wanted === this.length.steps ? 0 : this.secondsOf(this.wanted);
    const began = performance.now();
    this.playing.textContent = "Pause";
    this.timer = setInterval(() => {
      const seconds = from + (performance.now() - began) / 1000;
      this.choose(Math.min(seconds, end));
      if (seconds >= end) {
        this.pause();
      }
    }, TICK_MS);
  }

  pause() {
    clearInterval(this.timer);
    this.timer = null;
    this.playing.textContent = "Play";
  }
}
