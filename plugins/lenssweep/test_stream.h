/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "simulated_sweep.h"
#include "test_settings.h"

#include <gst/video/video.h>
#include <memory>
#include <optional>
#include <stop_token>

/* The frames of lenssweeptestsrc one after the other, with their times and metas. */
class TestStream {
public:
    /* Throws std::exception, with a message for the user, if the settings cannot be used. */
    explicit TestStream(const TestSettings &settings);

    bool is_live() const { return settings_.is_live; }
    bool finished() const;
    bool at_sweep_start() const { return plane() == 0; }
    bool is_rendered() const { return pictures_ != nullptr; }
    GstClockTime frame_duration() const;

    /* What the stream can be of `allowed`, at the one frame rate, the format that `allowed` names first
     * first. */
    GstCaps *caps(const GstCaps *allowed) const;

    /* Reduces caps to one format and size, the image's own if it can be. Throws if the image cannot be read.
     */
    GstCaps *fixate(GstCaps *caps) const;

    /* What to render from now on; a change makes the stream forget the pictures rendered before. */
    void set_format(const GstVideoInfo &info);
    void set_scene(const TestScene &scene);

    /* Renders what repeats. Throws if a file cannot be read or memory runs out; does nothing lasting if
     * `stop` was requested. */
    void render(const std::stop_token &stop, const SimulatedSweep::Progress &progress);

    /* The next frame will be taken at `time` if that is later than it would have been. */
    void postpone(GstClockTime time);

    /* The frame or, for the sweep's first frame, the true depth or motion that is due, with its time and
     * metas. */
    GstBuffer *frame() const;
    GstBuffer *depth() const;
    GstBuffer *motion() const;
    void advance() { frame_++; }

    /* Caps of true depth and motion. */
    GstCaps *depth_caps() const;
    GstCaps *motion_caps() const;

private:
    guint64 sweep() const { return frame_ / plan_.planes(); }
    guint plane() const { return static_cast<guint>(frame_ % plan_.planes()); }
    GstClockTime time_of(guint64 frame) const;
    const SimulatedSweep &shown(guint64 frame) const;
    const SimulatedSweep &shown_in_middle() const;
    void set_time_of_sweep(GstBuffer *buffer) const;
    GstCaps *truth_caps(GstVideoFormat format) const;

    TestSettings settings_;
    dff::SweepPlan plan_;
    gint rate_n_ = 0; /* sweeps per second */
    gint rate_d_ = 1;
    GstVideoInfo info_;
    std::unique_ptr<SimulatedSweep> pictures_;
    std::unique_ptr<SimulatedSweep> turned_; /* the scene upside down; only if there are cuts */
    guint64 frame_ = 0;
    guint64 first_frame_ = 0; /* taken at first_time_; the others follow at the frame rate */
    GstClockTime first_time_ = 0;
};
