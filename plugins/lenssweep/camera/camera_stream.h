/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "aravis_camera.h"
#include "plane_labeller.h"

#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <span>

namespace dff {

class BufferReturn;

/* A frame in Aravis's memory. Its end gives the memory back for another frame while the stream is there, and
 * frees it afterwards. */
class CameraBuffer {
public:
    CameraBuffer(ArvBuffer *buffer, std::shared_ptr<BufferReturn> way_back, std::int64_t arrival_ns);
    CameraBuffer(CameraBuffer &&other) noexcept;
    CameraBuffer &operator=(CameraBuffer &&other) noexcept;
    ~CameraBuffer();

    /* Whether all of it is here. If not, only that it once was there is known. */
    bool complete() const;

    CameraFrame facts() const;
    std::span<std::uint8_t> pixels() const;

private:
    ArvBuffer *buffer_;
    std::shared_ptr<BufferReturn> way_back_;
    std::int64_t arrival_ns_;
};

/* The frames of a camera that acquires, in the order they come. */
class CameraStream {
public:
    /* Opens the stream, with so many buffers of so many bytes. `on_frame` is called, in a thread of Aravis's,
     * when there is one to take. Throws CameraError. The camera outlives it. */
    CameraStream(AravisCamera &camera, unsigned buffers, std::size_t payload, std::function<void()> on_frame);
    CameraStream(const CameraStream &) = delete;
    CameraStream &operator=(const CameraStream &) = delete;

    /* Buffers that are still in use stay valid. */
    ~CameraStream();

    /* The next frame, or nothing if none has come; never waits. */
    std::optional<CameraBuffer> take();

    /* Frames for which no buffer was free. */
    std::uint64_t underruns() const;

private:
    static void put(ArvStream *stream, CameraStream *self);

    std::function<void()> on_frame_;
    std::mutex mutex_; /* guards arrived_; nothing is locked within */
    std::deque<CameraBuffer> arrived_;

    std::shared_ptr<BufferReturn> way_back_;
    ObjectRef<ArvStream> stream_;
};

} // namespace dff
