/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/dff/dff.h>
#include <memory>
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

/* Gives a writable buffer the meta of an event; one that it has already is replaced. Throws
 * std::runtime_error with a user's text if the event is damaged or from another release. */
void add_meta_of_event(GstBuffer *buffer, GstEvent *event);

} // namespace dff
