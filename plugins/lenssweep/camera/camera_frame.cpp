/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "camera_frame.h"

#include <algorithm>

namespace dff {

namespace {

constexpr std::int64_t round_16 = 65535; /* numbers 1 to 65535 */

} // namespace

bool FrameNumbers::valid(std::uint64_t id) const
{
    switch (numbering_) {
    case FrameNumbering::GigE16:
        return id >= 1 && id <= round_16;
    case FrameNumbering::GigE64:
        return id >= 1;
    case FrameNumbering::Usb64:
        break;
    }
    return true;
}

std::int64_t FrameNumbers::steps(std::uint64_t from, std::uint64_t to) const
{
    const auto difference = static_cast<std::int64_t>(to - from);
    if (numbering_ != FrameNumbering::GigE16)
        return difference;
    const std::int64_t forward = (difference % round_16 + round_16) % round_16;
    return forward > round_16 / 2 ? forward - round_16 : forward;
}

bool FrameNumbers::apart(std::uint64_t from, std::uint64_t to, std::int64_t steps) const
{
    const std::int64_t difference = static_cast<std::int64_t>(to - from) - steps;
    return numbering_ == FrameNumbering::GigE16 ? difference % round_16 == 0 : difference == 0;
}

namespace {

constexpr std::int64_t drift_ppm = 200;
constexpr std::int64_t jump_ns = 1'000'000'000;

} // namespace

std::int64_t ExposureClock::exposed_ns(const CameraFrame &frame, std::int64_t delay_ns)
{
    if (frame.camera_ns == 0)
        return frame.arrival_ns - delay_ns;
    const std::int64_t offset_ns = frame.arrival_ns - frame.camera_ns;
    const std::int64_t drift_ns = (frame.arrival_ns - last_ns_) / 1'000'000 * drift_ppm;
    last_ns_ = frame.arrival_ns;
    const bool jumped = offset_ns_ && offset_ns > *offset_ns_ + drift_ns + jump_ns;
    if (offset_ns_ && !jumped)
        offset_ns_ = std::min(*offset_ns_ + drift_ns, offset_ns);
    else
        offset_ns_ = offset_ns;
    return frame.camera_ns + *offset_ns_ - delay_ns;
}

} // namespace dff
