/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/cpu/focus_tiles.h"

namespace dff {

namespace {

/* TILE_WIDTH and TILE_HEIGHT of tile.cl, SEGMENT and STRIP of select_ridges.cl */
constexpr size_t tile_width = 384, tile_height = 36, segment = 2048, strip = 36;

constexpr size_t block = 64; /* BLOCK of tile.cl */

constexpr size_t parts_of(size_t size, size_t part)
{
    return (size + part - 1) / part;
}

} // namespace

FocusTiles::FocusTiles(CommandQueue &queue, const StackShape &shape, unsigned levels, float tolerance,
                       float entropy_bits)
    : queue_(queue), shape_(shape), tolerance_(tolerance), entropy_bits_(entropy_bits),
      stride_((parts_of(shape.width, block) + 1) * block),
      tiles_(parts_of(shape.width, tile_width), parts_of(shape.height, tile_height)),
      focus_tiles_(
          Program(queue.device(), "focus_tiles", "-DLEVELS=" + std::to_string(levels)).kernel("focus_tiles")),
      select_ridges_(Program(queue.device(), "select_ridges").kernel("select_ridges")),
      place_(queue.allocate(stride_ * shape.height)),
      tile_sums_(queue.allocate(tiles_.get()[0] * tiles_.get()[1] * sizeof(cl_float))),
      sparse_(queue.allocate(size_t{shape.width} * shape.height)),
      mean_(queue.allocate(size_t{shape.width} * shape.height)),
      moved_(queue.allocate(size_t{shape.width} * shape.height))
{
    /* The columns of 0 between rows, and as many before the first row. */
    const size_t margin = 128, bytes = margin + stride_ * shape.height * sizeof(cl_ushort);
    peak_memory_ = queue.allocate(bytes);
    queue.commands().enqueueFillBuffer(peak_memory_, cl_uchar{0}, 0, bytes);
    const cl_buffer_region region{margin, bytes - margin};
    peak_ = peak_memory_.createSubBuffer(CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region);
}

void FocusTiles::run(const LumaPlanes &luma, bool motion_mask, bool with_confidence)
{
    const auto width = static_cast<cl_int>(shape_.width), height = static_cast<cl_int>(shape_.height);
    const auto stride = static_cast<cl_int>(stride_), planes = static_cast<cl_int>(shape_.planes);
    const auto tiles = static_cast<cl_int>(tiles_.get()[0] * tiles_.get()[1]);
    if (with_confidence && !confidence_())
        confidence_ = queue_.allocate(size_t{shape_.width} * shape_.height);

    /* A kernel argument must be some buffer, also where it is not used. */
    queue_.begin_stage("focus-measure");
    queue_.run_groups(focus_tiles_, tiles_, luma.bytes(), luma.rows(), peak_, place_, tile_sums_,
                      with_confidence ? confidence_ : place_, mean_, moved_, stride, width, height, planes,
                      tolerance_, entropy_bits_, static_cast<cl_int>(with_confidence));

    queue_.begin_stage("sparse-depth");
    queue_.run_groups(select_ridges_, {parts_of(shape_.width, segment), parts_of(shape_.height, strip)},
                      peak_, place_, tile_sums_, tiles, moved_, sparse_, stride, width, height,
                      static_cast<cl_int>(motion_mask));
}

} // namespace dff
