/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/base/gstaggregator.h>
#include <memory>
#include <optional>

namespace dff {

struct PadUnref {
    void operator()(GstAggregatorPad *pad) const { gst_object_unref(pad); }
};
using AggregatorPad = std::unique_ptr<GstAggregatorPad, PadUnref>;

struct BufferUnref {
    void operator()(GstBuffer *buffer) const { gst_buffer_unref(buffer); }
};
using OwnedBuffer = std::unique_ptr<GstBuffer, BufferUnref>;

/* The pads whose first buffers belong together where they have the same running time; those without a time go
 * by their order. `stack` and `uncertainty` may be missing, and may be released while this looks at them. */
struct InputPads {
    AggregatorPad colour, depth, stack, uncertainty;
};

/* Taken off their pads. */
struct MatchedBuffers {
    OwnedBuffer colour, depth;
    /* nullptr where the pad is missing or at its end, or has none of this time. */
    OwnedBuffer stack, uncertainty;
};

enum class Match { Waiting, Again, Ended, Ready };

/* Ready: `buffers` holds the next ones that belong together. A picture without its depth, a depth map without
 * its picture, and a stack or an uncertainty without both are dropped, which is told in the log. */
Match match_inputs(const InputPads &pads, MatchedBuffers &buffers);

} // namespace dff
