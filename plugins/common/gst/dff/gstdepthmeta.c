/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:gstdepthmeta
 * @short_description: what the pixels of a depth map mean
 */
#include "gstdepthmeta.h"

#include "private/gstdffbytes.h"

#include <gst/video/video.h>
#include <math.h>

#define KIND 'D'

GType gst_depth_unit_get_type(void)
{
    static GType type;
    static const GEnumValue values[] = {
        {GST_DEPTH_UNIT_AUTO, "Dioptre where the planes' powers are known, else index", "auto"},
        {GST_DEPTH_UNIT_INDEX, "Plane position, 0 is the nearest", "index"},
        {GST_DEPTH_UNIT_DIOPTRE, "Object vergence in dioptres", "dioptre"},
        {GST_DEPTH_UNIT_MILLIMETRE, "Distance in millimetres", "millimetre"},
        {GST_DEPTH_UNIT_MICROMETRE, "Stage position in micrometres", "micrometre"},
        {0, NULL, NULL},
    };

    if (g_once_init_enter(&type))
        g_once_init_leave(&type, g_enum_register_static("GstDepthUnit", values));
    return type;
}

/**
 * gst_depth_meta_api_get_type: (skip)
 *
 * The type of the meta's API, as #GST_DEPTH_META_API_TYPE.
 *
 * Returns: the type
 *
 * Since: 0.1
 */
GType gst_depth_meta_api_get_type(void)
{
    static GType type;
    static const gchar *tags[] = {GST_META_TAG_VIDEO_STR, GST_META_TAG_VIDEO_SIZE_STR,
                                  GST_META_TAG_VIDEO_ORIENTATION_STR, NULL};

    if (g_once_init_enter(&type))
        g_once_init_leave(&type, gst_meta_api_type_register("GstDepthMetaAPI", tags));
    return type;
}

/* Of a picture, which GST_DEPTH_UNIT_AUTO is not. */
static gboolean is_unit(gint unit)
{
    return unit >= GST_DEPTH_UNIT_INDEX && unit <= GST_DEPTH_UNIT_MICROMETRE;
}

static void set_depth(GstDepthMeta *self, const GstDepthInfo *info)
{
    self->unit = info->unit;
    self->scale = info->scale;
    self->offset = info->offset;
    self->near = info->near;
    self->far = info->far;
    self->has_intrinsics = info->has_intrinsics;
    self->fx = info->fx;
    self->fy = info->fy;
    self->cx = info->cx;
    self->cy = info->cy;
    memcpy(self->distortion, info->distortion, sizeof self->distortion);
    self->sequence = info->sequence;
    self->sweep = info->sweep;
}

static gboolean init(GstMeta *meta, gpointer params, GstBuffer *buffer)
{
    GstDepthInfo unknown;

    (void)params;
    (void)buffer;
    gst_depth_info_init(&unknown);
    set_depth((GstDepthMeta *)meta, &unknown);
    return TRUE;
}

/* Pixel centres lie at whole numbers, hence the halves. */
static void scale_intrinsics(GstDepthInfo *info, const GstVideoMetaTransform *scale)
{
    const gdouble x = (gdouble)GST_VIDEO_INFO_WIDTH(scale->out_info) / GST_VIDEO_INFO_WIDTH(scale->in_info);
    const gdouble y = (gdouble)GST_VIDEO_INFO_HEIGHT(scale->out_info) / GST_VIDEO_INFO_HEIGHT(scale->in_info);

    info->fx *= x;
    info->fy *= y;
    info->cx = (info->cx + 0.5) * x - 0.5;
    info->cy = (info->cy + 0.5) * y - 0.5;
}

#if GST_CHECK_VERSION(1, 28, 0)
/* Flips, turns by right angles, crops and scales lead axes to axes: x' = a x + b, or the same of y.
 * Intrinsics of what else a picture may go through cannot be told. p1 and p2 of the distortion go with y and
 * x. */
static void map_intrinsics(GstDepthInfo *info, const GstVideoMetaTransformMatrix *map)
{
    const gboolean swaps = map->matrix[0][0] == 0;
    const gdouble x = swaps ? map->matrix[0][1] : map->matrix[0][0];
    const gdouble y = swaps ? map->matrix[1][0] : map->matrix[1][1];
    const gdouble others[] = {swaps ? map->matrix[1][1] : map->matrix[0][1], swaps ? 0 : map->matrix[1][0],
                              map->matrix[2][0], map->matrix[2][1]};
    const GstDepthInfo old = *info;

    for (guint i = 0; i < G_N_ELEMENTS(others); i++)
        info->has_intrinsics = info->has_intrinsics && others[i] == 0;
    const gdouble cx = (swaps ? old.cy - map->in_rectangle.y : old.cx - map->in_rectangle.x);
    const gdouble cy = (swaps ? old.cx - map->in_rectangle.x : old.cy - map->in_rectangle.y);
    info->fx = fabs(x) * (swaps ? old.fy : old.fx);
    info->fy = fabs(y) * (swaps ? old.fx : old.fy);
    info->cx = x * cx + map->matrix[0][2] + map->out_rectangle.x;
    info->cy = y * cy + map->matrix[1][2] + map->out_rectangle.y;
    info->distortion[3] = copysign(1, x) * old.distortion[swaps ? 2 : 3];
    info->distortion[2] = copysign(1, y) * old.distortion[swaps ? 3 : 2];
}
#endif

static void transform_intrinsics(GstDepthInfo *info, GQuark type, gpointer data)
{
    if (GST_VIDEO_META_TRANSFORM_IS_SCALE(type))
        scale_intrinsics(info, data);
#if GST_CHECK_VERSION(1, 28, 0)
    if (GST_VIDEO_META_TRANSFORM_IS_MATRIX(type))
        map_intrinsics(info, data);
#endif
}

/* What else is done to a picture leaves nobody knows which intrinsics: then there is no meta. */
static gboolean is_known(GQuark type)
{
#if GST_CHECK_VERSION(1, 28, 0)
    if (GST_VIDEO_META_TRANSFORM_IS_MATRIX(type))
        return TRUE;
#endif
    return GST_META_TRANSFORM_IS_COPY(type) || GST_VIDEO_META_TRANSFORM_IS_SCALE(type);
}

static gboolean transform(GstBuffer *destination, GstMeta *meta, GstBuffer *buffer, GQuark type,
                          gpointer data)
{
    GstDepthInfo info;

    (void)buffer;
    if (!is_known(type))
        return FALSE;
    if (gst_buffer_get_depth_meta(destination))
        return TRUE;

    gst_depth_meta_get_depth((GstDepthMeta *)meta, &info);
    if (info.has_intrinsics)
        transform_intrinsics(&info, type, data);
    return gst_buffer_add_depth_meta(destination, &info) != NULL;
}

#if GST_CHECK_VERSION(1, 24, 0)
static gboolean serialize(const GstMeta *meta, GstByteArrayInterface *data, guint8 *version)
{
    return gst_dff_bytes_append(gst_depth_meta_to_bytes((const GstDepthMeta *)meta), data, version);
}

static GstMeta *deserialize(const GstMetaInfo *info, GstBuffer *buffer, const guint8 *data, gsize size,
                            guint8 version)
{
    g_autoptr(GBytes) bytes = g_bytes_new_static(data, size);

    (void)info;
    (void)version; /* the bytes say it too */
    return (GstMeta *)gst_buffer_add_depth_meta_from_bytes(buffer, bytes, NULL);
}

static const GstMetaInfo *register_meta(void)
{
    GstMetaInfo *info = gst_meta_info_new(GST_DEPTH_META_API_TYPE, "GstDepthMeta", sizeof(GstDepthMeta));

    info->init_func = init;
    info->transform_func = transform;
    info->serialize_func = serialize;
    info->deserialize_func = deserialize;
    return gst_meta_info_register(info);
}
#else
static const GstMetaInfo *register_meta(void)
{
    return gst_meta_register(GST_DEPTH_META_API_TYPE, "GstDepthMeta", sizeof(GstDepthMeta), init, NULL,
                             transform);
}
#endif

/**
 * gst_depth_meta_get_info: (skip)
 *
 * What GStreamer knows of the meta, as #GST_DEPTH_META_INFO.
 *
 * Returns: (transfer none): a description that lives as long as the program
 *
 * Since: 0.1
 */
const GstMetaInfo *gst_depth_meta_get_info(void)
{
    static const GstMetaInfo *info;

    if (g_once_init_enter((GstMetaInfo **)&info))
        g_once_init_leave((GstMetaInfo **)&info, (GstMetaInfo *)register_meta());
    return info;
}

/**
 * gst_depth_info_init:
 * @info: a #GstDepthInfo
 *
 * Sets every field to "unknown": unit index, no range, no intrinsics.
 *
 * Since: 0.1
 */
void gst_depth_info_init(GstDepthInfo *info)
{
    *info = (GstDepthInfo){.unit = GST_DEPTH_UNIT_INDEX, .near = NAN, .far = NAN};
}

/**
 * gst_buffer_add_depth_meta:
 * @buffer: a writable #GstBuffer
 * @info: what its pixels mean
 *
 * Says with a buffer what the pixels of a depth map mean.
 *
 * Returns: (transfer none) (nullable): the meta, which belongs to @buffer, or %NULL if @buffer is not
 * writable
 *
 * Since: 0.1
 */
GstDepthMeta *gst_buffer_add_depth_meta(GstBuffer *buffer, const GstDepthInfo *info)
{
    g_return_val_if_fail(GST_IS_BUFFER(buffer), NULL);
    g_return_val_if_fail(gst_buffer_is_writable(buffer), NULL);
    g_return_val_if_fail(info && is_unit(info->unit), NULL);

    GstDepthMeta *self = (GstDepthMeta *)gst_buffer_add_meta(buffer, GST_DEPTH_META_INFO, NULL);
    set_depth(self, info);
    return self;
}

/**
 * gst_buffer_get_depth_meta:
 * @buffer: a #GstBuffer
 *
 * Asks a buffer what the pixels of a depth map mean.
 *
 * Returns: (transfer none) (nullable): the meta, or %NULL if @buffer has none
 *
 * Since: 0.1
 */
GstDepthMeta *gst_buffer_get_depth_meta(GstBuffer *buffer)
{
    return (GstDepthMeta *)gst_buffer_get_meta(buffer, GST_DEPTH_META_API_TYPE);
}

/**
 * gst_depth_meta_get_depth:
 * @meta: a #GstDepthMeta
 * @info: (out caller-allocates): where the facts go
 *
 * Copies what the meta says, as gst_buffer_add_depth_meta() takes it.
 *
 * Since: 0.1
 */
void gst_depth_meta_get_depth(const GstDepthMeta *meta, GstDepthInfo *info)
{
    *info = (GstDepthInfo){
        .unit = meta->unit,
        .scale = meta->scale,
        .offset = meta->offset,
        .near = meta->near,
        .far = meta->far,
        .has_intrinsics = meta->has_intrinsics,
        .fx = meta->fx,
        .fy = meta->fy,
        .cx = meta->cx,
        .cy = meta->cy,
        .sequence = meta->sequence,
        .sweep = meta->sweep,
    };
    memcpy(info->distortion, meta->distortion, sizeof info->distortion);
}

static const gchar *unit_nick(GstDepthUnit unit)
{
    g_autoptr(GEnumClass) units = g_type_class_ref(GST_TYPE_DEPTH_UNIT);

    return g_enum_get_value(units, unit)->value_nick;
}

/**
 * gst_depth_info_to_caps:
 * @info: what the pixels of the stream mean
 * @caps: writable caps of the stream
 *
 * Writes the fields depth-unit, depth-near and depth-far, which raw transforms and payloaders keep. near and
 * far stand there only where they are known; older ones are removed.
 *
 * Since: 0.1
 */
void gst_depth_info_to_caps(const GstDepthInfo *info, GstCaps *caps)
{
    g_return_if_fail(info && is_unit(info->unit));
    g_return_if_fail(GST_IS_CAPS(caps) && gst_caps_is_writable(caps));

    for (guint i = 0; i < gst_caps_get_size(caps); i++)
        gst_structure_remove_fields(gst_caps_get_structure(caps, i), "depth-near", "depth-far", NULL);
    gst_caps_set_simple(caps, "depth-unit", G_TYPE_STRING, unit_nick(info->unit), NULL);
    if (!isnan(info->near) && !isnan(info->far))
        gst_caps_set_simple(caps, "depth-near", G_TYPE_DOUBLE, info->near, "depth-far", G_TYPE_DOUBLE,
                            info->far, NULL);
}

/**
 * gst_depth_info_from_caps:
 * @info: (inout): gets the unit, near and far; the rest is left alone
 * @caps: fixed caps of a depth stream
 *
 * Reads the fields that gst_depth_info_to_caps() wrote.
 *
 * Returns: %FALSE if @caps do not say the unit
 *
 * Since: 0.1
 */
gboolean gst_depth_info_from_caps(GstDepthInfo *info, const GstCaps *caps)
{
    const GstStructure *structure = gst_caps_get_structure(caps, 0);
    const gchar *nick = gst_structure_get_string(structure, "depth-unit");
    g_autoptr(GEnumClass) units = g_type_class_ref(GST_TYPE_DEPTH_UNIT);
    const GEnumValue *unit = nick ? g_enum_get_value_by_nick(units, nick) : NULL;

    if (!unit || unit->value == GST_DEPTH_UNIT_AUTO)
        return FALSE;
    info->unit = (GstDepthUnit)unit->value;
    gst_structure_get_double(structure, "depth-near", &info->near);
    gst_structure_get_double(structure, "depth-far", &info->far);
    return TRUE;
}

/**
 * gst_depth_meta_to_bytes:
 * @meta: a #GstDepthMeta
 *
 * Packs a meta for files and networks.
 *
 * Returns: (transfer full): the meta as bytes with a version, for files and networks
 *
 * Since: 0.1
 */
GBytes *gst_depth_meta_to_bytes(const GstDepthMeta *meta)
{
    const gdouble numbers[] = {meta->scale, meta->offset, meta->near, meta->far,
                               meta->fx,    meta->fy,     meta->cx,   meta->cy};
    GstByteWriter writer;

    gst_dff_bytes_begin(&writer, KIND);
    gst_byte_writer_put_uint8(&writer, (guint8)meta->unit);
    gst_byte_writer_put_uint8(&writer, meta->has_intrinsics ? 1 : 0);
    for (guint i = 0; i < G_N_ELEMENTS(numbers); i++)
        gst_byte_writer_put_float64_be(&writer, numbers[i]);
    for (guint i = 0; i < G_N_ELEMENTS(meta->distortion); i++)
        gst_byte_writer_put_float64_be(&writer, meta->distortion[i]);
    gst_byte_writer_put_uint64_be(&writer, meta->sequence);
    gst_byte_writer_put_uint64_be(&writer, meta->sweep);
    return gst_dff_bytes_end(&writer);
}

static gboolean read_depth(GstDepthInfo *info, GstByteReader *reader)
{
    gdouble *const numbers[] = {&info->scale, &info->offset, &info->near, &info->far,
                                &info->fx,    &info->fy,     &info->cx,   &info->cy};
    guint8 unit = 0, has_intrinsics = 0;

    if (!gst_byte_reader_get_uint8(reader, &unit) || !gst_byte_reader_get_uint8(reader, &has_intrinsics))
        return FALSE;
    if (!is_unit(unit))
        return FALSE;
    info->unit = (GstDepthUnit)unit;
    info->has_intrinsics = has_intrinsics != 0;
    for (guint i = 0; i < G_N_ELEMENTS(numbers); i++)
        if (!gst_byte_reader_get_float64_be(reader, numbers[i]))
            return FALSE;
    for (guint i = 0; i < G_N_ELEMENTS(info->distortion); i++)
        if (!gst_byte_reader_get_float64_be(reader, &info->distortion[i]))
            return FALSE;
    return gst_byte_reader_get_uint64_be(reader, &info->sequence) &&
           gst_byte_reader_get_uint64_be(reader, &info->sweep);
}

/**
 * gst_buffer_add_depth_meta_from_bytes:
 * @buffer: a writable #GstBuffer
 * @bytes: what gst_depth_meta_to_bytes() gave
 * @error: where an error goes
 *
 * Gives a buffer a meta that was packed. The bytes may come from anybody.
 *
 * Returns: (transfer none) (nullable): the meta, or %NULL with @error set if @bytes are damaged or of an
 * unknown version
 *
 * Since: 0.1
 */
GstDepthMeta *gst_buffer_add_depth_meta_from_bytes(GstBuffer *buffer, GBytes *bytes, GError **error)
{
    g_return_val_if_fail(GST_IS_BUFFER(buffer), NULL);
    g_return_val_if_fail(gst_buffer_is_writable(buffer), NULL);
    g_return_val_if_fail(bytes != NULL, NULL);

    GstByteReader reader;
    GstDepthInfo info;

    if (!gst_dff_bytes_open(&reader, bytes, KIND, error))
        return NULL;
    gst_depth_info_init(&info);
    if (!gst_dff_bytes_close(&reader, read_depth(&info, &reader), error))
        return NULL;
    return gst_buffer_add_depth_meta(buffer, &info);
}
