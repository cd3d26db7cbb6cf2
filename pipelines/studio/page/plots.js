// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the gst-plugins-dff authors
// Curves and bars as SVG.

const WIDTH = 370, HEIGHT = 190, LEFT = 46, RIGHT = 10, TOP = 10, BOTTOM = 28;

export function element(name, attributes = {}, text) {
  const made = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
}

// A number with as many digits as a reader can use.
export function short(value) {
  if (value === null || value === undefined || !isFinite(value)) return '–';
  const size = Math.abs(value);
  return size >= 1000 ? value.toFixed(0) : size >= 100 ? value.toFixed(1) : size >= 10 ? value.toFixed(2) : value.toFixed(3);
}

function ends(values) {
  const known = values.filter(value => value !== null && isFinite(value));
  if (!known.length) return [0, 1];
  const least = Math.min(...known), most = Math.max(...known);
  return least === most ? [least - 0.5, most + 0.5] : [least, most];
}

// xs and ys: numbers, null where there is none. options: yEnds, xLabel, yLabel, dots, bars, peak (an x).
export function draw(place, xs, ys, { xEnds = ends(xs), yEnds = ends(ys), xLabel = '', yLabel = '', dots = false, bars = false, peak = null } = {}) {
  const svg = element('svg', { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: 'img' });
  const x = value => LEFT + (value - xEnds[0]) / (xEnds[1] - xEnds[0]) * (WIDTH - LEFT - RIGHT);
  const y = value => HEIGHT - BOTTOM - (value - yEnds[0]) / (yEnds[1] - yEnds[0]) * (HEIGHT - TOP - BOTTOM);
  svg.append(element('path', { class: 'axis', fill: 'none', d: `M${LEFT} ${TOP}V${HEIGHT - BOTTOM}H${WIDTH - RIGHT}` }));
  for (const [value, anchor] of [[xEnds[0], 'start'], [xEnds[1], 'end']])
    svg.append(element('text', { x: x(value), y: HEIGHT - BOTTOM + 15, 'text-anchor': anchor }, short(value)));
  svg.append(element('text', { x: (LEFT + WIDTH - RIGHT) / 2, y: HEIGHT - BOTTOM + 15, 'text-anchor': 'middle' }, xLabel));
  for (const value of yEnds)
    svg.append(element('text', { x: LEFT - 5, y: y(value) + 4, 'text-anchor': 'end' }, short(value)));
  svg.append(element('text', { x: LEFT - 5, y: (TOP + HEIGHT - BOTTOM) / 2 + 4, 'text-anchor': 'end' }, yLabel));
  if (bars) {
    const wide = Math.max(1, (WIDTH - LEFT - RIGHT) / ys.length - 1);
    ys.forEach((value, k) => svg.append(element('rect', {
      class: 'bar', x: LEFT + k * (WIDTH - LEFT - RIGHT) / ys.length, y: y(value), width: wide, height: HEIGHT - BOTTOM - y(value),
    })));
  } else {
    let path = '', pen = 'M';
    ys.forEach((value, k) => {
      if (value === null || !isFinite(value)) { pen = 'M'; return; }
      path += `${pen}${x(xs[k]).toFixed(1)} ${y(value).toFixed(1)}`;
      pen = 'L';
      if (dots) svg.append(element('circle', { class: 'dot', cx: x(xs[k]), cy: y(value), r: 3 }));
    });
    svg.append(element('path', { class: 'curve', d: path }));
  }
  if (peak !== null) svg.append(element('path', { class: 'peak', d: `M${x(peak)} ${TOP}V${HEIGHT - BOTTOM}` }));
  place.replaceChildren(svg);
}
