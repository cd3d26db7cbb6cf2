/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-depthcolorize
 * @title: depthcolorize
 * @short_description: depth as colours, for eyes or for lossy codecs
 *
 * Paints depth from near (warm; white in palette=gray) to far, evenly in dioptres where the stream's unit
 * allows. Black is "no value". The range is that of the stream unless `near` and `far` narrow it.
 *
 * palette=hue can be undone by depthuncolorize after H.264 or H.265. The fields depth-unit, depth-near and
 * depth-far leave the caps: who decodes has to be told them another way.
 *
 * ## Example launch line
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=30 ! focalstackmux ! dffdepth ! depthcolorize ! \
 *     videoconvert ! autovideosink
 * ]|
 */
#include "depthcolorize.h"

#include "caps_fields.h"
#include "depth_palette.h"
#include "depth_range.h"
#include "depth_range_properties.h"
#include "each_pixel.h"
#include "stream_depth.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

GST_DEBUG_CATEGORY_STATIC(gst_depth_colorize_debug);
#define GST_CAT_DEFAULT gst_depth_colorize_debug

static GstStaticPadTemplate sink_template = GST_STATIC_PAD_TEMPLATE(
    "sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE("GRAY16_LE")));
static GstStaticPadTemplate src_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE("RGB")));

#define GST_TYPE_DEPTH_PALETTE (gst_depth_palette_get_type())

static GType gst_depth_palette_get_type()
{
    static const GEnumValue values[] = {
        {static_cast<int>(dff::DepthPalette::Turbo), "Red, yellow, green, blue, even to the eye", "turbo"},
        {static_cast<int>(dff::DepthPalette::Jet), "Red, yellow, cyan, blue", "jet"},
        {static_cast<int>(dff::DepthPalette::Gray), "White to dark gray", "gray"},
        {static_cast<int>(dff::DepthPalette::Hue), "For lossy codecs: depthuncolorize makes it depth again",
         "hue"},
        {0, nullptr, nullptr},
    };
    static const GType type = g_enum_register_static("GstDepthPalette", values);
    return type;
}

namespace {

enum Property : guint { PropertyPalette = 1, PropertyNear };

struct Settings {
    dff::DepthPalette palette = dff::DepthPalette::Turbo;
    dff::DepthRangeProperties range;
};

/* The colour of every pixel there can be. */
struct ColourTable {
    dff::DepthPalette palette;
    dff::DepthRange range;
    std::vector<dff::Colour> colours;

    ColourTable(dff::DepthPalette wanted, const dff::DepthRange &wanted_range)
        : palette(wanted), range(wanted_range), colours(dff::DepthScale::max_pixel + 1, dff::no_value_colour)
    {
        const dff::PaletteColours all(palette);
        for (unsigned pixel = 1; pixel <= dff::DepthScale::max_pixel; pixel++)
            colours[pixel] = all.at(*range.position(static_cast<uint16_t>(pixel)));
    }
};

struct State {
    Settings settings; /* guarded by the object lock */

    /* The streaming thread's own. */
    GstCaps *caps = nullptr;
    std::optional<ColourTable> table;

    ~State() { gst_clear_caps(&caps); }
};

std::optional<double> first_known(double wish, double stream)
{
    if (wish != dff::DepthRangeProperties::not_set)
        return wish;
    return std::isnan(stream) ? std::nullopt : std::optional(stream);
}

} // namespace

struct _GstDepthColorize {
    GstVideoFilter parent;
    State *state;
};

G_DEFINE_FINAL_TYPE(GstDepthColorize, gst_depth_colorize, GST_TYPE_VIDEO_FILTER)
GST_ELEMENT_REGISTER_DEFINE_WITH_CODE(depthcolorize, "depthcolorize", GST_RANK_NONE, GST_TYPE_DEPTH_COLORIZE,
                                      GST_DEBUG_CATEGORY_INIT(gst_depth_colorize_debug, "depthcolorize", 0,
                                                              "depth as colours"))

static Settings settings_of(GstDepthColorize *self)
{
    GST_OBJECT_LOCK(self);
    const Settings settings = self->state->settings;
    GST_OBJECT_UNLOCK(self);
    return settings;
}

static void prepare_table(GstDepthColorize *self, GstBuffer *frame)
{
    State &state = *self->state;
    const Settings settings = settings_of(self);
    const GstDepthInfo depth = dff::depth_of(frame, state.caps);
    const dff::DepthRange range(dff::scale_of(depth), first_known(settings.range.near, depth.near),
                                first_known(settings.range.far, depth.far));
    if (state.table && state.table->palette == settings.palette && state.table->range == range)
        return;
    GST_INFO_OBJECT(self, "new colours: unit %d, scale %g, offset %g", depth.unit, depth.scale, depth.offset);
    state.table.emplace(settings.palette, range);
}

static GstFlowReturn transform_frame(GstVideoFilter *filter, GstVideoFrame *depth, GstVideoFrame *picture)
{
    auto *self = GST_DEPTH_COLORIZE(filter);
    try {
        prepare_table(self, depth->buffer);
    } catch (const std::invalid_argument &error) {
        GST_ELEMENT_ERROR(self, STREAM, FORMAT, ("%s", error.what()), (nullptr));
        return GST_FLOW_ERROR;
    }
    const ColourTable &table = *self->state->table;
    dff::each_pixel(depth, picture, [&](const guint8 *pixel, guint8 *out) {
        const dff::Colour &colour = table.colours[GST_READ_UINT16_LE(pixel)];
        std::copy(colour.begin(), colour.end(), out);
    });
    return GST_FLOW_OK;
}

static gboolean set_info(GstVideoFilter *filter, GstCaps *caps, GstVideoInfo *, GstCaps *, GstVideoInfo *)
{
    gst_caps_replace(&GST_DEPTH_COLORIZE(filter)->state->caps, caps);
    return TRUE;
}

static GstCaps *transform_caps(GstBaseTransform *, GstPadDirection from, GstCaps *caps, GstCaps *filter)
{
    return dff::caps_in_format(caps, from == GST_PAD_SINK ? "RGB" : "GRAY16_LE", filter);
}

/* Colours are no depth. */
static gboolean transform_meta(GstBaseTransform *transform, GstBuffer *picture, GstMeta *meta,
                               GstBuffer *depth)
{
    if (meta->info->api == GST_DEPTH_META_API_TYPE)
        return FALSE;
    return GST_BASE_TRANSFORM_CLASS(gst_depth_colorize_parent_class)
        ->transform_meta(transform, picture, meta, depth);
}

static gboolean stop(GstBaseTransform *transform)
{
    State &state = *GST_DEPTH_COLORIZE(transform)->state;
    gst_clear_caps(&state.caps);
    state.table.reset();
    return TRUE;
}

static void set_property(GObject *object, guint id, const GValue *value, GParamSpec *pspec)
{
    Settings &settings = GST_DEPTH_COLORIZE(object)->state->settings;
    GST_OBJECT_LOCK(object);
    if (id == PropertyPalette)
        settings.palette = static_cast<dff::DepthPalette>(g_value_get_enum(value));
    else if (!dff::set_depth_range(settings.range, pspec, value))
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
    GST_OBJECT_UNLOCK(object);
}

static void get_property(GObject *object, guint id, GValue *value, GParamSpec *pspec)
{
    const Settings settings = settings_of(GST_DEPTH_COLORIZE(object));
    if (id == PropertyPalette)
        g_value_set_enum(value, static_cast<int>(settings.palette));
    else if (!dff::get_depth_range(settings.range, pspec, value))
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void finalize(GObject *object)
{
    delete GST_DEPTH_COLORIZE(object)->state;
    G_OBJECT_CLASS(gst_depth_colorize_parent_class)->finalize(object);
}

static void gst_depth_colorize_init(GstDepthColorize *self)
{
    self->state = new State;
}

static void gst_depth_colorize_class_init(GstDepthColorizeClass *klass)
{
    auto *object_class = G_OBJECT_CLASS(klass);
    auto *element_class = GST_ELEMENT_CLASS(klass);
    auto *transform_class = GST_BASE_TRANSFORM_CLASS(klass);
    auto *filter_class = GST_VIDEO_FILTER_CLASS(klass);

    object_class->set_property = set_property;
    object_class->get_property = get_property;
    object_class->finalize = finalize;
    g_object_class_install_property(
        object_class, PropertyPalette,
        g_param_spec_enum("palette", "Palette", "Colours from near to far", GST_TYPE_DEPTH_PALETTE,
                          static_cast<int>(Settings().palette),
                          static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS |
                                                   GST_PARAM_MUTABLE_PLAYING)));
    dff::install_depth_range(object_class, PropertyNear,
                             "-1 = that of the stream. Of no effect in the units index and micrometre",
                             GST_PARAM_MUTABLE_PLAYING);

    transform_class->transform_caps = transform_caps;
    transform_class->transform_meta = transform_meta;
    transform_class->stop = stop;
    filter_class->set_info = set_info;
    filter_class->transform_frame = transform_frame;
    gst_element_class_add_static_pad_template(element_class, &sink_template);
    gst_element_class_add_static_pad_template(element_class, &src_template);
    gst_element_class_set_static_metadata(element_class, "Depth colorizer", "Filter/Converter/Video",
                                          "Paints depth in colours, for eyes or for lossy codecs",
                                          "the gst-plugins-dff authors");
    gst_type_mark_as_plugin_api(GST_TYPE_DEPTH_PALETTE, static_cast<GstPluginAPIFlags>(0));
}
