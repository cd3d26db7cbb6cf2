/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lenssweep/step_tagger.h"

#include <chrono>
#include <gtest/gtest.h>
#include <thread>

namespace {

constexpr uint64_t second = 1'000'000'000;

uint64_t now_ns()
{
    return static_cast<uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
}

/* A lens that notes where it was moved. */
class NotingLens : public dff::SteppedLens {
public:
    explicit NotingLens(std::vector<unsigned> &moves) : moves_(moves) {}
    void prepare(const dff::LensSweep &) override {}
    void start() override {}
    void stop() override {}
    bool calibrated() const override { return true; }
    int code(unsigned plane) const override { return static_cast<int>(plane); }
    void move_to(unsigned plane) override { moves_.push_back(plane); }
    bool wait_settled(const std::stop_token &stop) override { return !stop.stop_requested(); }

private:
    std::vector<unsigned> &moves_;
};

/* A camera whose lens is told where to be some frames after it was asked, and which says for the last frame
 * that is done where that was. Frames may pile up on the way from it. */
class LateCamera : public dff::SteppedLens {
public:
    explicit LateCamera(unsigned delay) : delay_(delay) {}
    void prepare(const dff::LensSweep &) override {}
    void start() override {}
    void stop() override {}
    bool calibrated() const override { return true; }
    int code(unsigned plane) const override { return static_cast<int>(plane); }
    void move_to(unsigned plane) override { asked_ = static_cast<int>(plane); }
    bool wait_settled(const std::stop_token &) override { return true; }
    std::optional<bool> at_plane() override { return told_ == asked_; }

    /* A frame is taken and done: the plane that its lens had. */
    int take()
    {
        on_the_way_.push_back(asked_);
        if (on_the_way_.size() > delay_) {
            told_ = on_the_way_.front();
            on_the_way_.erase(on_the_way_.begin());
        }
        return told_;
    }

private:
    unsigned delay_;
    int asked_ = -1;
    int told_ = -1;
    std::vector<int> on_the_way_;
};

/* Three planes at 100 frames a second. */
class Step : public testing::Test {
protected:
    void begin(unsigned settle_frames)
    {
        tagger_ = std::make_unique<StepTagger>(std::make_unique<NotingLens>(moves_), 3, settle_frames);
        tagger_->set_period(second / 100);
    }

    /* "-" for a dropped frame, else its label. */
    std::string label(std::optional<uint64_t> time_ns, const std::stop_token &stop = {})
    {
        const auto label = tagger_->label(time_ns, stop);
        return label ? std::to_string(label->sweep) + "." + std::to_string(label->plane) : "-";
    }

    std::vector<unsigned> moves_;
    std::unique_ptr<StepTagger> tagger_;
};

} // namespace

TEST_F(Step, each_plane_is_labelled_once_and_then_the_lens_moves_on)
{
    begin(0);
    std::string labels;
    for (int i = 0; i < 7; ++i)
        labels += label(now_ns() + second) + " ";
    EXPECT_EQ(labels, "0.0 0.1 0.2 1.0 1.1 1.2 2.0 ");
    EXPECT_EQ(moves_, (std::vector<unsigned>{0, 1, 2, 0, 1, 2, 0, 1}));
}

TEST_F(Step, frames_that_may_have_seen_the_lens_move_are_dropped)
{
    begin(0);
    const uint64_t before = now_ns();
    EXPECT_EQ(label(before), "-");
    EXPECT_EQ(label(before + second / 100 - 1),
              "-"); /* a period after the move it may have begun before it */
    EXPECT_EQ(label(now_ns() + second / 100), "0.0");
    EXPECT_EQ(label(now_ns() - 1), "-");
    EXPECT_EQ(label(now_ns() + second / 100), "0.1");
}

TEST_F(Step, settle_frames_are_dropped_in_addition)
{
    begin(2);
    EXPECT_EQ(label(now_ns()), "-");
    std::string labels;
    for (int i = 0; i < 6; ++i)
        labels += label(now_ns() + second) + " ";
    EXPECT_EQ(labels, "- - 0.0 - - 0.1 ");
}

TEST_F(Step, frames_without_a_time_are_counted_only)
{
    begin(1);
    std::string labels;
    for (int i = 0; i < 5; ++i)
        labels += label(std::nullopt) + " ";
    EXPECT_EQ(labels, "- - 0.0 - 0.1 ");
}

TEST_F(Step, a_frame_that_was_there_before_the_lens_is_moved_has_no_plane)
{
    begin(0);
    EXPECT_EQ(label(std::nullopt), "-");
    EXPECT_EQ(label(std::nullopt), "0.0");
    EXPECT_EQ(label(std::nullopt), "0.1");
}

TEST_F(Step, after_a_restart_a_new_sweep_begins_at_plane_0)
{
    begin(0);
    label(now_ns() + second);
    tagger_->restart();
    EXPECT_EQ(label(now_ns() + second), "1.0");
    EXPECT_EQ(moves_, (std::vector<unsigned>{0, 1, 0, 1}));
}

TEST_F(Step, a_lens_that_was_not_waited_for_gives_no_label)
{
    begin(0);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_EQ(label(now_ns() + second, stop.get_token()), "-");
    EXPECT_EQ(label(now_ns() + second), "0.0");
}

TEST_F(Step, frames_are_dropped_until_the_camera_says_that_its_lens_is_there)
{
    for (unsigned delay = 0; delay < 6; delay++) {
        auto owned = std::make_unique<LateCamera>(delay);
        LateCamera &camera = *owned;
        StepTagger tagger(std::move(owned), 3, 0);
        unsigned labelled = 0;
        for (int i = 0; i < 200; i++) {
            const int plane = camera.take();
            const auto found = tagger.label(std::nullopt, {});
            labelled += found.has_value();
            if (found) {
                EXPECT_EQ(plane, static_cast<int>(found->plane)) << "delay " << delay;
            }
        }
        EXPECT_NEAR(labelled, 200.0 / (delay + 1), 2) << "delay " << delay;
    }
}

/* What the camera says is of the last frame done, not of the one that comes in. */
TEST_F(Step, frames_that_have_piled_up_are_older_than_what_the_camera_says)
{
    using namespace std::chrono_literals;
    for (unsigned delay = 1; delay < 5; delay++) {
        auto owned = std::make_unique<LateCamera>(delay);
        LateCamera &camera = *owned;
        StepTagger tagger(std::move(owned), 3, 0);
        tagger.set_period(second / 200);
        std::vector<std::pair<uint64_t, int>> piled; /* time and plane */
        unsigned labelled = 0;
        for (int i = 0; i < 80; i++) {
            std::this_thread::sleep_for(5ms);
            piled.emplace_back(now_ns(), camera.take());
            if (i % 20 > 14)
                continue; /* the pipeline is busy */
            for (const auto &[time, plane] : piled) {
                const auto found = tagger.label(time, {});
                labelled += found.has_value();
                if (found) {
                    EXPECT_EQ(plane, static_cast<int>(found->plane)) << "frame " << i << ", delay " << delay;
                }
            }
            piled.clear();
        }
        EXPECT_GT(labelled, 6U);
    }
}
