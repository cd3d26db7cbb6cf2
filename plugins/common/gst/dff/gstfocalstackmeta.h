/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/dff/gstfocusmeta.h>

G_BEGIN_DECLS

/**
 * GST_FOCAL_STACK_MAX_PLANES:
 *
 * The most planes that a stack has.
 *
 * Since: 0.1
 */
#define GST_FOCAL_STACK_MAX_PLANES 64
#define GST_FOCAL_STACK_META_API_TYPE (gst_focal_stack_meta_api_get_type())
#define GST_FOCAL_STACK_META_INFO (gst_focal_stack_meta_get_info())

typedef struct _GstFocalStackMeta GstFocalStackMeta;

/**
 * GstFocalStackMeta:
 * @meta: parent
 * @sequence: number of the stack; one more a stack, so that depth and stack can be matched
 * @planes: how many planes the stack has, 2 to 64
 * @complete: whether every plane was taken in this sweep
 * @missing: bit z is set where plane z was lost and does not hold a picture of its own
 * @repeated: bit z is set where plane z repeats a picture from elsewhere (another sweep or plane)
 *
 * What is known of a focal stack. It has no tags.
 *
 * Since: 0.1
 */
struct _GstFocalStackMeta {
    GstMeta meta;

    guint64 sequence;
    guint planes;
    gboolean complete;
    guint64 missing;
    guint64 repeated;

    /*< private >*/
    GstFocusInfo *focus;
    gpointer shared;
};

GST_DFF_API GType gst_focal_stack_meta_api_get_type(void);
GST_DFF_API const GstMetaInfo *gst_focal_stack_meta_get_info(void);

GST_DFF_API GstFocalStackMeta *gst_buffer_add_focal_stack_meta(GstBuffer *buffer, guint64 sequence,
                                                               guint planes);
GST_DFF_API GstFocalStackMeta *gst_buffer_get_focal_stack_meta(GstBuffer *buffer);
GST_DFF_API void gst_focal_stack_meta_set_focus(GstFocalStackMeta *meta, guint plane,
                                                const GstFocusInfo *info);
GST_DFF_API gboolean gst_focal_stack_meta_get_focus(const GstFocalStackMeta *meta, guint plane,
                                                    GstFocusInfo *info);

GST_DFF_API GBytes *gst_focal_stack_meta_to_bytes(const GstFocalStackMeta *meta);
GST_DFF_API GstFocalStackMeta *gst_buffer_add_focal_stack_meta_from_bytes(GstBuffer *buffer, GBytes *bytes,
                                                                          GError **error);

G_END_DECLS
