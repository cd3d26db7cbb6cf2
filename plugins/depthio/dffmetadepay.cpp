/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-dffmetadepay
 * @title: dffmetadepay
 * @short_description: gives buffers the metas that dffmetapay sent
 *
 * A stream without such events passes unchanged.
 *
 * ## Example launch line
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=18 ! focalstackmux ! dffmetapay ! gdppay ! gdpdepay ! \
 *     dffmetadepay ! dffdepth unit=dioptre ! fakesink
 * ]|
 */
#include "dffmetadepay.h"

#include "meta_events.h"

#include <stdexcept>

GST_DEBUG_CATEGORY_STATIC(gst_dff_meta_depay_debug);
#define GST_CAT_DEFAULT gst_dff_meta_depay_debug

static GstStaticPadTemplate sink_template =
    GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS_ANY);
static GstStaticPadTemplate src_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS_ANY);

namespace {

/* The streaming thread's own. */
struct State {
    dff::PendingMetas metas; /* of the next buffer */
};

} // namespace

struct _GstDffMetaDepay {
    GstBaseTransform parent;
    State *state;
};

G_DEFINE_FINAL_TYPE(GstDffMetaDepay, gst_dff_meta_depay, GST_TYPE_BASE_TRANSFORM)
GST_ELEMENT_REGISTER_DEFINE_WITH_CODE(dffmetadepay, "dffmetadepay", GST_RANK_NONE, GST_TYPE_DFF_META_DEPAY,
                                      GST_DEBUG_CATEGORY_INIT(gst_dff_meta_depay_debug, "dffmetadepay", 0,
                                                              "metas from events"))

static gboolean sink_event(GstBaseTransform *transform, GstEvent *event)
{
    State &state = *GST_DFF_META_DEPAY(transform)->state;
    if (dff::is_meta_event(event)) {
        GST_LOG_OBJECT(transform, "%" GST_PTR_FORMAT, event);
        state.metas.add(event);
        gst_event_unref(event);
        return TRUE;
    }
    if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP)
        state.metas.clear();
    return GST_BASE_TRANSFORM_CLASS(gst_dff_meta_depay_parent_class)->sink_event(transform, event);
}

/* A buffer of others is copied without its pixels, since only metas are added. */
static GstFlowReturn prepare_output_buffer(GstBaseTransform *, GstBuffer *input, GstBuffer **output)
{
    *output = gst_buffer_is_writable(input) ? input : gst_buffer_copy(input);
    return GST_FLOW_OK;
}

static GstFlowReturn transform_ip(GstBaseTransform *transform, GstBuffer *buffer)
{
    try {
        GST_DFF_META_DEPAY(transform)->state->metas.give_to(buffer);
    } catch (const std::runtime_error &error) {
        GST_ELEMENT_ERROR(transform, STREAM, DECODE, ("%s", error.what()), (nullptr));
        return GST_FLOW_ERROR;
    }
    return GST_FLOW_OK;
}

static gboolean stop(GstBaseTransform *transform)
{
    GST_DFF_META_DEPAY(transform)->state->metas.clear();
    return TRUE;
}

static void finalize(GObject *object)
{
    delete GST_DFF_META_DEPAY(object)->state;
    G_OBJECT_CLASS(gst_dff_meta_depay_parent_class)->finalize(object);
}

static void gst_dff_meta_depay_init(GstDffMetaDepay *self)
{
    self->state = new State;
}

static void gst_dff_meta_depay_class_init(GstDffMetaDepayClass *klass)
{
    auto *element_class = GST_ELEMENT_CLASS(klass);
    auto *transform_class = GST_BASE_TRANSFORM_CLASS(klass);

    G_OBJECT_CLASS(klass)->finalize = finalize;
    transform_class->sink_event = sink_event;
    transform_class->prepare_output_buffer = prepare_output_buffer;
    transform_class->transform_ip = transform_ip;
    transform_class->stop = stop;
    gst_element_class_add_static_pad_template(element_class, &sink_template);
    gst_element_class_add_static_pad_template(element_class, &src_template);
    gst_element_class_set_static_metadata(
        element_class, "Focus and depth meta depayloader", "Codec/Depayloader",
        "Gives buffers the metas that dffmetapay sent as events", "the gst-plugins-dff authors");
}
