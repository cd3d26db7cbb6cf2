/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "support.h"
#include "swung_camera.h"

#include <filesystem>
#include <fstream>
#include <gst/dff/dff.h>
#include <gtest/gtest.h>
#include <unistd.h>

using namespace std::chrono_literals;

namespace {

constexpr unsigned planes = 3; /* at 200, 100 and 0 mA: the triangle goes from 250 to -50 */
constexpr unsigned frames_a_period = 2 * planes;

/* 50 mA a dioptre, in a file. */
class Profile {
public:
    Profile()
    {
        std::ofstream(path_) << "%YAML:1.0\n---\nlens: \"EL-16-40\"\nvergence: [ 0, 5 ]\n"
                                "position: [ 0, 250 ]\nunit: \"mA\"\n";
    }
    ~Profile() { std::filesystem::remove(path_); }
    std::string path() const { return path_; }

private:
    std::filesystem::path path_ =
        std::filesystem::temp_directory_path() / ("dff-triangle-" + std::to_string(getpid()) + ".yaml");
};

std::string tagger(const FakeOptotune &driver, const std::string &line, const Profile &profile)
{
    return "lenssweeptag name=tag mode=sync planes=3 near=4 far=0 sync-line=" + line +
           " lens-profile=" + profile.path() + " lens=optotune:" + driver.device() + " ! ";
}

/* A clock that is read in time; but now and then whoever reads it is kept waiting then, as on a busy machine.
 */
struct SlowClock {
    GstClock parent;
    guint reads;
};
struct SlowClockClass {
    GstClockClass parent;
};
G_DEFINE_TYPE(SlowClock, slow_clock, GST_TYPE_CLOCK)

GstClockTime read_slowly(GstClock *clock)
{
    const auto now = static_cast<GstClockTime>(g_get_monotonic_time()) * 1000;
    if (++reinterpret_cast<SlowClock *>(clock)->reads % 23 == 0)
        g_usleep(40000); /* two frames */
    return now;
}

void slow_clock_class_init(SlowClockClass *klass)
{
    GST_CLOCK_CLASS(klass)->get_internal_time = read_slowly;
}

void slow_clock_init(SlowClock *) {}

/* Frames of a camera that is wired to the driver. */
class Swing {
public:
    explicit Swing(FakeOptotune &driver, std::chrono::nanoseconds lag = 0ns,
                   std::chrono::nanoseconds delay = 0ns,
                   const std::string &rest = "appsink name=out max-buffers=200")
        : camera(driver, frames_a_period, lag, delay),
          pipeline("appsrc name=camera is-live=true format=time caps=" + std::string(SwungCamera::caps) +
                   " ! " + tagger(driver, camera.line(), profile_) + rest)
    {
    }
    ~Swing() { camera.stop(); }

    /* PLAYING, and the camera shoots. */
    void play()
    {
        ASSERT_NE(pipeline.set_state(GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
        camera.shoot_into(GST_APP_SRC(pipeline.element("camera")));
        /* The lens begins with the caps, which come with a first frame. */
        GstBuffer *first =
            gst_buffer_new_allocate(nullptr, size_t{SwungCamera::side} * SwungCamera::side, nullptr);
        GST_BUFFER_PTS(first) = 0;
        gst_app_src_push_buffer(GST_APP_SRC(pipeline.element("camera")), first);
    }

private:
    Profile profile_;

public:
    SwungCamera camera;
    Pipeline pipeline;
};

/* Labels are right if the lens stood, in the middle of the frame, where the plane is. */
void expect_labels(Swing &swing, unsigned count)
{
    swing.play();
    std::optional<std::pair<guint64, guint>> before;
    unsigned neighbours = 0;
    for (unsigned i = 0; i < count; ++i) {
        const Sample sample = swing.pipeline.pull("out");
        ASSERT_TRUE(sample) << swing.pipeline.wait();
        const GstFocusMeta *focus = focus_of(sample);
        ASSERT_LT(focus->plane, planes);
        EXPECT_DOUBLE_EQ(focus->power, 4.0 - 2.0 * focus->plane);
        EXPECT_NEAR(bytes_of(sample.get()).at(0), 200 - 100 * static_cast<int>(focus->plane), 3);
        /* Down in even sweeps, up in odd ones. */
        const guint place = focus->sweep % 2 == 0 ? focus->plane : planes - 1 - focus->plane;
        const guint64 slot = focus->sweep * planes + place;
        neighbours += before && before->first + 1 == slot;
        before = {slot, focus->plane};
    }
    EXPECT_GT(neighbours, count / 2);
}

/* The text of the first warning; an error is one, too. */
std::string first_message(Swing &swing)
{
    g_autoptr(GstBus) bus = gst_element_get_bus(swing.pipeline.get());
    g_autoptr(GstMessage) message = gst_bus_timed_pop_filtered(
        bus, patience, static_cast<GstMessageType>(GST_MESSAGE_WARNING | GST_MESSAGE_ERROR));
    g_autoptr(GError) error = nullptr;
    if (message && GST_MESSAGE_TYPE(message) == GST_MESSAGE_WARNING)
        gst_message_parse_warning(message, &error, nullptr);
    else if (message)
        gst_message_parse_error(message, &error, nullptr);
    return error ? error->message : "none came";
}

} // namespace

TEST(TriangleSweep, planes_are_labelled_on_the_way_there_and_back)
{
    FakeOptotune driver;
    {
        Swing swing(driver);
        expect_labels(swing, 60);
    }
    EXPECT_FALSE(driver.triangle());
    EXPECT_EQ(driver.moves().back(), "0 mA");
}

/* The camera's trigger is as late as the lens, and timestamp-delay says so. */
TEST(TriangleSweep, a_lens_that_follows_late_is_labelled_right_if_its_lag_is_told)
{
    FakeOptotune driver;
    Swing swing(driver, 8ms, 8ms);
    g_object_set(swing.pipeline.element("tag"), "timestamp-delay", G_GUINT64_CONSTANT(8000000), nullptr);
    expect_labels(swing, 60);
}

TEST(TriangleSweep, a_reader_of_the_clock_who_is_kept_waiting_labels_no_frame_wrongly)
{
    FakeOptotune driver;
    Swing swing(driver, 0ns, 0ns, "appsink name=out max-buffers=200 sync=false");
    auto *clock = static_cast<GstClock *>(g_object_new(slow_clock_get_type(), nullptr));
    gst_pipeline_use_clock(GST_PIPELINE(swing.pipeline.get()), clock);
    gst_object_unref(gst_object_ref_sink(clock));
    expect_labels(swing, 60);
}

TEST(TriangleSweep, frames_between_two_planes_are_not_labelled_and_a_warning_tells_how_far_they_are_off)
{
    FakeOptotune driver;
    Swing swing(driver, 0ns, 8ms, "fakesink sync=false");
    swing.play();
    const std::string warning = first_message(swing);
    EXPECT_NE(warning.find("do not fit together"), std::string::npos) << warning;
    EXPECT_NE(warning.find("timestamp-delay"), std::string::npos) << warning;
    g_autoptr(GstStructure) stats = nullptr;
    g_object_get(swing.pipeline.element("tag"), "stats", &stats, nullptr);
    guint64 labelled = 1;
    gst_structure_get_uint64(stats, "labelled", &labelled);
    EXPECT_EQ(labelled, 0U);
}

/* A fifth of a plane there, and a fifth back. */
TEST(TriangleSweep, a_lens_that_is_later_than_was_told_is_seen_by_sharpness)
{
    FakeOptotune driver;
    Swing swing(driver, 4ms, 0ms, "fakesink sync=false");
    swing.play();
    const std::string warning = first_message(swing);
    EXPECT_NE(warning.find("us behind where frames are labelled"), std::string::npos) << warning;
    const auto place = warning.find("set timestamp-delay to ");
    ASSERT_NE(place, std::string::npos) << warning;
    EXPECT_NEAR(std::stod(warning.substr(place + 23)), 4e6, 1.5e6) << warning;
}

TEST(TriangleSweep, stacks_have_the_nearest_plane_first_both_ways)
{
    FakeOptotune driver;
    Swing swing(driver, 0ns, 0ns, "focalstackmux on-missing=drop ! appsink name=out max-buffers=20");
    swing.play();
    std::optional<guint64> before;
    unsigned neighbours = 0;
    for (unsigned stack = 0; stack < 8; ++stack) {
        const Sample sample = swing.pipeline.pull("out");
        ASSERT_TRUE(sample) << swing.pipeline.wait();
        const auto bytes = bytes_of(sample.get());
        ASSERT_GE(bytes.size(), size_t{planes} * SwungCamera::side * SwungCamera::side);
        for (unsigned plane = 0; plane < planes; ++plane)
            EXPECT_NEAR(bytes.at(plane * bytes.size() / planes), 200 - 100 * static_cast<int>(plane), 3);
        const auto *meta = gst_buffer_get_focal_stack_meta(gst_sample_get_buffer(sample.get()));
        ASSERT_NE(meta, nullptr);
        EXPECT_TRUE(meta->complete);
        GstFocusInfo nearest;
        ASSERT_TRUE(gst_focal_stack_meta_get_focus(meta, 0, &nearest));
        neighbours += before && *before + 1 == nearest.sweep;
        before = nearest.sweep;
    }
    EXPECT_GT(neighbours, 0U);
}

TEST(TriangleSweep, unplugged_in_mid_sweep_ends_in_an_error_and_it_may_come_back)
{
    auto driver = std::make_unique<FakeOptotune>();
    {
        Swing swing(*driver);
        swing.play();
        ASSERT_TRUE(swing.pipeline.pull("out"));
        driver->unplug();
        const std::string error = swing.pipeline.wait();
        EXPECT_NE(error.find("unplugged"), std::string::npos) << error;
    }
    driver = std::make_unique<FakeOptotune>();
    Swing swing(*driver);
    swing.play();
    EXPECT_TRUE(swing.pipeline.pull("out"));
}

TEST(TriangleSweep, a_hot_lens_ends_in_an_error_that_says_so)
{
    FakeOptotune driver;
    driver.set_temperature(80);
    Swing swing(driver, 0ns, 0ns, "fakesink");
    swing.play();
    const std::string error = swing.pipeline.wait();
    EXPECT_NE(error.find("80 degrees Celsius"), std::string::npos) << error;
}

TEST(TriangleSweep, what_is_wrong_at_the_start_is_told)
{
    FakeOptotune driver;
    const Profile profile;
    const std::string source = "videotestsrc ! video/x-raw,width=64,height=64,framerate=50/1 ! ";
    Pipeline wireless(source + tagger(driver, "\"\"", profile) + "fakesink");
    const std::string line = wireless.run();
    EXPECT_NE(line.find("needs sync-line"), std::string::npos) << line;

    SwungCamera camera(driver, frames_a_period, 0ns, 0ns);
    Pipeline range(source + tagger(driver, camera.line(), profile) + "fakesink");
    g_object_set(range.element("tag"), "near", 5.0, nullptr);
    const std::string far = range.run();
    EXPECT_NE(far.find("-292.83 to 292.83 mA"), std::string::npos) << far;

    Pipeline dioptres(source + tagger(driver, camera.line(), profile) + "fakesink");
    g_object_set(dioptres.element("tag"), "lens-profile", "", nullptr);
    const std::string unit = dioptres.run();
    EXPECT_NE(unit.find("with unit \"mA\""), std::string::npos) << unit;
}

TEST(TriangleSweep, two_hundred_starts_leave_nothing_open)
{
    FakeOptotune driver;
    const Profile profile;
    SwungCamera camera(driver, frames_a_period, 0ns, 0ns);
    Pipeline pipeline("videotestsrc is-live=true ! video/x-raw,width=64,height=64,framerate=50/1 ! " +
                      tagger(driver, camera.line(), profile) + "fakesink");
    const auto open_files = [] {
        return std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                             std::filesystem::directory_iterator());
    };
    /* The server of the line sees some milliseconds later that it was let go. */
    const auto settled_files = [&] {
        std::this_thread::sleep_for(100ms);
        return open_files();
    };
    decltype(open_files()) before = 0;
    for (int cycle = 0; cycle < 200; cycle++) {
        ASSERT_NE(pipeline.set_state(GST_STATE_PLAYING), GST_STATE_CHANGE_FAILURE);
        while (!driver.triangle())
            std::this_thread::sleep_for(1ms);
        ASSERT_EQ(pipeline.set_state(GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
        if (cycle == 0)
            before = settled_files();
    }
    EXPECT_EQ(settled_files(), before);
    EXPECT_FALSE(driver.triangle());
    EXPECT_EQ(driver.moves().back(), "0 mA");
}
