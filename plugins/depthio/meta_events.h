/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <array>
#include <gst/dff/dff.h>
#include <memory>
#include <string>
#include <vector>

namespace dff {

struct EventDeleter {
    void operator()(GstEvent *event) const { gst_event_unref(event); }
};
using Event = std::unique_ptr<GstEvent, EventDeleter>;

/* A serialised event for each GstFocusMeta, GstFocalStackMeta, GstDepthMeta and GstReferenceTimestampMeta of
 * a buffer. They can be written as text, which is how gdppay and rtpgstpay keep them. */
std::vector<Event> events_of_metas(GstBuffer *buffer);

/* Whether an event is one of these. Only its name tells: gdppay 1.22 cuts the type of custom events to 16
 * bits. */
bool is_meta_event(GstEvent *event);

/* What such events said of the next buffer: at most what one buffer can have, however many come. */
class PendingMetas {
public:
    /* A later event takes the place of an earlier one of its kind, whose buffer was lost. */
    void add(GstEvent *event);

    /* Gives a writable buffer the metas, in place of those that it has already, and forgets them. Throws
     * std::runtime_error with a user's text if one of the events was damaged or from another release. */
    void give_to(GstBuffer *buffer);

    void clear() { *this = {}; }

private:
    struct ClockTime {
        std::string clock; /* its caps */
        GstClockTime timestamp;
        GstClockTime duration;
    };

    void add_bytes(size_t kind, const GstStructure *structure);
    void add_time(const GstStructure *structure);

    std::array<std::vector<guint8>, 3> bytes_; /* focus, stack, depth; empty: none */
    std::vector<ClockTime> times_;
    std::string fault_; /* of the first damaged event */
};

} // namespace dff
