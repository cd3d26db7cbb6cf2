// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the gst-plugins-dff authors
// The planes one by one, and how sharp each is where the user clicked.
import { draw, short } from './plots.js';

const PAUSE = 500; // milliseconds between an answer and the next question

export class Planes {
  // `send` asks the server; `isWanted` says whether the panel is looked at and the page not frozen.
  constructor(send, isWanted) {
    this.send = send;
    this.isWanted = isWanted;
    this.at = null;
    this.follow = true; // the sharpest plane, until the user chooses one
    this.part = name => document.getElementById(name);
    this.part('plane-number').addEventListener('input', () => {
      this.follow = false;
      this.load();
    });
  }

  pick(place) {
    this.at = place;
    this.follow = true;
    this.ask();
  }

  ask() {
    clearTimeout(this.timer);
    if (this.isWanted()) this.send({ type: 'planes', ...(this.at ?? { x: 0.5, y: 0.5 }) });
    this.timer = setTimeout(() => this.ask(), 4 * PAUSE); // also where an answer is lost
  }

  step(by) {
    const input = this.part('plane-number');
    input.value = Number(input.value) + by;
    this.follow = false;
    this.load();
  }

  take(message) {
    this.last = message;
    this.part('planes-hint').hidden = this.at !== null;
    const { curve, positions, unit, peak, at } = message;
    draw(this.part('sharpness'), positions, curve, {
      xEnds: [positions[0], positions.at(-1)], yEnds: [0, 1], xLabel: unit === 'plane' ? 'plane' : unit, yLabel: 'sharp', dots: true, peak: at,
    });
    const distance = unit === 'dpt' && at > 0 ? `, ${short(1 / at)} m` : '';
    this.part('peak').textContent = `Sharpest in plane ${peak.toFixed(2)}${unit === 'plane' ? '' : `: ${short(at)} ${unit}${distance}`}`;
    this.part('peak').dataset.peak = peak;
    const input = this.part('plane-number');
    input.max = message.planes - 1;
    if (this.follow) input.value = Math.round(peak);
    this.load();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.ask(), PAUSE);
  }

  load() {
    if (!this.last) return;
    const plane = Number(this.part('plane-number').value), { stack, positions, unit } = this.last;
    this.part('plane-name').textContent = unit === 'plane' ? `${plane}` : `${plane}: ${short(positions[plane])} ${unit}`;
    const image = new Image();
    image.onload = () => {
      if (stack !== this.last.stack && plane !== Number(this.part('plane-number').value)) return;
      this.part('plane').src = image.src;
      this.part('plane').hidden = false;
    };
    image.src = `/stack/${stack}/${plane}.jpg`;
  }
}
