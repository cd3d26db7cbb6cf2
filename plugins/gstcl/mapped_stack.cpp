/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gstcl/mapped_stack.h"

#include "common/stack_noise.h"
#include "gstcl/stack_upload.h"

#include <stdexcept>

namespace dff {

namespace {

PixelFormat pixel_format(GstVideoFormat format)
{
    switch (format) {
    case GST_VIDEO_FORMAT_GRAY16_LE:
        return PixelFormat::Gray16;
    case GST_VIDEO_FORMAT_I420:
        return PixelFormat::I420;
    case GST_VIDEO_FORMAT_NV12:
        return PixelFormat::Nv12;
    case GST_VIDEO_FORMAT_RGB:
        return PixelFormat::Rgb;
    case GST_VIDEO_FORMAT_BGR:
        return PixelFormat::Bgr;
    case GST_VIDEO_FORMAT_RGBx:
        return PixelFormat::Rgbx;
    case GST_VIDEO_FORMAT_BGRx:
        return PixelFormat::Bgrx;
    case GST_VIDEO_FORMAT_RGBA64_LE:
        return PixelFormat::Rgba64;
    default: /* the pad template lets nothing else through */
        return PixelFormat::Gray8;
    }
}

std::vector<RowLayout> locate_planes(const GstFocalStackInfo &info, GstBuffer *buffer)
{
    const guint components = GST_VIDEO_INFO_N_PLANES(&info.frame);
    std::vector<RowLayout> layout(size_t{components} * info.planes);
    for (guint z = 0; z < info.planes; z++) {
        gsize offset[GST_VIDEO_MAX_PLANES];
        gint stride[GST_VIDEO_MAX_PLANES];
        g_autoptr(GError) error = nullptr;
        if (!gst_focal_stack_info_locate_plane(&info, buffer, z, offset, stride, &error))
            throw std::runtime_error(error->message);
        for (guint c = 0; c < components; c++)
            layout[c * info.planes + z] = {offset[c], static_cast<uint64_t>(stride[c])};
    }
    return layout;
}

/* None of planes that were lost or repeat another's picture. */
std::vector<std::optional<PlaneIdentity>> identify_planes(const GstFocalStackInfo &info, GstBuffer *buffer)
{
    const GstFocalStackMeta *meta = gst_focal_stack_info_get_meta(&info, buffer, nullptr);
    if (!meta)
        return {};
    std::vector<std::optional<PlaneIdentity>> identities(info.planes);
    for (guint z = 0; z < info.planes; z++) {
        GstFocusInfo focus;
        const bool own = ((meta->missing | meta->repeated) >> z & 1) == 0;
        if (own && gst_focal_stack_meta_get_focus(meta, z, &focus))
            identities[z] = PlaneIdentity{focus.sweep, focus.plane};
    }
    return identities;
}

} // namespace

StackShape stack_shape(const GstFocalStackInfo &info)
{
    return {pixel_format(GST_VIDEO_INFO_FORMAT(&info.frame)),
            static_cast<uint32_t>(GST_VIDEO_INFO_WIDTH(&info.frame)),
            static_cast<uint32_t>(GST_VIDEO_INFO_HEIGHT(&info.frame)), info.planes};
}

MappedStack::MappedStack(const GstFocalStackInfo &info, GstBuffer *buffer, const Device &device)
    : buffer_(buffer)
{
    view_.shape = stack_shape(info);
    view_.layout = locate_planes(info, buffer);
    view_.identities = identify_planes(info, buffer);
    view_.noise = stack_noise(buffer);
    if (!device.works_in_place())
        view_.upload = shared_upload(buffer);
    if (!gst_buffer_map(buffer, &map_, GST_MAP_READ))
        throw std::runtime_error("The stack's memory cannot be read");
    view_.memory = {reinterpret_cast<const std::byte *>(map_.data), map_.size};
    if (lies_within_memory(view_))
        return;
    gst_buffer_unmap(buffer, &map_);
    throw std::runtime_error("The stack's memory is shorter than it was said to be");
}

} // namespace dff
