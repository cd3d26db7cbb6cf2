/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/dff/dff-prelude.h>

G_BEGIN_DECLS

#define GST_TYPE_DEPTH_UNIT (gst_depth_unit_get_type())
#define GST_DEPTH_META_API_TYPE (gst_depth_meta_api_get_type())
#define GST_DEPTH_META_INFO (gst_depth_meta_get_info())

typedef struct _GstDepthInfo GstDepthInfo;
typedef struct _GstDepthMeta GstDepthMeta;

/**
 * GstDepthUnit:
 * @GST_DEPTH_UNIT_AUTO: dioptre where the planes' powers are known, else index; only as a wish, never in a
 * meta
 * @GST_DEPTH_UNIT_INDEX: plane position, 0 is the nearest plane
 * @GST_DEPTH_UNIT_DIOPTRE: object vergence, 1 / metres
 * @GST_DEPTH_UNIT_MILLIMETRE: distance from the entrance pupil (the Z16 convention)
 * @GST_DEPTH_UNIT_MICROMETRE: stage position
 *
 * What the numbers of a depth map count.
 *
 * Since: 0.1
 */
typedef enum {
    GST_DEPTH_UNIT_AUTO,
    GST_DEPTH_UNIT_INDEX,
    GST_DEPTH_UNIT_DIOPTRE,
    GST_DEPTH_UNIT_MILLIMETRE,
    GST_DEPTH_UNIT_MICROMETRE,
} GstDepthUnit;

/**
 * GstDepthInfo:
 * @unit: unit of @scale and @offset
 * @scale: unit value = @offset + @scale * pixel
 * @offset: unit value = @offset + @scale * pixel
 * @near: object vergence of the nearest plane in dioptres, NAN if unknown
 * @far: object vergence of the farthest plane in dioptres, NAN if unknown
 * @has_intrinsics: whether the camera's intrinsics are known
 * @fx: focal length along x in pixels
 * @fy: focal length along y in pixels
 * @cx: principal point in pixels
 * @cy: principal point in pixels
 * @distortion: OpenCV's k1, k2, p1, p2, k3
 * @sequence: number of the stack the depth was computed from
 * @sweep: number of the sweep it was taken in
 *
 * What the pixels of a depth map mean. Pixel 0 is "no value"; a smaller pixel is nearer in every unit.
 *
 * Since: 0.1
 */
struct _GstDepthInfo {
    GstDepthUnit unit;
    gdouble scale;
    gdouble offset;
    gdouble near;
    gdouble far;
    gboolean has_intrinsics;
    gdouble fx;
    gdouble fy;
    gdouble cx;
    gdouble cy;
    gdouble distortion[5];
    guint64 sequence;
    guint64 sweep;
};

/**
 * GstDepthMeta:
 * @meta: parent
 * @unit: see #GstDepthInfo
 * @scale: see #GstDepthInfo
 * @offset: see #GstDepthInfo
 * @near: see #GstDepthInfo
 * @far: see #GstDepthInfo
 * @has_intrinsics: see #GstDepthInfo
 * @fx: see #GstDepthInfo
 * @fy: see #GstDepthInfo
 * @cx: see #GstDepthInfo
 * @cy: see #GstDepthInfo
 * @distortion: see #GstDepthInfo
 * @sequence: see #GstDepthInfo
 * @sweep: see #GstDepthInfo
 *
 * Goes with each depth frame. Tags: video and size; a scaled frame gets scaled intrinsics. Scale depth with
 * nearest-neighbour: other filters mix the 0 of "no value" in.
 *
 * Since: 0.1
 */
struct _GstDepthMeta {
    GstMeta meta;

    GstDepthUnit unit;
    gdouble scale;
    gdouble offset;
    gdouble near;
    gdouble far;
    gboolean has_intrinsics;
    gdouble fx;
    gdouble fy;
    gdouble cx;
    gdouble cy;
    gdouble distortion[5];
    guint64 sequence;
    guint64 sweep;
};

GST_DFF_API GType gst_depth_unit_get_type(void);
GST_DFF_API GType gst_depth_meta_api_get_type(void);
GST_DFF_API const GstMetaInfo *gst_depth_meta_get_info(void);

GST_DFF_API void gst_depth_info_init(GstDepthInfo *info);

GST_DFF_API GstDepthMeta *gst_buffer_add_depth_meta(GstBuffer *buffer, const GstDepthInfo *info);
GST_DFF_API GstDepthMeta *gst_buffer_get_depth_meta(GstBuffer *buffer);
GST_DFF_API void gst_depth_meta_get_depth(const GstDepthMeta *meta, GstDepthInfo *info);

GST_DFF_API void gst_depth_info_to_caps(const GstDepthInfo *info, GstCaps *caps);
GST_DFF_API gboolean gst_depth_info_from_caps(GstDepthInfo *info, const GstCaps *caps);

GST_DFF_API GBytes *gst_depth_meta_to_bytes(const GstDepthMeta *meta);
GST_DFF_API GstDepthMeta *gst_buffer_add_depth_meta_from_bytes(GstBuffer *buffer, GBytes *bytes,
                                                               GError **error);

G_END_DECLS
