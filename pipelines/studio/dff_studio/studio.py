# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""What belongs together: the source, its frames, the videos, and the browsers that look at them."""
import collections
import json
import logging
import pathlib
import threading
import time

from gi.repository import GLib

from dff_studio import Unusable, controls, frames, saving
from dff_studio.frames import Frames
from dff_studio.planes import StackTap
from dff_studio.session import Session
from dff_studio.source import OVERLAYS, Source
from dff_studio.video import TRACKS, Video
from dff_studio.web import parts

MOST_SESSIONS = 8
KEPT_FROZEN, KEPT_STACKS, KEPT_RECORDINGS = 8, 4, 4
KEPT_STACK_BYTES = 512 << 20  # of all stacks, where there is more than one: 64 planes of 1920x1080 are 200 MB
REST = 5  # seconds without anybody after which the source stops
SILENCE = 5  # seconds without a frame after which the page says so
PLANES_PAUSE = 1 / 12  # seconds between two planes that are shown, where there is no other picture
log = logging.getLogger('dff-studio')


class Kept:
    """The last few things, by number, and fewer where they weigh more together than `bound`. Any thread."""

    def __init__(self, most, dropped=lambda thing: None, weigh=lambda thing: 0, bound=0):
        self.most, self.dropped, self.weigh, self.bound = most, dropped, weigh, bound
        self.things, self.count, self.lock = collections.OrderedDict(), 0, threading.Lock()

    def add(self, thing):
        with self.lock:
            self.count += 1
            self.things[self.count] = thing
            while len(self.things) > self.most or (len(self.things) > 1 and sum(map(self.weigh, self.things.values())) > self.bound):
                self.dropped(self.things.popitem(last=False)[1])
            return self.count

    def get(self, number):
        with self.lock:
            return self.things.get(number)

    def clear(self):
        with self.lock:
            while self.things:
                self.dropped(self.things.popitem()[1])


class Studio:
    """All methods but `answer` and `take_frame` are called by the main loop."""

    def __init__(self, launch, addresses, bitrate):
        self.frames = Frames()
        self.source = Source(launch, self.take_frame, self.take_state)
        self.stacks = StackTap(self.source.depth_element)
        self.shows_planes = 'aif' not in self.source.sinks and 'planes' in self.source.sinks
        shown = self.source.sinks.keys() | ({'aif'} if self.shows_planes else set())
        self.video = Video(addresses, bitrate, [track for track in TRACKS if track in shown])
        self.plane_shown = 0.0
        self.outputs = [name for name in self.source.sinks if name != 'planes' or self.shows_planes]
        self.outputs += ['stacks'] if self.stacks.pad else []
        self.sessions = []
        self.frozen = Kept(KEPT_FROZEN)
        self.kept_stacks = Kept(KEPT_STACKS, weigh=lambda stack: stack.buffer.get_size(), bound=KEPT_STACK_BYTES)
        self.recordings = Kept(KEPT_RECORDINGS, saving.Recording.forget)
        self.recording = None
        self.trouble = ''
        self.state = ('', False)
        self.rest = None
        GLib.timeout_add(1000, self.tick)

    def take_frame(self, output, sample, age):
        if output == 'planes':
            if not self.shows_planes or time.monotonic() - self.plane_shown < PLANES_PAUSE:
                return
            self.plane_shown = time.monotonic()
            output = 'aif'
        self.frames.put(output, sample, age)
        if output in TRACKS:
            self.video.push(output, sample)

    def take_state(self, text):
        self.trouble = text
        self.tell_state()

    def state_of_source(self):
        """In words for the page, and whether it is trouble; no words where frames come."""
        if self.trouble:
            return self.trouble, True
        silence = self.frames.silence() if self.source.delivered else 0.0
        if self.source.progress and (silence > SILENCE or not self.source.delivered):
            return self.source.progress, False
        if not self.source.delivered:
            return 'The source starts', False
        return (f'No frame for {silence:.0f} s', True) if silence > SILENCE else ('', False)

    def tell_state(self):
        """Where it has changed."""
        state = self.state_of_source()
        if state != self.state:
            self.state = state
            self.tell({'type': 'state', 'text': state[0], 'bad': state[1]})

    def tell(self, message):
        for session in list(self.sessions):
            session.send(message)

    # Those who look

    def connected(self, connection):
        if len(self.sessions) >= MOST_SESSIONS:
            connection.close(1013, f'{MOST_SESSIONS} browsers look already')  # try again later
            return
        if self.rest:
            GLib.source_remove(self.rest)
            self.rest = None
        self.source.want(True)
        self.tell_state()
        session = Session(self, connection)
        self.sessions.append(session)
        session.send({'type': 'hello', 'outputs': self.outputs, 'tracks': self.video.tracks,
                      'controls': controls.controls(self.source.pipeline), 'recording': self.recording is not None,
                      'state': self.state[0], 'bad': self.state[1]})

    def gone(self, session):
        if session in self.sessions:
            self.sessions.remove(session)
        if not self.sessions and not self.rest:
            self.rest = GLib.timeout_add_seconds(REST, self.go_to_rest)

    def go_to_rest(self):
        self.rest = None
        self.stop_recording()
        self.source.want(False)
        self.frames.forget()
        return GLib.SOURCE_REMOVE

    def tick(self):
        self.tell_state()
        if self.sessions:
            rate, age = self.frames.pace()
            self.tell({'type': 'health', 'rate': rate, 'latency': age, 'viewers': len(self.sessions),
                       'stats': controls.stats(self.source.pipeline),
                       'recording': time.monotonic() - self.recording.started if self.recording else None})
            depth = self.frames.depth()
            if depth:
                self.tell({'type': 'histogram', **frames.histogram(depth), 'facts': depth.facts()})
            for session in list(self.sessions):
                session.look_whether_alive()
        if self.recording and self.recording.is_full():
            self.stop_recording()
        return GLib.SOURCE_CONTINUE

    # What they ask for

    def set(self, path, name, value):
        controls.set_property(self.source, path, name, value, lambda: GLib.idle_add(lambda: self.tell(self.controls())))

    def controls(self):
        return {'type': 'controls', 'controls': controls.controls(self.source.pipeline)}

    def depth_of(self, number):
        """Of a frozen frame, or the last one."""
        if number:
            kept = self.frozen.get(number)
            if not kept:
                raise Unusable('That frame is not kept any more: freeze another')
            depth = kept['depth']
        else:
            depth = self.frames.depth()
        if not depth:
            raise Unusable('There is no depth yet' if 'depth' in self.source.sinks else 'This source gives no depth')
        return depth

    def uncertainty_of(self, number):
        return self.frozen.get(number)['uncertainty'] if number and self.frozen.get(number) else self.frames.get('uncertainty')

    def overlays_of(self, number):
        if number and self.frozen.get(number):
            return self.frozen.get(number)['overlays']
        return {name: sample for name in OVERLAYS if (sample := self.frames.get(name))}

    def freeze(self):
        picture, depth = self.frames.pair()
        if not picture and not depth:
            raise Unusable('There is no frame yet')
        number = self.frozen.add({'picture': picture, 'depth': depth, 'overlays': self.overlays_of(0),
                                  'uncertainty': self.uncertainty_of(0)})
        return {'type': 'frozen', 'number': number, 'picture': picture is not None, 'facts': depth.facts() if depth else None}

    def start_recording(self):
        if self.recording:
            return
        if not self.frames.pair()[0] or not self.frames.depth():
            raise Unusable('There is nothing to record yet: picture and depth are needed')
        self.recording = saving.Recording(self.video, self.frames.depth())
        self.tell({'type': 'recording', 'on': True})

    def stop_recording(self):
        if not self.recording:
            return
        recording, self.recording = self.recording, None

        def finish():
            try:
                recording.finish()
                number = self.recordings.add(recording)
                message = {'type': 'recording', 'on': False, 'url': f'/recording/{number}.mkv'}
            except Unusable as error:
                recording.forget()
                message = {'type': 'recording', 'on': False, 'text': str(error)}
            GLib.idle_add(lambda: self.tell(message))
        threading.Thread(target=finish).start()

    # What they load, by a thread of the server's

    def answer(self, path):
        if found := parts(path, r'/overlay/(confidence|motion)\.jpg'):
            sample = self.frames.get(found[0])
            return saving.jpeg(sample) if sample else None
        if found := parts(path, r'/stack/(\d+)/(\d+)\.jpg'):
            stack, plane = self.kept_stacks.get(int(found[0])), int(found[1])
            return saving.jpeg(stack.sample(plane)) if stack and plane < stack.planes else None
        if found := parts(path, r'/recording/(\d+)\.mkv'):
            recording = self.recordings.get(int(found[0]))
            return pathlib.Path(recording.path) if recording else None
        if found := parts(path, r'/frozen/(\d+)/([a-z.]+)'):
            kept = self.frozen.get(int(found[0]))
            return self.file_of(kept, found[1]) if kept else None
        return None

    @staticmethod
    def file_of(kept, name):
        """A file of a frozen frame."""
        picture, depth = kept['picture'], kept['depth']
        overlay = kept['overlays'].get(name.removesuffix('.jpg'))
        if name.endswith('.jpg') and overlay:
            return saving.jpeg(overlay)
        if name == 'picture.jpg' and picture:
            return saving.jpeg(picture, 95)
        if name == 'depth.bin' and depth:
            return depth.pixels().tobytes()
        if name == 'depth.json' and depth:
            return json.dumps(depth.facts()).encode()
        kinds = {'picture.png': 'png', 'depth.png': 'depth.png', 'frame.exr': 'exr', 'cloud.ply': 'ply'}
        return saving.file_of(kinds[name], picture, depth) if name in kinds else None

    def end(self):
        for session in list(self.sessions):
            session.end()
        if self.recording:
            self.recording.forget()
        self.recordings.clear()
        self.source.end()
        self.video.end()
