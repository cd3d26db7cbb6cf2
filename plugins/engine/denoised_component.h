/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/noise_curve.h"
#include "engine/opencl/command_queue.h"

namespace dff {

constexpr uint32_t tile_pixels = 8; /* of StackDenoiser's tiles: their side */

/* One component of all planes, as StackDenoiser sees it: how its tiles look, and what is known of it. */
struct DenoisedComponent {
    /* `tiles` across and down. */
    DenoisedComponent(CommandQueue &queue, const StackShape &shape, const Component &described,
                      cl_int2 tiles);

    uint32_t tile_width() const { return tile_pixels / component.subsampling * component.channels; }
    uint32_t tile_rows() const { return tile_pixels / component.subsampling; }
    size_t mean_bytes() const { return component.sample_bytes == 2 ? sizeof(cl_float) : sizeof(cl_ushort); }

    /* Noise as half of the planes show it at least. */
    NoiseCurve single() const;

    /* A difference between sweeps that is never called motion, as rounding makes it. */
    float least_change() const;

    /* The same means of all planes, elsewhere; what comes in from outside is to be seen anew. */
    void shift(CommandQueue &queue, int right, int down, uint32_t planes);

    Component component;
    cl_int width, height;
    float samples; /* a tile */
    size_t tile_count;
    cl::Kernel measure, judge, count, average;
    cl::Buffer means, tiles, curve, rows;
    cl::Buffer spare;                       /* of the size of `means`, once these were shifted */
    std::vector<TileDifference> host_tiles; /* of the plane that noise is learned from */
    std::vector<RowLayout> host_rows;
    std::vector<NoiseCurve> singles; /* as one picture of each plane shows it */
    NoiseCurve noise{};              /* as it is believed */
    float spread = 1.0F;

private:
    uint32_t lanes() const { return tile_width() % 8 == 0 ? 8 : 4; }
    std::string options() const;
};

} // namespace dff
