/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depthio/matched_inputs.h"

#include <utility>

#define GST_CAT_DEFAULT dff_file_encoder_debug
GST_DEBUG_CATEGORY_EXTERN(dff_file_encoder_debug);

namespace dff {

namespace {

constexpr GstClockTimeDiff tolerance = GST_MSECOND; /* of containers that round */

/* The first buffer of a pad. */
struct Head {
    explicit Head(GstAggregatorPad *of) : pad(of), buffer(gst_aggregator_pad_peek_buffer(of)) {}

    bool is_gap() const { return gst_buffer_get_size(buffer.get()) == 0; }

    /* Nanoseconds, below 0 before the segment's start; empty where the stream or the buffer has no time. */
    std::optional<gint64> running_time() const
    {
        guint64 time = 0;
        if (!GST_BUFFER_PTS_IS_VALID(buffer.get()) || pad->segment.format != GST_FORMAT_TIME)
            return std::nullopt;
        const int sign = gst_segment_to_running_time_full(&pad->segment, GST_FORMAT_TIME,
                                                          GST_BUFFER_PTS(buffer.get()), &time);
        if (sign == 0)
            return std::nullopt;
        return sign * static_cast<gint64>(time);
    }

    /* Off the pad; nullptr if a flush or a release of the pad was faster. */
    OwnedBuffer take()
    {
        OwnedBuffer taken(gst_aggregator_pad_pop_buffer(pad));
        return taken == buffer ? std::move(taken) : nullptr;
    }

    void drop(const char *reason)
    {
        GST_DEBUG_OBJECT(pad, "%s: %" GST_PTR_FORMAT " is dropped", reason, buffer.get());
        take();
    }

    GstAggregatorPad *pad;
    OwnedBuffer buffer;
};

/* Whether `one` comes before all of `other`. */
bool is_before(const Head &one, const Head &other)
{
    const std::optional<gint64> time = one.running_time(), other_time = other.running_time();
    return time && other_time && *time + tolerance < *other_time;
}

/* What else there is of a picture, on a pad that may be missing. Waiting: it may come yet; Ready: `found` is
 * it, or empty if there is none. */
Match match_to(const Head &colour, GstAggregatorPad *pad, std::optional<Head> &found)
{
    if (!pad)
        return Match::Ready;
    found.emplace(pad);
    if (!found->buffer) {
        found.reset();
        const bool released = GST_OBJECT_PARENT(pad) == nullptr;
        return released || gst_aggregator_pad_is_eos(pad) ? Match::Ready : Match::Waiting;
    }
    if (found->is_gap() || is_before(*found, colour)) {
        found->drop(found->is_gap() ? "A gap" : "There is no picture of its time");
        return Match::Again;
    }
    if (is_before(colour, *found)) {
        GST_DEBUG_OBJECT(pad, "There is none for %" GST_PTR_FORMAT, colour.buffer.get());
        found.reset();
    }
    return Match::Ready;
}

} // namespace

Match match_inputs(const InputPads &pads, MatchedBuffers &buffers)
{
    Head colour(pads.colour.get()), depth(pads.depth.get());
    for (Head *head : {&colour, &depth}) {
        if (!head->buffer)
            return gst_aggregator_pad_is_eos(head->pad) ? Match::Ended : Match::Waiting;
        if (head->is_gap()) {
            head->drop("A gap");
            return Match::Again;
        }
    }
    if (is_before(colour, depth) || is_before(depth, colour)) {
        if (is_before(colour, depth))
            colour.drop("There is no depth of this picture");
        else
            depth.drop("There is no picture of this depth");
        return Match::Again;
    }
    std::optional<Head> stack, uncertainty;
    if (const Match match = match_to(colour, pads.stack.get(), stack); match != Match::Ready)
        return match;
    if (const Match match = match_to(colour, pads.uncertainty.get(), uncertainty); match != Match::Ready)
        return match;
    buffers = {colour.take(), depth.take(), stack ? stack->take() : nullptr,
               uncertainty ? uncertainty->take() : nullptr};
    return buffers.colour && buffers.depth ? Match::Ready : Match::Again;
}

} // namespace dff
