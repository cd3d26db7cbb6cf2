/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/denoise_strips.h"

#include "engine/denoised_component.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dff {

namespace {

constexpr cl_int strip_rows = 23;    /* a sixth of 1080 pixels: enough work-items for a few cores */
constexpr size_t brightnesses = 256; /* BRIGHTNESSES of the kernels */
constexpr cl_int shares_ahead = 16;  /* SHARES of the kernels */
constexpr cl_short new_scene = -1;   /* NEW_SCENE of the kernels */
constexpr size_t most_sweeps = 255;

std::string build_options(const std::vector<Component> &components)
{
    std::string options = "-DCOMPONENTS=" + std::to_string(components.size());
    for (size_t c = 0; c < components.size(); c++) {
        const std::string suffix = std::to_string(c) + "=";
        const uint32_t rows = tile_pixels / components[c].subsampling;
        options += " -DTILE" + suffix + std::to_string(rows * components[c].channels);
        options += " -DROWS" + suffix + std::to_string(rows);
    }
    return options;
}

} // namespace

bool DenoiseStrips::suits(const Device &device, const StackShape &shape)
{
    const auto components = shape.components();
    return device.kernel_style() == KernelStyle::Tiles &&
           std::all_of(components.begin(), components.end(),
                       [](const Component &c) { return c.sample_bytes == 1; });
}

DenoiseStrips::DenoiseStrips(CommandQueue &queue, const StackShape &shape, std::vector<DenoisedPart> parts,
                             cl_int2 tiles)
    : queue_(queue), shape_(shape), parts_(std::move(parts)), tiles_(tiles),
      strip_(std::min(strip_rows, tiles.s[1])), part_stride_(0)
{
    const auto components = shape.components();
    for (const Component &c : components) {
        const auto tile = static_cast<cl_int>(tile_pixels / c.subsampling * c.channels);
        part_stride_ = std::max(part_stride_, tiles.s[0] * tile);
    }
    const auto strips = static_cast<size_t>((tiles.s[1] + strip_ - 1) / strip_);
    part_stride_ += tiles.s[0] + shares_ahead;
    near_ = queue.allocate(strips * static_cast<size_t>(tiles.s[0]));
    room_ = queue.allocate(strips * static_cast<size_t>(part_stride_) * sizeof(cl_short));
    most_ = queue.allocate(components.size() * brightnesses * sizeof(cl_float2));
    host_most_.resize(components.size() * brightnesses);

    const Program program(queue.device(), "denoise_strips", build_options(components));
    measure_ = program.kernel("measure_rows");
    judge_ = program.kernel("judge_borders");
    denoise_ = program.kernel("denoise_strips");

    std::vector<cl_float2> of_sweeps(most_sweeps + 1);
    std::vector<cl_short> of_shares(most_sweeps + 1);
    for (size_t k = 0; k < of_sweeps.size(); k++) {
        const float variances = 1.0F + 1.0F / std::max(static_cast<float>(k), 1.0F);
        of_sweeps[k] = {{std::sqrt(variances), variances}};
        if (k == 0) /* what was never seen did not move */
            of_sweeps[k] = {{std::numeric_limits<float>::max(), std::numeric_limits<float>::max()}};
        const size_t share = k < 2 ? 0 : (32768 + k / 2) / k;
        of_shares[k] = k == 1 ? new_scene : static_cast<cl_short>(share);
    }
    of_sweeps_ = queue.allocate(of_sweeps.size() * sizeof(cl_float2));
    of_shares_ = queue.allocate(of_shares.size() * sizeof(cl_short));
    queue.commands().enqueueWriteBuffer(of_sweeps_, CL_TRUE, 0, of_sweeps.size() * sizeof(cl_float2),
                                        of_sweeps.data());
    queue.commands().enqueueWriteBuffer(of_shares_, CL_TRUE, 0, of_shares.size() * sizeof(cl_short),
                                        of_shares.data());
}

/* The arguments that all kernels begin with; gives the next one's place. */
cl_uint DenoiseStrips::set_parts(cl::Kernel &kernel, const cl::Buffer &bytes) const
{
    cl_uint place = 0;
    kernel.setArg(place++, bytes);
    const auto components = shape_.components();
    for (size_t c = 0; c < components.size(); c++) {
        const cl_int2 size = {
            {static_cast<cl_int>(components[c].width), static_cast<cl_int>(components[c].height)}};
        kernel.setArg(place++, parts_[c].rows);
        kernel.setArg(place++, parts_[c].means);
        kernel.setArg(place++, size);
    }
    return place;
}

void DenoiseStrips::measure(const cl::Buffer &bytes, uint32_t z, uint32_t step,
                            const std::vector<cl::Buffer> &tiles)
{
    cl_uint place = set_parts(measure_, bytes);
    for (const cl::Buffer &of_component : tiles)
        measure_.setArg(place++, of_component);
    measure_.setArg(place++, tiles_);
    measure_.setArg(place++, static_cast<cl_int>(z));
    measure_.setArg(place++, static_cast<cl_int>(step));
    queue_.run_groups(measure_, {(static_cast<size_t>(tiles_.s[1]) + step - 1) / step});
}

template <typename... Arguments>
void DenoiseStrips::run_strips(cl::Kernel &kernel, const cl::Buffer &bytes, const Arguments &...arguments)
{
    cl_uint place = set_parts(kernel, bytes);
    (kernel.setArg(place++, arguments), ...);
    queue_.run_groups(kernel, {static_cast<size_t>((tiles_.s[1] + strip_ - 1) / strip_)});
}

void DenoiseStrips::upload(const std::vector<NoiseBounds> &bounds)
{
    auto next = host_most_.begin();
    for (const NoiseBounds &of : bounds)
        for (size_t i = 0; i < brightnesses; i++) {
            const float variance = variance_at(of.curve, static_cast<float>(i) + 0.5F);
            *next++ = {{most_mean(of.samples, of.spread, of.sigmas) * std::sqrt(variance),
                        most_square(of.samples, of.spread, of.sigmas) * variance}};
        }
    queue_.commands().enqueueWriteBuffer(most_, CL_FALSE, 0, host_most_.size() * sizeof(cl_float2),
                                         host_most_.data());
}

void DenoiseStrips::run(const cl::Buffer &bytes, const cl::Buffer &moved, const cl::Buffer &held,
                        const cl::Buffer &sweeps, const std::vector<NoiseBounds> &bounds, float least,
                        uint32_t frames, uint64_t wanted, uint64_t absent)
{
    upload(bounds);
    const auto planes = static_cast<cl_int>(shape_.planes);
    run_strips(judge_, bytes, sweeps, most_, of_sweeps_, moved, held, tiles_, planes, strip_, least,
               static_cast<cl_ulong>(wanted));
    run_strips(denoise_, bytes, sweeps, most_, of_sweeps_, of_shares_, moved, near_, room_, part_stride_,
               held, tiles_, planes, strip_, least, static_cast<cl_int>(frames),
               static_cast<cl_ulong>(wanted), static_cast<cl_ulong>(absent));
}

} // namespace dff
