/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depth_maps.h"

#include "gstcl/blur_step.h"

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace dff {

DepthMaps::Map::Map(std::shared_ptr<DepthOutput> output, const GstVideoInfo &stack)
    : output_(std::move(output)), buffer_(output_->acquire())
{
    gst_video_info_set_format(&info_, output_->format(), GST_VIDEO_INFO_WIDTH(&stack),
                              GST_VIDEO_INFO_HEIGHT(&stack));
    /* Takes no reference to the buffer, which then can still be given metas. */
    const bool is_mapped = gst_buffer_map(buffer_, &map_, GST_MAP_WRITE);
    if (is_mapped && map_.size >= GST_VIDEO_INFO_SIZE(&info_))
        return;
    if (is_mapped)
        gst_buffer_unmap(buffer_, &map_);
    gst_buffer_unref(buffer_);
    throw std::runtime_error("The memory of a depth map cannot be written");
}

DepthMaps::Map::~Map()
{
    if (GstBuffer *buffer = release())
        gst_buffer_unref(buffer);
}

OutputPicture DepthMaps::Map::picture() const
{
    return {reinterpret_cast<std::byte *>(map_.data) + GST_VIDEO_INFO_PLANE_OFFSET(&info_, 0),
            static_cast<size_t>(GST_VIDEO_INFO_PLANE_STRIDE(&info_, 0))};
}

void DepthMaps::Map::blank()
{
    std::memset(map_.data, 0, map_.size);
    GST_BUFFER_FLAG_SET(buffer_, GST_BUFFER_FLAG_GAP);
    GST_BUFFER_FLAG_SET(buffer_, GST_BUFFER_FLAG_CORRUPTED);
}

/* The buffer, unmapped, for whoever takes it. */
GstBuffer *DepthMaps::Map::release()
{
    if (buffer_)
        gst_buffer_unmap(buffer_, &map_);
    return std::exchange(buffer_, nullptr);
}

/* What pixels mean that are differences of depth. */
static void add_deviation_meta(GstBuffer *buffer, GstDepthInfo depth)
{
    depth.scale = std::abs(depth.scale);
    depth.offset = 0.0;
    gst_buffer_add_depth_meta(buffer, &depth);
}

DepthMaps::DepthMaps(const std::vector<std::shared_ptr<DepthOutput>> &outputs, const GstVideoInfo &stack,
                     const GstDepthInfo &depth, const StreamSegment &segment)
{
    for (const std::shared_ptr<DepthOutput> &output : outputs) {
        if (!output->is_linked())
            continue;
        output->prepare(stack, depth, segment);
        maps_.push_back(std::make_unique<Map>(output, stack));
        if (output->has_depth())
            gst_buffer_add_depth_meta(maps_.back()->buffer(), &depth);
        else if (output->tells_uncertainty())
            add_deviation_meta(maps_.back()->buffer(), depth);
    }
}

DepthOutputs DepthMaps::outputs() const
{
    DepthOutputs outputs;
    for (const auto &map : maps_) {
        const gchar *name = GST_PAD_NAME(map->output().pad());
        if (g_str_equal(name, "sparse"))
            outputs.sparse = map->picture();
        else if (g_str_equal(name, "confidence"))
            outputs.confidence = map->picture();
        else if (g_str_equal(name, "motion"))
            outputs.motion = map->picture();
        else if (map->output().tells_uncertainty())
            outputs.uncertainty = map->picture();
        else
            outputs.depth = map->picture();
    }
    return outputs;
}

void DepthMaps::blank()
{
    for (const auto &map : maps_)
        map->blank();
}

void DepthMaps::stamp(GstBuffer *stack, const StackClock::Time &time, guint64 index)
{
    const GstReferenceTimestampMeta *clock = gst_buffer_get_reference_timestamp_meta(stack, nullptr);
    for (const auto &map : maps_) {
        GST_BUFFER_PTS(map->buffer()) = time.start;
        GST_BUFFER_DURATION(map->buffer()) = time.duration;
        GST_BUFFER_OFFSET(map->buffer()) = index;
        if (GST_BUFFER_IS_DISCONT(stack))
            GST_BUFFER_FLAG_SET(map->buffer(), GST_BUFFER_FLAG_DISCONT);
        if (clock)
            gst_buffer_add_reference_timestamp_meta(map->buffer(), clock->reference, clock->timestamp,
                                                    clock->duration);
    }
}

void DepthMaps::add_blur_step(float pixels)
{
    for (const auto &map : maps_)
        if (map->output().format() == GST_VIDEO_FORMAT_GRAY16_LE)
            dff::add_blur_step(map->buffer(), pixels);
}

void DepthMaps::push(const std::function<void(GstPad *, GstFlowReturn)> &pushed)
{
    while (!maps_.empty()) {
        const std::unique_ptr<Map> map = std::move(maps_.front());
        maps_.erase(maps_.begin());
        GstPad *pad = map->output().pad();
        pushed(pad, gst_pad_push(pad, map->release()));
    }
}

} // namespace dff
