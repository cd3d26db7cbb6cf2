/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/scene/disk_kernel.h"

#include <cmath>

namespace dff {

namespace {

constexpr int subpixels = 8;

/* Share of pixel (x, y) that a disk of this radius around (0, 0) covers. */
float coverage(int x, int y, double radius)
{
    int inside = 0;
    for (int j = 0; j < subpixels; j++)
        for (int i = 0; i < subpixels; i++) {
            const double dx = x + (i + 0.5) / subpixels - 0.5;
            const double dy = y + (j + 0.5) / subpixels - 0.5;
            inside += dx * dx + dy * dy <= radius * radius;
        }
    return static_cast<float>(inside) / (subpixels * subpixels);
}

} // namespace

int disk_reach(double diameter)
{
    return diameter < sharp_diameter ? 0 : static_cast<int>(std::ceil(diameter / 2));
}

cv::Mat1f disk_kernel(double diameter)
{
    const int reach = disk_reach(diameter);
    if (reach == 0)
        return {};
    cv::Mat1f kernel(2 * reach + 1, 2 * reach + 1);
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++)
            kernel(y + reach, x + reach) = coverage(x, y, diameter / 2);
    return kernel / cv::sum(kernel)[0];
}

} // namespace dff
