/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "support.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <gtest/gtest.h>
#include <random>
#include <thread>

/* Random walks through what applications do to a mux: nothing may hang, crash or be called critical.
 * DFF_WALKS sets how many, DFF_SEED the first seed. */

namespace {

constexpr unsigned planes = 3;
constexpr unsigned steps = 25;

std::atomic<unsigned> criticals = 0;

void count_criticals(const gchar *domain, GLogLevelFlags level, const gchar *text, gpointer)
{
    if (!(level & G_LOG_LEVEL_CRITICAL)) /* queue warns when it is flushed at an unlucky moment */
        return;
    std::printf("%s: %s\n", domain, text);
    criticals++;
}

/* A sink that is slower than the sources, so that the mux is held up. */
void take_time(GstElement *, GstBuffer *, GstPad *, gpointer)
{
    std::this_thread::sleep_for(std::chrono::milliseconds(15));
}

/* What happens to the frames of one source. */
struct Disturbance {
    bool label = false; /* for the one pad of all planes */
    std::atomic<bool> end = false;
};

/* Some frames are lost, some become gaps. */
GstPadProbeReturn disturb(GstPad *pad, GstPadProbeInfo *info, gpointer user_data)
{
    auto &disturbance = *static_cast<Disturbance *>(user_data);
    GstBuffer *frame = GST_PAD_PROBE_INFO_BUFFER(info);
    const guint64 number = GST_BUFFER_OFFSET(frame);
    if (disturbance.end.exchange(false))
        gst_pad_push_event(pad, gst_event_new_eos());
    if (number % 17 == 5)
        return GST_PAD_PROBE_DROP;
    if (number % 13 == 7) {
        gst_pad_push_event(pad, gst_event_new_gap(GST_BUFFER_PTS(frame), GST_BUFFER_DURATION(frame)));
        return GST_PAD_PROBE_DROP;
    }
    if (disturbance.label) {
        GstFocusInfo focus;
        gst_focus_info_init(&focus);
        focus.sweep = number / planes;
        focus.plane = static_cast<unsigned>(number % planes);
        focus.planes = planes;
        frame = gst_buffer_make_writable(frame);
        gst_buffer_add_focus_meta(frame, &focus);
        GST_PAD_PROBE_INFO_DATA(info) = frame;
    }
    return GST_PAD_PROBE_OK;
}

class Walk {
public:
    explicit Walk(unsigned seed) : random_(seed), one_pad_(pick(3) == 0), sources_(one_pad_ ? 1 : planes)
    {
        static const char *on_missing[] = {"drop", "hold", "repeat"};
        std::string description =
            "focalstackmux name=m planes=3 on-missing=" + std::string(on_missing[pick(3)]);
        if (pick(3) == 0)
            description += " window=rolling";
        description +=
            " ! fakesink name=out signal-handoffs=true sync=" + std::string(pick(2) ? "true" : "false") + " ";
        for (unsigned i = 0; i < sources_; i++) {
            const std::string n = std::to_string(i);
            description += "videotestsrc name=s" + n + (pick(5) ? "" : " is-live=true") +
                           " ! capsfilter name=c" + n + " caps=" + caps(64) + " ! queue name=q" + n +
                           " max-size-buffers=2 ! m.sink" + (one_pad_ ? "" : "_" + n) + " ";
        }
        pipeline_ = gst_parse_launch(description.c_str(), nullptr);
        for (unsigned i = 0; i < sources_; i++) {
            g_autoptr(GstPad) pad = gst_element_get_static_pad(element("q", i), "src");
            disturbances_[i].label = one_pad_;
            gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, disturb, &disturbances_[i], nullptr);
        }
        GstElement *sink = gst_bin_get_by_name(GST_BIN(pipeline_), "out");
        g_signal_connect(sink, "handoff", G_CALLBACK(take_time), nullptr);
        gst_object_unref(sink);
        note(description);
    }

    Walk(const Walk &) = delete;
    Walk &operator=(const Walk &) = delete;
    ~Walk() { gst_object_unref(pipeline_); }

    void run()
    {
        set_state(GST_STATE_PLAYING);
        for (unsigned k = 0; k < steps; k++)
            step();
        set_state(GST_STATE_NULL);
    }

    const std::string &log() const { return log_; }

private:
    static std::string caps(unsigned width)
    {
        return "video/x-raw,format=GRAY8,width=" + std::to_string(width) + ",height=64,framerate=120/1";
    }

    unsigned pick(unsigned count) { return static_cast<unsigned>(random_() % count); }

    GstElement *element(const std::string &name, unsigned i) const
    {
        GstElement *found = gst_bin_get_by_name(GST_BIN(pipeline_), (name + std::to_string(i)).c_str());
        gst_object_unref(found); /* the bin holds it */
        return found;
    }

    GstElement *mux() const
    {
        GstElement *found = gst_bin_get_by_name(GST_BIN(pipeline_), "m");
        gst_object_unref(found);
        return found;
    }

    void note(const std::string &what) { log_ += what + "\n"; }

    void set_state(GstState state)
    {
        note(gst_element_state_get_name(state));
        gst_element_set_state(pipeline_, state);
    }

    void wait()
    {
        note("wait");
        std::this_thread::sleep_for(std::chrono::milliseconds(60));
    }

    GstEvent *new_seek()
    {
        return gst_event_new_seek(1.0, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, GST_SEEK_TYPE_SET,
                                  pick(4) * GST_SECOND, GST_SEEK_TYPE_NONE, -1);
    }

    /* A flush that comes while a pad's thread and its idle probe have met leaves that thread waiting on the
     * pad for ever (GStreamer 1.22, 1 in some thousand walks). */
    bool may_flush() const
    {
        return std::ranges::none_of(replugs_, [](const std::atomic<bool> &waits) { return waits.load(); });
    }

    void seek_all()
    {
        if (!may_flush())
            return;
        note("seek all");
        gst_element_send_event(pipeline_, new_seek());
    }

    /* By its pad: gst_element_send_event() holds the state lock of the source while the flush makes the
     * pipeline ask for its own, which a state change in another thread holds while it waits for the
     * source's. */
    void seek(unsigned i)
    {
        if (!may_flush())
            return;
        note("seek " + std::to_string(i));
        g_autoptr(GstPad) pad = gst_element_get_static_pad(element("s", i), "src");
        gst_pad_send_event(pad, new_seek());
    }

    void change_caps(unsigned i, unsigned width)
    {
        note("width of " + std::to_string(i) + ": " + std::to_string(width));
        g_autoptr(GstCaps) wanted = gst_caps_from_string(caps(width).c_str());
        g_object_set(element("c", i), "caps", wanted, nullptr);
    }

    /* What becomes of a link, decided before it is idle. */
    struct Replug {
        GstElement *mux;
        std::string sink;
        bool release;
        bool again;
        std::atomic<bool> &waits;
    };

    static GstPadProbeReturn replug_idle(GstPad *source, GstPadProbeInfo *, gpointer user_data)
    {
        const Replug &replug = *static_cast<Replug *>(user_data);
        g_autoptr(GstPad) sink = gst_pad_get_peer(source);
        if (sink) {
            gst_pad_unlink(source, sink);
            if (replug.release)
                gst_element_release_request_pad(replug.mux, sink);
        }
        if (sink && !replug.again)
            return GST_PAD_PROBE_REMOVE;
        g_autoptr(GstPad) next = gst_element_get_static_pad(replug.mux, replug.sink.c_str());
        if (!next)
            next = gst_element_request_pad_simple(replug.mux, replug.sink.c_str());
        gst_pad_link(source, next);
        return GST_PAD_PROBE_REMOVE;
    }

    /* Unlinked, perhaps released, linked again, as soon as nothing is under way. One at a time: two threads
     * must not ask for the same pad. */
    void replug(unsigned i)
    {
        if (replugs_[i].exchange(true))
            return;
        auto *replug = new Replug{mux(), one_pad_ ? "sink" : "sink_" + std::to_string(i),
                                  !one_pad_ && pick(2), pick(4) != 0, replugs_[i]};
        note(std::string(replug->release ? "release " : "unlink ") + replug->sink +
             (replug->again ? " and link" : ""));
        const auto done = [](gpointer data) {
            static_cast<Replug *>(data)->waits = false;
            delete static_cast<Replug *>(data);
        };
        g_autoptr(GstPad) source = gst_element_get_static_pad(element("q", i), "src");
        gst_pad_add_probe(source, GST_PAD_PROBE_TYPE_IDLE, replug_idle, replug, done);
    }

    /* After an error nothing moves: the pipeline is stopped and started as applications do. */
    void recover()
    {
        g_autoptr(GstBus) bus = gst_element_get_bus(pipeline_);
        const Owned<GstMessage> error(gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR));
        if (!error || pick(2))
            return;
        set_state(GST_STATE_READY);
        gst_bus_set_flushing(bus, TRUE);
        gst_bus_set_flushing(bus, FALSE);
        for (unsigned i = 0; i < sources_; i++)
            change_caps(i, 64);
        set_state(GST_STATE_PLAYING);
    }

    void step()
    {
        recover();
        const unsigned i = pick(sources_);
        switch (pick(12)) {
        case 0:
            return seek(i);
        case 1:
            return seek_all();
        case 2:
            note("end of " + std::to_string(i));
            disturbances_[i].end = true;
            return;
        case 3:
            return change_caps(i, pick(2) ? 64 : 96);
        case 4: {
            const unsigned width = pick(2) ? 64 : 96;
            for (unsigned k = 0; k < sources_; k++)
                change_caps(k, width);
            return;
        }
        case 5:
        case 6:
            return replug(i);
        case 7:
            return set_state(GST_STATE_PAUSED);
        case 8:
            return set_state(GST_STATE_PLAYING);
        case 9:
            if (pick(3) == 0)
                set_state(GST_STATE_READY);
            return set_state(GST_STATE_PLAYING);
        default:
            return wait();
        }
    }

    std::mt19937 random_;
    bool one_pad_;
    unsigned sources_;
    std::array<Disturbance, planes> disturbances_;
    std::array<std::atomic<bool>, planes> replugs_ = {}; /* of each source, whether one waits */
    GstElement *pipeline_ = nullptr;
    std::string log_;
};

unsigned number_of(const char *variable, unsigned otherwise)
{
    const char *text = std::getenv(variable);
    return text ? static_cast<unsigned>(std::atoi(text)) : otherwise;
}

} // namespace

TEST(MuxWalk, nothing_hangs_or_is_critical)
{
    const unsigned walks = number_of("DFF_WALKS", 30);
    const unsigned first = number_of("DFF_SEED", 1);
    g_log_set_default_handler(count_criticals, nullptr);
    for (unsigned seed = first; seed < first + walks; seed++) {
        Walk walk(seed);
        auto done = std::async(std::launch::async, [&] { walk.run(); });
        if (done.wait_for(std::chrono::seconds(60)) != std::future_status::ready) {
            std::printf("seed %u hangs after\n%s", seed, walk.log().c_str());
            std::fflush(stdout);
            std::abort();
        }
        ASSERT_EQ(criticals, 0u) << "seed " << seed << "\n" << walk.log();
    }
}
