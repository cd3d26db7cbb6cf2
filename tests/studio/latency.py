#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""How long light takes from the lens to a viewer of dff-studio, and what a second viewer costs; by hand:

    meson devenv -C build                                                     # as root, and in its shell:
    cd .. && unshare -n sh -c 'ip link set lo up && tests/studio/latency.py'  # or with --browser

The simulated rig's light is switched between two sweeps. From the moment that the first exposure under the new light begins, it
takes so long until the picture's mean brightness has changed by half, at a receiver by WebRTC that decodes it or, with --browser, on
the page in a headless Chromium. Then processor time of the server for each stack, with one receiver and with two, in turns.
"""
import argparse
import logging
import pathlib
import statistics
import subprocess
import sys
import tempfile
import threading
import time

import gi

gi.require_version('Gst', '1.0')
gi.require_version('Soup', '3.0')
from gi.repository import GLib, Gst  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'pipelines/studio'))
SWITCH = 6  # seconds from one switch of the light to the next
WARM = 12   # seconds, for kernels and connections
SHARE = 20  # seconds of each measurement of processor time
ROUNDS = 3


class Server:
    """dff-studio in this process, which knows when the light was switched."""

    def __init__(self, rate):
        from dff_studio import arguments, frames
        from dff_studio.access import Access
        from dff_studio.source import of_factory
        from dff_studio.studio import Studio
        from dff_studio.web import Web
        frames.load_types()
        self.studio = Studio(arguments.rig(), ['127.0.0.1'], 2500000)
        camera = of_factory(self.studio.source.pipeline, 'lenssweeptestsrc')
        camera.set_property('rate', rate)
        self.period = int(SWITCH * camera.get_property('rate') * camera.get_property('planes'))
        camera.set_property('light-switch', self.period)
        camera.get_static_pad('src').add_probe(Gst.PadProbeType.BUFFER, self.watch)
        self.count, self.switches, self.stacks, self.ages = 0, [], 0, []
        GLib.timeout_add_seconds(1, self.note_age)
        self.studio.source.depth_element.get_static_pad('src').add_probe(Gst.PadProbeType.BUFFER, self.count_stack)
        self.web = Web(Access(None, {}), None, self.studio.answer, self.studio.connected)
        self.web.listen(None, 0)
        self.port = int(self.web.urls()[0].rstrip('/').rsplit(':', 1)[1])

    def watch(self, _, info):
        if self.count and self.count % self.period == 0:
            self.switches.append((self.studio.source.pipeline.get_base_time() + info.get_buffer().pts) / Gst.SECOND)
        self.count += 1
        return Gst.PadProbeReturn.OK

    def note_age(self):
        """From the first exposure to depth, as the page shows it."""
        if age := self.studio.frames.pace()[1]:
            self.ages.append(age)
        return GLib.SOURCE_CONTINUE

    def count_stack(self, *_):
        self.stacks += 1
        return Gst.PadProbeReturn.OK

    def seconds_a_stack(self):
        """Of processor time, over some seconds."""
        stacks, used = self.stacks, time.process_time()
        time.sleep(SHARE)
        return (time.process_time() - used) / max(1, self.stacks - stacks)


def receive(port):
    """Prints when each picture came and how bright it is."""
    from dff_studio.video import ice_of
    from studio_process import Socket
    gi.require_version('GstSdp', '1.0')
    gi.require_version('GstWebRTC', '1.0')
    from gi.repository import GstSdp, GstWebRTC
    socket = Socket(argparse.Namespace(port=port))
    pipeline, peer = Gst.Pipeline(), Gst.ElementFactory.make('webrtcbin')
    peer.set_property('bundle-policy', GstWebRTC.WebRTCBundlePolicy.MAX_BUNDLE)
    pipeline.add(peer)
    ice_of(peer).emit('add-local-ip-address', '127.0.0.1')

    def take_sample(sink):
        sample = sink.emit('pull-sample')
        caps, buffer = sample.get_caps().get_structure(0), sample.get_buffer()
        luma = buffer.extract_dup(0, caps.get_value('width') * caps.get_value('height'))
        print(time.monotonic(), sum(luma[::97]) / len(luma[::97]), flush=True)
        return Gst.FlowReturn.OK

    def take_pad(_, pad):
        if pad.get_property('transceiver').get_property('mlineindex') == 0:  # the picture; depth is the second
            tail = Gst.parse_bin_from_description('rtpvp8depay request-keyframe=true wait-for-keyframe=true ! vp8dec ! '
                                                  'appsink name=out sync=false emit-signals=true', True)
            tail.get_by_name('out').connect('new-sample', take_sample)
        else:
            tail = Gst.ElementFactory.make('fakesink')
        pipeline.add(tail)
        tail.sync_state_with_parent()
        pad.link(tail.sinkpads[0])

    def take_answer(promise, *_):
        reply = promise.get_reply()  # which owns the answer
        answer = reply.get_value('answer')
        text = answer.sdp.as_text()
        peer.emit('set-local-description', answer, None)
        GLib.idle_add(lambda: socket.send(type='answer', sdp=text))

    def take_messages():
        while socket.inbox:
            message = socket.inbox.pop(0)
            if message['type'] == 'offer':
                _, sdp = GstSdp.SDPMessage.new_from_text(message['sdp'])
                offer = GstWebRTC.WebRTCSessionDescription.new(GstWebRTC.WebRTCSDPType.OFFER, sdp)
                peer.emit('set-remote-description', offer, None)
                peer.emit('create-answer', None, Gst.Promise.new_with_change_func(take_answer))
            elif message['type'] == 'candidate':
                peer.emit('add-ice-candidate', message['line'], message['candidate'])
        return GLib.SOURCE_CONTINUE

    peer.connect('pad-added', take_pad)
    peer.connect('on-ice-candidate', lambda _, line, text: GLib.idle_add(lambda: socket.send(type='candidate', line=line, candidate=text)))
    pipeline.set_state(Gst.State.PLAYING)
    socket.send(type='watch')
    GLib.timeout_add(20, take_messages)
    loop = GLib.MainLoop()
    GLib.unix_fd_add_full(GLib.PRIORITY_DEFAULT, sys.stdin.fileno(), GLib.IOCondition.HUP, lambda *_: loop.quit())  # who started it is gone
    loop.run()


def latencies(switches, seen):
    """Seconds from each switch of the light to the first picture that is nearer to the new brightness than to the old."""
    found = []
    for at, after in zip(switches, switches[1:]):
        old = [bright for when, bright in seen if at - SWITCH / 2 < when < at]
        new = [bright for when, bright in seen if after - SWITCH / 3 < when < after]
        if old and new:
            middle = (statistics.median(old) + statistics.median(new)) / 2
            rises = statistics.median(new) > middle
            found += [when - at for when, bright in seen if when > at and (bright > middle) == rises][:1]
    return found


class Receivers:
    """Receivers of their own processes."""

    def __init__(self, port):
        self.port, self.running, self.seen = port, [], []

    def set_count(self, count):
        while len(self.running) > count:
            self.running.pop().terminate()
        while len(self.running) < count:
            self.running.append(subprocess.Popen([sys.executable, __file__, '--receive', str(self.port)], stdin=subprocess.PIPE,
                                                 stdout=subprocess.PIPE, text=True))
            threading.Thread(target=self.read, args=(self.running[-1],), daemon=True).start()

    def read(self, process):
        for line in process.stdout:
            if process is self.running[0]:
                self.seen.append(tuple(float(word) for word in line.split()))


LOOK = '''
const small = document.createElement('canvas');
Object.assign(small, { width: 16, height: 12 });
const context = small.getContext('2d', { willReadFrequently: true });
window.seen = [];
const look = () => {
  context.drawImage(picture, 0, 0, 16, 12);
  const data = context.getImageData(0, 0, 16, 12).data;
  let sum = 0;
  for (let i = 1; i < data.length; i += 4) sum += data[i];
  seen.push([performance.timeOrigin + performance.now(), sum / 192]);
  picture.requestVideoFrameCallback(look);
};
picture.requestVideoFrameCallback(look);
'''


def seen_on_the_page(port, seconds):
    import test_page
    for command in test_page.NETWORK:
        subprocess.run(command.split(), check=True)
    with tempfile.TemporaryDirectory() as folder:
        browser = test_page.Browser(folder)
        try:
            browser.driver.get(f'http://localhost:{port}/')
            browser.is_playing()
            browser.run(LOOK)
            time.sleep(seconds)
            offset = time.time() - time.monotonic()
            return [(when / 1000 - offset, bright) for when, bright in browser.run('return seen')]
        finally:
            browser.driver.quit()


def tell(name, values):
    if not values:
        raise SystemExit(f'{name}: no picture came')
    if max(values) > SWITCH / 2:
        print('The machine is too slow for this, and what follows means nothing: lower --rate')
    print(f'{name}: {statistics.median(values) * 1000:.0f} ms ({min(values) * 1000:.0f}-{max(values) * 1000:.0f}, {len(values)} times)', flush=True)


def measure(server, options, done):
    try:
        if options.browser:
            tell('from light to the page', latencies(server.switches, seen_on_the_page(server.port, options.seconds + WARM)))
            return tell('of it, first exposure to depth', server.ages[WARM:])
        receivers = Receivers(server.port)
        receivers.set_count(1)
        time.sleep(WARM + options.seconds)
        tell('from light to a receiver', latencies(server.switches, receivers.seen))
        tell('of it, first exposure to depth', server.ages[WARM:])
        used = {1: [], 2: []}
        for count in [1, 2] * ROUNDS:
            receivers.set_count(count)
            time.sleep(5)
            used[count].append(server.seconds_a_stack())
            tell(f'processor time a stack with {count}', used[count][-1:])
        receivers.set_count(0)
        ratios = [two / one for one, two in zip(used[1], used[2])]
        print('two receivers over one:', ' '.join(f'{ratio:.3f}' for ratio in ratios), f'median {statistics.median(ratios):.3f}')
    finally:
        GLib.idle_add(done)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--browser', action='store_true')
    parser.add_argument('--seconds', type=int, default=60, help='of watching the light; default: 60')
    parser.add_argument('--rate', type=float, default=10, help='sweeps a second, fewer for a slow machine; default: 10')
    parser.add_argument('--receive', type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    logging.basicConfig()
    Gst.init(None)
    if options.receive:
        return receive(options.receive)
    server, loop = Server(options.rate), GLib.MainLoop()
    worker = threading.Thread(target=measure, args=(server, options, loop.quit))
    worker.start()
    loop.run()
    worker.join()
    server.web.end()
    server.studio.end()
    return None


if __name__ == '__main__':
    main()
