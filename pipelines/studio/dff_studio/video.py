# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""Picture and depth as WebRTC video: encoded once, for all who look."""
import ctypes
import logging

import gi

gi.require_version('GstSdp', '1.0')
gi.require_version('GstVideo', '1.0')
gi.require_version('GstWebRTC', '1.0')
from gi.repository import GLib, Gst, GstSdp, GstVideo, GstWebRTC  # noqa: E402

from dff_studio import Unusable  # noqa: E402

TRACKS = ('aif', 'depth')
LONGEST_SIDE = 960  # of the video, in pixels; frozen and saved pictures keep theirs
CAPS = 'application/x-rtp,media=video,encoding-name=VP8,payload=96,clock-rate=90000'
# Depth is scaled before it is painted, without mixing 0, "not known", in.
PAINT = {'aif': 'videoconvert ! videoscale', 'depth': 'videoscale method=nearest-neighbour ! {limit} ! depthcolorize palette=hue ! videoconvert'}
PACKAGES = {'webrtcbin': 'gstreamer1.0-plugins-bad', 'dtlssrtpenc': 'gstreamer1.0-plugins-bad', 'nicesink': 'gstreamer1.0-nice',
            'vp8enc': 'gstreamer1.0-plugins-good', 'rtpvp8pay': 'gstreamer1.0-plugins-good', 'depthcolorize': 'these plug-ins'}
log = logging.getLogger('dff-studio')


def description(track, bitrate):
    limit = f'video/x-raw,width=[2,{LONGEST_SIDE}],height=[2,{LONGEST_SIDE}],pixel-aspect-ratio=1/1'
    return (f'appsrc name={track} is-live=true format=time do-timestamp=true max-buffers=2 max-bytes=0 leaky-type=downstream ! '
            f'{PAINT[track].format(limit=limit)} ! {limit},format=I420,colorimetry=bt601 ! '
            f'vp8enc name={track}-encoder deadline=1 cpu-used=8 threads=2 end-usage=cbr target-bitrate={bitrate} keyframe-max-dist=300 '
            f'buffer-initial-size=200 buffer-optimal-size=300 buffer-size=400 max-quantizer=40 ! '
            f'rtpvp8pay picture-id-mode=2 mtu=1200 ! {CAPS} ! tee name={track}-tee allow-not-linked=true')


def ice_of(peer):
    """What finds the ways to the browser. GStreamer 1.22 gives it out with a floating reference, which Python takes for its own:
    the peer would be left with an object that is freed."""
    ice = peer.get_property('ice-agent')
    if ice.__grefcount__ == 1:
        reference = ctypes.CDLL('libgobject-2.0.so.0').g_object_ref
        reference.argtypes, reference.restype = [ctypes.c_void_p], ctypes.c_void_p
        reference(hash(ice))
    return ice


class Video:
    """The encoders, and the viewers behind them. `addresses`: those that media may go by; empty: all of this machine. `tracks`:
    those that there are pictures for; webrtcbin offers nothing before all have some."""

    def __init__(self, addresses, bitrate, tracks):
        for element, package in PACKAGES.items():
            if not Gst.ElementFactory.find(element):
                raise Unusable(f'GStreamer has no element {element}: install {package}')
        self.addresses, self.tracks = addresses, tracks
        self.pipeline = Gst.parse_launch(' '.join(description(track, bitrate) for track in tracks)) if tracks else Gst.Pipeline.new(None)
        self.sources = {track: self.pipeline.get_by_name(track) for track in tracks}
        self.caps = {}
        bus = self.pipeline.get_bus()
        bus.add_signal_watch()
        bus.connect('message', self.take_message)
        self.pipeline.set_state(Gst.State.PLAYING)

    def push(self, track, sample):
        """Any thread."""
        source, caps = self.sources[track], sample.get_caps()
        if self.caps.get(track) is None or not caps.is_equal(self.caps[track]):
            source.set_property('caps', caps)
            self.caps[track] = caps
        buffer = sample.get_buffer().copy()  # the pixels are shared
        buffer.pts = buffer.dts = Gst.CLOCK_TIME_NONE
        source.emit('push-buffer', buffer)

    def take_message(self, _, message):
        if message.type == Gst.MessageType.ERROR:
            error, details = message.parse_error()
            log.warning('Video: %s (%s)', error.message, details)
            if message.src and self.is_encoding(message.src):  # a viewer that fails is no reason to stop the others
                self.pipeline.set_state(Gst.State.READY)
                self.caps.clear()
                self.pipeline.set_state(Gst.State.PLAYING)

    def is_encoding(self, element):
        while element and not isinstance(element, Gst.Pipeline):
            if element.get_name().startswith('viewer'):
                return False
            element = element.get_parent()
        return True

    def ask_for_whole_picture(self):
        for track in self.tracks:
            event = GstVideo.video_event_new_upstream_force_key_unit(Gst.CLOCK_TIME_NONE, True, 0)
            self.pipeline.get_by_name(f'{track}-encoder').get_static_pad('src').send_event(event)

    def end(self):
        self.pipeline.set_state(Gst.State.NULL)


class Viewer:
    """One browser. `send(message)` is called by the main loop, with offers and candidates for it."""
    count = 0

    def __init__(self, video, send):
        self.video, self.send_now = video, send
        self.gone = False
        Viewer.count += 1
        self.bin = Gst.Bin.new(f'viewer{Viewer.count}')
        self.peer = Gst.ElementFactory.make('webrtcbin')
        self.peer.set_property('bundle-policy', GstWebRTC.WebRTCBundlePolicy.MAX_BUNDLE)
        self.bin.add(self.peer)
        ice = ice_of(self.peer)
        ice.get_property('agent').set_property('upnp', False)  # nobody asked for a hole in the router
        for address in video.addresses:
            ice.emit('add-local-ip-address', address)
        self.signals = [
            self.peer.connect('on-negotiation-needed', lambda peer: peer.emit('create-offer', None, self.then(self.take_offer))),
            self.peer.connect('on-ice-candidate', lambda _, line, text: self.send({'type': 'candidate', 'line': line, 'candidate': text})),
            self.peer.connect('notify::ice-connection-state', self.look_at_connection)]
        inlets = [self.inlet(track) for track in range(len(video.tracks))]
        video.pipeline.add(self.bin)
        self.bin.sync_state_with_parent()  # before packets come: a tee that meets a pad at rest gives up, for all
        self.pads = []
        for track, inlet in zip(video.tracks, inlets):
            tee = video.pipeline.get_by_name(f'{track}-tee')
            pad = tee.request_pad_simple('src_%u')
            self.pads.append((tee, pad))
            pad.link(inlet)

    def inlet(self, number):
        """The bin's pad for a track."""
        queue = Gst.ElementFactory.make('queue')
        for name, value in (('leaky', 2), ('max-size-buffers', 400), ('max-size-bytes', 0), ('max-size-time', 0)):
            queue.set_property(name, value)
        self.bin.add(queue)
        queue.link_pads_filtered('src', self.peer, 'sink_%u', Gst.Caps.from_string(CAPS))
        transceiver = self.peer.emit('get-transceiver', number)
        transceiver.set_property('direction', GstWebRTC.WebRTCRTPTransceiverDirection.SENDONLY)
        transceiver.set_property('do-nack', True)
        ghost = Gst.GhostPad.new(f'sink_{number}', queue.get_static_pad('sink'))
        self.bin.add_pad(ghost)
        return ghost

    def then(self, function):
        """By the main loop: two threads that meet a type for the first time would each make half of it."""
        return Gst.Promise.new_with_change_func(lambda promise, *_: GLib.idle_add(function, promise), None)

    def take_offer(self, promise):
        if promise.wait() != Gst.PromiseResult.REPLIED or self.gone:
            return
        reply = promise.get_reply()  # which owns the offer
        offer = reply.get_value('offer')
        self.peer.emit('set-local-description', offer, None)
        self.send({'type': 'offer', 'sdp': offer.sdp.as_text()})

    def take_answer(self, text):
        result, sdp = GstSdp.SDPMessage.new_from_text(text)
        if result != GstSdp.SDPResult.OK:
            return
        answer = GstWebRTC.WebRTCSessionDescription.new(GstWebRTC.WebRTCSDPType.ANSWER, sdp)
        self.peer.emit('set-remote-description', answer, self.then(lambda _: self.video.ask_for_whole_picture()))

    def take_candidate(self, line, text):
        self.peer.emit('add-ice-candidate', line, text)

    def look_at_connection(self, peer, _):
        if peer.get_property('ice-connection-state') in (GstWebRTC.WebRTCICEConnectionState.CONNECTED,
                                                         GstWebRTC.WebRTCICEConnectionState.COMPLETED):
            GLib.idle_add(self.video.ask_for_whole_picture)

    def send(self, message):
        GLib.idle_add(lambda: None if self.gone else self.send_now(message))

    def end(self):
        self.gone = True
        for signal in self.signals:  # which hold this, which holds the peer
            self.peer.disconnect(signal)
        for _, pad in self.pads:
            pad.add_probe(Gst.PadProbeType.IDLE, self.unlink)

    def unlink(self, pad, _):
        """Between two packets, by any thread: one that was on its way into a stopped viewer would stop the encoder for all."""
        pad.unlink(pad.get_peer())
        GLib.idle_add(self.finish, pad)
        return Gst.PadProbeReturn.REMOVE

    def finish(self, unlinked):
        """When the last pad is unlinked, the rest goes."""
        for tee, pad in self.pads:
            if pad == unlinked:
                tee.release_request_pad(pad)
        self.pads = [entry for entry in self.pads if entry[1] != unlinked]
        if not self.pads:
            self.bin.set_state(Gst.State.NULL)
            self.video.pipeline.remove(self.bin)
            self.bin = self.peer = None
        return GLib.SOURCE_REMOVE
