# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""The pipeline in front of the page: what --launch says, its outputs, and that it goes on."""
import concurrent.futures
import logging

import gi

gi.require_version('GstDff', '1.0')
from gi.repository import GLib, Gst, GstDff  # noqa: E402

from dff_studio import Unusable  # noqa: E402

OVERLAYS = ('confidence', 'motion')
WAITS = (0.5, 1, 2, 4, 8, 10)  # seconds before the next start, after each failure in a row
log = logging.getLogger('dff-studio')


def parse(launch):
    """A capture of it, see gst_dff_capture_new(), which is what dff-rtsp-server makes of it too."""
    try:
        return GstDff.dff_capture_new(launch)
    except GLib.Error as error:
        raise Unusable(error.message) from None


def items(iterator):
    """What a GstIterator gives; from the start again where it changed on the way."""
    found = []
    while True:
        result, item = iterator.next()
        if result == Gst.IteratorResult.OK:
            found.append(item)
        elif result == Gst.IteratorResult.RESYNC:
            iterator.resync()
            found = []
        else:
            return found


def of_factory(bin_, name):
    """The first element of that factory, in bins too."""
    for child in items(bin_.iterate_recurse()):
        if child.get_factory() and child.get_factory().get_name() == name:
            return child
    return None


def running_time(sample):
    """Nanoseconds since the pipeline's base time; None where the sample has none."""
    segment, pts = sample.get_segment(), sample.get_buffer().pts
    if segment.format != Gst.Format.TIME or pts == Gst.CLOCK_TIME_NONE:
        return None
    running = segment.to_running_time(Gst.Format.TIME, pts)
    return None if running == Gst.CLOCK_TIME_NONE else running


class Source:
    """Runs while it is wanted; started again, for ever, when it fails or ends. `on_sample(output, sample, age)` is called by its
    streaming threads, `age` in seconds since the first exposure; `on_state(text)` by the main loop, empty when it runs. What
    takes its time, starting and stopping a camera, is done by a thread of its own. With `on_end`, that is called at the end of
    the stream in place of another start. `overlays`: what dffdepth is asked for beside depth; `convert`: elements between an
    output and its samples, by the output's name. `delivered`: whether there was a sample since the last start; `progress`: what
    an element says that keeps the first one waiting."""

    def __init__(self, launch, on_sample, on_state, overlays=OVERLAYS, convert=None, on_end=None):
        self.on_sample, self.on_state, self.on_end = on_sample, on_state, on_end
        self.convert = convert or {}
        self.pipeline, capture = Gst.Pipeline.new(None), parse(launch)
        self.pipeline.add(capture)
        self.sinks = {}
        for pad in list(capture.srcpads):
            self.tap(pad.get_name(), pad, self.pipeline)
        self.depth_element = of_factory(self.pipeline, 'dffdepth')
        for name in overlays:
            self.tap_overlay(name)
        self.pipeline.use_clock(Gst.SystemClock.obtain())
        bus = self.pipeline.get_bus()
        bus.add_signal_watch()
        bus.connect('message', self.take_message)
        self.worker = concurrent.futures.ThreadPoolExecutor(1, 'source')
        self.wanted = self.failed = self.delivered = False
        self.progress = ''
        self.taken_caps = {}
        self.failures = 0
        self.retry = None

    def tap_overlay(self, name):
        """What dffdepth can tell beside depth, unless the pipeline has a use for it already."""
        if self.depth_element and not self.depth_element.get_static_pad(name):
            if pad := self.depth_element.request_pad_simple(name):
                self.tap(name, pad, self.depth_element.get_parent())

    def tap(self, name, pad, parent):
        queue, sink = Gst.ElementFactory.make('queue'), Gst.ElementFactory.make('appsink')
        queue.set_property('max-size-buffers', 4)
        queue.set_property('max-size-bytes', 0)
        queue.set_property('max-size-time', 0)
        sink.set_property('max-buffers', 1)
        sink.set_property('emit-signals', True)
        sink.connect('new-sample', self.take_sample, name)
        parent.add(queue)
        parent.add(sink)
        if name in self.convert:
            converter = Gst.parse_bin_from_description(self.convert[name], True)
            parent.add(converter)
            queue.link(converter)
            converter.link(sink)
        else:
            queue.link(sink)
        if pad.link(queue.get_static_pad('sink')) != Gst.PadLinkReturn.OK:
            raise Unusable(f'The output {name} of the source pipeline cannot be linked')
        self.sinks[name] = sink

    def take_sample(self, sink, name):
        sample = sink.emit('pull-sample')
        if sample is None:
            return Gst.FlowReturn.EOS
        if not self.is_fit(name, sample.get_caps()):
            return Gst.FlowReturn.OK
        running = running_time(sample)
        now = self.pipeline.get_pipeline_clock().get_time() - self.pipeline.get_base_time()
        self.on_sample(name, sample, None if running is None else (now - running) / Gst.SECOND)
        if not self.delivered:
            self.delivered = True
            GLib.idle_add(self.tell_delivery)
        return Gst.FlowReturn.OK

    def tell_delivery(self):
        if not self.failed:
            self.on_state('')

    def is_fit(self, name, caps):
        """Whether an output gives what its name says."""
        if name in self.convert or (name in self.taken_caps and caps.is_equal(self.taken_caps[name])):
            return True
        try:
            GstDff.dff_capture_check_caps(name, caps)
        except GLib.Error as error:
            GLib.idle_add(self.fail, error.message)
            return False
        self.taken_caps[name] = caps
        return True

    def want(self, wanted):
        if wanted != self.wanted:
            self.wanted, self.delivered = wanted, False
            self.forget_retry()
            self.failures = 0
            self.worker.submit(self.start if wanted else self.stop)

    def start(self):
        self.failed = self.delivered = False
        self.progress = ''
        live = self.pipeline.set_state(Gst.State.PAUSED) == Gst.StateChangeReturn.NO_PREROLL
        for sink in self.sinks.values():
            sink.set_property('sync', not live)  # what is not live is slowed down to its rate
        if self.pipeline.set_state(Gst.State.PLAYING) == Gst.StateChangeReturn.FAILURE:
            GLib.idle_add(self.fail, 'It does not start')
        else:
            GLib.idle_add(self.on_state, '')

    def stop(self):
        self.pipeline.set_state(Gst.State.NULL)

    def restart_with(self, change):
        """Stops, calls `change`, and goes on where it was wanted."""
        def work():
            self.pipeline.set_state(Gst.State.NULL)
            change()
            if self.wanted:
                self.start()
        self.forget_retry()
        self.worker.submit(work)

    def take_message(self, _, message):
        if message.type == Gst.MessageType.ERROR:
            error, details = message.parse_error()
            log.debug('%s', details)
            self.fail(error.message)
        elif message.type == Gst.MessageType.EOS and self.on_end:
            self.on_end()
        elif message.type == Gst.MessageType.EOS:
            self.fail('It came to its end')
        elif message.type == Gst.MessageType.PROGRESS:
            kind, _, text = message.parse_progress()
            self.progress = '' if kind == Gst.ProgressType.COMPLETE else text
        elif message.type == Gst.MessageType.WARNING:
            log.warning('%s', message.parse_warning()[0].message)
        elif message.type == Gst.MessageType.LATENCY:
            self.worker.submit(self.pipeline.recalculate_latency)

    def fail(self, reason):
        """Once a run: an element that fails takes others with it."""
        if self.failed or not self.wanted:
            return
        self.failed = True
        self.failures = 0 if self.delivered else self.failures
        wait = WAITS[min(self.failures, len(WAITS) - 1)]
        self.failures += 1
        text = f'The source stopped: {reason.rstrip(".")}. It is started again in {wait} s'
        log.warning('%s', text)
        self.on_state(text)
        self.worker.submit(self.stop)
        self.retry = GLib.timeout_add(int(wait * 1000), self.try_again)

    def try_again(self):
        self.retry = None
        self.worker.submit(self.start)
        return GLib.SOURCE_REMOVE

    def forget_retry(self):
        if self.retry:
            GLib.source_remove(self.retry)
            self.retry = None

    def end(self):
        self.wanted = False
        self.forget_retry()
        self.worker.submit(self.stop)
        self.worker.shutdown()
