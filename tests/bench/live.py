#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""live.py [--seconds S] [--method M] [--size WxH] [--planes N] [--rate R] [--window sweep|rolling] [--denoise F [--local-motion]]
           [--camera OPTIONS]

A live camera through focalstackmux, dffdepth and aifcompose to a clocked sink, as on a rig. Prints as Markdown how many
stacks were late or dropped, how many of these while a hypervisor took the processors away, and how long after its last
plane a stack's depth left.

What the camera shows is rendered before, since noise and motion take longer than a sweep lasts: 24 sweeps of
lenssweeptestsrc, which come again and again.

Run it in `meson devenv -C build`, on a machine that has nothing else to do; five minutes (--seconds 300) are the proof,
ten seconds a trial.
"""
import argparse
import bisect
import collections
import sys
import threading
import time

import gi

gi.require_version("Gst", "1.0")
gi.require_version("GstDff", "1.0")
from gi.repository import Gst, GstDff

BUCKETS_MS = [*range(0, 100, 5), *range(100, 200, 25), *range(200, 500, 100), 500, 1000, 2000, 5000, float("inf")]
RENDERED_SWEEPS = 24
STOLEN_SHARE = 0.02  # of a second's processor time, above which the machine was not ours


class Camera:
    """Frames of lenssweeptestsrc, shown again and again at the rate of a live camera."""

    def __init__(self, options):
        self.planes, self.rate = options.planes, options.rate
        self.shown = int(options.seconds * options.rate) * options.planes
        self.frames, self.caps = [], None
        self.render(options)

    def render(self, options):
        width, height = options.size.split("x")
        wanted = min(RENDERED_SWEEPS * self.planes, self.shown)
        pipeline = Gst.parse_launch(
            f"lenssweeptestsrc planes={self.planes} rate={self.rate} num-buffers={wanted} {options.camera} ! "
            f"video/x-raw,format=I420,width={width},height={height} ! appsink name=frames sync=false")
        frames, bus = pipeline.get_by_name("frames"), pipeline.get_bus()
        pipeline.set_state(Gst.State.PLAYING)
        while len(self.frames) < wanted:
            sample = frames.emit("try-pull-sample", Gst.SECOND)
            while message := bus.pop_filtered(Gst.MessageType.ERROR | Gst.MessageType.PROGRESS):
                if message.type == Gst.MessageType.ERROR:
                    raise SystemExit(message.parse_error()[0].message)
                print(message.parse_progress()[2], file=sys.stderr)
            if sample:
                self.caps = sample.get_caps()
                self.frames.append((sample.get_buffer(), GstDff.buffer_get_focus_meta(sample.get_buffer()).get_focus()))
                if len(self.frames) % (4 * self.planes) == 0:
                    print(f"{len(self.frames)} of {wanted} frames are rendered", file=sys.stderr)
        pipeline.set_state(Gst.State.NULL)

    def duration(self):
        return Gst.SECOND // (self.rate * self.planes)

    def frame(self, number):
        """In the memory of the one that was rendered."""
        rendered, focus = self.frames[number % len(self.frames)]
        buffer = rendered.copy_region(Gst.BufferCopyFlags.MEMORY, 0, rendered.get_size())
        focus.sweep, focus.frame_id = number // self.planes, number
        GstDff.buffer_add_focus_meta(buffer, focus)
        buffer.pts = number * Gst.SECOND // (self.rate * self.planes)
        buffer.duration = self.duration()
        return buffer

    def play(self, pipeline):
        """From now on, in a thread of its own. A frame leaves the camera at the end of its exposure."""
        source, clock = pipeline.get_by_name("camera"), pipeline.get_clock()
        start = clock.get_time() - pipeline.get_base_time()

        def push():
            for number in range(self.shown):
                buffer = self.frame(number)
                buffer.pts += start
                clock.id_wait(clock.new_single_shot_id(pipeline.get_base_time() + buffer.pts + buffer.duration))
                if source.emit("push-buffer", buffer) != Gst.FlowReturn.OK:
                    return
            source.emit("end-of-stream")

        threading.Thread(target=push, daemon=True).start()


def pipeline_text(options, camera):
    denoise = (f"queue max-size-bytes=0 ! focalstackdenoise name=denoise frames={options.denoise} "
               f"local-motion={options.local_motion} ! " if options.denoise > 1 else "")
    return (
        f"appsrc name=camera is-live=true format=time block=true max-buffers=1 max-bytes=0 "
        f"min-latency={camera.duration()} ! queue ! "
        f"focalstackmux name=mux window={options.window} ! {denoise}tee name=s  "
        f"s. ! queue max-size-bytes=0 ! dffdepth name=depth method={options.method} ! tee name=d  "
        "d. ! queue ! picture.depth  s. ! queue max-size-bytes=0 ! picture.stack  "
        "aifcompose name=picture ! queue ! fakesink name=sink sync=true qos=true max-lateness=20000000  "
        "d. ! queue ! fakesink sync=false async=false"
    )


class Latency:
    """From the arrival of a stack's last plane at the mux to its depth leaving dffdepth. The k-th depth belongs to the
    k-th stack: dffdepth never drops."""

    def __init__(self, pipeline, planes, rolling):
        self.planes, self.rolling = planes, rolling
        self.frames = 0
        self.arrived = collections.deque()
        self.milliseconds = []
        probe = Gst.PadProbeType.BUFFER
        pipeline.get_by_name("mux").get_static_pad("sink").add_probe(probe, self.frame_arrives)
        pipeline.get_by_name("depth").get_static_pad("src").add_probe(probe, self.depth_leaves)

    def frame_arrives(self, *_):
        self.frames += 1
        complete = self.frames >= self.planes if self.rolling else self.frames % self.planes == 0
        if complete:
            self.arrived.append(time.monotonic())
        return Gst.PadProbeReturn.OK

    def depth_leaves(self, *_):
        if self.arrived:
            self.milliseconds.append(1e3 * (time.monotonic() - self.arrived.popleft()))
        return Gst.PadProbeReturn.OK

    def print(self):
        if not self.milliseconds:
            print("No depth has left.")
            return
        ordered = sorted(self.milliseconds)
        at = lambda share: ordered[min(int(share * len(ordered)), len(ordered) - 1)]
        print(f"\nLast plane's arrival to depth, ms: median {at(0.5):.1f}, 95 % {at(0.95):.1f}, "
              f"99 % {at(0.99):.1f}, longest {ordered[-1]:.1f}, the first {self.milliseconds[0]:.1f}\n")
        print("| ms | stacks |\n|---|---|")
        buckets = collections.Counter(bisect.bisect_right(BUCKETS_MS, value) for value in ordered)
        for bucket in sorted(buckets):
            print(f"| {BUCKETS_MS[bucket - 1]} to {BUCKETS_MS[bucket]} | {buckets[bucket]} |")


def processor_ticks():
    """All ticks of all processors so far, and those that the hypervisor gave to others."""
    with open("/proc/stat") as stat:
        ticks = [int(word) for word in stat.readline().split()[1:9]]
    return sum(ticks), ticks[7]


class StolenTime:
    """What the hypervisor took away, second by second."""

    def __init__(self):
        self.ends, self.shares = [], []
        self.stop = threading.Event()
        self.first = self.last = processor_ticks()
        self.thread = threading.Thread(target=self.sample, daemon=True)
        self.thread.start()

    def sample(self):
        while not self.stop.wait(1.0):
            self.take()

    def take(self):
        now = processor_ticks()
        self.ends.append(time.monotonic())
        self.shares.append((now[1] - self.last[1]) / max(now[0] - self.last[0], 1))
        self.last = now

    def print(self, late):
        self.stop.set()
        self.thread.join()
        self.take()
        robbed = sum(share > STOLEN_SHARE for share in self.shares)
        late_then = sum(self.shares[min(bisect.bisect_left(self.ends, moment), len(self.ends) - 1)] > STOLEN_SHARE
                        for moment in late)
        share = (self.last[1] - self.first[1]) / max(self.last[0] - self.first[0], 1)
        print(f"hypervisor: {share:.1%} of the processor time stolen, more than {STOLEN_SHARE:.0%} in {robbed} of "
              f"{len(self.shares)} seconds; {late_then} of the {len(late)} late pictures fell in these")


def run(pipeline, camera):
    """Until the end; returns when pictures were too late for the sink."""
    late = []
    bus = pipeline.get_bus()
    pipeline.set_state(Gst.State.PLAYING)
    camera.play(pipeline)
    while True:
        message = bus.timed_pop_filtered(Gst.CLOCK_TIME_NONE, Gst.MessageType.EOS | Gst.MessageType.ERROR |
                                         Gst.MessageType.LATENCY | Gst.MessageType.QOS)
        if message.type == Gst.MessageType.LATENCY:
            pipeline.recalculate_latency()
        elif message.type == Gst.MessageType.QOS:
            if message.src.get_name() == "sink":
                late.append(time.monotonic())
        elif message.type == Gst.MessageType.ERROR:
            error, _ = message.parse_error()
            raise SystemExit(error.message)
        else:
            return late


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=300)
    parser.add_argument("--method", default="volume")
    parser.add_argument("--size", default="1920x1080")
    parser.add_argument("--planes", type=int, default=6)
    parser.add_argument("--rate", type=int, default=26)
    parser.add_argument("--window", default="sweep")
    parser.add_argument("--denoise", type=int, default=1, metavar="F", help="sweeps that focalstackdenoise averages")
    parser.add_argument("--local-motion", action="store_true", help="what moves is followed")
    parser.add_argument("--camera", default="", metavar="OPTIONS", help="of lenssweeptestsrc: noise=strong motion=4")
    options = parser.parse_args()

    Gst.init(None)
    camera = Camera(options)
    pipeline = Gst.parse_launch(pipeline_text(options, camera))
    pipeline.get_by_name("camera").set_property("caps", camera.caps)
    latency = Latency(pipeline, options.planes, options.window == "rolling")
    stolen = StolenTime()
    start, start_cpu = time.monotonic(), time.process_time()
    late = run(pipeline, camera)
    passed, cpu = time.monotonic() - start, time.process_time() - start_cpu

    stacks = int(options.seconds * options.rate)
    if options.window == "rolling":
        stacks = stacks * options.planes - options.planes + 1
    stats = pipeline.get_by_name("sink").get_property("stats")
    rendered, dropped = stats.get_uint64("rendered")[1], stats.get_uint64("dropped")[1]
    print(f"method={options.method}, {options.size}, N={options.planes}, window={options.window}: {stacks} stacks asked "
          f"for, {len(latency.milliseconds)} depth maps, {rendered} pictures in time, {dropped} late and dropped; "
          f"{len(latency.milliseconds) / passed:.1f} depth maps/s over {passed:.1f} s, {cpu / passed:.2f} CPUs busy")
    print(f"mux: {pipeline.get_by_name('mux').get_property('stats').to_string()}")
    if denoiser := pipeline.get_by_name("denoise"):
        stats = denoiser.get_property("stats")
        print("denoise: " + ", ".join(f"{name} {stats.get_value(name):.3g}" for name in ("stacks", "sweeps", "moved")))
    stolen.print(late)
    latency.print()
    pipeline.set_state(Gst.State.NULL)


if __name__ == "__main__":
    main()
