/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/noise_curve.h"

#include <vector>

namespace dff {

/* Rows of 16-bit depth, `stride` bytes apart; 0 is no value. */
struct DepthRows {
    std::byte *pixels;
    size_t stride;
};

/* By how much depth may differ from that of the stacks before, without that another plane is meant: for
 * pixels of i * 256 to i * 256 + 255. */
using DepthJumps = std::array<uint16_t, 256>;

/* Keeps depth from flickering where the picture stands still: the mean of the depth maps of up to 16 stacks.
 * A pixel that jumps to another plane there does so after a few stacks that agree. Where the picture changed
 * by more than its noise, in tiles of 8x8 pixels and those around them, depth is what the last stack alone
 * says, so that nothing that moves leaves a trace. */
class SteadyDepth {
public:
    explicit SteadyDepth(const StackShape &shape);

    /* Changes the depth map of `stack` in place. */
    void steady(const StackView &stack, const DepthRows &depth, const DepthJumps &jumps);

    /* The next stack shows another scene. */
    void forget() { is_new_ = true; }

private:
    struct Room;

    void take_cells(const StackView &stack, uint32_t z, uint32_t y, Room &room);
    void add_differences(size_t first_cell, std::span<float> squares, std::span<float> brightness) const;
    void compare(const StackView &stack, uint32_t first_row, uint32_t end);
    void learn_noise(const StackView &stack);
    void judge();
    void follow(uint32_t first_row, uint32_t end);
    void average_pixel(uint16_t &depth, size_t i, bool is_moved, const DepthJumps &jumps);
    bool average_run(uint16_t *depth, size_t i, float jump);
    void average_row(uint16_t *depth, uint32_t y, const DepthJumps &jumps);

    StackShape shape_;
    Component component_;
    uint32_t cells_across_, cells_down_, tiles_across_, tiles_down_;
    float samples_; /* cells of a tile, in all planes */

    std::vector<float> cells_, means_; /* [z][cell]: of this stack, and of those before */
    std::vector<TileDifference> tiles_;
    std::vector<uint8_t> sweeps_;     /* of each tile, that means_ is the mean of */
    std::vector<uint8_t> moved_;      /* [tile] */
    NoiseCurve noise_{};              /* of a cell */
    std::vector<float> depth_;        /* the mean */
    std::vector<uint8_t> stacks_;     /* that it is the mean of, a pixel each */
    std::vector<uint8_t> jumped_;     /* stacks that a pixel has been in another plane */
    std::vector<NoiseCurve> singles_; /* as one picture of each plane shows it */
    uint32_t looked_at_ = 0;          /* plane whose picture tells of noise next */
    uint32_t compared_ = 0;           /* stacks of this scene */
    bool is_new_ = true;
};

} // namespace dff
