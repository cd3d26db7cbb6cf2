/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-rtphdrextdff
 * @title: rtphdrextdff
 * @short_description: sends focus and depth metas in RTP header extensions
 *
 * Carries the #GstFocusMeta (which plane of which sweep a frame is) and the #GstDepthMeta (what the pixels of
 * a depth map mean, and of which stack it is) of each frame over RTP, next to any payload, and puts them onto
 * the frames that the depayloader gives out. It is no element of a pipeline: payloaders and depayloaders make
 * one where the caps, or the SDP, of the stream have an extmap field with the URI
 * urn:gst-plugins-dff:rtp-hdrext:metas.
 *
 * The metas are in the last packet of each frame, up to 182 bytes that are not counted in the payloader's
 * mtu: take 200 off it.
 *
 * ## Example launch line
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=60 ! rtpgstpay mtu=1200 config-interval=1 ! \
 *     "application/x-rtp,extmap-1=(string)urn:gst-plugins-dff:rtp-hdrext:metas" ! rtpgstdepay ! \
 *     focalstackmux ! dffdepth ! fakesink
 * ]|
 */
#include "rtphdrextdff.h"

#include "rtp/record_list.h"

#include <algorithm>
#include <gst/dff/dff.h>

GST_DEBUG_CATEGORY_STATIC(gst_rtp_header_extension_dff_debug);
#define GST_CAT_DEFAULT gst_rtp_header_extension_dff_debug

struct _GstRTPHeaderExtensionDff {
    GstRTPHeaderExtension parent;
};

G_DEFINE_FINAL_TYPE(GstRTPHeaderExtensionDff, gst_rtp_header_extension_dff, GST_TYPE_RTP_HEADER_EXTENSION)
/* Payloaders make only extensions with a rank by themselves. */
GST_ELEMENT_REGISTER_DEFINE_WITH_CODE(rtphdrextdff, "rtphdrextdff", GST_RANK_MARGINAL,
                                      GST_TYPE_RTP_HEADER_EXTENSION_DFF,
                                      GST_DEBUG_CATEGORY_INIT(gst_rtp_header_extension_dff_debug,
                                                              "rtphdrextdff", 0,
                                                              "focus and depth metas over RTP"))

namespace {

void append_bytes(std::vector<uint8_t> &list, GBytes *bytes)
{
    gsize size = 0;
    const auto *data = static_cast<const uint8_t *>(g_bytes_get_data(bytes, &size));
    dff::append_record(list, {data, size});
    g_bytes_unref(bytes);
}

/* The metas of a frame as a list of records. */
std::vector<uint8_t> metas_of(GstBuffer *frame)
{
    std::vector<uint8_t> list;
    if (const GstFocusMeta *focus = gst_buffer_get_focus_meta(frame))
        append_bytes(list, gst_focus_meta_to_bytes(focus));
    if (const GstDepthMeta *depth = gst_buffer_get_depth_meta(frame))
        append_bytes(list, gst_depth_meta_to_bytes(depth));
    return list;
}

/* The marker bit of an RTP packet: set in the last one of a frame. */
bool ends_a_frame(GstBuffer *packet)
{
    guint8 marker_and_type = 0;
    return gst_buffer_extract(packet, 1, &marker_and_type, 1) == 1 && (marker_and_type & 0x80);
}

/* Metas of kinds that a later release adds are passed over. */
void add_meta(GstRTPHeaderExtension *extension, GstBuffer *frame, dff::Record record)
{
    g_autoptr(GBytes) bytes = g_bytes_new(record.data(), record.size());
    g_autoptr(GError) error = nullptr;
    const char kind = record.empty() ? '\0' : static_cast<char>(record.front());
    if (kind == 'F' && !gst_buffer_get_focus_meta(frame))
        gst_buffer_add_focus_meta_from_bytes(frame, bytes, &error);
    else if (kind == 'D' && !gst_buffer_get_depth_meta(frame))
        gst_buffer_add_depth_meta_from_bytes(frame, bytes, &error);
    if (error)
        GST_WARNING_OBJECT(extension, "A frame comes without its meta: %s", error->message);
}

} // namespace

static GstRTPHeaderExtensionFlags get_supported_flags(GstRTPHeaderExtension *)
{
    return static_cast<GstRTPHeaderExtensionFlags>(GST_RTP_HEADER_EXTENSION_ONE_BYTE |
                                                   GST_RTP_HEADER_EXTENSION_TWO_BYTE);
}

static gsize get_max_size(GstRTPHeaderExtension *, const GstBuffer *input)
{
    return metas_of(const_cast<GstBuffer *>(input)).size();
}

static gssize write(GstRTPHeaderExtension *extension, const GstBuffer *input, GstRTPHeaderExtensionFlags,
                    GstBuffer *packet, guint8 *data, gsize size)
{
    if (!ends_a_frame(packet))
        return 0;
    const std::vector<uint8_t> list = metas_of(const_cast<GstBuffer *>(input));
    if (list.size() > size)
        return -1;
    std::copy(list.begin(), list.end(), data);
    GST_LOG_OBJECT(extension, "%" G_GSIZE_FORMAT " bytes of metas of %" GST_PTR_FORMAT, list.size(), input);
    return static_cast<gssize>(list.size());
}

/* Damaged metas are a warning and never FALSE: with that, depayloaders of GStreamer 1.22 lock up. */
static gboolean read(GstRTPHeaderExtension *extension, GstRTPHeaderExtensionFlags, const guint8 *data,
                     gsize size, GstBuffer *frame)
{
    const auto records = dff::records_of({data, size});
    if (!records) {
        GST_WARNING_OBJECT(extension, "A frame comes without its metas: the last one is cut short");
        return TRUE;
    }
    GST_LOG_OBJECT(extension, "%" G_GSIZE_FORMAT " metas for %" GST_PTR_FORMAT, records->size(), frame);
    for (const dff::Record record : *records)
        add_meta(extension, frame, record);
    return TRUE;
}

static void gst_rtp_header_extension_dff_init(GstRTPHeaderExtensionDff *) {}

static void gst_rtp_header_extension_dff_class_init(GstRTPHeaderExtensionDffClass *klass)
{
    auto *extension_class = GST_RTP_HEADER_EXTENSION_CLASS(klass);
    auto *element_class = GST_ELEMENT_CLASS(klass);

    extension_class->get_supported_flags = get_supported_flags;
    extension_class->get_max_size = get_max_size;
    extension_class->write = write;
    extension_class->read = read;
    gst_rtp_header_extension_class_set_uri(extension_class, GST_RTP_HEADER_EXTENSION_DFF_URI);
    gst_element_class_set_static_metadata(
        element_class, "Focus and depth metas over RTP", GST_RTP_HDREXT_ELEMENT_CLASS,
        "Sends focus and depth metas in RTP header extensions", "the gst-plugins-dff authors");
}
