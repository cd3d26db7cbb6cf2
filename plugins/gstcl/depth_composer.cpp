/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "gstcl/depth_composer.h"

#include "common/refused_seek.h"
#include "common/running_time.h"
#include "gstcl/engine_message.h"

#include <gst/video/video.h>
#include <utility>

namespace dff {

namespace {

/* Always pads, built here so that they keep their names. */
GstAggregatorPad *add_sink(GstAggregator *element, GstStaticPadTemplate *static_template)
{
    g_autoptr(GstPadTemplate) pad_template = gst_static_pad_template_get(static_template);
    GstPad *pad = GST_PAD(g_object_new(GST_TYPE_AGGREGATOR_PAD, "name", static_template->name_template,
                                       "direction", GST_PAD_SINK, "template", pad_template, nullptr));
    gst_element_add_pad(GST_ELEMENT(element), pad);
    return GST_AGGREGATOR_PAD(pad);
}

} // namespace

DepthComposer::DepthComposer(GstAggregator *element, GstStaticPadTemplate *main, GstStaticPadTemplate *depth,
                             const char *needs)
    : element_(element), main_pad_(add_sink(element, main)), depth_pad_(add_sink(element, depth)),
      needs_(needs), device_(GST_ELEMENT(element))
{
}

/* The element's name in a pipeline description, or its type's where no factory made it. */
const gchar *DepthComposer::kind() const
{
    GstElementFactory *factory = gst_element_get_factory(GST_ELEMENT(element_));
    return factory ? GST_OBJECT_NAME(factory) : G_OBJECT_TYPE_NAME(element_);
}

bool DepthComposer::start()
{
    for (GstAggregatorPad *pad : {main_pad_, depth_pad_})
        if (!gst_pad_is_linked(GST_PAD(pad))) {
            GST_ELEMENT_ERROR(
                element_, CORE, PAD,
                ("The pad \"%s\" is not linked: %s needs %s", GST_PAD_NAME(pad), kind(), needs_), (nullptr));
            return false;
        }
    try {
        std::shared_ptr<Device> device = device_.open(device_wish());
        const std::lock_guard lock(mutex);
        open_device(std::move(device));
        return true;
    } catch (const EngineError &error) {
        post_engine_error(GST_ELEMENT(element_), error);
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(element_, RESOURCE, SETTINGS, ("%s", error.what()), (nullptr));
    }
    return false;
}

void DepthComposer::stop()
{
    close_device();
    device_.close();
    has_main_caps_ = false;
    const std::lock_guard lock(mutex);
    pictures_ = without_depth_ = 0;
    latency_.reset();
}

GstFlowReturn DepthComposer::aggregate()
{
    g_autoptr(GstBuffer) main = gst_aggregator_pad_peek_buffer(main_pad_);
    if (!main)
        return gst_aggregator_pad_is_eos(main_pad_) ? GST_FLOW_EOS : GST_AGGREGATOR_FLOW_NEED_DATA;
    if (!has_main_caps_)
        return GST_FLOW_NOT_NEGOTIATED;
    if (gst_buffer_get_size(main) == 0) { /* a gap */
        gst_aggregator_pad_drop_buffer(main_pad_);
        return GST_FLOW_OK;
    }
    const std::optional<GstBuffer *> match = matching_depth(main_pad_, main, depth_pad_);
    if (!match)
        return GST_AGGREGATOR_FLOW_NEED_DATA;
    g_autoptr(GstBuffer) depth = *match;
    gst_aggregator_pad_drop_buffer(main_pad_);
    return compose_and_push(main, depth);
}

GstFlowReturn DepthComposer::compose_and_push(GstBuffer *main, GstBuffer *depth)
{
    try {
        const GstClockTime start = gst_util_get_timestamp();
        GstBuffer *picture = compose(main, depth);
        account(gst_util_get_timestamp() - start, std::exchange(has_new_caps_, false), depth != nullptr);
        gst_aggregator_selected_samples(element_, GST_BUFFER_PTS(picture), GST_BUFFER_DTS(picture),
                                        GST_BUFFER_DURATION(picture), nullptr);
        return gst_aggregator_finish_buffer(element_, picture);
    } catch (const EngineError &error) {
        post_engine_error(GST_ELEMENT(element_), error);
    } catch (const std::exception &error) {
        GST_ELEMENT_ERROR(element_, STREAM, FORMAT, ("%s", error.what()), (nullptr));
    }
    return GST_FLOW_ERROR;
}

void DepthComposer::account(GstClockTime compute_time, bool is_first, bool with_depth)
{
    {
        const std::lock_guard lock(mutex);
        pictures_++;
        without_depth_ += !with_depth;
        compute_time_ = compute_time;
        if (!latency_.add(compute_time, is_first))
            return;
    }
    gst_aggregator_set_latency(element_, compute_time, compute_time);
}

std::optional<bool> DepthComposer::sink_event(GstAggregatorPad *pad, GstEvent *event)
{
    const bool is_main = pad == main_pad_;
    if (is_gap_out_of_time(event, pad->segment)) {
        gst_event_unref(event);
        return true;
    }
    if (GST_EVENT_TYPE(event) == GST_EVENT_CAPS) {
        g_autoptr(GstEvent) taken = event;
        GstCaps *caps = nullptr;
        gst_event_parse_caps(taken, &caps);
        has_new_caps_ = true;
        if (!is_main)
            return set_depth_caps(caps);
        if (!set_main_caps(caps))
            return false;
        has_main_caps_ = true;
        gst_pad_mark_reconfigure(GST_AGGREGATOR_SRC_PAD(element_));
        return true;
    }
    if (GST_EVENT_TYPE(event) == GST_EVENT_SEGMENT && is_main) {
        const GstSegment *segment = nullptr;
        gst_event_parse_segment(event, &segment);
        if (segment->format == GST_FORMAT_TIME)
            gst_aggregator_update_segment(element_, segment);
    }
    return std::nullopt;
}

std::optional<bool> DepthComposer::src_event(GstEvent *event)
{
    if (!is_refused_seek(GST_ELEMENT(element_), event))
        return std::nullopt;
    gst_event_unref(event);
    return false;
}

gboolean DepthComposer::propose_allocation(GstAggregator *, GstAggregatorPad *, GstQuery *, GstQuery *query)
{
    gst_query_add_allocation_meta(query, GST_VIDEO_META_API_TYPE, nullptr);
    return TRUE;
}

void DepthComposer::install_properties(GObjectClass *object_class, guint device, guint stats)
{
    g_object_class_install_property(
        object_class, device,
        g_param_spec_string(
            "device", "Device",
            "Part of the name of the OpenCL device to compute on, as clinfo -l lists it; empty: the one that "
            "the application or a neighbour shares, else the first GPU, else the CPU",
            "",
            static_cast<GParamFlags>(G_PARAM_READWRITE | G_PARAM_STATIC_STRINGS | GST_PARAM_MUTABLE_READY)));
    g_object_class_install_property(
        object_class, stats,
        g_param_spec_boxed(
            "stats", "Stats", "Pictures so far, those without any depth, and milliseconds the last one took",
            GST_TYPE_STRUCTURE, static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_STATIC_STRINGS)));
}

void DepthComposer::set_device(const GValue *value)
{
    const std::lock_guard lock(mutex);
    device_wish_ = g_value_get_string(value) ? g_value_get_string(value) : "";
}

std::string DepthComposer::device_wish()
{
    const std::lock_guard lock(mutex);
    return device_wish_;
}

void DepthComposer::get_device(GValue *value)
{
    g_value_set_string(value, device_wish().c_str());
}

void DepthComposer::get_stats(GValue *value)
{
    const std::lock_guard lock(mutex);
    const std::string name = std::string(kind()) + "-stats";
    GstStructure *stats = gst_structure_new(
        name.c_str(), "pictures", G_TYPE_UINT64, pictures_, "without-depth", G_TYPE_UINT64, without_depth_,
        "compute-ms", G_TYPE_DOUBLE, static_cast<gdouble>(compute_time_) / 1e6, nullptr);
    add_stats(stats);
    g_value_take_boxed(value, stats);
}

} // namespace dff
