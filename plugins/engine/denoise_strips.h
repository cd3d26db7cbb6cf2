/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/noise_curve.h"
#include "engine/opencl/command_queue.h"
#include "engine/opencl/program.h"

namespace dff {

/* One component of all planes on the device. */
struct DenoisedPart {
    cl::Buffer rows;  /* RowLayout a plane */
    cl::Buffer means; /* of its samples */
};

/* How much a tile of one component may change by noise: from the curve, how alike neighbouring samples are,
 * the samples of a tile, and how many standard deviations noise may reach. */
struct NoiseBounds {
    NoiseCurve curve;
    float spread;
    float samples;
    float sigmas;
};

/* The whole of StackDenoiser's work on CPUs, for samples of 8 bits: kernels/cpu/denoise_strips.cl. */
class DenoiseStrips {
public:
    static bool suits(const Device &device, const StackShape &shape);

    /* `parts` are the components, `tiles` how many there are across and down. */
    DenoiseStrips(CommandQueue &queue, const StackShape &shape, std::vector<DenoisedPart> parts,
                  cl_int2 tiles);

    /* Of a component that has others from now on. */
    void set_means(size_t component, const cl::Buffer &means) { parts_[component].means = means; }

    /* Writes every step-th row of tiles of plane z to tiles[component]. */
    void measure(const cl::Buffer &bytes, uint32_t z, uint32_t step, const std::vector<cl::Buffer> &tiles);

    /* Denoises in place. The bits of `wanted` and `absent` are planes, as of stack_denoise.cl; bounds of each
     * component. */
    void run(const cl::Buffer &bytes, const cl::Buffer &moved, const cl::Buffer &held,
             const cl::Buffer &sweeps, const std::vector<NoiseBounds> &bounds, float least, uint32_t frames,
             uint64_t wanted, uint64_t absent);

private:
    cl_uint set_parts(cl::Kernel &kernel, const cl::Buffer &bytes) const;
    template <typename... Arguments>
    void run_strips(cl::Kernel &kernel, const cl::Buffer &bytes, const Arguments &...arguments);
    void upload(const std::vector<NoiseBounds> &bounds);

    CommandQueue &queue_;
    StackShape shape_;
    std::vector<DenoisedPart> parts_;
    cl_int2 tiles_;
    cl_int strip_;       /* rows of tiles a work-item */
    cl_int part_stride_; /* of room_: shares of a row of tiles, and of its samples at most */
    cl::Kernel measure_, judge_, denoise_;
    cl::Buffer near_, room_, most_, of_sweeps_, of_shares_;
    std::vector<cl_float2> host_most_;
};

} // namespace dff
