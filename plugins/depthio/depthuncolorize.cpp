/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-depthuncolorize
 * @title: depthuncolorize
 * @short_description: depth from the colours of depthcolorize palette=hue
 *
 * Undoes depthcolorize palette=hue, also after a lossy codec. Colours do not say what they mean: `unit`,
 * `near` and `far` must be those that the depth had before depthcolorize; they come back as caps fields and
 * as GstDepthMeta. Frames are numbered from 0 in `sequence` and `sweep`.
 *
 * Scale neither the colours nor the depth with a filter that mixes pixels.
 *
 * ## Example launch line
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=30 near=5 far=0.5 ! focalstackmux ! dffdepth ! \
 *     depthcolorize palette=hue ! videoconvert ! video/x-raw,format=I420 ! x264enc ! h264parse ! \
 *     avdec_h264 ! videoconvert ! depthuncolorize near=5 far=0.5 ! fakesink
 * ]|
 */
#include "depthuncolorize.h"

#include "caps_fields.h"
#include "depth_palette.h"
#include "depth_range.h"
#include "depth_range_properties.h"
#include "each_pixel.h"
#include "stream_depth.h"

#include <cmath>
#include <gst/dff/dff.h>
#include <optional>
#include <stdexcept>

GST_DEBUG_CATEGORY_STATIC(gst_depth_uncolorize_debug);
#define GST_CAT_DEFAULT gst_depth_uncolorize_debug

static GstStaticPadTemplate sink_template = GST_STATIC_PAD_TEMPLATE(
    "sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE("RGB")));
static GstStaticPadTemplate src_template = GST_STATIC_PAD_TEMPLATE(
    "src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE("GRAY16_LE")));

namespace {

enum Property : guint { PropertyUnit = 1, PropertyNear };

struct Settings {
    GstDepthUnit unit = GST_DEPTH_UNIT_AUTO;
    dff::DepthRangeProperties range;
};

/* What the pixels of the restored depth mean. */
GstDepthInfo depth_of(const Settings &settings)
{
    GstDepthInfo depth;
    gst_depth_info_init(&depth);
    const auto [near, far] = settings.range;
    const bool known =
        near != dff::DepthRangeProperties::not_set && far != dff::DepthRangeProperties::not_set;
    if (known) {
        depth.near = near;
        depth.far = far;
    }
    depth.unit = settings.unit;
    if (settings.unit == GST_DEPTH_UNIT_AUTO)
        depth.unit = known ? GST_DEPTH_UNIT_DIOPTRE : GST_DEPTH_UNIT_INDEX;
    depth.scale = 1.0;
    if (depth.unit == GST_DEPTH_UNIT_DIOPTRE) {
        const dff::DepthScale scale = dff::dioptre_scale(depth.near, depth.far);
        depth.scale = scale.scale;
        depth.offset = scale.offset;
    }
    return depth;
}

dff::DepthRange range_of(const GstDepthInfo &depth)
{
    const auto known = [](double power) { return std::isnan(power) ? std::nullopt : std::optional(power); };
    if (depth.unit == GST_DEPTH_UNIT_MICROMETRE)
        throw std::invalid_argument("Stage positions do not survive as colours: use unit=index");
    return {dff::scale_of(depth), known(depth.near), known(depth.far)};
}

struct State {
    Settings settings; /* guarded by the object lock */

    /* The streaming thread's own. */
    GstDepthInfo depth{};
    std::optional<dff::DepthRange> range;
};

} // namespace

struct _GstDepthUncolorize {
    GstVideoFilter parent;
    State *state;
};

G_DEFINE_FINAL_TYPE(GstDepthUncolorize, gst_depth_uncolorize, GST_TYPE_VIDEO_FILTER)
GST_ELEMENT_REGISTER_DEFINE_WITH_CODE(depthuncolorize, "depthuncolorize", GST_RANK_NONE,
                                      GST_TYPE_DEPTH_UNCOLORIZE,
                                      GST_DEBUG_CATEGORY_INIT(gst_depth_uncolorize_debug, "depthuncolorize",
                                                              0, "depth from colours"))

static Settings settings_of(GstDepthUncolorize *self)
{
    GST_OBJECT_LOCK(self);
    const Settings settings = self->state->settings;
    GST_OBJECT_UNLOCK(self);
    return settings;
}

static gboolean start(GstBaseTransform *transform)
{
    auto *self = GST_DEPTH_UNCOLORIZE(transform);
    State &state = *self->state;
    state.depth = depth_of(settings_of(self));
    try {
        state.range = range_of(state.depth);
    } catch (const std::invalid_argument &error) {
        GST_ELEMENT_ERROR(self, RESOURCE, SETTINGS, ("%s", error.what()), (nullptr));
        return FALSE;
    }
    return TRUE;
}

static GstCaps *transform_caps(GstBaseTransform *transform, GstPadDirection from, GstCaps *caps,
                               GstCaps *filter)
{
    if (from == GST_PAD_SRC)
        return dff::caps_in_format(caps, "RGB", filter);
    g_autoptr(GstCaps) depth_caps = dff::caps_in_format(caps, "GRAY16_LE", nullptr);
    const GstDepthInfo depth = depth_of(settings_of(GST_DEPTH_UNCOLORIZE(transform)));
    gst_depth_info_to_caps(&depth, depth_caps);
    return filter ? gst_caps_intersect_full(filter, depth_caps, GST_CAPS_INTERSECT_FIRST)
                  : gst_caps_ref(depth_caps);
}

static GstFlowReturn transform_frame(GstVideoFilter *filter, GstVideoFrame *picture, GstVideoFrame *depth)
{
    State &state = *GST_DEPTH_UNCOLORIZE(filter)->state;
    dff::each_pixel(picture, depth, [&](const guint8 *colour, guint8 *out) {
        const std::optional<double> position = dff::hue_position({colour[0], colour[1], colour[2]});
        GST_WRITE_UINT16_LE(out, position ? state.range->pixel(*position) : dff::DepthScale::no_value);
    });
    gst_buffer_add_depth_meta(depth->buffer, &state.depth);
    state.depth.sequence++;
    state.depth.sweep++;
    return GST_FLOW_OK;
}

static void set_property(GObject *object, guint id, const GValue *value, GParamSpec *pspec)
{
    Settings &settings = GST_DEPTH_UNCOLORIZE(object)->state->settings;
    GST_OBJECT_LOCK(object);
    if (id == PropertyUnit)
        settings.unit = static_cast<GstDepthUnit>(g_value_get_enum(value));
    else if (!dff::set_depth_range(settings.range, pspec, value))
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
    GST_OBJECT_UNLOCK(object);
}

static void get_property(GObject *object, guint id, GValue *value, GParamSpec *pspec)
{
    const Settings settings = settings_of(GST_DEPTH_UNCOLORIZE(object));
    if (id == PropertyUnit)
        g_value_set_enum(value, settings.unit);
    else if (!dff::get_depth_range(settings.range, pspec, value))
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, pspec);
}

static void finalize(GObject *object)
{
    delete GST_DEPTH_UNCOLORIZE(object)->state;
    G_OBJECT_CLASS(gst_depth_uncolorize_parent_class)->finalize(object);
}

static void gst_depth_uncolorize_init(GstDepthUncolorize *self)
{
    self->state = new State;
}

static void gst_depth_uncolorize_class_init(GstDepthUncolorizeClass *klass)
{
    auto *object_class = G_OBJECT_CLASS(klass);
    auto *element_class = GST_ELEMENT_CLASS(klass);
    auto *transform_class = GST_BASE_TRANSFORM_CLASS(klass);

    object_class->set_property = set_property;
    object_class->get_property = get_property;
    object_class->finalize = finalize;
    g_object_class_install_property(
        object_class, PropertyUnit,
        g_param_spec_enum(
            "unit", "Unit",
            "Unit of the depth: what it was before the colours; auto is dioptre where near and far are "
            "set, else index. millimetre needs near and far, micrometre is refused",
            GST_TYPE_DEPTH_UNIT, Settings().unit,
            static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_READY)));
    dff::install_depth_range(object_class, PropertyNear, "-1 = unknown", GST_PARAM_MUTABLE_READY);

    transform_class->start = start;
    transform_class->transform_caps = transform_caps;
    GST_VIDEO_FILTER_CLASS(klass)->transform_frame = transform_frame;
    gst_element_class_add_static_pad_template(element_class, &sink_template);
    gst_element_class_add_static_pad_template(element_class, &src_template);
    gst_element_class_set_static_metadata(element_class, "Depth uncolorizer", "Filter/Converter/Video",
                                          "Turns the colours of depthcolorize palette=hue back into depth",
                                          "the gst-plugins-dff authors");
}
