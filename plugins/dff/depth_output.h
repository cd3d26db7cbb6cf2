/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "gstcl/picture_pool.h"

#include <gst/dff/dff.h>
#include <string>

namespace dff {

/* A segment and its event's number. */
struct StreamSegment {
    GstSegment segment;
    guint32 seqnum;
};

/* One source pad of dffdepth with what it has to send before its first picture. Used by the streaming thread
 * alone, but for the pad itself. */
class DepthOutput {
public:
    DepthOutput(GstElement *element, GstPad *pad, GstVideoFormat format);
    ~DepthOutput();

    DepthOutput(const DepthOutput &) = delete;
    DepthOutput &operator=(const DepthOutput &) = delete;

    GstPad *pad() const { return pad_; }
    GstVideoFormat format() const { return format_; }
    /* Whether its maps are of depth, and not of how uncertain that is, or of 8 bits. */
    bool has_depth() const { return format_ == GST_VIDEO_FORMAT_GRAY16_LE && !tells_uncertainty(); }
    bool tells_uncertainty() const { return g_str_equal(GST_PAD_NAME(pad_), "uncertainty"); }
    bool is_linked() const { return gst_pad_is_linked(pad_); }

    /* Sends stream-start, caps and segment where they are not the last that were sent. `depth` stands in the
     * caps of depth. */
    void prepare(const GstVideoInfo &stack, const GstDepthInfo &depth, const StreamSegment &segment);

    /* Sends what has to come before the end, if it has not: stream-start and segment, even where no picture
     * was sent. */
    void end(const StreamSegment &segment);

    /* Sends the gap within `segment`; lost where no picture was sent yet, whose caps nobody knows. */
    void pass_gap(GstEvent *gap, const StreamSegment &segment);

    /* Sends stream-start if nothing was sent yet, so that other events may follow. */
    void open();

    /* After a flush or a new stream everything is sent again. */
    void restart();

    /* A picture of the prepared size; PicturePool::acquire(). */
    GstBuffer *acquire() { return pool_.acquire(); }

private:
    void send_segment(const StreamSegment &segment);

    GstElement *element_;
    GstPad *pad_;
    GstVideoFormat format_;
    PicturePool pool_;
    GstCaps *caps_ = nullptr;
    StreamSegment segment_{};
    bool opened_ = false;
    bool has_segment_ = false;
};

} // namespace dff
