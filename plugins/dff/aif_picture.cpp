/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "aif_picture.h"

#include "gstcl/mapped_stack.h"

#include <stdexcept>

namespace dff {

namespace {

/* A depth frame mapped for reading, as long as this lives. */
class MappedDepth {
public:
    MappedDepth(const GstVideoInfo &info, GstBuffer *buffer)
    {
        if (!gst_video_frame_map(&frame_, &info, buffer, GST_MAP_READ))
            throw std::runtime_error("The depth map's memory does not hold what its caps say");
    }
    ~MappedDepth() { gst_video_frame_unmap(&frame_); }

    MappedDepth(const MappedDepth &) = delete;
    MappedDepth &operator=(const MappedDepth &) = delete;

    AifComposer::DepthView view() const
    {
        const auto stride = static_cast<size_t>(GST_VIDEO_FRAME_PLANE_STRIDE(&frame_, 0));
        const size_t row_bytes = 2 * static_cast<size_t>(GST_VIDEO_FRAME_WIDTH(&frame_));
        return {{static_cast<const std::byte *>(GST_VIDEO_FRAME_PLANE_DATA(&frame_, 0)),
                 stride * (GST_VIDEO_FRAME_HEIGHT(&frame_) - 1) + row_bytes},
                stride};
    }

private:
    GstVideoFrame frame_;
};

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

GstBuffer *AifPicture::compose(GstBuffer *stack, GstBuffer *depth, AifComposer::Blend blend)
{
    ensure_composer();
    g_autoptr(GstBuffer) picture = pool_.acquire();
    if (!picture)
        throw std::runtime_error("There is no memory left for another picture");
    fill(stack, depth, blend, picture);
    stamp(stack, depth, picture);
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
    GstDepthInfo info;
    gst_depth_info_init(&info);
    if (const GstDepthMeta *meta = gst_buffer_get_depth_meta(depth))
        gst_depth_meta_get_depth(meta, &info);
    if (scale_ && scale_->unit == info.unit && scale_->scale == info.scale && scale_->offset == info.offset &&
        positions == positions_)
        return;
    composer_->set_encoder(encoder_of(info, stack_.planes, positions));
    positions_ = std::move(positions);
    scale_ = info;
}

void AifPicture::check_depth_size() const
{
    const GstVideoInfo &stack = stack_.frame;
    if (GST_VIDEO_INFO_WIDTH(&depth_) == GST_VIDEO_INFO_WIDTH(&stack) &&
        GST_VIDEO_INFO_HEIGHT(&depth_) == GST_VIDEO_INFO_HEIGHT(&stack))
        return;
    g_autofree gchar *text = g_strdup_printf(
        "The depth map is %dx%d, the stack %dx%d: scale the depth with nearest-neighbour, or neither",
        GST_VIDEO_INFO_WIDTH(&depth_), GST_VIDEO_INFO_HEIGHT(&depth_), GST_VIDEO_INFO_WIDTH(&stack),
        GST_VIDEO_INFO_HEIGHT(&stack));
    throw std::runtime_error(text);
}

void AifPicture::fill(GstBuffer *stack, GstBuffer *depth, AifComposer::Blend blend, GstBuffer *picture)
{
    const GstVideoInfo &frame = stack_.frame;
    std::vector<RowLayout> layout;
    for (guint c = 0; c < GST_VIDEO_INFO_N_PLANES(&frame); c++)
        layout.push_back({GST_VIDEO_INFO_PLANE_OFFSET(&frame, c),
                          static_cast<uint64_t>(GST_VIDEO_INFO_PLANE_STRIDE(&frame, c))});

    const MappedStack mapped_stack(stack_, stack);
    std::optional<MappedDepth> mapped_depth;
    if (depth) {
        check_depth_size();
        ensure_encoder(stack, depth);
        mapped_depth.emplace(depth_, depth);
    }
    const AifComposer::DepthView nothing{std::as_bytes(std::span(no_depth_)),
                                         2 * static_cast<size_t>(GST_VIDEO_INFO_WIDTH(&frame))};
    GstMapInfo output;
    if (!gst_buffer_map(picture, &output, GST_MAP_WRITE))
        throw std::runtime_error("The picture's memory cannot be written");
    composer_->compose(mapped_stack.view(), mapped_depth ? mapped_depth->view() : nothing, blend,
                       {reinterpret_cast<std::byte *>(output.data), output.size}, layout);
    gst_buffer_unmap(picture, &output);
}

void AifPicture::stamp(GstBuffer *stack, GstBuffer *depth, GstBuffer *picture)
{
    GstBuffer *timed = GST_BUFFER_PTS_IS_VALID(stack) || !depth ? stack : depth;
    GST_BUFFER_PTS(picture) = GST_BUFFER_PTS(timed);
    GST_BUFFER_DURATION(picture) = GST_BUFFER_DURATION(timed);
    GST_BUFFER_OFFSET(picture) = next_picture_++;
    if (const GstReferenceTimestampMeta *clock = gst_buffer_get_reference_timestamp_meta(stack, nullptr))
        gst_buffer_add_reference_timestamp_meta(picture, clock->reference, clock->timestamp, clock->duration);
}

} // namespace dff
