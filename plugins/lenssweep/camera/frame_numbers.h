/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>

namespace dff {

enum class FrameNumbering {
    GigE16, /* GigE Vision 1: 16 bits, 65535 is followed by 1 */
    GigE64, /* GigE Vision 2 with extended ids: from 1 */
    Usb64   /* USB3 Vision: from 0 */
};

/* The arithmetic of the numbers that a camera gives to its frames. */
class FrameNumbers {
public:
    explicit FrameNumbers(FrameNumbering numbering) : numbering_(numbering) {}

    /* Whether a camera can have given this number. */
    bool valid(std::uint64_t id) const;

    /* Frames from one number to the other, negative backwards; of 16-bit numbers the shorter way round. */
    std::int64_t steps(std::uint64_t from, std::uint64_t to) const;

    /* Whether `to` is the number `steps` frames after `from`, once round or more included. */
    bool apart(std::uint64_t from, std::uint64_t to, std::int64_t steps) const;

private:
    FrameNumbering numbering_;
};

} // namespace dff
