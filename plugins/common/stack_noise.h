/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>
#include <optional>

namespace dff {

/* A name may be registered once, and several plug-ins have this: each calls it as it is loaded. */
inline const char *stack_noise_meta_name()
{
    static const char *const name = [] {
        constexpr const char *wanted = "GstFocalStackNoiseMeta";
        if (!gst_meta_get_info(wanted)) {
            const gchar *tags[] = {nullptr};
            gst_meta_register_custom(wanted, tags, nullptr, nullptr, nullptr);
        }
        return wanted;
    }();
    return name;
}

/* What an element knows of the noise of a stack that it sends: a custom meta without tags, by the name
 * GstFocalStackNoiseMeta, whose field "luma" (double) is the standard deviation of luma, of 255, the same in
 * all planes. Whoever changes the pictures takes it away. */
inline void tell_stack_noise(GstBuffer *stack, std::optional<double> luma)
{
    GstCustomMeta *meta = gst_buffer_get_custom_meta(stack, stack_noise_meta_name());
    if (!luma) {
        if (meta)
            gst_buffer_remove_meta(stack, &meta->meta);
        return;
    }
    if (!meta)
        meta = gst_buffer_add_custom_meta(stack, stack_noise_meta_name());
    gst_structure_set(gst_custom_meta_get_structure(meta), "luma", G_TYPE_DOUBLE, *luma, nullptr);
}

inline std::optional<double> stack_noise(GstBuffer *stack)
{
    GstCustomMeta *meta = gst_buffer_get_custom_meta(stack, stack_noise_meta_name());
    gdouble luma = 0.0;
    if (!meta || !gst_structure_get_double(gst_custom_meta_get_structure(meta), "luma", &luma))
        return std::nullopt;
    return luma;
}

} // namespace dff
