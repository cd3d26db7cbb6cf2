/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "output_pads.h"

#include <algorithm>

namespace dff {

void OutputPads::add(GstElement *element, GstPad *pad, GstVideoFormat format)
{
    const std::lock_guard lock(mutex_);
    gst_flow_combiner_add_pad(flows_, pad);
    outputs_.push_back(std::make_shared<DepthOutput>(element, pad, format));
}

void OutputPads::remove(GstPad *pad)
{
    const std::lock_guard lock(mutex_);
    gst_flow_combiner_remove_pad(flows_, pad);
    std::erase_if(outputs_, [&](const auto &output) { return output->pad() == pad; });
}

std::vector<std::shared_ptr<DepthOutput>> OutputPads::outputs() const
{
    const std::lock_guard lock(mutex_);
    return outputs_;
}

void OutputPads::open()
{
    for (const auto &output : outputs())
        output->open();
}

void OutputPads::restart()
{
    for (const auto &output : outputs())
        output->restart();
    const std::lock_guard lock(mutex_);
    gst_flow_combiner_reset(flows_);
}

void OutputPads::end(const StreamSegment &segment)
{
    for (const auto &output : outputs())
        output->end(segment);
}

void OutputPads::pass_gap(GstEvent *gap, const StreamSegment &segment)
{
    for (const auto &output : outputs())
        output->pass_gap(gap, segment);
}

GstFlowReturn OutputPads::push(DepthMaps &maps)
{
    GstFlowReturn flow = GST_FLOW_NOT_LINKED;
    maps.push([&](GstPad *pad, GstFlowReturn pushed) {
        const std::lock_guard lock(mutex_);
        const bool is_here =
            std::ranges::any_of(outputs_, [&](const auto &output) { return output->pad() == pad; });
        if (is_here) /* the flow of a pad that has gone in the meantime is nobody's */
            flow = gst_flow_combiner_update_pad_flow(flows_, pad, pushed);
    });
    return flow;
}

} // namespace dff
