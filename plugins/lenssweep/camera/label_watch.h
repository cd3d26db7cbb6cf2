/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "plane_labeller.h"

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <utility>

namespace dff {

/* Notices when frames come and labels stay away, and says it once for each cause: a stream that only counts
 * what it drops looks like one that hangs. */
class LabelWatch {
public:
    explicit LabelWatch(unsigned planes) : planes_(planes) {}

    /* A frame and its verdict, with the number of sweeps that were dropped until then. */
    void judged(const FrameVerdict &verdict, std::uint64_t dropped_sweeps);

    /* What the user should know; empty if it was told already. */
    std::string take_complaint() { return std::exchange(complaint_, {}); }

private:
    void labelled(const FrameLabel &label);
    void complain(const std::string &what);
    Unlabelled main_reason() const;

    unsigned planes_;
    std::array<unsigned, unlabelled_reasons> reasons_{}; /* of frames since the last whole sweep */
    unsigned unlabelled_in_row_ = 0;
    std::uint64_t dropped_sweeps_ = 0;
    unsigned dropped_in_row_ = 0; /* with no whole sweep between them */
    std::uint64_t sweep_ = 0;     /* of the last label */
    unsigned labels_ = 0;         /* in it */
    std::set<Unlabelled> told_;
    std::string complaint_;
};

} // namespace dff
