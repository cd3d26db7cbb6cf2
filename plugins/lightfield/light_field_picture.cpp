/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "light_field_picture.h"

#include "gstcl/mapped_frame.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace dff {

namespace {

PixelFormat pixel_format(GstVideoFormat format)
{
    switch (format) {
    case GST_VIDEO_FORMAT_RGB:
        return PixelFormat::Rgb;
    case GST_VIDEO_FORMAT_BGR:
        return PixelFormat::Bgr;
    case GST_VIDEO_FORMAT_BGRx:
        return PixelFormat::Bgrx;
    default: /* the pad template lets nothing else through */
        return PixelFormat::Rgbx;
    }
}

PictureSize size_of(const GstVideoInfo &info)
{
    return {static_cast<uint32_t>(GST_VIDEO_INFO_WIDTH(&info)),
            static_cast<uint32_t>(GST_VIDEO_INFO_HEIGHT(&info))};
}

void require_at_most(PictureSize size, uint32_t side, const std::string &who)
{
    if (std::max(size.width, size.height) > side)
        throw std::runtime_error(who + " " + std::to_string(size.width) + "x" + std::to_string(size.height) +
                                 " pixels, and the limit is " + std::to_string(side) + "x" +
                                 std::to_string(side));
}

DepthUnit unit_of(GstDepthUnit unit)
{
    switch (unit) {
    case GST_DEPTH_UNIT_DIOPTRE:
        return DepthUnit::Dioptre;
    case GST_DEPTH_UNIT_MILLIMETRE:
        return DepthUnit::Millimetre;
    case GST_DEPTH_UNIT_MICROMETRE:
        return DepthUnit::Micrometre;
    default:
        return DepthUnit::Index;
    }
}

} // namespace

void LightFieldPicture::stop()
{
    renderer_.reset();
    converter_.stop();
    device_.reset();
    pool_.stop();
    color_ = depth_ = output_ = {};
    next_picture_ = 0;
}

void LightFieldPicture::set_color(const GstVideoInfo &color)
{
    require_at_most(size_of(color), largest_picture_side, "The colour picture has");
    color_ = color;
    renderer_.reset();
    no_depth_.assign(static_cast<size_t>(size_of(color).width) * size_of(color).height, 0);
}

void LightFieldPicture::set_depth(const GstVideoInfo &depth, const GstDepthInfo &facts)
{
    depth_ = depth;
    caps_facts_ = facts;
}

void LightFieldPicture::set_output(const GstVideoInfo &output)
{
    require_at_most(size_of(output), largest_output_side, "What comes after lightfieldcompose wants");
    output_ = output;
    converter_.start(color_, GST_VIDEO_INFO_FORMAT(&output));
    renderer_.reset();
    pool_.start(output);
}

void LightFieldPicture::set_settings(const LightFieldSettings &settings)
{
    settings_ = settings;
    settings_changed_ = true;
}

LightFieldPlan LightFieldPicture::plan() const
{
    return {settings_, size_of(color_)};
}

void LightFieldPicture::ensure_renderer()
{
    if (renderer_ && !settings_changed_)
        return;
    LightFieldParameters parameters = plan().parameters;
    if (settings_.zero_parallax_dioptre >= 0.0)
        if (const auto position = sweep_position(facts_, settings_.zero_parallax_dioptre))
            parameters.zero_parallax = std::clamp(*position, -4.0, 5.0); /* far away, but still rendered */
    if (renderer_) {
        renderer_->set_parameters(parameters);
    } else {
        const LightFieldShape shape{pixel_format(GST_VIDEO_INFO_FORMAT(&output_)), size_of(color_),
                                    size_of(output_)};
        translate_errors(
            *device_, [&] { renderer_ = std::make_unique<LightFieldRenderer>(device_, shape, parameters); });
        renderer_->set_positions(sweep_positions(facts_));
    }
    disparity_ = LightFieldDisparity(parameters, size_of(output_));
    settings_changed_ = false;
}

void LightFieldPicture::read_facts(GstBuffer *depth)
{
    GstDepthInfo info = caps_facts_;
    if (const GstDepthMeta *meta = gst_buffer_get_depth_meta(depth))
        gst_depth_meta_get_depth(meta, &info);
    DepthFacts facts{{unit_of(info.unit), info.scale, info.offset}, 0.0, 0.0};
    if (info.near > info.far && std::isfinite(info.near - info.far)) { /* false for NAN */
        facts.near = info.near;
        facts.far = info.far;
    }
    if (facts == facts_)
        return;
    facts_ = facts;
    settings_changed_ = true; /* dioptres of the plane of zero parallax lie elsewhere now */
    if (renderer_)
        renderer_->set_positions(sweep_positions(facts_));
}

void LightFieldPicture::render(GstBuffer *color, GstBuffer *depth, GstBuffer *picture)
{
    const MappedFrame colors(converter_.info(), converter_.convert(color), GST_MAP_READ);
    const MappedFrame output(output_, picture, GST_MAP_WRITE);
    if (depth) {
        const MappedFrame depths(depth_, depth, GST_MAP_READ);
        renderer_->render({colors.memory(), colors.stride()}, {depths.memory(), depths.stride()},
                          output.memory(), output.stride());
        return;
    }
    renderer_->render({colors.memory(), colors.stride()},
                      {std::as_bytes(std::span(no_depth_)), sizeof(guint16) * size_of(color_).width},
                      output.memory(), output.stride());
}

GstBuffer *LightFieldPicture::compose(GstBuffer *color, GstBuffer *depth)
{
    if (depth) {
        require_size(depth_, color_, "colour picture");
        read_facts(depth);
    }
    ensure_renderer();
    g_autoptr(GstBuffer) picture = pool_.acquire();
    render(color, depth, picture);
    stamp_picture(picture, color, color, next_picture_++);
    return reinterpret_cast<GstBuffer *>(g_steal_pointer(&picture));
}

} // namespace dff
