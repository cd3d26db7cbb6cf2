// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the gst-plugins-dff authors
// What belongs together on the page.
import { Connection } from './connection.js';
import { Controls, forgetHealth, showHealth } from './panels.js';
import { Planes } from './planes.js';
import { draw, short } from './plots.js';
import { Relief } from './relief.js';
import { Overlay, paint, Views } from './views.js';

const part = id => document.getElementById(id);
const pictureView = part('picture-view'), depthView = part('depth-view');
const picture = part('picture'), depth = part('depth');
const OVERLAYS = ['', 'confidence', 'motion'];
const PROBE_PAUSE = 80, PROFILE_PAUSE = 300; // milliseconds

let frozen = null; // {number, facts, codes} of the frame that is held
let outputs = [];
let problemTimer;

function problem(text) {
  part('problem').textContent = text;
  part('problem').hidden = false;
  clearTimeout(problemTimer);
  problemTimer = setTimeout(() => { part('problem').hidden = true; }, 7000);
}

// What is going on with the server, the source, the video: the first that is not as it should be.
const news = { server: null, source: null, video: null };
function state(of, text, bad) {
  news[of] = text ? { text, bad } : null;
  const first = news.server ?? news.source ?? news.video ?? { text: 'live', bad: false };
  part('state').textContent = first.text;
  part('state').classList.toggle('bad', first.bad);
}

// Calls `work` at once, and then not before `pause` milliseconds are over, with what it was last called with.
function spaced(work, pause) {
  let timer = null, next = null;
  return (...values) => {
    if (timer) { next = values; return; }
    work(...values);
    timer = setTimeout(function again() {
      timer = next ? setTimeout(again, pause) : null;
      if (next) work(...next);
      next = null;
    }, pause);
  };
}

const server = new Connection({ aif: picture, depth });
const send = message => server.send(message);
// What the user wants done, and not just shown.
const order = message => send(message) || problem('The server is gone: this was not done');
const onFrame = message => ({ ...message, frozen: frozen?.number ?? 0 });
const askOfDepth = message => outputs.includes('depth') && send(onFrame(message));
const isShown = name => !part(name).hidden;

// Relief

let relief = null;
try {
  relief = new Relief(part('relief'));
} catch (error) {
  part('no-relief').textContent = error.message;
  part('no-relief').hidden = false;
}

(function eachFrame() {
  if (!frozen && relief && depth.videoWidth) relief.takeFrame(depth, picture);
  if (depth.requestVideoFrameCallback) depth.requestVideoFrameCallback(eachFrame);
  else setTimeout(eachFrame, 66);
})();
part('height').addEventListener('input', event => {
  if (!relief) return;
  relief.height = Number(event.target.value);
  relief.draw();
});

// What is pointed at

const views = new Views([pictureView, depthView]);
const planes = new Planes(send, () => isShown('planes') && outputs.includes('stacks'));
let cut = null;
views.addEventListener('point', spaced(event => askOfDepth({ type: 'probe', ...event.detail }), PROBE_PAUSE));
views.addEventListener('click', event => {
  showPanel('planes');
  planes.pick(event.detail);
  askOfDepth({ type: 'probe', ...event.detail });
});
const askProfile = spaced(() => cut && askOfDepth({ type: 'profile', ...cut }), PROFILE_PAUSE);
views.addEventListener('cut', event => {
  cut = event.detail;
  showPanel('profile');
  askProfile();
});
setInterval(() => { if (isShown('profile') && !frozen) askProfile(); }, 1000);

const overlay = new Overlay(pictureView.querySelector('.overlay'));
function chooseOverlay() {
  const name = part('overlay').value;
  const url = frozen ? `/frozen/${frozen.number}/${name}.jpg` : `/overlay/${name}.jpg`;
  overlay.show(name, name ? url : null, !frozen);
}
part('overlay').addEventListener('change', chooseOverlay);

server.addEventListener('probe', ({ detail }) => {
  const bold = document.createElement('b');
  const metres = detail.metres !== null && detail.symbol !== 'mm' ? `, ${short(detail.metres)} m` : '';
  const deviation = typeof detail.deviation === 'number' ? ` ± ${short(detail.deviation)}` : '';
  bold.textContent = detail.value === null ? 'not known' : `${short(detail.value)}${deviation} ${detail.symbol}${metres}`;
  const parts = [`${detail.x}, ${detail.y}:  `, bold];
  if ('confidence' in detail) parts.push(`   confidence ${(100 * detail.confidence).toFixed(0)} %`);
  if (detail.motion > 0.5) parts.push('   moved');
  part('readout').replaceChildren(...parts);
});
server.addEventListener('profile', ({ detail }) => {
  part('profile-hint').hidden = true;
  const step = detail.length / Math.max(1, detail.values.length - 1);
  draw(part('profile-plot'), detail.values.map((_, k) => k * step), detail.values, { xLabel: 'pixels', yLabel: detail.symbol });
});
server.addEventListener('planes', ({ detail }) => planes.take(detail));
server.addEventListener('histogram', ({ detail }) => {
  if ((detail.frozen ?? 0) !== (frozen?.number ?? 0)) return;
  const { facts } = detail;
  part('range').textContent = facts.near === null ? '' : `near ${short(facts.near)} – far ${short(facts.far)} dpt`;
  if (!isShown('spread')) return;
  draw(part('histogram'), [detail.first, detail.last], detail.counts, { xEnds: [detail.first, detail.last], yEnds: [0, Math.max(1, ...detail.counts)], xLabel: detail.symbol, bars: true });
  part('known').textContent = `Known: ${(100 * detail.known).toFixed(1)} % of the pixels`;
});

// Health, controls, problems

const controls = new Controls(part('controls'), (name, property, value) => order({ type: 'set', element: name, name: property, value }));
server.addEventListener('hello', ({ detail }) => {
  outputs = detail.outputs;
  const pictures = outputs.includes('aif') || outputs.includes('planes');
  part('no-picture').hidden = pictures;
  part('no-depth').hidden = outputs.includes('depth');
  part('picture-name').textContent = outputs.includes('planes') ? 'Planes, one after the other' : 'All in focus';
  if (!outputs.includes('stacks')) part('planes-hint').textContent = 'This source gives no stacks to look into: there is no dffdepth in its pipeline';
  for (const option of part('overlay').options) option.disabled = option.value !== '' && !outputs.includes(option.value);
  controls.show(detail.controls);
  recording(detail.recording);
  state('server', '');
  state('source', detail.state, detail.bad);
});
server.addEventListener('controls', ({ detail }) => controls.show(detail.controls));
server.addEventListener('state', ({ detail }) => state('source', detail.text, detail.bad));
server.addEventListener('video', ({ detail }) => state('video', detail.text, detail.bad));
server.addEventListener('closed', ({ detail }) => {
  state('server', detail.text || 'The server is gone: trying again', true);
  forgetHealth();
  if (frozen) thaw(); // a new server does not know it
});
server.addEventListener('health', ({ detail }) => {
  showHealth(detail, part('counts'));
  if (detail.recording !== null) part('record').textContent = `Stop, ${Math.round(detail.recording)} s`;
});
server.addEventListener('problem', ({ detail }) => {
  problem(detail.text);
  if (detail.element) send({ type: 'controls' });
});

// Freeze

async function hold(detail) {
  const { number, facts } = detail;
  const held = { number, facts, codes: null };
  if (facts) {
    const answer = await fetch(`/frozen/${number}/depth.bin`);
    if (!answer.ok) throw new Error(await answer.text());
    held.codes = new Uint16Array(await answer.arrayBuffer());
    const canvas = depthView.querySelector('.frozen');
    paint(canvas, held.codes, facts.width, facts.height);
    canvas.hidden = false;
  }
  frozen = held;
  if (facts) relief?.takeExact(held.codes, facts.width, facts.height);
  if (detail.picture) {
    const image = pictureView.querySelector('.frozen');
    image.src = `/frozen/${number}/picture.jpg`;
    await image.decode();
    image.hidden = false;
    relief?.takeColour(image);
    relief?.draw();
  }
  part('freeze').setAttribute('aria-pressed', 'true');
  part('freeze').textContent = 'Go on';
  part('planes-live').hidden = !outputs.includes('stacks');
  chooseOverlay();
  if (facts) send(onFrame({ type: 'histogram' }));
  if (cut) askProfile();
}

function thaw() {
  frozen = null;
  for (const view of [pictureView, depthView]) view.querySelector('.frozen').hidden = true;
  part('freeze').setAttribute('aria-pressed', 'false');
  part('freeze').textContent = 'Freeze';
  part('planes-live').hidden = true;
  chooseOverlay();
}

server.addEventListener('frozen', ({ detail }) => {
  if (detail.file) download(`/frozen/${detail.number}/${detail.file}`, detail.file);
  else hold(detail).catch(error => problem(`This frame cannot be held: ${error.message}`));
});
part('freeze').addEventListener('click', () => frozen ? thaw() : order({ type: 'freeze' }));

// Save and record

async function download(url, name) {
  let answer;
  try {
    answer = await fetch(url);
  } catch {
    return problem(`${name} was not saved: the server is gone`);
  }
  if (!answer.ok) return problem(await answer.text());
  const link = document.createElement('a');
  link.href = URL.createObjectURL(await answer.blob());
  const time = new Date().toISOString().replace(/[-:]/g, '').replace(/\..*/, '');
  link.download = `dff-${time}-${name}`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}
for (const button of document.querySelectorAll('#save [data-file]')) {
  button.addEventListener('click', () => {
    part('save').open = false;
    if (frozen) download(`/frozen/${frozen.number}/${button.dataset.file}`, button.dataset.file);
    else order({ type: 'freeze', file: button.dataset.file });
  });
}

function recording(on) {
  part('record').setAttribute('aria-pressed', on ? 'true' : 'false');
  part('record').textContent = on ? 'Stop' : 'Record';
}
let mine = false; // whether this page stopped the recording, and so wants it
server.addEventListener('recording', ({ detail }) => {
  recording(detail.on);
  if (detail.text) problem(detail.text);
  if (detail.url && mine) {
    const link = document.createElement('a');
    link.href = detail.url;
    link.download = 'dff-recording.mkv';
    link.click();
  }
  mine = false;
});
part('record').addEventListener('click', () => {
  const on = part('record').getAttribute('aria-pressed') === 'true';
  mine = on;
  order({ type: 'record', on: !on });
});

// Panels and keys

const tabs = [...document.querySelectorAll('[role=tab]')];
function showPanel(name) {
  for (const tab of tabs) {
    tab.setAttribute('aria-selected', tab.dataset.panel === name ? 'true' : 'false');
    part(tab.dataset.panel).hidden = tab.dataset.panel !== name;
  }
  if (name === 'planes') planes.ask();
  if (name === 'spread' && frozen) askOfDepth({ type: 'histogram' });
}
for (const tab of tabs) tab.addEventListener('click', () => showPanel(tab.dataset.panel));

function nextOverlay() {
  const usable = OVERLAYS.filter(name => name === '' || outputs.includes(name));
  part('overlay').value = usable[(usable.indexOf(part('overlay').value) + 1) % usable.length];
  chooseOverlay();
}
const keys = {
  ' ': () => part('freeze').click(), r: () => part('record').click(), s: () => { part('save').open = !part('save').open; }, o: nextOverlay,
  '[': () => planes.step(-1), ']': () => planes.step(1), '?': () => part('help').showModal(),
};
document.addEventListener('keydown', event => {
  if (event.ctrlKey || event.altKey || event.metaKey || event.target.closest('input, select, button, summary, dialog')) return;
  const tab = tabs[Number(event.key) - 1];
  if (tab) showPanel(tab.dataset.panel);
  else if (keys[event.key]) keys[event.key]();
  else return;
  event.preventDefault();
});
