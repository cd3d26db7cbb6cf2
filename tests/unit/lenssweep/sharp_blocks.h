/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <random>
#include <vector>

/* The sharpness that block_sharpness() would tell of a scene whose blocks are sharp at planes of their own,
 * with noise. */
class SharpBlocks {
public:
    SharpBlocks(unsigned planes, double contrast, double noise)
        : planes_(planes), contrast_(contrast), noise_(0, noise)
    {
    }

    /* Seen by a lens that stands at this plane, or between two. */
    std::vector<double> seen_at(double plane)
    {
        constexpr size_t blocks = 100;
        std::vector<double> sharpness(blocks);
        for (size_t block = 0; block < blocks; block++) {
            const double off = plane - planes_ * static_cast<double>(block) / blocks;
            sharpness[block] = contrast_ / (1 + off * off) + noise_(random_);
        }
        return sharpness;
    }

private:
    double planes_;
    double contrast_;
    std::normal_distribution<double> noise_;
    std::mt19937 random_{7};
};
