/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/dff/dff.h>
#include <gst/gst.h>
#include <string>
#include <vector>

namespace dff {

/* What a pipeline said until it ended. */
struct Outcome {
    bool end_of_stream = false;
    std::string error;   /* the user's text of the first error */
    std::string warning; /* of the first warning */
};

/* Runs a pipeline as gst-launch-1.0 does, at most `seconds`. An outcome without EOS and error is a hang. */
Outcome run(const std::string &description, unsigned seconds = 60);

/* A pipeline with appsinks, read frame by frame. */
class TestPipeline {
public:
    explicit TestPipeline(const std::string &description);
    ~TestPipeline();

    TestPipeline(const TestPipeline &) = delete;
    TestPipeline &operator=(const TestPipeline &) = delete;

    GstElement *bin() const { return pipeline_; }
    GstElement *element(const char *name) const;
    void stop() { gst_element_set_state(pipeline_, GST_STATE_NULL); }
    void play() { gst_element_set_state(pipeline_, GST_STATE_PLAYING); }

    /* The next sample of an appsink, to be unreffed; nullptr at its end or after 30 s. */
    GstSample *pull(const char *sink) const;

    /* All samples of an appsink to its end. */
    std::vector<GstSample *> pull_all(const char *sink) const;

    /* The first error or EOS on the bus; waits at most 30 s. */
    Outcome wait() const;

private:
    GstElement *pipeline_;
    mutable std::vector<GstElement *> elements_;
};

/* Writes stacks of GRAY8 noise to a file of `blob` bytes and returns its name, in the test's own folder. */
std::string write_file(const std::string &name, const std::vector<guint8> &bytes);

/* `planes` GRAY8 frames; texture only in plane `sharp`, or nowhere if that is no plane. */
std::vector<guint8> gray_stack(unsigned width, unsigned height, unsigned planes, unsigned sharp);

} // namespace dff
