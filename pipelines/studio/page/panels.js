// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the gst-plugins-dff authors
// Controls made of the elements' own properties, and what the elements count.

const WIDEST_SLIDER = 1024; // a slider over more than that hits nothing

function make(name, properties = {}, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
}

function rounded(value) {
  return typeof value === 'number' ? Number(value.toPrecision(6)) : value;
}

// `set(element, name, value)` is called when the user changes one.
export class Controls {
  constructor(panel, set) {
    this.panel = panel;
    this.set = set;
    this.rows = new Map();
  }

  // What the server says the properties are; those that the user has a hand on are left alone.
  show(elements) {
    const shape = JSON.stringify(elements.map(item => [item.element, item.properties.map(property => property.name)]));
    if (shape !== this.shape) this.build(elements);
    this.shape = shape;
    for (const item of elements)
      for (const property of item.properties) this.rows.get(`${item.element} ${property.name}`)(property);
  }

  build(elements) {
    this.rows.clear();
    this.panel.replaceChildren(...elements.map(item => {
      const group = make('fieldset', { className: 'element' }, make('legend', {}, item.factory,
        ...(item.name.replace(/\d+$/, '') === item.factory ? [] : [make('small', {}, item.name)])));
      for (const property of item.properties) group.append(this.row(item, property));
      return group;
    }));
    if (!elements.length) this.panel.replaceChildren(make('p', { className: 'hint' }, 'The pipeline has no elements with properties to turn'));
  }

  row(item, property) {
    const id = `${item.element} ${property.name}`.replace(/\W+/g, '-');
    const label = make('label', { htmlFor: id, textContent: property.name, title: property.about });
    const change = value => this.set(item.element, property.name, value);
    const inputs = this.inputs(property, id, change);
    const about = make('p', { hidden: true }, property.about + (property.default === null ? '' : ` Default: ${rounded(property.default)}.`) +
      (property.running ? '' : ' The source starts anew.'));
    label.addEventListener('click', event => {
      event.preventDefault();
      about.hidden = !about.hidden;
    });
    const row = make('div', { className: 'property' }, label, ...inputs, about);
    row.dataset.property = property.name;
    this.rows.set(`${item.element} ${property.name}`, now => {
      label.classList.toggle('changed', now.default !== null && rounded(now.value) !== rounded(now.default));
      for (const input of inputs) {
        if (document.activeElement === input && this.touched > performance.now() - 1500) continue;
        if (input.type === 'checkbox') input.checked = now.value;
        else input.value = rounded(now.value);
      }
    });
    return row;
  }

  inputs(property, id, change) {
    if (property.kind === 'switch') {
      const box = make('input', { type: 'checkbox', id, className: 'wide' });
      box.addEventListener('change', () => change(box.checked));
      return [box];
    }
    if (property.kind === 'choice') {
      const list = make('select', { id, className: 'wide' }, ...property.choices.map(choice => make('option', { value: choice.name, title: choice.about }, choice.name)));
      list.addEventListener('change', () => change(list.value));
      return [list];
    }
    const { least, most } = property, whole = property.kind === 'whole';
    const number = make('input', { type: 'number', id, step: whole ? 1 : 'any' });
    if (least !== null) number.min = least;
    if (most !== null) number.max = most;
    number.addEventListener('change', () => number.value !== '' && change(Number(number.value)));
    if (least === null || most === null || most - least > WIDEST_SLIDER) {
      number.className = 'wide';
      return [number];
    }
    const slider = make('input', { type: 'range', min: least, max: most, step: whole ? 1 : (most - least) / 200 });
    slider.setAttribute('aria-label', property.name);
    let waiting = null;
    slider.addEventListener('input', () => {
      this.touched = performance.now();
      number.value = rounded(Number(slider.value));
      // Where the source starts anew, only when the hand is off; else some times a second.
      if (property.running) waiting ??= setTimeout(() => { waiting = null; change(Number(slider.value)); }, 120);
    });
    slider.addEventListener('change', () => {
      clearTimeout(waiting);
      waiting = null;
      change(Number(slider.value));
    });
    return [slider, number];
  }
}

// Sums of what the elements count, over names that end in one of `endings`; null where nobody counts that.
function sum(stats, names) {
  let total = null;
  for (const counts of Object.values(stats))
    for (const name of names) if (name in counts) total = (total ?? 0) + counts[name];
  return total;
}

const HEALTH = ['rate', 'latency', 'lost', 'late', 'disagreements'];

export function forgetHealth() {
  for (const id of HEALTH) document.getElementById(id).textContent = '–';
}

export function showHealth({ rate, latency, stats, viewers }, panel) {
  const put = (id, text) => { document.getElementById(id).textContent = text; };
  const count = names => sum(stats, names)?.toString() ?? '–';
  put('rate', rate.toFixed(1));
  put('latency', latency === null ? '–' : `${Math.round(latency * 1000)} ms`);
  put('lost', count(['lost']));
  put('late', count(['late']));
  put('disagreements', count(['disagreements']));
  const table = (title, rows) => make('table', {}, make('caption', {}, title),
    make('tbody', {}, ...rows.map(([name, value]) => make('tr', {}, make('td', {}, name), make('td', {}, `${rounded(value)}`)))));
  panel.replaceChildren(table('browsers', [['looking', viewers]]), ...Object.entries(stats).map(([name, counts]) => table(name, Object.entries(counts))));
}
