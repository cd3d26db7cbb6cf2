/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/stack_denoiser.h"

#include "engine/opencl/program.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace dff {

namespace {

constexpr uint32_t tile_pixels = 8;
constexpr float sigmas_of_noise = 6.0F;  /* that a tile may be off, of strength 1 */
constexpr float memory_of_noise = 0.8F;  /* share of the curve that stays from stack to stack */
constexpr float most_over_single = 4.0F; /* noise between sweeps has at most this many times the variance that
                                            one picture shows: more is motion */

/* Of 256 brightnesses: differences between sweeps that are never called motion, as rounding makes them. */
constexpr float least_change = 0.3F;

} // namespace

/* One component of all planes: how its tiles look, and what is known of it. */
struct StackDenoiser::ComponentState {
    ComponentState(CommandQueue &queue, const StackShape &shape, const Component &described, cl_int2 tiles)
        : component(described), width(static_cast<cl_int>(described.width)),
          height(static_cast<cl_int>(described.height)),
          samples(static_cast<float>(tile_width() * tile_rows())),
          tile_count(size_t{shape.planes} * static_cast<size_t>(tiles.s[0]) *
                     static_cast<size_t>(tiles.s[1])),
          means(queue.allocate(size_t{shape.planes} * described.width * described.height *
                               (described.sample_bytes == 2 ? sizeof(cl_float) : sizeof(cl_ushort)))),
          tiles(queue.allocate(tile_count * sizeof(TileDifference))),
          curve(queue.allocate(sizeof(NoiseCurve))), rows(queue.allocate(shape.planes * sizeof(RowLayout))),
          singles(shape.planes)
    {
        const Program program(queue.device(), "stack_denoise", options());
        measure = program.kernel("measure_tiles");
        judge = program.kernel("judge_tiles");
        count = program.kernel("count_sweeps");
        average = program.kernel("average_tiles");
    }

    uint32_t tile_width() const { return tile_pixels / component.subsampling * component.channels; }
    uint32_t tile_rows() const { return tile_pixels / component.subsampling; }
    uint32_t lanes() const { return tile_width() % 8 == 0 ? 8 : 4; }
    /* As half of the planes show it at least. */
    NoiseCurve single() const
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
    float least() const { return component.sample_bytes == 2 ? least_change * 256.0F : least_change; }

    std::string options() const
    {
        return "-DSAMPLE_BYTES=" + std::to_string(component.sample_bytes) +
               " -DLANES=" + std::to_string(lanes()) + " -DCHUNKS=" + std::to_string(tile_width() / lanes()) +
               " -DROWS=" + std::to_string(tile_rows());
    }

    Component component;
    cl_int width, height;
    float samples; /* a tile */
    size_t tile_count;
    cl::Kernel measure, judge, count, average;
    cl::Buffer means, tiles, curve, rows;
    std::vector<RowLayout> host_rows;
    std::vector<NoiseCurve> singles; /* as one picture of each plane shows it */
    NoiseCurve noise{};              /* as it is believed */
    float spread = 1.0F;
};

StackDenoiser::StackDenoiser(std::shared_ptr<Device> device, const StackShape &shape)
    : device_(std::move(device)), queue_(device_),
      shape_(shape), tiles_{{static_cast<cl_int>((shape.width + tile_pixels - 1) / tile_pixels),
                             static_cast<cl_int>((shape.height + tile_pixels - 1) / tile_pixels)}},
      run_(device_->kernel_style() == KernelStyle::Tiles ? tiles_.s[0] : 1), bytes_(queue_)
{
    translate_errors(*device_, [this] {
        const auto components = shape_.components();
        const size_t tiles =
            size_t{shape_.planes} * static_cast<size_t>(tiles_.s[0]) * static_cast<size_t>(tiles_.s[1]);
        moved_ = queue_.allocate(tiles);
        sweeps_ = queue_.allocate(tiles);
        for (const Component &component : components)
            components_.push_back(std::make_shared<ComponentState>(queue_, shape_, component, tiles_));
    });
}

void StackDenoiser::denoise(const StackView &view, std::span<std::byte> memory, uint64_t absent,
                            const DenoiseParameters &parameters)
{
    const uint64_t all = ~uint64_t{0} >> (64 - shape_.planes);
    const uint64_t changed = has_means_ ? tracker_.changed(view) : all;
    tracker_.remember(view);
    translate_errors(*device_, [&] {
        queue_.begin_stage("denoise");
        if (has_means_)
            look_at_noise(view, learned_plane_);
        else
            begin(view);
        upload(view, memory);
        measure();
        if (has_means_)
            learn_noise();
        judge(parameters);
        average(parameters, changed & ~absent, absent);
        bytes_.download(memory);
        times_ = queue_.finish();
    });
    learned_plane_ = (learned_plane_ + 1) % shape_.planes;
    has_means_ = true;
}

void StackDenoiser::begin(const StackView &view)
{
    queue_.commands().enqueueFillBuffer(sweeps_, cl_uchar{0}, 0, tiles_a_plane() * shape_.planes);
    for (const auto &part : components_)
        queue_.commands().enqueueFillBuffer(part->means, cl_ushort{0}, 0, part->means.getInfo<CL_MEM_SIZE>());
    for (uint32_t z = 0; z < shape_.planes; z++)
        look_at_noise(view, z);
    for (const auto &part : components_)
        part->noise = part->single();
    has_learned_ = false;
}

void StackDenoiser::look_at_noise(const StackView &view, uint32_t z)
{
    for (size_t i = 0; i < components_.size(); i++)
        components_[i]->singles[z] = noise_of_plane(view, i, z);
}

void StackDenoiser::upload(const StackView &view, std::span<std::byte> memory)
{
    const cl::Buffer &bytes = bytes_.target(memory);
    if (!device_->works_in_place())
        queue_.commands().enqueueWriteBuffer(bytes, CL_FALSE, 0, view.memory.size(), view.memory.data());
    for (size_t i = 0; i < components_.size(); i++) {
        ComponentState &part = *components_[i];
        const auto first = view.layout.begin() + static_cast<std::ptrdiff_t>(i * shape_.planes);
        std::vector<RowLayout> rows(first, first + shape_.planes);
        if (rows == part.host_rows)
            continue;
        part.host_rows = std::move(rows);
        queue_.commands().enqueueWriteBuffer(part.rows, CL_TRUE, 0, shape_.planes * sizeof(RowLayout),
                                             part.host_rows.data());
    }
}

/* A row of tiles a work-item on CPUs, a tile elsewhere. */
template <typename... Arguments>
void StackDenoiser::run_tiles(cl::Kernel &kernel, const Arguments &...arguments)
{
    const cl::NDRange size(static_cast<size_t>((tiles_.s[0] + run_ - 1) / run_),
                           static_cast<size_t>(tiles_.s[1]), shape_.planes);
    if (device_->kernel_style() == KernelStyle::Tiles)
        queue_.run_groups(kernel, size, arguments...);
    else
        queue_.run(kernel, size, arguments...);
}

void StackDenoiser::measure()
{
    for (const auto &part : components_)
        run_tiles(part->measure, bytes_.buffer(), part->rows, part->means, part->tiles, part->width,
                  part->height, tiles_, run_);
}

void StackDenoiser::judge(const DenoiseParameters &parameters)
{
    const cl::NDRange size(static_cast<size_t>(tiles_.s[0]), static_cast<size_t>(tiles_.s[1]), shape_.planes);
    cl_int is_first = 1;
    for (const auto &part : components_) {
        queue_.commands().enqueueWriteBuffer(part->curve, CL_FALSE, 0, sizeof(NoiseCurve),
                                             part->noise.data());
        queue_.run(part->judge, size, part->tiles, sweeps_, part->curve, moved_, tiles_, part->samples,
                   part->spread, sigmas_of_noise * parameters.strength, part->least(), is_first);
        is_first = 0;
    }
}

void StackDenoiser::average(const DenoiseParameters &parameters, uint64_t wanted, uint64_t absent)
{
    const cl::NDRange size(static_cast<size_t>(tiles_.s[0]), static_cast<size_t>(tiles_.s[1]), shape_.planes);
    queue_.run(components_.front()->count, size, moved_, sweeps_, tiles_,
               static_cast<cl_int>(parameters.frames), static_cast<cl_ulong>(wanted));
    for (const auto &part : components_)
        run_tiles(part->average, bytes_.buffer(), part->rows, part->means, sweeps_, part->width, part->height,
                  tiles_, run_, static_cast<cl_ulong>(wanted), static_cast<cl_ulong>(absent));
}

/* From the tiles of one plane, which are waited for. */
void StackDenoiser::learn_noise()
{
    const size_t count = tiles_a_plane(), first = count * learned_plane_;
    std::vector<uint8_t> sweeps(count);
    queue_.commands().enqueueReadBuffer(sweeps_, CL_TRUE, first, count, sweeps.data());
    std::vector<TileDifference> tiles(count);
    for (const auto &part : components_) {
        queue_.commands().enqueueReadBuffer(part->tiles, CL_TRUE, first * sizeof(TileDifference),
                                            count * sizeof(TileDifference), tiles.data());
        const auto between = noise_of_tiles(tiles, sweeps, part->component, part->samples);
        if (!between)
            continue;
        const NoiseCurve single = part->single();
        const float kept = has_learned_ ? memory_of_noise : 0.0F;
        for (size_t i = 0; i < single.size(); i++)
            part->noise[i] =
                std::lerp(std::min((*between)[i], most_over_single * single[i]), part->noise[i], kept);
        part->spread = std::lerp(spread_of_tiles(tiles, part->samples), part->spread, kept);
    }
    has_learned_ = true;
}

DenoiseReport StackDenoiser::report()
{
    DenoiseReport report;
    for (const auto &part : components_) {
        report.noise.push_back(part->noise);
        report.spread.push_back(part->spread);
    }
    report.sample_unit = shape_.format == PixelFormat::Gray16 ? 1.0 / 256.0 : 1.0;
    std::vector<uint8_t> sweeps(tiles_a_plane() * shape_.planes);
    if (has_means_)
        queue_.commands().enqueueReadBuffer(sweeps_, CL_TRUE, 0, sweeps.size(), sweeps.data());
    report.mean_sweeps =
        std::accumulate(sweeps.begin(), sweeps.end(), 0.0) / static_cast<double>(sweeps.size());
    return report;
}

} // namespace dff
