// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the gst-plugins-dff authors
// The web socket to the server and the video that is agreed on over it. Comes back by itself.

const FIRST_WAIT = 500, LONGEST_WAIT = 5000; // milliseconds before the next try
const HERE = 30000; // milliseconds between two signs of life
const PATIENCE = 6000; // milliseconds that a broken video may take to mend itself
const WAY = 12000; // milliseconds that a new video may take to find its way
const LOOK = 4000; // milliseconds between two looks at what of the video gets through
const LOST = 0.1; // share of lost packets that is told

export class Connection extends EventTarget {
  // `videos`: the elements for the tracks, by name.
  constructor(videos) {
    super();
    this.videos = videos;
    this.wait = FIRST_WAIT;
    this.open();
    setInterval(() => this.send({ type: 'here' }), HERE);
    setInterval(() => this.look(), LOOK);
  }

  open() {
    this.socket = new WebSocket(`${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/live`);
    this.socket.onopen = () => {
      this.wait = FIRST_WAIT;
      this.send({ type: 'watch' });
      this.tell('open', {});
    };
    this.socket.onmessage = event => {
      const message = JSON.parse(event.data);
      if (message.type === 'offer') this.answer(message.sdp).catch(problem => this.tell('problem', { text: `No video: ${problem.message}` }));
      else if (message.type === 'candidate') this.add(message);
      else this.tell(message.type, message);
      if (message.type === 'hello') this.tracks = message.tracks; // in the order of the offer
    };
    this.socket.onclose = event => {
      this.leave();
      this.tell('closed', { text: event.reason });
      setTimeout(() => this.open(), this.wait);
      this.wait = Math.min(2 * this.wait, LONGEST_WAIT);
    };
  }

  tell(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }

  // Whether there is a server to send to.
  send(message) {
    const open = this.socket.readyState === WebSocket.OPEN;
    if (open) this.socket.send(JSON.stringify(message));
    return open;
  }

  async answer(sdp) {
    this.leave();
    const peer = this.peer = new RTCPeerConnection({ iceServers: [] });
    this.early = [];
    // A browser that has no address to be reached at stays silent about it.
    this.broken = setTimeout(() => this.tryAgain(), WAY);
    peer.ontrack = event => {
      const video = this.videos[this.tracks[peer.getTransceivers().indexOf(event.transceiver)]];
      if (!video) return;
      if ('jitterBufferTarget' in event.receiver) event.receiver.jitterBufferTarget = 0;
      video.srcObject = new MediaStream([event.track]);
      video.play().catch(() => {}); // a page in the background may not play yet; it will when it is looked at
    };
    peer.onicecandidate = event => {
      // Names of mDNS cannot be looked up everywhere; the server learns the address behind them from the first packet.
      if (event.candidate?.candidate && !event.candidate.candidate.includes('.local'))
        this.send({ type: 'candidate', line: event.candidate.sdpMLineIndex, candidate: event.candidate.candidate });
    };
    peer.onconnectionstatechange = () => {
      if (peer.connectionState === 'connected') {
        clearTimeout(this.broken);
        this.tellVideo('', false);
      }
      if (peer.connectionState === 'failed') this.tryAgain();
      if (peer.connectionState === 'disconnected') {
        clearTimeout(this.broken);
        this.tellVideo('The video is interrupted', true);
        this.broken = setTimeout(() => this.send({ type: 'watch' }), PATIENCE);
      }
    };
    await peer.setRemoteDescription({ type: 'offer', sdp });
    await peer.setLocalDescription(await peer.createAnswer());
    this.send({ type: 'answer', sdp: peer.localDescription.sdp });
    for (const candidate of this.early) await peer.addIceCandidate(candidate);
    this.early = null;
  }

  tellVideo(text, bad) {
    this.tell('video', { text, bad });
  }

  tryAgain() {
    clearTimeout(this.broken);
    this.tellVideo('The video finds no way from the server to this browser: trying again', true);
    this.send({ type: 'watch' });
  }

  // What of the video gets through.
  async look() {
    const peer = this.peer, before = this.seen, now = { decoded: 0, received: 0, lost: 0 };
    if (peer?.connectionState !== 'connected') return;
    for (const stream of (await peer.getStats()).values())
      if (stream.type === 'inbound-rtp') {
        now.decoded += stream.framesDecoded;
        now.received += stream.packetsReceived;
        now.lost += stream.packetsLost;
      }
    if (peer !== this.peer) return;
    this.seen = now;
    if (!before || now.received === before.received) return;
    const lost = (now.lost - before.lost) / (now.lost - before.lost + now.received - before.received);
    const bad = lost > LOST || now.decoded === before.decoded;
    this.tellVideo(bad ? `${Math.round(100 * lost)} % of the video is lost on the way: a lower --bitrate of dff-studio may do` : '', bad);
  }

  add({ line, candidate }) {
    if (this.early) this.early.push({ sdpMLineIndex: line, candidate });
    else this.peer?.addIceCandidate({ sdpMLineIndex: line, candidate }).catch(() => {}); // of a video that is left already
  }

  leave() {
    clearTimeout(this.broken);
    this.peer?.close();
    this.peer = this.seen = null;
  }
}
