/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/stack_pictures.h"

#include "focalstack/bad_pixels.h"

#include <algorithm>

namespace dff {

std::unique_ptr<StackPictures> StackPictures::map(const GstFocalStackInfo &info, GstBuffer *buffer,
                                                  GstMapFlags flags, GError **error)
{
    std::unique_ptr<StackPictures> pictures(new StackPictures(info, buffer));

    for (guint z = 0; z < info.planes; z++) {
        Place place;
        if (!gst_focal_stack_info_locate_plane(&info, buffer, z, place.offset, place.stride, error))
            return nullptr;
        pictures->planes_.push_back(place);
    }
    if (!gst_buffer_map(buffer, &pictures->map_, flags)) {
        g_set_error(error, GST_RESOURCE_ERROR, GST_RESOURCE_ERROR_FAILED,
                    "The stack's memory cannot be mapped");
        return nullptr;
    }
    return pictures;
}

StackPictures::~StackPictures()
{
    if (map_.memory)
        gst_buffer_unmap(buffer_, &map_);
}

unsigned StackPictures::components() const
{
    return GST_VIDEO_INFO_N_PLANES(&info_.frame);
}

std::vector<guint> StackPictures::channels(unsigned component) const
{
    gint numbers[GST_VIDEO_MAX_COMPONENTS];
    std::vector<guint> result;

    gst_video_format_info_component(info_.frame.finfo, component, numbers);
    for (const gint number : numbers) {
        if (number >= 0 && number != GST_VIDEO_COMP_A)
            result.push_back(static_cast<guint>(number));
    }
    std::ranges::sort(result, {},
                      [&](guint channel) { return GST_VIDEO_INFO_COMP_POFFSET(&info_.frame, channel); });
    return result;
}

std::vector<double> StackPictures::black(unsigned component) const
{
    gint offset[GST_VIDEO_MAX_COMPONENTS], scale[GST_VIDEO_MAX_COMPONENTS];
    std::vector<double> result;

    gst_video_color_range_offsets(info_.frame.colorimetry.range, info_.frame.finfo, offset, scale);
    for (const guint channel : channels(component))
        result.push_back(offset[channel]);
    return result;
}

int StackPictures::step(unsigned component) const
{
    return 1 << GST_VIDEO_FORMAT_INFO_W_SUB(info_.frame.finfo, channels(component).front());
}

void StackPictures::leave_out(std::span<const cv::Point> bad_pixels)
{
    if (bad_pixels.empty())
        return;
    std::vector<cv::Mat> copies;
    for (unsigned z = 0; z < planes_.size(); z++)
        for (unsigned i = 0; i < components(); i++) {
            copies.push_back(component(z, i).clone());
            repair_pixels(copies.back(), bad_pixels, step(i));
        }
    copies_ = std::move(copies);
}

cv::Mat StackPictures::component(unsigned plane, unsigned component) const
{
    if (!copies_.empty())
        return copies_[plane * components() + component];
    const guint channel = channels(component).front();
    const int bytes = GST_VIDEO_INFO_COMP_DEPTH(&info_.frame, channel) > 8 ? 2 : 1;
    const int channels = GST_VIDEO_INFO_COMP_PSTRIDE(&info_.frame, channel) / bytes;
    const Place &place = planes_[plane];

    return {GST_VIDEO_INFO_COMP_HEIGHT(&info_.frame, channel),
            GST_VIDEO_INFO_COMP_WIDTH(&info_.frame, channel),
            CV_MAKETYPE(bytes == 2 ? CV_16U : CV_8U, channels), map_.data + place.offset[component],
            static_cast<std::size_t>(place.stride[component])};
}

} // namespace dff
