/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/dff/dff-prelude.h>

G_BEGIN_DECLS

#define GST_FOCUS_META_API_TYPE (gst_focus_meta_api_get_type())
#define GST_FOCUS_META_INFO (gst_focus_meta_get_info())

typedef struct _GstFocusInfo GstFocusInfo;
typedef struct _GstFocusMeta GstFocusMeta;

/**
 * GstFocusInfo:
 * @sweep: number of the sweep the picture was taken in
 * @plane: number of the plane within the sweep, 0 is the nearest
 * @planes: planes a sweep, 2 to 64
 * @code: code the lens driver was given, or -1
 * @power: object vergence of the plane in focus in dioptres (1 / metres; 0 is infinity), NAN if unknown
 * @position_um: stage position in micrometres (microscopes), NAN if unknown
 * @exposure: exposure time in nanoseconds, or GST_CLOCK_TIME_NONE
 * @frame_id: the camera's number of the frame
 *
 * How one plane of a sweep was focused and taken.
 *
 * Since: 0.1
 */
struct _GstFocusInfo {
    guint64 sweep;
    guint plane;
    guint planes;
    gdouble power;
    gdouble position_um;
    gint code;
    GstClockTime exposure;
    guint64 frame_id;
};

/**
 * GstFocusMeta:
 * @meta: parent
 * @sweep: see #GstFocusInfo
 * @plane: see #GstFocusInfo
 * @planes: see #GstFocusInfo
 * @power: see #GstFocusInfo
 * @position_um: see #GstFocusInfo
 * @code: see #GstFocusInfo
 * @exposure: see #GstFocusInfo
 * @frame_id: see #GstFocusInfo
 *
 * Says of a video frame which plane of which sweep it is. It has no tags, so that converters, croppers and
 * scalers keep it.
 *
 * Since: 0.1
 */
struct _GstFocusMeta {
    GstMeta meta;

    guint64 sweep;
    guint plane;
    guint planes;
    gdouble power;
    gdouble position_um;
    gint code;
    GstClockTime exposure;
    guint64 frame_id;
};

GST_DFF_API GType gst_focus_meta_api_get_type(void);
GST_DFF_API const GstMetaInfo *gst_focus_meta_get_info(void);

GST_DFF_API void gst_focus_info_init(GstFocusInfo *info);

GST_DFF_API GstFocusMeta *gst_buffer_add_focus_meta(GstBuffer *buffer, const GstFocusInfo *info);
GST_DFF_API GstFocusMeta *gst_buffer_get_focus_meta(GstBuffer *buffer);
GST_DFF_API void gst_focus_meta_get_focus(const GstFocusMeta *meta, GstFocusInfo *info);

GST_DFF_API GBytes *gst_focus_meta_to_bytes(const GstFocusMeta *meta);
GST_DFF_API GstFocusMeta *gst_buffer_add_focus_meta_from_bytes(GstBuffer *buffer, GBytes *bytes,
                                                               GError **error);

G_END_DECLS
