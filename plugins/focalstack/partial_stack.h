/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "common/memory_pool.h"

#include <gst/dff/dff.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace dff {

struct BufferUnref {
    void operator()(GstBuffer *buffer) const { gst_buffer_unref(buffer); }
};
using BufferPtr = std::unique_ptr<GstBuffer, BufferUnref>;

/* Adds the GstReferenceTimestampMetas of one buffer to another. */
void copy_reference_times(GstBuffer *from, GstBuffer *to);

/* What to tell a user whose machine cannot hold such stacks; nothing where it can. */
std::optional<std::string> too_large(const GstFocalStackInfo &info);

/* Stacks of one shape: each in one memory of its own, with 64 bytes of slack at both ends and one
 * GstVideoMeta a plane. Without an upper limit, so that nobody downstream who keeps stacks can stop the
 * stream; what comes back is used again. A stack may outlive its pool. */
class StackPool {
public:
    explicit StackPool(const GstFocalStackInfo &info);

    const GstFocalStackInfo &info() const { return info_; }

    /* Empty if there is no memory. */
    BufferPtr acquire();

private:
    GstFocalStackInfo info_;
    MemoryPool pool_;
};

/* The time of a frame or stack on its stream: both may be GST_CLOCK_TIME_NONE. */
struct TimeSpan {
    GstClockTime start = GST_CLOCK_TIME_NONE;
    GstClockTime duration = GST_CLOCK_TIME_NONE;
};

/* A frame with its place in the sweep. Borrows what it points to. */
struct PlaneFrame {
    GstBuffer *buffer;
    const GstVideoFrame *picture;
    GstFocusInfo focus;
    TimeSpan time;
};

/* A stack whose planes come one by one. */
class PartialStack {
public:
    /* `buffer` comes from a pool of stacks of this shape. */
    PartialStack(const GstFocalStackInfo &info, BufferPtr buffer);

    /* Copies the picture into the plane. False if the stack's memory cannot be written. */
    bool put(unsigned plane, const PlaneFrame &frame);

    /* Copies the picture of plane `from` to plane `to`, which is said to be at `power` dioptres all the same.
     */
    void repeat(unsigned from, unsigned to, double power);

    /* Copies one plane, or all planes, of another stack of the same shape. */
    void take_over(const PartialStack &other, unsigned plane);
    void take_over(const PartialStack &other);

    const GstFocusInfo &focus(unsigned plane) const { return planes_[plane].focus; }

    /* Time from the first exposure's start to the last one's end of the planes in `fresh` (bit z: plane z).
     */
    TimeSpan span(uint64_t fresh) const;

    /* Writes times and metas. Planes in `filled` hold a picture from elsewhere. From now on this stack can
     * only be copied from; whoever gets the buffer may write to it once this object is gone. */
    BufferPtr finish(uint64_t sequence, uint64_t filled);

private:
    struct Plane {
        GstFocusInfo focus;
        TimeSpan time;
        std::shared_ptr<GstBuffer> clocks; /* holds the frame's GstReferenceTimestampMetas, if it has any */
    };

    unsigned first_of(uint64_t fresh) const;
    void copy_picture(const PartialStack &other, unsigned from, unsigned to);
    bool holds_all(const GstMapInfo &map) const;

    GstFocalStackInfo info_;
    BufferPtr buffer_;
    std::vector<Plane> planes_;
};

} // namespace dff
