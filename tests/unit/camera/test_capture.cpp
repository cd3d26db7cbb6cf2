/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* The capture without GStreamer, with the camera that Aravis simulates in this process. Thread sanitizer sees
 * every lock here; see tests/tsan.sh. */
#include "lenssweep/camera/sweep_capture.h"
#include "lenssweep/camera/triggers.h"

#include <atomic>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <sys/eventfd.h>
#include <thread>
#include <unistd.h>

namespace {

constexpr std::int64_t second_ns = 1'000'000'000;

dff::CaptureSettings simulated(double rate)
{
    dff::CaptureSettings settings;
    settings.camera = "Fake_1";
    settings.plan = dff::SweepPlan::even(4, 5, 0);
    settings.rate = rate;
    settings.exposure_us = 2000;
    settings.trigger = dff::TriggerKind::FreeRun;
    return settings;
}

void start(dff::SweepCapture &capture)
{
    capture.start(*dff::layout_of_camera("Mono8"), 64, 48);
}

dff::CapturedPlane next_plane(dff::SweepCapture &capture)
{
    while (true) {
        auto plane = capture.next(dff::host_now_ns() + second_ns);
        if (plane)
            return std::move(*plane);
    }
}

/* A lens in the hands of a sequencer that only counts, as far as it can be read. */
struct CountingSequencer : dff::SequencedLens {
    std::atomic<std::uint32_t> count = 0;
    std::atomic<bool> readable = true;
    std::atomic<int> readings = 0;

    void prepare(const dff::LensSweep &) override {}
    void start() override {}
    void stop() override {}
    bool calibrated() const override { return true; }
    int code(unsigned) const override { return -1; }
    void check() override {}
    std::uint32_t sweep_count() override { return count / 6; }
    std::uint32_t frame_count() override
    {
        readings++;
        if (!readable)
            throw dff::LensError("no acknowledge");
        return count;
    }
};

/* A sync line whose edges come when the test says so. */
class TestedLine : public dff::EdgeLine {
public:
    TestedLine() : readable_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}
    ~TestedLine() override { close(readable_); }
    TestedLine(const TestedLine &) = delete;
    TestedLine &operator=(const TestedLine &) = delete;

    void edge(std::int64_t time_ns)
    {
        next_ns_ = time_ns;
        eventfd_write(readable_, 1);
    }

    int descriptor() const override { return readable_; }

    std::optional<dff::LineEdge> read() override
    {
        eventfd_t edges = 0;
        if (eventfd_read(readable_, &edges) != 0)
            return std::nullopt;
        return dff::LineEdge{static_cast<std::uint64_t>(next_ns_.load())};
    }

private:
    int readable_;
    std::atomic<std::int64_t> next_ns_ = 0;
};

/* As the capture does it: what there is to hear is heard. */
bool comes_true(dff::Triggers &triggers, const std::function<bool()> &what)
{
    for (int i = 0; i < 10'000 && !what(); i++) {
        triggers.hear();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return what();
}

const dff::FrameNumbers sixteen_bits(dff::FrameNumbering::GigE16);

/* Long enough for a machine that is busy. */
constexpr dff::SweepTiming slow_sweeps{4, 200'000'000, 800'000'000, 6'000'000};

} // namespace

TEST(SweepCapture, planes_are_read_while_frames_arrive)
{
    dff::SweepCapture capture(simulated(40));
    start(capture);
    unsigned sum = 0;
    for (int i = 0; i < 100; i++) {
        const auto plane = next_plane(capture);
        for (const std::uint8_t pixel : plane.buffer.pixels())
            sum += pixel;
    }
    EXPECT_GT(sum, 0U);
}

TEST(SweepCapture, an_interrupt_ends_the_wait)
{
    dff::SweepCapture capture(simulated(0.5));
    start(capture);
    next_plane(capture);
    std::atomic<bool> ended = false;
    std::thread waiting([&] {
        capture.next(std::numeric_limits<std::int64_t>::max() / 2);
        ended = true;
    });
    capture.interrupt();
    waiting.join();
    EXPECT_TRUE(ended);
}

TEST(SweepCapture, planes_outlive_it_in_another_thread)
{
    std::vector<dff::CapturedPlane> planes;
    std::thread reader;
    {
        dff::SweepCapture capture(simulated(40));
        start(capture);
        for (int i = 0; i < 8; i++)
            planes.push_back(next_plane(capture));
        reader = std::thread([taken = std::move(planes)]() mutable {
            std::this_thread::sleep_for(std::chrono::milliseconds(30));
            while (!taken.empty()) {
                EXPECT_FALSE(taken.back().buffer.pixels().empty());
                taken.pop_back();
            }
        });
        next_plane(capture);
    }
    reader.join();
}

TEST(SweepCapture, settings_change_and_sweeps_go_on_rising)
{
    dff::SweepCapture capture(simulated(20));
    start(capture);
    const std::uint64_t before = next_plane(capture).sweep;
    dff::CaptureSettings faster = simulated(40);
    faster.gain = 3;
    capture.change(faster);
    std::uint64_t last = before;
    for (int i = 0; i < 20; i++) {
        const std::uint64_t sweep = next_plane(capture).sweep;
        EXPECT_GE(sweep, last);
        last = sweep;
    }
    EXPECT_GT(last, before);
}

/* It would wait for its own end: Aravis tells it in the thread that asks the camera whether it is there. */
TEST(AravisCamera, is_not_freed_by_the_thread_that_tells_that_it_is_gone)
{
    auto camera = std::make_unique<dff::AravisCamera>("Fake_1");
    ArvDevice *device = arv_camera_get_device(camera->handle());
    std::atomic<bool> telling = false;
    const auto busy = +[](ArvDevice *, std::atomic<bool> *told) {
        *told = true;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    };
    g_signal_connect(device, "control-lost", G_CALLBACK(busy), &telling);
    std::thread::id freed_by;
    const auto freed =
        +[](gpointer id, GObject *) { *static_cast<std::thread::id *>(id) = std::this_thread::get_id(); };
    g_object_weak_ref(G_OBJECT(device), freed, &freed_by);
    std::thread heartbeat([&] { g_signal_emit_by_name(device, "control-lost"); });
    while (!telling)
        std::this_thread::yield();
    camera.reset();
    heartbeat.join();
    EXPECT_EQ(freed_by, std::this_thread::get_id());
}

TEST(LineTriggers, count_what_the_sequencer_has_given)
{
    CountingSequencer lens;
    lens.count = 0xffff'fff0; /* of those before us */
    dff::LineTriggers triggers({6, 6'400'000, 38'400'000, 6'000'000}, sixteen_bits, {&lens, nullptr, nullptr},
                               [] {});
    EXPECT_EQ(triggers.given(), 0U);
    triggers.start();
    lens.count += 10;
    EXPECT_TRUE(comes_true(triggers, [&] { return triggers.given() == 10U; })) << "each second";
    lens.count += 10; /* its 32 bits wrap */
    triggers.stop();
    EXPECT_EQ(triggers.given(), 20U);
    lens.count += 100; /* somebody else's */
    triggers.start();
    lens.count += 6;
    triggers.stop();
    EXPECT_EQ(triggers.given(), 26U);
}

TEST(LineTriggers, read_the_count_in_each_sweep_and_hold_it_against_the_edge)
{
    CountingSequencer lens;
    TestedLine line;
    dff::LineTriggers triggers(slow_sweeps, sixteen_bits, {&lens, nullptr, &line}, [] {});
    triggers.start();
    lens.count = 1;
    line.edge(dff::host_now_ns());
    ASSERT_TRUE(comes_true(triggers, [&] { return triggers.given() == 1U; }));
    lens.count = 3; /* when it has come to rest */
    triggers.stop();
    EXPECT_EQ(triggers.wrong_counts(), 0U);
    triggers.start();
    lens.count = 3 + 3; /* plane 2 */
    line.edge(dff::host_now_ns());
    EXPECT_TRUE(comes_true(triggers, [&] { return triggers.wrong_counts() == 1U; }));
    EXPECT_EQ(triggers.take_complaint(), "");
}

TEST(LineTriggers, tell_once_that_the_count_cannot_be_read_and_go_on)
{
    CountingSequencer lens;
    dff::LineTriggers triggers(slow_sweeps, sixteen_bits, {&lens, nullptr, nullptr}, [] {});
    triggers.start();
    lens.readable = false;
    const int before = lens.readings;
    ASSERT_TRUE(comes_true(triggers, [&] { return lens.readings >= before + 2; }));
    EXPECT_NE(triggers.take_complaint().find("no acknowledge"), std::string::npos);
    EXPECT_EQ(triggers.take_complaint(), "");
    triggers.hear();
    lens.count += 7;
    lens.readable = true;
    EXPECT_TRUE(comes_true(triggers, [&] { return triggers.given() == 7U; }));
}

TEST(SweepCapture, starts_and_stops_as_often_as_wanted)
{
    dff::SweepCapture capture(simulated(40));
    for (int i = 0; i < 10; i++) {
        start(capture);
        if (i % 2 == 0)
            next_plane(capture);
        capture.stop();
    }
}
