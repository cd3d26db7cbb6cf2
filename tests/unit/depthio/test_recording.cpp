/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depth_frame.h"

#include <cstring>
#include <gtest/gtest.h>
#include <unistd.h>

using namespace dff;

namespace {

struct SampleDeleter {
    void operator()(GstSample *sample) const { gst_sample_unref(sample); }
};
using Sample = std::unique_ptr<GstSample, SampleDeleter>;

/* Everything that leaves the appsinks `names` of a pipeline, until its end. */
std::vector<std::vector<Sample>> play(const std::string &description, const std::vector<const char *> &names)
{
    g_autoptr(GError) error = nullptr;
    g_autoptr(GstElement) pipeline = gst_parse_launch(description.c_str(), &error);
    EXPECT_EQ(error, nullptr) << error->message;
    gst_element_set_state(pipeline, GST_STATE_PLAYING);
    std::vector<std::vector<Sample>> samples(names.size());
    for (size_t k = 0; k < names.size(); k++) {
        g_autoptr(GstElement) sink = gst_bin_get_by_name(GST_BIN(pipeline), names[k]);
        GstSample *sample = nullptr;
        for (;;) {
            g_signal_emit_by_name(sink, "try-pull-sample", 60 * GST_SECOND, &sample);
            if (!sample)
                break;
            samples[k].emplace_back(sample);
        }
    }
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline); /* files end a little later */
    g_autoptr(GstMessage) end = gst_bus_timed_pop_filtered(
        bus, 60 * GST_SECOND, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
    EXPECT_TRUE(end && GST_MESSAGE_TYPE(end) == GST_MESSAGE_EOS);
    gst_element_set_state(pipeline, GST_STATE_NULL);
    return samples;
}

std::string file_name(const char *name)
{
    return testing::TempDir() + name + std::to_string(getpid()) + ".gdp";
}

std::vector<guint8> content(GstBuffer *buffer)
{
    std::vector<guint8> bytes(gst_buffer_get_size(buffer));
    gst_buffer_extract(buffer, 0, bytes.data(), bytes.size());
    return bytes;
}

/* Every field of a meta at once; empty without the meta. */
template <typename Meta> std::string fields(Meta *meta, GBytes *(*to_bytes)(const Meta *))
{
    if (!meta)
        return {};
    g_autoptr(GBytes) bytes = to_bytes(meta);
    gsize size = 0;
    const auto *data = static_cast<const char *>(g_bytes_get_data(bytes, &size));
    return {data, size};
}

std::string camera_clock(GstBuffer *buffer)
{
    const GstReferenceTimestampMeta *meta = gst_buffer_get_reference_timestamp_meta(buffer, nullptr);
    if (!meta)
        return {};
    g_autofree gchar *clock = gst_caps_to_string(meta->reference);
    return std::string(clock) + " " + std::to_string(meta->timestamp) + " " + std::to_string(meta->duration);
}

void expect_same(GstSample *one, GstSample *other)
{
    GstBuffer *a = gst_sample_get_buffer(one), *b = gst_sample_get_buffer(other);
    EXPECT_EQ(GST_BUFFER_PTS(a), GST_BUFFER_PTS(b));
    EXPECT_EQ(GST_BUFFER_DURATION(a), GST_BUFFER_DURATION(b));
    EXPECT_TRUE(gst_caps_is_equal(gst_sample_get_caps(one), gst_sample_get_caps(other)));
    EXPECT_EQ(content(a), content(b));
    EXPECT_EQ(fields(gst_buffer_get_focus_meta(a), gst_focus_meta_to_bytes),
              fields(gst_buffer_get_focus_meta(b), gst_focus_meta_to_bytes));
    EXPECT_EQ(fields(gst_buffer_get_focal_stack_meta(a), gst_focal_stack_meta_to_bytes),
              fields(gst_buffer_get_focal_stack_meta(b), gst_focal_stack_meta_to_bytes));
    EXPECT_EQ(fields(gst_buffer_get_depth_meta(a), gst_depth_meta_to_bytes),
              fields(gst_buffer_get_depth_meta(b), gst_depth_meta_to_bytes));
    EXPECT_EQ(camera_clock(a), camera_clock(b));
}

void expect_same(const std::vector<Sample> &live, const std::vector<Sample> &replayed, size_t count)
{
    ASSERT_EQ(live.size(), count);
    ASSERT_EQ(replayed.size(), count);
    for (size_t k = 0; k < count; k++)
        expect_same(live[k].get(), replayed[k].get());
}

const std::string camera = "lenssweeptestsrc num-buffers=18 planes=6 near=4 far=0.5 motion=1 noise=strong ! "
                           "video/x-raw,format=I420,width=160,height=120";

} // namespace

TEST(Recording, replayed_stacks_give_the_same_depth_to_the_bit)
{
    const std::string file = file_name("stacks");
    const auto live = play(camera +
                               " ! focalstackmux ! tee name=s "
                               "s. ! queue ! dffmetapay ! gdppay ! filesink location=" +
                               file +
                               " s. ! queue ! appsink name=stack sync=false "
                               "s. ! queue ! dffdepth ! appsink name=depth sync=false",
                           {"stack", "depth"});
    const auto replayed = play("filesrc location=" + file +
                                   " ! gdpdepay ! dffmetadepay ! tee name=s "
                                   "s. ! queue ! appsink name=stack sync=false "
                                   "s. ! queue ! dffdepth ! appsink name=depth sync=false",
                               {"stack", "depth"});
    unlink(file.c_str());
    expect_same(live[0], replayed[0], 3);
    expect_same(live[1], replayed[1], 3);
    EXPECT_FALSE(fields(gst_buffer_get_focal_stack_meta(gst_sample_get_buffer(replayed[0][2].get())),
                        gst_focal_stack_meta_to_bytes)
                     .empty());
}

TEST(Recording, planes_compressed_without_loss_give_the_same_depth_to_the_bit)
{
    const std::string file = file_name("planes");
    const auto live = play(camera +
                               " ! tee name=p "
                               "p. ! queue ! dffmetapay ! avenc_ffv1 ! gdppay ! filesink location=" +
                               file +
                               " p. ! queue ! appsink name=plane sync=false "
                               "p. ! queue ! focalstackmux ! dffdepth ! appsink name=depth sync=false",
                           {"plane", "depth"});
    const auto replayed = play("filesrc location=" + file +
                                   " ! gdpdepay ! avdec_ffv1 ! dffmetadepay ! tee name=p "
                                   "p. ! queue ! appsink name=plane sync=false "
                                   "p. ! queue ! focalstackmux ! dffdepth ! appsink name=depth sync=false",
                               {"plane", "depth"});
    unlink(file.c_str());
    ASSERT_EQ(live[1].size(), 3u);
    ASSERT_EQ(replayed[1].size(), 3u);
    for (size_t k = 0; k < 3; k++)
        EXPECT_EQ(content(gst_sample_get_buffer(live[1][k].get())),
                  content(gst_sample_get_buffer(replayed[1][k].get())));
    ASSERT_EQ(live[0].size(), 18u);
    ASSERT_EQ(replayed[0].size(), 18u);
    for (size_t k = 0; k < 18; k++) {
        const std::string focus = fields(gst_buffer_get_focus_meta(gst_sample_get_buffer(live[0][k].get())),
                                         gst_focus_meta_to_bytes);
        EXPECT_FALSE(focus.empty());
        EXPECT_EQ(focus, fields(gst_buffer_get_focus_meta(gst_sample_get_buffer(replayed[0][k].get())),
                                gst_focus_meta_to_bytes));
    }
}

namespace {

/* A pipeline that is sought while its appsink holds it up: by an event to `target`, or as a whole. */
class SoughtPipeline {
public:
    explicit SoughtPipeline(const std::string &description)
    {
        g_autoptr(GError) error = nullptr;
        pipeline_ =
            gst_parse_launch((description + " ! appsink name=end sync=false max-buffers=1").c_str(), &error);
        EXPECT_EQ(error, nullptr) << error->message;
        end_ = gst_bin_get_by_name(GST_BIN(pipeline_), "end");
        gst_element_set_state(pipeline_, GST_STATE_PLAYING);
    }
    ~SoughtPipeline()
    {
        gst_element_set_state(pipeline_, GST_STATE_NULL);
        gst_object_unref(end_);
        gst_object_unref(pipeline_);
    }
    SoughtPipeline(const SoughtPipeline &) = delete;
    SoughtPipeline &operator=(const SoughtPipeline &) = delete;

    /* So many frames, or fewer at the end. */
    std::vector<std::vector<guint8>> next(size_t count)
    {
        std::vector<std::vector<guint8>> frames;
        while (frames.size() < count) {
            GstSample *taken = nullptr;
            g_signal_emit_by_name(end_, "try-pull-sample", 60 * GST_SECOND, &taken);
            const Sample sample(taken);
            if (!sample)
                break;
            frames.push_back(content(gst_sample_get_buffer(sample.get())));
        }
        return frames;
    }

    bool seek_file_to_start()
    {
        g_autoptr(GstElement) file = gst_bin_get_by_name(GST_BIN(pipeline_), "file");
        return gst_element_send_event(file, gst_event_new_seek(1.0, GST_FORMAT_BYTES, GST_SEEK_FLAG_FLUSH,
                                                               GST_SEEK_TYPE_SET, 0, GST_SEEK_TYPE_NONE, 0));
    }

    bool seek_to_start()
    {
        return gst_element_seek_simple(pipeline_, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, 0);
    }

private:
    GstElement *pipeline_;
    GstElement *end_;
};

/* Eight sweeps in which something moves; a file of them by `written`. */
std::string record_moving(const char *name, const std::string &written)
{
    const std::string file = file_name(name);
    play("lenssweeptestsrc num-buffers=48 planes=6 near=4 far=0.5 motion=2 noise=strong ! "
         "video/x-raw,format=I420,width=160,height=120 ! " +
             written + " ! filesink location=" + file,
         {});
    return file;
}

constexpr size_t moving_sweeps = 8;

/* What comes after a seek, at any time, is what comes first: with no trace of what was seen before. */
void expect_no_ghost(const std::string &chain, bool (SoughtPipeline::*seek)())
{
    const auto first = SoughtPipeline(chain).next(moving_sweeps + 1);
    ASSERT_EQ(first.size(), moving_sweeps);
    SoughtPipeline pipeline(chain);
    for (const size_t seen : {size_t{5}, size_t{1}, moving_sweeps}) {
        EXPECT_EQ(pipeline.next(seen).size(), seen);
        ASSERT_TRUE((pipeline.*seek)());
    }
    const auto again = pipeline.next(moving_sweeps + 1);
    ASSERT_EQ(again.size(), moving_sweeps);
    for (size_t k = 0; k < moving_sweeps; k++)
        EXPECT_EQ(again[k], first[k]) << "sweep " << k;
}

const std::string chains_in_time[] = {
    " ! focalstackdenoise frames=16 local-motion=true",
    " ! focalstackdenoise frames=16 local-motion=true ! dffdepth steady=on"};

} // namespace

TEST(Recording, a_seek_leaves_no_ghost_of_stacks)
{
    const std::string file = record_moving("sought", "focalstackmux ! dffmetapay ! gdppay");
    for (const std::string &chain : chains_in_time)
        expect_no_ghost("filesrc name=file location=" + file + " ! gdpdepay ! dffmetadepay" + chain,
                        &SoughtPipeline::seek_file_to_start);
    unlink(file.c_str());
}

TEST(Recording, a_seek_leaves_no_ghost_of_planes)
{
    const std::string file = record_moving("sought", "avenc_ffv1 ! matroskamux");
    for (const std::string &chain : chains_in_time)
        expect_no_ghost(
            "filesrc location=" + file +
                " ! matroskademux ! avdec_ffv1 ! lenssweeptag planes=6 near=4 far=0.5 ! focalstackmux" +
                chain,
            &SoughtPipeline::seek_to_start);
    unlink(file.c_str());
}

TEST(Recording, depth_and_the_camera_clock_keep_their_metas)
{
    const Harness harness = depth_harness("dffmetapay ! rtpgstpay ! rtpgstdepay ! dffmetadepay", 16, 8);
    const GstDepthInfo depth = dioptres_from_5_to_1();
    g_autoptr(GstCaps) clock = gst_caps_from_string("timestamp/x-camera");
    for (guint64 k = 0; k < 3; k++) {
        Buffer frame = depth_frame(16, 8, [](unsigned x, unsigned y) { return 1000 * x + y; });
        gst_buffer_add_depth_meta(frame.get(), &depth)->sequence = 41 + k;
        gst_buffer_add_reference_timestamp_meta(frame.get(), clock, 1234567890123 + k, 5);
        const std::string before = fields(gst_buffer_get_depth_meta(frame.get()), gst_depth_meta_to_bytes);
        const std::string time = camera_clock(frame.get());
        gst_harness_push(harness.get(), frame.release());
        const Buffer back(gst_harness_pull(harness.get()));
        EXPECT_EQ(fields(gst_buffer_get_depth_meta(back.get()), gst_depth_meta_to_bytes), before);
        EXPECT_EQ(camera_clock(back.get()), time);
    }
}

namespace {

GstEvent *bytes_event(const char *kind, gsize size, guint8 fill = 0)
{
    g_autoptr(GstBuffer) data = gst_buffer_new_allocate(nullptr, size, nullptr);
    gst_buffer_memset(data, 0, fill, size);
    return gst_event_new_custom(
        GST_EVENT_CUSTOM_DOWNSTREAM,
        gst_structure_new("GstDffMeta", "kind", G_TYPE_STRING, kind, "data", GST_TYPE_BUFFER, data, nullptr));
}

GstEvent *time_event(const std::string &clock, guint64 timestamp)
{
    return gst_event_new_custom(GST_EVENT_CUSTOM_DOWNSTREAM,
                                gst_structure_new("GstDffMeta", "kind", G_TYPE_STRING, "time", "clock",
                                                  G_TYPE_STRING, clock.c_str(), "timestamp", G_TYPE_UINT64,
                                                  timestamp, "duration", G_TYPE_UINT64, guint64{5}, nullptr));
}

GstFlowReturn push_frame(const Harness &harness)
{
    return gst_harness_push(harness.get(),
                            depth_frame(16, 8, [](unsigned, unsigned) { return 1; }).release());
}

/* What the harness's element says before it gives up. */
class Errors {
public:
    explicit Errors(const Harness &harness) : element_(harness->element), bus_(gst_bus_new())
    {
        gst_element_set_bus(element_, bus_);
    }
    ~Errors()
    {
        gst_element_set_bus(element_, nullptr);
        gst_object_unref(bus_);
    }

    std::string next()
    {
        g_autoptr(GstMessage) message = gst_bus_pop_filtered(bus_, GST_MESSAGE_ERROR);
        g_autoptr(GError) error = nullptr;
        if (message)
            gst_message_parse_error(message, &error, nullptr);
        return error ? error->message : "";
    }

private:
    GstElement *element_;
    GstBus *bus_;
};

/* Such an event whose data is counted in `alive` as long as anybody has it. */
GstEvent *counted_event(const char *kind, guint &alive)
{
    auto forget = [](gpointer count, GstMiniObject *) { --*static_cast<guint *>(count); };
    GstEvent *event = bytes_event(kind, 1 << 20);
    const GValue *data = gst_structure_get_value(gst_event_get_structure(event), "data");
    gst_mini_object_weak_ref(GST_MINI_OBJECT(gst_value_get_buffer(data)), forget, &alive);
    alive++;
    return event;
}

} // namespace

TEST(Recording, events_without_buffers_do_not_pile_up)
{
    guint alive = 0;
    const Harness harness = depth_harness("dffmetadepay", 16, 8);
    for (const char *kind : {"focus", "stack", "depth", "unknown"})
        for (guint k = 0; k < 200; k++)
            gst_harness_push_event(harness.get(), counted_event(kind, alive));
    EXPECT_LE(alive, 3U);
}

TEST(Recording, metas_of_lost_buffers_give_way_to_the_next_ones)
{
    const Harness harness = depth_harness("dffmetadepay", 16, 8);
    Buffer frame = depth_frame(16, 8, [](unsigned, unsigned) { return 1; });
    const GstDepthInfo depth = dioptres_from_5_to_1();
    GstDepthMeta *meta = gst_buffer_add_depth_meta(frame.get(), &depth);
    for (guint64 k = 0; k < 100; k++) {
        meta->sequence = k;
        g_autoptr(GBytes) bytes = gst_depth_meta_to_bytes(meta);
        g_autoptr(GstBuffer) data = gst_buffer_new_wrapped_bytes(bytes);
        gst_harness_push_event(
            harness.get(),
            gst_event_new_custom(GST_EVENT_CUSTOM_DOWNSTREAM,
                                 gst_structure_new("GstDffMeta", "kind", G_TYPE_STRING, "depth", "data",
                                                   GST_TYPE_BUFFER, data, nullptr)));
        gst_harness_push_event(harness.get(), time_event("timestamp/x-camera", k));
    }
    EXPECT_EQ(push_frame(harness), GST_FLOW_OK);
    const Buffer back(gst_harness_pull(harness.get()));
    ASSERT_NE(gst_buffer_get_depth_meta(back.get()), nullptr);
    EXPECT_EQ(gst_buffer_get_depth_meta(back.get())->sequence, 99u);
    EXPECT_EQ(camera_clock(back.get()), "timestamp/x-camera 99 5");
    EXPECT_EQ(push_frame(harness), GST_FLOW_OK);
    const Buffer next(gst_harness_pull(harness.get()));
    EXPECT_EQ(gst_buffer_get_depth_meta(next.get()), nullptr);
}

TEST(Recording, more_than_a_frame_can_have_is_an_error)
{
    const auto error_after = [](const std::vector<GstEvent *> &events) {
        const Harness harness = depth_harness("dffmetadepay", 16, 8);
        Errors errors(harness);
        for (GstEvent *event : events)
            gst_harness_push_event(harness.get(), event);
        EXPECT_EQ(push_frame(harness), GST_FLOW_ERROR);
        return errors.next();
    };
    EXPECT_EQ(error_after({bytes_event("stack", 20'000)}), "A recorded meta is damaged: it has 20000 bytes");
    EXPECT_EQ(error_after({bytes_event("stack", 0)}), "A recorded meta has no data");
    EXPECT_EQ(error_after({bytes_event("colour", 10)}),
              "A recorded meta is of a kind that this release does not know");
    EXPECT_EQ(error_after({time_event("timestamp/x-" + std::string(2000, 'a'), 1)}),
              "A recorded reference timestamp is damaged");
    std::vector<GstEvent *> clocks;
    for (guint k = 0; k < 9; k++)
        clocks.push_back(time_event("timestamp/x-" + std::to_string(k), k));
    EXPECT_EQ(error_after(clocks), "A recorded frame has the times of more than 8 clocks");
}

TEST(Recording, a_damaged_meta_is_an_error_that_says_so)
{
    const Harness harness = depth_harness("dffmetadepay", 16, 8);
    Errors errors(harness);
    gst_harness_push_event(harness.get(), bytes_event("depth", 5, 'D'));
    EXPECT_EQ(push_frame(harness), GST_FLOW_ERROR);
    EXPECT_NE(errors.next(), "");
}
