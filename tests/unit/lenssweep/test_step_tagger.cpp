/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "lenssweep/step_tagger.h"

#include <chrono>
#include <gtest/gtest.h>

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
    for (int i = 0; i < 4; ++i)
        labels += label(std::nullopt) + " ";
    EXPECT_EQ(labels, "- 0.0 - 0.1 ");
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
