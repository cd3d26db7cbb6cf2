/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gstcl/depth_facts.h"

#include <cmath>
#include <gtest/gtest.h>
#include <stdexcept>

using namespace dff;

TEST(DepthFacts, auto_is_dioptre_where_powers_are_known)
{
    EXPECT_EQ(make_encoder(GST_DEPTH_UNIT_AUTO, 3, {{3, 2, 1}, {}}).scale().unit, DepthUnit::Dioptre);
    EXPECT_EQ(make_encoder(GST_DEPTH_UNIT_AUTO, 3, {}).scale().unit, DepthUnit::Index);
}

TEST(DepthFacts, powers_out_of_order_are_refused)
{
    EXPECT_THROW(make_encoder(GST_DEPTH_UNIT_DIOPTRE, 3, {{1, 2, 3}, {}}), std::invalid_argument);
    EXPECT_THROW(make_encoder(GST_DEPTH_UNIT_MICROMETRE, 3, {{}, {5, 5, 6}}), std::invalid_argument);
}

TEST(DepthFacts, what_is_written_can_be_read_in_every_unit)
{
    const PlanePositions positions{{5.0, 3.0, 2.5, 1.0}, {0.0, 10.0, 30.0, 35.0}};
    for (const GstDepthUnit unit : {GST_DEPTH_UNIT_INDEX, GST_DEPTH_UNIT_DIOPTRE, GST_DEPTH_UNIT_MILLIMETRE,
                                    GST_DEPTH_UNIT_MICROMETRE}) {
        const DepthEncoder written = make_encoder(unit, 4, positions);
        const DepthEncoder read = encoder_of(depth_info(written, positions), 4, positions);
        for (double z = 0.0; z <= 3.0; z += 0.1)
            EXPECT_NEAR(read.decode(written.encode(z)).value(), z, 0.02);
    }
}

TEST(DepthFacts, a_map_may_reach_beyond_the_planes)
{
    const PlanePositions positions{{4.0, 3.0, 2.0, 1.0}, {}};
    GstDepthInfo depth = depth_info(make_encoder(GST_DEPTH_UNIT_DIOPTRE, 4, positions), positions);
    depth.near = 4.5;
    depth.far = 0.5;
    const DepthEncoder read = encoder_of(depth, 4, positions);
    EXPECT_NEAR(read.decode(1 + 65534 * 2 / 4).value(), 1.5, 1e-3); /* 2.5 dioptres */
    EXPECT_NEAR(read.decode(1).value(), 0.0, 1e-9);
}

TEST(DepthFacts, a_reader_without_powers_takes_the_planes_as_even)
{
    const PlanePositions even{{4.0, 3.0, 2.0, 1.0}, {}};
    const DepthEncoder written = make_encoder(GST_DEPTH_UNIT_DIOPTRE, 4, even);
    const DepthEncoder read = encoder_of(depth_info(written, even), 4, {});
    EXPECT_NEAR(read.decode(written.encode(1.25)).value(), 1.25, 1e-3);
}

TEST(DepthFacts, a_stack_tells_its_planes_only_when_it_knows_all)
{
    gst_init(nullptr, nullptr);
    g_autoptr(GstBuffer) stack = gst_buffer_new();
    g_autoptr(GstCaps) caps =
        gst_caps_from_string("video/x-focal-stack,format=GRAY8,width=64,height=64,planes=2,framerate=1/1");
    GstFocalStackInfo info;
    ASSERT_TRUE(gst_focal_stack_info_from_caps(&info, caps));
    EXPECT_EQ(plane_positions(info, stack), PlanePositions());
    GstFocalStackMeta *meta = gst_buffer_add_focal_stack_meta(stack, 0, 2);
    GstFocusInfo focus;
    gst_focus_info_init(&focus);
    focus.power = 2.0;
    gst_focal_stack_meta_set_focus(meta, 0, &focus);
    EXPECT_TRUE(plane_positions(info, stack).powers.empty());
    focus.power = 1.0;
    gst_focal_stack_meta_set_focus(meta, 1, &focus);
    EXPECT_EQ(plane_positions(info, stack).powers, (std::vector<double>{2.0, 1.0}));
    info.planes = 3;
    EXPECT_THROW(plane_positions(info, stack), std::invalid_argument) << "the caps say otherwise";
    info.planes = 2;
    for (const double power : {HUGE_VAL, -HUGE_VAL, 1e300}) {
        focus.power = power;
        gst_focal_stack_meta_set_focus(meta, 1, &focus);
        EXPECT_THROW(plane_positions(info, stack), std::invalid_argument) << power;
    }
}
