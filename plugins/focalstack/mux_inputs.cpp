/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/mux_inputs.h"

#include "focalstack/frame_verdict.h"

#include <algorithm>
#include <bit>

#define GST_CAT_DEFAULT focalstackmux_debug
GST_DEBUG_CATEGORY_EXTERN(focalstackmux_debug);

namespace dff {

static std::string described(const MuxInput &input)
{
    g_autoptr(GstCaps) caps = gst_video_info_to_caps(&input.info);
    gst_structure_remove_fields(gst_caps_get_structure(caps, 0), "interlace-mode", "multiview-mode",
                                "multiview-flags", nullptr);
    g_autofree gchar *text = gst_caps_to_string(caps);
    return std::string("the pad \"") + GST_PAD_NAME(input.pad) + "\" has " + text;
}

void MuxInput::reset()
{
    begin_stream();
    numbering = {};
    caps_changed = false;
    state = State::Open;
    has_caps = false;
    gst_video_info_init(&info);
    sweeps.reset();
}

void MuxInput::begin_stream()
{
    gst_segment_init(&segment, GST_FORMAT_UNDEFINED);
    live.reset();
}

GstClockTime MuxInput::running_time(GstClockTime time) const
{
    return segment.format == GST_FORMAT_TIME ? gst_segment_to_running_time(&segment, GST_FORMAT_TIME, time)
                                             : GST_CLOCK_TIME_NONE;
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

void MuxInputs::release(MuxInput &input)
{
    const std::lock_guard lock(mutex_);
    input.released = true;
    input.sweeps.reset();
}

void MuxInputs::reset()
{
    const std::lock_guard lock(mutex_);
    for (const auto &input : inputs_)
        if (!input->released)
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

bool MuxInputs::set_caps(MuxInput &input, const GstCaps *caps)
{
    GstVideoInfo info;
    if (!gst_video_info_from_caps(&info, caps))
        return false;
    const std::lock_guard lock(mutex_);
    if (input.has_caps && gst_video_info_is_equal(&info, &input.info))
        return true;
    input.caps_changed = input.has_caps;
    input.has_caps = true;
    input.info = info;
    input.sweeps.reset();
    return true;
}

std::optional<std::string> MuxInputs::arrive(MuxInput &input, uint64_t sweep)
{
    const std::lock_guard lock(mutex_);
    input.sweeps = {input.sweeps ? std::min(input.sweeps->first, sweep) : sweep, sweep};
    const auto other = std::find_if(inputs_.begin(), inputs_.end(), [&](const auto &it) {
        return !it->released && it->sweeps && it->sweeps->first <= sweep && sweep <= it->sweeps->last &&
               !gst_video_info_is_equal(&it->info, &input.info);
    });
    if (other == inputs_.end())
        return std::nullopt;
    return std::string("The planes of a sweep must be pictures of one kind: ") + described(input) + ", but " +
           described(**other) + ".";
}

void MuxInputs::reopen(MuxInput &input)
{
    const std::lock_guard lock(mutex_);
    input.state = MuxInput::State::Open;
    input.sweeps.reset();
}

void MuxInputs::end(MuxInput &input)
{
    const std::lock_guard lock(mutex_);
    input.state = MuxInput::State::Ended;
}

bool MuxInputs::all_ended() const
{
    const std::lock_guard lock(mutex_);
    return std::all_of(inputs_.begin(), inputs_.end(), [](const auto &input) {
        return input->state == MuxInput::State::Ended || !gst_pad_is_linked(input->pad);
    });
}

FlushReach MuxInputs::begin_flush(MuxInput &input)
{
    const std::lock_guard lock(mutex_);
    input.state = MuxInput::State::Flushing;
    const bool others_open = std::any_of(inputs_.begin(), inputs_.end(), [](const auto &other) {
        return other->state == MuxInput::State::Open && gst_pad_is_linked(other->pad);
    });
    if (!others_open)
        return FlushReach::Stream;
    return pushing_ == &input ? FlushReach::Downstream : FlushReach::Plane;
}

bool MuxInputs::is_flushing(const MuxInput &input) const
{
    const std::lock_guard lock(mutex_);
    return input.state == MuxInput::State::Flushing;
}

bool MuxInputs::begin_push(const MuxInput *input)
{
    const std::lock_guard lock(mutex_);
    if (input && input->state == MuxInput::State::Flushing)
        return false;
    pushing_ = input;
    return true;
}

void MuxInputs::end_push()
{
    const std::lock_guard lock(mutex_);
    pushing_ = nullptr;
}

} // namespace dff
