/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/z_entropy.h"

namespace dff {

ZEntropy::ZEntropy(CommandQueue &queue, const StackShape &shape, float threshold_bits)
    : queue_(queue), shape_(shape), threshold_bits_(threshold_bits),
      kernel_(Program(queue.device(), "z_entropy", Luma::build_options(shape.format)).kernel("z_entropy")),
      moved_(queue.allocate(size_t{shape.width} * shape.height))
{
}

void ZEntropy::run(const Luma &luma)
{
    queue_.begin_stage("z-entropy");
    queue_.run(kernel_, {shape_.width, shape_.height}, luma.bytes(), luma.rows(), moved_,
               static_cast<cl_int>(shape_.width), static_cast<cl_int>(shape_.planes), threshold_bits_);
}

} // namespace dff
