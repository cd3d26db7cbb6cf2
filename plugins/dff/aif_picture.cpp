/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "aif_picture.h"

#include "gstcl/blur_step.h"
#include "gstcl/mapped_frame.h"
#include "gstcl/mapped_stack.h"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace dff {

namespace {

/* A buffer's memory, mapped as long as this lives. */
class MappedBuffer {
public:
    MappedBuffer(GstBuffer *buffer, GstMapFlags flags) : buffer_(buffer)
    {
        if (!gst_buffer_map(buffer, &map_, flags))
            throw std::runtime_error("The picture's memory cannot be mapped");
    }
    ~MappedBuffer() { gst_buffer_unmap(buffer_, &map_); }

    MappedBuffer(const MappedBuffer &) = delete;
    MappedBuffer &operator=(const MappedBuffer &) = delete;

    std::span<std::byte> memory() const { return {reinterpret_cast<std::byte *>(map_.data), map_.size}; }

private:
    GstBuffer *buffer_;
    GstMapInfo map_{};
};

bool is_same(double one, double other)
{
    return one == other || (std::isnan(one) && std::isnan(other));
}

/* What an encoder depends on. */
bool have_same_scale(const GstDepthInfo &one, const GstDepthInfo &other)
{
    return one.unit == other.unit && one.scale == other.scale && one.offset == other.offset &&
           is_same(one.near, other.near) && is_same(one.far, other.far);
}

} // namespace

void AifPicture::stop()
{
    composer_.reset();
    device_.reset();
    pool_.stop();
    next_picture_ = 0;
}

void AifPicture::set_stack(const GstFocalStackInfo &stack)
{
    stack_ = stack;
    composer_.reset();
    encoder_.reset();
    pool_.start(stack.frame);
}

void AifPicture::set_depth(const GstVideoInfo &depth, const GstDepthInfo &facts)
{
    depth_ = depth;
    caps_facts_ = facts;
}

GstBuffer *AifPicture::compose(GstBuffer *stack, GstBuffer *depth, AifComposer::Blend blend)
{
    ensure_composer();
    g_autoptr(GstBuffer) picture = pool_.acquire();
    fill(stack, depth, blend, picture);
    stamp_picture(picture, GST_BUFFER_PTS_IS_VALID(stack) || !depth ? stack : depth, stack, next_picture_++);
    return reinterpret_cast<GstBuffer *>(g_steal_pointer(&picture));
}

void AifPicture::ensure_composer()
{
    if (composer_)
        return;
    translate_errors(*device_,
                     [&] { composer_ = std::make_unique<AifComposer>(device_, stack_shape(stack_)); });
    encoder_is_new_ = encoder_.has_value();
    no_depth_.assign(
        static_cast<size_t>(GST_VIDEO_INFO_WIDTH(&stack_.frame)) * GST_VIDEO_INFO_HEIGHT(&stack_.frame), 0);
}

std::optional<std::string> AifPicture::take_facts(GstBuffer *stack, GstBuffer *depth)
{
    GstDepthInfo info = caps_facts_;
    if (const GstDepthMeta *meta = gst_buffer_get_depth_meta(depth))
        gst_depth_meta_get_depth(meta, &info);
    try {
        PlanePositions positions = plane_positions(stack_, stack);
        if (encoder_ && have_same_scale(scale_, info) && positions == positions_)
            return std::nullopt;
        encoder_ = encoder_of(info, stack_.planes, positions);
        encoder_is_new_ = true;
        positions_ = std::move(positions);
        scale_ = info;
        return std::nullopt;
    } catch (const std::invalid_argument &error) {
        return error.what();
    }
}

void AifPicture::fill(GstBuffer *stack, GstBuffer *depth, AifComposer::Blend blend, GstBuffer *picture)
{
    const GstVideoInfo &frame = stack_.frame;
    std::vector<RowLayout> layout;
    for (guint c = 0; c < GST_VIDEO_INFO_N_PLANES(&frame); c++)
        layout.push_back({GST_VIDEO_INFO_PLANE_OFFSET(&frame, c),
                          static_cast<uint64_t>(GST_VIDEO_INFO_PLANE_STRIDE(&frame, c))});

    const MappedStack mapped_stack(stack_, stack, *device_);
    std::optional<MappedFrame> mapped_depth;
    AifComposer::DepthView depth_view{std::as_bytes(std::span(no_depth_)),
                                      sizeof(guint16) * static_cast<size_t>(GST_VIDEO_INFO_WIDTH(&frame))};
    if (depth) {
        require_size(depth_, frame, "stack");
        if (std::exchange(encoder_is_new_, false))
            composer_->set_encoder(*encoder_);
        mapped_depth.emplace(depth_, depth, GST_MAP_READ);
        depth_view = {mapped_depth->memory(), mapped_depth->stride(), blur_step_of(depth)};
    }
    const MappedBuffer output(picture, GST_MAP_WRITE);
    composer_->compose(mapped_stack.view(), depth_view, blend, output.memory(), layout);
}

} // namespace dff
