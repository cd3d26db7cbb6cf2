/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* What may change while the source plays, again and again, however it is triggered: the frames come again
 * with their right planes each time, and the source can be stopped. */
#include "fickle_filter.h"
#include "proofs.h"

#include <atomic>
#include <cstdlib>
#include <gtest/gtest.h>
#include <string_view>
#include <thread>

using namespace dff;
using namespace std::chrono_literals;

namespace {

constexpr auto patience = 15s;
constexpr auto soon = 1s;

struct Wiring {
    const char *name;
    std::vector<std::string> bench;
    bool lines;
    const char *source;
    double rate;
    bool moves; /* whether somebody moves the lens in step: then the labels can be checked */
};

const std::vector<Wiring> wirings = {
    {"line", {"--rate=30", "--planes=3"}, true, "trigger=line exposure=5000", 30, true},
    {"software",
     {"--lens=register", "--planes=3"},
     false,
     "trigger=software lens=genicam:FocalPower exposure=5000",
     4,
     true},
    {"free_run", {"--planes=3"}, false, "trigger=free-run exposure=5000", 30, false},
};

/* The k-th new value of something, which differs from the one before; and whether a frame shows it. */
struct Change {
    const char *name;
    void (*make)(GstElement *source, GstElement *filter, double rate, int k);
    bool (*shows)(const Watched &frames, double rate, int k);
};

/* The sequencer's rate is its own; a twentieth of a percent off it is still told. */
double new_rate(double rate, int k)
{
    return k % 2 == 0 ? rate * 1.0005 : rate;
}

const std::vector<Change> changes = {
    {"exposure",
     [](GstElement *source, GstElement *, double, int k) {
         g_object_set(source, "exposure", 4000.0 + 100.0 * (k % 3), nullptr);
     },
     [](const Watched &frames, double, int k) {
         return frames.exposure_ns == static_cast<uint64_t>(4'000'000 + 100'000 * (k % 3));
     }},
    {"rate",
     [](GstElement *source, GstElement *, double rate, int k) {
         g_object_set(source, "rate", new_rate(rate, k), nullptr);
     },
     [](const Watched &frames, double rate, int k) {
         return std::abs(frames.frame_rate - 3 * new_rate(rate, k)) < 1e-4 * rate;
     }},
    {"gain_and_timeout",
     [](GstElement *source, GstElement *, double, int k) {
         g_object_set(source, "gain", 0.5 * (k % 2), "trigger-timeout",
                      (60 + static_cast<guint64>(k)) * GST_SECOND, nullptr);
     },
     [](const Watched &, double, int) { return true; }},
    {"caps",
     [](GstElement *, GstElement *filter, double, int k) {
         g_autoptr(GstCaps) caps = gst_caps_new_simple("video/x-raw", "format", G_TYPE_STRING, "GRAY8",
                                                       "width", G_TYPE_INT, k % 2 == 0 ? 128 : 160, nullptr);
         g_object_set(filter, "caps", caps, nullptr);
     },
     [](const Watched &frames, double, int k) { return frames.width == (k % 2 == 0 ? 128 : 160); }},
};

struct Unref {
    void operator()(gpointer object) const { gst_object_unref(object); }
};
using Element = std::unique_ptr<GstElement, Unref>;

/* A stream of one wiring that plays, to be changed. */
class ChangedStream {
public:
    ChangedStream(const Wiring &wiring, const Change &change)
        : wiring_(wiring), change_(change), bench_(options(wiring)),
          stream_((wiring.lines ? bench_.source() : bench_.unwired_source()) + ' ' + wiring.source +
                  " planes=3 rate=" + std::to_string(wiring.rate) +
                  " ! capsfilter name=filter caps=video/x-raw,format=GRAY8,width=160 "
                  "! appsink name=labels sync=false"),
          source_(gst_bin_get_by_name(GST_BIN(stream_.pipeline()), "source")),
          filter_(gst_bin_get_by_name(GST_BIN(stream_.pipeline()), "filter"))
    {
        stream_.play();
        if (!stream_.wait_for_frames(6, patience))
            throw std::runtime_error("no frames: " + stream_.stats());
    }
    ~ChangedStream()
    {
        /* What does not stop cannot be cleared away either. */
        if (!stopped_ && !stop_at_once()) {
            std::puts("the source hangs: the rest of the tests is not run");
            std::fflush(stdout);
            std::_Exit(EXIT_FAILURE);
        }
    }
    ChangedStream(const ChangedStream &) = delete;
    ChangedStream &operator=(const ChangedStream &) = delete;

    void play()
    {
        stopped_ = false;
        stream_.play();
    }

    GstElement *filter() { return filter_.get(); }

    bool gets_width(int width)
    {
        return stream_.wait_until([width](const Watched &frames) { return frames.width == width; }, patience);
    }

    void change(int k) { change_.make(source_.get(), filter_.get(), wiring_.rate, k); }

    /* Two sweeps with the k-th value. */
    bool comes_again(int k)
    {
        const auto shown = [&](const Watched &frames) { return change_.shows(frames, wiring_.rate, k); };
        return stream_.wait_until(shown, patience) &&
               stream_.wait_for_frames(stream_.watched().frames + 6, patience);
    }

    bool stop_at_once(std::chrono::milliseconds time = soon)
    {
        const bool in_time = stream_.stop_within(time);
        stopped_ = in_time || stream_.stop_within(patience);
        return in_time;
    }

    void expect_right_labels() const
    {
        const uint64_t wrong = wiring_.moves ? stream_.watched().wrong : 0;
        EXPECT_EQ(wrong, 0U) << stream_.watched().first_wrong;
    }

    std::string stats() const { return stream_.stats(); }
    std::optional<std::string> error() const { return stream_.wait_for_end(0s); }

private:
    static std::vector<std::string> options(const Wiring &wiring)
    {
        std::vector<std::string> options = wiring.bench;
        options.emplace_back("--size=160x120");
        return options;
    }

    const Wiring &wiring_;
    const Change &change_;
    BenchProcess bench_;
    WatchedStream stream_;
    Element source_;
    Element filter_;
    bool stopped_ = false;
};

class Changes : public testing::TestWithParam<std::tuple<Wiring, Change>> {
protected:
    const Wiring &wiring() const { return std::get<0>(GetParam()); }
    const Change &change() const { return std::get<1>(GetParam()); }
};

} // namespace

TEST_P(Changes, the_stream_goes_on_after_each_and_can_be_stopped)
{
    ChangedStream stream(wiring(), change());
    for (int k = 0; k < cycles_of_proof(4); k++) {
        stream.change(k);
        ASSERT_TRUE(stream.comes_again(k)) << "after change " << k << ": " << stream.stats();
    }
    stream.expect_right_labels();
    EXPECT_TRUE(stream.stop_at_once());
}

TEST_P(Changes, twenty_at_once_are_as_good_as_one)
{
    ChangedStream stream(wiring(), change());
    for (int k = 0; k < 20; k++) {
        stream.change(k);
        std::this_thread::sleep_for(std::chrono::milliseconds(k * k % 23));
    }
    EXPECT_TRUE(stream.comes_again(19)) << stream.stats();
    stream.expect_right_labels();
    stream.change(20);
    std::this_thread::sleep_for(20ms);
    EXPECT_TRUE(stream.stop_at_once()) << "while a change is taken over";
}

/* Each state change meets a change of something at another moment. */
TEST_P(Changes, another_thread_may_make_them_while_the_source_starts_and_stops)
{
    ChangedStream stream(wiring(), change());
    std::atomic<bool> done = false;
    std::thread other([&] {
        for (int k = 0; !done; k++) {
            stream.change(k);
            std::this_thread::sleep_for(std::chrono::milliseconds(k % 7));
        }
    });
    for (int cycle = 0; cycle < 4; cycle++) {
        /* It may have just begun to set the camera up. */
        EXPECT_TRUE(stream.stop_at_once(5s)) << "cycle " << cycle;
        stream.play();
        std::this_thread::sleep_for(std::chrono::milliseconds(60 * cycle));
    }
    done = true;
    other.join();
    stream.change(19);
    EXPECT_TRUE(stream.comes_again(19)) << stream.stats();
    EXPECT_EQ(stream.error(), std::nullopt);
    stream.expect_right_labels();
}

TEST_P(Changes, what_downstream_takes_may_change_while_they_are_told)
{
    ChangedStream stream(wiring(), change());
    const FickleFilter fickle(stream.filter(), 144);
    const std::string_view name = change().name;
    if (name != "caps" && name != "rate") { /* these are told in no caps but the first */
        EXPECT_TRUE(stream.stop_at_once());
        stream.play();
    }
    stream.change(0);
    EXPECT_TRUE(stream.gets_width(144)) << stream.stats();
    EXPECT_EQ(stream.error(), std::nullopt);
    stream.expect_right_labels();
}

INSTANTIATE_TEST_SUITE_P(Rig, Changes,
                         testing::Combine(testing::ValuesIn(wirings), testing::ValuesIn(changes)),
                         [](const auto &info) {
                             return std::string(std::get<0>(info.param).name) + "_" +
                                    std::get<1>(info.param).name;
                         });
