/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "gstcl/compute_latency.h"
#include "gstcl/device_context.h"

#include <gst/base/gstaggregator.h>
#include <memory>
#include <optional>

namespace dff {

/* What aggregators have in common that compose a picture from each buffer of a main input and the depth map
 * that goes with it: always pads, a device, statistics. An element's state derives from it and says how. */
class DepthComposer {
public:
    /* Adds the always pads `main` and `depth`. `needs` is what their element cannot do without, in a user's
     * words. */
    DepthComposer(GstAggregator *element, GstStaticPadTemplate *main, GstStaticPadTemplate *depth,
                  const char *needs);
    virtual ~DepthComposer() = default;

    DepthComposer(const DepthComposer &) = delete;
    DepthComposer &operator=(const DepthComposer &) = delete;

    /* The aggregator's functions of these names. sink_event takes caps, src_event what cannot be sought, and
     * both return empty for what the base class has to see. answer() is for the queries of all pads, and
     * false where the base class answers. */
    bool start();
    void stop();
    GstFlowReturn aggregate();
    std::optional<bool> sink_event(GstAggregatorPad *pad, GstEvent *event);
    std::optional<bool> src_event(GstEvent *event);
    bool answer(GstQuery *query) const { return device_.answer(query); }
    static gboolean propose_allocation(GstAggregator *aggregator, GstAggregatorPad *pad,
                                       GstQuery *decide_query, GstQuery *query);

    bool has_main_caps() const { return has_main_caps_; }

    /* The properties `device` and `stats`, under these numbers. */
    static void install_properties(GObjectClass *object_class, guint device, guint stats);
    void set_device(const GValue *value);
    void get_device(GValue *value);
    void get_stats(GValue *value);

protected:
    /* Guards the properties and statistics; nothing else is locked under it but the element's own lock. */
    std::mutex mutex;

private:
    /* The work. All but open_device, which is called under the mutex, by the streaming thread. Those that can
     * fail throw EngineError, or std::exception with a user's text. */
    virtual void open_device(std::shared_ptr<Device> device) = 0;
    virtual void close_device() = 0;
    virtual bool set_main_caps(const GstCaps *caps) = 0;
    virtual bool set_depth_caps(const GstCaps *caps) = 0;

    /* The depth map that goes with `main`, taken from its pad, or nullptr if it has none; empty if it has not
     * come yet. Maps of main buffers that never came are dropped. */
    virtual std::optional<GstBuffer *> matching_depth(GstAggregatorPad *main_pad, GstBuffer *main,
                                                      GstAggregatorPad *depth_pad) = 0;

    /* `depth` may be nullptr. */
    virtual GstBuffer *compose(GstBuffer *main, GstBuffer *depth) = 0;

    /* What else there is to tell in `stats`; called under the mutex. */
    virtual void add_stats(GstStructure *) const {}

    const gchar *kind() const;
    std::string device_wish();
    GstFlowReturn compose_and_push(GstBuffer *main, GstBuffer *depth);
    void account(GstClockTime compute_time, bool is_first, bool with_depth);

    GstAggregator *element_; /* which owns this */
    GstAggregatorPad *main_pad_;
    GstAggregatorPad *depth_pad_;
    const char *needs_;
    DeviceContext device_;

    /* The streaming thread's own. */
    bool has_main_caps_ = false;
    bool has_new_caps_ = false;

    /* Under the mutex. */
    std::string device_wish_;
    guint64 pictures_ = 0;
    guint64 without_depth_ = 0;
    GstClockTime compute_time_ = 0;
    ComputeLatency latency_;
};

} // namespace dff
