/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/steady_depth.h"

#include "engine/cell_sums.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <future>
#include <system_error>

namespace dff {

namespace {

constexpr uint32_t cell_pixels = 4, tile_cells = 2;
constexpr uint8_t most_stacks = 16; /* that are averaged */
constexpr uint8_t enough_jumps = 4; /* stacks that a pixel must be elsewhere before it is believed */
constexpr uint32_t settled = 32;    /* stacks after which noise is learned from one in `seldom` */
constexpr uint32_t seldom = 4;
constexpr float sigmas = 6.0F;           /* that a tile may be off by noise */
constexpr float most_over_single = 4.0F; /* times the variance that one picture shows */
constexpr float least_change = 0.05F;    /* mean square that is never called motion, white is 256 */

/* Sums of `channels` times 4 x 4 neighbouring samples of a row of cells. */
template <typename Sample>
void sum_cells(const std::byte *first_row, size_t stride, const Component &component,
               std::vector<uint32_t> &columns, std::span<float> cells)
{
    std::fill(columns.begin(), columns.end(), 0U);
    for (uint32_t i = 0; i < cell_pixels; i++) {
        const auto *row = reinterpret_cast<const Sample *>(first_row + i * stride);
        for (size_t x = 0; x < columns.size(); x++)
            columns[x] += row[x];
    }
    const size_t width = size_t{cell_pixels} * component.channels;
    const float scale = 1.0F / static_cast<float>(width * cell_pixels);
    for (size_t x = 0; x < cells.size(); x++) {
        uint32_t sum = 0;
        for (size_t i = 0; i < width; i++)
            sum += columns[x * width + i];
        cells[x] = static_cast<float>(sum) * scale;
    }
}

/* lround() keeps compilers from doing eight at once. */
inline uint16_t rounded(float value)
{
    constexpr float half = 0.5F;
    return static_cast<uint16_t>(static_cast<int>(value + half));
}

/* Two threads at once, each with half of the rows. */
void in_halves(uint32_t rows, const std::function<void(uint32_t, uint32_t)> &work)
{
    std::future<void> second;
    try {
        second = std::async(std::launch::async, [&] { work(rows / 2, rows); });
    } catch (const std::system_error &) { /* no thread is to be had */
        work(rows / 2, rows);
    }
    work(0, rows / 2);
    if (second.valid())
        second.get();
}

} // namespace

/* What a thread needs to take a row of cells. */
struct SteadyDepth::Room {
    explicit Room(const SteadyDepth &of)
        : columns(size_t{of.cells_across_} * cell_pixels * of.component_.channels), plain(of.cells_across_)
    {
    }

    std::vector<uint32_t> columns;
    CellSums<cell_pixels> plain;
};

SteadyDepth::SteadyDepth(const StackShape &shape)
    : shape_(shape), component_(shape.components().front()), cells_across_(shape.width / cell_pixels),
      cells_down_(shape.height / cell_pixels), tiles_across_(cells_across_ / tile_cells),
      tiles_down_(cells_down_ / tile_cells),
      samples_(static_cast<float>(tile_cells * tile_cells * shape.planes)),
      cells_(size_t{cells_across_} * cells_down_ * shape.planes), means_(cells_.size()),
      tiles_(size_t{tiles_across_} * tiles_down_), sweeps_(tiles_.size()), moved_(tiles_.size()),
      depth_(size_t{shape.width} * shape.height), stacks_(depth_.size()), jumped_(depth_.size()),
      singles_(shape.planes)
{
}

/* A row of cells of plane z. */
void SteadyDepth::take_cells(const StackView &stack, uint32_t z, uint32_t y, Room &room)
{
    const RowLayout &rows = stack.layout[z];
    const std::byte *first = stack.memory.data() + rows.offset + size_t{y} * cell_pixels * rows.stride;
    const std::span<float> cells(cells_.data() + (size_t{z} * cells_down_ + y) * cells_across_,
                                 cells_across_);
    if (component_.sample_bytes == 2)
        sum_cells<uint16_t>(first, rows.stride, component_, room.columns, cells);
    else if (component_.channels > 1)
        sum_cells<uint8_t>(first, rows.stride, component_, room.columns, cells);
    else {
        constexpr float scale = 1.0F / (cell_pixels * cell_pixels);
        const std::span<const int32_t> sums = room.plain.of(first, rows.stride);
        std::transform(sums.begin(), sums.end(), cells.begin(),
                       [](int32_t sum) { return static_cast<float>(sum) * scale; });
    }
}

/* Adds to a row of tiles how much a row of their cells differs from the mean of the stacks before. */
void SteadyDepth::add_differences(size_t first_cell, std::span<float> squares,
                                  std::span<float> brightness) const
{
    const float share = 1.0F / samples_;
    const float *cells = cells_.data() + first_cell, *means = means_.data() + first_cell;
    for (size_t tx = 0; tx < squares.size(); tx++) {
        float square = squares[tx], light = brightness[tx];
        for (size_t i = tx * tile_cells; i < (tx + 1) * tile_cells; i++) {
            const float difference = cells[i] - means[i];
            square += difference * difference * share;
            light += means[i] * share;
        }
        squares[tx] = square;
        brightness[tx] = light;
    }
}

/* How each tile of these rows of them differs from the mean of the stacks before, over all planes. */
void SteadyDepth::compare(const StackView &stack, uint32_t first_row, uint32_t end)
{
    Room room(*this);
    std::vector<float> squares(size_t{end - first_row} * tiles_across_), brightness(squares.size());
    for (uint32_t z = 0; z < shape_.planes; z++)
        for (uint32_t y = first_row * tile_cells; y < end * tile_cells; y++) {
            const size_t tiles = size_t{y / tile_cells - first_row} * tiles_across_;
            take_cells(stack, z, y, room);
            add_differences((size_t{z} * cells_down_ + y) * cells_across_,
                            std::span(squares).subspan(tiles, tiles_across_),
                            std::span(brightness).subspan(tiles, tiles_across_));
        }
    const auto first = tiles_.begin() + static_cast<std::ptrdiff_t>(size_t{first_row} * tiles_across_);
    std::transform(squares.begin(), squares.end(), brightness.begin(), first, [](float square, float light) {
        return TileDifference{0.0F, square, light, 0.0F};
    });
}

/* By the tiles that differ least, but no more than one picture shows: else it is motion. */
void SteadyDepth::learn_noise(const StackView &stack)
{
    singles_[looked_at_] = noise_of_plane(stack, 0, looked_at_);
    looked_at_ = (looked_at_ + 1) % shape_.planes;
    const auto between = noise_of_tiles(tiles_, sweeps_, component_, samples_);
    if (!between)
        return;
    const auto pixels = static_cast<float>(cell_pixels * cell_pixels);
    for (size_t i = 0; i < noise_.size(); i++) {
        float single = 0.0F;
        for (const NoiseCurve &of : singles_)
            single = std::max(single, of[i]);
        noise_[i] = std::min((*between)[i], most_over_single * single / pixels);
    }
}

void SteadyDepth::judge()
{
    const float unit = component_.sample_bytes == 2 ? 256.0F : 1.0F;
    const float most = 1.0F + sigmas * std::sqrt(2.0F / samples_);
    std::vector<uint8_t> changed(tiles_.size());
    for (size_t i = 0; i < tiles_.size(); i++) {
        const float variance = variance_at(noise_, tiles_[i].brightness / unit) *
                               (1.0F + 1.0F / std::max(static_cast<float>(sweeps_[i]), 1.0F));
        changed[i] = tiles_[i].square > variance * most + least_change * unit * unit;
    }
    /* And the tiles around: those above and below, then those of them beside. */
    std::vector<uint8_t> near(size_t{tiles_across_} + 2);
    for (uint32_t ty = 0; ty < tiles_down_; ty++) {
        const uint8_t *here = changed.data() + size_t{ty} * tiles_across_;
        const uint8_t *above = ty > 0 ? here - tiles_across_ : here;
        const uint8_t *below = ty + 1 < tiles_down_ ? here + tiles_across_ : here;
        for (size_t tx = 0; tx < tiles_across_; tx++)
            near[tx + 1] = above[tx] | here[tx] | below[tx];
        for (size_t tx = 0; tx < tiles_across_; tx++)
            moved_[size_t{ty} * tiles_across_ + tx] = is_new_ | near[tx] | near[tx + 1] | near[tx + 2];
    }
}

/* The means of these rows of tiles go on with this stack, or begin anew. */
void SteadyDepth::follow(uint32_t first_row, uint32_t end)
{
    for (size_t i = size_t{first_row} * tiles_across_; i < size_t{end} * tiles_across_; i++)
        sweeps_[i] = moved_[i] ? uint8_t{1} : std::min<uint8_t>(sweeps_[i] + 1, most_stacks);
    std::vector<float> shares(cells_across_);
    for (uint32_t y = first_row * tile_cells; y < end * tile_cells; y++) {
        const uint8_t *sweeps = sweeps_.data() + size_t{y / tile_cells} * tiles_across_;
        for (uint32_t x = 0; x < tiles_across_ * tile_cells; x++) {
            const uint32_t tx = x / tile_cells;
            shares[x] = 1.0F / static_cast<float>(sweeps[tx]);
        }
        for (uint32_t z = 0; z < shape_.planes; z++) {
            float *means = means_.data() + (size_t{z} * cells_down_ + y) * cells_across_;
            const float *cells = cells_.data() + (size_t{z} * cells_down_ + y) * cells_across_;
            for (uint32_t x = 0; x < tiles_across_ * tile_cells; x++)
                means[x] += (cells[x] - means[x]) * shares[x];
        }
    }
}

/* A pixel where something is out of the ordinary. */
void SteadyDepth::average_pixel(uint16_t &depth, size_t i, bool is_moved, const DepthJumps &jumps)
{
    const auto now = static_cast<float>(depth);
    float &mean = depth_[i];
    const bool jumps_now = std::fabs(now - mean) > static_cast<float>(jumps[depth >> 8]);
    jumped_[i] = static_cast<uint8_t>(jumps_now ? jumped_[i] + 1 : 0);
    if (is_moved || depth == 0 || mean < 1.0F || jumped_[i] >= enough_jumps) {
        mean = now;
        stacks_[i] = 1;
        jumped_[i] = 0;
    } else if (!jumps_now) {
        stacks_[i] = std::min<uint8_t>(stacks_[i] + 1, most_stacks);
        mean += (now - mean) / static_cast<float>(stacks_[i]);
    }
    depth = rounded(mean);
}

/* Eight pixels of a row at once, where all of them go on as they did; else false. */
bool SteadyDepth::average_run(uint16_t *depth, size_t i, float jump)
{
    float *means = depth_.data() + i;
    uint8_t *stacks = stacks_.data() + i;
    uint64_t equal = 0, jumped = 0;
    std::memcpy(&equal, stacks, sizeof equal);
    std::memcpy(&jumped, jumped_.data() + i, sizeof jumped);
    if (equal != stacks[0] * uint64_t{0x0101010101010101} || jumped != 0)
        return false;
    int odd = 0;
    for (int x = 0; x < 8; x++) {
        const auto now = static_cast<float>(depth[x]);
        odd |= static_cast<int>(std::fabs(now - means[x]) > jump) | static_cast<int>(means[x] < 1.0F) |
               static_cast<int>(now < 1.0F);
    }
    if (odd)
        return false;
    const uint8_t more = std::min<uint8_t>(stacks[0] + 1, most_stacks);
    const float share = 1.0F / static_cast<float>(more);
    for (int x = 0; x < 8; x++) {
        means[x] += (static_cast<float>(depth[x]) - means[x]) * share;
        depth[x] = rounded(means[x]);
    }
    std::memset(stacks, more, 8);
    return true;
}

void SteadyDepth::average_row(uint16_t *depth, uint32_t y, const DepthJumps &jumps)
{
    constexpr uint32_t tile_pixels = cell_pixels * tile_cells;
    static_assert(tile_pixels == 8);
    const uint8_t *moved = moved_.data() + size_t{std::min(y / tile_pixels, tiles_down_ - 1)} * tiles_across_;
    const size_t row = size_t{y} * shape_.width;
    for (uint32_t x = 0; x < shape_.width; x += tile_pixels) {
        const bool is_moved = moved[std::min(x / tile_pixels, tiles_across_ - 1)];
        const uint32_t end = std::min(x + tile_pixels, shape_.width);
        if (!is_moved && end == x + tile_pixels &&
            average_run(depth + x, row + x, static_cast<float>(jumps[depth[x] >> 8])))
            continue;
        for (uint32_t i = x; i < end; i++)
            average_pixel(depth[i], row + i, is_moved, jumps);
    }
}

void SteadyDepth::steady(const StackView &stack, const DepthRows &depth, const DepthJumps &jumps)
{
    in_halves(tiles_down_, [&](uint32_t first, uint32_t end) { compare(stack, first, end); });
    if (is_new_) {
        compared_ = 0;
        for (uint32_t z = 0; z < shape_.planes; z++)
            singles_[z] = noise_of_plane(stack, 0, z);
    } else if (compared_ < settled || compared_ % seldom == 0)
        learn_noise(stack);
    compared_++;
    judge();
    is_new_ = false;
    in_halves(tiles_down_, [&](uint32_t first, uint32_t end) { follow(first, end); });
    in_halves(shape_.height, [&](uint32_t first, uint32_t end) {
        for (uint32_t y = first; y < end; y++)
            average_row(reinterpret_cast<uint16_t *>(depth.pixels + y * depth.stride), y, jumps);
    });
}

} // namespace dff
