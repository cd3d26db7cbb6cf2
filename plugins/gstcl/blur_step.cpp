/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gstcl/blur_step.h"

namespace dff {

namespace {

constexpr const char *meta_name = "DffBlurStep";
constexpr const char *field = "pixels";

/* Once for the process. Who scales a map must not keep it. */
void ensure_registered()
{
    static const bool registered = [] {
        const gchar *tags[] = {"video", "size", nullptr};
        return gst_meta_get_info(meta_name) ||
               gst_meta_register_custom(meta_name, tags, nullptr, nullptr, nullptr);
    }();
    (void)registered;
}

} // namespace

void add_blur_step(GstBuffer *depth, float pixels)
{
    ensure_registered();
    if (GstCustomMeta *meta = gst_buffer_add_custom_meta(depth, meta_name))
        gst_structure_set(gst_custom_meta_get_structure(meta), field, G_TYPE_DOUBLE, double{pixels}, nullptr);
}

float blur_step_of(GstBuffer *depth)
{
    ensure_registered();
    gdouble pixels = 0.0;
    if (GstCustomMeta *meta = gst_buffer_get_custom_meta(depth, meta_name))
        gst_structure_get_double(gst_custom_meta_get_structure(meta), field, &pixels);
    return static_cast<float>(pixels);
}

} // namespace dff
