/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "two_halves.h"

#include "engine/aif_composer.h"
#include "engine/focus_engine.h"

#include <gtest/gtest.h>

namespace dff {

namespace {

/* A board of squares of 5 pixels. */
unsigned board_at(unsigned x, unsigned y)
{
    return (x / 5 + y / 5) % 2 * 200 + 20;
}

/* All samples of a pixel are alike, and so are the bytes of a sample. */
std::vector<std::byte> two_halves(const StackShape &shape, const std::vector<RowLayout> &layout)
{
    const Component component = shape.components().front();
    const size_t pixel_bytes = component.channels * component.sample_bytes;
    std::vector<std::byte> memory(bytes_of(shape), std::byte{120});
    for (unsigned z : {0U, shape.planes - 1})
        for (unsigned y = 0; y < shape.height; y++)
            for (unsigned x = 0; x < shape.width; x++)
                if ((x < shape.width / 2) == (z == 0))
                    std::fill_n(memory.begin() +
                                    static_cast<std::ptrdiff_t>(layout[z].offset + layout[z].stride * y +
                                                                x * pixel_bytes),
                                pixel_bytes, std::byte(board_at(x, y)));
    return memory;
}

} // namespace

void expect_two_halves(const StackShape &shape)
{
    const std::vector<RowLayout> layout = packed_layout(shape);
    const std::vector<std::byte> memory = two_halves(shape, layout);
    const StackView view{shape, memory, layout};
    std::vector<uint16_t> depth(size_t{shape.width} * shape.height);
    {
        FocusEngine engine(Device::open(""), shape, {});
        DepthOutputs outputs;
        outputs.depth = {std::as_writable_bytes(std::span(depth)).data(), shape.width * sizeof(uint16_t)};
        ASSERT_TRUE(engine.compute(view, outputs));
    }
    const unsigned left = shape.width / 8, right = shape.width - shape.width / 8;
    for (const unsigned y : {shape.height / 4, shape.height - shape.height / 4}) {
        EXPECT_LT(depth[size_t{y} * shape.width + left], 6000);
        EXPECT_GT(depth[size_t{y} * shape.width + right], 59000);
    }

    const std::vector<RowLayout> one = packed_layout({shape.format, shape.width, shape.height, 1});
    AifComposer composer(Device::open(""), shape);
    std::vector<std::byte> picture(memory.size() / shape.planes);
    const size_t pixel_bytes = picture.size() / depth.size();
    for (const auto blend : {AifComposer::Blend::Linear, AifComposer::Blend::Sharp}) {
        composer.compose(view, {std::as_bytes(std::span(depth)), shape.width * sizeof(uint16_t)}, blend,
                         picture, one);
        for (const unsigned x : {left, right})
            for (const unsigned y : {shape.height / 2, shape.height - 8})
                EXPECT_NEAR(static_cast<double>(picture[one[0].stride * y + (x + 1) * pixel_bytes - 1]),
                            board_at(x, y), 12.0)
                    << x << "," << y;
    }
}

} // namespace dff
