/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "support.h"

#include <atomic>
#include <chrono>
#include <future>
#include <glib/gstdio.h>
#include <gst/app/gstappsink.h>
#include <gtest/gtest.h>
#include <optional>
#include <thread>
#include <unistd.h>

/* Sources of one plane each, of which one does what the others do not. */

namespace {

const std::string picture = "video/x-raw,format=GRAY8,width=64,height=64,framerate=30/1";

/* Two sources "a" and "b" with queues "qa" and "qb" on the pads sink_0 and sink_1 of a mux "m". */
class TwoPlanes {
public:
    explicit TwoPlanes(const std::string &a = "", const std::string &b = "", const std::string &mux = "",
                       const std::string &sink = "appsink name=out sync=false max-buffers=4")
    {
        const auto source = [](const std::string &name, const std::string &settings) {
            return "videotestsrc name=" + name + " " + settings + " ! capsfilter name=c" + name +
                   " caps=" + picture + " ! queue max-size-buffers=2 name=q" + name + " ! m.";
        };
        pipeline_ = gst_parse_launch(("focalstackmux name=m " + mux + " ! " + sink + " " + source("a", a) +
                                      "sink_0 " + source("b", b) + "sink_1")
                                         .c_str(),
                                     nullptr);
        bus_ = gst_element_get_bus(pipeline_);
    }

    TwoPlanes(const TwoPlanes &) = delete;
    TwoPlanes &operator=(const TwoPlanes &) = delete;

    ~TwoPlanes()
    {
        gst_element_set_state(pipeline_, GST_STATE_NULL);
        gst_object_unref(bus_);
        gst_object_unref(pipeline_);
    }

    GstElement *get() const { return pipeline_; }

    GstElement *element(const std::string &name) const
    {
        GstElement *found = gst_bin_get_by_name(GST_BIN(pipeline_), name.c_str());
        gst_object_unref(found); /* the bin holds it */
        return found;
    }

    void set_state(GstState state)
    {
        gst_element_set_state(pipeline_, state);
        gst_element_get_state(pipeline_, nullptr, nullptr, 10 * GST_SECOND);
    }

    /* The time of the next stack, or nothing at the end or after ten seconds. */
    std::optional<GstClockTime> pull() const
    {
        g_autoptr(GstSample) sample =
            gst_app_sink_try_pull_sample(GST_APP_SINK(element("out")), 10 * GST_SECOND);
        return sample ? std::optional(GST_BUFFER_PTS(gst_sample_get_buffer(sample))) : std::nullopt;
    }

    unsigned pull_all() const
    {
        unsigned stacks = 0;
        while (pull())
            stacks++;
        return stacks;
    }

    bool seek(const char *source, GstClockTime time = 0, GstClockTime stop = GST_CLOCK_TIME_NONE) const
    {
        return gst_element_send_event(
            element(source),
            gst_event_new_seek(1.0, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, GST_SEEK_TYPE_SET,
                               static_cast<gint64>(time),
                               GST_CLOCK_TIME_IS_VALID(stop) ? GST_SEEK_TYPE_SET : GST_SEEK_TYPE_NONE,
                               static_cast<gint64>(stop)));
    }

    /* "end", an error's text, or "nothing". */
    std::string outcome(GstClockTime patience = 10 * GST_SECOND) const
    {
        const Owned<GstMessage> message(gst_bus_timed_pop_filtered(
            bus_, patience, static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS)));
        if (!message)
            return "nothing";
        if (GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_EOS)
            return "end";
        g_autoptr(GError) error = nullptr;
        gst_message_parse_error(message.get(), &error, nullptr);
        return error->message;
    }

    /* As an application takes a source away: its queue is held, then unlinked. */
    void take_away(const char *queue, const char *pad, bool release)
    {
        g_autoptr(GstPad) source = gst_element_get_static_pad(element(queue), "src");
        g_autoptr(GstPad) sink = gst_element_get_static_pad(element("m"), pad);
        gst_pad_add_probe(
            source, GST_PAD_PROBE_TYPE_BLOCK_DOWNSTREAM,
            [](GstPad *, GstPadProbeInfo *, gpointer) { return GST_PAD_PROBE_OK; }, nullptr, nullptr);
        gst_pad_unlink(source, sink);
        if (release)
            gst_element_release_request_pad(element("m"), sink);
    }

private:
    GstElement *pipeline_;
    GstBus *bus_;
};

} // namespace

TEST(MuxPlanes, a_flush_of_one_source_leaves_the_other_running)
{
    TwoPlanes planes("num-buffers=200", "num-buffers=200");
    planes.set_state(GST_STATE_PLAYING);
    for (unsigned k = 0; k < 30; k++)
        ASSERT_TRUE(planes.pull()) << k;
    ASSERT_TRUE(planes.seek("a"));
    const unsigned after = planes.pull_all();
    EXPECT_GT(after, 100u);
    EXPECT_EQ(planes.outcome(), "end");
}

TEST(MuxPlanes, a_flush_of_one_source_while_all_wait_does_not_hang)
{
    for (const char *source : {"a", "b", "a"}) {
        SCOPED_TRACE(source);
        TwoPlanes planes("num-buffers=100", "num-buffers=100", "", "fakesink name=out sync=false");
        planes.set_state(GST_STATE_PAUSED);
        ASSERT_TRUE(planes.seek(source, 200 * GST_MSECOND));
        ASSERT_TRUE(planes.seek(source));
        planes.set_state(GST_STATE_PLAYING);
        EXPECT_EQ(planes.outcome(), "end");
        EXPECT_GT(count_of(planes.element("m"), "stacks"), 50u);
    }
}

TEST(MuxPlanes, a_source_that_begins_again_after_the_end_is_heard)
{
    constexpr gint64 five_frames = 5 * GST_SECOND / 30;
    TwoPlanes planes("", "", "on-missing=repeat");
    planes.set_state(GST_STATE_PAUSED);
    ASSERT_TRUE(gst_element_seek(planes.get(), 1.0, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, GST_SEEK_TYPE_SET,
                                 0, GST_SEEK_TYPE_SET, five_frames));
    planes.set_state(GST_STATE_PLAYING);
    EXPECT_EQ(planes.pull_all(), 5u);
    EXPECT_EQ(planes.outcome(), "end");
    ASSERT_TRUE(planes.seek("a", 0, five_frames));
    EXPECT_EQ(planes.pull_all(), 5u);
    EXPECT_EQ(planes.outcome(), "end");
}

namespace {

/* A mux without sources, whose end is held up as by a paused sink. */
class HeldEnd {
public:
    HeldEnd() : mux_(gst_element_factory_make("focalstackmux", nullptr))
    {
        g_object_set(mux_, "planes", 2, nullptr);
        for (unsigned i = 0; i < 2; i++) {
            const std::string name = "sink_" + std::to_string(i);
            g_autoptr(GstPad) sink = gst_element_request_pad_simple(mux_, name.c_str());
            sources_[i] = gst_pad_new(nullptr, GST_PAD_SRC);
            gst_pad_set_active(sources_[i], TRUE);
            gst_pad_link(sources_[i], sink);
        }
        g_autoptr(GstPad) source = gst_element_get_static_pad(mux_, "src");
        probe_ = gst_pad_add_probe(
            source,
            static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BLOCK | GST_PAD_PROBE_TYPE_EVENT_DOWNSTREAM),
            &HeldEnd::hold, this, nullptr);
        gst_element_set_state(mux_, GST_STATE_PLAYING);
    }
    ~HeldEnd()
    {
        g_autoptr(GstPad) source = gst_element_get_static_pad(mux_, "src");
        gst_pad_remove_probe(source, probe_);
        gst_element_set_state(mux_, GST_STATE_NULL);
        for (GstPad *pad : sources_)
            gst_object_unref(pad);
        gst_object_unref(mux_);
    }
    HeldEnd(const HeldEnd &) = delete;
    HeldEnd &operator=(const HeldEnd &) = delete;

    void begin(unsigned i)
    {
        GstSegment segment;
        gst_segment_init(&segment, GST_FORMAT_TIME);
        g_autoptr(GstCaps) caps = gst_caps_from_string(picture.c_str());
        push(i, gst_event_new_stream_start(i == 0 ? "a" : "b"));
        push(i, gst_event_new_caps(caps));
        push(i, gst_event_new_segment(&segment));
    }
    void push(unsigned i, GstEvent *event) { gst_pad_push_event(sources_[i], event); }

    void wait_until_held()
    {
        while (!held_)
            std::this_thread::yield();
    }

private:
    static GstPadProbeReturn hold(GstPad *, GstPadProbeInfo *info, gpointer self)
    {
        if (GST_EVENT_TYPE(GST_PAD_PROBE_INFO_EVENT(info)) != GST_EVENT_EOS)
            return GST_PAD_PROBE_PASS;
        static_cast<HeldEnd *>(self)->held_ = true;
        return GST_PAD_PROBE_OK;
    }

    GstElement *mux_;
    GstPad *sources_[2] = {};
    gulong probe_ = 0;
    std::atomic<bool> held_ = false;
};

} // namespace

/* Otherwise the thread that brought the end could not be had back. */
TEST(MuxPlanes, a_flush_of_the_source_whose_end_is_held_up_downstream_frees_it)
{
    std::future<void> end, again;
    HeldEnd mux;
    mux.begin(0);
    mux.begin(1);
    mux.push(1, gst_event_new_eos());
    end = std::async(std::launch::async, [&] { mux.push(0, gst_event_new_eos()); });
    mux.wait_until_held();
    again = std::async(std::launch::async, [&] { mux.push(1, gst_event_new_stream_start("b again")); });
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    mux.push(0, gst_event_new_flush_start());
    EXPECT_EQ(end.wait_for(std::chrono::seconds(5)), std::future_status::ready);
}

TEST(MuxPlanes, the_end_comes_when_the_last_open_source_is_taken_away)
{
    for (const bool release : {false, true}) {
        SCOPED_TRACE(release);
        TwoPlanes planes("num-buffers=3", "is-live=true", "on-missing=repeat", "fakesink sync=false");
        planes.set_state(GST_STATE_PLAYING);
        EXPECT_EQ(planes.outcome(200 * GST_MSECOND), "nothing");
        planes.take_away("qb", "sink_1", release);
        EXPECT_EQ(planes.outcome(), "end");
        EXPECT_EQ(planes.outcome(100 * GST_MSECOND), "nothing") << "once";
    }
}

TEST(MuxPlanes, the_end_comes_when_the_others_end_after_one_was_taken_away)
{
    TwoPlanes planes("num-buffers=20", "", "planes=2 on-missing=repeat", "fakesink sync=false");
    planes.set_state(GST_STATE_PAUSED);
    planes.take_away("qb", "sink_1", false);
    planes.set_state(GST_STATE_PLAYING);
    EXPECT_EQ(planes.outcome(), "end");
}

TEST(MuxPlanes, one_that_is_linked_again_is_waited_for)
{
    TwoPlanes planes("num-buffers=100", "num-buffers=100", "planes=2",
                     "appsink name=out sync=false max-buffers=2");
    planes.set_state(GST_STATE_PLAYING);
    ASSERT_TRUE(planes.pull());
    GstElement *other = gst_parse_bin_from_description(
        ("videotestsrc num-buffers=100 ! capsfilter caps=" + picture).c_str(), TRUE, nullptr);
    gst_bin_add(GST_BIN(planes.get()), other);
    planes.take_away("qb", "sink_1", false);
    ASSERT_TRUE(gst_element_link_pads(other, "src", planes.element("m"), "sink_1"));
    gst_element_sync_state_with_parent(other);
    EXPECT_GT(planes.pull_all(), 60u);
    EXPECT_EQ(planes.outcome(), "end");
}

TEST(MuxPlanes, new_caps_of_all_sources_cost_no_stack)
{
    TwoPlanes planes("num-buffers=100", "num-buffers=100");
    planes.set_state(GST_STATE_PLAYING);
    for (unsigned k = 0; k < 10; k++)
        ASSERT_TRUE(planes.pull());
    g_autoptr(GstCaps) large =
        gst_caps_from_string("video/x-raw,format=GRAY8,width=96,height=64,framerate=30/1");
    /* Both from the same frame on: each at its own sweep would be an error. */
    const auto change_at = [&](const char *name) {
        g_autoptr(GstPad) pad = gst_element_get_static_pad(planes.element(name), "src");
        gst_pad_add_probe(
            pad, GST_PAD_PROBE_TYPE_BUFFER,
            [](GstPad *probed, GstPadProbeInfo *info, gpointer caps) {
                GstBuffer *frame = GST_PAD_PROBE_INFO_BUFFER(info);
                if (GST_BUFFER_OFFSET(frame) < 50)
                    return GST_PAD_PROBE_OK;
                if (GST_BUFFER_OFFSET(frame) == 50)
                    gst_pad_push_event(probed, gst_event_new_caps(GST_CAPS(caps)));
                GstBuffer *large = gst_buffer_new_allocate(nullptr, 96 * 64, nullptr);
                GST_BUFFER_PTS(large) = GST_BUFFER_PTS(frame);
                GST_BUFFER_DURATION(large) = GST_BUFFER_DURATION(frame);
                GST_PAD_PROBE_INFO_DATA(info) = large;
                gst_buffer_unref(frame);
                return GST_PAD_PROBE_OK;
            },
            gst_caps_ref(large), [](gpointer caps) { gst_caps_unref(GST_CAPS(caps)); });
    };
    change_at("qa");
    change_at("qb");
    EXPECT_EQ(planes.pull_all(), 90u);
    EXPECT_EQ(count_of(planes.element("m"), "lost"), 0u);
}

TEST(MuxPlanes, streams_that_count_in_bytes_pass_without_a_critical)
{
    g_autofree gchar *path = nullptr;
    const int file = g_file_open_tmp("dff-mux-XXXXXX", &path, nullptr);
    ASSERT_GE(file, 0);
    close(file);
    const std::string pixels(12 * 64 * 64, 'x');
    ASSERT_TRUE(g_file_set_contents(path, pixels.data(), static_cast<gssize>(pixels.size()), nullptr));
    const std::string source =
        "filesrc blocksize=4096 location=" + std::string(path) + " ! " + picture + " ! ";
    const Complaints complaints;
    GstElement *pipeline = gst_parse_launch(
        (source + "m.sink_0 " + source + "m.sink_1 focalstackmux name=m ! fakesink").c_str(), nullptr);
    gst_element_set_state(pipeline, GST_STATE_PLAYING);
    GstBus *bus = gst_element_get_bus(pipeline);
    const Owned<GstMessage> end(gst_bus_timed_pop_filtered(bus, 10 * GST_SECOND, GST_MESSAGE_EOS));
    EXPECT_TRUE(end);
    GstElement *mux = gst_bin_get_by_name(GST_BIN(pipeline), "m");
    EXPECT_EQ(count_of(mux, "stacks"), 12u);
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(mux);
    gst_object_unref(bus);
    gst_object_unref(pipeline);
    g_remove(path);
}
