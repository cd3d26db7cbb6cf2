/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>
#include <optional>

namespace dff {

/* Where an aligned stack lies in the scene: its pixel (x, y) shows what pixel (x + right, y + down) of the
 * stack `anchor` shows. Even numbers. Of stacks with another anchor nothing is known. */
struct StackPlace {
    guint anchor = 0;
    gint right = 0;
    gint down = 0;

    bool operator==(const StackPlace &) const = default;
};

/* A custom meta without tags, with the fields of StackPlace. */
constexpr const char *stack_place_meta_name = "GstFocalStackPlaceMeta";

/* Whoever wants to be told proposes it when memory is allocated. A name may be registered once. */
inline GType stack_place_meta_api()
{
    static const GType api = [] {
        const gchar *tags[] = {nullptr};
        const GstMetaInfo *known = gst_meta_get_info(stack_place_meta_name);
        return (known ? known
                      : gst_meta_register_custom(stack_place_meta_name, tags, nullptr, nullptr, nullptr))
            ->api;
    }();
    return api;
}

inline void tell_stack_place(GstBuffer *stack, const StackPlace &place)
{
    GstCustomMeta *meta = gst_buffer_get_custom_meta(stack, stack_place_meta_name);
    if (!meta)
        meta = gst_buffer_add_custom_meta(stack, stack_place_meta_name);
    gst_structure_set(gst_custom_meta_get_structure(meta), "anchor", G_TYPE_UINT, place.anchor, "right",
                      G_TYPE_INT, place.right, "down", G_TYPE_INT, place.down, nullptr);
}

inline std::optional<StackPlace> stack_place(GstBuffer *stack)
{
    GstCustomMeta *meta = gst_buffer_get_custom_meta(stack, stack_place_meta_name);
    StackPlace place;
    if (!meta ||
        !gst_structure_get(gst_custom_meta_get_structure(meta), "anchor", G_TYPE_UINT, &place.anchor, "right",
                           G_TYPE_INT, &place.right, "down", G_TYPE_INT, &place.down, nullptr))
        return std::nullopt;
    return place;
}

} // namespace dff
