/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/**
 * SECTION:element-dffmetapay
 * @title: dffmetapay
 * @short_description: lets metas travel where only buffers and events can
 *
 * Files and networks do not keep the metas of a buffer. This element sends what GstFocusMeta,
 * GstFocalStackMeta, GstDepthMeta and GstReferenceTimestampMeta say as events before their buffer; gdppay,
 * rtpgstpay and encoders that keep the order of frames pass such events on, and dffmetadepay makes metas of
 * them again. The buffers are left alone.
 *
 * ## Example launch line
 * |[
 * gst-launch-1.0 lenssweeptestsrc num-buffers=18 ! focalstackmux ! dffmetapay ! gdppay ! \
 *     filesink location=stacks.gdp
 * ]|
 */
#include "dffmetapay.h"

#include "meta_events.h"

GST_DEBUG_CATEGORY_STATIC(gst_dff_meta_pay_debug);
#define GST_CAT_DEFAULT gst_dff_meta_pay_debug

static GstStaticPadTemplate sink_template =
    GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS_ANY);
static GstStaticPadTemplate src_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS_ANY);

struct _GstDffMetaPay {
    GstBaseTransform parent;
};

G_DEFINE_FINAL_TYPE(GstDffMetaPay, gst_dff_meta_pay, GST_TYPE_BASE_TRANSFORM)
GST_ELEMENT_REGISTER_DEFINE_WITH_CODE(dffmetapay, "dffmetapay", GST_RANK_NONE, GST_TYPE_DFF_META_PAY,
                                      GST_DEBUG_CATEGORY_INIT(gst_dff_meta_pay_debug, "dffmetapay", 0,
                                                              "metas as events"))

static GstFlowReturn transform_ip(GstBaseTransform *transform, GstBuffer *buffer)
{
    for (dff::Event &event : dff::events_of_metas(buffer)) {
        GST_LOG_OBJECT(transform, "%" GST_PTR_FORMAT, event.get());
        gst_pad_push_event(GST_BASE_TRANSFORM_SRC_PAD(transform), event.release());
    }
    return GST_FLOW_OK;
}

static void gst_dff_meta_pay_init(GstDffMetaPay *self)
{
    gst_base_transform_set_passthrough(GST_BASE_TRANSFORM(self), TRUE);
}

static void gst_dff_meta_pay_class_init(GstDffMetaPayClass *klass)
{
    auto *element_class = GST_ELEMENT_CLASS(klass);

    GST_BASE_TRANSFORM_CLASS(klass)->transform_ip = transform_ip;
    GST_BASE_TRANSFORM_CLASS(klass)->transform_ip_on_passthrough = TRUE;
    gst_element_class_add_static_pad_template(element_class, &sink_template);
    gst_element_class_add_static_pad_template(element_class, &src_template);
    gst_element_class_set_static_metadata(
        element_class, "Focus and depth meta payloader", "Codec/Payloader",
        "Sends focus and depth metas as events, which files and networks keep",
        "the gst-plugins-dff authors");
}
