/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "mount_media.h"

#include "depth_attributes.h"

#include <gst/rtp/rtp.h>

using dff::Capture;
using dff::Mount;
using dff::Outlet;

namespace {

const char *const extension_uri = "urn:gst-plugins-dff:rtp-hdrext:metas";

/* What a media takes from the capture; goes with it. */
class Feed {
public:
    Feed(GstRTSPMedia *media, const Mount &mount, Capture &capture) : mount_(mount), capture_(capture)
    {
        const dff::ObjectPointer<GstElement> bin(gst_rtsp_media_get_element(media));
        for (const std::string &output : mount.outputs) {
            const dff::ObjectPointer<GstElement> appsrc(
                gst_bin_get_by_name(GST_BIN(bin.get()), output.c_str()));
            outlets_.push_back(std::make_shared<Outlet>(appsrc.get()));
            capture.attach(output, outlets_.back());
        }
    }
    ~Feed()
    {
        for (const auto &outlet : outlets_)
            capture_.detach(outlet);
    }
    Feed(const Feed &) = delete;
    Feed &operator=(const Feed &) = delete;

    void describe(GstSDPMessage *sdp) const
    {
        const auto info = capture_.depth_info();
        if (!info)
            return;
        for (const unsigned stream : mount_.depth_streams)
            for (const auto &[name, value] : dff::depth_attributes(*info))
                gst_sdp_media_add_attribute(const_cast<GstSDPMedia *>(gst_sdp_message_get_media(sdp, stream)),
                                            name.c_str(), value.c_str());
    }

private:
    const Mount &mount_;
    Capture &capture_;
    std::vector<std::shared_ptr<Outlet>> outlets_;
};

const char *const feed_key = "dff-feed";

} // namespace

/* A media that says in its SDP what the pixels of its depth mean. */
struct DffMedia {
    GstRTSPMedia parent;
};
struct DffMediaClass {
    GstRTSPMediaClass parent;
};
G_DEFINE_TYPE(DffMedia, dff_media, GST_TYPE_RTSP_MEDIA)

static gboolean setup_sdp(GstRTSPMedia *media, GstSDPMessage *sdp, GstSDPInfo *info)
{
    if (!GST_RTSP_MEDIA_CLASS(dff_media_parent_class)->setup_sdp(media, sdp, info))
        return FALSE;
    if (const auto *feed = static_cast<const Feed *>(g_object_get_data(G_OBJECT(media), feed_key)))
        feed->describe(sdp);
    return TRUE;
}

static void dff_media_init(DffMedia *) {}

static void dff_media_class_init(DffMediaClass *klass)
{
    klass->parent.setup_sdp = setup_sdp;
}

struct DffMediaFactory {
    GstRTSPMediaFactory parent;
    const Mount *mount;
    Capture *capture;
};
struct DffMediaFactoryClass {
    GstRTSPMediaFactoryClass parent;
};
G_DEFINE_TYPE(DffMediaFactory, dff_media_factory, GST_TYPE_RTSP_MEDIA_FACTORY)

/* Without this a client could ask for as many encoders as there are query strings. */
static gchar *gen_key(GstRTSPMediaFactory *factory, const GstRTSPUrl *)
{
    return g_strdup(reinterpret_cast<DffMediaFactory *>(factory)->mount->path.c_str());
}

static void add_header_extensions(GstBin *bin)
{
    for (guint i = 0;; i++) {
        g_autofree char *name = g_strdup_printf("pay%u", i);
        const dff::ObjectPointer<GstElement> payloader(gst_bin_get_by_name(bin, name));
        if (!payloader)
            return;
        GstRTPHeaderExtension *extension = gst_rtp_header_extension_create_from_uri(extension_uri);
        if (!extension)
            return; /* main() has said so */
        gst_rtp_header_extension_set_id(extension, 1);
        g_signal_emit_by_name(payloader.get(), "add-extension", extension);
        gst_object_unref(extension);
    }
}

static void configure(GstRTSPMediaFactory *factory, GstRTSPMedia *media)
{
    GST_RTSP_MEDIA_FACTORY_CLASS(dff_media_factory_parent_class)->configure(factory, media);
    const auto *self = reinterpret_cast<DffMediaFactory *>(factory);
    const dff::ObjectPointer<GstElement> bin(gst_rtsp_media_get_element(media));
    add_header_extensions(GST_BIN(bin.get()));

    const GDestroyNotify destroy = [](gpointer feed) { delete static_cast<Feed *>(feed); };
    g_object_set_data_full(G_OBJECT(media), feed_key, new Feed(media, *self->mount, *self->capture), destroy);
    const auto end = +[](GstRTSPMedia *ended) { g_object_set_data(G_OBJECT(ended), feed_key, nullptr); };
    g_signal_connect(media, "unprepared", G_CALLBACK(end), nullptr);
}

static void dff_media_factory_init(DffMediaFactory *) {}

static void dff_media_factory_class_init(DffMediaFactoryClass *klass)
{
    klass->parent.gen_key = gen_key;
    klass->parent.configure = configure;
}

namespace dff {

ObjectPointer<GstRTSPMediaFactory> make_factory(const Mount &mount, Capture &capture, bool tcp_only)
{
    auto *self = reinterpret_cast<DffMediaFactory *>(g_object_new(dff_media_factory_get_type(), nullptr));
    self->mount = &mount;
    self->capture = &capture;
    GstRTSPMediaFactory *factory = &self->parent;
    gst_rtsp_media_factory_set_launch(factory, ("( " + mount.launch + " )").c_str());
    gst_rtsp_media_factory_set_shared(factory, TRUE);
    gst_rtsp_media_factory_set_media_gtype(factory, dff_media_get_type());
    if (tcp_only)
        gst_rtsp_media_factory_set_protocols(factory, GST_RTSP_LOWER_TRANS_TCP);
    const ObjectPointer<GstClock> clock(gst_system_clock_obtain());
    gst_rtsp_media_factory_set_clock(factory, clock.get());
    return ObjectPointer<GstRTSPMediaFactory>(factory);
}

} // namespace dff
