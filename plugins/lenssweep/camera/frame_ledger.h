/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "frame_numbers.h"
#include "plane_labeller.h"

#include <array>
#include <cstdint>
#include <optional>

namespace dff {

/* Follows the numbers of frames, and counts what they tell: frames that were lost, and those that came twice.
 */
class FrameLedger {
public:
    FrameLedger(FrameNumbers numbers, LabelCounts &counts) : numbers_(numbers), counts_(counts) {}

    /* The next number has nothing to do with those before. */
    void restart();

    /* Why a frame can have no label, whatever its time; empty if nothing is wrong with its number. */
    std::optional<Unlabelled> enter(std::uint64_t id);

    /* The sweep is one of those that are dropped; counted once. */
    void drop_sweep(std::uint64_t sweep);
    bool dropped(std::uint64_t sweep) const { return dropped_ == sweep; }

private:
    bool seen(std::uint64_t id) const;

    FrameNumbers numbers_;
    LabelCounts &counts_;
    std::array<std::optional<std::uint64_t>, 64> recent_;
    std::size_t next_ = 0;
    std::optional<std::uint64_t> newest_;
    std::optional<std::uint64_t> dropped_;
};

} // namespace dff
