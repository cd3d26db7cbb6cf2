/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "engine/small_planes.h"

#include "engine/luma.h"

namespace dff {

SmallPlanes::SmallPlanes(CommandQueue &queue, const StackShape &shape, const LowShape &low)
    : queue_(queue), low_(low), channels_(colour_channels(shape.format)),
      average_colours_(Program(queue.device(), "small_planes",
                               colour_options(shape.format) + " -DSCALE=" + std::to_string(low.scale))
                           .kernel("average_colours")),
      colours_(low.allocate_shorts(queue, size_t{3} * shape.planes))
{
}

void SmallPlanes::run(const StackBuffer &stack)
{
    queue_.begin_stage("small-planes");
    queue_.run(average_colours_, low_.rows_of_planes(), stack.bytes(), stack.layout(), channels_,
               cl_ulong{stack.changed_planes()}, colours_, low_.width, low_.stride);
}

} // namespace dff
