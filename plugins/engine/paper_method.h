/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/depth_method.h"
#include "engine/depth_parameters.h"
#include "engine/gaussian_blur.h"

namespace dff {

/* Oliva-García 2022, section 2.3: sparse depth from the focus measure, filled in bilateral space. */
class PaperMethod : public DepthMethod {
public:
    PaperMethod(CommandQueue &queue, const StackShape &shape, const DepthParameters &parameters);

    void run(const StackBuffer &stack, DepthCoder &coder, const Wanted &wanted,
             const cl::Buffer &depth) override;

    const cl::Buffer &sparse() const override { return sparse_depth_; }
    const cl::Buffer &confidence() const override { return sparse_.confidence(); }
    const cl::Buffer &motion() const override { return entropy_.moved(); }

private:
    CommandQueue &queue_;
    StackShape shape_;
    bool motion_mask_;
    Luma luma_;
    FocusMeasure focus_;
    ZEntropy entropy_;
    SparseDepth sparse_;
    ReferenceImage reference_;
    BilateralGrid grid_;
    GaussianBlur blur_;
    cl::Buffer sparse_depth_;
};

} // namespace dff
