/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/dff/gstfocalstackmeta.h>
#include <gst/video/video.h>

G_BEGIN_DECLS

/**
 * GST_FOCAL_STACK_CAPS_NAME:
 *
 * The media type of focal stacks.
 *
 * Since: 0.1
 */
#define GST_FOCAL_STACK_CAPS_NAME "video/x-focal-stack"
/**
 * GST_FOCAL_STACK_FORMATS:
 *
 * The formats of their planes, as template caps list them.
 *
 * Since: 0.1
 */
#define GST_FOCAL_STACK_FORMATS "{ GRAY8, GRAY16_LE, I420, NV12, RGB, BGR, RGBx, BGRx, RGBA64_LE }"

/**
 * GST_FOCAL_STACK_MAX_SIDE:
 *
 * The greatest width and height of a plane.
 *
 * Since: 0.1
 */
#define GST_FOCAL_STACK_MAX_SIDE 16384
/**
 * GST_FOCAL_STACK_SIZES:
 *
 * The fields of template caps for planes of any size up to #GST_FOCAL_STACK_MAX_SIDE.
 *
 * Since: 0.1
 */
#define GST_FOCAL_STACK_SIZES "width = (int) [ 1, 16384 ], height = (int) [ 1, 16384 ]"

/**
 * GST_FOCAL_STACK_CAPS_MAKE:
 *
 * Template caps of a focal stack; the framerate is stacks per second.
 *
 * Since: 0.1
 */
#define GST_FOCAL_STACK_CAPS_MAKE                                                                            \
    GST_FOCAL_STACK_CAPS_NAME ", format = (string) " GST_FOCAL_STACK_FORMATS ", " GST_FOCAL_STACK_SIZES      \
                              ", planes = (int) [ 2, 64 ], framerate = (fraction) [ 0, max ]"

typedef struct _GstFocalStackInfo GstFocalStackInfo;

/**
 * GstFocalStackInfo:
 * @planes: planes a stack, 2 to 64
 * @frame: format, size, colorimetry of one plane, and its default layout; its frame rate is stacks per second
 *
 * The caps of a focal stack, parsed.
 *
 * Since: 0.1
 */
struct _GstFocalStackInfo {
    guint planes;
    GstVideoInfo frame;
};

#define GST_TYPE_FOCAL_STACK_INFO (gst_focal_stack_info_get_type())
GST_DFF_API GType gst_focal_stack_info_get_type(void);

GST_DFF_API GstFocalStackInfo *gst_focal_stack_info_new_from_caps(const GstCaps *caps);
GST_DFF_API GstFocalStackInfo *gst_focal_stack_info_copy(const GstFocalStackInfo *info);
GST_DFF_API void gst_focal_stack_info_free(GstFocalStackInfo *info);
GST_DFF_API gboolean gst_focal_stack_info_from_caps(GstFocalStackInfo *info, const GstCaps *caps);
GST_DFF_API GstCaps *gst_focal_stack_info_to_caps(const GstFocalStackInfo *info);
GST_DFF_API gsize gst_focal_stack_info_get_size(const GstFocalStackInfo *info);
GST_DFF_API gboolean gst_focal_stack_info_locate_plane(const GstFocalStackInfo *info, GstBuffer *buffer,
                                                       guint plane, gsize offset[GST_VIDEO_MAX_PLANES],
                                                       gint stride[GST_VIDEO_MAX_PLANES], GError **error);
GST_DFF_API GstFocalStackMeta *gst_focal_stack_info_get_meta(const GstFocalStackInfo *info, GstBuffer *buffer,
                                                             GError **error);
GST_DFF_API void gst_focal_stack_info_add_video_metas(const GstFocalStackInfo *info, GstBuffer *buffer);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(GstFocalStackInfo, gst_focal_stack_info_free)

G_END_DECLS
