/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <opencv2/core/utility.hpp>

namespace dff {

/* work(i) for each i below `count`, on all processors. No two of them may touch the same. */
template <typename Work> void in_parallel(size_t count, const Work &work)
{
    cv::parallel_for_(cv::Range(0, static_cast<int>(count)), [&](const cv::Range &range) {
        for (int i = range.start; i < range.end; i++)
            work(static_cast<unsigned>(i));
    });
}

} // namespace dff
