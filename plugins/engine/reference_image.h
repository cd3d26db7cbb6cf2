/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/luma.h"

namespace dff {

/* The reference R = mean_z I (6) of Oliva-García 2022 in YUV of 8 bits, at full resolution. */
class ReferenceImage {
public:
    /* Chroma is computed only `with_chroma`, and neutral for gray formats. */
    ReferenceImage(CommandQueue &queue, const StackShape &shape, bool with_chroma);

    void run(const StackBuffer &stack, const Luma &luma);

    const cl::Buffer &y() const { return y_; } /* uchar[height][width] each */
    const cl::Buffer &u() const { return u_; }
    const cl::Buffer &v() const { return v_; }

private:
    void run_chroma(const StackBuffer &stack);

    CommandQueue &queue_;
    StackShape shape_;
    bool with_chroma_;
    cl::Kernel mean_luma_, mean_chroma_, mean_chroma_of_colours_;
    cl::Buffer y_, u_, v_;
};

} // namespace dff
