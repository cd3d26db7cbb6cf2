/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/focalstackalign_private.h"

#include "common/stack_place.h"
#include "focalstack/brightness_evener.h"
#include "focalstack/plane_placing.h"
#include "focalstack/stack_aligner.h"
#include "focalstack/stack_pictures.h"

#include <stdexcept>

namespace {

std::optional<dff::MotionModel> model_of(dff::MotionChoice choice)
{
    switch (choice) {
    case dff::MotionChoice::Similarity:
        return dff::MotionModel::Similarity;
    case dff::MotionChoice::Homography:
        return dff::MotionModel::Homography;
    default:
        return {};
    }
}

std::vector<dff::PlaneAlignment> estimate(GstFocalStackAlign *self, const dff::StackPictures &pictures,
                                          unsigned planes, dff::MotionChoice choice)
{
    try {
        std::vector<cv::Mat> lumas;
        for (unsigned z = 0; z < planes; z++)
            lumas.push_back(pictures.component(z, 0));
        return dff::align_stack(lumas, model_of(choice));
    } catch (const cv::Exception &exception) {
        GST_WARNING_OBJECT(self, "the stack is left as it is: %s", exception.what());
        return std::vector<dff::PlaneAlignment>(planes, {.warp = {}, .trusted = false, .blank = true});
    }
}

std::vector<dff::PlaneAlignment> find_alignments(GstFocalStackAlign *self, const dff::StackPictures &pictures,
                                                 unsigned planes, const dff::AlignSettings &settings)
{
    const GstFocalStackAlignState &state = *self->state;
    return state.calibration ? state.calibration->alignments(pictures.component(0, 0).size(), planes)
                             : estimate(self, pictures, planes, settings.motion_model);
}

void place_planes(const dff::StackPictures &from, const dff::StackPictures &to,
                  std::span<const dff::PlaneAlignment> alignments, bool even)
{
    for (unsigned i = 0; i < from.components(); i++) {
        std::vector<cv::Mat> aligned;
        for (unsigned z = 0; z < alignments.size(); z++) {
            aligned.push_back(to.component(z, i));
            if (dff::is_shown(alignments[z]))
                dff::undo_warp(from.component(z, i), aligned[z], alignments[z].warp, from.step(i));
        }
        if (even)
            dff::even_brightness(aligned, alignments, from.black(i), from.step(i));
        dff::fill_hidden(aligned, alignments, from.step(i));
    }
}

/* Planes that show their neighbour's picture. */
void tell_repeated(GstBuffer *stack, std::span<const dff::PlaneAlignment> alignments)
{
    GstFocalStackMeta *meta = gst_buffer_get_focal_stack_meta(stack);
    for (std::size_t z = 0; meta && z < alignments.size(); z++)
        if (!dff::is_shown(alignments[z]))
            meta->repeated |= guint64{1} << z;
}

/* Each cause once, until the element is started anew. */
void tell_of_trust(GstFocalStackAlign *self, std::span<const dff::PlaneAlignment> alignments)
{
    GstFocalStackAlignState &state = *self->state;
    const std::string untrusted = dff::numbers_of(alignments, false),
                      blank = dff::numbers_of(alignments, true);

    GST_DEBUG_OBJECT(self, "planes not trusted: %s; without texture: %s",
                     untrusted.empty() ? "none" : untrusted.c_str(), blank.empty() ? "none" : blank.c_str());
    if (!untrusted.empty() && !state.told_untrusted) {
        state.told_untrusted = true;
        GST_ELEMENT_WARNING(
            self, STREAM, FAILED,
            ("Planes %s of a stack of %zu do not fit the others by any shift, turn, zoom or perspective. "
             "Nothing is "
             "taken from them. Hold the camera still, or give the planes in the order of their focus.",
             untrusted.c_str(), alignments.size()),
            ("said once; the property stats tells the planes of every stack"));
    }
    if (!blank.empty() && !state.told_blank) {
        state.told_blank = true;
        GST_ELEMENT_WARNING(
            self, STREAM, FAILED,
            ("Planes %s of a stack of %zu show no texture by which they could be aligned. They are "
             "moved with their neighbours.",
             blank.c_str(), alignments.size()),
            ("said once; the property stats tells the planes of every stack"));
    }
}

/* The latency only ever grows, with some room, so that it is seldom announced. */
void announce_latency(GstFocalStackAlign *self, GstClockTime measured)
{
    {
        const dff::ObjectLock lock(self);
        if (measured <= self->state->latency)
            return;
        self->state->latency = measured + measured / 4;
    }
    gst_element_post_message(GST_ELEMENT(self), gst_message_new_latency(GST_OBJECT(self)));
}

/* Before anything else: what lies at the same place of all planes would hold them fast. */
void leave_out_bad_pixels(dff::BadPixels &known, GstBuffer *stack, dff::StackPictures &pictures,
                          unsigned planes)
{
    const GstFocalStackMeta *meta = gst_buffer_get_focal_stack_meta(stack);
    const guint64 absent = meta ? meta->missing | meta->repeated : 0;
    std::vector<cv::Mat> taken;
    for (unsigned z = 0; z < planes; z++)
        if (!(absent >> z & 1))
            taken.push_back(pictures.component(z, 0));
    known.look(taken);
    pictures.leave_out(known.places());
}

/* The same planes, as they are to be placed for somebody who averages stacks; tells where this one lies. */
std::vector<dff::PlaneAlignment> in_scene(GstFocalStackAlign *self, const dff::StackPictures &pictures,
                                          std::vector<dff::PlaneAlignment> alignments, GstBuffer *output)
{
    GstFocalStackAlignState &state = *self->state;
    if (!state.tells_place || state.calibration)
        return alignments;
    const auto middle = static_cast<unsigned>(dff::middle_plane(alignments.size()));
    const dff::PlaneWarp rest = state.anchor.rest_of(pictures.component(middle, 0));
    for (dff::PlaneAlignment &alignment : alignments)
        alignment.warp = dff::PlaneWarp(alignment.warp.matrix() * rest.matrix());
    const cv::Point shift = state.anchor.shift();
    GST_DEBUG_OBJECT(self, "%d pixels right of anchor %u, %d down", shift.x, state.anchor.anchors(), shift.y);
    dff::tell_stack_place(output, {state.anchor.anchors(), shift.x, shift.y});
    return alignments;
}

} // namespace

GstFlowReturn gst_focal_stack_align_transform(GstBaseTransform *base, GstBuffer *input, GstBuffer *output)
{
    GstFocalStackAlign *self = GST_FOCAL_STACK_ALIGN(base);
    const GstFocalStackInfo &info = self->state->pool->info();
    const gint64 start_us = g_get_monotonic_time();
    g_autoptr(GError) error = nullptr;

    const auto from = dff::StackPictures::map(info, input, GST_MAP_READ, &error);
    const auto to = from ? dff::StackPictures::map(info, output, GST_MAP_WRITE, &error) : nullptr;
    if (!to) {
        GST_ELEMENT_ERROR(self, STREAM, FORMAT, ("%s", error->message), (nullptr));
        return GST_FLOW_ERROR;
    }
    dff::AlignSettings settings;
    {
        const dff::ObjectLock lock(self);
        settings = self->state->settings;
    }
    if (GST_BUFFER_FLAG_IS_SET(input, GST_BUFFER_FLAG_GAP)) { /* of which nothing can be learned */
        place_planes(
            *from, *to,
            std::vector<dff::PlaneAlignment>(info.planes, {.warp = {}, .trusted = true, .blank = false}),
            false);
        self->state->clock.stamp(output, info.frame);
        return GST_FLOW_OK;
    }
    std::vector<dff::PlaneAlignment> alignments;
    try {
        leave_out_bad_pixels(self->state->bad_pixels, input, *from, info.planes);
        alignments = find_alignments(self, *from, info.planes, settings);
        place_planes(*from, *to, in_scene(self, *from, alignments, output), settings.even_brightness);
    } catch (const cv::Exception &exception) {
        GST_ELEMENT_ERROR(self, STREAM, FAILED, ("The planes of the stack cannot be warped."),
                          ("%s", exception.what()));
        return GST_FLOW_ERROR;
    } catch (const std::runtime_error &mismatch) {
        GST_ELEMENT_ERROR(self, STREAM, WRONG_TYPE, ("%s", mismatch.what()), (nullptr));
        return GST_FLOW_ERROR;
    }
    self->state->clock.stamp(output, info.frame);
    tell_repeated(output, alignments);
    tell_of_trust(self, alignments);
    {
        const dff::ObjectLock lock(self);
        self->state->statistics.add(std::move(alignments), self->state->bad_pixels.places().size());
    }
    announce_latency(self, static_cast<GstClockTime>(g_get_monotonic_time() - start_us) * GST_USECOND);
    return GST_FLOW_OK;
}
