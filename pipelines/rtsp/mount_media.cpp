/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "mount_media.h"

#include "depth_attributes.h"
#include "log.h"

#include <gst/rtp/rtp.h>
#include <mutex>

using dff::Capture;
using dff::Mount;
using dff::ObjectPointer;
using dff::Outlet;

namespace {

const char *const extension_uri = "urn:gst-plugins-dff:rtp-hdrext:metas";

/* Far longer than a client takes from asking for a media to having it. */
constexpr guint seconds_pinned = 1;

/* What a media takes from the capture; goes with it. */
class Feed {
public:
    Feed(GstRTSPMedia *media, const Mount &mount, std::shared_ptr<Capture> capture)
        : mount_(mount), capture_(std::move(capture))
    {
        const ObjectPointer<GstElement> bin(gst_rtsp_media_get_element(media));
        for (const std::string &output : mount.outputs) {
            const ObjectPointer<GstElement> appsrc(gst_bin_get_by_name(GST_BIN(bin.get()), output.c_str()));
            outlets_.push_back(std::make_shared<Outlet>(appsrc.get()));
            capture_->attach(output, outlets_.back());
        }
    }
    ~Feed()
    {
        for (const auto &outlet : outlets_)
            capture_->detach(outlet);
    }
    Feed(const Feed &) = delete;
    Feed &operator=(const Feed &) = delete;

    const std::string &path() const { return mount_.path; }

    void describe(GstSDPMessage *sdp) const
    {
        for (const auto &[stream, output] : mount_.depth_streams) {
            const auto info = capture_->depth_info(output);
            if (!info)
                continue;
            for (const auto &[name, value] : dff::depth_attributes(*info))
                gst_sdp_media_add_attribute(const_cast<GstSDPMedia *>(gst_sdp_message_get_media(sdp, stream)),
                                            name.c_str(), value.c_str());
        }
    }

private:
    const Mount &mount_;
    const std::shared_ptr<Capture> capture_;
    std::vector<std::shared_ptr<Outlet>> outlets_;
};

const char *const feed_key = "dff-feed";

} // namespace

/* A media that says in its SDP what the pixels of its depth mean, and in the log why it cannot be served. */
struct DffMedia {
    GstRTSPMedia parent;
};
struct DffMediaClass {
    GstRTSPMediaClass parent;
};
G_DEFINE_TYPE(DffMedia, dff_media, GST_TYPE_RTSP_MEDIA)

static const Feed *feed_of(GstRTSPMedia *media)
{
    return static_cast<const Feed *>(g_object_get_data(G_OBJECT(media), feed_key));
}

static gboolean setup_sdp(GstRTSPMedia *media, GstSDPMessage *sdp, GstSDPInfo *info)
{
    if (!GST_RTSP_MEDIA_CLASS(dff_media_parent_class)->setup_sdp(media, sdp, info))
        return FALSE;
    if (const Feed *feed = feed_of(media))
        feed->describe(sdp);
    return TRUE;
}

/* Its clients are answered 503, which says nothing of the reason. */
static gboolean handle_message(GstRTSPMedia *media, GstMessage *message)
{
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
        g_autoptr(GError) error = nullptr;
        g_autofree gchar *details = nullptr;
        gst_message_parse_error(message, &error, &details);
        const Feed *feed = feed_of(media);
        g_warning("%s cannot be served: %s (%s)", feed ? feed->path().c_str() : "A mount", error->message,
                  details ? details : "no details");
    }
    return GST_RTSP_MEDIA_CLASS(dff_media_parent_class)->handle_message(media, message);
}

static void dff_media_init(DffMedia *) {}

static void dff_media_class_init(DffMediaClass *klass)
{
    klass->parent.setup_sdp = setup_sdp;
    klass->parent.handle_message = handle_message;
}

struct DffMediaFactoryState {
    const Mount *mount;
    std::shared_ptr<Capture> capture;

    std::mutex mutex;                     /* of what follows; no other lock is taken under it */
    dff::WeakPointer<GstRTSPMedia> media; /* that clients share now */
    unsigned ended = 0;                   /* how many came before it */
};

struct DffMediaFactory {
    GstRTSPMediaFactory parent;
    DffMediaFactoryState *state;
};
struct DffMediaFactoryClass {
    GstRTSPMediaFactoryClass parent;
};
G_DEFINE_TYPE(DffMediaFactory, dff_media_factory, GST_TYPE_RTSP_MEDIA_FACTORY)

static DffMediaFactoryState &state_of(GstRTSPMediaFactory *factory)
{
    return *reinterpret_cast<DffMediaFactory *>(factory)->state;
}

/* Keeps the media prepared for a moment; false if its last client is gone and it is past that. */
static bool pin(GstRTSPMedia *media)
{
    if (!gst_rtsp_media_prepare(media, nullptr))
        return false;
    const auto unpin = +[](gpointer pinned) -> gboolean {
        gst_rtsp_media_unprepare(GST_RTSP_MEDIA(pinned));
        return G_SOURCE_REMOVE;
    };
    g_timeout_add_seconds_full(G_PRIORITY_DEFAULT, seconds_pinned, unpin, g_object_ref(media),
                               g_object_unref);
    return true;
}

/* Media with the same key are shared. A media that ends just now would still be given to a client, who is
 * then refused: so it is pinned, or else gets another key. The query string is no part of the key: a client
 * could ask for as many encoders as there are query strings. */
static gchar *gen_key(GstRTSPMediaFactory *factory, const GstRTSPUrl *)
{
    DffMediaFactoryState &state = state_of(factory);
    const auto [media, generation] = [&] {
        const std::lock_guard lock(state.mutex);
        return std::pair(state.media.get(), state.ended);
    }();
    const bool over = media && !pin(media.get());
    const std::lock_guard lock(state.mutex);
    if (over && state.ended == generation)
        state.ended++;
    return g_strdup_printf("%u", state.ended);
}

static void add_header_extensions(GstBin *bin)
{
    for (guint i = 0;; i++) {
        g_autofree char *name = g_strdup_printf("pay%u", i);
        const ObjectPointer<GstElement> payloader(gst_bin_get_by_name(bin, name));
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

static void end_feed(GstRTSPMedia *media)
{
    GST_INFO_OBJECT(media, "The last client is gone");
    g_object_set_data(G_OBJECT(media), feed_key, nullptr);
}

static void configure(GstRTSPMediaFactory *factory, GstRTSPMedia *media)
{
    GST_RTSP_MEDIA_FACTORY_CLASS(dff_media_factory_parent_class)->configure(factory, media);
    DffMediaFactoryState &state = state_of(factory);
    const ObjectPointer<GstElement> bin(gst_rtsp_media_get_element(media));
    add_header_extensions(GST_BIN(bin.get()));

    const GDestroyNotify destroy = [](gpointer feed) { delete static_cast<Feed *>(feed); };
    g_object_set_data_full(G_OBJECT(media), feed_key, new Feed(media, *state.mount, state.capture), destroy);
    g_signal_connect(media, "unprepared", G_CALLBACK(end_feed), nullptr);
    GST_INFO_OBJECT(media, "Made for %s", state.mount->path.c_str());
    const std::lock_guard lock(state.mutex);
    state.media.set(media);
}

static void finalize(GObject *object)
{
    delete reinterpret_cast<DffMediaFactory *>(object)->state;
    G_OBJECT_CLASS(dff_media_factory_parent_class)->finalize(object);
}

static void dff_media_factory_init(DffMediaFactory *self)
{
    self->state = new DffMediaFactoryState;
}

static void dff_media_factory_class_init(DffMediaFactoryClass *klass)
{
    G_OBJECT_CLASS(klass)->finalize = finalize;
    klass->parent.gen_key = gen_key;
    klass->parent.configure = configure;
}

namespace dff {

ObjectPointer<GstRTSPMediaFactory> make_factory(const Mount &mount, std::shared_ptr<Capture> capture,
                                                bool tcp_only)
{
    ObjectPointer<GstRTSPMediaFactory> factory(
        GST_RTSP_MEDIA_FACTORY(g_object_new(dff_media_factory_get_type(), nullptr)));
    DffMediaFactoryState &state = state_of(factory.get());
    state.mount = &mount;
    state.capture = std::move(capture);
    gst_rtsp_media_factory_set_launch(factory.get(), ("( " + mount.launch + " )").c_str());
    gst_rtsp_media_factory_set_shared(factory.get(), TRUE);
    gst_rtsp_media_factory_set_media_gtype(factory.get(), dff_media_get_type());
    if (tcp_only)
        gst_rtsp_media_factory_set_protocols(factory.get(), GST_RTSP_LOWER_TRANS_TCP);
    const ObjectPointer<GstClock> clock(gst_system_clock_obtain());
    gst_rtsp_media_factory_set_clock(factory.get(), clock.get());
    return factory;
}

} // namespace dff
