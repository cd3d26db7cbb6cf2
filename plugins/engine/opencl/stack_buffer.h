/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/host_buffer.h"
#include "engine/opencl/upload_pool.h"
#include "engine/plane_tracker.h"

namespace dff {

/* Throws EngineError (TooLarge) if the device cannot take stacks of this shape: one is a single allocation,
 * and may have half of the device's memory at most. */
void require_room(const Device &device, const StackShape &shape);

/* A focal stack as the kernels see it: its bytes, and where each component of each plane starts. On a CPU the
 * bytes are used in place, elsewhere those of the view's shared upload or of one of its own, so the view must
 * stay valid until the queue is finished. */
class StackBuffer {
public:
    /* Throws as require_room(), before anything is allocated. */
    StackBuffer(CommandQueue &queue, StackShape shape);

    /* Points the buffer at the stack in `view`. Throws EngineError if that has another shape than this, or
     * does not lie within its memory. */
    void assign(const StackView &view);

    /* Bit z is set where plane z is another than in the stack of the last remember(). */
    uint64_t changed_planes() const { return changed_planes_; }

    /* The same for whoever has seen none of its planes. */
    StackBuffer as_new() const
    {
        StackBuffer all = *this;
        all.changed_planes_ = ~uint64_t{0};
        return all;
    }

    /* All that was asked of the stack in `view`, the last one assigned, has been computed. */
    void remember(const StackView &view) { tracker_.remember(view); }

    /* StackView::noise */
    std::optional<float> noise() const { return noise_; }

    const StackShape &shape() const { return shape_; }
    const cl::Buffer &bytes() const { return bytes_; }

    /* ulong2 (offset, stride) in bytes for each component and plane: [component][z]. */
    const cl::Buffer &layout() const { return layout_; }

private:
    std::shared_ptr<cl::Buffer> upload_shared(const StackView &view);

    CommandQueue &queue_;
    StackShape shape_;
    std::optional<float> noise_;
    std::vector<RowLayout> host_layout_;
    PlaneTracker tracker_;
    uint64_t changed_planes_ = ~uint64_t{0};
    std::shared_ptr<UploadPool> uploads_; /* for stacks like the last one that was shared */
    HostBuffer own_;
    cl::Buffer bytes_, layout_;
};

} // namespace dff
