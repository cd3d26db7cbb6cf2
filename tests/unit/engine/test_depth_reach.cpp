/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/aif_composer.h"
#include "engine/depth_reach.h"
#include "twin_volume.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace dff;

namespace {

/* Squares of several depths, sizes that are no multiples of a block. */
std::vector<uint16_t> depth_of_squares(const StackShape &shape)
{
    const DepthEncoder encoder = DepthEncoder::index(shape.planes);
    std::vector<uint16_t> depth;
    for (unsigned y = 0; y < shape.height; y++)
        for (unsigned x = 0; x < shape.width; x++)
            depth.push_back(x % 37 == 5 ? 0 : encoder.encode((x / 23 + y / 31) * 7 % shape.planes + 0.25));
    return depth;
}

} // namespace

TEST(DepthReach, agrees_with_its_twin)
{
    struct Case {
        StackShape shape;
        float blur_step;
        unsigned block;
    };
    const StackShape small{PixelFormat::Gray8, 131, 97, 9}, large{PixelFormat::Gray8, 1003, 602, 6};
    for (const auto &[shape, blur_step, block] :
         {Case{small, 3.5f, 2}, {small, 9.0f, 2}, {small, 40.0f, 2}, {large, 9.0f, 4}}) {
        const std::vector<uint16_t> depth = depth_of_squares(shape);
        CommandQueue queue(Device::open(""));
        const cl::Buffer on_device = queue.allocate(depth.size() * sizeof(uint16_t));
        queue.commands().enqueueWriteBuffer(on_device, CL_TRUE, 0, depth.size() * sizeof(uint16_t),
                                            depth.data());
        DepthReach reach(queue, shape);
        const auto found =
            read_back<uint16_t>(queue, reach.run(on_device, shape.width, blur_step), depth.size());
        const auto expected =
            twin::limit_depth(depth, shape.width, shape.height, block, blur_step, shape.planes);
        EXPECT_NE(expected, depth);
        for (size_t i = 0; i < depth.size(); i++)
            ASSERT_NEAR(found[i], expected[i], 4)
                << i % shape.width << "," << i / shape.width << " blur " << blur_step;
    }
}

/* A near square before a far ground, both blank but for their edge: in the far plane the square's blur lies
 * on the ground around it. */
TEST(DepthReach, a_picture_shows_less_of_a_halo_where_planes_lie_far_apart)
{
    const StackShape shape{PixelFormat::Gray8, 192, 160, 6};
    TestStack stack(shape);
    std::vector<uint16_t> depth;
    const DepthEncoder encoder = DepthEncoder::index(shape.planes);
    constexpr int blur = 6; /* pixels a plane */
    const auto is_square = [](int x, int y) { return x >= 60 && x < 120 && y >= 50 && y < 110; };
    for (int y = 0; y < 160; y++)
        for (int x = 0; x < 192; x++) {
            depth.push_back(encoder.encode(is_square(x, y) ? 0.0 : 5.0));
            for (int z = 0; z < 6; z++) {
                const int radius = blur * z / 2;
                int inside = 0;
                for (int j = -radius; j <= radius; j++)
                    for (int i = -radius; i <= radius; i++)
                        inside += is_square(x + i, y + j);
                stack.memory[stack.layout[z].offset + stack.layout[z].stride * y + x] =
                    static_cast<std::byte>(40 + 180 * inside / ((2 * radius + 1) * (2 * radius + 1)));
            }
        }
    const auto worst = [&](AifComposer::Blend blend, float blur_step) {
        AifComposer composer(Device::open(""), shape);
        std::vector<std::byte> picture(stack.memory.size() / shape.planes);
        composer.compose(stack.view(), {std::as_bytes(std::span(depth)), 192 * 2, blur_step}, blend, picture,
                         packed_layout({shape.format, 192, 160, 1}));
        int most = 0;
        const RowLayout rows = packed_layout({shape.format, 192, 160, 1})[0];
        for (int y = 8; y < 152; y++)
            for (int x = 8; x < 184; x++)
                if (!is_square(x - 3, y) && !is_square(x + 3, y) && !is_square(x, y - 3) &&
                    !is_square(x, y + 3))
                    most = std::max(most, static_cast<int>(picture[rows.offset + rows.stride * y + x]) - 40);
        return most;
    };
    for (const auto blend : {AifComposer::Blend::Linear, AifComposer::Blend::Sharp})
        EXPECT_LT(worst(blend, blur), 0.7 * worst(blend, 0.0f));
}
