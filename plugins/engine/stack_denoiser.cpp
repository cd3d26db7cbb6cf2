/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/stack_denoiser.h"

#include "engine/denoised_component.h"
#include "engine/luma.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace dff {

namespace {

constexpr float sigmas_of_noise = 6.0F; /* that a tile may be off, of strength 1 */
constexpr unsigned mean_unit = 128;     /* of samples of 8 bits: MEAN_UNIT of the kernels */
constexpr uint32_t enough_tiles = 8000; /* of one plane, to learn the noise from */
constexpr float memory_of_noise = 0.8F; /* share of the curve that stays from stack to stack */
constexpr uint32_t settled = 32;        /* stacks after which noise is learned from one in `seldom` */
constexpr uint32_t seldom = 4;
constexpr float most_alike = 0.2F; /* samples of a tile, of all, that say the same: more is motion of all */
constexpr float late_memory = memory_of_noise * memory_of_noise * memory_of_noise * memory_of_noise;
constexpr float most_over_single = 4.0F; /* noise between sweeps has at most this many times the variance that
                                            one picture shows: more is motion */

/* Those that differ by what noise explains: a tile that moved tells nothing of how alike noise is. */
std::vector<TileDifference> quiet_tiles(std::span<const TileDifference> tiles,
                                        std::span<const uint8_t> sweeps, const NoiseCurve &noise,
                                        uint32_t sample_bytes)
{
    constexpr float most = 1.5F; /* of the variance */
    const float unit = sample_bytes == 2 ? 256.0F : 1.0F;
    std::vector<TileDifference> quiet;
    for (size_t i = 0; i < tiles.size(); i++) {
        const float variance = variance_at(noise, tiles[i].brightness / unit) *
                               (1.0F + 1.0F / std::max(static_cast<float>(sweeps[i]), 1.0F));
        if (tiles[i].square < most * variance)
            quiet.push_back(tiles[i]);
    }
    return quiet;
}

/* Noise of luma, of that of a component's samples: interleaved colours are noisy by themselves. */
double luma_part(PixelFormat format)
{
    return is_interleaved(format) ? std::hypot(0.299, 0.587, 0.114) : 1.0;
}

/* Samples of 8 bits, or of 16, rounded from their means. */
void to_samples(std::span<const cl_ushort> means, uint32_t sample_bytes, std::vector<std::byte> &samples)
{
    samples.resize(means.size());
    if (sample_bytes == 1) {
        for (size_t i = 0; i < means.size(); i++)
            samples[i] = static_cast<std::byte>((means[i] + mean_unit / 2) / mean_unit);
        return;
    }
    for (size_t i = 0; i < means.size() / 2; i++) {
        cl_float mean = 0.0F;
        std::memcpy(&mean, means.data() + 2 * i, sizeof mean);
        const auto value = static_cast<uint16_t>(std::lround(mean));
        std::memcpy(samples.data() + 2 * i, &value, sizeof value);
    }
}

} // namespace

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
        held_ = queue_.allocate(tiles);
        host_sweeps_.resize(tiles);
        for (const Component &component : components)
            components_.push_back(std::make_shared<DenoisedComponent>(queue_, shape_, component, tiles_));
        if (DenoiseStrips::suits(*device_, shape_))
            make_strips();
    });
}

void StackDenoiser::make_strips()
{
    std::vector<DenoisedPart> parts;
    for (const auto &part : components_)
        parts.push_back({part->rows, part->means});
    strips_.emplace(queue_, shape_, std::move(parts), tiles_);
}

void StackDenoiser::denoise(const StackView &view, std::span<std::byte> memory, uint64_t absent,
                            const DenoiseParameters &parameters, std::span<const uint8_t> held)
{
    const uint64_t all = ~uint64_t{0} >> (64 - shape_.planes);
    const uint64_t changed = has_means_ ? tracker_.changed(view) : all;
    tracker_.remember(view);
    learns_ = !has_means_ || stacks_ < settled || stacks_ % seldom == 0;
    if (learns_)
        learned_plane_ = ((has_means_ ? learned_plane_ : 0) + 1) % shape_.planes;
    translate_errors(*device_, [&] {
        queue_.begin_stage("denoise");
        if (!has_means_)
            begin(view);
        else if (learns_)
            look_at_noise(view, learned_plane_);
        upload(view, memory);
        hold(held);
        if (strips_)
            run_strips(parameters, changed & ~absent, absent);
        else
            run_tiles(parameters, changed & ~absent, absent);
        bytes_.download(memory);
        queue_.commands().enqueueReadBuffer(sweeps_, CL_FALSE, 0, host_sweeps_.size(), host_sweeps_.data());
        times_ = queue_.finish();
    });
    if (has_means_)
        tell_noise_left(parameters.frames);
    stacks_++;
    has_means_ = true;
}

void StackDenoiser::begin(const StackView &view)
{
    queue_.commands().enqueueFillBuffer(sweeps_, cl_uchar{0}, 0, tiles_a_plane() * shape_.planes);
    for (const auto &part : components_)
        queue_.commands().enqueueFillBuffer(part->means, cl_ushort{0}, 0, part->means.getInfo<CL_MEM_SIZE>());
    for (uint32_t z = 0; z < shape_.planes; z++)
        look_at_noise(view, z);
    for (const auto &part : components_) {
        part->noise = part->single();
        part->spread = 1.0F;
    }
    has_learned_ = false;
    stacks_ = 0;
    kept_sweeps_ = 1;
    kept_variance_ = 1.0;
    left_.reset();
}

void StackDenoiser::hold(std::span<const uint8_t> held)
{
    if (!held.empty())
        queue_.commands().enqueueWriteBuffer(held_, CL_TRUE, 0, held.size(), held.data());
    else if (holds_)
        queue_.commands().enqueueFillBuffer(held_, cl_uchar{0}, 0, tiles_a_plane() * shape_.planes);
    holds_ = !held.empty();
}

/* All parts are read at once: a round trip to the device costs more than a part. */
void StackDenoiser::background(std::span<BackgroundPart> parts)
{
    std::vector<std::vector<cl_ushort>> means(parts.size()); /* or two a cl_float */
    translate_errors(*device_, [&] {
        for (size_t i = 0; i < parts.size(); i++) {
            const BackgroundPart &part = parts[i];
            const DenoisedComponent &of = *components_[part.component];
            const size_t size = of.mean_bytes();
            means[i].resize(size_t{part.width} * part.height * size / sizeof(cl_ushort));
            if (means[i].empty())
                continue;
            queue_.commands().enqueueReadBufferRect(
                of.means, CL_FALSE, {part.x * size, part.y + size_t{part.z} * of.component.height, 0},
                {0, 0, 0}, {part.width * size, part.height, 1}, of.component.width * size, 0,
                part.width * size, 0, means[i].data());
        }
        queue_.commands().finish();
    });
    for (size_t i = 0; i < parts.size(); i++)
        to_samples(means[i], components_[parts[i].component]->component.sample_bytes, parts[i].samples);
}

void StackDenoiser::shift(int right, int down)
{
    if (!has_means_ || (right == 0 && down == 0))
        return;
    if (std::abs(right) >= static_cast<int>(shape_.width) ||
        std::abs(down) >= static_cast<int>(shape_.height)) {
        forget();
        return;
    }
    translate_errors(*device_, [&] {
        for (size_t i = 0; i < components_.size(); i++) {
            components_[i]->shift(queue_, right, down, shape_.planes);
            if (strips_)
                strips_->set_means(i, components_[i]->means);
        }
        shift_sweeps(right, down);
        queue_.commands().enqueueWriteBuffer(sweeps_, CL_TRUE, 0, host_sweeps_.size(), host_sweeps_.data());
    });
}

/* A tile is the mean of as many sweeps as all tiles of which it shows a part. */
void StackDenoiser::shift_sweeps(int right, int down)
{
    const int across = tiles_.s[0], rows = tiles_.s[1], side = static_cast<int>(tile_pixels);
    const auto first_of = [](int at) { return at >= 0 ? at / side : -((side - 1 - at) / side); };
    const std::vector<uint8_t> before = std::move(host_sweeps_);
    host_sweeps_.resize(before.size());
    auto next = host_sweeps_.begin();
    for (auto plane = before.begin(); plane != before.end(); plane += across * rows)
        for (int ty = 0; ty < rows; ty++)
            for (int tx = 0; tx < across; tx++) {
                const int left = tx * side + right, top = ty * side + down;
                const int x0 = first_of(left), x1 = first_of(left + side - 1);
                const int y0 = first_of(top), y1 = first_of(top + side - 1);
                if (x0 < 0 || y0 < 0 || x1 >= across || y1 >= rows)
                    *next++ = 0;
                else
                    *next++ = std::min({plane[y0 * across + x0], plane[y0 * across + x1],
                                        plane[y1 * across + x0], plane[y1 * across + x1]});
            }
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
        DenoisedComponent &part = *components_[i];
        const auto first = view.layout.begin() + static_cast<std::ptrdiff_t>(i * shape_.planes);
        std::vector<RowLayout> rows(first, first + shape_.planes);
        if (rows == part.host_rows)
            continue;
        part.host_rows = std::move(rows);
        queue_.commands().enqueueWriteBuffer(part.rows, CL_TRUE, 0, shape_.planes * sizeof(RowLayout),
                                             part.host_rows.data());
    }
}

void StackDenoiser::run_strips(const DenoiseParameters &parameters, uint64_t wanted, uint64_t absent)
{
    if (has_means_ && learns_) {
        std::vector<cl::Buffer> tiles;
        for (const auto &part : components_)
            tiles.push_back(part->tiles);
        strips_->measure(bytes_.buffer(), learned_plane_, learned_step(), tiles);
        learn_noise();
    }
    std::vector<NoiseBounds> bounds;
    for (const auto &part : components_)
        bounds.push_back({part->noise, part->spread, part->samples, sigmas_of_noise * parameters.strength});
    strips_->run(bytes_.buffer(), moved_, held_, sweeps_, bounds, components_.front()->least_change(),
                 parameters.frames, wanted, absent);
}

void StackDenoiser::run_tiles(const DenoiseParameters &parameters, uint64_t wanted, uint64_t absent)
{
    measure();
    if (has_means_ && learns_)
        learn_noise();
    judge(parameters);
    average(parameters, wanted, absent);
}

/* A row of tiles a work-item on CPUs, a tile elsewhere. */
template <typename... Arguments>
void StackDenoiser::enqueue_tiles(cl::Kernel &kernel, const Arguments &...arguments)
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
        enqueue_tiles(part->measure, bytes_.buffer(), part->rows, part->means, part->tiles, part->width,
                      part->height, tiles_, run_);
}

void StackDenoiser::judge(const DenoiseParameters &parameters)
{
    const cl::NDRange size(static_cast<size_t>(tiles_.s[0]), static_cast<size_t>(tiles_.s[1]), shape_.planes);
    const float sigmas = sigmas_of_noise * parameters.strength;
    cl_int is_first = 1;
    for (const auto &part : components_) {
        queue_.commands().enqueueWriteBuffer(part->curve, CL_FALSE, 0, sizeof(NoiseCurve),
                                             part->noise.data());
        queue_.run(part->judge, size, part->tiles, sweeps_, part->curve, moved_, tiles_,
                   most_mean(part->samples, part->spread, sigmas),
                   most_square(part->samples, part->spread, sigmas), part->least_change(), is_first);
        is_first = 0;
    }
}

void StackDenoiser::average(const DenoiseParameters &parameters, uint64_t wanted, uint64_t absent)
{
    const cl::NDRange size(static_cast<size_t>(tiles_.s[0]), static_cast<size_t>(tiles_.s[1]), shape_.planes);
    queue_.run(components_.front()->count, size, moved_, held_, sweeps_, tiles_,
               static_cast<cl_int>(parameters.frames), static_cast<cl_ulong>(wanted));
    for (const auto &part : components_)
        enqueue_tiles(part->average, bytes_.buffer(), part->rows, part->means, held_, sweeps_, part->width,
                      part->height, tiles_, run_, static_cast<cl_ulong>(wanted),
                      static_cast<cl_ulong>(absent));
}

/* Rows of tiles that are looked at: every so many. */
uint32_t StackDenoiser::learned_step() const
{
    return std::max(static_cast<uint32_t>(tiles_a_plane()) / enough_tiles, 1U);
}

/* The tiles of one plane; waits for them. */
void StackDenoiser::read_tiles()
{
    const size_t across = static_cast<size_t>(tiles_.s[0]), down = static_cast<size_t>(tiles_.s[1]);
    const size_t step = strips_ ? learned_step() : 1, rows = (down + step - 1) / step;
    const size_t first = strips_ ? 0 : tiles_a_plane() * learned_plane_;
    for (const auto &part : components_) {
        part->host_tiles.resize(rows * across);
        queue_.commands().enqueueReadBuffer(part->tiles, CL_FALSE, first * sizeof(TileDifference),
                                            part->host_tiles.size() * sizeof(TileDifference),
                                            part->host_tiles.data());
    }
    queue_.commands().finish();
}

/* What each of them was the mean of when the last stack was done. */
std::vector<uint8_t> StackDenoiser::learned_sweeps() const
{
    const size_t across = static_cast<size_t>(tiles_.s[0]);
    const size_t step = strips_ ? learned_step() : 1;
    const auto plane = std::span(host_sweeps_).subspan(tiles_a_plane() * learned_plane_, tiles_a_plane());
    std::vector<uint8_t> sweeps;
    for (size_t first = 0; first < plane.size(); first += step * across)
        sweeps.insert(sweeps.end(), plane.begin() + static_cast<std::ptrdiff_t>(first),
                      plane.begin() + static_cast<std::ptrdiff_t>(first + across));
    return sweeps;
}

/* The camera pans, the light is switched, the scene was cut: what differs then differs alike over whole
 * tiles, as noise does not. */
bool StackDenoiser::all_moved() const
{
    const DenoisedComponent &first = *components_.front();
    return spread_of_tiles(first.host_tiles, first.samples) > most_alike * first.samples;
}

void StackDenoiser::learn_noise()
{
    read_tiles();
    const std::vector<uint8_t> sweeps = learned_sweeps();
    if (all_moved())
        return;
    for (const auto &part : components_) {
        const auto between = noise_of_tiles(part->host_tiles, sweeps, part->component, part->samples);
        if (!between)
            continue;
        const NoiseCurve single = part->single();
        const float kept = !has_learned_ ? 0.0F : stacks_ < settled ? memory_of_noise : late_memory;
        for (size_t i = 0; i < single.size(); i++)
            part->noise[i] =
                std::lerp(std::min((*between)[i], most_over_single * single[i]), part->noise[i], kept);
        const auto quiet = quiet_tiles(part->host_tiles, sweeps, part->noise, part->component.sample_bytes);
        if (quiet.size() * 10 >= part->host_tiles.size())
            part->spread = std::lerp(spread_of_tiles(quiet, part->samples), part->spread, kept);
    }
    has_learned_ = true;
}

/* The mean m <- m + (x - m) / k of k sweeps has 1 / k of their variance; where k has come to its most and
 * stays there, less and less, down to 1 / (2 k - 1). Of the plane that was learned from. */
void StackDenoiser::tell_noise_left(uint32_t frames)
{
    const std::vector<uint8_t> sweeps = learned_sweeps();
    const DenoisedComponent &luma = *components_.front();
    kept_sweeps_ = std::min(kept_sweeps_ + 1, frames);
    const double share = 1.0 / kept_sweeps_;
    kept_variance_ = (1.0 - share) * (1.0 - share) * kept_variance_ + share * share;

    const double unit = luma.component.sample_bytes == 2 ? 256.0 : 1.0;
    std::vector<double> variances;
    for (size_t i = 0; i < luma.host_tiles.size(); i++) {
        const uint32_t k = std::clamp<uint32_t>(sweeps[i], 1U, frames);
        const double part = k < frames ? 1.0 / k : std::min(kept_variance_, share);
        const auto brightness = static_cast<float>(luma.host_tiles[i].brightness / unit);
        variances.push_back(part * static_cast<double>(variance_at(luma.noise, brightness)));
    }
    const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
    std::nth_element(variances.begin(), middle, variances.end());
    const double rounding = luma.component.sample_bytes == 2 ? 0.0 : 1.0 / 12.0;
    left_ = luma_part(shape_.format) * std::sqrt(*middle + rounding) / unit;
}

DenoiseReport StackDenoiser::report() const
{
    DenoiseReport report;
    for (const auto &part : components_) {
        report.noise.push_back(part->noise);
        report.spread.push_back(part->spread);
    }
    report.left = left_;
    report.sample_unit = sample_bytes(shape_.format) == 2 ? 1.0 / 256.0 : 1.0;
    const auto sum = std::accumulate(host_sweeps_.begin(), host_sweeps_.end(), uint64_t{0});
    report.mean_sweeps = static_cast<double>(sum) / static_cast<double>(host_sweeps_.size());
    return report;
}

} // namespace dff
