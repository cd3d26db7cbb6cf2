/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:gstfocalstackinfo
 * @short_description: caps and memory layout of focal stacks
 *
 * A focal stack is one buffer with N frames in exactly one memory, nearest plane first. Plane z is the
 * GstVideoMeta with the id z; a buffer without such metas holds the frames one after the other in the
 * format's default layout.
 */
#include "gstfocalstackinfo.h"

#include <math.h>

G_DEFINE_BOXED_TYPE(GstFocalStackInfo, gst_focal_stack_info, gst_focal_stack_info_copy,
                    gst_focal_stack_info_free)

static GstCaps *as_raw_caps(const GstCaps *caps)
{
    GstCaps *raw = gst_caps_copy(caps);

    gst_structure_set_name(gst_caps_get_structure(raw, 0), "video/x-raw");
    return raw;
}

/* The formats of GST_FOCAL_STACK_FORMATS. */
static gboolean is_stack_format(GstVideoFormat format)
{
    switch (format) {
    case GST_VIDEO_FORMAT_GRAY8:
    case GST_VIDEO_FORMAT_GRAY16_LE:
    case GST_VIDEO_FORMAT_I420:
    case GST_VIDEO_FORMAT_NV12:
    case GST_VIDEO_FORMAT_RGB:
    case GST_VIDEO_FORMAT_BGR:
    case GST_VIDEO_FORMAT_RGBx:
    case GST_VIDEO_FORMAT_BGRx:
    case GST_VIDEO_FORMAT_RGBA64_LE:
        return TRUE;
    default:
        return FALSE;
    }
}

/**
 * gst_focal_stack_info_copy: (skip)
 * @info: a #GstFocalStackInfo
 *
 * Copies what was parsed.
 *
 * Returns: (transfer full): a copy, to be freed with gst_focal_stack_info_free()
 *
 * Since: 0.1
 */
GstFocalStackInfo *gst_focal_stack_info_copy(const GstFocalStackInfo *info)
{
    return g_memdup2(info, sizeof *info);
}

/**
 * gst_focal_stack_info_free: (skip)
 * @info: what gst_focal_stack_info_new_from_caps() or gst_focal_stack_info_copy() gave
 *
 * Frees what was parsed.
 *
 * Since: 0.1
 */
void gst_focal_stack_info_free(GstFocalStackInfo *info)
{
    g_free(info);
}

/**
 * gst_focal_stack_info_new_from_caps: (constructor)
 * @caps: fixed caps
 *
 * For languages that cannot put a #GstVideoInfo on their stack.
 *
 * Returns: (transfer full) (nullable): the parsed caps, or %NULL if @caps are not those of a focal stack
 *
 * Since: 0.1
 */
GstFocalStackInfo *gst_focal_stack_info_new_from_caps(const GstCaps *caps)
{
    GstFocalStackInfo info;

    return gst_focal_stack_info_from_caps(&info, caps) ? gst_focal_stack_info_copy(&info) : NULL;
}

/**
 * gst_focal_stack_info_from_caps: (skip)
 * @info: (out caller-allocates): the parsed caps
 * @caps: fixed caps
 *
 * Parses the caps of focal stacks.
 *
 * Returns: %FALSE if @caps are not those of a focal stack
 *
 * Since: 0.1
 */
gboolean gst_focal_stack_info_from_caps(GstFocalStackInfo *info, const GstCaps *caps)
{
    g_return_val_if_fail(gst_caps_is_fixed(caps), FALSE);

    const GstStructure *structure = gst_caps_get_structure(caps, 0);
    g_autoptr(GstCaps) raw = as_raw_caps(caps);
    gint planes = 0;

    if (!gst_structure_has_name(structure, GST_FOCAL_STACK_CAPS_NAME) ||
        !gst_structure_get_int(structure, "planes", &planes) || planes < 2 ||
        planes > GST_FOCAL_STACK_MAX_PLANES)
        return FALSE;
    info->planes = (guint)planes;
    return gst_video_info_from_caps(&info->frame, raw) &&
           is_stack_format(GST_VIDEO_INFO_FORMAT(&info->frame));
}

/**
 * gst_focal_stack_info_to_caps:
 * @info: format, size, planes and rate
 *
 * Makes the caps of focal stacks.
 *
 * Returns: (transfer full): the caps of such stacks
 *
 * Since: 0.1
 */
GstCaps *gst_focal_stack_info_to_caps(const GstFocalStackInfo *info)
{
    GstCaps *caps = gst_video_info_to_caps(&info->frame);

    gst_structure_set_name(gst_caps_get_structure(caps, 0), GST_FOCAL_STACK_CAPS_NAME);
    gst_caps_set_simple(caps, "planes", G_TYPE_INT, (gint)info->planes, NULL);
    return caps;
}

/**
 * gst_focal_stack_info_get_size:
 * @info: format, size and planes
 *
 * How large a stack is.
 *
 * Returns: bytes of a stack in the default layout
 *
 * Since: 0.1
 */
gsize gst_focal_stack_info_get_size(const GstFocalStackInfo *info)
{
    return GST_VIDEO_INFO_SIZE(&info->frame) * info->planes;
}

static gsize row_bytes(const GstVideoInfo *info, guint component)
{
    return (gsize)GST_VIDEO_INFO_COMP_WIDTH(info, component) * GST_VIDEO_INFO_COMP_PSTRIDE(info, component);
}

/* Where the last row ends, which need not be padded to the stride; G_MAXSIZE if that is no place in memory.
 */
static gsize end_of_rows(const GstVideoInfo *info, guint i, gsize offset, gint stride)
{
    gint component[GST_VIDEO_MAX_COMPONENTS];

    gst_video_format_info_component(info->finfo, i, component);
    const gsize row = row_bytes(info, component[0]);
    const gsize rows = GST_VIDEO_INFO_COMP_HEIGHT(info, component[0]);
    gsize end;

    if (stride < 0 || (gsize)stride < row ||
        !g_size_checked_add(&end, offset, (rows - 1) * (gsize)stride + row))
        return G_MAXSIZE;
    return end;
}

static gboolean fits_caps(const GstVideoMeta *meta, const GstVideoInfo *info)
{
    return meta->format == GST_VIDEO_INFO_FORMAT(info) && meta->n_planes == GST_VIDEO_INFO_N_PLANES(info) &&
           meta->width == (guint)GST_VIDEO_INFO_WIDTH(info) &&
           meta->height == (guint)GST_VIDEO_INFO_HEIGHT(info);
}

/* The plane's meta; NULL and no error where the stack has none at all. */
static const GstVideoMeta *find_meta(const GstFocalStackInfo *info, GstBuffer *buffer, guint plane,
                                     GError **error)
{
    const GstVideoInfo *frame = &info->frame;
    const GstVideoMeta *meta = gst_buffer_get_video_meta_id(buffer, (gint)plane);

    if (meta && !fits_caps(meta, frame)) {
        g_set_error(error, GST_STREAM_ERROR, GST_STREAM_ERROR_FORMAT,
                    "The GstVideoMeta of plane %u says %ux%u %s, but the stack's caps say %dx%d %s", plane,
                    meta->width, meta->height, gst_video_format_to_string(meta->format),
                    GST_VIDEO_INFO_WIDTH(frame), GST_VIDEO_INFO_HEIGHT(frame), GST_VIDEO_INFO_NAME(frame));
        return NULL;
    }
    if (!meta && gst_buffer_get_meta(buffer, GST_VIDEO_META_API_TYPE))
        g_set_error(error, GST_STREAM_ERROR, GST_STREAM_ERROR_FORMAT,
                    "The stack has GstVideoMetas, but none for plane %u of %u", plane, info->planes);
    return meta;
}

/* Bytes of a stack whose rows follow each other without padding. */
static gsize tight_size(const GstFocalStackInfo *info)
{
    const GstVideoInfo *frame = &info->frame;
    gsize size = 0;

    for (guint i = 0; i < GST_VIDEO_INFO_N_PLANES(frame); i++) {
        gint component[GST_VIDEO_MAX_COMPONENTS];
        gst_video_format_info_component(frame->finfo, i, component);
        size +=
            row_bytes(frame, (guint)component[0]) * (gsize)GST_VIDEO_INFO_COMP_HEIGHT(frame, component[0]);
    }
    return size * info->planes;
}

static gboolean tight_rows_error(const GstFocalStackInfo *info, gsize size, GError **error)
{
    g_set_error(
        error, GST_STREAM_ERROR, GST_STREAM_ERROR_FORMAT,
        "The stack has %" G_GSIZE_FORMAT " bytes: its rows are tight, of %" G_GSIZE_FORMAT
        " bytes. Rows of multiples of 4 bytes are expected, here of %d, which make %" G_GSIZE_FORMAT
        " bytes (%u planes of %dx%d %s): pad each row, or crop the pictures to a multiple of 4 pixels",
        size, row_bytes(&info->frame, 0), GST_VIDEO_INFO_PLANE_STRIDE(&info->frame, 0),
        gst_focal_stack_info_get_size(info), info->planes, GST_VIDEO_INFO_WIDTH(&info->frame),
        GST_VIDEO_INFO_HEIGHT(&info->frame), GST_VIDEO_INFO_NAME(&info->frame));
    return FALSE;
}

static gboolean size_error(const GstFocalStackInfo *info, gsize size, gsize needed, GError **error)
{
    if (size == tight_size(info) && size < gst_focal_stack_info_get_size(info))
        return tight_rows_error(info, size, error);
    g_set_error(error, GST_STREAM_ERROR, GST_STREAM_ERROR_FORMAT,
                "The stack has %" G_GSIZE_FORMAT
                " bytes, but its caps (%u planes of %dx%d %s) need %" G_GSIZE_FORMAT,
                size, info->planes, GST_VIDEO_INFO_WIDTH(&info->frame), GST_VIDEO_INFO_HEIGHT(&info->frame),
                GST_VIDEO_INFO_NAME(&info->frame), needed);
    return FALSE;
}

static gboolean locate_by_meta(const GstFocalStackInfo *info, const GstVideoMeta *meta, guint plane,
                               gsize size, gsize offset[GST_VIDEO_MAX_PLANES],
                               gint stride[GST_VIDEO_MAX_PLANES], GError **error)
{
    gsize end = 0;

    for (guint i = 0; i < GST_VIDEO_INFO_N_PLANES(&info->frame); i++) {
        offset[i] = meta->offset[i];
        stride[i] = meta->stride[i];
        end = MAX(end, end_of_rows(&info->frame, i, offset[i], stride[i]));
    }
    if (end == G_MAXSIZE) {
        g_set_error(error, GST_STREAM_ERROR, GST_STREAM_ERROR_FORMAT,
                    "The GstVideoMeta of plane %u has an impossible stride or offset", plane);
        return FALSE;
    }
    return end <= size || size_error(info, size, end, error);
}

/**
 * gst_focal_stack_info_locate_plane:
 * @info: the stack's caps
 * @buffer: a stack
 * @plane: which plane, 0 is the nearest
 * @offset: (out) (array fixed-size=4): byte offsets of its components in @buffer
 * @stride: (out) (array fixed-size=4): their strides in bytes
 * @error: where an error goes
 *
 * Finds a plane by its GstVideoMeta, or by the default layout where the buffer has none; then @buffer must
 * have exactly the size of a stack.
 *
 * Returns: %FALSE with @error set if the buffer does not hold the plane; the message names both sizes
 *
 * Since: 0.1
 */
gboolean gst_focal_stack_info_locate_plane(const GstFocalStackInfo *info, GstBuffer *buffer, guint plane,
                                           gsize offset[GST_VIDEO_MAX_PLANES],
                                           gint stride[GST_VIDEO_MAX_PLANES], GError **error)
{
    g_return_val_if_fail(plane < info->planes, FALSE);

    GError *mismatch = NULL;
    const GstVideoMeta *meta = find_meta(info, buffer, plane, &mismatch);
    const gsize size = gst_buffer_get_size(buffer);

    if (mismatch) {
        g_propagate_error(error, mismatch);
        return FALSE;
    }
    if (meta)
        return locate_by_meta(info, meta, plane, size, offset, stride, error);

    for (guint i = 0; i < GST_VIDEO_INFO_N_PLANES(&info->frame); i++) {
        offset[i] = GST_VIDEO_INFO_SIZE(&info->frame) * plane + GST_VIDEO_INFO_PLANE_OFFSET(&info->frame, i);
        stride[i] = GST_VIDEO_INFO_PLANE_STRIDE(&info->frame, i);
    }
    return size == gst_focal_stack_info_get_size(info) ||
           size_error(info, size, gst_focal_stack_info_get_size(info), error);
}

/* A lens that is at most a micrometre from what it sees; a stage that goes a kilometre. */
#define LARGEST_POWER 1e6
#define LARGEST_POSITION_UM 1e9

static gboolean is_unknown_or_within(gdouble value, gdouble largest)
{
    return isnan(value) || fabs(value) <= largest;
}

/**
 * gst_focal_stack_info_get_meta:
 * @info: the stack's caps
 * @buffer: a stack
 * @error: where an error goes
 *
 * What is known of a stack, where it can be believed: a meta that speaks of as many planes as the caps, with
 * powers within a million dioptres and positions within a kilometre, or unknown ones.
 *
 * Returns: (transfer none) (nullable): the meta; %NULL without @error if @buffer has none, %NULL with @error
 * set if it has one that cannot be
 *
 * Since: 0.1
 */
GstFocalStackMeta *gst_focal_stack_info_get_meta(const GstFocalStackInfo *info, GstBuffer *buffer,
                                                 GError **error)
{
    GstFocalStackMeta *meta = gst_buffer_get_focal_stack_meta(buffer);

    if (meta && meta->planes != info->planes) {
        g_set_error(error, GST_STREAM_ERROR, GST_STREAM_ERROR_FORMAT,
                    "The meta of stack %" G_GUINT64_FORMAT " speaks of %u planes, but its caps of %u",
                    meta->sequence, meta->planes, info->planes);
        return NULL;
    }
    for (guint z = 0; meta && z < meta->planes; z++) {
        GstFocusInfo focus;

        gst_focal_stack_meta_get_focus(meta, z, &focus);
        if (is_unknown_or_within(focus.power, LARGEST_POWER) &&
            is_unknown_or_within(focus.position_um, LARGEST_POSITION_UM))
            continue;
        g_set_error(error, GST_STREAM_ERROR, GST_STREAM_ERROR_FORMAT,
                    "Plane %u of stack %" G_GUINT64_FORMAT
                    " cannot lie at a power of %g dioptres or a position of %g um",
                    z, meta->sequence, focus.power, focus.position_um);
        return NULL;
    }
    return meta;
}

/**
 * gst_focal_stack_info_add_video_metas:
 * @info: the stack's caps
 * @buffer: a writable stack in the default layout
 *
 * Adds a GstVideoMeta a plane, with the plane's number as id.
 *
 * Since: 0.1
 */
void gst_focal_stack_info_add_video_metas(const GstFocalStackInfo *info, GstBuffer *buffer)
{
    const GstVideoInfo *frame = &info->frame;

    g_return_if_fail(GST_IS_BUFFER(buffer));
    g_return_if_fail(gst_buffer_is_writable(buffer));
    for (guint z = 0; z < info->planes; z++) {
        gsize offset[GST_VIDEO_MAX_PLANES];
        for (guint i = 0; i < GST_VIDEO_INFO_N_PLANES(frame); i++)
            offset[i] = GST_VIDEO_INFO_SIZE(frame) * z + GST_VIDEO_INFO_PLANE_OFFSET(frame, i);

        GstVideoMeta *meta = gst_buffer_add_video_meta_full(
            buffer, GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_INFO_FORMAT(frame), GST_VIDEO_INFO_WIDTH(frame),
            GST_VIDEO_INFO_HEIGHT(frame), GST_VIDEO_INFO_N_PLANES(frame), offset, (gint *)frame->stride);
        meta->id = (gint)z;
    }
}
