// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the gst-plugins-dff authors
// Depth as a surface that carries the picture and turns under the mouse. Written on WebGL 2 itself: it is one mesh.

const FINE = [240, 180], COARSE = [128, 96]; // corners of the mesh; coarse where the processor draws
const PAUSE = 80, COARSE_PAUSE = 400; // milliseconds between two frames of a video, at least
const START = { turn: -0.45, tilt: 0.35, zoom: 0.85 };

// A corner of the mesh a vertex. The texture of depth holds hues as depthcolorize paints them, or (exact) 16 bits in red and green.
const VERTEX = `#version 300 es
uniform sampler2D depth;
uniform bool exact;
uniform float aspect, height, zoom, screen;
uniform vec2 angles;
uniform ivec2 corners;
out vec2 place;
out float known;
out vec3 surface;

// Position from near (0) to far (1); below 0 where depth is not known.
float position(ivec2 at) {
  vec4 c = texelFetch(depth, clamp(at, ivec2(0), textureSize(depth, 0) - 1), 0);
  if (exact) {
    float code = c.r * 65280.0 + c.g * 255.0;
    return code < 0.5 ? -1.0 : (code - 1.0) / 65534.0;
  }
  float most = max(c.r, max(c.g, c.b)), least = min(c.r, min(c.g, c.b)), chroma = most - least;
  if (most < 0.5 || chroma < 0.1) return -1.0;
  float edges = most == c.r ? (c.g - c.b) / chroma : most == c.g ? 2.0 + (c.b - c.r) / chroma : 4.0 + (c.r - c.g) / chroma;
  if (edges < -0.5) edges = 5.0;
  return clamp(edges / 5.0, 0.0, 1.0);
}

// The middle of five: the codec mixes hues at edges.
float settled(ivec2 at) {
  float v[5] = float[5](position(at), position(at + ivec2(2, 0)), position(at - ivec2(2, 0)), position(at + ivec2(0, 2)), position(at - ivec2(0, 2)));
  if (exact || v[0] < 0.0) return v[0];
  for (int i = 0; i < 3; i++)
    for (int k = i + 1; k < 5; k++)
      if (v[k] < v[i]) { float t = v[i]; v[i] = v[k]; v[k] = t; }
  return v[2];
}

void main() {
  place = vec2(gl_VertexID % corners.x, gl_VertexID / corners.x) / vec2(corners - 1);
  float z = settled(ivec2(place * vec2(textureSize(depth, 0))));
  known = z < 0.0 ? 0.0 : 1.0;
  vec3 p = vec3((place.x - 0.5) * 2.0 * aspect, (0.5 - place.y) * 2.0, (0.5 - max(z, 0.0)) * 2.0 * height);
  surface = p;
  float c = cos(angles.x), s = sin(angles.x);
  p = vec3(c * p.x + s * p.z, p.y, -s * p.x + c * p.z);
  c = cos(angles.y); s = sin(angles.y);
  p = vec3(p.x, c * p.y - s * p.z, s * p.y + c * p.z);
  float away = 4.2 - p.z;
  gl_Position = vec4(p.x * zoom * 3.0 / screen, p.y * zoom * 3.0, (away - 4.0) / 8.0 * away, away);
}`;

const FRAGMENT = `#version 300 es
precision highp float;
uniform sampler2D colour, depth;
uniform bool coloured;
in vec2 place;
in float known;
in vec3 surface;
out vec4 pixel;

void main() {
  if (known < 0.99) discard;
  vec3 normal = normalize(cross(dFdx(surface), dFdy(surface)));
  if (abs(normal.z) < 0.06) discard; // a wall between near and far that nobody has seen
  float light = 0.55 + 0.45 * max(dot(normal * sign(normal.z), normalize(vec3(-0.4, 0.5, 0.8))), 0.0);
  vec3 paint = coloured ? texture(colour, place).rgb : vec3(0.62, 0.72, 0.8);
  pixel = vec4(paint * mix(1.0, light, coloured ? 0.6 : 1.0), 1.0);
}`;

function compiled(gl, kind, text) {
  const shader = gl.createShader(kind);
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  return shader;
}

function triangles(columns, rows) {
  const corners = new Uint32Array((columns - 1) * (rows - 1) * 6);
  let at = 0;
  for (let row = 0; row < rows - 1; row++)
    for (let column = 0; column < columns - 1; column++) {
      const k = row * columns + column;
      corners.set([k, k + columns, k + 1, k + 1, k + columns, k + columns + 1], at);
      at += 6;
    }
  return corners;
}

function isSoftware(gl) {
  const about = gl.getExtension('WEBGL_debug_renderer_info');
  return about !== null && /swiftshader|llvmpipe|software/i.test(gl.getParameter(about.UNMASKED_RENDERER_WEBGL));
}

export class Relief {
  // Throws where the browser has no WebGL 2.
  constructor(canvas) {
    this.canvas = canvas;
    this.view = { ...START };
    this.height = 0.6;
    this.aspect = 4 / 3;
    this.hasDepth = this.hasColour = this.exact = false;
    this.start();
    canvas.addEventListener('webglcontextlost', event => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => this.start());
    new ResizeObserver(() => this.draw()).observe(canvas);
    this.listen();
  }

  start() {
    const gl = this.gl = this.canvas.getContext('webgl2', { antialias: true });
    if (!gl) throw new Error('This browser has no WebGL 2: there is no relief');
    const program = gl.createProgram();
    gl.attachShader(program, compiled(gl, gl.VERTEX_SHADER, VERTEX));
    gl.attachShader(program, compiled(gl, gl.FRAGMENT_SHADER, FRAGMENT));
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    gl.useProgram(program);
    this.uniform = name => gl.getUniformLocation(program, name);
    gl.bindVertexArray(gl.createVertexArray());
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    const slow = isSoftware(gl), size = slow ? COARSE : FINE, corners = triangles(...size);
    this.pause = slow ? COARSE_PAUSE : PAUSE;
    gl.uniform2i(this.uniform('corners'), ...size);
    this.count = corners.length;
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, corners, gl.STATIC_DRAW);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(0.05, 0.063, 0.075, 1);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    this.depth = this.texture(0, gl.NEAREST);
    this.colour = this.texture(1, gl.LINEAR);
    gl.uniform1i(this.uniform('depth'), 0);
    gl.uniform1i(this.uniform('colour'), 1);
  }

  texture(unit, filter) {
    const gl = this.gl, made = gl.createTexture();
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, made);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, filter);
    for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
    return made;
  }

  upload(unit, source) {
    const gl = this.gl;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, source);
  }

  // A frame of the hue video, and of the picture beside it.
  takeFrame(video, picture) {
    if (performance.now() - (this.taken ?? 0) < this.pause || !this.canvas.clientHeight) return;
    this.taken = performance.now();
    if (picture.videoWidth) this.takeColour(picture);
    this.upload(0, video);
    this.aspect = video.videoWidth / video.videoHeight;
    this.hasDepth = true;
    this.exact = false;
    this.draw();
  }

  // 16 bits a pixel, 0 = not known.
  takeExact(codes, width, height) {
    const gl = this.gl, bytes = new Uint8Array(width * height * 2);
    for (let k = 0; k < codes.length; k++) {
      bytes[2 * k] = codes[k] >> 8;
      bytes[2 * k + 1] = codes[k] & 255;
    }
    gl.activeTexture(gl.TEXTURE0);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RG8, width, height, 0, gl.RG, gl.UNSIGNED_BYTE, bytes);
    this.aspect = width / height;
    this.hasDepth = this.exact = true;
    this.draw();
  }

  takeColour(source) {
    this.upload(1, source);
    this.hasColour = true;
  }

  draw() {
    const gl = this.gl, ratio = this.pause === COARSE_PAUSE ? 1 : Math.min(devicePixelRatio, 2);
    const width = Math.round(this.canvas.clientWidth * ratio), height = Math.round(this.canvas.clientHeight * ratio);
    if (!width || !height) return;
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (!this.hasDepth) return;
    gl.uniform1i(this.uniform('exact'), this.exact);
    gl.uniform1i(this.uniform('coloured'), this.hasColour);
    gl.uniform1f(this.uniform('aspect'), this.aspect);
    gl.uniform1f(this.uniform('height'), this.height);
    gl.uniform1f(this.uniform('zoom'), this.view.zoom);
    gl.uniform1f(this.uniform('screen'), width / height);
    gl.uniform2f(this.uniform('angles'), this.view.turn, this.view.tilt);
    gl.drawElements(gl.TRIANGLES, this.count, gl.UNSIGNED_INT, 0);
  }

  move(turn, tilt, zoom) {
    this.view.turn = Math.max(-1.5, Math.min(1.5, this.view.turn + turn));
    this.view.tilt = Math.max(-1.5, Math.min(1.5, this.view.tilt + tilt));
    this.view.zoom = Math.max(0.4, Math.min(6, this.view.zoom * zoom));
    this.draw();
  }

  listen() {
    const pointers = new Map();
    const apart = () => {
      const [a, b] = [...pointers.values()];
      return Math.hypot(a.x - b.x, a.y - b.y);
    };
    this.canvas.addEventListener('pointerdown', event => {
      this.canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    });
    this.canvas.addEventListener('pointermove', event => {
      const before = pointers.get(event.pointerId);
      if (!before) return;
      const gap = pointers.size === 2 ? apart() : 0;
      pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      if (gap) this.move(0, 0, apart() / gap);
      else this.move((event.clientX - before.x) / 200, (event.clientY - before.y) / 200, 1);
    });
    for (const name of ['pointerup', 'pointercancel']) this.canvas.addEventListener(name, event => pointers.delete(event.pointerId));
    this.canvas.addEventListener('wheel', event => {
      event.preventDefault();
      this.move(0, 0, Math.exp(-event.deltaY / 600));
    }, { passive: false });
    this.canvas.addEventListener('dblclick', () => this.putBack());
    const keys = { ArrowLeft: [-0.1, 0, 1], ArrowRight: [0.1, 0, 1], ArrowUp: [0, -0.1, 1], ArrowDown: [0, 0.1, 1], '+': [0, 0, 1.1], '-': [0, 0, 1 / 1.1] };
    this.canvas.addEventListener('keydown', event => {
      if (keys[event.key]) this.move(...keys[event.key]);
      else if (event.key === '0') this.putBack();
      else return;
      event.preventDefault();
    });
  }

  putBack() {
    this.view = { ...START };
    this.draw();
  }
}
