/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/cpu/stack_statistics.h"

namespace dff {

StackStatistics::StackStatistics(CommandQueue &queue, const StackShape &shape, float entropy_bits)
    : queue_(queue), shape_(shape), entropy_bits_(entropy_bits),
      kernel_(Program(queue.device(), "stack_statistics").kernel("stack_statistics")),
      mean_(queue.allocate(size_t{shape.width} * shape.height)),
      moved_(queue.allocate(size_t{shape.width} * shape.height))
{
}

void StackStatistics::run(const LumaPlanes &luma)
{
    queue_.begin_stage("statistics");
    queue_.run_groups(kernel_, {shape_.height}, luma.bytes(), luma.rows(), mean_, moved_,
                      static_cast<cl_int>(shape_.width), static_cast<cl_int>(shape_.planes), entropy_bits_);
}

} // namespace dff
