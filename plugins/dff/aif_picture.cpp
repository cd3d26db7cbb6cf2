/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "aif_picture.h"

#include "gstcl/mapped_frame.h"
#include "gstcl/mapped_stack.h"

#include <cmath>
#include <stdexcept>

namespace dff {

namespace {

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
    if (!picture)
        throw std::runtime_error("There is no memory left for another picture");
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
    scale_.reset();
    no_depth_.assign(
        static_cast<size_t>(GST_VIDEO_INFO_WIDTH(&stack_.frame)) * GST_VIDEO_INFO_HEIGHT(&stack_.frame), 0);
}

void AifPicture::ensure_encoder(GstBuffer *stack, GstBuffer *depth)
{
    PlanePositions positions = plane_positions(stack);
    GstDepthInfo info = caps_facts_;
    if (const GstDepthMeta *meta = gst_buffer_get_depth_meta(depth))
        gst_depth_meta_get_depth(meta, &info);
    if (scale_ && have_same_scale(*scale_, info) && positions == positions_)
        return;
    composer_->set_encoder(encoder_of(info, stack_.planes, positions));
    positions_ = std::move(positions);
    scale_ = info;
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
        ensure_encoder(stack, depth);
        mapped_depth.emplace(depth_, depth, GST_MAP_READ);
        depth_view = {mapped_depth->memory(), mapped_depth->stride()};
    }
    GstMapInfo output;
    if (!gst_buffer_map(picture, &output, GST_MAP_WRITE))
        throw std::runtime_error("The picture's memory cannot be written");
    composer_->compose(mapped_stack.view(), depth_view, blend,
                       {reinterpret_cast<std::byte *>(output.data), output.size}, layout);
    gst_buffer_unmap(picture, &output);
}

} // namespace dff
