/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors
 *
 * Which pictures, depth maps and stacks the file encoders put together. */
#include "encoded_file.h"

#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <thread>
#include <utility>

using namespace dff;

namespace {

constexpr unsigned side = 16;
constexpr GstClockTime period = 100 * GST_MSECOND;
const std::string size = ",width=16,height=16,framerate=10/1";
constexpr gsize colour_bytes = 3 * side * side;
constexpr gsize depth_bytes = 2 * side * side;
constexpr gsize stack_bytes = 3 * colour_bytes;

struct ElementUnref {
    void operator()(gpointer object) const { gst_object_unref(object); }
};
using Element = std::unique_ptr<GstElement, ElementUnref>;
using Pad = std::unique_ptr<GstPad, ElementUnref>;

/* An input that a thread of its own feeds, in a stream that begins at `offset` of its own time. */
class Input {
public:
    Input(GstElement *element, const char *name, GstClockTime offset)
        : name_(name), offset_(offset), source_(gst_pad_new(name, GST_PAD_SRC)),
          sink_(gst_element_get_static_pad(element, name))
    {
        if (!sink_)
            sink_.reset(gst_element_request_pad_simple(element, name));
        gst_pad_set_active(source_.get(), TRUE);
        EXPECT_EQ(gst_pad_link(source_.get(), sink_.get()), GST_PAD_LINK_OK);
    }

    /* Frames that begin at these multiples of the period, and the end of the stream. */
    void feed(std::vector<unsigned> frames)
    {
        thread_ = std::jthread([this, frames = std::move(frames)] {
            begin();
            for (const unsigned k : frames)
                push(k);
            end();
        });
    }

    void begin()
    {
        const std::string caps_text = name_ == "color"   ? "video/x-raw,format=RGB"
                                      : name_ == "stack" ? "video/x-focal-stack,format=RGB,planes=3"
                                                         : "video/x-raw,format=GRAY16_LE";
        g_autoptr(GstCaps) caps = gst_caps_from_string((caps_text + size).c_str());
        GstSegment segment;
        gst_segment_init(&segment, GST_FORMAT_TIME);
        segment.start = segment.time = offset_;
        gst_pad_push_event(source_.get(), gst_event_new_stream_start(name_.c_str()));
        gst_pad_push_event(source_.get(), gst_event_new_caps(caps));
        gst_pad_push_event(source_.get(), gst_event_new_segment(&segment));
    }

    void push_gap_before_segment()
    {
        gst_pad_push_event(source_.get(), gst_event_new_stream_start(name_.c_str()));
        gst_pad_push_event(source_.get(), gst_event_new_gap(0, period));
    }

    void push(unsigned k)
    {
        const gsize bytes = name_ == "color" ? colour_bytes : name_ == "stack" ? stack_bytes : depth_bytes;
        GstBuffer *buffer = gst_buffer_new_allocate(nullptr, bytes, nullptr);
        gst_buffer_memset(buffer, 0, 7, bytes);
        GST_BUFFER_PTS(buffer) = offset_ + k * period;
        GST_BUFFER_DURATION(buffer) = period;
        if (name_ == "depth") {
            GstDepthInfo depth = dioptres_from_5_to_1();
            depth.has_intrinsics = TRUE;
            depth.fx = depth.fy = 20.0;
            gst_buffer_add_depth_meta(buffer, &depth);
        }
        gst_pad_push(source_.get(), buffer);
    }

    void end() { gst_pad_push_event(source_.get(), gst_event_new_eos()); }
    void release(GstElement *element) { gst_element_release_request_pad(element, sink_.get()); }

private:
    std::string name_;
    GstClockTime offset_;
    Pad source_, sink_;
    std::jthread thread_;
};

/* An encoder that plays, and the files that it wrote. */
class Encoder {
public:
    explicit Encoder(const std::string &description, const std::string &behind = "")
    {
        const std::string graph = description + " name=e ! " + behind + "appsink name=out sync=false";
        pipeline_.reset(gst_parse_launch(graph.c_str(), nullptr));
        encoder_.reset(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "e"));
        sink_.reset(gst_bin_get_by_name(GST_BIN(pipeline_.get()), "out"));
    }
    ~Encoder() { gst_element_set_state(pipeline_.get(), GST_STATE_NULL); }

    GstElement *element() const { return encoder_.get(); }
    void play() { gst_element_set_state(pipeline_.get(), GST_STATE_PLAYING); }

    /* Sizes in bytes of the files up to the end of the stream. */
    std::vector<gsize> sizes()
    {
        std::vector<gsize> sizes;
        for (;;) {
            g_autoptr(GstSample) sample = nullptr;
            g_signal_emit_by_name(sink_.get(), "try-pull-sample", 20 * GST_SECOND, &sample);
            if (!sample)
                break;
            sizes.push_back(gst_buffer_get_size(gst_sample_get_buffer(sample)));
        }
        return sizes;
    }

    std::string error(GstClockTime patience = 0) const
    {
        g_autoptr(GstBus) bus = gst_element_get_bus(pipeline_.get());
        g_autoptr(GstMessage) message = gst_bus_timed_pop_filtered(bus, patience, GST_MESSAGE_ERROR);
        g_autoptr(GError) error = nullptr;
        if (message)
            gst_message_parse_error(message, &error, nullptr);
        return error ? error->message : "";
    }

private:
    Element pipeline_, encoder_, sink_;
};

std::vector<std::string> encoders()
{
    std::vector<std::string> found;
    for (const char *name : {"depthexrenc", "depthplyenc"})
        if (g_autoptr(GstElementFactory) factory = gst_element_factory_find(name))
            found.emplace_back(name);
    return found;
}

bool has_exr()
{
    return encoders().front() == "depthexrenc";
}

std::vector<unsigned> up_to(unsigned count)
{
    std::vector<unsigned> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0U);
    return numbers;
}

/* How many files come of pictures and depth maps of these numbers, whose streams begin at these times. */
size_t files_of(const std::string &kind, GstClockTime colour_offset, std::vector<unsigned> colours,
                GstClockTime depth_offset, std::vector<unsigned> depths)
{
    Encoder encoder(kind);
    Input colour(encoder.element(), "color", colour_offset);
    Input depth(encoder.element(), "depth", depth_offset);
    encoder.play();
    colour.feed(std::move(colours));
    depth.feed(std::move(depths));
    const size_t files = encoder.sizes().size();
    EXPECT_EQ(encoder.error(), "");
    return files;
}

} // namespace

TEST(FileInputs, colour_and_depth_meet_by_running_time)
{
    for (const std::string &kind : encoders())
        for (const GstClockTime colour : {0 * GST_SECOND, 10 * GST_SECOND})
            for (const GstClockTime depth : {0 * GST_SECOND, 10 * GST_SECOND, 3600 * GST_SECOND})
                EXPECT_EQ(files_of(kind, colour, up_to(4), depth, up_to(4)), 4U)
                    << kind << ", streams from " << colour / GST_SECOND << " s and " << depth / GST_SECOND
                    << " s";
}

TEST(FileInputs, what_has_no_partner_is_left_out)
{
    for (const std::string &kind : encoders())
        for (const GstClockTime colour : {0 * GST_SECOND, 5 * GST_SECOND})
            EXPECT_EQ(files_of(kind, colour, {0, 2, 3}, 0, {0, 1, 3}), 2U) << kind;
}

/* As a source sends whose first caps were refused. */
TEST(FileInputs, a_gap_before_the_segment_is_no_fault)
{
    for (const std::string &kind : encoders()) {
        const GLogLevelFlags fatal =
            g_log_set_always_fatal(static_cast<GLogLevelFlags>(G_LOG_FATAL_MASK | G_LOG_LEVEL_CRITICAL));
        Encoder encoder(kind);
        Input colour(encoder.element(), "color", 0);
        Input depth(encoder.element(), "depth", 0);
        encoder.play();
        colour.push_gap_before_segment();
        depth.push_gap_before_segment();
        colour.feed(up_to(4));
        depth.feed(up_to(4));
        EXPECT_EQ(encoder.sizes().size(), 4U) << kind;
        EXPECT_EQ(encoder.error(), "") << kind;
        g_log_set_always_fatal(fatal);
    }
}

/* A single picture has none after it by which the threads of the inputs would learn of it. */
TEST(FileInputs, caps_that_nothing_behind_takes_are_an_error)
{
    for (const std::string &kind : encoders()) {
        const std::string media = kind == "depthexrenc" ? "image/x-exr" : "application/x-ply";
        Encoder encoder(kind, media + ",width=1 ! ");
        Input colour(encoder.element(), "color", 0);
        Input depth(encoder.element(), "depth", 0);
        encoder.play();
        colour.feed({0});
        depth.feed({0});
        EXPECT_NE(encoder.error(20 * GST_SECOND).find("16x16"), std::string::npos) << kind;
    }
}

namespace {

/* An encoder and a pad that it may have or not. */
struct Further {
    std::string encoder;
    const char *pad;
};

std::vector<Further> further_inputs()
{
    std::vector<Further> inputs;
    for (const std::string &encoder : encoders())
        inputs.push_back({encoder, "uncertainty"});
    if (has_exr())
        inputs.push_back({"depthexrenc compression=none", "stack"});
    return inputs;
}

gsize size_without_further_input(const std::string &kind)
{
    Encoder encoder(kind);
    Input colour(encoder.element(), "color", 0);
    Input depth(encoder.element(), "depth", 0);
    encoder.play();
    colour.feed({0});
    depth.feed({0});
    return encoder.sizes().at(0);
}

} // namespace

TEST(FileInputs, what_begins_late_or_ends_early_is_missing_in_the_other_files_alone)
{
    for (const Further &further : further_inputs())
        for (const std::vector<unsigned> &frames : std::vector<std::vector<unsigned>>{
                 {}, {0, 1, 2, 3, 4, 5}, {2, 3, 4, 5}, {0, 1, 2}, {1, 4}, {2, 9}}) {
            const gsize without = size_without_further_input(further.encoder);
            Encoder encoder(further.encoder);
            Input colour(encoder.element(), "color", 0);
            Input depth(encoder.element(), "depth", 0);
            Input input(encoder.element(), further.pad, 7 * GST_SECOND);
            encoder.play();
            colour.feed(up_to(6));
            depth.feed(up_to(6));
            input.feed(frames);
            std::vector<bool> with_it;
            for (const gsize bytes : encoder.sizes())
                with_it.push_back(bytes > without);
            std::vector<bool> expected(6);
            for (const unsigned k : frames)
                if (k < expected.size())
                    expected[k] = true;
            EXPECT_EQ(encoder.error(), "");
            EXPECT_EQ(with_it, expected)
                << further.encoder << ' ' << further.pad << ' ' << testing::PrintToString(frames);
        }
}

TEST(FileInputs, what_is_requested_may_come_and_go_while_the_others_stream)
{
    constexpr unsigned count = 400;
    for (const Further &further : further_inputs()) {
        Encoder encoder(further.encoder);
        Input colour(encoder.element(), "color", 0);
        Input depth(encoder.element(), "depth", 0);
        encoder.play();
        colour.feed(up_to(count));
        depth.feed(up_to(count));
        std::mt19937 random(1);
        for (unsigned k = 0; k < 100; k++) {
            Input input(encoder.element(), further.pad, 0);
            const unsigned steps = random() % 4;
            if (steps > 0)
                input.begin();
            if (steps > 1)
                input.push(static_cast<unsigned>(random() % count));
            if (steps > 2)
                input.end();
            g_usleep(random() % 1000);
            input.release(encoder.element());
        }
        EXPECT_EQ(encoder.sizes().size(), count) << further.encoder << ' ' << further.pad;
        EXPECT_EQ(encoder.error(), "");
    }
}
