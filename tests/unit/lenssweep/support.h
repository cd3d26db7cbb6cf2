/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <cstdint>
#include <gst/app/gstappsink.h>
#include <gst/dff/dff.h>
#include <gst/video/video.h>
#include <memory>
#include <string>
#include <vector>

/* Pipelines as users write them. Linking this in also calls gst_init(). */

struct SampleUnref {
    void operator()(GstSample *sample) const { gst_sample_unref(sample); }
};
using Sample = std::unique_ptr<GstSample, SampleUnref>;

constexpr GstClockTime patience = 60 * GST_SECOND;

class Pipeline {
public:
    /* Sinks whose samples are wanted are appsinks with names. */
    explicit Pipeline(const std::string &description);
    Pipeline(const Pipeline &) = delete;
    Pipeline &operator=(const Pipeline &) = delete;
    ~Pipeline();

    GstElement *get() const { return pipeline_; }

    /* Owned by the pipeline. */
    GstElement *element(const char *name) const;

    GstStateChangeReturn set_state(GstState state) { return gst_element_set_state(pipeline_, state); }

    /* The next sample of an appsink, or nothing at the end of its stream. */
    Sample pull(const char *sink) const;
    std::vector<Sample> pull_all(const char *sink) const;

    /* Waits for the end of all streams: "" or the error's text, "timeout" if there was neither. */
    std::string wait();

    /* PLAYING until the end. */
    std::string run();

private:
    GstElement *pipeline_;
};

/* The bytes of a frame, padding included; the pixels of a depth map, without. */
std::vector<uint8_t> bytes_of(GstSample *sample);
std::vector<uint16_t> depth_of(GstSample *sample);

GstVideoInfo info_of(GstSample *sample);
const GstFocusMeta *focus_of(const Sample &sample);
