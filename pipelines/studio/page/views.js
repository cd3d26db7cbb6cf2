// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the gst-plugins-dff authors
// Picture and depth: what lies over them, and what is pointed at. Places are parts of width and height, 0 to 1.
import { element } from './plots.js';

const EDGES = [[255, 0, 0], [255, 255, 0], [0, 255, 0], [0, 255, 255], [0, 0, 255], [255, 0, 255]];
const CLICK = 0.01; // how far a pointer may move, in parts of the width, and still mean a point

// The colour of depthcolorize palette=hue for a 16-bit pixel.
function hue(code) {
  if (!code) return [0, 0, 0];
  const place = (code - 1) / 65534 * 5, edge = Math.min(4, Math.floor(place)), part = place - edge;
  return EDGES[edge].map((value, k) => value + (EDGES[edge + 1][k] - value) * part);
}

export function paint(canvas, codes, width, height) {
  Object.assign(canvas, { width, height });
  const context = canvas.getContext('2d'), image = context.createImageData(width, height);
  for (let k = 0; k < codes.length; k++) {
    const colour = hue(codes[k]);
    for (let part = 0; part < 3; part++) image.data[4 * k + part] = colour[part];
    image.data[4 * k + 3] = 255;
  }
  context.putImageData(image, 0, 0);
}

// Events: point {x, y} while the pointer is over a view, away, click {x, y}, cut {x0, y0, x1, y1}.
export class Views extends EventTarget {
  constructor(views) {
    super();
    this.views = views;
    for (const view of views) {
      const video = view.querySelector('video');
      video.addEventListener('resize', () => this.shape(video.videoWidth, video.videoHeight));
      let from = null;
      const at = event => {
        const box = video.getBoundingClientRect();
        const inside = value => Math.max(0, Math.min(1, value));
        return { x: inside((event.clientX - box.left) / box.width), y: inside((event.clientY - box.top) / box.height) };
      };
      video.addEventListener('pointerdown', event => {
        from = at(event);
        video.setPointerCapture(event.pointerId);
      });
      video.addEventListener('pointermove', event => {
        const place = at(event);
        this.mark('cross', place);
        this.tell('point', place);
        if (from && Math.hypot(place.x - from.x, place.y - from.y) > CLICK) this.cut(from, place);
      });
      video.addEventListener('pointerup', event => {
        const place = at(event);
        if (from && Math.hypot(place.x - from.x, place.y - from.y) > CLICK) this.cut(from, place);
        else if (from) {
          this.mark('picked', place);
          this.tell('click', place);
        }
        from = null;
      });
      video.addEventListener('pointercancel', () => { from = null; });
      video.addEventListener('pointerleave', () => {
        this.mark('cross', null);
        this.tell('away', {});
      });
    }
  }

  tell(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }

  shape(width, height) {
    if (width && height) document.documentElement.style.setProperty('--shape', `${width} / ${height}`);
  }

  cut(from, to) {
    this.mark('cut', { x0: from.x, y0: from.y, x1: to.x, y1: to.y });
    this.tell('cut', { x0: from.x, y0: from.y, x1: to.x, y1: to.y });
  }

  // In all views; nothing where `place` is null.
  mark(kind, place) {
    for (const view of this.views) {
      const svg = view.querySelector('.marks');
      svg.querySelectorAll(`.${kind}`).forEach(old => old.remove());
      if (!place) continue;
      const percent = value => `${(value * 100).toFixed(2)}%`;
      if (kind === 'cut') {
        svg.append(element('line', { class: kind, x1: percent(place.x0), y1: percent(place.y0), x2: percent(place.x1), y2: percent(place.y1) }));
      } else if (kind === 'picked') {
        svg.append(element('circle', { class: kind, cx: percent(place.x), cy: percent(place.y), r: 8 }));
      } else {
        svg.append(element('line', { class: kind, x1: percent(place.x), y1: 0, x2: percent(place.x), y2: '100%' }),
          element('line', { class: kind, x1: 0, y1: percent(place.y), x2: '100%', y2: percent(place.y) }));
      }
    }
  }
}

// Confidence or motion over the picture, at `url`; some times a second where it is `live`. Nothing where there is no url.
export class Overlay {
  constructor(canvas) {
    this.canvas = canvas;
    this.url = null;
  }

  show(name, url, live) {
    Object.assign(this, { name, url, live });
    this.canvas.hidden = !url;
    clearTimeout(this.timer);
    if (url) this.load();
  }

  load() {
    const image = new Image();
    const again = wait => { this.timer = setTimeout(() => this.load(), wait); };
    const url = this.url, name = this.name;
    image.onload = () => {
      if (url !== this.url) return;
      this.paint(image, name);
      if (this.live) again(200);
    };
    image.onerror = () => { if (url === this.url) again(1000); };
    image.src = `${url}?${performance.now()}`;
  }

  // Confidence: blue where it is low, yellow where it is high. Motion: red.
  paint(image, name) {
    Object.assign(this.canvas, { width: image.width, height: image.height });
    const context = this.canvas.getContext('2d', { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    const pixels = context.getImageData(0, 0, image.width, image.height), data = pixels.data;
    for (let k = 0; k < data.length; k += 4) {
      const value = data[k];
      if (name === 'motion') {
        data[k] = value;
        data[k + 1] = data[k + 2] = 0;
      } else {
        data[k] = value;
        data[k + 1] = value * 0.8;
        data[k + 2] = 90 * (1 - value / 255);
      }
    }
    context.putImageData(pixels, 0, 0);
  }
}
