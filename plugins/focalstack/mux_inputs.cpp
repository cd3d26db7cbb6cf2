/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/mux_inputs.h"

#include "focalstack/frame_verdict.h"

#include <algorithm>
#include <bit>

#define GST_CAT_DEFAULT focalstackmux_debug
GST_DEBUG_CATEGORY_EXTERN(focalstackmux_debug);

namespace dff {

void MuxInput::reset()
{
    has_caps = false;
    gst_video_info_init(&info);
    gst_segment_init(&segment, GST_FORMAT_UNDEFINED);
    numbering = {};
    live.reset();
    ended = false;
}

bool MuxInput::is_live()
{
    if (!live) {
        gboolean said = FALSE;
        g_autoptr(GstQuery) query = gst_query_new_latency();
        if (gst_pad_peer_query(pad, query))
            gst_query_parse_latency(query, &said, nullptr, nullptr);
        live = said;
    }
    return *live;
}

MuxInput &MuxInputs::add(GstPad *pad, std::optional<unsigned> plane)
{
    const std::lock_guard lock(mutex_);
    return *inputs_.emplace_back(std::make_unique<MuxInput>(pad, plane));
}

void MuxInputs::remove(GstPad *pad)
{
    const std::lock_guard lock(mutex_);
    std::erase_if(inputs_, [pad](const auto &input) { return input->pad == pad; });
}

void MuxInputs::reset()
{
    const std::lock_guard lock(mutex_);
    for (const auto &input : inputs_)
        input->reset();
}

uint64_t MuxInputs::linked_planes() const
{
    const std::lock_guard lock(mutex_);
    uint64_t linked = 0;
    for (const auto &input : inputs_)
        if (input->plane && gst_pad_is_linked(input->pad))
            linked |= plane_bit(*input->plane);
    return linked;
}

bool MuxInputs::all_in_one_linked() const
{
    const std::lock_guard lock(mutex_);
    return std::any_of(inputs_.begin(), inputs_.end(),
                       [](const auto &input) { return !input->plane && gst_pad_is_linked(input->pad); });
}

bool MuxInputs::make_sense(GstElement *element, unsigned planes) const
{
    const uint64_t linked = linked_planes();
    if (linked != 0 && all_in_one_linked()) {
        GST_ELEMENT_ERROR(element, CORE, PAD, ("Both the pad \"sink\" and pads of single planes are linked."),
                          ("Link either \"sink\", for the frames of all planes in the order of time, or "
                           "\"sink_0\", \"sink_1\", ..., one for each plane."));
        return false;
    }
    if (planes == 0 && (linked & (linked + 1)) != 0) {
        GST_ELEMENT_ERROR(
            element, CORE, PAD,
            ("The pad \"sink_%d\" is not linked, but one of a farther plane is.", std::countr_one(linked)),
            ("Link the pads from \"sink_0\" on, one for each plane, or set planes if the pad is linked "
             "later."));
        return false;
    }
    return true;
}

void MuxInputs::reopen(MuxInput &input)
{
    const std::lock_guard lock(mutex_);
    input.ended = false;
}

bool MuxInputs::end(MuxInput &input)
{
    const std::lock_guard lock(mutex_);
    input.ended = true;
    return std::all_of(inputs_.begin(), inputs_.end(),
                       [](const auto &other) { return other->ended || !gst_pad_is_linked(other->pad); });
}

} // namespace dff
