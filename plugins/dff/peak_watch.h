/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace dff {

/* Looks now and then whether any pixel is sharper in one plane than in the others. Where none is, nobody
 * moved the focus, and the depth says nothing, however full the map is. */
class PeakWatch {
public:
    /* Counts a stack. The first one is to be looked at, and every so many after it. */
    bool is_due() { return stacks_++ % period == 0; }

    /* Room for the confidence of a stack that nobody else asks for. */
    std::span<std::byte> room(size_t pixels)
    {
        room_.resize(pixels);
        return room_;
    }

    /* Rows of `width` bytes, 255 c, that follow each other after `stride` bytes. */
    static bool has_peaks(const std::byte *confidence, size_t stride, size_t width, size_t height);

private:
    static constexpr uint64_t period = 32;

    uint64_t stacks_ = 0;
    std::vector<std::byte> room_;
};

} // namespace dff
