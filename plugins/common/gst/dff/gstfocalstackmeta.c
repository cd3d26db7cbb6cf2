/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:gstfocalstackmeta
 * @short_description: what is known of a focal stack
 */
#include "private/gstfocalstackshared.h"

#include "private/gstdffbytes.h"
#include "private/gstfocusbytes.h"

#define KIND 'S'

/**
 * gst_focal_stack_meta_api_get_type: (skip)
 *
 * The type of the meta's API, as #GST_FOCAL_STACK_META_API_TYPE.
 *
 * Returns: the type
 *
 * Since: 0.1
 */
GType gst_focal_stack_meta_api_get_type(void)
{
    static GType type;
    static const gchar *tags[] = {NULL};

    if (g_once_init_enter(&type))
        g_once_init_leave(&type, gst_meta_api_type_register("GstFocalStackMetaAPI", tags));
    return type;
}

static void shared_clear(gpointer shared)
{
    gst_focal_stack_shared_set(shared, NULL, NULL);
    g_mutex_clear(&((GstFocalStackShared *)shared)->mutex);
}

static GstFocalStackShared *shared_new(void)
{
    GstFocalStackShared *shared = g_atomic_rc_box_new0(GstFocalStackShared);

    g_mutex_init(&shared->mutex);
    return shared;
}

static void shared_unref(GstFocalStackShared *shared)
{
    g_atomic_rc_box_release_full(shared, shared_clear);
}

void gst_focal_stack_shared_set(GstFocalStackShared *shared, gpointer data, GDestroyNotify destroy)
{
    if (shared->destroy)
        shared->destroy(shared->data);
    shared->data = data;
    shared->destroy = destroy;
}

static gboolean init(GstMeta *meta, gpointer params, GstBuffer *buffer)
{
    GstFocalStackMeta *self = (GstFocalStackMeta *)meta;

    (void)params;
    (void)buffer;
    self->sequence = 0;
    self->planes = 0;
    self->complete = FALSE;
    self->missing = 0;
    self->repeated = 0;
    self->focus = NULL;
    self->shared = shared_new();
    return TRUE;
}

static void release(GstMeta *meta, GstBuffer *buffer)
{
    (void)buffer;
    g_clear_pointer(&((GstFocalStackMeta *)meta)->focus, g_free);
    g_clear_pointer(&((GstFocalStackMeta *)meta)->shared, shared_unref);
}

/* A copy of the metadata alone. */
static gboolean has_same_memory(GstBuffer *one, GstBuffer *other)
{
    return gst_buffer_n_memory(one) == 1 && gst_buffer_n_memory(other) == 1 &&
           gst_buffer_peek_memory(one, 0) == gst_buffer_peek_memory(other, 0);
}

static gboolean transform(GstBuffer *destination, GstMeta *meta, GstBuffer *buffer, GQuark type,
                          gpointer data)
{
    const GstFocalStackMeta *self = (GstFocalStackMeta *)meta;

    (void)type;
    (void)data;
    if (gst_buffer_get_focal_stack_meta(destination))
        return TRUE;

    GstFocalStackMeta *copy = gst_buffer_add_focal_stack_meta(destination, self->sequence, self->planes);
    if (!copy)
        return FALSE;
    copy->complete = self->complete;
    copy->missing = self->missing;
    copy->repeated = self->repeated;
    memcpy(copy->focus, self->focus, self->planes * sizeof(GstFocusInfo));
    if (has_same_memory(destination, buffer)) {
        shared_unref(copy->shared);
        copy->shared = g_atomic_rc_box_acquire(self->shared);
    }
    return TRUE;
}

#if GST_CHECK_VERSION(1, 24, 0)
static gboolean serialize(const GstMeta *meta, GstByteArrayInterface *data, guint8 *version)
{
    return gst_dff_bytes_append(gst_focal_stack_meta_to_bytes((const GstFocalStackMeta *)meta), data,
                                version);
}

static GstMeta *deserialize(const GstMetaInfo *info, GstBuffer *buffer, const guint8 *data, gsize size,
                            guint8 version)
{
    g_autoptr(GBytes) bytes = g_bytes_new_static(data, size);

    (void)info;
    (void)version; /* the bytes say it too */
    return (GstMeta *)gst_buffer_add_focal_stack_meta_from_bytes(buffer, bytes, NULL);
}

static const GstMetaInfo *register_meta(void)
{
    GstMetaInfo *info =
        gst_meta_info_new(GST_FOCAL_STACK_META_API_TYPE, "GstFocalStackMeta", sizeof(GstFocalStackMeta));

    info->init_func = init;
    info->free_func = release;
    info->transform_func = transform;
    info->serialize_func = serialize;
    info->deserialize_func = deserialize;
    return gst_meta_info_register(info);
}
#else
static const GstMetaInfo *register_meta(void)
{
    return gst_meta_register(GST_FOCAL_STACK_META_API_TYPE, "GstFocalStackMeta", sizeof(GstFocalStackMeta),
                             init, release, transform);
}
#endif

/**
 * gst_focal_stack_meta_get_info: (skip)
 *
 * What GStreamer knows of the meta, as #GST_FOCAL_STACK_META_INFO.
 *
 * Returns: (transfer none): a description that lives as long as the program
 *
 * Since: 0.1
 */
const GstMetaInfo *gst_focal_stack_meta_get_info(void)
{
    static const GstMetaInfo *info;

    if (g_once_init_enter((GstMetaInfo **)&info))
        g_once_init_leave((GstMetaInfo **)&info, (GstMetaInfo *)register_meta());
    return info;
}

/**
 * gst_buffer_add_focal_stack_meta:
 * @buffer: a writable #GstBuffer
 * @sequence: number of the stack
 * @planes: planes of the stack, 2 to 64
 *
 * Adds the meta of a complete stack whose planes' focus is unknown.
 *
 * Returns: (transfer none) (nullable): the meta, which belongs to @buffer, or %NULL if @buffer is not
 * writable
 *
 * Since: 0.1
 */
GstFocalStackMeta *gst_buffer_add_focal_stack_meta(GstBuffer *buffer, guint64 sequence, guint planes)
{
    g_return_val_if_fail(GST_IS_BUFFER(buffer), NULL);
    g_return_val_if_fail(gst_buffer_is_writable(buffer), NULL);
    g_return_val_if_fail(planes >= 2 && planes <= GST_FOCAL_STACK_MAX_PLANES, NULL);

    GstFocalStackMeta *self =
        (GstFocalStackMeta *)gst_buffer_add_meta(buffer, GST_FOCAL_STACK_META_INFO, NULL);
    self->sequence = sequence;
    self->planes = planes;
    self->complete = TRUE;
    self->focus = g_new(GstFocusInfo, planes);
    for (guint z = 0; z < planes; z++) {
        gst_focus_info_init(&self->focus[z]);
        self->focus[z].plane = z;
        self->focus[z].planes = planes;
    }
    return self;
}

/**
 * gst_buffer_get_focal_stack_meta:
 * @buffer: a #GstBuffer
 *
 * Asks a buffer what is known of a focal stack.
 *
 * Returns: (transfer none) (nullable): the meta, or %NULL if @buffer has none
 *
 * Since: 0.1
 */
GstFocalStackMeta *gst_buffer_get_focal_stack_meta(GstBuffer *buffer)
{
    return (GstFocalStackMeta *)gst_buffer_get_meta(buffer, GST_FOCAL_STACK_META_API_TYPE);
}

/**
 * gst_focal_stack_meta_set_focus:
 * @meta: a #GstFocalStackMeta
 * @plane: which plane, below the stack's number of planes
 * @info: how it was focused and taken
 *
 * Says how a plane of the stack was focused and taken.
 *
 * Since: 0.1
 */
void gst_focal_stack_meta_set_focus(GstFocalStackMeta *meta, guint plane, const GstFocusInfo *info)
{
    g_return_if_fail(meta != NULL && info != NULL);
    g_return_if_fail(plane < meta->planes);

    meta->focus[plane] = *info;
}

/**
 * gst_focal_stack_meta_get_focus:
 * @meta: a #GstFocalStackMeta
 * @plane: which plane
 * @info: (out caller-allocates): how it was focused and taken
 *
 * Asks how a plane of the stack was focused and taken.
 *
 * Returns: %FALSE if the stack has no such plane
 *
 * Since: 0.1
 */
gboolean gst_focal_stack_meta_get_focus(const GstFocalStackMeta *meta, guint plane, GstFocusInfo *info)
{
    g_return_val_if_fail(meta != NULL && info != NULL, FALSE);
    if (plane >= meta->planes)
        return FALSE;
    *info = meta->focus[plane];
    return TRUE;
}

/**
 * gst_focal_stack_meta_to_bytes:
 * @meta: a #GstFocalStackMeta
 *
 * Packs a meta for files and networks.
 *
 * Returns: (transfer full): the meta as bytes with a version, for files and networks
 *
 * Since: 0.1
 */
GBytes *gst_focal_stack_meta_to_bytes(const GstFocalStackMeta *meta)
{
    GstByteWriter writer;

    gst_dff_bytes_begin(&writer, KIND);
    gst_byte_writer_put_uint64_be(&writer, meta->sequence);
    gst_byte_writer_put_uint8(&writer, (guint8)meta->planes);
    gst_byte_writer_put_uint8(&writer, meta->complete ? 1 : 0);
    gst_byte_writer_put_uint64_be(&writer, meta->missing);
    gst_byte_writer_put_uint64_be(&writer, meta->repeated);
    for (guint z = 0; z < meta->planes; z++)
        gst_focus_info_write(&meta->focus[z], &writer);
    return gst_dff_bytes_end(&writer);
}

static gboolean read_planes(GstFocusInfo *focus, guint planes, GstByteReader *reader)
{
    for (guint z = 0; z < planes; z++)
        if (!gst_focus_info_read(&focus[z], reader))
            return FALSE;
    return TRUE;
}

/* Whether a bit mask speaks of the stack's planes only. */
static gboolean names_planes(guint64 mask, guint planes)
{
    return planes == GST_FOCAL_STACK_MAX_PLANES || mask >> planes == 0;
}

/**
 * gst_buffer_add_focal_stack_meta_from_bytes:
 * @buffer: a writable #GstBuffer
 * @bytes: what gst_focal_stack_meta_to_bytes() gave
 * @error: where an error goes
 *
 * Gives a buffer a meta that was packed. The bytes may come from anybody.
 *
 * Returns: (transfer none) (nullable): the meta, or %NULL with @error set if @bytes are damaged or of an
 * unknown version
 *
 * Since: 0.1
 */
GstFocalStackMeta *gst_buffer_add_focal_stack_meta_from_bytes(GstBuffer *buffer, GBytes *bytes,
                                                              GError **error)
{
    g_return_val_if_fail(GST_IS_BUFFER(buffer), NULL);
    g_return_val_if_fail(gst_buffer_is_writable(buffer), NULL);
    g_return_val_if_fail(bytes != NULL, NULL);

    GstByteReader reader;
    GstFocusInfo focus[GST_FOCAL_STACK_MAX_PLANES];
    guint64 sequence = 0, missing = 0, repeated = 0;
    guint8 planes = 0, complete = 0;

    if (!gst_dff_bytes_open(&reader, bytes, KIND, error))
        return NULL;
    const gboolean whole =
        gst_byte_reader_get_uint64_be(&reader, &sequence) && gst_byte_reader_get_uint8(&reader, &planes) &&
        gst_byte_reader_get_uint8(&reader, &complete) && gst_byte_reader_get_uint64_be(&reader, &missing) &&
        gst_byte_reader_get_uint64_be(&reader, &repeated) && planes >= 2 &&
        planes <= GST_FOCAL_STACK_MAX_PLANES && names_planes(missing | repeated, planes) &&
        read_planes(focus, planes, &reader);
    if (!gst_dff_bytes_close(&reader, whole, error))
        return NULL;

    GstFocalStackMeta *self = gst_buffer_add_focal_stack_meta(buffer, sequence, planes);
    self->complete = complete != 0;
    self->missing = missing;
    self->repeated = repeated;
    memcpy(self->focus, focus, planes * sizeof(GstFocusInfo));
    return self;
}
