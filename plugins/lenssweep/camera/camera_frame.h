/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <optional>

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

/* What is known of a frame beside its pixels. */
struct CameraFrame {
    std::uint64_t id = 0;        /* the camera's number */
    std::int64_t camera_ns = 0;  /* of the camera's own clock; 0: it has none */
    std::int64_t arrival_ns = 0; /* when its last byte was here, by the host's CLOCK_MONOTONIC */

    /* The best that says when it was exposed, up to a constant. */
    std::int64_t stamp_ns() const { return camera_ns != 0 ? camera_ns : arrival_ns; }
};

/* When frames were exposed, from when they arrived. Arrivals are jittery and never early; where the camera
 * has a clock, its times with the least delay seen are used. The clocks may drift by 200 ppm. */
class ExposureClock {
public:
    /* Start of the exposure by the host's CLOCK_MONOTONIC. `delay_ns`: from there to the arrival at the
     * least. */
    std::int64_t exposed_ns(const CameraFrame &frame, std::int64_t delay_ns);

private:
    std::optional<std::int64_t> offset_ns_; /* arrival - camera, at the least */
    std::int64_t last_ns_ = 0;
};

} // namespace dff
