/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/denoised_component.h"

#include "engine/opencl/program.h"

#include <algorithm>

namespace dff {

DenoisedComponent::DenoisedComponent(CommandQueue &queue, const StackShape &shape, const Component &described,
                                     cl_int2 tiles)
    : component(described), width(static_cast<cl_int>(described.width)),
      height(static_cast<cl_int>(described.height)), samples(static_cast<float>(tile_width() * tile_rows())),
      tile_count(size_t{shape.planes} * static_cast<size_t>(tiles.s[0]) * static_cast<size_t>(tiles.s[1])),
      means(queue.allocate(size_t{shape.planes} * described.width * described.height * mean_bytes())),
      tiles(queue.allocate(tile_count * sizeof(TileDifference))), curve(queue.allocate(sizeof(NoiseCurve))),
      rows(queue.allocate(shape.planes * sizeof(RowLayout))), singles(shape.planes)
{
    const Program program(queue.device(), "stack_denoise", options());
    measure = program.kernel("measure_tiles");
    judge = program.kernel("judge_tiles");
    count = program.kernel("count_sweeps");
    average = program.kernel("average_tiles");
}

NoiseCurve DenoisedComponent::single() const
{
    NoiseCurve median{};
    std::vector<float> values(singles.size());
    for (size_t i = 0; i < median.size(); i++) {
        std::transform(singles.begin(), singles.end(), values.begin(),
                       [i](const NoiseCurve &c) { return c[i]; });
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        median[i] = *middle;
    }
    return median;
}

float DenoisedComponent::least_change() const
{
    constexpr float least = 0.3F; /* of 256 */
    return component.sample_bytes == 2 ? least * 256.0F : least;
}

void DenoisedComponent::shift(CommandQueue &queue, int right, int down, uint32_t planes)
{
    const auto bytes = means.getInfo<CL_MEM_SIZE>();
    if (!spare()) {
        spare = queue.allocate(bytes);
        queue.commands().enqueueFillBuffer(spare, cl_ushort{0}, 0, bytes);
    }
    const auto divisor = static_cast<int>(component.subsampling);
    const int x = right / divisor * static_cast<int>(component.channels), y = down / divisor;
    const auto part = [](int of) { return static_cast<size_t>(std::max(of, 0)); };
    const size_t row = component.width * mean_bytes(), plane = row * component.height;
    queue.commands().enqueueCopyBufferRect(
        means, spare, {part(x) * mean_bytes(), part(y), 0}, {part(-x) * mean_bytes(), part(-y), 0},
        {row - static_cast<size_t>(std::abs(x)) * mean_bytes(), part(height - std::abs(y)), planes}, row,
        plane, row, plane);
    std::swap(means, spare);
}

std::string DenoisedComponent::options() const
{
    return "-DSAMPLE_BYTES=" + std::to_string(component.sample_bytes) +
           " -DLANES=" + std::to_string(lanes()) + " -DCHUNKS=" + std::to_string(tile_width() / lanes()) +
           " -DROWS=" + std::to_string(tile_rows());
}

} // namespace dff
