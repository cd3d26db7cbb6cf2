/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "color_converter.h"
#include "engine/light_field_renderer.h"
#include "gstcl/picture_pool.h"
#include "light_field_disparity.h"
#include "light_field_settings.h"
#include "sweep_positions.h"

#include <gst/dff/dff.h>
#include <memory>
#include <optional>

namespace dff {

/* Colour pictures and depth maps in GstBuffers to pictures for a display in GstBuffers. Used by one thread.
 */
class LightFieldPicture {
public:
    void start(std::shared_ptr<Device> device) { device_ = std::move(device); }
    void stop();

    /* The caps of what comes from here on, and of what is wanted, in any format of 8-bit RGB. set_color and
     * set_output throw std::runtime_error with a user's text if they are too large. */
    void set_color(const GstVideoInfo &color);
    void set_depth(const GstVideoInfo &depth, const GstDepthInfo &facts);
    void set_output(const GstVideoInfo &output);
    const GstVideoInfo &color() const { return color_; }

    /* From the next picture on. */
    void set_settings(const LightFieldSettings &settings);

    /* How the settings fit the colour's caps. Throws std::runtime_error. */
    LightFieldPlan plan() const;

    /* Returns a picture with the colour's time. Without a depth map it is flat. Throws EngineError, or
     * std::exception with a user's text if depth and colour do not fit each other. */
    GstBuffer *compose(GstBuffer *color, GstBuffer *depth);

    /* Of the last picture. */
    const LightFieldDisparity &disparity() const { return disparity_; }

private:
    void ensure_renderer();
    void read_facts(GstBuffer *depth);
    void render(GstBuffer *color, GstBuffer *depth, GstBuffer *picture);

    std::shared_ptr<Device> device_;
    std::unique_ptr<LightFieldRenderer> renderer_;
    LightFieldSettings settings_;
    bool settings_changed_ = true;
    GstVideoInfo color_{}, depth_{}, output_{};
    ColorConverter converter_; /* to the format of the output */
    GstDepthInfo caps_facts_{};
    DepthFacts facts_;
    LightFieldDisparity disparity_;
    PicturePool pool_;
    std::vector<guint16> no_depth_; /* zeros, for pictures without a depth map */
    guint64 next_picture_ = 0;
};

} // namespace dff
