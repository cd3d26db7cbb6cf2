/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "camera_stream.h"

#include "camera_control.h"
#include "capture_poll.h"

#include <utility>

namespace dff {

/* Where a buffer goes when nobody reads it any more. */
class BufferReturn {
public:
    explicit BufferReturn(ArvStream *stream) : stream_(stream) {}

    void give(ArvBuffer *buffer)
    {
        const std::lock_guard lock(mutex_);
        if (stream_)
            arv_stream_push_buffer(stream_, buffer);
        else
            g_object_unref(buffer);
    }

    void close()
    {
        const std::lock_guard lock(mutex_);
        stream_ = nullptr;
    }

private:
    std::mutex mutex_; /* guards stream_; nothing of ours is locked within */
    ArvStream *stream_;
};

CameraBuffer::CameraBuffer(ArvBuffer *buffer, std::shared_ptr<BufferReturn> way_back, std::int64_t arrival_ns)
    : buffer_(buffer), way_back_(std::move(way_back)), arrival_ns_(arrival_ns)
{
}

CameraBuffer::CameraBuffer(CameraBuffer &&other) noexcept
    : buffer_(std::exchange(other.buffer_, nullptr)), way_back_(std::move(other.way_back_)),
      arrival_ns_(other.arrival_ns_)
{
}

CameraBuffer &CameraBuffer::operator=(CameraBuffer &&other) noexcept
{
    std::swap(buffer_, other.buffer_);
    std::swap(way_back_, other.way_back_);
    std::swap(arrival_ns_, other.arrival_ns_);
    return *this;
}

CameraBuffer::~CameraBuffer()
{
    if (buffer_)
        way_back_->give(buffer_);
}

bool CameraBuffer::complete() const
{
    return arv_buffer_get_status(buffer_) == ARV_BUFFER_STATUS_SUCCESS;
}

CameraFrame CameraBuffer::facts() const
{
    return {arv_buffer_get_frame_id(buffer_), static_cast<std::int64_t>(arv_buffer_get_timestamp(buffer_)),
            arrival_ns_};
}

/* Aravis lends its memory as const, since others may read it; a buffer that was popped is ours alone. */
std::span<std::uint8_t> CameraBuffer::pixels() const
{
    std::size_t size = 0;
    const void *data = arv_buffer_get_data(buffer_, &size);
    return {static_cast<std::uint8_t *>(const_cast<void *>(data)), size};
}

CameraStream::CameraStream(AravisCamera &camera, unsigned buffers, std::size_t payload,
                           std::function<void()> on_frame)
    : on_frame_(std::move(on_frame))
{
    CallError error;
    stream_.reset(arv_camera_create_stream(camera.handle(), nullptr, nullptr, error.out()));
    error.check<CameraError>("the camera's stream cannot be opened");
    if (ARV_IS_GV_STREAM(stream_.get()))
        g_object_set(stream_.get(), "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_AUTO, nullptr);
    way_back_ = std::make_shared<BufferReturn>(stream_.get());
    for (unsigned i = 0; i < buffers; i++)
        arv_stream_push_buffer(stream_.get(), arv_buffer_new_allocate(payload));
    g_signal_connect(stream_.get(), "new-buffer", G_CALLBACK(put), this);
    arv_stream_set_emit_signals(stream_.get(), TRUE);
}

CameraStream::~CameraStream()
{
    g_signal_handlers_disconnect_by_data(stream_.get(), this);
    arv_stream_set_emit_signals(stream_.get(), FALSE);
    way_back_->close();
    stream_.reset(); /* joins its thread, which may still be in put() */
}

/* In Aravis's thread, right after the frame is complete. */
void CameraStream::put(ArvStream *stream, CameraStream *self)
{
    ArvBuffer *buffer = arv_stream_try_pop_buffer(stream);
    if (!buffer)
        return;
    {
        const std::lock_guard lock(self->mutex_);
        self->arrived_.emplace_back(buffer, self->way_back_, host_now_ns());
    }
    self->on_frame_();
}

std::optional<CameraBuffer> CameraStream::take()
{
    const std::lock_guard lock(mutex_);
    if (arrived_.empty())
        return std::nullopt;
    std::optional<CameraBuffer> buffer(std::move(arrived_.front()));
    arrived_.pop_front();
    return buffer;
}

std::uint64_t CameraStream::underruns() const
{
    guint64 underruns = 0;
    arv_stream_get_statistics(stream_.get(), nullptr, nullptr, &underruns);
    return underruns;
}

} // namespace dff
