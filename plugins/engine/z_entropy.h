/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/luma.h"

namespace dff {

/* Which pixels moved during the sweep: entropy along z (3) of Oliva-García 2022 over `threshold_bits`. */
class ZEntropy {
public:
    ZEntropy(CommandQueue &queue, const StackShape &shape, float threshold_bits);

    void run(const Luma &luma);

    const cl::Buffer &moved() const { return moved_; } /* uchar[height][width]: 255 = moved */

private:
    CommandQueue &queue_;
    StackShape shape_;
    float threshold_bits_;
    cl::Kernel kernel_;
    cl::Buffer moved_;
};

} // namespace dff
