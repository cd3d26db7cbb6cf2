/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-depthexrenc
 * @title: depthexrenc
 * @short_description: colour and depth as OpenEXR
 *
 * Writes each frame as an OpenEXR file with R, G, B in half precision, as linear light, and Z in single
 * precision: metres along the camera's axis, NaN where nothing is known. The attribute `depthUnit` says what
 * Z is: "metre", "metre of stage travel", or "plane" where only the number of the plane is known. `nearPower`
 * and `farPower` are the ends of the sweep in dioptres, `intrinsics` is fx, fy, cx, cy in pixels,
 * `distortion` is k1, k2, p1, p2, k3.
 *
 * With the stack on the request pad `stack` the file has more parts: first `all-in-focus`, then `plane00`,
 * `plane01` and so on, nearest first, each with its `focus` in metres, `focusPower` in dioptres, and
 * `expTime` in seconds; the first part has all `focusPowers`. The pad may be requested and released while the
 * others stream: a picture whose time has no stack makes a file without planes. Put a queue on every branch.
 *
 * With dffdepth's `uncertainty` on the request pad of that name the first part has a channel `uncertainty.Z`:
 * one standard deviation of Z, in what Z is in, NaN where it is unknown.
 *
 * Colour, depth, stack and uncertainty of the same running time belong together.
 *
 * ## Example launch line
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=6 planes=6 ! videoconvert ! video/x-raw,format=RGB ! \
 *     focalstackmux ! tee name=s  s. ! queue ! dffdepth ! tee name=d  d. ! queue ! c.depth \
 *     s. ! queue ! c.stack  aifcompose name=c ! queue ! e.color  d. ! queue ! e.depth \
 *     s. ! queue ! e.stack  depthexrenc name=e ! multifilesink location=sweep-%02d.exr
 * gst-launch-1.0 lenssweeptestsrc num-buffers=6 near=5 far=0.5 ! videoconvert ! video/x-raw,format=RGB ! \
 *     focalstackmux ! tee name=s  s. ! queue ! dffdepth name=d  d.src ! tee name=t  t. ! queue ! c.depth \
 *     s. ! queue ! c.stack  aifcompose name=c ! queue ! e.color  t. ! queue ! e.depth \
 *     d.uncertainty ! queue ! e.uncertainty  depthexrenc name=e ! multifilesink location=sigma-%02d.exr
 * ]|
 */
#include "depthexrenc.h"

#include "distance_table.h"
#include "exr_file.h"
#include "mapped_picture.h"
#include "stream_depth.h"

#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

GST_DEBUG_CATEGORY_STATIC(gst_depth_exr_enc_debug);
#define GST_CAT_DEFAULT gst_depth_exr_enc_debug

static GstStaticPadTemplate stack_template =
    GST_STATIC_PAD_TEMPLATE("stack", GST_PAD_SINK, GST_PAD_REQUEST,
                            GST_STATIC_CAPS(GST_FOCAL_STACK_CAPS_NAME
                                            ", format = (string) RGB, " GST_FOCAL_STACK_SIZES
                                            ", planes = (int) [ 2, 64 ], framerate = (fraction) [ 0, max ]"));
static GstStaticPadTemplate src_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS("image/x-exr"));

#define GST_TYPE_EXR_COMPRESSION (gst_exr_compression_get_type())

static GType gst_exr_compression_get_type()
{
    using dff::ExrCompression;
    static const GEnumValue values[] = {
        {static_cast<int>(ExrCompression::None), "None", "none"},
        {static_cast<int>(ExrCompression::Rle), "Run lengths", "rle"},
        {static_cast<int>(ExrCompression::Zips), "Deflate, a line at a time", "zips"},
        {static_cast<int>(ExrCompression::Zip), "Deflate, 16 lines at a time", "zip"},
        {static_cast<int>(ExrCompression::Piz), "Wavelets: for noisy pictures", "piz"},
        {static_cast<int>(ExrCompression::Dwaa), "Lossy colours, depth without loss, 32 lines at a time",
         "dwaa"},
        {static_cast<int>(ExrCompression::Dwab), "Lossy colours, depth without loss, 256 lines at a time",
         "dwab"},
        {0, nullptr, nullptr},
    };
    static const GType type = g_enum_register_static("GstDepthExrCompression", values);
    return type;
}

namespace {

enum Property : guint { PropertyCompression = 1 };

struct State {
    dff::ExrCompression compression = dff::ExrCompression::Zip; /* guarded by the object lock */

    /* The streaming thread's own. */
    std::optional<dff::DepthScale> scale;
    std::vector<float> distances, slopes; /* of `scale` */
};

/* A stack with all its planes mapped for reading. */
class MappedPlanes {
public:
    MappedPlanes(GstBuffer *stack, const GstFocalStackInfo &info) : stack_(stack), info_(info)
    {
        if (!gst_buffer_map(stack, &map_, GST_MAP_READ))
            throw std::runtime_error("A stack cannot be read");
    }
    ~MappedPlanes() { gst_buffer_unmap(stack_, &map_); }

    MappedPlanes(const MappedPlanes &) = delete;
    MappedPlanes &operator=(const MappedPlanes &) = delete;

    dff::PictureView plane(guint z) const
    {
        gsize offset[GST_VIDEO_MAX_PLANES];
        gint stride[GST_VIDEO_MAX_PLANES];
        g_autoptr(GError) error = nullptr;
        if (!gst_focal_stack_info_locate_plane(&info_, stack_, z, offset, stride, &error))
            throw std::runtime_error(error->message);
        return {map_.data + offset[0], stride[0], static_cast<unsigned>(GST_VIDEO_INFO_WIDTH(&info_.frame)),
                static_cast<unsigned>(GST_VIDEO_INFO_HEIGHT(&info_.frame))};
    }

private:
    GstBuffer *stack_;
    const GstFocalStackInfo &info_;
    GstMapInfo map_{};
};

float metres_of_power(double power)
{
    return power > 0.0 ? static_cast<float>(1.0 / power) : INFINITY;
}

std::string text_of(dff::DepthUnit unit)
{
    if (unit == dff::DepthUnit::Index)
        return "plane";
    return unit == dff::DepthUnit::Micrometre ? "metre of stage travel" : "metre";
}

std::vector<dff::ExrAttribute> depth_attributes(const GstDepthInfo &depth)
{
    std::vector<dff::ExrAttribute> attributes{{"depthUnit", text_of(dff::scale_of(depth).unit)}};
    if (!std::isnan(depth.near) && !std::isnan(depth.far)) {
        attributes.emplace_back("nearPower", static_cast<float>(depth.near));
        attributes.emplace_back("farPower", static_cast<float>(depth.far));
    }
    if (depth.has_intrinsics) {
        attributes.emplace_back("intrinsics",
                                std::vector{static_cast<float>(depth.fx), static_cast<float>(depth.fy),
                                            static_cast<float>(depth.cx), static_cast<float>(depth.cy)});
        attributes.emplace_back("distortion",
                                std::vector<float>(std::begin(depth.distortion), std::end(depth.distortion)));
    }
    return attributes;
}

std::vector<dff::ExrAttribute> focus_attributes(const GstFocusInfo &focus)
{
    std::vector<dff::ExrAttribute> attributes;
    if (!std::isnan(focus.power)) {
        attributes.emplace_back("focus", metres_of_power(focus.power));
        attributes.emplace_back("focusPower", static_cast<float>(focus.power));
    }
    if (!std::isnan(focus.position_um))
        attributes.emplace_back("stagePosition", static_cast<float>(focus.position_um / 1e6));
    if (GST_CLOCK_TIME_IS_VALID(focus.exposure))
        attributes.emplace_back("expTime",
                                static_cast<float>(static_cast<double>(focus.exposure) / GST_SECOND));
    return attributes;
}

/* Adds a part a plane, and to the first part what is known of all of them. */
void add_planes(std::vector<dff::ExrPart> &parts, const MappedPlanes &planes, const dff::FrameSet &frames)
{
    const GstFocalStackMeta *meta = gst_buffer_get_focal_stack_meta(frames.stack);
    std::vector<float> powers;
    for (guint z = 0; z < frames.stack_info->planes; z++) {
        g_autofree gchar *name = g_strdup_printf("plane%02u", z);
        GstFocusInfo focus;
        gst_focus_info_init(&focus);
        if (meta)
            gst_focal_stack_meta_get_focus(meta, z, &focus);
        powers.push_back(static_cast<float>(focus.power));
        parts.push_back({name, planes.plane(z), std::nullopt, std::nullopt, focus_attributes(focus)});
    }
    if (meta)
        parts.front().attributes.emplace_back("focusPowers", powers);
}

std::array<float, 256> linear_light(const GstVideoInfo &info)
{
    std::array<float, 256> linear{};
    for (size_t k = 0; k < linear.size(); k++)
        linear[k] = static_cast<float>(
            gst_video_transfer_function_decode(info.colorimetry.transfer, static_cast<double>(k) / 255.0));
    return linear;
}

} // namespace

struct _GstDepthExrEnc {
    GstDepthFileEnc parent;
    State *state;
};

G_DEFINE_FINAL_TYPE(GstDepthExrEnc, gst_depth_exr_enc, GST_TYPE_DEPTH_FILE_ENC)
GST_ELEMENT_REGISTER_DEFINE_WITH_CODE(depthexrenc, "depthexrenc", GST_RANK_NONE, GST_TYPE_DEPTH_EXR_ENC,
                                      GST_DEBUG_CATEGORY_INIT(gst_depth_exr_enc_debug, "depthexrenc", 0,
                                                              "OpenEXR of colour and depth"))

static dff::ExrCompression compression_of(GstDepthExrEnc *self)
{
    GST_OBJECT_LOCK(self);
    const dff::ExrCompression compression = self->state->compression;
    GST_OBJECT_UNLOCK(self);
    return compression;
}

static std::vector<guint8> encode(GstDepthFileEnc *encoder, const dff::FrameSet &frames)
{
    auto *self = GST_DEPTH_EXR_ENC(encoder);
    State &state = *self->state;
    const dff::MappedPicture colour(frames.colour, *frames.colour_info);
    const dff::MappedPicture depth(frames.depth, *frames.depth_info);
    const GstDepthInfo facts = dff::depth_of(frames.depth, frames.depth_caps);
    if (state.scale != dff::scale_of(facts)) {
        state.scale = dff::scale_of(facts);
        state.distances = dff::distance_table(*state.scale);
        state.slopes = dff::distance_slope_table(*state.scale);
    }

    std::optional<dff::MappedPicture> uncertainty;
    if (frames.uncertainty)
        uncertainty.emplace(frames.uncertainty, *frames.uncertainty_info);

    std::vector<dff::ExrPart> parts{{"all-in-focus", colour.view(), depth.view(),
                                     uncertainty ? std::optional(uncertainty->view()) : std::nullopt,
                                     depth_attributes(facts)}};
    std::optional<MappedPlanes> planes;
    if (frames.stack) {
        planes.emplace(frames.stack, *frames.stack_info);
        add_planes(parts, *planes, frames);
    }
    return dff::write_exr(
        parts, {compression_of(self), linear_light(*frames.colour_info), state.distances, state.slopes});
}

static void set_property(GObject *object, guint id, const GValue *value, GParamSpec *pspec)
{
    GST_OBJECT_LOCK(object);
    if (id == PropertyCompression)
        GST_DEPTH_EXR_ENC(object)->state->compression =
            static_cast<dff::ExrCompression>(g_value_get_enum(value));
    else
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
    GST_OBJECT_UNLOCK(object);
}

static void get_property(GObject *object, guint id, GValue *value, GParamSpec *pspec)
{
    if (id == PropertyCompression)
        g_value_set_enum(value, static_cast<int>(compression_of(GST_DEPTH_EXR_ENC(object))));
    else
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void finalize(GObject *object)
{
    delete GST_DEPTH_EXR_ENC(object)->state;
    G_OBJECT_CLASS(gst_depth_exr_enc_parent_class)->finalize(object);
}

static void gst_depth_exr_enc_init(GstDepthExrEnc *self)
{
    self->state = new State;
}

static void gst_depth_exr_enc_class_init(GstDepthExrEncClass *klass)
{
    auto *object_class = G_OBJECT_CLASS(klass);
    auto *element_class = GST_ELEMENT_CLASS(klass);

    object_class->set_property = set_property;
    object_class->get_property = get_property;
    object_class->finalize = finalize;
    g_object_class_install_property(
        object_class, PropertyCompression,
        g_param_spec_enum("compression", "Compression",
                          "How the file is compressed; depth never loses anything", GST_TYPE_EXR_COMPRESSION,
                          static_cast<int>(dff::ExrCompression::Zip),
                          static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                                                   GST_PARAM_MUTABLE_PLAYING)));
    GST_DEPTH_FILE_ENC_CLASS(klass)->encode = encode;
    gst_element_class_add_static_pad_template_with_gtype(element_class, &stack_template,
                                                         GST_TYPE_AGGREGATOR_PAD);
    gst_element_class_add_static_pad_template_with_gtype(element_class, &src_template,
                                                         GST_TYPE_AGGREGATOR_PAD);
    gst_element_class_set_static_metadata(element_class, "OpenEXR encoder", "Codec/Encoder/Image",
                                          "Writes colour, depth and stacks as OpenEXR",
                                          "the gst-plugins-dff authors");
    gst_type_mark_as_plugin_api(GST_TYPE_EXR_COMPRESSION, static_cast<GstPluginAPIFlags>(0));
}
