/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gstdffbytes.h"

void gst_dff_bytes_begin(GstByteWriter *writer, guint8 kind)
{
    gst_byte_writer_init(writer);
    gst_byte_writer_put_uint8(writer, kind);
    gst_byte_writer_put_uint8(writer, GST_DFF_BYTES_VERSION);
}

GBytes *gst_dff_bytes_end(GstByteWriter *writer)
{
    const gsize size = gst_byte_writer_get_size(writer);

    return g_bytes_new_take(gst_byte_writer_reset_and_get_data(writer), size);
}

gboolean gst_dff_bytes_open(GstByteReader *reader, GBytes *bytes, guint8 kind, GError **error)
{
    gsize size = 0;
    const guint8 *data = g_bytes_get_data(bytes, &size);
    guint8 found = 0, version = 0;

    gst_byte_reader_init(reader, data, (guint)MIN(size, G_MAXUINT));
    if (!gst_byte_reader_get_uint8(reader, &found) || !gst_byte_reader_get_uint8(reader, &version) ||
        found != kind) {
        g_set_error(error, GST_STREAM_ERROR, GST_STREAM_ERROR_FORMAT,
                    "These %" G_GSIZE_FORMAT " bytes are not a meta of the kind '%c'", size, kind);
        return FALSE;
    }
    if (version != GST_DFF_BYTES_VERSION) {
        g_set_error(error, GST_STREAM_ERROR, GST_STREAM_ERROR_FORMAT,
                    "A meta of version %u was sent, this library knows version %u: use the same release on "
                    "both sides",
                    version, GST_DFF_BYTES_VERSION);
        return FALSE;
    }
    return TRUE;
}

gboolean gst_dff_bytes_close(const GstByteReader *reader, gboolean complete, GError **error)
{
    const gboolean whole = complete && gst_byte_reader_get_remaining(reader) == 0;

    if (!whole)
        g_set_error(error, GST_STREAM_ERROR, GST_STREAM_ERROR_FORMAT,
                    "The meta is cut short or damaged (%u bytes)", gst_byte_reader_get_size(reader));
    return whole;
}

#if GST_CHECK_VERSION(1, 24, 0)
gboolean gst_dff_bytes_append(GBytes *bytes, GstByteArrayInterface *data, guint8 *version)
{
    gsize size = 0;
    const guint8 *begin = g_bytes_get_data(bytes, &size);
    const gboolean appended = gst_byte_array_interface_append_data(data, begin, size);

    *version = GST_DFF_BYTES_VERSION;
    g_bytes_unref(bytes);
    return appended;
}
#endif
