/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/stack_shape.h"

namespace dff::bench {

/* A stack I420 of a picture with texture in luma and, coarser and fainter, in chroma; vertical bands of it
 * are sharp in one plane after the other and blurred by 2 pixels more a plane elsewhere. */
struct BenchStack {
    BenchStack(uint32_t width, uint32_t height, uint32_t planes);

    /* The same picture in RGBA64. */
    BenchStack in_deep_colour() const;

    StackView view() const { return {shape, memory, layout}; }

    StackShape shape;
    std::vector<RowLayout> layout;
    std::vector<std::byte> memory;
    std::vector<uint8_t> luma; /* of all planes, one after the other */

private:
    explicit BenchStack(const StackShape &shape);
};

} // namespace dff::bench
