/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "frame_numbers.h"

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

} // namespace dff
