/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "support.h"

#include <gtest/gtest.h>
#include <initializer_list>

namespace {

constexpr unsigned planes = 4;

/* A mux with frames of 4 planes going in, its messages and its stacks. */
class MuxLosses : public testing::Test {
protected:
    void start(const char *settings = "focalstackmux")
    {
        harness_.reset(gst_harness_new_parse(settings));
        mux_ = gst_harness_find_element(harness_.get(), "focalstackmux");
        gst_object_unref(mux_); /* the harness holds it */
        bus_ = gst_bus_new();
        gst_element_set_bus(mux_, bus_);
        gst_harness_set_src_caps_str(harness_.get(), frame_caps("GRAY8", 32, 8).c_str());
    }

    void TearDown() override
    {
        gst_element_set_bus(mux_, nullptr);
        harness_.reset();
        gst_object_unref(bus_);
    }

    void push(uint64_t sweep, unsigned plane)
    {
        ASSERT_EQ(gst_harness_push(harness_.get(), new_frame(info_, sweep, plane, planes)), GST_FLOW_OK);
    }

    void push_sweep(uint64_t sweep, std::initializer_list<unsigned> order)
    {
        for (const unsigned plane : order)
            push(sweep, plane);
    }

    Owned<GstBuffer> pull() { return Owned<GstBuffer>(gst_harness_try_pull(harness_.get())); }

    void expect_stack(const std::vector<uint8_t> &shades)
    {
        const Owned<GstBuffer> stack = pull();
        ASSERT_TRUE(stack);
        EXPECT_EQ(shades_of(info_, stack.get(), planes), shades);
        EXPECT_EQ(gst_buffer_n_memory(stack.get()), 1u);
    }

    /* The next warning, or nothing. */
    std::string warning()
    {
        const Owned<GstMessage> message(gst_bus_pop_filtered(bus_, GST_MESSAGE_WARNING));
        if (!message)
            return "";
        g_autoptr(GError) error = nullptr;
        gst_message_parse_warning(message.get(), &error, nullptr);
        return error->message;
    }

    void expect_no_stack() { EXPECT_FALSE(pull()); }
    void expect_count(const char *name, uint64_t count) { EXPECT_EQ(count_of(mux_, name), count) << name; }
    void end() { gst_harness_push_event(harness_.get(), gst_event_new_eos()); }

    GstVideoInfo info_ = video_info("GRAY8", 32, 8);
    Owned<GstHarness> harness_;
    GstElement *mux_ = nullptr;
    GstBus *bus_ = nullptr;
};

} // namespace

TEST_F(MuxLosses, whole_sweeps_make_whole_stacks)
{
    start();
    for (uint64_t sweep = 0; sweep < 3; sweep++) {
        push_sweep(sweep, {0, 1, 2, 3});
        const Owned<GstBuffer> stack = pull();
        ASSERT_TRUE(stack);
        EXPECT_EQ(shades_of(info_, stack.get(), planes), shades_of_sweep(sweep, planes));
        EXPECT_EQ(GST_BUFFER_PTS(stack.get()), sweep * planes * frame_duration);
        EXPECT_EQ(GST_BUFFER_DURATION(stack.get()), planes * frame_duration);
        const GstFocalStackMeta *meta = gst_buffer_get_focal_stack_meta(stack.get());
        ASSERT_NE(meta, nullptr);
        EXPECT_EQ(meta->sequence, sweep);
        EXPECT_TRUE(meta->complete);
        GstFocusInfo focus;
        ASSERT_TRUE(gst_focal_stack_meta_get_focus(meta, 2, &focus));
        EXPECT_EQ(focus.sweep, sweep);
        EXPECT_EQ(focus.plane, 2u);
        EXPECT_DOUBLE_EQ(focus.power, 3.0);
        EXPECT_EQ(focus.frame_id, sweep * planes + 2);
    }
    expect_count("frames", 12);
    expect_count("stacks", 3);
    EXPECT_EQ(count_messages(bus_, GST_MESSAGE_QOS), 0u);
}

TEST_F(MuxLosses, lost_frame_drops_one_stack)
{
    start();
    push_sweep(0, {0, 1, 2, 3});
    push_sweep(1, {0, 1, 3});
    push_sweep(2, {0, 1, 2, 3});
    expect_stack(shades_of_sweep(0, planes));
    expect_stack(shades_of_sweep(2, planes));
    expect_no_stack();
    expect_count("lost", 1);
    expect_count("dropped-stacks", 1);
    EXPECT_EQ(count_messages(bus_, GST_MESSAGE_QOS), 1u);
}

TEST_F(MuxLosses, the_stack_after_a_lost_one_is_discontinuous)
{
    start();
    push_sweep(0, {0, 1, 2, 3});
    push_sweep(1, {0, 1, 2, 3});
    push_sweep(2, {0});
    push_sweep(3, {0, 1, 2, 3});
    EXPECT_TRUE(GST_BUFFER_IS_DISCONT(pull().get()));
    EXPECT_FALSE(GST_BUFFER_IS_DISCONT(pull().get()));
    const Owned<GstBuffer> after = pull();
    EXPECT_TRUE(GST_BUFFER_IS_DISCONT(after.get()));
    EXPECT_EQ(gst_buffer_get_focal_stack_meta(after.get())->sequence, 2u);
}

TEST_F(MuxLosses, lost_sweeps_are_counted_and_reported)
{
    start();
    push_sweep(0, {0, 1, 2, 3});
    push_sweep(3, {0, 1, 2, 3});
    expect_count("lost", 2 * planes);
    expect_count("dropped-stacks", 2);
    expect_count("stacks", 2);
    EXPECT_EQ(count_messages(bus_, GST_MESSAGE_QOS), 2u);
}

TEST_F(MuxLosses, hold_takes_the_plane_of_the_last_stack)
{
    start("focalstackmux on-missing=hold");
    push_sweep(0, {0, 1, 2, 3});
    push_sweep(1, {0, 1, 3});
    push_sweep(2, {0, 1, 2, 3});
    expect_stack(shades_of_sweep(0, planes));

    const Owned<GstBuffer> filled = pull();
    ASSERT_TRUE(filled);
    EXPECT_EQ(shades_of(info_, filled.get(), planes),
              (std::vector{shade(1, 0), shade(1, 1), shade(0, 2), shade(1, 3)}));
    const GstFocalStackMeta *meta = gst_buffer_get_focal_stack_meta(filled.get());
    EXPECT_FALSE(meta->complete);
    EXPECT_EQ(meta->missing, 0b0100u);
    EXPECT_EQ(meta->repeated, 0b0100u);
    GstFocusInfo focus;
    gst_focal_stack_meta_get_focus(meta, 2, &focus);
    EXPECT_EQ(focus.sweep, 0u);
    EXPECT_EQ(GST_BUFFER_PTS(filled.get()), planes * frame_duration);

    expect_stack(shades_of_sweep(2, planes));
    expect_count("dropped-stacks", 0);
    expect_count("lost", 1);
}

TEST_F(MuxLosses, hold_has_nothing_to_hold_in_the_first_sweep)
{
    start("focalstackmux on-missing=hold");
    push_sweep(0, {1, 2, 3});
    push_sweep(1, {0, 1, 2, 3});
    expect_stack(shades_of_sweep(1, planes));
    expect_count("dropped-stacks", 1);
}

TEST_F(MuxLosses, repeat_takes_the_neighbouring_plane)
{
    start("focalstackmux on-missing=repeat");
    push_sweep(0, {0, 1, 2, 3});
    push_sweep(1, {1, 2});
    push_sweep(2, {0, 1, 2, 3});
    expect_stack(shades_of_sweep(0, planes));

    const Owned<GstBuffer> filled = pull();
    ASSERT_TRUE(filled);
    EXPECT_EQ(shades_of(info_, filled.get(), planes),
              (std::vector{shade(1, 1), shade(1, 1), shade(1, 2), shade(1, 2)}));
    const GstFocalStackMeta *meta = gst_buffer_get_focal_stack_meta(filled.get());
    EXPECT_EQ(meta->repeated, 0b1001u);
    GstFocusInfo focus;
    gst_focal_stack_meta_get_focus(meta, 3, &focus);
    EXPECT_EQ(focus.plane, 3u);
    EXPECT_DOUBLE_EQ(focus.power, 2.0) << "the powers still fall from plane to plane";
    EXPECT_EQ(focus.frame_id, planes + 2u) << "the frame that is shown";
    EXPECT_EQ(GST_BUFFER_PTS(filled.get()), (planes + 1) * frame_duration);
}

TEST_F(MuxLosses, repeat_in_the_first_sweep_has_the_power_that_the_others_make_plain)
{
    for (unsigned lost = 0; lost < planes; lost++) {
        SCOPED_TRACE(lost);
        start("focalstackmux on-missing=repeat");
        for (unsigned z = 0; z < planes; z++)
            if (z != lost)
                push(0, z);
        push_sweep(1, {0, 1, 2, 3});
        const Owned<GstBuffer> filled = pull();
        ASSERT_TRUE(filled);
        GstFocusInfo focus;
        for (unsigned z = 0; z < planes; z++) {
            gst_focal_stack_meta_get_focus(gst_buffer_get_focal_stack_meta(filled.get()), z, &focus);
            EXPECT_NEAR(focus.power, 5.0 - z, 1e-9);
        }
        TearDown();
    }
    start();
}

TEST_F(MuxLosses, a_plane_that_never_comes_is_named_once)
{
    start();
    for (uint64_t sweep = 0; sweep < 60; sweep++)
        push_sweep(sweep, {0, 1, 3});
    const std::string text = warning();
    EXPECT_NE(text.find("No stack"), std::string::npos) << text;
    EXPECT_NE(text.find("never come: 2."), std::string::npos) << text;
    EXPECT_EQ(warning(), "");
}

TEST_F(MuxLosses, a_sweep_number_that_stands_still_is_told)
{
    start();
    for (unsigned i = 0; i < 100; i++)
        push_sweep(7, {0, 1});
    const std::string text = warning();
    EXPECT_NE(text.find("the same planes of the same sweep"), std::string::npos) << text;
}

TEST_F(MuxLosses, rows_without_their_gap_are_named_as_such)
{
    start();
    gst_harness_set_src_caps_str(harness_.get(), frame_caps("RGB", 30, 8).c_str());
    for (unsigned z = 0; z < planes; z++) {
        GstBuffer *tight = new_frame(info_, 0, z, planes);
        gst_buffer_remove_all_memory(tight);
        gst_buffer_append_memory(tight, gst_allocator_alloc(nullptr, 90 * 8, nullptr));
        EXPECT_EQ(gst_harness_push(harness_.get(), tight), GST_FLOW_OK);
    }
    const std::string text = warning();
    for (const char *part : {"720 bytes", "736", "rows of 90 bytes", "multiple of 4, 92 bytes"})
        EXPECT_NE(text.find(part), std::string::npos) << text;
    EXPECT_EQ(warning(), "") << "once";
    expect_count("damaged", 4);
}

TEST_F(MuxLosses, late_frame_of_last_sweep_still_fits)
{
    start();
    push_sweep(0, {0, 1, 2});
    push_sweep(1, {0, 1});
    push(0, 3);
    push_sweep(1, {2, 3});
    expect_stack(shades_of_sweep(0, planes));
    expect_stack(shades_of_sweep(1, planes));
    expect_count("reordered", 1);
    expect_count("late", 0);
    EXPECT_EQ(count_messages(bus_, GST_MESSAGE_QOS), 0u);
}

TEST_F(MuxLosses, frame_that_comes_too_late_is_left_out)
{
    start();
    push_sweep(0, {0, 1, 2});
    push_sweep(1, {0, 1, 2});
    push(0, 3);
    push(1, 3);
    expect_stack(shades_of_sweep(1, planes));
    expect_no_stack();
    expect_count("late", 1);
    expect_count("lost", 1);
    EXPECT_EQ(count_messages(bus_, GST_MESSAGE_QOS), 2u);
}

TEST_F(MuxLosses, reordered_frames_make_whole_stacks)
{
    start();
    push_sweep(0, {1, 0, 3, 2});
    push_sweep(1, {3, 2, 1, 0});
    expect_stack(shades_of_sweep(0, planes));
    expect_stack(shades_of_sweep(1, planes));
    expect_count("reordered", 2);
}

TEST_F(MuxLosses, a_frame_that_comes_twice_is_used_once)
{
    start();
    push_sweep(0, {0, 1, 1, 2, 3});
    expect_stack(shades_of_sweep(0, planes));
    expect_count("repeated", 1);
    expect_count("lost", 0);
}

TEST_F(MuxLosses, a_camera_that_starts_anew_is_followed)
{
    start();
    push_sweep(100, {0, 1, 2, 3});
    expect_stack(shades_of_sweep(100, planes));
    for (uint64_t sweep = 0; sweep < 6; sweep++)
        push_sweep(sweep, {0, 1, 2, 3});
    expect_stack(shades_of_sweep(4, planes));
    expect_stack(shades_of_sweep(5, planes));
}

TEST_F(MuxLosses, end_in_mid_sweep_drops_the_rest_and_says_so)
{
    start();
    push_sweep(0, {0, 1, 2, 3});
    push_sweep(1, {0, 1});
    end();
    expect_stack(shades_of_sweep(0, planes));
    expect_no_stack();
    expect_count("lost", 2);
    EXPECT_EQ(count_messages(bus_, GST_MESSAGE_WARNING), 1u);
}

TEST_F(MuxLosses, end_in_mid_sweep_fills_the_rest)
{
    start("focalstackmux on-missing=repeat");
    push_sweep(0, {0, 1});
    end();
    expect_stack({shade(0, 0), shade(0, 1), shade(0, 1), shade(0, 1)});
    EXPECT_EQ(count_messages(bus_, GST_MESSAGE_WARNING), 1u);
}

TEST_F(MuxLosses, a_short_frame_costs_its_stack_only)
{
    start();
    push_sweep(0, {0, 1, 2});
    GstBuffer *truncated = new_frame(info_, 0, 3, planes);
    gst_buffer_set_size(truncated, 100);
    EXPECT_EQ(gst_harness_push(harness_.get(), truncated), GST_FLOW_OK);
    push_sweep(1, {0, 1, 2, 3});
    expect_stack(shades_of_sweep(1, planes));
    expect_count("damaged", 1);
    expect_count("lost", 1);
    EXPECT_EQ(count_messages(bus_, GST_MESSAGE_WARNING), 1u);
}

TEST_F(MuxLosses, a_plane_beyond_the_sweep_is_left_out)
{
    start();
    push_sweep(0, {0, 1, 2, 9, 3});
    expect_stack(shades_of_sweep(0, planes));
    expect_count("damaged", 1);
}

TEST_F(MuxLosses, rolling_sends_a_stack_at_every_frame)
{
    start("focalstackmux window=rolling");
    push_sweep(0, {0, 1, 2});
    expect_no_stack();
    push(0, 3);
    expect_stack(shades_of_sweep(0, planes));
    push(1, 0);

    const Owned<GstBuffer> rolled = pull();
    ASSERT_TRUE(rolled);
    EXPECT_EQ(shades_of(info_, rolled.get(), planes),
              (std::vector{shade(1, 0), shade(0, 1), shade(0, 2), shade(0, 3)}));
    EXPECT_EQ(GST_BUFFER_PTS(rolled.get()), frame_duration);
    EXPECT_EQ(GST_BUFFER_DURATION(rolled.get()), planes * frame_duration);
    EXPECT_EQ(gst_buffer_get_focal_stack_meta(rolled.get())->sequence, 1u);

    g_autoptr(GstCaps) caps = gst_pad_get_current_caps(harness_->sinkpad);
    GstFocalStackInfo info;
    ASSERT_TRUE(gst_focal_stack_info_from_caps(&info, caps));
    EXPECT_EQ(GST_VIDEO_INFO_FPS_N(&info.frame), 120 * GST_VIDEO_INFO_FPS_D(&info.frame));
}

TEST_F(MuxLosses, rolling_drops_stacks_until_the_lost_plane_is_there_again)
{
    start("focalstackmux window=rolling");
    push_sweep(0, {0, 1, 2, 3});
    push_sweep(1, {0, 2, 3});
    push_sweep(2, {0, 1});
    expect_stack(shades_of_sweep(0, planes));
    expect_stack({shade(1, 0), shade(0, 1), shade(0, 2), shade(0, 3)});
    expect_stack({shade(2, 0), shade(2, 1), shade(1, 2), shade(1, 3)});
    expect_no_stack();
    expect_count("dropped-stacks", 3);
    expect_count("lost", 1);
}

TEST_F(MuxLosses, rolling_holds_the_lost_plane)
{
    start("focalstackmux window=rolling on-missing=hold");
    push_sweep(0, {0, 1, 2, 3});
    push_sweep(1, {0, 2});
    pull();
    pull();
    const Owned<GstBuffer> filled = pull();
    ASSERT_TRUE(filled);
    EXPECT_EQ(shades_of(info_, filled.get(), planes),
              (std::vector{shade(1, 0), shade(0, 1), shade(1, 2), shade(0, 3)}));
    EXPECT_EQ(gst_buffer_get_focal_stack_meta(filled.get())->missing, 0b0010u);
}

TEST_F(MuxLosses, rolling_repeats_the_neighbour_of_the_lost_plane)
{
    start("focalstackmux window=rolling on-missing=repeat");
    push_sweep(0, {0, 1, 2, 3});
    push_sweep(1, {0, 2});
    pull();
    pull();
    expect_stack({shade(1, 0), shade(1, 0), shade(1, 2), shade(0, 3)});
}
