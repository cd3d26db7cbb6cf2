/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>

#include <string>

namespace dff {

enum class AlignMode { Estimate, Calibration };
enum class MotionChoice { Auto, Similarity, Homography };

/* What a user can set on focalstackalign. */
struct AlignSettings {
    AlignMode mode = AlignMode::Estimate;
    std::string calibration; /* file, or empty */
    MotionChoice motion_model = MotionChoice::Auto;
    bool even_brightness = false;
};

/* The properties of focalstackalign, from 1 to align_properties_end - 1. */
constexpr guint align_properties_end = 5;

void install_align_properties(GObjectClass *object_class);

/* False if `id` is not one of these properties. */
bool set_align_property(AlignSettings &settings, guint id, const GValue *value);
bool get_align_property(const AlignSettings &settings, guint id, GValue *value);

} // namespace dff
