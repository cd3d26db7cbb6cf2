/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* How MuxCore makes stacks of frames; all with its stream lock held. */
#include "focalstack/mux_core.h"

#include "common/whole_frame.h"
#include "focalstack/frame_layout.h"

#include <bit>
#include <utility>

GST_DEBUG_CATEGORY_EXTERN(focalstackmux_debug);
#define GST_CAT_DEFAULT focalstackmux_debug

namespace dff {

namespace {

GstFocalStackInfo stack_shape(const GstVideoInfo &frame, unsigned planes, unsigned frames_a_stack)
{
    GstFocalStackInfo shape{planes, frame};
    if (frames_a_stack > 1)
        gst_util_fraction_multiply(frame.fps_n, frame.fps_d, 1, static_cast<gint>(frames_a_stack),
                                   &shape.frame.fps_n, &shape.frame.fps_d);
    return shape;
}

bool same_shape(const GstFocalStackInfo &a, const GstFocalStackInfo &b)
{
    return a.planes == b.planes && gst_video_info_is_equal(&a.frame, &b.frame);
}

} // namespace

/* Planes a stack, or 0 with the error posted. */
unsigned MuxCore::planes_for(const MuxInput &input, const GstFocusInfo &focus)
{
    unsigned planes = settings_.planes;
    if (planes == 0)
        planes = input.plane ? static_cast<unsigned>(std::bit_width(inputs_.linked_planes())) : focus.planes;
    else if (!input.plane && focus.planes != 0 && focus.planes != planes) {
        GST_ELEMENT_ERROR(
            element_, STREAM, FORMAT,
            ("The frames are of sweeps of %u planes, but planes=%u was asked for.", focus.planes, planes),
            ("Set planes=0 to go by the frames."));
        return 0;
    }

    if (planes < 2 || planes > longest_stack) {
        GST_ELEMENT_ERROR(element_, STREAM, FORMAT, ("A stack has 2 to 64 planes, not %u.", planes),
                          ("Set planes, or planes of the element that gives the frames their sweep."));
        return 0;
    }
    return planes;
}

GstFlowReturn MuxCore::assemble(MuxInput &input, PlaneFrame &frame)
{
    const unsigned planes = planes_for(input, frame.focus);
    if (planes == 0)
        return GST_FLOW_ERROR;
    if (frame.focus.plane >= planes) {
        refuse_damaged(frame, "its plane is not one of the sweep's");
        return GST_FLOW_OK;
    }
    const bool stack_a_frame = input.plane || settings_.window == StackWindow::Rolling;
    const GstFlowReturn flow = use_shape(input, stack_shape(input.info, planes, stack_a_frame ? 1 : planes));
    return flow == GST_FLOW_OK ? put(input, frame) : flow;
}

GstFlowReturn MuxCore::use_shape(const MuxInput &input, const GstFocalStackInfo &shape)
{
    if (maker_ && same_shape(maker_->info(), shape))
        return GST_FLOW_OK;
    const GstFlowReturn flow = finish(&input);
    if (flow != GST_FLOW_OK)
        return flow;
    if (!inputs_.make_sense(element_, settings_.planes))
        return GST_FLOW_ERROR;
    if (const auto problem = too_large(shape)) {
        GST_ELEMENT_ERROR(element_, RESOURCE, NO_SPACE_LEFT, ("%s", problem->c_str()), (nullptr));
        return GST_FLOW_ERROR;
    }
    if (!output_.set_shape(shape))
        return GST_FLOW_NOT_NEGOTIATED;

    const unsigned allowance = inputs_.linked_planes() ? shape.planes - 1 : StackMaker::default_allowance;
    maker_ = StackMaker::create(settings_.window, shape, settings_.on_missing, allowance, counting_);
    update_latency(shape);
    return GST_FLOW_OK;
}

GstFlowReturn MuxCore::put(const MuxInput &input, PlaneFrame &frame)
{
    GstVideoFrame picture;
    if (!map_whole(picture, input.info, frame.buffer, GST_MAP_READ)) {
        const bool described = gst_buffer_get_video_meta(frame.buffer) != nullptr;
        refuse_damaged(
            frame, described ? "its GstVideoMeta has another size than its caps, or leads out of its memory"
                             : describe_misfit(input.info, gst_buffer_get_size(frame.buffer)));
        return GST_FLOW_OK;
    }
    frame.picture = &picture;
    const bool put = maker_->add(frame);
    frame.picture = nullptr;
    gst_video_frame_unmap(&picture);
    if (!put) {
        GST_ELEMENT_ERROR(element_, RESOURCE, NO_SPACE_LEFT,
                          ("There is no memory for another focal stack of %" G_GSIZE_FORMAT
                           " bytes: lower planes, or the width and height of the pictures.",
                           gst_focal_stack_info_get_size(&maker_->info())),
                          (nullptr));
        return GST_FLOW_ERROR;
    }
    return send_outcomes(&input);
}

/* The user hears of the first one; stats count all of them. */
void MuxCore::refuse_damaged(const PlaneFrame &frame, const std::string &why)
{
    counting_.damaged++;
    GST_WARNING_OBJECT(element_, "plane %u of sweep %" G_GUINT64_FORMAT " is left out: %s", frame.focus.plane,
                       frame.focus.sweep, why.c_str());
    if (!std::exchange(damage_told_, true))
        GST_ELEMENT_WARNING(element_, STREAM, DECODE, ("A frame was left out: %s.", why.c_str()),
                            ("Plane %u of sweep %" G_GUINT64_FORMAT "; the property stats counts those that "
                             "follow.",
                             frame.focus.plane, frame.focus.sweep));
}

GstFlowReturn MuxCore::send_outcomes(const MuxInput *input)
{
    publish();
    GstFlowReturn flow = GST_FLOW_OK;
    while (flow == GST_FLOW_OK) {
        if (!inputs_.begin_push(input))
            return GST_FLOW_FLUSHING;
        auto outcome = maker_->next_outcome();
        if (outcome)
            flow = output_.send(std::move(*outcome), counting_);
        inputs_.end_push();
        if (!outcome)
            break;
    }
    return flow;
}

GstFlowReturn MuxCore::finish(const MuxInput *input)
{
    if (!maker_)
        return GST_FLOW_OK;
    maker_->finish();
    const GstFlowReturn flow = send_outcomes(input);
    maker_.reset();
    return flow;
}

/* A stack is sent when its last frame is there; one to be filled up waits for frames that may have been
 * overtaken. Planes on pads of their own come within one frame period. */
void MuxCore::update_latency(const GstFocalStackInfo &shape)
{
    const GstClockTime stack_period = frame_period(shape.frame);
    const bool rolling = settings_.window == StackWindow::Rolling;
    const bool side_by_side = inputs_.linked_planes() != 0;
    const GstClockTime period = side_by_side || rolling ? stack_period : stack_period / shape.planes;
    GstClockTime latency = side_by_side ? period : period * (shape.planes - 1);
    if (settings_.on_missing != OnMissing::Drop && !rolling)
        latency += side_by_side ? period : period * (StackMaker::default_allowance + 1);
    {
        const std::lock_guard lock(facts_);
        if (latency == std::exchange(latency_, latency))
            return;
    }
    gst_element_post_message(element_, gst_message_new_latency(GST_OBJECT(element_)));
}

void MuxCore::warn_of_missing_stacks()
{
    if (!maker_)
        return;
    const std::string warning = watch_.look(counting_, maker_->info().planes);
    if (!warning.empty())
        GST_ELEMENT_WARNING(
            element_, STREAM, FAILED, ("%s", warning.c_str()),
            ("dropped stacks: %" G_GUINT64_FORMAT ", frames lost: %" G_GUINT64_FORMAT
             ", repeated: %" G_GUINT64_FORMAT ", late: %" G_GUINT64_FORMAT ", damaged: %" G_GUINT64_FORMAT
             ". See whether the source gives as many planes as it says; on-missing=repeat fills what is "
             "missing.",
             counting_.dropped, counting_.lost, counting_.repeated, counting_.late, counting_.damaged));
}

} // namespace dff
