/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/cpu/depth_slice.h"
#include "engine/cpu/focus_tiles.h"
#include "engine/depth_method.h"
#include "engine/depth_parameters.h"

namespace dff {

/* PaperMethod for CPUs: its stages fused and in lanes of integers; what that changes stands in kernels/cpu.
 * Parts pixels by luma only, sigma_chroma must be 0. */
class CpuPaperMethod : public DepthMethod {
public:
    CpuPaperMethod(CommandQueue &queue, const StackShape &shape, const DepthParameters &parameters);

    void run(const StackBuffer &stack, DepthCoder &coder, const Wanted &wanted,
             const cl::Buffer &depth) override;

    const cl::Buffer &sparse() const override { return sparse_depth_; }
    const cl::Buffer &confidence() const override { return focus_.confidence(); }
    const cl::Buffer &motion() const override { return focus_.moved(); }
    const cl::Buffer *residual() const override { return &grid_.residual_norm(); }

private:
    CommandQueue &queue_;
    StackShape shape_;
    bool motion_mask_;
    LumaPlanes luma_;
    FocusTiles focus_;
    LumaGrid grid_;
    DepthSlice slice_;
    cl::Buffer sparse_depth_;
};

} // namespace dff
