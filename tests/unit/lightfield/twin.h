/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/light_field_geometry.h"

#include <array>
#include <glm/vec3.hpp>
#include <vector>

namespace dff {

/* The plain C++ twin of light_field_layers.cl and light_field_trace.cl, of a picture's colours (R, G, B) and
 * positions in the sweep (NAN: unknown). */
class TwinLayers {
public:
    TwinLayers(const LightFieldGeometry &geometry, PictureSize picture, const std::vector<glm::dvec3> &color,
               const std::vector<float> &positions);

    glm::dvec3 trace(glm::dvec2 origin, glm::dvec2 slope, bool fill) const;

private:
    struct Ground {
        int left = -1, right = -1;
    };

    double &height(int x, int y) { return height_[static_cast<size_t>(y * size_.x + x)]; }
    double height(int x, int y) const { return height_[static_cast<size_t>(y * size_.x + x)]; }
    void fill_unknown(int y);
    void hide(int y);
    int ground(int x, int y, int direction) const;
    glm::dvec3 beyond(int x, int y, int ground) const;
    glm::dvec3 sample(const std::vector<glm::dvec3> &picture, glm::dvec2 point) const;

    glm::ivec2 size_;
    double lowest_, range_, step_;
    int reach_;
    std::vector<glm::dvec3> color_, hidden_color_;
    std::vector<double> height_, hidden_height_;
};

} // namespace dff
