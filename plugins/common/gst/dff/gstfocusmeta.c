/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:gstfocusmeta
 * @short_description: which plane of which sweep a frame is
 */
#include "private/gstdffbytes.h"
#include "private/gstfocusbytes.h"

#include <math.h>

#define KIND 'F'

/**
 * gst_focus_meta_api_get_type: (skip)
 *
 * The type of the meta's API, as #GST_FOCUS_META_API_TYPE.
 *
 * Returns: the type
 *
 * Since: 0.1
 */
GType gst_focus_meta_api_get_type(void)
{
    static GType type;
    static const gchar *tags[] = {NULL};

    if (g_once_init_enter(&type))
        g_once_init_leave(&type, gst_meta_api_type_register("GstFocusMetaAPI", tags));
    return type;
}

static void set_focus(GstFocusMeta *self, const GstFocusInfo *info)
{
    self->sweep = info->sweep;
    self->plane = info->plane;
    self->planes = info->planes;
    self->power = info->power;
    self->position_um = info->position_um;
    self->code = info->code;
    self->exposure = info->exposure;
    self->frame_id = info->frame_id;
}

static gboolean init(GstMeta *meta, gpointer params, GstBuffer *buffer)
{
    GstFocusInfo unknown;

    (void)params;
    (void)buffer;
    gst_focus_info_init(&unknown);
    set_focus((GstFocusMeta *)meta, &unknown);
    return TRUE;
}

static gboolean transform(GstBuffer *destination, GstMeta *meta, GstBuffer *buffer, GQuark type,
                          gpointer data)
{
    GstFocusInfo info;

    (void)buffer;
    (void)type;
    (void)data;
    if (gst_buffer_get_focus_meta(destination))
        return TRUE;
    gst_focus_meta_get_focus((GstFocusMeta *)meta, &info);
    return gst_buffer_add_focus_meta(destination, &info) != NULL;
}

#if GST_CHECK_VERSION(1, 24, 0)
static gboolean serialize(const GstMeta *meta, GstByteArrayInterface *data, guint8 *version)
{
    return gst_dff_bytes_append(gst_focus_meta_to_bytes((const GstFocusMeta *)meta), data, version);
}

static GstMeta *deserialize(const GstMetaInfo *info, GstBuffer *buffer, const guint8 *data, gsize size,
                            guint8 version)
{
    g_autoptr(GBytes) bytes = g_bytes_new_static(data, size);

    (void)info;
    (void)version; /* the bytes say it too */
    return (GstMeta *)gst_buffer_add_focus_meta_from_bytes(buffer, bytes, NULL);
}

static const GstMetaInfo *register_meta(void)
{
    GstMetaInfo *info = gst_meta_info_new(GST_FOCUS_META_API_TYPE, "GstFocusMeta", sizeof(GstFocusMeta));

    info->init_func = init;
    info->transform_func = transform;
    info->serialize_func = serialize;
    info->deserialize_func = deserialize;
    return gst_meta_info_register(info);
}
#else
static const GstMetaInfo *register_meta(void)
{
    return gst_meta_register(GST_FOCUS_META_API_TYPE, "GstFocusMeta", sizeof(GstFocusMeta), init, NULL,
                             transform);
}
#endif

/**
 * gst_focus_meta_get_info: (skip)
 *
 * What GStreamer knows of the meta, as #GST_FOCUS_META_INFO.
 *
 * Returns: (transfer none): a description that lives as long as the program
 *
 * Since: 0.1
 */
const GstMetaInfo *gst_focus_meta_get_info(void)
{
    static const GstMetaInfo *info;

    if (g_once_init_enter((GstMetaInfo **)&info))
        g_once_init_leave((GstMetaInfo **)&info, (GstMetaInfo *)register_meta());
    return info;
}

/**
 * gst_focus_info_init:
 * @info: a #GstFocusInfo
 *
 * Sets every field to "unknown".
 *
 * Since: 0.1
 */
void gst_focus_info_init(GstFocusInfo *info)
{
    *info = (GstFocusInfo){.power = NAN, .position_um = NAN, .code = -1, .exposure = GST_CLOCK_TIME_NONE};
}

/**
 * gst_buffer_add_focus_meta:
 * @buffer: a writable #GstBuffer
 * @info: how the plane was focused and taken
 *
 * Says with a buffer which plane of which sweep a frame is.
 *
 * Returns: (transfer none) (nullable): the meta, which belongs to @buffer, or %NULL if @buffer is not
 * writable
 *
 * Since: 0.1
 */
GstFocusMeta *gst_buffer_add_focus_meta(GstBuffer *buffer, const GstFocusInfo *info)
{
    g_return_val_if_fail(GST_IS_BUFFER(buffer), NULL);
    g_return_val_if_fail(gst_buffer_is_writable(buffer), NULL);
    g_return_val_if_fail(info, NULL);

    GstFocusMeta *self = (GstFocusMeta *)gst_buffer_add_meta(buffer, GST_FOCUS_META_INFO, NULL);
    set_focus(self, info);
    return self;
}

/**
 * gst_buffer_get_focus_meta:
 * @buffer: a #GstBuffer
 *
 * Asks a buffer which plane of which sweep a frame is.
 *
 * Returns: (transfer none) (nullable): the meta, or %NULL if @buffer has none
 *
 * Since: 0.1
 */
GstFocusMeta *gst_buffer_get_focus_meta(GstBuffer *buffer)
{
    return (GstFocusMeta *)gst_buffer_get_meta(buffer, GST_FOCUS_META_API_TYPE);
}

/**
 * gst_focus_meta_get_focus:
 * @meta: a #GstFocusMeta
 * @info: (out caller-allocates): where the facts go
 *
 * Copies what the meta says, as gst_buffer_add_focus_meta() takes it.
 *
 * Since: 0.1
 */
void gst_focus_meta_get_focus(const GstFocusMeta *meta, GstFocusInfo *info)
{
    *info = (GstFocusInfo){
        .sweep = meta->sweep,
        .plane = meta->plane,
        .planes = meta->planes,
        .power = meta->power,
        .position_um = meta->position_um,
        .code = meta->code,
        .exposure = meta->exposure,
        .frame_id = meta->frame_id,
    };
}

void gst_focus_info_write(const GstFocusInfo *info, GstByteWriter *writer)
{
    gst_byte_writer_put_uint64_be(writer, info->sweep);
    gst_byte_writer_put_uint32_be(writer, info->plane);
    gst_byte_writer_put_uint32_be(writer, info->planes);
    gst_byte_writer_put_float64_be(writer, info->power);
    gst_byte_writer_put_float64_be(writer, info->position_um);
    gst_byte_writer_put_int32_be(writer, info->code);
    gst_byte_writer_put_uint64_be(writer, info->exposure);
    gst_byte_writer_put_uint64_be(writer, info->frame_id);
}

gboolean gst_focus_info_read(GstFocusInfo *info, GstByteReader *reader)
{
    return gst_byte_reader_get_uint64_be(reader, &info->sweep) &&
           gst_byte_reader_get_uint32_be(reader, &info->plane) &&
           gst_byte_reader_get_uint32_be(reader, &info->planes) &&
           gst_byte_reader_get_float64_be(reader, &info->power) &&
           gst_byte_reader_get_float64_be(reader, &info->position_um) &&
           gst_byte_reader_get_int32_be(reader, &info->code) &&
           gst_byte_reader_get_uint64_be(reader, &info->exposure) &&
           gst_byte_reader_get_uint64_be(reader, &info->frame_id);
}

/**
 * gst_focus_meta_to_bytes:
 * @meta: a #GstFocusMeta
 *
 * Packs a meta for files and networks.
 *
 * Returns: (transfer full): the meta as bytes with a version, for files and networks
 *
 * Since: 0.1
 */
GBytes *gst_focus_meta_to_bytes(const GstFocusMeta *meta)
{
    GstByteWriter writer;
    GstFocusInfo info;

    gst_focus_meta_get_focus(meta, &info);
    gst_dff_bytes_begin(&writer, KIND);
    gst_focus_info_write(&info, &writer);
    return gst_dff_bytes_end(&writer);
}

/**
 * gst_buffer_add_focus_meta_from_bytes:
 * @buffer: a writable #GstBuffer
 * @bytes: what gst_focus_meta_to_bytes() gave
 * @error: where an error goes
 *
 * Gives a buffer a meta that was packed. The bytes may come from anybody.
 *
 * Returns: (transfer none) (nullable): the meta, or %NULL with @error set if @bytes are damaged or of an
 * unknown version
 *
 * Since: 0.1
 */
GstFocusMeta *gst_buffer_add_focus_meta_from_bytes(GstBuffer *buffer, GBytes *bytes, GError **error)
{
    g_return_val_if_fail(GST_IS_BUFFER(buffer), NULL);
    g_return_val_if_fail(gst_buffer_is_writable(buffer), NULL);
    g_return_val_if_fail(bytes != NULL, NULL);

    GstByteReader reader;
    GstFocusInfo info;

    gst_focus_info_init(&info);
    if (!gst_dff_bytes_open(&reader, bytes, KIND, error))
        return NULL;
    if (!gst_dff_bytes_close(&reader, gst_focus_info_read(&info, &reader), error))
        return NULL;
    return gst_buffer_add_focus_meta(buffer, &info);
}
