/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "board_view.h"

namespace dff {

/* How a plane shows what the middle plane shows: p from the picture's centre goes to S p + d, where S =
 * [cosine -sine; sine cosine]. */
struct PlaneSimilarity {
    double cosine = 1.0, sine = 0.0, dx = 0.0, dy = 0.0;

    cv::Point2d apply(cv::Point2d p) const
    {
        return {cosine * p.x - sine * p.y + dx, sine * p.x + cosine * p.y + dy};
    }
    cv::Point2d undo(cv::Point2d p) const;
    double scale() const { return std::hypot(cosine, sine); }
};

struct PlaneWarps {
    std::vector<PlaneSimilarity> planes;           /* plane N / 2 stays as it is */
    std::vector<std::vector<cv::Point2d>> corners; /* of each view, where the middle plane shows them */
    double residual_px = 0.0;         /* root mean square along x and y, of corners in single planes */
    std::vector<cv::Point2d> offsets; /* of each plane, mean of what the warp leaves */
};

/* Finds the warps that bring the corners of all views together. */
PlaneWarps find_warps(const std::vector<BoardView> &views);

/* What the warps leave of each view: root mean square along x and y, pixels. */
std::vector<double> left_of_views(const std::vector<BoardView> &views, const PlaneWarps &warps);

/* The corners of a view by warps that are known. */
PlaneWarps apply_warps(const std::vector<BoardView> &views, std::vector<PlaneSimilarity> planes);

} // namespace dff
